"""The case of point_rate.py by two builds in turn: what one costs more than the other.

    python3 tests/bench/side_by_side.py OTHER/build/gamut build/gamut
        [--pairs N] [--shapes linear,quadratic] [--instructions]

Times by runs in turn on one processor (the first of each pair changes), so that a machine that
others use disturbs both alike: the median of the ratios of N pairs (40) is what counts, the spread
stands beside it. Instructions by valgrind, of a shorter run, where the machine does not matter at
all. Work counts of both builds are compared. Prints Markdown.
"""
import argparse
import os
import re
import statistics
import subprocess
import sys
import tempfile

import point_rate

HALF = 1.8  # us, about 50 steps
SHORT = 0.72  # us, about 20 steps


def cost(program, shape, end, folder):
    point_rate.GAMUT = program
    return point_rate.run(shape, end, folder=folder)


def times(options, folder):
    point_rate.table("shape", "pairs", "second over first, processor time: median",
                     "middle half of the ratios", "least over least", "work counts")
    for shape in options.shapes:
        found = {program: [] for program in options.programs}
        for pair in range(options.pairs):
            turn = options.programs if pair % 2 else options.programs[::-1]
            for program in turn:
                found[program].append(cost(program, shape, HALF, folder))
        first, second = (found[program] for program in options.programs)
        ratio = sorted(b["cpu_s"] / a["cpu_s"] for a, b in zip(first, second))
        least = min(c["cpu_s"] for c in second) / min(c["cpu_s"] for c in first)
        same = "the same" if first[0]["work"] == second[0]["work"] else \
            ", ".join(f"{name} {second[0]['work'][name] - count:+}"
                      for name, count in first[0]["work"].items()
                      if second[0]["work"].get(name, 0) != count)
        point_rate.row(shape, options.pairs, f"{statistics.median(ratio):.3f}",
                       f"{ratio[len(ratio) // 4]:.3f} to {ratio[3 * len(ratio) // 4]:.3f}",
                       f"{least:.3f}", same)


def instructions(options, folder):
    point_rate.table("shape", "instructions of the run, first", "second", "second over first")
    for shape in options.shapes:
        counted = []
        for program in options.programs:
            done = subprocess.run(
                ["valgrind", "--tool=callgrind",
                 "--callgrind-out-file=" + os.path.join(folder, "callgrind"), program, "run",
                 point_rate.SCENE, "--no-user-plugins", "--threads", "1", "--force", "-o",
                 os.path.join(folder, "out"),
                 *point_rate.scene(shape, SHORT, point_rate.CELL, point_rate.USUAL)],
                capture_output=True, text=True, check=False)
            found = re.search(r"refs:\s+([\d,]+)", done.stderr)
            if done.returncode != 0 or not found:
                sys.exit(done.stderr[-2000:])
            counted.append(int(found.group(1).replace(",", "")))
        point_rate.row(shape, *(f"{count:.4e}" for count in counted),
                       f"{counted[1] / counted[0]:.4f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("programs", nargs=2, metavar="GAMUT", type=os.path.abspath)
    parser.add_argument("--pairs", type=int, default=40)
    parser.add_argument("--shapes", default="linear,quadratic", type=lambda text: text.split(","))
    parser.add_argument("--instructions", action="store_true", help="count them, by valgrind")
    options = parser.parse_args()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    with tempfile.TemporaryDirectory() as folder:
        print(f"{point_rate.processor()}, one thread")
        times(options, folder)
        if options.instructions:
            instructions(options, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
