"""The material driver against flow curves of Johnson and Cook, and single steps of the return."""
import math
from decimal import Decimal

import scenes
from laws import (ORACLES, apart, drive, eliminate, exact, evaluate, johnson_cook, linear_eos,
                  material, order, rows, seconds)

EXACT = 1e-9
BULK = 163.4572e9
RIGID = 1e20  # shear modulus that leaves no elastic strain: the whole strain is plastic


def law(p, rate_dependent=True):
    return {"model": "johnson_cook", "A": f"{p['A']!r} Pa", "B": f"{p['B']!r} Pa", "n": p["n"],
            "C": p["C"] if rate_dependent else 0, "m": p["m"],
            "reference_rate": f"{p['eps0']!r} 1/s", "T_room": f"{p['Troom']!r} K",
            "T_melt": f"{p['Tm']!r} K"}


def numbers(p):
    return {"A": p["A"], "B": p["B"], "n": p["n"], "C": p["C"], "m": p["m"],
            "reference_rate": p["eps0"], "T_room": p["Troom"], "T_melt": p["Tm"]}


def flow_stress(p, strain, rate, temperature, rate_dependent=True):
    values = exact({**numbers(p), "plastic_strain": strain, "plastic_strain_rate": rate,
                    "temperature": temperature})
    if not rate_dependent:
        values["C"] = Decimal(0)
    return float(johnson_cook(values))


def shear(rate):
    """Simple shear at a given equivalent rate."""
    return {"xy": {"velocity_gradient": f"{math.sqrt(3.0) * rate!r} 1/s"}}


# ---- jc_curve -----------------------------------------------------------------------------------

def isothermal(p, curves, card):
    worst = 0.0
    for rate, curve in curves.items():
        listed = curve["isothermal"]
        onset = evaluate("strength/johnson_cook", numbers(p),
                         {"plastic_strain": 0.0, "plastic_strain_rate": float(rate),
                          "temperature": 298.0})["outputs"]["flow_stress"]
        worst = max(worst, apart(onset, listed["0.0"]))
        got = drive(card, shear(float(rate)), 1.0 / float(rate), 1000, history=["von_mises"])
        worst = max([worst] + [apart(got["von_mises"][round(float(e) * 1000)], stress)
                               for e, stress in listed.items() if e != "0.0"])
    return worst


def adiabatic_reference(p, rate, pieces=4000):
    """Temperature and stress at plastic strain 1, Runge-Kutta; strain = s^12 smooths strain^n."""
    heat = 0.9 / (p["rho"] * p["cp"])
    factor = 1.0 + p["C"] * math.log(max(rate / p["eps0"], 1.0))

    def stress(strain, t):
        warm = max((t - p["Troom"]) / (p["Tm"] - p["Troom"]), 0.0) ** p["m"]
        return (p["A"] + p["B"] * strain ** p["n"]) * factor * (1.0 - warm)

    def slope(s, t):
        return heat * stress(s ** 12, t) * 12.0 * s ** 11

    t, h = 298.0, 1.0 / pieces
    for i in range(pieces):
        s = i * h
        k1 = slope(s, t)
        k2 = slope(s + h / 2, t + h / 2 * k1)
        k3 = slope(s + h / 2, t + h / 2 * k2)
        t += h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(s + h, t + h * k3))
    return stress(1.0, t), t


def adiabatic(p, curves, card):
    """Order of convergence, distance to the listed values (8 digits) and to a quadrature."""
    orders, listed, own = [], 0.0, 0.0
    for rate, curve in curves.items():
        got = [drive(card, shear(float(rate)), 1.0 / float(rate), steps,
                     final=["von_mises", "temperature"], adiabatic=True)
               for steps in (250, 500, 1000, 2000, 4000, 8000)]
        targets = adiabatic_reference(p, float(rate))
        table = curve["adiabatic_chi0p9"]["1.0"]
        for name, target, known in zip(("von_mises", "temperature"), targets,
                                       (table["sigma"], table["T"])):
            values = [g[name] for g in got]
            orders.append(order(*values[-2:], target))
            limit = eliminate(values, [1, 1 + p["n"], 2, 2 + p["n"], 3])
            listed, own = max(listed, apart(limit, known)), max(own, apart(limit, target))
    return max(abs(each - 1.0) for each in orders), listed, own


def curves():
    for name, entry in ORACLES["jc_curve"].items():
        p = entry["params"]
        card = material(linear_eos(BULK), law(p), RIGID, p["rho"], p["cp"])
        scenes.below(f"{name}, isothermal curves at rates 1, 1e3, 1e5 and strains 0 to 1, relative",
                     isothermal(p, entry["curves"], card), EXACT)
        off, listed, own = adiabatic(p, entry["curves"], card)
        scenes.below(f"{name}, adiabatic, 8000 steps: order of convergence apart from 1", off,
                     0.02)
        scenes.below(f"{name}, adiabatic, extrapolated, against listed values (8 digits)", listed,
                     1e-8)
        scenes.below(f"{name}, adiabatic, extrapolated, against quadrature", own, EXACT)


def own_stiffness():
    """Steel as it is, pulled: the stress is the law's at the point's own strain and rate."""
    p = ORACLES["jc_curve"]["steel4340"]["params"]
    card = material({"model": "mie_gruneisen", "C0": "4569 m/s", "S1": 1.49, "gamma0": 2.17,
                     "a": 0.46}, law(p), 81.8e9, p["rho"], p["cp"])
    pull = {"xx": {"strain_rate": "1000 1/s"}, "yy": {"stress": "0 Pa"}, "zz": {"stress": "0 Pa"}}
    names = ["von_mises", "plastic_strain", "plastic_strain_rate", "temperature", "stress_xx",
             "stress_yy", "stress_zz"]
    got = drive(card, pull, 1e-3, 500, history=names, adiabatic=True)
    worst, lateral = 0.0, 0.0
    for i in range(1, 501):
        if got["plastic_strain"][i] > got["plastic_strain"][i - 1]:
            rate = got["plastic_strain"][i] - got["plastic_strain"][i - 1]
            target = flow_stress(p, got["plastic_strain"][i], rate / 2e-6,
                                 got["temperature"][i - 1])
            worst = max(worst, apart(got["von_mises"][i], target))
        lateral = max(lateral, max(abs(got["stress_yy"][i]), abs(got["stress_zz"][i]))
                      / abs(got["stress_xx"][i]))
    scenes.below("4340 pulled at 1000 1/s, adiabatic, 500 steps: stress against the law at the "
                 "point's state, relative", worst, EXACT)
    scenes.below("the same: lateral stress over axial stress", lateral, 1e-10)


def scene_of_inputs():
    """inputs/driver_johnson_cook.yaml as it stands, and at constant temperature."""
    p = ORACLES["jc_curve"]["steel4340"]["params"]
    for name, changes in (("adiabatic", {}), ("isothermal", {"effects.heat.enabled": "off"})):
        run = scenes.run("driver_johnson_cook", changes)
        times, strains = run.history("plastic_strain")
        rate = (strains[-1] - strains[-2]) / (times[-1] - times[-2])
        warm = run.history("temperature")[1][-1]
        stress = run.value("final_stress")
        scenes.below(f"driver_johnson_cook.yaml, {name}, {stress / 1e6:.1f} MPa, {warm:.1f} K: "
                     "stress against the law at the last state (temperature of a step before)",
                     apart(stress, flow_stress(p, strains[-1], rate, warm)), 2e-4)
        scenes.below("the same: strain, relative", apart(run.history("strain")[1][-1], 0.5), EXACT)
        scenes.below("the same: lateral stress over axial", run.value("lateral_stress") / stress,
                     1e-10)
        scenes.below("the same: ledger", run.residual(), 1e-10)


# ---- radial return ------------------------------------------------------------------------------

def pull_of(strain):
    """The log strain for which the step's own increment of strain is `strain`."""
    return 2.0 * math.atanh(strain / 2.0)


def stretched(first, second, dt):
    """Two isochoric steps with these equivalent strains."""
    def table(share):
        one = pull_of(share * first)
        return {"log_strain": rows([(0.0, 0.0), (dt, one), (2 * dt, one + pull_of(share * second))],
                                   "")}
    return {"xx": table(1.0), "yy": table(-0.5), "zz": table(-0.5)}


def one_step(case, p, modulus):
    """Brings the point to the plastic strain of the case, then to its trial stress."""
    dt, before = case["dt"], case["eps0"]
    rate_dependent = case["rate_dep"]
    card = material(linear_eos(BULK), law(p, rate_dependent), modulus, p["rho"], p["cp"])
    start = (flow_stress(p, before, before / dt, case["T"], rate_dependent) if before else 0.0)
    first = before + start / (3 * modulus)
    second = (case["sig_trial"] - start) / (3 * modulus)
    got = drive(card, stretched(first, second, dt), 2 * dt, 2,
                history=["von_mises", "plastic_strain"], temperature=case["T"])
    increment = got["plastic_strain"][2] - got["plastic_strain"][1]
    if case["elastic"]:
        return abs(increment), apart(got["von_mises"][2], case["sig_trial"])
    return apart(increment, case["delta_ep"]), apart(got["von_mises"][2], case["sig_y_new"])


def radial_return():
    p = ORACLES["jc_curve"]["steel4340"]["params"]
    for case in ORACLES["radial_return"]["one_step_implicit"]:
        strain, stress = one_step(case, p, 81.8e9)
        name = (f"return from plastic strain {case['eps0']:g}, trial {case['sig_trial'] / 1e6:g} "
                f"MPa in {seconds(case['dt'])}, {case['T']:g} K"
                f"{'' if case['rate_dep'] else ', no rate'}")
        scenes.below(f"{name}: plastic increment" + ("" if case["elastic"] else ", relative"),
                     strain, EXACT)
        scenes.below(f"{name}: stress, relative", stress, EXACT)


curves()
own_stiffness()
scene_of_inputs()
radial_return()
scenes.done()
