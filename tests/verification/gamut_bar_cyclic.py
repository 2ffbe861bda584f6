"""Loops of the deformation-gamut bar: closed, tips on the monotonic curve, energy as in the closed
form."""
import scenes
import numpy
from gamut_bar_scenes import CARD, GROWTH, OFFSET, STRESS_STRAIN, curve, strain_at, uneven_table, \
    write_scene

MEASURES = {**STRESS_STRAIN, "energy": "measure: loop_energy, reduce: at end",
            "closure": "measure: loop_closure",
            **{f"tip{k}": f"measure: level_strain, level: {k}, reduce: at end" for k in range(10)}}


def loop_energy(card, stress):
    """Of one loop of the doubled curve between -stress and stress."""
    n = card["n"]
    return 4 * stress * OFFSET * (stress / card["yield_stress"]) ** n * (n - 1) / (n + 1)


def even_bars():
    for material, card in CARD.items():
        tip = card["yield_stress"] * GROWTH ** 9
        errors = []
        for increments in (20, 40, 80):
            path = write_scene(f"loops-{material}-{increments}", "bonds: 100, grid: random, "
                               f"load: cyclic, increments: {increments}", MEASURES,
                               material=material)
            result = scenes.run(path)
            errors.append(result.value("energy") / loop_energy(card, tip) - 1)
            if increments == 40:
                tips_and_closure(material, card, result)
        scenes.below(f"{material}: energy of the last loop, 40 increments, relative", errors[1],
                     5e-3)
        scenes.report(abs(errors[2]) < 0.4 * abs(errors[1]) < 0.16 * abs(errors[0]) * 1.2,
                      f"{material}: the energy converges: off by {errors[0]:.2e}, {errors[1]:.2e}, "
                      f"{errors[2]:.2e} with 20, 40, 80 increments")


def tips_and_closure(material, card, result):
    off = max(abs(result.value(f"tip{k}")
                  - strain_at(card, card["yield_stress"] * GROWTH ** k)) for k in range(10))
    scenes.below(f"{material}: tips of ten levels against the monotonic curve, strain", off, 1e-9)
    closure = [v for v in result.summary["quantities"]["closure"]["values"] if v is not None]
    scenes.below(f"{material}: strain by which any loop does not close", max(map(abs, closure)),
                 1e-10)
    scenes.below(f"{material}: residual of the ledger", result.residual(), 1e-10)
    strain, stress = curve(result)
    # Each branch is the monotonic curve twice as large.
    last = len(stress) - 81
    down = slice(last, last + 41)
    branch = strain[down][0] - strain[down]
    exact = 2 * strain_at(card, (stress[down][0] - stress[down]) / 2)
    scenes.below(f"{material}: a falling branch against the doubled curve, strain",
                 max(abs(branch - exact)), 1e-9)


def uneven_bar():
    """A net of elements with Masing's memory has it as a whole."""
    for material, card in CARD.items():
        table = f"bonds: 200, bond_table: {uneven_table(200)}"
        path = write_scene(f"uneven-loops-{material}", f"{table}, load: cyclic, levels: 4, "
                           "increments: 20", {**STRESS_STRAIN, "closure": "measure: loop_closure",
                                              **{f"tip{k}": f"measure: level_strain, level: {k}, "
                                                 "reduce: at end" for k in range(4)}},
                           material=material)
        result = scenes.run(path)
        rising = curve(scenes.run(write_scene(f"uneven-rise-{material}", table, STRESS_STRAIN,
                                              material=material)))
        off = 0.0
        for k in range(4):
            at = numpy.argmin(abs(rising[1] / (card["yield_stress"] * GROWTH ** k) - 1))
            off = max(off, abs(result.value(f"tip{k}") - rising[0][at]))
        scenes.below(f"{material}, uneven: tips against the monotonic curve, strain", off, 1e-9)
        closure = [v for v in result.summary["quantities"]["closure"]["values"] if v is not None]
        scenes.below(f"{material}, uneven: strain by which any loop does not close",
                     max(map(abs, closure)), 1e-10)


def loops_in_loops():
    """A path that turns within itself comes back to each outer branch where it left it."""
    rows = [0, 560, -520, 480, -440, 400, 480, -520, 560]
    table = ", ".join(f"[{20 * k}, {value} MPa]" for k, value in enumerate(rows))
    path = write_scene("nested", f"bonds: 200, bond_table: {uneven_table(200)}, load: table, "
                       f"load_table: [{table}]", STRESS_STRAIN)
    strain, _ = curve(scenes.run(path))
    for first, again in ((3, 6), (2, 7), (1, 8)):
        scenes.below(f"back at {rows[first]} MPa after inner loops, strain",
                     strain[20 * again] - strain[20 * first], 1e-10)


even_bars()
uneven_bar()
loops_in_loops()
scenes.done()
