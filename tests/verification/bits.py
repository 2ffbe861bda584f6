"""The same bits for any number of threads and for blocks of any size. Prints TAP."""
import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy

SCENES = {"taylor_bar": {"solver.cell": "0.5 mm", "solver.end": "12 us"},
          "taylor_bar_3d": {"solver.cell": "1 mm", "solver.end": "10 us"},
          "taylor_bar_4340": {"solver.cell": "0.5 mm", "solver.end": "6 us",
                              "solver.shape": "linear"},
          "plate_impact": {}, "sod": {"solver.end": "0.05 s", "quantities": "{}"},
          "vibrating_bar": {"solver.end": "2 s"}}
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


for scene, changes in SCENES.items():
    first = scenes.run(scene, changes, threads=1)
    shown, recorded = frames(first), history(first)
    scenes.report(len(shown) >= 6 and sum(map(len, shown.values())) > 1000,
                  f"{scene}: {len(shown)} arrays in the frames")
    for threads, block in WAYS:
        size = {} if block is None else {"solver.block": str(block)}
        other = scenes.run(scene, {**changes, **size}, threads=threads)
        again = frames(other)
        differ = sorted(k for k in set(shown) | set(again) if shown.get(k) != again.get(k))
        if history(other) != recorded:
            differ.append("history.csv")
        scenes.report(not differ, f"{scene}: same bits with {threads} threads, blocks of "
                                  f"{block or 'the usual size'}", differ[:8])
        scenes.drop(other)
    scenes.drop(first)
scenes.done()
