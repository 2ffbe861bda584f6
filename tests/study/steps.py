"""Common steps of a study's runs: who takes them, who cannot, and what --resume makes of them."""
import math
import os
import re
import tempfile

from scenes import DRIVER, PLATE, column, content, runs_of, summary, table, write
from tap import done, figure, gamut, report

C0 = "materials.copper.eos.C0 [m/s]"
MEAN = 3940.0
AT_REST = PLATE.replace("velocity: [500 m/s]", "velocity: [0 m/s]")
REASON = re.compile(r"needs a step of (\S+) s or less, but all runs of the study take one of "
                    r"(\S+) s here \(step 1\)")


def study(folder, name, base, options, *arguments):
    """Of a Monte Carlo study: what it said, and its folder."""
    scene = write(folder, name + ".yaml", base + "uncertainty: {estimator: {model: monte_carlo, "
                  f"runs: 12}}, seed: 3, failures: 0.9{options}}}\n")
    out = os.path.join(folder, name)
    return gamut("run", scene, "-o", out, *arguments), out


def shared(folder):
    """All runs take the steps of the run at the means, shorter by the margin."""
    answer, out = study(folder, "shared", PLATE, "", "--threads", "1")
    again, other = study(folder, "again", PLATE, "", "--threads", "2")
    report(answer.code == again.code == 0, "a study with common steps", answer)
    report(content(out, "study.csv") == content(other, "study.csv")
           and content(out, "history.csv") == content(other, "history.csv"),
           "the same bits for 1 and 2 threads")
    nominal, steps = table(out)[0], {row["steps"] for row in runs_of(out)}
    report(nominal["run"] == "-1" and nominal["level"] == "0" and len(steps) == 1,
           f"12 runs of {steps} steps each, after row -1")
    ratio = float(nominal["steps"]) / float(next(iter(steps), "1"))
    figure(abs(ratio / 0.8 - 1), 0.06, "steps of the run at the means over theirs, 0.8, off by")
    said = summary(out)["study"]["nominal"]
    report(str(said["common_steps"]) in steps, "the summary has their number")
    _, own = study(folder, "own", PLATE, ", step_margin: off")
    report(len({row["steps"] for row in runs_of(own)}) > 1
           and "common_steps" not in summary(own)["study"]["nominal"],
           "step_margin off: each run takes its own")


def too_long(folder):
    """Material at rest needs a step of cell over sound speed, so the number due is known."""
    answer, out = study(folder, "long", AT_REST, ", step_margin: 0")
    rows = runs_of(out)
    fast = [row for row in rows if float(row[C0]) > MEAN]
    report(answer.code == 0 and 0 < len(fast) < len(rows)
           and all((row["status"] == "failed") == (row in fast) for row in rows),
           f"without a margin the {len(fast)} runs of faster sound fail, no other", answer)
    reasons = [REASON.search(row["reason"]) for row in fast]
    if not report(all(reasons), "they say which step they need, and which is given"):
        return
    figure(max(abs(float(r.group(1)) / float(r.group(2)) * float(row[C0]) / MEAN - 1)
               for r, row in zip(reasons, fast)), 1e-5,
           "the step needed over the one given is the sound speed at the means over theirs, off by")
    _, out = study(folder, "enough", AT_REST, "")
    report(all(row["status"] == "ok" for row in runs_of(out)), "with a margin of 0.2 none fails")


def resumed(folder):
    """The log may end anywhere: before the steps, between them and their run, or behind it."""
    _, out = study(folder, "whole", PLATE, "")
    names = ("study.csv", "history.csv")
    whole, lines = [content(out, name) for name in names], content(out, "study.log").split(b"\n")
    kinds = [line.split(b" ")[0] for line in lines]
    at = kinds.index(b"steps")
    report(kinds.count(b"steps") == 1 and kinds[at + 1] == b"nominal",
           "the log has the steps once, before the run that they come from")
    for kept, what in ((at, "before"), (at + 1, "behind"), (at + 2, "behind the run of")):
        with open(os.path.join(out, "study.log"), "wb") as file:
            file.write(b"\n".join(lines[:kept]) + b"\n")
        answer = gamut("run", os.path.join(folder, "whole.yaml"), "-o", out, "--resume")
        report(answer.code == 0 and [content(out, name) for name in names] == whole,
               f"cut off {what} the steps and resumed: the same tables, bit for bit", answer)
    answer = gamut("run", os.path.join(folder, "whole.yaml"), "-o", out, "--resume", "--set",
                   "uncertainty.step_margin=0.3")
    report(answer.code == 7, "not resumed with another margin: exit 7", answer)


def stated(folder):
    """Where the scene or the solver states the steps there is nothing to share."""
    answer, out = study(folder, "driver", DRIVER, "")
    report(answer.code == 0 and {row["steps"] for row in table(out)} == {"20"}
           and "common_steps" not in summary(out)["study"]["nominal"],
           "material_driver: the steps of the scene", answer)
    answer, out = study(folder, "fixed", PLATE.replace("cell: 1 mm", "cell: 1 mm, step: 50 ns"), "")
    report(answer.code == 0 and {row["steps"] for row in table(out)} == {"40"}
           and len(column(table(out), "peak [Pa]")) == 12, "solver.step: as stated", answer)


def forecast(folder):
    """explain counts the margin in. How fast a run is it measures anew each time."""
    for margin, longer in (("off", 1), ("0.5", 2)):
        scene = write(folder, "forecast.yaml", PLATE.replace("cell: 1 mm", "cell: 0.02 mm")
                      + "uncertainty: {estimator: {model: monte_carlo, runs: 1000}, "
                      f"step_margin: {margin}}}\n")
        answer = gamut("explain", scene, "--json")
        said = answer.json() or {}
        one, whole = said["seconds"], said["study"]
        due = longer * math.ceil(1000 / whole["threads"]) + 1
        figure(abs(whole["seconds"] / one / due - 1), 1e-9,
               f"step_margin {margin}: explain counts {due} runs' time, off by")


with tempfile.TemporaryDirectory() as scratch:
    shared(scratch)
    too_long(scratch)
    resumed(scratch)
    stated(scratch)
    forecast(scratch)
done()
