"""The scenes of inputs/ by two builds: how far apart their results are.

    python3 tests/bench/same_results.py OTHER/build/gamut build/gamut [SCENE..]

Each scene runs once with either, most of them for a first part of their time. Of every curve, and
of every field of every frame by the points' ids, the largest difference stands over the largest
value of the curve, or of that field in all frames; it is infinite where only one side has a value.
Prints Markdown. Not a test: a change of
the order of sums moves last bits, and what such a change may do is said where it is made.
"""
import glob
import json
import os
import subprocess
import sys
import tempfile

import h5py
import numpy

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# What is enough for contact, plastic flow and many sorts; the others run whole.
ENDS = {"colliding_disks": "2.5 s", "plate_impact": "1.5 us", "rotating_block": "0.6 s",
        "self_weight": "8 s", "taylor_bar": "20 us", "taylor_bar_3d": "8 us",
        "taylor_bar_42crmo4": "15 us", "taylor_bar_4340": "15 us", "taylor_bar_benchmark": "15 us",
        "taylor_bar_quarter": "8 us", "taylor_bar_random_field": "8 us", "vibrating_bar": "5 s",
        "vortex": "0.1 s"}


def run(program, scene, folder):
    name = os.path.splitext(os.path.basename(scene))[0]
    changes = ["--set", "solver.end=" + ENDS[name]] if name in ENDS else []
    done = subprocess.run([program, "run", scene, "--no-user-plugins", "--threads", "1", "--force",
                           "-o", folder, *changes], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 6):
        sys.exit(f"{program} {scene}: exit {done.returncode}\n{done.stderr[-2000:]}")


def size(values):
    values = numpy.asarray(values, float)
    return float(abs(values[numpy.isfinite(values)]).max(initial=0.0))


def apart(one, other, scale=None):
    """Largest difference over the largest value, or over `scale`."""
    one, other = numpy.asarray(one, float), numpy.asarray(other, float)
    if one.shape != other.shape:
        return numpy.inf
    same = (one == other) | (numpy.isnan(one) & numpy.isnan(other))
    if same.all():
        return 0.0
    if not (numpy.isfinite(one[~same]).all() and numpy.isfinite(other[~same]).all()):
        return numpy.inf
    return float(abs(one - other)[~same].max() / (scale or size(one)))


def curves(file):
    """Each curve's values; of a study the rows of study.csv stand in h5 as tables."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and \
                not name.startswith("frames/"):
            found[name] = item[()]
    file.visititems(visit)
    return found


def fields(frame):
    found = {}
    for body, points in frame.items():
        order = numpy.argsort(points["id"][()])
        for name, item in points.items():
            if name != "id" and item.dtype.kind == "f":
                found[f"{body}.{name}"] = item[()][order]
    return found


def worst(one, other, scale):
    names = set(one) | set(other)
    return max(((apart(one[n], other[n], scale.get(n)) if n in one and n in other else numpy.inf,
                 n) for n in names), default=(0.0, ""))


def sizes(frames):
    found = {}
    for frame in frames.values():
        for name, values in fields(frame).items():
            found[name] = max(found.get(name, 0.0), size(values))
    return found


def steps(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        count = json.load(file).get("cost", {}).get("steps")
    return None if count is None else int(count)


def compare(scene, programs, folder):
    out = [os.path.join(folder, str(k)) for k in range(2)]
    for program, where in zip(programs, out):
        run(program, scene, where)
    with h5py.File(os.path.join(out[0], "results.h5")) as one, \
            h5py.File(os.path.join(out[1], "results.h5")) as other:
        curve = worst(curves(one), curves(other), {})
        frames = sorted(set(one.get("frames", {})) | set(other.get("frames", {})))
        scale = sizes(one.get("frames", {}))
        field = max((worst(fields(one["frames"][f]), fields(other["frames"][f]), scale)
                     if f in one["frames"] and f in other["frames"] else (numpy.inf, f)
                     for f in frames), default=(0.0, ""))
    first, second = (steps(where) for where in out)
    count = f"{first}" if first == second else f"{first}, {second}"
    return count if first is not None else "a study", curve, field


def shown(found):
    return "0" if found[0] == 0.0 else f"{found[0]:.1e} (`{found[1]}`)"


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    programs, scenes = sys.argv[1:3], sys.argv[3:]
    scenes = scenes or sorted(glob.glob(os.path.join(TREE, "inputs", "*.yaml")))
    print("| scene | steps | largest difference of a curve | of a field |")
    print("|---|---|---|---|")
    for scene in scenes:
        name = os.path.splitext(os.path.basename(scene))[0]
        with tempfile.TemporaryDirectory() as folder:
            count, curve, field = compare(scene, programs, folder)
        end = f", `solver.end={ENDS[name]}`" if name in ENDS else ""
        print(f"| `{name}`{end} | {count} | {shown(curve)} | {shown(field)} |", flush=True)


if __name__ == "__main__":
    main()
