"""Parameters that hold others, by an effect of a stranger: lists, maps whose entries the scene
names, measures of one entry, values that may be written in several forms, members in place of
others."""
import csv
import os

import made
import scenes

SCENE = """gamut: 1
solver: {{model: material_driver, end: 1 us, steps: 2, control: {{xx: {{strain_rate: 1 1/s}}}}}}
materials:
  metal: {{density: 8 g/cm3, eos: {{model: linear, bulk_modulus: 100 GPa}}}}
bodies:
  point: {{material: metal}}
effects:
  tried: {{model: stations, {given}}}
quantities:
{quantities}
"""
TWO = ("stations: {left: {place: [3 m, 4 m, 0 m], side: far},"
       " right: {place: [0 m, 0 m, 2 m], weight: 7}}")
REST = TWO[len("stations: "):]
MANY = (TWO + ", steps: [{time: 0 s, factor: 2}, {time: 1 us, slope: 5 1/s},"
        " {time: 2 us, slope: 0.5 1/s, start: 40}], heights: [1 m, 250 mm], labels: [one, two]")

# What the scene gives, the measure with its arguments, the number that must come out.
RIGHT = (
    ("an entry's own number", MANY, "weight, station: right", 7),
    ("an entry's default", MANY, "weight, station: left", 1),
    ("a vector and a choice of an entry", MANY, "distance, station: left", -5),
    ("of another entry", MANY, "distance, station: right", 2),
    ("members of the entries of a list", MANY, "growth", 5.5),
    ("members in place of others", MANY, "factor", 42),
    ("a list of plain numbers", MANY, "height", 1.25),
    ("a list of words", MANY, "words", 2),
    ("one word is a list of one", TWO + ", labels: one", "words", 1),
    ("a list that is not given", TWO, "growth", 0),
    ("a form: a word", TWO + ", level: roof", "level", 10),
    ("a form: a number", TWO + ", level: 2500 mm", "level", 2.5),
    ("a form: a group, with its default", TWO + ", level: {first: 4 m}", "level", 7),
    ("no form", TWO, "level", -1),
)
# What the scene gives, the place of the fault, and words of its message.
WRONG = (
    ("{left: {place: [0 m, 0 m, 0 m], wieght: 1}}", "stations.left.wieght",
     "unknown key 'wieght' in 'left'", "did you mean 'weight'?"),
    ("{left: {weight: 1}}", "stations.left.place", "'place' is missing in 'left'"),
    ("{left: {place: [0 m, 0 m, 0 m], weight: -1}}", "stations.left.weight",
     "weight = -1 is not possible"),
    ("{left: {place: [0 m, 0 m, 0 m], weight: 101}}", "stations.left.weight", "'left' is too heavy",
     "at most 100"),
    ("{}", "stations", "'stations' has 0 entries", "at least 1"),
    ("{a: {}, b: {}, c: {}, d: {}}", "stations", "'stations' has 4 entries", "at most 3"),
    ("[{place: [0 m, 0 m, 0 m]}]", "stations", "'stations' is a list where a mapping is due"),
    ("{a b: {place: [0 m, 0 m, 0 m]}}", "stations.a b", "'a b' cannot be the name of an entry"),
    (REST + ", steps: {time: 1 s}", "steps", "'steps' is a mapping where a list is due"),
    (REST + ", steps: [{time: 1 s}]", "steps.0",
     "entry 0 of 'steps' lacks one of its alternatives", "factor, or slope with start"),
    (REST + ", steps: [{time: 1 s, factor: 1, slope: 2 1/s}]", "steps.0.slope",
     "'factor' and 'slope' are both given in entry 0 of 'steps'", "factor, or slope with start"),
    (REST + ", steps: [{time: 1 s, start: 2}]", "steps.0.slope",
     "'slope' is missing in entry 0 of 'steps'"),
    (REST + ", steps: [{factor: 2}]", "steps.0.time", "'time' is missing in entry 0 of 'steps'"),
    (REST + ", heights: [1 m, 2]", "heights.1", "heights: '2' has no unit"),
    (REST + ", heights: 1 m", "heights", "'heights' is a plain value where a list is due"),
    (REST + ", labels: [one, two, one]", "labels.2", "'one' stands twice in 'labels'"),
    (REST + ", level: rof", "level", "level: 'rof' is no number"),
    (REST + ", level: 3 s", "level", "level: '3 s' has a unit of another dimension"),
    (REST + ", level: [3 m]", "level", "'level' cannot be a list", "ground or roof; or a height"),
    (REST + ", level: {frist: 3 m}", "level.frist", "unknown key 'frist' in 'level'",
     "did you mean 'first'?"),
)


def asked_text(given, quantities):
    return SCENE.format(given=given, quantities=quantities)


def asked(given, quantities):
    return scenes.written("nested", asked_text(given, quantities))


def right(folder):
    for name, given, measure, wanted in RIGHT:
        scene = asked(given, f"  asked: {{measure: {measure}, reduce: at end}}")
        process, result = scenes.attempt(scene, extra=("--plugin-path", folder))
        found = None
        if process.returncode == 0:
            found = scenes.read(result, process).value("asked")
        scenes.report(found == wanted, f"{name}: {measure} is {found} ({wanted})", [process.stderr])


def refused(scene, folder, words):
    process, _ = scenes.attempt(scene, extra=("--plugin-path", folder))
    code, said = process.returncode, process.stderr
    scenes.report(code == 3 and all(w in said for w in words),
                  f"exit {code} (3), {words[0]}", [said])


def wrong(folder):
    for given, path, *words in WRONG:
        refused(asked("stations: " + given, "  asked: {measure: words}"), folder,
                [*words, f"(effects.tried.{path})"])
    refused(asked(TWO, "  asked: {measure: weight, station: lift}"), folder,
            ["station: unknown choice 'lift'", "did you mean 'left'?",
             "(quantities.asked.station)"])


def drawn(folder):
    """A number of an entry may be random, and has its path."""
    given = TWO.replace("weight: 7", "weight: {distribution: uniform, lower: 2, upper: 5}")
    path = "effects.tried.stations.right.weight"
    scene = scenes.written("random", asked_text(
        given, "  asked: {measure: weight, station: right, reduce: at end}")
        + "uncertainty: {estimator: {model: monte_carlo, runs: 3}, seed: 1}\n")
    process, result = scenes.attempt(scene, extra=("--plugin-path", folder))
    rows = []
    if process.returncode == 0:
        with open(os.path.join(result, "study.csv"), encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["status"] == "ok"]
    weights = {row[path] for row in rows if row[path] == row["asked"]}
    scenes.report(len(weights) == 3, f"{path}: {len(weights)} weights of runs are measured (3)",
                  [process.stderr])


def main():
    folder = made.of_tree("effect/stations")
    right(folder)
    drawn(folder)
    wrong(folder)
    scenes.done()


main()
