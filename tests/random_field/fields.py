"""Random fields in runs: distributions kept, parameters that follow, same bits, what is refused."""
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "verification"))
import scenes  # noqa: E402
import h5py  # noqa: E402
import numpy as np  # noqa: E402

# A block of copper in one step; what varies is put in by each test.
BLOCK = """
gamut: 1
include: [materials/copper.yaml]
solver: {model: material_point_method, geometry: plane_strain, cell: CELL, end: 1 ns}
materials:
  copper: {MATERIAL}
bodies:
  block: {material: copper, shape: {box: {min: [0 mm, 0 mm], max: [20 mm, 10 mm]}},
          points_per_cell: 4EXTRA}
outputs: {frames: 1, fields: [FIELDS]}
UNCERTAINTY
"""
LENGTH = "correlation_length: 2 mm"
runs = 0


def scene(material, fields, cell="0.5 mm", extra="", uncertainty=""):
    global runs
    runs += 1
    text = BLOCK.replace("CELL", cell).replace("MATERIAL", material).replace("FIELDS", fields)
    return scenes.written(f"block{runs}", text.replace("EXTRA", extra)
                          .replace("UNCERTAINTY", uncertainty))


def strength(field, spread="mean: 90 MPa, cv: 0.1"):
    return f"strength: {{A: {{{spread}, field: {{{field}}}}}}}"


def frame(result, name, number=0):
    with h5py.File(result.file("results.h5"), "r") as file:
        frames = file["frames"]
        bodies = frames[sorted(frames)[number]]
        return next(iter(bodies.values()))[name][...]


A = "materials.copper.strength.A"


def field_of(material, name=A, threads=1, **options):
    result = scenes.run(scene(material, name, **options), threads=threads)
    values = frame(result, name)
    scenes.drop(result)
    return values


def refused(label, material, words, code=3, **options):
    process, _ = scenes.attempt(scene(material, "plastic_strain", **options))
    scenes.report(process.returncode == code and all(w in process.stderr for w in words),
                  f"refused: {label} (exit {process.returncode}, {code} expected)",
                  [process.stderr])


def test_distributions():
    white = field_of(strength("model: white"), cell="0.25 mm")
    n = len(white)
    scenes.below(f"white, {n} points: mean off 90 MPa, in standard errors",
                 (white.mean() / 90e6 - 1) / 0.1 * math.sqrt(n), 5)
    scenes.below("white: standard deviation off 9 MPa, in standard errors",
                 (white.std() / 9e6 - 1) * math.sqrt(2 * n), 5)
    # One number u makes both noises, z = quantile(u) and a signed Weibull number that lies below
    # 0.5 - u (or 1.5 - u) of all others: so what the parameter makes of both adds up.
    normal, signed = (np.array([0.5 * math.erfc(-(x / 90e6 - 1) / (0.1 * math.sqrt(2)))
                                for x in field_of(strength(f"model: white, distribution: {name}"))])
                      for name in ("normal", "weibull"))
    scenes.below("white: probabilities of normal and Weibull noise of one number, sum against 0.5, "
                 "1.5", np.max(np.abs((normal + signed) % 1.0 - 0.5)), 1e-12)
    uniform = field_of(strength("model: white, distribution: weibull",
                                "distribution: uniform, lower: 80 MPa, upper: 100 MPa"),
                       cell="0.25 mm")
    order = np.sort((uniform - 80e6) / 20e6)
    distance = np.max(np.abs(order - (np.arange(n) + 0.5) / n)) * math.sqrt(n)
    scenes.below("Weibull noise, uniform parameter: Kolmogorov's distance", distance, 1.95)
    cut = field_of(strength(f"model: karhunen_loeve, {LENGTH}",
                            "mean: 90 MPa, cv: 0.1, truncate: [85 MPa, 95 MPa]"))
    scenes.report(cut.min() >= 85e6 and cut.max() <= 95e6 and np.ptp(cut) > 5e6,
                  f"truncated field: from {cut.min() / 1e6:.3f} to {cut.max() / 1e6:.3f} MPa")


def test_companions():
    material = ("eos: {model: linear, youngs_modulus: {mean: 120 GPa, cv: 0.05, field: "
                f"{{model: karhunen_loeve, kernel: gaussian, {LENGTH}}}}}, poissons_ratio: 0.34}}")
    text = scene("MORE",
                 "materials.bar.eos.youngs_modulus, materials.bar.eos.bulk_modulus")
    with open(text, encoding="utf-8") as file:
        words = file.read()
    words = words.replace("include: [materials/copper.yaml]\n", "").replace(
        "copper: {MORE}", "bar: {density: 8960 kg/m3, " + material +
        ", elasticity: {model: hypoelastic, shear_modulus: 45 GPa}}")
    words = words.replace("material: copper", "material: bar")
    with open(text, "w", encoding="utf-8") as file:
        file.write(words)
    result = scenes.run(text)
    young = frame(result, "materials.bar.eos.youngs_modulus")
    bulk = frame(result, "materials.bar.eos.bulk_modulus")
    scenes.below("a parameter that follows from a field, off its formula at each point",
                 np.max(np.abs(bulk / (young / (3 * (1 - 2 * 0.34))) - 1)), 1e-14)
    scenes.report(np.ptp(young) > 6e9, f"the field's values: {young.min() / 1e9:.1f} to "
                  f"{young.max() / 1e9:.1f} GPa")


def test_bits():
    material = strength(f"model: karhunen_loeve, kernel: matern_5_2, {LENGTH}")
    one, three = field_of(material), field_of(material, threads=3)
    scenes.report(np.array_equal(one, three), "the same field on 1 and 3 threads")
    other = field_of(material, uncertainty="uncertainty: {seed: 2}")
    scenes.report(not np.array_equal(one, other), "another seed, another field")


def test_pressed():
    material = ("eos: {gamma0: {mean: 2.02, cv: 0.02, field: {model: white}}}")
    result = scenes.run(scene(material, "pressure, energy", extra=", pressure: 1 GPa"))
    pressure, energy = frame(result, "pressure"), frame(result, "energy")
    scenes.below("a pressure at the start where the eos varies: off 1 GPa",
                 np.max(np.abs(pressure / 1e9 - 1)), 1e-12)
    scenes.report(np.ptp(energy) > 0, "by energies that differ")


def test_study():
    field = "model: karhunen_loeve, from: samples, samples: RUNS, energy: 0.9"
    study = "uncertainty: {estimator: {model: monte_carlo, runs: 4}}\n" \
            "quantities: {mass: {measure: plastic_strain, at: {body: block, point: [1 mm, 1 mm]}," \
            " reduce: at end}}"
    process, _ = scenes.attempt(
        scene(strength(field.replace("RUNS", "4")), "plastic_strain", uncertainty=study))
    scenes.report(process.returncode == 0, "a study of as many runs as samples", [process.stderr])
    refused("a study of more runs than samples", strength(field.replace("RUNS", "2")),
            ["realisation 2 is asked for", "'samples' = 2"], code=5, uncertainty=study)


def test_explain():
    path = scene(strength(f"model: karhunen_loeve, {LENGTH}"), A)
    process = subprocess.run([scenes.GAMUT, "explain", path, "--no-user-plugins"],
                             capture_output=True, text=True, check=False)
    scenes.report(A in process.stdout and "random fields" in process.stdout and
                  "random_field/karhunen_loeve" in process.stdout,
                  "explain shows what varies, its bytes and the plugin", [process.stdout])
    process = subprocess.run([scenes.GAMUT, "explain", "--no-user-plugins", scene(
        "strength: {C: {mean: 0.025, cv: 0.1, field: {model: white}}}", "plastic_strain")],
        capture_output=True, text=True, check=False)
    scenes.report("materials.copper.strength.C" in process.stdout, "a rate factor may vary",
                  [process.stdout, process.stderr])


def test_refusals():
    kernel = "model: karhunen_loeve"
    refused("no correlation length", strength(kernel), ["needs a correlation length"])
    refused("two kinds of lengths",
            strength(f"{kernel}, {LENGTH}, correlation_lengths: [1 mm, 1 mm]"),
            ["both a correlation length"])
    refused("a length far below the body", strength(f"{kernel}, correlation_length: 1 um"),
            ["modes hold only", "random_field/white"])
    refused("a smooth kernel's length far below the body",
            strength(f"{kernel}, kernel: gaussian, correlation_length: 1 um"), ["far below"])
    refused("a domain that leaves points out",
            strength(f"{kernel}, {LENGTH}, domain: {{lower: [0 mm, 0 mm], upper: [15 mm, 10 mm]}}"),
            ["outside the field's domain", "point"])
    refused("an empty domain",
            strength(f"{kernel}, {LENGTH}, domain: {{lower: [5 mm, 0 mm], upper: [5 mm, 10 mm]}}"),
            ["no extent along x"])
    refused("values outside the physical range", strength("model: white", "mean: 90 MPa, cv: 0.9"),
            ["at point", "it must be"])
    refused("a density that varies",
            "density: {mean: 8960 kg/m3, cv: 0.01, field: {model: white}}",
            ["'density' cannot vary in space"])
    refused("an unknown field", strength("model: wite"), ["wite", "did you mean 'white'"])
    refused("a misspelt key of the field", strength("model: white, shap: 2"), ["shap", "shape"])
    refused("samples without their number", strength("model: karhunen_loeve, from: samples"),
            ["needs their number"])
    refused("a table with a place twice",
            strength("model: karhunen_loeve, from: table, values: "
                     "[[0 mm, 0 mm, 0 mm, 1], [0 mm, 0 mm, 0 mm, 2]]"), ["stands twice"])


def test_lengths():
    material = strength("model: karhunen_loeve, kernel: gaussian, correlation_length: 10 m")
    process, _ = scenes.attempt(scene(material, A))
    scenes.report(process.returncode == 0 and "nearly one random number" in process.stderr,
                  "a length far above the body: one mode, and a word", [process.stderr])
    material = strength("model: karhunen_loeve, correlation_length: 0.5 mm, energy: 0.8")
    process, _ = scenes.attempt(scene(material, A, cell="1 mm"))
    scenes.report(process.returncode == 0 and "near or below their spacing" in process.stderr,
                  "a length near the spacing: a warning", [process.stderr])
    table = strength("model: karhunen_loeve, from: table, values: "
                     "[[0 mm, 0 mm, 0 mm, -1], [20 mm, 0 mm, 0 mm, 1]]", "mean: 90 MPa, sd: 9 MPa")
    result = scenes.run(scene(table, f"{A}, position"))
    values, x = frame(result, A), frame(result, "position")
    expected = 90e6 + 9e6 * (x[:, 0] / 0.01 - 1)
    scenes.below("a field from a table, off its line, MPa",
                 np.max(np.abs(values - expected)) / 1e6, 1e-9)


test_distributions()
test_companions()
test_bits()
test_pressed()
test_study()
test_explain()
test_lengths()
test_refusals()
scenes.done()
