"""What the tests of the deformation-gamut bar share: materials, scenes, results."""
import json
import math
import os

import scenes  # first: it skips the test where h5py or numpy are missing
import h5py
import numpy

REFERENCE = json.load(open(os.path.join(scenes.HERE, "gamut_bar_reference.json"),
                           encoding="utf-8"))
CARD = {"al7075": dict(E=71.6e9, yield_stress=538.6e6, n=17.8702),
        "ti64": dict(E=115.7e9, yield_stress=867e6, n=47.61)}
OFFSET = 0.002
GROWTH = 1.01


def strain_at(card, stress):
    return stress / card["E"] + OFFSET * (stress / card["yield_stress"]) ** card["n"]


def curve(result, name="stress_strain"):
    quantity = result.summary["quantities"][name]
    return numpy.array(quantity["strain"]), numpy.array(quantity["values"])


def frame(result, which=-1):
    with h5py.File(result.file("results.h5"), "r") as file:
        frames = file["frames"]
        body = frames[sorted(frames)[which]]["bar"]
        return {name: body[name][()].ravel() for name in body}


def write_scene(name, solver, quantities, fields=(), material="al7075", body="", every=0):
    """A scene of its own, with the cards of the inputs."""
    path = os.path.join(scenes.SCRATCH, name + ".yaml")
    card = "7075" if material == "al7075" else "ti64"
    lines = ["gamut: 1", f"include: [{scenes.INPUTS}/materials/{card}.yaml]",
             f"solver: {{model: gamut_bar, {solver}}}",
             f"bodies: {{bar: {{material: {material}, length: 100 mm, area: 100 mm2{body}}}}}",
             "quantities:"]
    lines += [f"  {key}: {{{value}}}" for key, value in quantities.items()]
    if fields:
        every = f"every: {every}, " if every else ""
        lines.append(f"outputs: {{{every}fields: [{', '.join(fields)}]}}")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


STRESS_STRAIN = {"stress_strain": "measure: stress_strain"}


def uneven_table(bonds):
    rows = []
    for i in range(bonds):
        rows.append((1 + 0.5 * math.sin(2.3 * i), 1.0, 1 + 0.1 * math.sin(1.7 * i + 0.3),
                     0.1 * math.cos(2.9 * i + 0.1), 1.0))
    return "[" + ", ".join("[" + ", ".join(repr(v) for v in row) + "]" for row in rows) + "]"


def wavy_table(bonds):
    """Modulus and softness as waves along the bar, the same for any number of bonds."""
    rows = []
    for i in range(bonds):
        x = (i + 0.5) / bonds
        rows.append((1.0, 1.0, 1 + 0.1 * math.sin(4 * math.pi * x),
                     0.1 * math.cos(2 * math.pi * x), 1.0))
    return "[" + ", ".join("[" + ", ".join(repr(v) for v in row) + "]" for row in rows) + "]"
