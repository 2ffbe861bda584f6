"""The table of docs/results/studies.md on common time steps: runs that fail by margin and scatter,
and how smooth the peak is over what was drawn. GAMUT names the program."""
import csv
import math
import os
import subprocess
import tempfile

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "../../inputs/plate_impact.yaml")
RUNS = 200


def study(folder, margin, spread):
    """Steps, failed runs, deviation of the peak, and of what a square of C0 leaves of it."""
    out = os.path.join(folder, "study")
    done = subprocess.run(
        [os.environ.get("GAMUT", "gamut"), "run", SCENE, "-o", out, "--force",
         "--set", "solver.cell=0.4 mm",
         "--set", f"materials.copper.eos.C0={{mean: 3940 m/s, cv: {spread}}}",
         "--set", f"uncertainty={{estimator: {{model: monte_carlo, runs: {RUNS}}}, "
         f"failures: 0.99, step_margin: {margin}}}"], check=False, capture_output=True)
    if done.returncode not in (0, 5):
        raise SystemExit(done.stderr.decode())
    with open(os.path.join(out, "study.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))[1:]
    good = [row for row in rows if row["status"] == "ok"]
    if len(good) < 10:
        return None, len(rows) - len(good), None, None
    speed = numpy.array([float(row["materials.copper.eos.C0 [m/s]"]) for row in good]) / 3940 - 1
    name = next(key for key in good[0] if key.endswith("[Pa]"))
    peak = numpy.array([float(row[name]) for row in good])
    terms = numpy.stack([numpy.ones_like(speed), speed, speed ** 2], 1)
    rest = peak - terms @ numpy.linalg.lstsq(terms, peak, rcond=None)[0]
    steps = numpy.mean([int(row["steps"]) for row in good])
    return steps, len(rows) - len(good), peak.std() / peak.mean(), \
        math.sqrt(numpy.mean(rest ** 2)) / peak.mean()


with tempfile.TemporaryDirectory() as scratch:
    for cv in (0.01, 0.03, 0.1):
        for share in ("off", 0, 0.1, 0.2):
            mean, failed, deviation, left = study(scratch, share, cv)
            figures = "| {:.0f} | {} | {:.2f} | {:.3f} |" if mean else "| | {1} | | |"
            print(f"| {cv} | {share} " + figures.format(mean, failed, 100 * (deviation or 0),
                                                        100 * (left or 0)), flush=True)
