"""The JSON Schema that `gamut schema` prints: no alarm on a good scene of the tree, and what a
frame can know of the wrong ones. Prints TAP."""
import glob
import json
import os
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tap  # noqa: E402

try:
    import yaml
    import jsonschema
except ImportError:
    print("1..0 # SKIP no validator (Debian: python3-jsonschema, python3-yaml)")
    sys.exit(77)

BAD = os.path.join(tap.ROOT, "tests/bad_inputs")
# Kinds of mistakes that a frame can know, by the beginning of the file's name. What needs units,
# other files, other values or the plugins themselves is left to `gamut check`.
KNOWABLE = ("a_list", "a_word", "unknown_key_", "key_too_", "key_in_sister", "missing_version",
            "missing_density", "missing_unit.", "number_for_", "mapping_for_", "scalar_for_mapping",
            "two_shapes", "union_no_list", "union_of_two", "other_version", "unknown_choice",
            "unknown_plugin", "unknown_solver", "unknown_estimator", "correlation_no_list",
            "sweep_no_list_of_values", "tracers_no_list", "plugin_of_another_kind",
            "missing_material.", "difference_misspelt", "several_errors")
# `reduce` is text or a mapping to the frame; a mapping stands where a random number may.
BEYOND = {"unknown_key_reduce", "missing_material"}


def load(path):
    with open(path, encoding="utf-8") as file:
        return yaml.safe_load(file)


def good_scenes():
    for pattern in ("inputs/**/*.yaml", "plugins/*/*/*.scene.yaml", "tests/bad_inputs/good.yaml"):
        for path in sorted(glob.glob(os.path.join(tap.ROOT, pattern), recursive=True)):
            yield path


def main():
    answer = tap.gamut("schema")
    schema = answer.json()
    if not tap.report(answer.code == 0 and schema is not None, "gamut schema prints JSON", answer):
        tap.done()
    validator = jsonschema.Draft202012Validator
    validator.check_schema(schema)
    look = validator(schema)
    for path in good_scenes():
        faults = [f"{list(f.path)}: {f.message[:100]}" for f in look.iter_errors(load(path))]
        name = os.path.relpath(path, tap.ROOT)
        tap.report(not faults, f"{name}: no false alarm" + (f", but {faults[0]}" if faults else ""))
    caught = known = 0
    for path in sorted(glob.glob(os.path.join(BAD, "*.yaml"))):
        name = os.path.basename(path)
        if not name.startswith(KNOWABLE) or name[:-5] in BEYOND:
            continue
        known += 1
        found = any(True for _ in look.iter_errors(load(path)))
        caught += found
        tap.report(found, f"{name}: caught")
    tap.report(caught == known and known >= 40, f"{caught} of {known} mistakes of the frame caught")
    tap.done()


main()
