"""Estimators of strangers (tests/plugins/estimator), built against the public headers alone: Latin
hypercubes, and two levels that are weighed by their costs. What they are told, what they may
report, and what is refused."""
import csv
import math
import os
import shlex
import statistics
import subprocess
import tempfile

from scenes import PLATE, column, content, runs_of, summary, table, write
from tap import GAMUT, ROOT, done, figure, gamut, report

BUDGET = 6e5
SOURCES = os.path.join(ROOT, "tests/plugins/estimator")
STRAINED = """gamut: 1
title: one point under uniaxial strain, linear in both of its moduli
solver: {model: material_driver, end: 0.1 ms, steps: 2, control: {xx: {strain_rate: -10 1/s}}}
materials:
  metal:
    density: 8000 kg/m3
    eos: {model: linear, bulk_modulus: {mean: 140 GPa, cv: 0.05}}
    strength: {model: none}
    elasticity: {model: hypoelastic, shear_modulus: {mean: 48 GPa, cv: 0.1}}
bodies:
  sample: {material: metal}
quantities:
  stress: {measure: stress_xx, body: sample, reduce: at end}
  history: {measure: stress_xx, body: sample, every: 0.05 ms}
"""


def build(root, name, changes=(), as_name=None):
    """Builds a plugin out of tree; with `changes`, a spoilt one under another name."""
    as_name = as_name or name
    home = os.path.join(root, "estimator", as_name)
    os.makedirs(home)
    for folder in (os.path.dirname(home), home):
        os.chmod(folder, 0o755)
    for ending in (".yaml", ".c", ".test.yaml"):
        with open(os.path.join(SOURCES, name, name + ending), encoding="utf-8") as file:
            text = file.read()
        for old, new in changes:
            text = text.replace(old, new)
        text = text.replace(name, as_name)
        with open(os.path.join(home, as_name + ending), "w", encoding="utf-8") as file:
            file.write(text)
    header = subprocess.run([GAMUT, "header", as_name + ".yaml"], cwd=home, check=True, text=True,
                            capture_output=True).stdout
    with open(os.path.join(home, as_name + ".gamut.h"), "w", encoding="utf-8") as file:
        file.write(header)
    subprocess.run([*shlex.split(os.environ.get("CC", "cc")), "-std=gnu11", "-O1", "-Wall",
                    "-Wextra", "-Werror", "-fPIC", "-shared", "-fopenmp-simd", "-I",
                    os.path.join(ROOT, "framework/include"), "-o", as_name + ".so",
                    as_name + ".c", "-lm"], cwd=home, check=True)
    return home


def normal_below(z):
    return 0.5 * math.erfc(-z / math.sqrt(2))


def stratum_means(size):
    """Means of a standard normal variable within each of `size` equally probable intervals."""
    ends = [statistics.NormalDist().inv_cdf(i / size) for i in range(1, size)]
    density = [0.0, *(math.exp(-z * z / 2) / math.sqrt(2 * math.pi) for z in ends), 0.0]
    return [size * (density[i] - density[i + 1]) for i in range(size)]


def rows_in(folder, name):
    with open(os.path.join(folder, name), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def hypercubes(root, folder):
    """The mean of a linear quantity varies by what the strata leave: 1 - sum of squares of their
    means / size, over that of independent runs."""
    size, cubes = 10, 200
    scene = write(folder, "strained.yaml", STRAINED + "uncertainty: {estimator: {model: "
                  f"latin_hypercube, size: {size}, hypercubes: {cubes}}}}}\n")
    out = os.path.join(folder, "strained")
    answer = gamut("--plugin-path", root, "run", scene, "-o", out)
    if not report(answer.code == 0, "200 Latin hypercubes of 10 runs", answer):
        return
    said = summary(out)
    stress, runs = said["quantities"]["stress"], size * cubes
    factor = 1 - sum(m * m for m in stratum_means(size)) / size
    ratio = stress["estimates"]["variance_ratio"]["value"]
    figure(abs(ratio / factor - 1), 4 * math.sqrt(2 / cubes),
           f"variance of the mean over plain sampling's: {ratio:.4f}, due {factor:.4f}, off by")
    figure(abs(ratio - stress["mean_error"] ** 2 / (stress["variance"] / runs)), 1e-12 * ratio,
           "the number is what mean_error and variance say")
    nominal = said["study"]["nominal"]["quantities"]["stress"]
    figure(abs(stress["mean"] - nominal), 4 * stress["mean_error"],
           "its mean is the value at the means, off by [Pa]")
    values = column(runs_of(out), "stress [Pa]")
    for name in ("materials.metal.eos.bulk_modulus [Pa]",
                 "materials.metal.elasticity.shear_modulus [Pa]"):
        strata = sorted(column(runs_of(out)[:size], name))
        mean, spread = (140e9, 7e9) if "bulk" in name else (48e9, 4.8e9)
        found = [int(size * normal_below((x - mean) / spread)) for x in strata]
        report(found == list(range(size)), f"a hypercube has one run in each stratum of {name}")
    where_reported(out, said, values, size, cubes)


def where_reported(out, said, values, size, cubes):
    """summary.json, CSV and results.h5 hold the same numbers."""
    means = [statistics.fmean(values[i * size:(i + 1) * size]) for i in range(cubes)]
    columns = said["study"]["tables"]["hypercubes"]["columns"]
    of_stress = [m for m, q in zip(columns["mean"]["values"], columns["quantity"]["values"])
                 if q == "stress"]
    figure(max(abs(a / b - 1) for a, b in zip(of_stress, means)), 1e-12,
           "study.tables of summary.json: means of the hypercubes, off by")
    listed = [float(r["mean"]) for r in rows_in(out, "table_hypercubes.csv")
              if r["quantity"] == "stress"]
    figure(max(abs(a - b) for a, b in zip(of_stress, listed)), 0, "table_hypercubes.csv: the same")
    estimates = rows_in(out, "estimates.csv")
    scalar = [r for r in estimates if r["quantity"] == "stress"]
    curve = [r for r in estimates if r["quantity"] == "history"]
    of_curve = said["quantities"]["history"]["estimates"]["variance_ratio"]["values"]
    figure(abs(float(scalar[0]["value"])
               - said["quantities"]["stress"]["estimates"]["variance_ratio"]["value"]), 0,
           "estimates.csv: the number of a scalar")
    report(len(scalar) == 1 and scalar[0]["at"] == "" and len(curve) == len(of_curve) == 3
           and [float(r["at"]) for r in curve] == said["quantities"]["history"]["times"],
           "estimates.csv: one a place of a curve")
    try:
        import h5py
    except ImportError:
        return
    with h5py.File(os.path.join(out, "results.h5")) as file:
        figure(max(abs(a - b) for a, b in
                   zip(file["study/tables/hypercubes/mean"][:], columns["mean"]["values"])), 0,
               "results.h5: the table")
        report(len(file["study/estimates/value"]) == 4, "results.h5: the numbers")


def two_levels(root, folder):
    """Pairs see one sample and realisation; samples are shared out by variance and work."""
    scene = write(folder, "levels.yaml", PLATE + f"""uncertainty:
  estimator: {{model: two_level, over: {{solver.cell: [2 mm, 0.5 mm]}}, pilot: 20, work: {BUDGET}}}
""")
    out = os.path.join(folder, "levels")
    answer = gamut("--plugin-path", root, "run", scene, "-o", out, "--threads", "2")
    if not report(answer.code == 0, "two levels", answer):
        return
    rows = runs_of(out)
    first = [row for row in table(out) if row["run"] == "-1"]
    nominal = [level["nominal"] for level in summary(out)["study"]["levels"]]
    report([row["level"] for row in first] == ["0", "1"]
           and [row["steps"] for row in first] == [str(n["steps"]) for n in nominal]
           and all({row["steps"] for row in rows if row["level"] == str(i)}
                   == {str(n["common_steps"])} for i, n in enumerate(nominal)),
           "one row -1 a level, whose steps the runs of the level share")
    pairs = [(a, b) for a, b in zip(rows, rows[1:]) if b["level"] == "1"]
    same = ["realisation", "materials.copper.density [kg/m3]", "materials.copper.eos.C0 [m/s]"]
    report(pairs and all(a["level"] == "0" and all(a[k] == b[k] for k in same) for a, b in pairs),
           f"{len(pairs)} pairs of one sample and one realisation each")
    peaks = [(float(a["peak [Pa]"]), float(b["peak [Pa]"])) for a, b in pairs]
    paired = {a["run"] for a, b in pairs} | {b["run"] for a, b in pairs}
    cheap = [float(r["peak [Pa]"]) for r in rows if r["run"] not in paired]
    mean = statistics.fmean(cheap) + statistics.fmean(b - a for a, b in peaks)
    error = math.sqrt(statistics.variance(cheap) / len(cheap)
                      + statistics.variance([b - a for a, b in peaks]) / len(peaks))
    said = summary(out)
    figure(abs(said["quantities"]["peak"]["mean"] / mean - 1), 1e-12, "mean of both terms, off by")
    figure(abs(said["quantities"]["peak"]["mean_error"] / error - 1), 1e-9, "its error, off by")
    columns = said["study"]["tables"]["levels"]["columns"]
    work = columns["work"]["values"]
    steps = [float(a["steps"]) + 4 * float(b["steps"]) for a, b in pairs]
    expected = statistics.fmean(steps) / statistics.fmean(
        [float(r["steps"]) for r in rows if r["run"] not in paired])
    figure(abs(work[1] / work[0] / expected - 1), 1e-12,
           f"work of a pair over a cheap run's is that of steps and points, {expected:.3g}, off by")
    pilot = ([x for x in cheap[:20]], [b - a for a, b in peaks[:20]])
    share = [math.sqrt(statistics.variance(values) / w) for values, w in zip(pilot, work)]
    budget = BUDGET / sum(s * w for s, w in zip(share, work))
    wanted = [max(20, budget * s) for s in share]
    figure(max(abs(n / w - 1) for n, w in zip(columns["samples"]["values"], wanted)), 0.1,
           f"samples by variance and work: {columns['samples']['values']}, off by")
    report(columns["samples"]["values"] == [len(cheap), len(pairs)], "as many were run")
    plain = os.path.join(folder, "plain")
    answer = gamut("run", scene, "-o", plain, "--set", "solver.cell=0.5 mm",
                   "--set", "uncertainty.estimator={model: monte_carlo, runs: 120}")
    fine = summary(plain)["quantities"]["peak"]
    figure(abs(fine["mean"] - mean), 4 * math.hypot(error, fine["mean_error"]),
           "the mean is that of the dear level, off by [Pa]")
    go_on(root, scene, out)
    explained = gamut("--plugin-path", root, "explain", scene)
    report(explained.code == 0 and "at least 60 runs" in explained.out,
           "explain knows that an adaptive estimator may ask for more", explained)


def go_on(root, scene, out):
    """What costs were told comes from the log: the same decisions, the same tables."""
    names = ("study.csv", "table_levels.csv")
    whole, lines = [content(out, name) for name in names], content(out, "study.log").split(b"\n")
    with open(os.path.join(out, "study.log"), "wb") as file:
        file.write(b"\n".join(lines[:-30]) + b"\n")
    answer = gamut("--plugin-path", root, "run", scene, "-o", out, "--resume")
    report(answer.code == 0 and [content(out, name) for name in names] == whole,
           "resumed: the same tables, bit for bit", answer)
    answer = gamut("--plugin-path", root, "run", scene, "-o", out, "--force", "--set",
                   "uncertainty.estimator={model: monte_carlo, runs: 2}")
    report(answer.code == 0 and not os.path.exists(os.path.join(out, "table_levels.csv")),
           "--force takes away the tables of the study before", answer)


def refused(root, folder):
    scene = write(folder, "refused.yaml", STRAINED + "uncertainty: {estimator: {model: "
                  "latin_hypercube, size: 4, hypercubes: 5}, failures: 0.5}\n")
    wide = gamut("--plugin-path", root, "run", scene, "-o", os.path.join(folder, "wide"), "--set",
                 "materials.metal.eos.bulk_modulus={mean: 140 GPa, cv: 0.9}")
    report(wide.code == 5 and "latin_hypercube can leave none out" in wide.said,
           "an estimator that can leave no run out: the first failure ends the study", wide)
    shown = gamut("--plugin-path", root, "show", "estimator/latin_hypercube")
    report("no run may fail" in shown.out and "knows beforehand" in shown.out,
           "show says what kind of estimator it is", shown)
    for what, old, new, words in (
            ("a name with a blank", '"variance_ratio", "1"', '"variance ratio", "1"',
             "that is no word"),
            ("a name twice", "  free(ratio);\n",
             '  report->number(report, 0, "variance_ratio", "1", 0, ratio);\n  free(ratio);\n',
             "it was reported before"),
            ("a column of nothing", ".number = mean}", ".number = NULL}",
             "either numbers or texts"),
            ("a mode that nobody knows", "    s->asked++;", "    batch->mode[0] = 7; s->asked++;",
             "a row of mode 7"),
            ("a level that is not there", "    s->asked++;", "    batch->level[0] = 1; s->asked++;",
             "level 1, which is not there")):
        name = "spoilt_" + "".join(c for c in what if c.isalpha())[:20]
        build(root, "latin_hypercube", [(old, new)], name)
        answer = gamut("--plugin-path", root, "run", scene, "-o", os.path.join(folder, name),
                       "--set", f"uncertainty.estimator.model={name}")
        report(answer.code == 4 and words in answer.said, f"{what}: exit 4, '{words}'", answer)
    home = build(root, "two_level", [("adaptive: true", "adaptive: false")], "not_adaptive")
    answer = gamut("verify", home)
    report(answer.code == 4 and any(line.startswith("not ok") and "adaptive: false" in line
                                    for line in answer.out.splitlines()),
           "verify finds out an estimator that decides by results and does not say so", answer)


with tempfile.TemporaryDirectory() as scratch:
    plugins = os.path.join(scratch, "plugins")
    for one in ("latin_hypercube", "two_level"):
        verified = gamut("verify", build(plugins, one))
        report(verified.code == 0, f"verify {one}", verified)
    hypercubes(plugins, scratch)
    two_levels(plugins, scratch)
    refused(plugins, scratch)
done()
