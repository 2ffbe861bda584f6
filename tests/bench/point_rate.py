"""How many points the material point method moves a second: by shape, threads, number of points and
part of the step, beside what memory and arithmetic of the machine give in the same minutes.

    GAMUT=build/gamut python3 tests/bench/point_rate.py [--whole] [--sizes] [--repeat N]

The case is inputs/taylor_bar_3d.yaml with a cell of 0.381 mm (168,112 points). Every figure is the
best of N runs (3), by processor time, so that a machine that others use as well disturbs little.
Prints Markdown. Not a test: nothing here depends on the clock of the machine that runs the tests.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TREE = os.path.dirname(os.path.dirname(HERE))
GAMUT = os.environ.get("GAMUT", os.path.join(TREE, "build", "gamut"))
SCENE = os.path.join(TREE, "inputs", "taylor_bar_3d.yaml")
CELL, EARLY, SHOT = 0.381, 3.6, 80.0  # mm, us (about 100 steps), us

# Parts of a step by the names of their functions.
PARTS = (("strength", r"johnson_cook"), ("equation of state", r"mie_gruneisen"),
         ("stress update", r"hypoelastic"), ("points to nodes", r"scatter|leave"),
         ("nodes to points", r"gather|renew_momentum"), ("places", r"locate_(linear|quadratic)"),
         ("nodes", r"grid_|update|second_block|planes|touch"),
         ("sorting", r"arrange|sort|locate_set|places_find"), ("measures", r"span|measure"))


def run(shape, end, threads=1, cell=CELL, folder=None):
    arguments = [GAMUT, "run", SCENE, "--no-user-plugins", "--threads", str(threads), "--force",
                 "-o", os.path.join(folder, "out"), "--set", f"solver.cell={cell} mm",
                 "--set", f"solver.end={end} us", "--set", f"solver.shape={shape}",
                 "--set", "outputs={frames: 1, fields: [velocity]}"]
    subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                   env={**os.environ, "OMP_WAIT_POLICY": "passive"})
    with open(os.path.join(folder, "out", "summary.json"), encoding="utf-8") as file:
        return json.load(file)["cost"]


def best(count, *arguments, **options):
    """Least processor time of `count` runs, and least time by the clock."""
    costs = [run(*arguments, **options) for _ in range(count)]
    cost = min(costs, key=lambda c: c["cpu_s"])
    work = cost["points"] * cost["steps"]
    return cost, work / cost["cpu_s"] / 1e6, work / min(c["wall_s"] for c in costs) / 1e6


def machine(folder, threads):
    program = os.path.join(folder, "machine")
    compiler = os.environ.get("CC", "cc")
    if not os.path.exists(program):
        subprocess.run([compiler, "-O3", "-march=native", "-mprefer-vector-width=512", "-fopenmp",
                        os.path.join(HERE, "machine.c"), "-o", program], check=True)
    said = subprocess.run([program], check=True, capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": str(threads)}).stdout.split()
    return f"{said[0]} GB/s by a triad, {said[1]} GFlop/s by fused multiply-adds"


def parts(shape, folder):
    """Share of each part of the step, by samples of perf."""
    if not shutil.which("perf"):
        return None
    data = os.path.join(folder, "perf.data")
    command = ["perf", "record", "-q", "-o", data, GAMUT, "run", SCENE, "--no-user-plugins",
               "--threads", "1", "--force", "-o", os.path.join(folder, "out"),
               "--set", f"solver.cell={CELL} mm", "--set", f"solver.end={EARLY} us",
               "--set", f"solver.shape={shape}"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if done.returncode != 0:
        return None
    lines = subprocess.run(["perf", "report", "-i", data, "--stdio", "-F", "overhead,dso,symbol"],
                           capture_output=True, text=True).stdout.splitlines()
    share = dict.fromkeys([name for name, _ in PARTS] + ["rest"], 0.0)
    for line in lines:
        found = re.match(r"\s*([\d.]+)%\s+(\S+)\s+\[.\]\s+(.*)", line)
        if not found:
            continue
        text = found.group(2) + " " + found.group(3)
        text = text.replace("material_point_method", "")
        share[next((name for name, like in PARTS if re.search(like, text)), "rest")] += \
            float(found.group(1))
    return share


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            text = file.read()
        return re.search(r"model name\s*:\s*(.*)", text).group(1)
    except (OSError, AttributeError):
        return "unknown processor"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--whole", action="store_true", help="the whole shot of 80 us as well")
    parser.add_argument("--sizes", action="store_true", help="from 1e4 to 1e7 points")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        print(f"{processor()}, {os.cpu_count()} processors, best of {options.repeat}\n")
        for threads in (1, 2):
            print(f"- {threads} thread{'s' if threads > 1 else ''}: {machine(folder, threads)}")
        print("\n| shape | part of the shot | threads | million point-steps a second of processor "
              "time | by the clock | ns a point-step and thread | bytes a point |")
        print("|---|---|---|---|---|---|---|")
        cases = [("first 100 steps", EARLY, t) for t in (1, 2)]
        if options.whole:
            cases.append(("whole, 80 us", SHOT, 1))
        for shape in ("linear", "quadratic"):
            for name, end, threads in cases:
                cost, rate, wall = best(options.repeat, shape, end, threads, folder=folder)
                print(f"| {shape} | {name} | {threads} | {rate:.2f} | {wall:.2f} | "
                      f"{1e3 / rate:.0f} | {cost['bytes_per_point']:.0f} |", flush=True)
        for shape in ("linear", "quadratic"):
            share = parts(shape, folder)
            if share:
                print(f"\nParts of the step, {shape}: " +
                      ", ".join(f"{name} {value:.0f} %" for name, value in share.items()))
        if options.sizes:
            print("\n| cell, mm | points | linear, ns a point-step | quadratic |")
            print("|---|---|---|---|")
            for cell in (1.0, 0.45, 0.21, 0.0975):
                end = EARLY * cell / CELL * (1.0 if cell > 0.2 else 0.3)
                found = [best(min(options.repeat, 2), shape, end, 1, cell, folder)
                         for shape in ("linear", "quadratic")]
                print(f"| {cell} | {found[0][0]['points']} | " +
                      " | ".join(f"{1e3 / rate:.0f}" for _, rate, _ in found) + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
