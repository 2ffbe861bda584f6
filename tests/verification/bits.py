"""The same bits for any number of threads and for blocks of any size. Prints TAP."""
import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy

SHORT_3D = {"solver.cell": "1.27 mm", "solver.end": "8 us"}
SCENES = (("taylor_bar", {"solver.cell": "0.5 mm", "solver.end": "12 us"}),
          ("taylor_bar_3d", {"solver.cell": "1 mm", "solver.end": "10 us"}),
          ("taylor_bar_4340", {"solver.cell": "0.5 mm", "solver.end": "6 us",
                               "solver.shape": "linear"}),
          ("plate_impact", {}), ("sod", {"solver.end": "0.05 s", "quantities": "{}"}),
          ("vibrating_bar", {"solver.end": "2 s"}),
          ("taylor_bar_3d", {**SHORT_3D, "solver.shape": "linear", "solver.stress_update": "usl"}),
          ("taylor_bar_3d", {**SHORT_3D, "solver.shape": "linear", "solver.stress_update": "usf",
                             "solver.transfer": "{model: xpic, order: 3}"}),
          ("taylor_bar_3d", {**SHORT_3D, "solver.shape": "gimp",
                             "solver.transfer": "{model: apic}"}),
          ("taylor_bar_3d", {**SHORT_3D, "solver.shape": "cubic", "solver.stress_update": "musl",
                             "solver.transfer": "{model: apic}"}),
          ("colliding_disks", {"solver.end": "0.4 s", "solver.shape": "gimp",
                               "solver.stress_update": "usf"}),
          ("rotating_block", {"solver.end": "0.2 s", "solver.shape": "cubic",
                              "solver.transfer": "{model: xpic, order: 4}"}))
WAYS = ((2, None), (3, None), (1, 8), (2, 100), (3, 1024))


def frames(result):
    """Every number of every frame, as bytes."""
    found = {}

    def keep(name, node):
        if isinstance(node, h5py.Dataset):
            found[name] = numpy.asarray(node[...]).tobytes()

    with h5py.File(result.file("results.h5"), "r") as file:
        file["frames"].visititems(keep)
    return found


def history(result):
    with open(result.file("history.csv"), "rb") as file:
        return file.read()


def label(scene, changes):
    """The scene with the scheme that was chosen for it."""
    scheme = [v for k, v in changes.items() if k[7:] in ("shape", "stress_update", "transfer")]
    return ", ".join([scene, *scheme])


for scene, changes in SCENES:
    first = scenes.run(scene, changes, threads=1)
    shown, recorded, name = frames(first), history(first), label(scene, changes)
    scenes.report(len(shown) >= 6 and sum(map(len, shown.values())) > 1000,
                  f"{name}: {len(shown)} arrays in the frames")
    for threads, block in WAYS:
        size = {} if block is None else {"solver.block": str(block)}
        other = scenes.run(scene, {**changes, **size}, threads=threads)
        again = frames(other)
        differ = sorted(k for k in set(shown) | set(again) if shown.get(k) != again.get(k))
        if history(other) != recorded:
            differ.append("history.csv")
        if other.summary["ledger"] != first.summary["ledger"]:
            differ.append("the ledger")
        scenes.report(not differ, f"{name}: same bits with {threads} threads, blocks of "
                                  f"{block or 'the usual size'}", differ[:8])
        scenes.drop(other)
    scenes.drop(first)
scenes.done()
