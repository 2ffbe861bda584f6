"""How the files of the tree are written: widths, lengths, paths, words, YAML that parses."""

import re

import tap

WIDTH = 100
LENGTH = 400
CODE = (".c", ".h")
TEXT = CODE + (".py", ".sh", ".am", ".ac", ".m4", ".mk", ".inc", ".yaml")
FOLDERS = ("framework", "plugins", "inputs", "tests", "docs")
OWN_MACROS = "m4/gamut.m4"
# Files that are wrong on purpose.
BROKEN = ("tests/bad_inputs/", "tests/bad_plugins/")

PLACES = re.compile(r"(?<![\w.$})~-])/(home|root|tmp|work|Users|opt|mnt|usr/local|usr/share)/")
TEMPORARY = re.compile(r"/t[m]p/[\w-]*XXXXXX")
UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX|HACK|stub)\b")


def lines(path):
    return enumerate(tap.read(path).split("\n"), 1)


def sound(suffixes):
    return [p for p in tap.files(*FOLDERS, suffixes=suffixes) + [OWN_MACROS]
            if p.endswith(suffixes) and not p.startswith(BROKEN)]


def bad_lines(suffixes, wrong):
    return [f"{path}:{number}" for path in sound(suffixes)
            for number, line in lines(path) if wrong(line)]


def duplicate_keys(loader_class, yaml):
    """A loader that refuses what PyYAML would take in silence."""
    class Strict(loader_class):
        pass

    def mapping(loader, node, deep=False):
        keys = [loader.construct_object(key, deep=True) for key, _ in node.value]
        for key in keys:
            if keys.count(key) > 1:
                raise yaml.constructor.ConstructorError(
                    None, None, f"duplicate key {key!r}", node.start_mark)
        return loader_class.construct_mapping(loader, node, deep)

    Strict.add_constructor("tag:yaml.org,2002:map", mapping)
    return Strict


def yaml_findings(yaml):
    # libyaml's own reader, as gamut uses it; PyYAML's refuses "[strength?]".
    strict = duplicate_keys(yaml.CSafeLoader, yaml)
    for path in sound((".yaml",)):
        try:
            yaml.load(tap.read(path), Loader=strict)
        except yaml.YAMLError as error:
            yield f"{path}: " + " ".join(str(error).split())


tap.check(f"lines have at most {WIDTH} characters", bad_lines(TEXT, lambda s: len(s) > WIDTH))
tap.check("no blanks at the end of a line", bad_lines(TEXT, lambda s: s != s.rstrip()))
tap.check("no tabs in C and YAML", bad_lines(CODE + (".yaml",), lambda s: "\t" in s))
tap.check("sources are ASCII", bad_lines(CODE, lambda s: not s.isascii()))
tap.check("no path of one machine",
          bad_lines(TEXT + (".md",), lambda s: PLACES.search(TEMPORARY.sub("", s))))
tap.check("nothing left unfinished",
          bad_lines(CODE + (".yaml",), lambda s: UNFINISHED.search(s)))
long_files = [f"{p}: {n} lines" for p in sound(CODE + (".py", ".sh"))
              if (n := tap.read(p).count("\n")) > LENGTH]
tap.check("no source far beyond the length that reads well",
          [f for f in long_files if int(f.split()[-2]) > 1.5 * LENGTH])
for finding in long_files:
    print(f"# long: {finding}")
try:
    import yaml as pyyaml
    tap.check("YAML files parse, with no key twice", list(yaml_findings(pyyaml)))
except ImportError:
    print("# no PyYAML (Debian: python3-yaml): YAML files not parsed")
tap.done()
