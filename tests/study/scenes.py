"""Small scenes for studies, and what reads their tables."""
import csv
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(1, os.path.join(HERE, ".."))

STRENGTH = "materials.metal.strength."
DRIVER = """gamut: 1
title: one point under shear
solver: {model: material_driver, end: 1 ms, steps: 20, control: {xy: {velocity_gradient: 100 1/s}}}
materials:
  metal:
    density: {mean: 8000 kg/m3, cv: 0.01}
    eos: {model: linear, bulk_modulus: 140 GPa}
    strength: {model: von_mises, yield_stress: {mean: 90 MPa, cv: 0.1, distribution: lognormal},
               hardening_modulus: {mean: 300 MPa, cv: 0.2}}
    elasticity: {model: hypoelastic, shear_modulus: 48 GPa}
bodies:
  sample: {material: metal}
quantities:
  strain: {measure: plastic_strain, body: sample, reduce: at end}
  strength: {measure: stress_xy, body: sample, reduce: max}
  shear: {measure: stress_xy, body: sample, every: 0.1 ms}
"""
PLATE = """gamut: 1
title: two plates
solver: {model: material_point_method, geometry: 1d, cell: 1 mm, end: 2 us}
materials:
  copper:
    density: {mean: 8960 kg/m3, cv: 0.02}
    eos: {model: mie_gruneisen, C0: {mean: 3940 m/s, cv: 0.03}, S1: 1.489, gamma0: 2.02}
    strength: {model: none}
    elasticity: {model: hypoelastic, shear_modulus: 0 Pa}
bodies:
  flyer: {material: copper, shape: {box: {min: [0 mm], max: [10 mm]}}, velocity: [500 m/s]}
  target: {material: copper, shape: {box: {min: [10 mm], max: [20 mm]}}}
effects:
  viscosity: {model: artificial_viscosity}
quantities:
  peak: {measure: pressure, at: {body: target, point: [13 mm], follow: material}, reduce: max}
  arrival: {measure: pressure, at: {body: target, point: [13 mm], follow: material},
            reduce: {time_of: 5 GPa}}
  pressure: {measure: pressure, at: {body: target, point: [13 mm], follow: material}, every: 50 ns}
"""


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
    return path


def table(folder):
    with open(os.path.join(folder, "study.csv"), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def runs_of(folder):
    """Without the run at the means."""
    return [row for row in table(folder) if row["run"] != "-1"]


def column(rows, name):
    return [float(row[name]) for row in rows if row["status"] == "ok"]


def summary(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def content(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()
