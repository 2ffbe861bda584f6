"""Thirty realisations: the mean against Ramberg and Osgood, and what less noise does to it."""
import json

import scenes
import numpy
from gamut_bar_scenes import CARD, strain_at

FIELDS = ("modulus", "softness", "density", "weights")


def stress_at(card, strain):
    low, high = numpy.zeros_like(strain), card["E"] * strain
    for _ in range(200):
        middle = (low + high) / 2
        small = strain_at(card, middle) < strain
        low, high = numpy.where(small, middle, low), numpy.where(small, high, middle)
    return low


def study(material, changes):
    result = scenes.run(f"bar_{material}_random", changes, threads=2)
    quantity = result.summary["quantities"]["stress_strain"]
    strain = numpy.array(quantity["strain"])
    mean = numpy.array([numpy.nan if v is None else v for v in quantity["means"]])
    keep = numpy.isfinite(mean) & (strain > 1e-4)
    off = mean[keep] / stress_at(CARD[material], strain[keep]) - 1
    return result, strain[keep], off


def ensembles():
    for material in CARD:
        for grid in ("uniform", "random"):
            result, strain, off = study(material, {"solver.grid": grid})
            done = result.summary["study"]["done"]
            scenes.report(done == 30, f"{material}, {grid} grid: {done} of 30 realisations")
            scenes.below(f"{material}, {grid} grid: mean curve against Ramberg and Osgood, largest",
                         max(abs(off)), 0.035)
            scenes.below(f"{material}, {grid} grid: the same beyond a strain of 0.01",
                         max(abs(off[strain > 0.01])), 0.006)
            if (material, grid) == ("al7075", "random"):
                same_bits(result)


def same_bits(result):
    other = scenes.run("bar_al7075_random", {"solver.grid": "random"}, threads=1)
    scenes.report(json.dumps(other.summary["quantities"]) ==
                  json.dumps(result.summary["quantities"]),
                  "the same bits on one thread and on two")


def less_noise():
    """The paper's closing words: a larger divisor or a smaller range brings the mean closer."""
    def divided(by):
        return {f"solver.noise.{field}.divisor": by for field in FIELDS}
    offs = [max(abs(study("al7075", divided(by))[2])) for by in (10, 20, 40)]
    scenes.report(offs[0] > 2 * offs[1] > 4 * offs[2],
                  "largest difference of the mean curve with divisors 10, 20, 40: "
                  + ", ".join(f"{100 * off:.3f} %" for off in offs))
    sd = []
    for spread in (0.65, 0.1):
        result, _, _ = study("al7075", {"solver.grid_range": spread})
        sd.append(result.summary["quantities"]["initial_modulus"]["mean"])
    uniform = study("al7075", {"solver.grid": "uniform"})[0]
    even = uniform.summary["quantities"]["initial_modulus"]["mean"]
    scenes.report(abs(sd[1] - even) < abs(sd[0] - even),
                  "mean initial modulus on random grids of range 0.65 and 0.1 less that on the "
                  f"uniform grid: {(sd[0] - even) / 1e6:.2f} and {(sd[1] - even) / 1e6:.2f} MPa")


ensembles()
less_noise()
scenes.done()
