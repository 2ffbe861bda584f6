"""The deformation-gamut bar where it is hardest: reaches below the spacing, coincident bonds, what
it must refuse."""
import scenes
import numpy
from gamut_bar_scenes import CARD, STRESS_STRAIN, curve, strain_at, write_scene


def local_limit():
    """Weights to the next two bonds on either side. To one alone they cannot be: sums of one and
    action equal to reaction would leave pairs of bonds."""
    for material, card in CARD.items():
        path = write_scene("local-" + material, "bonds: 100, weight_deviation: 0.7 mm",
                           STRESS_STRAIN, material=material)
        strain, stress = curve(scenes.run(path))
        scenes.below(f"{material}, two neighbours on either side: difference from Ramberg and "
                     "Osgood in strain", max(abs(strain - strain_at(card, stress))), 1e-9)
    path = write_scene("patch", "bonds: 100, grid: random, weight_deviation: 2 mm, load: table, "
                       "load_table: [[1, 300 MPa], [2, 600 MPa]]",
                       {**STRESS_STRAIN, "deviation": "measure: strain_deviation"})
    deviation = scenes.run(path).summary["quantities"]["deviation"]["values"]
    scenes.below("uniform stress on a random grid: strain of a bond less the mean",
                 max(deviation), 1e-12)


def refused(name, solver, words, material="al7075", code=3, **more):
    path = write_scene(name, solver, STRESS_STRAIN, material=material, **more)
    process, _ = scenes.attempt(path)
    said = process.stderr.replace("\n", " ")
    scenes.report(process.returncode == code and all(word in said for word in words),
                  f"{name}: exit {code} with {', '.join(repr(w) for w in words)}",
                  [f"exit {process.returncode}", process.stderr])


def refusals():
    refused("reach-below-spacing", "bonds: 100, weight_deviation: 0.1 mm",
            ["no nonlocal bond within its reach"], code=5)
    refused("reach-of-one-bond", "bonds: 100, weight_deviation: 0.4 mm",
            ["must span two bonds"], code=5)
    rows = ", ".join("[1, 1, 1, 0, 1]" if i != 50 and i != 51 else "[1e-300, 1, 1, 0, 1]"
                     for i in range(100))
    refused("coincident-bonds", f"bonds: 100, bond_table: [{rows}]",
            ["bonds 50 and 51 lie at the same place"])
    refused("short-table", "bonds: 10, bond_table: [[1, 1, 1, 0, 1]]",
            ["bond_table", "1 rows for 10 bonds"])
    refused("no-load-table", "bonds: 10, load: table", ["load_table"])
    refused("table-back", "bonds: 10, load: table, load_table: [[2, 1 MPa], [1, 2 MPa]]",
            ["row 2"])
    refused("too-few-bonds", "bonds: 10, operator: interpolated", ["dense", "more than 10 bonds"])
    refused("noise-of-many-pairs", "bonds: 6000, noise: {weights: {model: white}}",
            ["fewer bonds"])


def other_strengths():
    """A strength without inverse, and one without a modulus of its own."""
    path = write_scene("johnson-cook", "bonds: 10", STRESS_STRAIN)
    with open(path, encoding="utf-8") as file:
        lines = [line for line in file.read().splitlines() if not line.startswith("include")]
    lines[1:1] = ["materials: {al7075: {density: 2810 kg/m3, strength: {model: johnson_cook, "
                  "A: 500 MPa, B: 300 MPa, n: 0.3, T_melt: 900 K}}}"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    process, _ = scenes.attempt(path)
    scenes.report(process.returncode == 3 and "inverse" in process.stderr,
                  "a strength without inverse is refused by name", [process.stderr])


def rupture():
    """The first broken family ends the run; told, it does not."""
    quantities = {**STRESS_STRAIN, "stress": "measure: rupture_stress, reduce: at end",
                  "strain": "measure: rupture_strain, reduce: at end",
                  "bond": "measure: rupture_bond, reduce: at end"}
    noise = "noise: {modulus: {model: white, distribution: weibull}, " \
            "softness: {model: white, distribution: weibull}}"
    runs = {}
    for what in ("stop", "report"):
        path = write_scene("rupture-" + what, f"bonds: 200, rupture: {what}, strain_limit: 0.2, "
                           + noise, quantities)
        runs[what] = scenes.run(path)
    same = all(runs["stop"].value(key) == runs["report"].value(key)
               for key in ("stress", "strain", "bond"))
    strain, stress = curve(runs["stop"])
    scenes.report(same and runs["stop"].value("strain") == strain[-1] and
                  runs["stop"].value("stress") == stress[-1],
                  "the run stops at the first broken family: bond "
                  f"{runs['stop'].value('bond'):.0f}, {stress[-1] / 1e6:.1f} MPa, strain "
                  f"{strain[-1]:.4f}")
    scenes.report(max(curve(runs["report"])[0]) > 0.2, "told only, it goes on to the strain limit")
    # Load control: the stress grows to the end, no limit point.
    scenes.report(bool(numpy.all(numpy.diff(curve(runs["report"])[0]) > 0)),
                  "the strain grows with the stress to the end")


local_limit()
refusals()
other_strengths()
rupture()
scenes.done()
