"""How many points the material point method moves a second: by shape, threads, number of points and
part of the step, beside what memory and arithmetic of the machine give in the same minutes.

    GAMUT=build/gamut python3 tests/bench/point_rate.py [--whole] [--sizes] [--parts]
        [--threads N] [--shapes linear,quadratic] [--repeat N]

The case is inputs/taylor_bar_3d.yaml with a cell of 0.381 mm (168,112 points). Every figure is the
best of N runs (3), by processor time, so that a machine that others use as well disturbs little;
what two threads give is by the clock, and needs both cores free. Prints Markdown. Not a test:
nothing here depends on the clock of the machine that runs the tests (that is
tests/verification/work.py, which counts).
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
# Courant numbers of the whole shot: that of the scene, and the longest that the shape bears well.
LONG = {"linear": 1.0, "quadratic": 0.65, "gimp": 0.65, "cubic": 0.65}
USUAL = 0.5
SIZES = (1.0, 0.45, 0.21, 0.0975)  # cells in mm, of 9 thousand to 10 million points

# Parts of a step by the names of their functions.
PARTS = (("strength", r"johnson_cook"), ("equation of state", r"mie_gruneisen"),
         ("stress update", r"hypoelastic"), ("points to nodes", r"scatter|leave|finish"),
         ("nodes to points", r"gather|renew|move|grid_load"), ("places", r"locate_(?!range)"),
         ("nodes", r"grid_|update|project|settle|divide|planes|touch"),
         ("sorting", r"permute|arrange|sort|locate_range|places_|place_points"),
         ("measures", r"edges_of|span|measure"),
         ("tables and copies", r"scratch_|memmove|memcpy|memset|image_follow|fill_argument"))


def scene(shape, end, cell, courant):
    return ["--set", f"solver.cell={cell} mm", "--set", f"solver.end={end} us",
            "--set", f"solver.shape={shape}", "--set", f"solver.courant={courant}",
            "--set", "outputs={frames: 1, fields: [velocity]}",
            "--set", "quantities={length: {measure: extent, body: bar, axis: y, reduce: at end}}"]


def run(shape, end, threads=1, cell=CELL, courant=USUAL, folder=None):
    arguments = [GAMUT, "run", SCENE, "--no-user-plugins", "--threads", str(threads), "--force",
                 "-o", os.path.join(folder, "out"), *scene(shape, end, cell, courant)]
    # threads that wait spin a little, then leave the core to others
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          check=False, env={"GOMP_SPINCOUNT": "10000", **os.environ})
    if done.returncode != 0:
        sys.exit(done.stderr[-2000:])
    with open(os.path.join(folder, "out", "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return {**summary["cost"], "length": summary["quantities"]["length"]["value"]}


def best(count, *arguments, **options):
    """The run of `count` with the least processor time; point-steps a second of that, and of the
    run with the least time by the clock."""
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
               *scene(shape, EARLY, CELL, USUAL)]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          check=False)
    if done.returncode != 0:
        return None
    lines = subprocess.run(["perf", "report", "-i", data, "--stdio", "-F", "overhead,dso,symbol"],
                           capture_output=True, text=True, check=False).stdout.splitlines()
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


def table(*heads):
    print("\n| " + " | ".join(heads) + " |\n|" + "---|" * len(heads), flush=True)


def row(*cells):
    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)


def early(options, folder):
    """The first 100 steps by one thread and by more, and how much faster more are."""
    table("shape", "threads", "million point-steps a second of processor time", "by the clock",
          "times one thread", "ns a point-step and thread", "bytes a point at the peak",
          "of the whole process")
    for shape in options.shapes:
        alone = None
        for threads in sorted({1, options.threads}):
            cost, rate, wall = best(options.repeat, shape, EARLY, threads, folder=folder)
            alone = alone or wall
            points = cost["points"]
            row(shape, threads, f"{rate:.2f}", f"{wall:.2f}", f"{wall / alone:.2f}",
                f"{1e3 / rate:.0f}", f"{cost['peak_bytes'] / points:.0f}",
                f"{cost['resident_bytes'] / points:.0f}")


def whole(options, folder):
    """The whole shot at the usual and at a long step."""
    table("shape", "courant", "threads", "steps", "s of processor time", "s by the clock",
          "million point-steps a second of processor time", "bytes a point at the peak",
          "of the whole process", "final length, mm")
    for shape in options.shapes:
        for courant in sorted({USUAL, LONG[shape]}):
            for threads in sorted({1, options.threads}):
                cost, rate, wall = best(options.repeat, shape, SHOT, threads, courant=courant,
                                        folder=folder)
                points = cost["points"]
                row(shape, courant, threads, cost["steps"], f"{cost['cpu_s']:.1f}",
                    f"{points * cost['steps'] / wall / 1e6:.1f}", f"{rate:.2f}",
                    f"{cost['peak_bytes'] / points:.0f}",
                    f"{cost['resident_bytes'] / points:.0f}", f"{1e3 * cost['length']:.4f}")


def sizes(options, folder):
    """From 1e4 to 1e7 points, about the same part of the shot. On finer grids fewer points flow, so
    that the strength is asked less often."""
    table("cell, mm", "points", *(f"{shape}, ns a point-step (evaluations of the strength)"
                                  for shape in options.shapes))
    for cell in SIZES:
        end = EARLY * cell / CELL * (1.0 if cell > 0.2 else 0.3)
        count = options.repeat if cell > 0.2 else 1
        found = [best(count, shape, end, 1, cell, folder=folder) for shape in options.shapes]
        row(cell, found[0][0]["points"],
            *(f"{1e3 / rate:.0f} ({c['work']['strength_points'] / c['work']['point_steps']:.2f})"
              for c, rate, _ in found))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--whole", action="store_true", help="the whole shot of 80 us as well")
    parser.add_argument("--sizes", action="store_true", help="from 1e4 to 1e7 points")
    parser.add_argument("--parts", action="store_true", help="parts of the step, by perf")
    parser.add_argument("--threads", type=int, default=2, help="beside one")
    parser.add_argument("--shapes", default="linear,quadratic,gimp,cubic",
                        type=lambda text: text.split(","))
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        print(f"{processor()}, {os.cpu_count()} processors, best of {options.repeat}\n")
        for threads in sorted({1, options.threads}):
            print(f"- {threads} thread{'s' if threads > 1 else ''}: {machine(folder, threads)}")
        early(options, folder)
        if options.whole:
            whole(options, folder)
        for shape in options.shapes if options.parts else ():
            share = parts(shape, folder)
            if share:
                print(f"\nParts of the step, {shape}: " +
                      ", ".join(f"{name} {value:.0f} %" for name, value in share.items()))
        if options.sizes:
            sizes(options, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
