"""Every scene of inputs/, coarser, in one go and stopped half-way: the same bits, with another
number of threads. Prints TAP."""
import os
import tempfile

import yaml

from same import (INPUTS, checkpoint_step, differences, done, forget_the_end, report, run, steps)

BAR = (["solver.bonds=40"], "{every: 55}")
SHOT = (["solver.cell=0.635 mm", "solver.end=24 us"], "{every: 14 us}")
# Settings that make a scene short, and how often it leaves a checkpoint: once, after the middle.
SHORT = {
    "colliding_disks": (["solver.cell=0.05 m", "solver.end=2 s"], "{every: 1.1 s}"),
    "driver_johnson_cook": (["solver.steps=1000"], "{every: 260 us}"),
    "mms_axis_aligned": (["solver.cell=0.1 m"], "{every: 0.011 s}"),
    "plate_impact": (["solver.cell=0.25 mm"], "{every: 1.6 us}"),
    "rotating_block": (["solver.cell=0.05 m", "solver.end=1 s"], "{every: 0.55 s}"),
    "self_weight": (["solver.cell=2 m", "solver.end=20 s"], "{every: 11 s}"),
    "sod": (["solver.cell=20 mm"], "{every: 0.12 s}"),
    "taylor_bar_3d": (["solver.cell=1.27 mm", "solver.end=16 us"], "{every: 9 us}"),
    "taylor_bar_benchmark": (["solver.cell=0.8 mm", "solver.end=24 us"], "{every: 14 us}"),
    "taylor_bar_quarter": (["solver.cell=1.27 mm", "solver.end=16 us"], "{every: 9 us}"),
    "taylor_bar_random_field": (["solver.cell=0.635 mm", "solver.end=24 us"], "{every: 14 us}"),
    "tension_bar": (["solver.cell=0.05 m", "solver.end=20 s"], "{every: 11 s}"),
    "vibrating_bar": (["solver.cell=1 m"], "{every: 11 s}"),
    "vortex": (["solver.cell=0.1 m", "solver.end=0.2 s"], "{every: 0.11 s}"),
}


def is_study(scene):
    return "estimator" in (scene.get("uncertainty") or {})


def compare(name, scene, settings, every, folder):
    label = "_".join([name, *(s.split("=")[1] for s in settings if "shape" in s)])
    whole, cut = os.path.join(folder, label + "-whole"), os.path.join(folder, label + "-cut")
    answer = run(scene, whole, settings)
    if not report(answer.code == 0, f"{label} in one go", answer):
        return
    answer = run(scene, cut, [*settings, f"outputs.checkpoint={every}"])
    if not report(answer.code == 0 and not differences(whole, cut),
                  f"{label}: a checkpoint on the way changes no bit", answer):
        return
    forget_the_end(cut)
    at, total = checkpoint_step(cut), steps(whole)
    answer = run(scene, cut, settings, "--resume", threads=2)
    wrong = differences(whole, cut) if answer.code == 0 else ["it failed"]
    report(0 < at < total and not wrong,
           f"{label}: from step {at} of {total} on with two threads, the same bits"
           + (f"; not the same: {', '.join(wrong[:5])}" if wrong else ""), answer)


with tempfile.TemporaryDirectory() as scratch:
    for file in sorted(os.listdir(INPUTS)):
        if not file.endswith(".yaml"):
            continue
        name, path = file[:-5], os.path.join(INPUTS, file)
        with open(path, encoding="utf-8") as opened:
            scene = yaml.safe_load(opened)
        if is_study(scene):
            continue
        model = scene["solver"]["model"]
        settings, every = SHORT.get(name, SHOT if model == "material_point_method" else BAR)
        shapes = ("linear", "quadratic") if model == "material_point_method" else (None,)
        for shape in shapes:
            compare(name, path, settings + ([f"solver.shape={shape}"] if shape else []), every,
                    scratch)
done()
