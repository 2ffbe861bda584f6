"""Writes docs/reference.md from what gamut says of itself.

    python3 docs/make_reference.py build/gamut > docs/reference.md

Keys of plugins come from `gamut show --json`. The keys around them are described below, and checked
against `gamut schema`: one that is missing here, or no longer there, ends the script.
"""

import json
import os
import subprocess
import sys

KINDS = (("solver", "Solvers"), ("eos", "Equations of state"), ("strength", "Strength"),
         ("elasticity", "Elasticity"), ("effect", "Effects"), ("random_field", "Random fields"),
         ("estimator", "Estimators"))

# What the schema's keys mean, by section. A section's place in the schema, then rows.
FRAME = (
    ("The file", (), (
        ("gamut", "1", "Format of the scene. Required."),
        ("title", "text", "For people, pictures and results."),
        ("include", "list of files", "Merged below this file, which overrides them. Looked for "
         "beside this file, then in the folders of inputs above it, then in the installed one."),
        ("solver", "mapping", "`model` names the solver, the other keys are its own."),
        ("materials", "mapping of names", "Materials."),
        ("bodies", "mapping of names", "Bodies."),
        ("effects", "mapping of names", "Effects that this scene calls for."),
        ("quantities", "mapping of names", "What the scene wants to know."),
        ("outputs", "mapping", "Frames of fields."),
        ("uncertainty", "mapping", "Of studies over random parameters; a run takes the means."))),
    ("A material", ("materials", "*"), (
        ("density", "kg/m3", "Density at zero compression. Required."),
        ("eos", "plugin", "Pressure. `model` names it."),
        ("strength", "plugin", "Flow stress. Absent: elastic without end."),
        ("elasticity", "plugin", "Stress update; `hypoelastic` unless stated."),
        ("source", "text or list", "Where the numbers come from."),
        ("scaled", "true or false",
         "Numbers without a scale: what would be unusual in a metal is not warned of."))),
    ("A body", ("bodies", "*"), (
        ("material", "name", "One of the materials. Required."),
        ("shape", "mapping", "One of the shapes below, or `union`: a list of them. Where a shape "
         "has no formula for its volume (a union of parts that overlap, a difference) that of the "
         "points is taken, and said."),
        ("velocity", "m/s, by component", "Numbers with units, or text with arithmetic in `x`, "
         "`y`, `z` (metres) that gives m/s. As many as the geometry has axes. Zero unless stated."),
        ("temperature", "K", "At the start; 298 K unless stated."),
        ("pressure", "Pa", "At the start; 0 unless stated."),
        ("energy", "J/m3", "At the start, per reference volume, in place of pressure."))),
    ("Shape: box", ("$defs", "shape", "box"), (
        ("min", "m, by component", "Lowest corner."),
        ("max", "m, by component", "Highest corner."),
        ("size", "m, by component", "In place of `min` and `max`."),
        ("centre", "m, by component", "With `size`; the origin unless stated."))),
    ("Shape: cylinder", ("$defs", "shape", "cylinder"), (
        ("radius", "m", "Required."),
        ("length", "m", "From the base along the axis."),
        ("axis", "x, y or z", "y unless stated; in plane strain z, without end."),
        ("base", "m, by component", "Centre of the base; the origin unless stated."))),
    ("Shape: sphere", ("$defs", "shape", "sphere"), (
        ("radius", "m", "Required."),
        ("centre", "m, by component", "The origin unless stated."))),
    ("Shape: tube", ("$defs", "shape", "tube"), (
        ("radius", "m", "Outer one. Required."),
        ("inner_radius", "m", "Required."),
        ("length", "m", "From the base along the axis."),
        ("axis", "x, y or z", "y unless stated; in plane strain z, without end."),
        ("base", "m, by component", "Centre of the base; the origin unless stated."))),
    ("Shape: cone", ("$defs", "shape", "cone"), (
        ("radius", "m", "Of the base. Required."),
        ("top_radius", "m", "At the other end; 0, a point, unless stated."),
        ("length", "m", "From the base along the axis."),
        ("axis", "x, y or z", "y unless stated."),
        ("base", "m, by component", "Centre of the base; the origin unless stated."))),
    ("Shape: difference", ("$defs", "shape", "difference"), (
        ("from", "shape", "What something is taken from. Required."),
        ("remove", "list of shapes", "What is taken away. Required."))),
    ("Shape: points", ("$defs", "shape", "points"), (
        ("file", "name", "A CSV file beside the scene. Its first line names the columns `x`, `y`, "
         "`z` (as many as there are axes) and `volume`, in SI or with their units: "
         "`x [mm], y [mm], volume [mm2]`. Volume is an area in plane strain, a length in 1d, that "
         "of the full circle where axisymmetric. Required."),
        ("spacing", "m", "Edge of the square that each point stands for, in place of `volume`."))),
    ("A quantity", ("quantities", "*"), (
        ("measure", "name", "A measure of the solver, the elasticity or an effect, or a field's "
         "component such as `velocity_y`. Required. Arguments of the measure are further keys."),
        ("effect", "name", "Which effect, where several offer the measure."),
        ("body", "name", "Of which body, where there are several."),
        ("at", "mapping", "For measures of a point: which one, or several."),
        ("reduce", "see below", "One number out of the history. Absent: the history."),
        ("every", "s", "Time between samples; about 500 samples unless stated."))),
    ("A quantity's point, `at`", ("quantities", "*", "at"), (
        ("body", "name", "Where there are several."),
        ("point", "m, by component", "The point. Or, with a curve for each:"),
        ("points", "list of points", "Several, at most 1000: the quantity `NAME` becomes `NAME.1`, "
         "`NAME.2`, ... (`NAME.01`, ... where there are ten or more)."),
        ("line", "mapping", "Points along a line."),
        ("follow", "material or space", "`material` (as it is unless stated): the point of the "
         "body that is nearest at the start. `space`: what is there."))),
    ("A line of points, `line`", ("quantities", "*", "at", "line"), (
        ("from", "m, by component", "The first. Required."),
        ("to", "m, by component", "The last. Required."),
        ("points", "whole number", "How many, at equal distances, with both ends; 2 to 1000. "
         "Required."))),
    ("Outputs", ("outputs",), (
        ("every", "s", "Time between frames."),
        ("frames", "whole number", "How many frames, in place of `every`."),
        ("checkpoint", "wall time, or {every: s}",
         "How often to leave a checkpoint; else at signals only."),
        ("fields", "list of names", "Fields and measures of points to write."))),
    ("Uncertainty", ("uncertainty",), (
        ("estimator", "plugin, or off", "`model` names it; off: one run at the means."),
        ("seed", "whole number", "Of the random numbers; 1 unless stated."),
        ("correlation", "list", "Of [path, path, number from -1 to 1]: between random parameters."),
        ("failures", "1", "Share of the runs that may fail."),
        ("step_margin", "1, or off", "Share by which the common steps of a sample's runs are "
         "shorter than those at the means; 0.2 unless stated; off: each run takes its own."))),
    ("A random number", ("$defs", "random"), (
        ("mean", "as the parameter", "Mean."),
        ("cv", "1", "Coefficient of variation: standard deviation over mean; of a temperature "
         "over its value in K. Refused where the mean is in degC or degF."),
        ("sd", "as the parameter", "Standard deviation, in place of `cv`; a difference: 20 degC "
         "are 20 K."),
        ("distribution", "name", "One of CHOICES; the first unless stated."),
        ("lower", "as the parameter", "Of uniform, beta, triangular."),
        ("upper", "as the parameter", "Of uniform, beta, triangular."),
        ("truncate", "true or [lower, upper]", "Cuts the distribution off: at the physical range "
         "and at constraints, or at the given ends (-inf and inf are open)."),
        ("field", "plugin", "A random field, in parameters that kernels see: every point then has "
         "its own value. See [random fields](random_fields.md)."))),
)

REDUCTIONS = (
    ("`at end`, `at 12 us`", "The value then; between samples on a straight line."),
    ("`max`, `min`, `mean`", "Over the whole run."),
    ("`{max: [t0, t1]}`, `{min: ...}`, `{mean: ...}`", "Over a window."),
    ("`{slope: [t0, t1]}`", "Slope of the straight line that fits best, per second."),
    ("`{time_of: VALUE}`", "When the value is first crossed."),
    ("`time_of_max`, `{time_of_max: [t0, t1]}`", "When the largest value is taken."),
)


def ask(gamut, *arguments):
    shell = {k: v for k, v in os.environ.items() if k != "GAMUT_PLUGIN_PATH"}
    return json.loads(subprocess.run([gamut, *arguments, "--no-user-plugins"], env=shell,
                                     check=True, stdout=subprocess.PIPE, text=True,
                                     stderr=subprocess.DEVNULL).stdout)


def schema_keys(schema, place):
    """Keys of the mapping at a place of the schema."""
    node = schema["$defs"][place[1]] if place[:1] == ("$defs",) else schema
    for step in place[2:] if place[:1] == ("$defs",) else place:
        node = node["additionalProperties"] if step == "*" else node["properties"][step]
    return set(node["properties"])


def choices(schema, place, key):
    """What may be chosen for a key, as the schema has it."""
    node = schema["$defs"][place[1]] if place[:1] == ("$defs",) else {}
    return ", ".join(node.get("properties", {}).get(key, {}).get("enum", ()))


def check_frame(schema, plugins):
    added = {k for p in plugins for part in ("material_parameters", "body_parameters")
             for k in p[part]}
    added |= {k for p in plugins for m in p["measures"].values() for k in m.get("arguments", {})}
    for title, place, rows in FRAME:
        known, said = schema_keys(schema, place), {row[0] for row in rows}
        if known - said - added or said - known:
            sys.exit(f"{title}: missing here {sorted(known - said - added)}, "
                     f"not in the schema {sorted(said - known)}")


def cell(text):
    return " ".join(str(text).split()).replace("|", "\\|")


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(cell(c) for c in row) + " |")
    print()


def number(value):
    return f"{value:.6g}"


def range_of(parameter):
    limits = parameter.get("physical")
    if not limits:
        return ""
    low, high = limits["lower"], limits["upper"]
    parts = []
    if low is not None:
        parts.append(("above " if limits["lower_open"] else "at least ") + number(low))
    if high is not None:
        parts.append(("below " if limits["upper_open"] else "at most ") + number(high))
    return ", ".join(parts)


def size_of(parameter):
    low, high = parameter["size"]
    return str(low) if low == high else f"{low} to {high}"


def unit_of(entry):
    """Its unit, or the argument that names the field whose unit it has."""
    return f"that of `{entry['unit_of']}`" if "unit_of" in entry else entry.get("unit", "1")


def sort_of(parameter):
    kind, unit = parameter["type"], unit_of(parameter)
    if kind == "real":
        return unit
    if kind == "choice":
        return " or ".join(f"`{c}`" for c in parameter["choices"])
    if kind == "vector":
        return f"{size_of(parameter)} numbers" + ("" if unit == "1" else f" in {unit}")
    if kind in ("list", "map"):
        of = parameter["of"]
        return f"{kind} of {size_of(parameter)}: {sort_of(of)}"
    if kind == "entry":
        return f"name of one of `{parameter['of']}`"
    if kind == "one of":
        return "; or ".join(sort_of(form) for form in parameter["forms"].values())
    if kind == "table":
        return "table of " + ", ".join(f"{k} ({u})" for k, u in parameter["columns"].items())
    return {"integer": "whole number", "group": "mapping", "body": "name of a body"}.get(kind, kind)


def need_of(parameter, given):
    if "default" in parameter:
        return f"`{parameter['default']}`"
    if given:
        return "one set"
    return "-" if parameter["optional"] else "required"


def parameter_rows(parameters, given=(), prefix=""):
    for name, p in parameters.items():
        yield (f"`{prefix}{name}`", sort_of(p), need_of(p, name in given), range_of(p),
               p.get("doc", "") + (" (may be random)" if p["random"] else ""))
        yield from rows_below(p, f"{prefix}{name}.")


def rows_below(parameter, prefix):
    """Members of a group, of the entries of a list or map, of the form that is a group."""
    if parameter["type"] == "group":
        members = parameter["members"]
        yield from parameter_rows(members, alternatives(parameter, members), prefix)
    elif parameter["type"] in ("list", "map"):
        yield from rows_below(parameter["of"], prefix + "*.")
    elif parameter["type"] == "one of":
        for form in parameter["forms"].values():
            yield from rows_below(form, prefix)


def alternatives(group, members):
    return {name for names in group.get("one_of", ()) for name in names
            if not members[name]["optional"]}


def family(row):
    """What rows share that differ only in the name of a component, and that name."""
    path = row[0].strip("`").split(".")
    if len(path) == 3 or (len(path) == 2 and row[1] == "mapping"):
        return (path[0], *path[2:], row[1:]), path[1]
    return row, None


def without_repeats(rows):
    """Rows that differ only in the name of a component are listed once."""
    told = {}
    for row in rows:
        key, name = family(row)
        told.setdefault(key, []).append((name, row))
    for same in told.values():
        row = same[0][1]
        if len(same) > 1:
            path = row[0].strip("`").split(".")
            path[1] = "*"
            names = ", ".join(name for name, _ in same)
            row = (f"`{'.'.join(path)}`", *row[1:4], f"{row[4]} (for {names})")
        yield row


def parameters(title, entries, given=()):
    if entries:
        if title:
            print(f"{title}:\n")
        table(("key", "value", "default", "range (SI)", "meaning"),
              without_repeats(parameter_rows(entries, given)))


def argument_text(measure):
    return ", ".join(f"`{k}`: {sort_of(p)}" + ("" if "default" not in p else f" (`{p['default']}`)")
                     for k, p in measure.get("arguments", {}).items())


def plugin(p):
    print(f"### {p['plugin']}\n\n{p['summary'][0].upper() + p['summary'][1:]}.\n")
    given = {n for s in p["given"] for n in list(s["set"]) + list(s["then"])}
    given |= alternatives(p, p["parameters"])
    parameters("", p["parameters"], given)
    if len(p["given"]) > 1:
        print("Give one of: " + "; ".join(", ".join(f"`{n}`" for n in s["set"])
                                          for s in p["given"]) + ".\n")
    if p["constraints"]:
        print("Must hold: " + ", ".join(f"`{c}`" for c in p["constraints"]) + ".\n")
    parameters("Further keys of every body", p["body_parameters"])
    parameters("Further keys of every material", p["material_parameters"])
    if p["measures"]:
        print("Measures:\n")
        table(("measure", "unit", "of", "arguments", "meaning"),
              [(f"`{k}`", unit_of(m), m["at"], argument_text(m), m.get("doc", ""))
               for k, m in p["measures"].items()])
    if p["requires"]:
        print("Needs a solver that provides: " + ", ".join(p["requires"]) + ".\n")
    print(f"Formula, limits and sources: `gamut show {p['plugin']}`.\n")


def fields(plugins):
    """Fields of points that may be written: unit and components by name."""
    found = {"position": ("m", 3), "velocity": ("m/s", 3), "mass": ("kg", 1)}
    for p in plugins:
        if p["plugin"].split("/")[0] not in ("elasticity", "effect"):
            continue
        for name, f in [*entries(p["outputs"]), *entries(p["state"])]:
            found.setdefault(name, (f["unit"], f.get("components", 1)))
    return found


def entries(part):
    return part.items() if isinstance(part, dict) else ((f["name"], f) for f in part)


def write(gamut):
    ours = os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(__file__))), "plugins")
    plugins = [ask(gamut, "show", p["id"], "--json") for p in ask(gamut, "list", "--json")
               if os.path.realpath(p["file"]).startswith(ours)]
    schema = ask(gamut, "schema")
    check_frame(schema, plugins)
    print("# Scene reference\n\nEvery key that a scene may hold. Generated by "
          "`docs/make_reference.py` from `gamut schema` and\n`gamut show`; the "
          "[manual](manual.md) explains, this page lists.\n")
    print("A number with a dimension carries its unit (`0.4 mm`, `190 m/s`, `383 J/(kg K)`); a "
          "pure number\ncarries none. Ranges are in SI. \"-\" under default: may be left out.\n")
    for title, place, rows in FRAME:
        print(f"## {title}\n")
        table(("key", "value", "meaning"), [
            (f"`{k}`", v, m.replace("CHOICES", choices(schema, place, k))) for k, v, m in rows])
        if title.startswith("A quantity's"):
            print("## Reductions\n")
            table(("`reduce:`", "gives"), REDUCTIONS)
    print("## Effects in a scene\n")
    table(("key", "value", "meaning"), (
        ("`model`", "name", "Which effect. Required."),
        ("`enabled`", "auto, on or off", "`auto` unless stated: the effect may decline where it "
         "has nothing to do. `on`: it is kept all the same. `off`: as if it were not there."),
        ("`bodies`", "list of names", "Which bodies; all unless stated."),
        ("`materials`", "list of names", "Which materials; all unless stated.")))
    for kind, title in KINDS:
        members = [p for p in plugins if p["plugin"].startswith(kind + "/")]
        if members:
            print(f"## {title}\n")
        for p in members:
            plugin(p)
    print("## Fields\n\nFor `outputs.fields`, and by component (`stress_xx`, `velocity_y`) as "
          "measures of a point; the\nelasticity's measures of points (`pressure`, `von_mises` ...) "
          "may be outputs too. A field can be had\nwhere some plugin of the scene keeps it.\n")
    table(("field", "unit", "components"),
          [(f"`{k}`", u, c) for k, (u, c) in sorted(fields(plugins).items())])


if __name__ == "__main__":
    write(sys.argv[1])
