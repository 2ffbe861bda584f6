"""Studies: tables against single runs and against moments taken here, bits, failures, draws."""
import csv
import math
import os
import re
import tempfile
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import needs  # noqa: E402

needs.modules("h5py", "numpy")
import h5py  # noqa: E402
import numpy  # noqa: E402

from scenes import (DRIVER, PLATE, STRENGTH, column, content, runs_of, summary, table,
                    write)
from tap import done, figure, gamut, report


def relative(got, expected):
    return abs(got - expected) / abs(expected)


def nothing_random(folder):
    fixed = re.sub(r"\{mean: ([^,]*),[^}]*\}", r"\1", DRIVER)
    aside = fixed.replace("8000 kg/m3", "{mean: 8000 kg/m3, cv: 0.01}")
    alike = "4 runs gave the same values to the last bit: no quantity depends on what is random"
    for name, text, words in (
            ("fixed", fixed, "no parameter of the scene is random: every run will be the same"),
            ("aside", aside, alike)):
        scene = write(folder, name + ".yaml", text
                      + "uncertainty: {estimator: {model: monte_carlo, runs: 4}}\n")
        answer = gamut("run", scene, "-o", os.path.join(folder, name))
        report(answer.code == 0 and words in answer.said,
               f"a study that varies nothing says so: {words}", answer)


MOMENTS = ("mean", "variance", "mean_error", "variance_error", "mean_interval",
           "variance_interval")


def sweep_is_no_sample(said, rows, out):
    """No moments anywhere; the values and one labelled curve a level in every file."""
    peak, curve = said["quantities"]["peak"], said["quantities"]["pressure"]
    many = {key: key + "s" if key != "variance" else "variances" for key in MOMENTS}
    report(all(peak[key] is None for key in MOMENTS)
           and all(curve[many[key]] is None for key in MOMENTS),
           "a sweep has no moments: null under every key")
    levels = said["study"]["levels"]
    figure(max(abs(level["quantities"]["peak"] - float(row["peak [Pa]"]))
               for level, row in zip(levels, rows)), 0, "the values of the levels are the rows'")
    with open(os.path.join(out, "history.csv"), encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    with h5py.File(os.path.join(out, "results.h5")) as file:
        group = file["study/curves/pressure"]
        worst = 0
        for number, level in enumerate(levels):
            own = group[f"{number:08d}"]
            values = level["quantities"]["pressure"]["values"]
            listed = [float(line["value"]) for line in lines if line["run"] == str(number)]
            report(own.attrs["label"] in (level["label"], level["label"].encode())
                   and {line["label"] for line in lines if line["run"] == str(number)}
                   == {level["label"]}, f"level {number} is labelled '{level['label']}'")
            worst = max(worst, numpy.abs(own["value"][:] - values).max(),
                        numpy.abs(numpy.array(listed) - values).max())
    figure(worst, 0, "curves of the levels: results.h5, history.csv and summary.json differ by")
    report("inf" not in content(out, "history.csv").decode()
           and not re.search(r"\b(inf|nan|NaN|Infinity)\b",
                             content(out, "summary.json").decode()),
           "no inf and no nan in tables or JSON")
    answer = gamut("plot", out)
    with open(os.path.join(out, "pictures/history_pressure.gp"), encoding="utf-8") as file:
        script = file.read()
    report((answer.code == 0 or "gnuplot was not found" in answer.said)
           and all(f"'{level['label']}'" in script for level in levels),
           "the picture has a labelled curve a level", answer)


def agree(folder, scene, what, due, options=(), words=""):
    """`check` ends as `run` does, and has said why."""
    given = [word for option in options for word in ("--set", option)]
    run = gamut("run", scene, "-o", os.path.join(folder, "agree"), "--force", *given)
    check = gamut("check", scene, *given)
    report(check.code == run.code == due and words in check.said,
           f"{what}: check ends with {check.code}, run with {run.code} (due {due})", check)
    return check


def unplanned_base(folder):
    """What a plugin refuses of the scene below the levels is nothing to `check` either, and levels
    that cannot be planned are weighed as `run` does."""
    linear = PLATE.replace("cell: 1 mm", "cell: 1 mm, shape: linear, transfer: {model: apic}")
    scene = write(folder, "unplanned.yaml", linear
                  + "uncertainty: {estimator: {model: sweep, over: {solver.shape: [gimp]}}}\n")
    alone = gamut("check", scene, "--set", "uncertainty.estimator=off")
    report(alone.code == 3, "check refuses a base that a plugin refuses", alone)
    for shapes, share, due in (("gimp", 0.1, 0), ("linear, gimp", 0.5, 0), ("linear, gimp", 0.1, 5),
                               ("gimp, gimp, linear", 0.4, 0), ("gimp, gimp, linear", 0.3, 5),
                               ("linear, linear", 0.5, 3)):
        check = agree(folder, scene, f"a sweep over {shapes}, failures {share}", due,
                      [f"uncertainty.estimator.over={{solver.shape: [{shapes}]}}",
                       f"uncertainty.failures={share}"])
        told = check.said.count("cannot be run")
        report(told == {0: "linear" in shapes, 5: 2, 3: 0}[due], f"levels told of: {told}",
               check)
    explained = gamut("explain", scene, "--set",
                      "uncertainty.estimator.over={solver.shape: [linear, gimp]}")
    report(explained.code == 0, "explain takes the first level that can be planned", explained)


def unread_base(folder):
    """What cannot be read of the scene below the levels neither: the first level stands for it."""
    over = "uncertainty: {estimator: {model: sweep, over: {solver.cell: [1 mm, 2 mm]}}}\n"
    for what, cell in (("without a cell", ""), ("with a cell of no size", "cell: 0 mm, "),
                       ("with a cell in seconds", "cell: 1 s, ")):
        scene = write(folder, "unread.yaml", PLATE.replace("cell: 1 mm, ", cell) + over)
        alone = gamut("check", scene, "--set", "uncertainty.estimator=off")
        report(alone.code == 3, f"a base {what} is refused", alone)
        agree(folder, scene, f"a sweep over cells, base {what}", 0)
        explained = gamut("explain", scene)
        report(explained.code == 0, "explain reads it", explained)
    agree(folder, scene, "levels that do not mend it", 3,
          ["uncertainty.estimator.over={solver.courant: [0.2, 0.3]}"], "solver.cell")
    agree(folder, scene, "a level that cannot be read", 3,
          ["uncertainty.estimator.over={solver.cell: [1 mm, 2 s]}"], "2 s")
    agree(folder, scene, "a path that leads nowhere", 3,
          ["uncertainty.estimator.over={solver.cell.size: [1 mm]}"], "solver.cell")


def unstarted_levels(folder):
    """Levels that only the start can refuse: a wall within a body, from the second level on."""
    wall = "  wall: {model: rigid_wall, plane: {point: [0 mm], normal: [1]}}\n"
    walled = PLATE.replace("  viscosity:", wall + "  viscosity:")
    scene = write(folder, "unstarted.yaml", walled + """uncertainty:
  estimator: {model: sweep, over: {effects.wall.plane.point: [[0 mm], [5 mm]]}}
""")
    agree(folder, scene, "a level that cannot start", 5, (), "cannot be run")
    agree(folder, scene, "the same where half may fail", 0, ["uncertainty.failures=0.5"],
          "cannot be run")
    agree(folder, scene, "no level that can start", 5,
          ["uncertainty.estimator.over={effects.wall.plane.point: [[4 mm], [5 mm]]}"])


def sweep_without_base(folder):
    """The scene below the levels is no member: that it fails is nothing to the sweep."""
    scene = write(folder, "base.yaml", PLATE.replace("cell: 1 mm", "cell: 1 mm, step: 1 us")
                  + """uncertainty:
  estimator: {model: sweep, over: {solver.step: [20 ns, 30 ns]}}
""")
    out = os.path.join(folder, "base")
    single = gamut("run", scene, "-o", os.path.join(folder, "alone"), "--set",
                   "uncertainty.estimator=off")
    report(single.code == 5, "the base scene alone fails", single)
    answer = gamut("run", scene, "-o", out)
    rows = table(out)
    report(answer.code == 0 and [r["status"] for r in rows] == ["ok", "ok"]
           and [r["run"] for r in rows] == ["0", "1"], "its sweep does not", answer)
    unplanned_base(folder)
    unread_base(folder)
    unstarted_levels(folder)
    scene = write(folder, "first.yaml", PLATE + """uncertainty:
  failures: 0.5
  estimator: {model: sweep, over: {solver.step: [1 us, 20 ns]}}
""")
    out = os.path.join(folder, "first")
    answer = gamut("run", scene, "-o", out)
    levels = summary(out)["study"]["levels"]
    report(answer.code == 0 and [level["status"] for level in levels] == ["failed", "ok"]
           and len(levels[1]["quantities"]["pressure"]["times"]) == 41
           and levels[0]["quantities"]["pressure"] is None,
           "a first member that fails leaves the others their axes", answer)
    answer = gamut("run", scene, "-o", out, "--resume")
    report(answer.code == 0 and summary(out)["study"]["levels"] == levels,
           "resumed: the curves of the levels come from the log", answer)


def sweep_grid(folder):
    scene = write(folder, "sweep.yaml", PLATE + """uncertainty:
  estimator:
    model: sweep
    over:
      solver.cell: [2 mm, 1 mm]
      bodies.flyer.velocity: [[300 m/s], [400 m/s], [500 m/s]]
""")
    out = os.path.join(folder, "sweep")
    answer = gamut("run", scene, "-o", out)
    if not report(answer.code == 0, "a sweep over cells and velocities runs", answer):
        return
    rows = table(out)
    report([(r["solver.cell"], r["bodies.flyer.velocity"]) for r in rows]
           == [(c, f"[{v} m/s]") for c in ("2 mm", "1 mm") for v in (300, 400, 500)],
           "a grid of six, the last path fastest")
    worst = 0
    for row in (rows[0], rows[5]):
        single = gamut("run", scene, "--json", "-o", os.path.join(folder, "single"), "--force",
                       "--set", "solver.cell=" + row["solver.cell"], "--set",
                       "bodies.flyer.velocity=" + row["bodies.flyer.velocity"], "--set",
                       "uncertainty={}")
        report("2 random parameters are taken at their mean" in single.said,
               "without an estimator a run says that it takes the means", single)
        for name in ("peak", "arrival"):
            value = single.json()["quantities"][name]["value"]
            key = next(k for k in row if k.split(" ")[0] == name)
            worst = max(worst, abs(value - float(row[key])))
    figure(worst, 0, "a row of a sweep is the single run, difference")
    said = summary(out)
    sweep_is_no_sample(said, rows, out)
    report(said["study"]["levels"][1]["set"]["bodies.flyer.velocity"] == "[400 m/s]"
           and said["study"]["asked"] == said["study"]["done"] == 6, "summary: levels and runs")
    answer = gamut("run", scene, "-o", os.path.join(folder, "zip"), "--set",
                   "uncertainty.estimator.combine=zip", "--set",
                   "uncertainty.estimator.over="
                   "{solver.cell: [2 mm, 1 mm], solver.end: [1 us, 2 us]}")
    rows = table(os.path.join(folder, "zip")) if answer.code == 0 else []
    report([(r["solver.cell"], r["solver.end"]) for r in rows] == [("2 mm", "1 us"),
                                                                   ("1 mm", "2 us")],
           "side by side", answer)
    ends = [level["quantities"]["pressure"]["times"][-1]
            for level in summary(os.path.join(folder, "zip"))["study"]["levels"]]
    figure(max(abs(ends[0] - 1e-6), abs(ends[1] - 2e-6)), 1e-12,
           "each level has its own curve to its own end, off by")


def moments(values):
    """Mean, variance and their standard errors, in numpy."""
    n = len(values)
    mean, variance = numpy.mean(values, 0), numpy.var(values, 0, ddof=1)
    fourth = numpy.mean((values - mean) ** 4, 0)
    return mean, variance, numpy.sqrt(variance / n), numpy.sqrt(
        (fourth - (n - 3) / (n - 1) * variance ** 2) / n)


def monte_carlo(folder):
    scene = write(folder, "plate.yaml", PLATE + "uncertainty: {estimator: {model: monte_carlo, "
                  "runs: 20}, seed: 3, step_margin: off}\n")
    out = [os.path.join(folder, f"threads_{n}") for n in (1, 2, 3)]
    for n, one in enumerate(out, 1):
        answer = gamut("run", scene, "-o", one, "--threads", str(n), "--json")
        if not report(answer.code == 0, f"monte_carlo of 20 plates, {n} side by side", answer):
            return
    for name in ("study.csv", "history.csv"):
        report(content(out[0], name) == content(out[1], name) == content(out[2], name),
               f"{name}: same bits for 1, 2 and 3 threads")
    said = summary(out[0])
    report(all(summary(one)["quantities"] == said["quantities"] for one in out),
           "summary.json: the same numbers")
    keys = ("mean", "variance", "mean_error", "variance_error")
    peaks = numpy.array(column(table(out[0]), "peak [Pa]"))
    for key, expected in zip(keys, moments(peaks)):
        figure(relative(said["quantities"]["peak"][key], expected), 1e-9, f"{key} of the peak")
    with h5py.File(os.path.join(out[0], "results.h5")) as file:
        curve = file["study/curves/pressure"]
        at = int(numpy.argmax(curve["mean"][:]))
        for key, expected in zip(keys, moments(curve["runs"][:])):
            figure(relative(curve[key][at], expected[at]), 1e-9, f"{key} of the curve at its top")
        report(len(file["study/quantities/peak"]) == 20 and
               file["study/parameters/materials.copper.eos.C0"].attrs["unit"] in ("m/s", b"m/s"),
               "results.h5: columns with units")
        report([s.decode() for s in file["study/status"][:]] == ["ok"] * 20, "results.h5: status")
    row = runs_of(out[0])[7]
    single = gamut("run", scene, "--json", "-o", os.path.join(folder, "one"), "--set",
                   "uncertainty={}", "--set", "materials.copper.density="
                   f"{row['materials.copper.density [kg/m3]']} kg/m3", "--set",
                   f"materials.copper.eos.C0={row['materials.copper.eos.C0 [m/s]']} m/s")
    figure(relative(single.json()["quantities"]["peak"]["value"], peaks[7]), 0,
           "run 7 is the single run with its parameters")
    answer = gamut("plot", out[0])
    report(answer.code == 0 or "gnuplot was not found" in answer.said, "plot of a study", answer)
    with open(os.path.join(out[0], "pictures/history_pressure.gp"), encoding="utf-8") as file:
        report("filledcurves" in file.read(), "the mean has its band")


def draws(folder):
    """Correlation and laws of what was drawn, within four standard errors."""
    runs = 400
    scene = write(folder, "draws.yaml", DRIVER + f"""uncertainty:
  estimator: {{model: monte_carlo, runs: {runs}}}
  correlation: [[{STRENGTH}yield_stress, {STRENGTH}hardening_modulus, 0.6]]
""")
    out = os.path.join(folder, "draws")
    answer = gamut("run", scene, "-o", out)
    if not report(answer.code == 0, "400 runs of one point", answer):
        return
    rows = table(out)
    stress = numpy.array(column(rows, STRENGTH + "yield_stress [Pa]"))
    modulus = numpy.array(column(rows, STRENGTH + "hardening_modulus [Pa]"))
    density = numpy.array(column(rows, "materials.metal.density [kg/m3]"))
    sigma = math.sqrt(math.log(1.01))
    normal = (numpy.log(stress / 90e6) + sigma ** 2 / 2) / sigma
    error = 1 / math.sqrt(runs)
    figure(abs(numpy.corrcoef(normal, modulus)[0, 1] - 0.6), 4 * (1 - 0.36) * error,
           "correlation of the normal variables, off by")
    figure(abs(numpy.corrcoef(density, modulus)[0, 1]), 4 * error, "no correlation where none is")
    figure(abs(normal.mean()), 4 * error, "lognormal: mean of its normal variable")
    figure(abs(normal.std() - 1), 4 * error / math.sqrt(2), "lognormal: deviation, off by")
    figure(abs(modulus.mean() / 300e6 - 1), 4 * 0.2 * error, "normal: mean, off by")
    figure(abs(density.std() / 80 - 1), 4 * error / math.sqrt(2), "random density: deviation")
    more = os.path.join(folder, "more")
    gamut("run", scene, "-o", more, "--set", "uncertainty.estimator.runs=10")
    report(table(more) == rows[:11], "the first runs of a longer study are those of a shorter one")


def failures(folder):
    scene = write(folder, "fail.yaml", PLATE + """uncertainty:
  estimator: {model: sweep, over: {solver.step: [20 ns, 30 ns, 40 ns, 1 us]}}
""")
    out = os.path.join(folder, "fail")
    answer = gamut("run", scene, "-o", out, "--json")
    said = answer.json()
    report(answer.code == 5 and "1 of 4 runs failed" in answer.said,
           "more failed runs than allowed: exit 5", answer)
    report(said["status"] == "failed" and said["quantities"]["peak"]["mean"] is None,
           "then there are no moments", answer)
    answer = gamut("run", scene, "-o", out, "--force", "--set", "uncertainty.failures=0.25")
    rows = table(out)
    report(answer.code == 0 and [r["status"] for r in rows] == ["ok", "ok", "ok", "failed"],
           "a share may fail", answer)
    report("energy was created" in rows[3]["reason"] and rows[3]["peak [Pa]"] == "",
           "a failed run stays in the table with its reason")
    said = summary(out)["study"]
    report(said["failed"] == 1 and said["done"] == 3 and said["reasons"][0]["runs"] == [3],
           "summary: who failed")
    wide = DRIVER.replace("cv: 0.1, distribution: lognormal", "cv: 0.7")
    scene = write(folder, "range.yaml", wide +
                  "uncertainty: {estimator: {model: monte_carlo, runs: 40}, failures: 0.5}\n")
    answer = gamut("run", scene, "-o", os.path.join(folder, "range"))
    rows = table(os.path.join(folder, "range"))
    bad = [r for r in rows if float(r[STRENGTH + "yield_stress [Pa]"]) < 0]
    report(answer.code == 0 and bad and all("yield_stress" in r["reason"] for r in bad)
           and all(r["status"] in ("ok", "nominal") for r in rows if r not in bad),
           f"{len(bad)} draws outside the physical range fail by name, no other", answer)
    said = summary(os.path.join(folder, "range"))
    report("conditional" in said["study"]["note"] and "are conditional" in answer.out
           and "gave no value" in said["quantities"]["strength"]["conditional"],
           "then statistics say that they are conditional", answer)


def without(folder):
    scene = write(folder, "plain.yaml", DRIVER)
    answer = gamut("run", scene, "-o", os.path.join(folder, "plain"), "--retry-failed")
    report(answer.code == 2 and "uncertainty.estimator" in answer.said,
           "--retry-failed of a scene that is no study: exit 2", answer)


with tempfile.TemporaryDirectory() as scratch:
    nothing_random(scratch)
    sweep_grid(scratch)
    sweep_without_base(scratch)
    monte_carlo(scratch)
    draws(scratch)
    failures(scratch)
    without(scratch)
done()
