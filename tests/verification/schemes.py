"""Shapes, transfers and orders of the material point method, and what its frames hold."""
import math

import scenes  # before h5py and numpy: it skips the test where they are missing
import h5py
import numpy

SHAPES = {"linear": {"solver.shape": "linear"},
          "gimp": {"solver.shape": "gimp"},
          "gimp, fixed": {"solver.shape": "gimp", "solver.gimp": "{domain: fixed}"},
          "quadratic": {"solver.shape": "quadratic"},
          "cubic": {"solver.shape": "cubic"}}
TRANSFERS = {"flip": {"solver.transfer": "{model: flip}"},
             "flip, pic 0.01": {"solver.transfer": "{model: flip, pic: 0.01}"},
             "pic": {"solver.transfer": "{model: pic}"},
             "apic": {"solver.transfer": "{model: apic}"},
             "xpic 2": {"solver.transfer": "{model: xpic, order: 2}"},
             "xpic 3": {"solver.transfer": "{model: xpic, order: 3}"},
             "xpic 4": {"solver.transfer": "{model: xpic, order: 4}"},
             "xpic 5": {"solver.transfer": "{model: xpic, order: 5}"}}
ORDERS = ("usl", "musl", "usf")


def table(shapes=tuple(SHAPES), transfers=tuple(TRANSFERS)):
    """Shape, transfer, order: flip with each order, other transfers with the usual one."""
    return [(s, t, o) for s in shapes for t in transfers
            for o in (ORDERS if t == "flip" else ("auto",))]


def allowed(shape, transfer, order="auto"):
    """The solver refuses apic with linear functions, whose slopes know nothing of mass."""
    return not (shape == "linear" and transfer == "apic")


def name(shape, transfer, order="auto"):
    return f"{shape}, {transfer}" + ("" if order == "auto" else f" {order}")


def scheme(shape="quadratic", transfer="flip", order="auto", **more):
    """Settings of a scene; `more` by path, with __ for a dot."""
    return {**SHAPES[shape], **TRANSFERS[transfer], "solver.stress_update": order,
            **{path.replace("__", "."): str(value) for path, value in more.items()}}


def outcome(measure, *what):
    """What `measure` gives, or how its run ended."""
    try:
        return measure(*what), ""
    except scenes.Failed as failed:
        lines = [line for line in failed.said.splitlines() if "error" in line]
        return None, f"exit {failed.code}" + (f": {lines[0]}" if lines else "")


def tell(title, measure, *what):
    """A note with the figures that `measure` gives, or with why there are none."""
    value, why = outcome(measure, *what)
    scenes.note(f"{title}: " + (why[:100] if value is None else ", ".join(
        f"{key} {v:.3g}" for key, v in value.items())))
    return value


def frames(result, body, names):
    """Of each frame: time and the named fields, by id; the first holds places at the start."""
    found = []
    with h5py.File(result.file("results.h5"), "r") as file:
        for key in sorted(file["frames"]):
            group = file["frames"][key]
            order = numpy.argsort(group[body]["id"][...])
            found.append((float(group.attrs["time"]),
                          {n: group[body][n][...][order] for n in names}))
    return found


def displacement_error(scene, body, exact, axes, changes):
    """Root mean square of the error of displacement in the last frame over that of displacement."""
    result = scenes.run(scene, changes)
    shots = frames(result, body, ["position"])
    scenes.drop(result)
    start, (time, last) = shots[0][1]["position"][:, :axes], shots[-1]
    target = exact(start, time)
    off = last["position"][:, :axes] - target
    return math.sqrt((off ** 2).sum() / ((target - start) ** 2).sum())


def orders(errors, cells):
    """Orders of convergence from grid to grid."""
    return [math.log(a / b) / math.log(g / h)
            for a, b, g, h in zip(errors, errors[1:], cells, cells[1:])]


def ledger(result, account, line):
    return result.summary["ledger"][account]["lines"][line]["value"]


def stored(result, account):
    """At the start and now: the lines of an account that are stored, added up."""
    lines = [v for v in result.summary["ledger"][account]["lines"].values()
             if v["role"] == "stored"]
    return sum(v["start"] for v in lines), sum(v["value"] for v in lines)
