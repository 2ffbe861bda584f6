"""What a checkpoint holds depends on the state of the run alone: not on threads, on how memory is
laid out, or on an earlier restart. Prints TAP."""
import os
import shutil
import tempfile

from same import (INPUTS, checkpoint_step, done, forget_the_end, h5py, numpy, report, run)

# Enough points that the sort works in ranges, one a thread.
SCENES = {
    "taylor_bar_3d": (["solver.cell=0.5 mm", "solver.end=3 us", "effects.wall.friction=0.1"],
                      "1 us"),
    "colliding_disks": (["solver.end=1.2 s"], "0.5 s"),
}


def arrays(out):
    found = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = (item.shape, numpy.asarray(item[()]).tobytes())
    with h5py.File(os.path.join(out, "checkpoint.h5"), "r") as file:
        file.visititems(keep)
    return found


def differences(one, other):
    """All but "run", the id of the result that the checkpoint belongs to."""
    a, b = arrays(one), arrays(other)
    return sorted(n for n in set(a) | set(b) if a.get(n) != b.get(n) and n != "run")


def previous_only(out):
    """As if the run had been killed before its last checkpoint."""
    forget_the_end(out)
    os.replace(os.path.join(out, "checkpoint.previous.h5"), os.path.join(out, "checkpoint.h5"))


with tempfile.TemporaryDirectory() as folder:
    for name, (settings, every) in SCENES.items():
        scene = os.path.join(INPUTS, name + ".yaml")
        settings = [*settings, f"outputs.checkpoint={{every: {every}}}"]
        one, two, gone_on = (os.path.join(folder, name + k) for k in "123")
        answer = run(scene, one, settings, threads=1)
        if not report(answer.code == 0, f"{name} runs", answer):
            continue
        answer = run(scene, two, settings, threads=2)
        wrong = differences(one, two)
        report(answer.code == 0 and not wrong,
               f"{name}: at step {checkpoint_step(one)} the same {len(arrays(one))} arrays on two "
               f"threads {wrong[:5]}", answer)
        shutil.copytree(one, gone_on)
        previous_only(gone_on)
        began = checkpoint_step(gone_on)
        answer = run(scene, gone_on, settings, "--resume", threads=2)
        wrong = differences(one, gone_on)
        report(answer.code == 0 and began < checkpoint_step(gone_on) and not wrong,
               f"{name}: the same from step {began} on {wrong[:5]}", answer)
done()
