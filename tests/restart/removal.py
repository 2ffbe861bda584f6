"""Points that leave before and after a checkpoint: a run that goes on has the same bits, with
another number of threads. Prints TAP."""
import os
import tempfile

from same import (INPUTS, checkpoint_step, differences, done, forget_the_end, report, run, steps)

EFFECTS = os.path.join(INPUTS, "../plugins/effect")
FOLLOWED = "quantities.followed={measure: velocity_y, at: {body: %s, point: %s}, every: 0.1 us}"
BAR = os.path.join(INPUTS, "taylor_bar.yaml")
# Scene, settings, time of the checkpoint. A point that is followed leaves before it.
CASES = {
    "outflow": (os.path.join(EFFECTS, "outflow/outflow.scene.yaml"),
                [FOLLOWED % ("block", "[2 mm, 0.6 mm]"), "outputs={every: 2 us, fields: [stress]}"],
                "6.3 us"),
    "outflow of all": (os.path.join(EFFECTS, "outflow/outflow.scene.yaml"),
                       ["solver.end=50 us", "bodies.still.velocity=[0 m/s, -200 m/s]",
                        "outputs={every: 10 us, fields: [stress]}"], "40 us"),
    "erosion": (BAR, ["solver.cell=0.635 mm", "solver.end=20 us", "effects.foot={model: erosion, "
                      "plastic_strain: 0.5, flagged: true, lost: true, most: 0.5}",
                      "outputs={every: 4 us, fields: [deformation_gradient, first_position]}",
                      FOLLOWED % ("bar", "[0.1 mm, 0.1 mm]")], "12 us"),
    "erosion, usf and gimp": (BAR, ["solver.cell=0.635 mm", "solver.end=20 us",
                                    "solver.shape=gimp", "solver.stress_update=usf",
                                    "effects.foot={model: erosion, plastic_strain: 0.5, "
                                    "lost: true, most: 0.5}"], "12 us"),
    "outside the domain": (BAR, ["solver.cell=0.635 mm", "solver.end=26 us",
                                 "solver.domain={min: [-1 mm, -1 mm], max: [4 mm, 30 mm], "
                                 "outside: remove}"], "20 us"),
}


def compare(name, scene, settings, at_time, folder):
    whole, cut = os.path.join(folder, name + "-whole"), os.path.join(folder, name + "-cut")
    answer = run(scene, whole, settings)
    if not report(answer.code == 0, f"{name}, in one go", answer):
        return
    answer = run(scene, cut, [*settings, "outputs.checkpoint={every: %s}" % at_time])
    forget_the_end(cut)
    at, total = checkpoint_step(cut), steps(whole)
    answer = run(scene, cut, settings, "--resume", threads=2)
    wrong = differences(whole, cut) if answer.code == 0 else ["it failed"]
    report(0 < at < total and not wrong,
           f"{name}: from step {at} of {total} on with two threads, the same bits"
           + (f"; not the same: {', '.join(wrong[:5])}" if wrong else ""), answer)


with tempfile.TemporaryDirectory() as scratch:
    for case, (path, changes, moment) in CASES.items():
        compare(case, path, changes, moment, scratch)
done()
