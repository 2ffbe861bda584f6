"""Every scene of inputs/, coarser, in one go and stopped half-way: the same bits, with another
number of threads. Prints TAP."""
import os
import sys
import tempfile

from same import (HERE, checkpoint_step, differences, done, forget_the_end, report, run, steps)

sys.path.insert(0, os.path.join(HERE, "../scenes"))
import short  # noqa: E402

# How often a scene leaves a checkpoint: once, after the middle.
BAR, SHOT = "{every: 55}", "{every: 14 us}"
EVERY = {
    "colliding_disks": "{every: 1.1 s}",
    "driver_johnson_cook": "{every: 260 us}",
    "mms_axis_aligned": "{every: 0.011 s}",
    "plate_impact": "{every: 1.6 us}",
    "rotating_block": "{every: 0.55 s}",
    "self_weight": "{every: 11 s}",
    "sod": "{every: 0.12 s}",
    "taylor_bar_3d": "{every: 9 us}",
    "taylor_bar_benchmark": "{every: 14 us}",
    "taylor_bar_quarter": "{every: 9 us}",
    "tension_bar": "{every: 11 s}",
    "vibrating_bar": "{every: 11 s}",
    "vortex": "{every: 0.11 s}",
}


# Shapes, transfers and orders that keep something of their own between two steps.
SCHEMES = (("shape=linear",), ("shape=quadratic",), ("shape=gimp", "transfer={model: apic}"),
           ("shape=cubic", "transfer={model: xpic, order: 2}", "stress_update=usf"))


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
    for name, path, scene, settings in short.scenes():
        if short.is_study(scene):
            continue
        grid = scene["solver"]["model"] == "material_point_method"
        every = EVERY.get(name, SHOT if grid else BAR)
        for scheme in SCHEMES if grid else ((),):
            compare(name, path, settings + [f"solver.{s}" for s in scheme], every, scratch)
done()
