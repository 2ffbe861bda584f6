"""Running scenes, and comparing two results bit for bit. Shared by the tests of this folder."""
import json
import os
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import needs  # noqa: E402

needs.modules("h5py", "numpy")
import h5py  # noqa: E402
import numpy  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
INPUTS = os.path.join(HERE, "../../inputs")
from tap import GAMUT, done, gamut, report  # noqa: E402,F401

# Waiting threads sleep: two of them on a busy machine are slow otherwise.
os.environ["OMP_WAIT_POLICY"] = "passive"


def run(scene, out, settings, *more, threads=1):
    words = []
    for setting in settings:
        words += ["--set", setting]
    return gamut("run", scene, "-o", out, "--threads", str(threads), *words, *more)


def content(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def tables(folder):
    """Datasets and attributes of results.h5 by name, as bytes; not the scene and the summary."""
    found = {}

    def keep(name, item):
        if name in ("scene", "summary"):
            return
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = numpy.asarray(value).tobytes()
        if isinstance(item, h5py.Dataset):
            found[name] = (item.shape, numpy.asarray(item[()]).tobytes())

    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        file.visititems(keep)
    return found


def summary(folder):
    told = json.loads(content(folder, "summary.json"))
    told.pop("cost")
    return told


def differences(one, other):
    """Names of what is not the same in two results."""
    a, b = tables(one), tables(other)
    found = sorted(key for key in set(a) | set(b) if a.get(key) != b.get(key))
    found += [name for name in ("history.csv", "results.xdmf")
              if content(one, name) != content(other, name)]
    if summary(one) != summary(other):
        found.append("summary.json")
    return found


def checkpoint_step(folder):
    with h5py.File(os.path.join(folder, "checkpoint.h5"), "r") as file:
        return int(file["counts"][0])


def steps(folder):
    return json.loads(content(folder, "summary.json"))["cost"]["steps"]


def forget_the_end(folder):
    """Leaves a result as a kill after its last checkpoint does."""
    os.remove(os.path.join(folder, "summary.json"))
