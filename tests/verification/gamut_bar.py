"""The deformation-gamut bar against Ramberg and Osgood's curve and numbers of an independent
program."""
import scenes
import numpy
from gamut_bar_scenes import CARD, OFFSET, REFERENCE, STRESS_STRAIN, curve, frame, strain_at, \
    uneven_table, wavy_table, write_scene


# ---- the same material everywhere ---------------------------------------------------------------

def uniform_bars():
    for material, card in CARD.items():
        for grid in ("uniform", "random"):
            result = scenes.run("bar_" + material, {"solver.grid": grid})
            strain, stress = curve(result)
            exact = strain_at(card, stress)
            scenes.below(f"{material}, {grid} grid, {len(stress)} points: largest difference from "
                         "Ramberg and Osgood in strain", max(abs(strain - exact)), 1e-9)
            scenes.below(f"{material}, {grid} grid: the same, relative",
                         max(abs(strain[1:] / exact[1:] - 1)), 1e-9)
            scenes.below(f"{material}, {grid} grid: residual of the ledger", result.residual(),
                         1e-10)
            fits(material, grid, result)


def fits(material, grid, result):
    """n' and K' of both definitions; engineering they are closed forms."""
    card, wanted = CARD[material], REFERENCE[material]["cyclic"]
    if grid != "uniform":
        return
    scenes.within(f"{material}: n', engineering", result.value("n_prime"), 1 / card["n"], 1e-7)
    scenes.within(f"{material}: K', engineering", result.value("K_prime"),
                  card["yield_stress"] * OFFSET ** (-1 / card["n"]), 1e-7, "MPa", 1e6)
    true = wanted["true (table definition)"]
    scenes.within(f"{material}: n', true, ten levels", result.value("n_prime_true"), true["n"],
                  1e-7)
    scenes.within(f"{material}: K', true, ten levels", result.value("K_prime_true"),
                  true["K_MPa"] * 1e6, 1e-7, "MPa", 1e6)


def softness_along_the_curve():
    """Energy, secant and tangent softness at listed stresses."""
    for material, card in CARD.items():
        rows = REFERENCE[material]["softness_table"]
        steps = ", ".join(f"[{k + 1}, {row[0]!r} Pa]" for k, row in enumerate(rows))
        path = write_scene("softness-" + material,
                           f"bonds: 60, load: table, load_table: [{steps}], rupture: report",
                           {**STRESS_STRAIN, "shared": "measure: total_nonlocal_gamut",
                            "left": "measure: total_local_gamut"}, material=material)
        result = scenes.run(path)
        strain, stress = curve(result)
        shared = numpy.array(result.summary["quantities"]["shared"]["values"]) / 1e-5
        left = numpy.array(result.summary["quantities"]["left"]["values"]) / 1e-5
        brittle = 0.5 * card["E"] * strain ** 2
        worst = [0.0, 0.0, 0.0, 0.0]
        for k, row in enumerate(rows, 1):
            secant = 1 - stress[k] / (card["E"] * strain[k])
            # Far beyond failure the tangent modulus is 1e-5 of the elastic one: rounding counts.
            off = abs(strain[k] / row[1] - 1)
            worst[0] = max(worst[0], off if strain[k] < 1 else off / 10)
            worst[1] = max(worst[1], abs(shared[k] / brittle[k] / row[2] - 1))
            worst[2] = max(worst[2], abs(secant - row[3]))
            worst[3] = max(worst[3], abs(left[k] / shared[k] - 1))
        scenes.below(f"{material}: strain at ten listed stresses, relative", worst[0], 1e-9)
        scenes.below(f"{material}: softness by energy, relative", worst[1], 1e-8)
        scenes.below(f"{material}: softness by secant", worst[2], 1e-9)
        scenes.below(f"{material}: local and nonlocal gamuts at uniform strain, relative",
                     worst[3], 1e-9)


def listed_points():
    for material, card in CARD.items():
        worst = max(abs(strain_at(card, stress) / strain - 1)
                    for strain, stress in REFERENCE[material]["stress_strain"])
        scenes.below(f"{material}: listed points of the curve lie on the law, strain relative",
                     worst, 1e-9)


def weights():
    """Softness at failure and standard deviations of the weights in a uniform bar."""
    fields = ["softness", "interaction_length", "yield_factor", "bond_state"]
    for material in CARD:
        listed = REFERENCE[material]
        path = write_scene("weights-" + material, "bonds: 500", STRESS_STRAIN, fields, material)
        result = scenes.run(path)
        got = frame(result, 0)
        scenes.below(f"{material}: softness at the failure point, relative",
                     max(abs(got["softness"] / listed["R_at_paper_failure_point"] - 1)), 1e-12)
        scenes.below(f"{material}: factor of the yield stress without noise, less 1",
                     max(abs(got["yield_factor"] - 1)), 1e-14)
        for where, value in listed["sigma_stdev"].items():
            p = int(where.split("=")[1].split()[0])
            scenes.below(f"{material}: standard deviation of the weights at bond {p}, relative",
                         got["interaction_length"][p] / value - 1, 1e-12)
        state = frame(result)["bond_state"]
        scenes.report(all(state == 2), f"{material}: all families broke at the end",
                      [f"{sum(state != 2)} did not"])


# ---- a bar that is uneven in everything ---------------------------------------------------------

def uneven_bar():
    for material in CARD:
        listed = REFERENCE[material]["uneven"]
        path = write_scene("uneven-" + material,
                           f"bonds: 500, rupture: report, bond_table: {uneven_table(500)}",
                           STRESS_STRAIN, ["interaction_length", "yield_factor"], material)
        result = scenes.run(path)
        got = frame(result, 0)
        for p in (0, 249):
            scenes.below(f"{material}, uneven: standard deviation of the weights at bond {p}, "
                         "relative",
                         got["interaction_length"][p] / listed[f"sigma_stdev_p{p}"] - 1, 1e-10)
            scenes.below(f"{material}, uneven: factor of the yield stress at bond {p}, relative",
                         got["yield_factor"][p] / listed[f"kappa_p{p}"] - 1, 1e-12)
        strain, stress = curve(result)
        worst = 0.0
        for _, wanted_stress, wanted_strain in listed["ladder"]:
            k = numpy.argmin(abs(stress - wanted_stress))
            worst = max(worst, abs(strain[k] / wanted_strain - 1),
                        abs(stress[k] / wanted_stress - 1))
        scenes.below(f"{material}, uneven: strain at {len(listed['ladder'])} listed stresses, "
                     "relative", worst, 1e-7)


# ---- other ways to cut the bar ------------------------------------------------------------------

def numbers_of_bonds():
    """With Eq. 31 the length of interaction itself shrinks with the logarithm of the number of
    bonds; a bar that varies along its length then feels it. With a given length it does not."""
    at = numpy.linspace(0.001, 0.099, 400)
    for name, extra, allowed in (("given length of interaction", "weight_deviation: 8 mm", 1e-3),
                                 ("length of Eq. 31", "pair_exponent: 6", 1e-2)):
        curves = {}
        for bonds in (50, 500, 5000):
            path = write_scene(f"bonds-{bonds}", f"bonds: {bonds}, {extra}, strain_limit: 0.1, "
                               f"bond_table: {wavy_table(bonds)}, rupture: report", STRESS_STRAIN)
            curves[bonds] = numpy.interp(at, *curve(scenes.run(path)))
        for bonds in (50, 500):
            scenes.below(f"{bonds} bonds against 5000, {name}, wavy bar: stress at the same "
                         "strain, relative", max(abs(curves[bonds] / curves[5000] - 1)), allowed)
    for bonds in (50, 5000):
        path = write_scene(f"even-{bonds}", f"bonds: {bonds}, grid: random", STRESS_STRAIN)
        strain, stress = curve(scenes.run(path))
        scenes.below(f"{bonds} bonds on a random grid: difference from Ramberg and Osgood, strain",
                     max(abs(strain - strain_at(CARD["al7075"], stress))), 1e-9)


def operators():
    """The interpolated operator against rows; it has no end of reach at three deviations."""
    for name, table in (("uneven", uneven_table(1500)), ("wavy", wavy_table(1500))):
        curves = {}
        for operator in ("dense", "interpolated"):
            path = write_scene("operator-" + operator, f"bonds: 1500, operator: {operator}, "
                               f"bond_table: {table}, rupture: report", STRESS_STRAIN)
            curves[operator] = curve(scenes.run(path))
        at = numpy.linspace(0.001, 0.11, 400)
        dense = numpy.interp(at, *curves["dense"])
        worst = max(abs(numpy.interp(at, *curves["interpolated"]) / dense - 1))
        scenes.below(f"interpolated against dense operator, {name} bar of 1500 bonds: stress at "
                     "the same strain, relative", worst, 2e-3)
    path = write_scene("operator-uniform", "bonds: 3000, grid: random, operator: interpolated",
                       STRESS_STRAIN, material="ti64")
    strain, stress = curve(scenes.run(path))
    scenes.below("interpolated operator, uniform material on a random grid: difference from "
                 "Ramberg and Osgood in strain",
                 max(abs(strain - strain_at(CARD["ti64"], stress))), 1e-9)


def tapered_bar():
    """Without yielding every bond has the strain of its own area."""
    rows = ", ".join(f"[1, {1 + 0.5 * i / 99!r}, 1, 0, 1]" for i in range(100))
    path = write_scene("tapered", f"bonds: 100, bond_table: [{rows}], load: table, "
                       "load_table: [[1, 50 MPa]]", STRESS_STRAIN,
                       ["strain", "stress_xx", "bond_area"])
    result = scenes.run(path)
    got = frame(result)
    force = 50e6 * 1e-4 * numpy.mean(1 + 0.5 * numpy.arange(100) / 99)
    scenes.below("tapered bar: stress of each bond from force and area, relative",
                 max(abs(got["stress_xx"] * got["bond_area"] / force - 1)), 1e-12)
    scenes.below("tapered bar, elastic: strain of each bond, relative",
                 max(abs(got["strain"] * 71.6e9 * got["bond_area"] / force - 1)), 1e-9)


def inertia():
    """Steps of two pi periods feel next to no inertia; shorter ones do at first."""
    start = "bonds: 200, start: 0.001, strain_limit: 0.02"
    still = curve(scenes.run(write_scene("still", start, STRESS_STRAIN)))
    moving = curve(scenes.run(write_scene("moving", start + ", dynamics: backward_euler",
                                          STRESS_STRAIN)))
    off = abs(moving[0][1:] / still[0][1:] - 1)
    elastic = still[1][1:] < 0.3 * CARD["al7075"]["yield_stress"]
    scenes.below("backward Euler against equilibrium from step 6 on, elastic, strain relative",
                 max(off[elastic][5:]), 1e-6)
    scenes.below("backward Euler against equilibrium to a strain of 0.02, strain relative",
                 max(off[5:]), 1e-2)
    short = scenes.run(write_scene("short", "bonds: 200, dynamics: backward_euler, "
                                   "time_step: 1 us, load: table, "
                                   "load_table: [[1, 50 MPa], [2000, 50 MPa]]", STRESS_STRAIN))
    strain, _ = curve(short)
    scenes.report(max(strain) > 1.2 * strain[-1],
                  f"a sudden force overshoots: {max(strain) / strain[-1]:.3f} times the strain at "
                  "rest (at least 1.2)")
    scenes.below("and comes to rest at the strain of equilibrium, relative",
                 strain[-1] / (50e6 / 71.6e9) - 1, 1e-6)
    scenes.below("residual of the ledger with inertia", short.residual(), 1e-10)


scenes.note("numbers of an independent program, closed forms")
listed_points()
uniform_bars()
softness_along_the_curve()
weights()
uneven_bar()
numbers_of_bonds()
operators()
tapered_bar()
inertia()
scenes.done()
