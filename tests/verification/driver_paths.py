"""The material driver on paths with closed forms: shear, uniaxial stress and strain, rotation."""
import math

import scenes
from laws import (ORACLES, apart, drive, eliminate, evaluate, linear_eos, material, order, rows,
                  von_mises)

EXACT = 1e-9
G, BULK, YIELD = 81.8e9, 163457208630.0, 792e6
SHEAR = {"xy": {"velocity_gradient": "1 1/s"}}
MIE_GRUNEISEN = {"C0": 4569.0, "S1": 1.49, "gamma0": 2.17, "a": 0.46}


# ---- simple shear -------------------------------------------------------------------------------

def elastic_shear():
    """Jaumann: s12 = G sin g, s11 = -s22 = G (1 - cos g); second order in the step."""
    card = material(linear_eos(BULK), None, G)
    names = ["stress_xy", "stress_xx", "stress_yy", "stress_zz"]
    worst, listed_worst, orders = 0.0, 0.0, []
    for g, listed in ORACLES["simple_shear_jaumann_elastic"].items():
        runs = [drive(card, SHEAR, float(g), steps, final=names) for steps in (32, 64, 128, 256)]
        exact = (math.sin(float(g)), 1.0 - math.cos(float(g)), math.cos(float(g)) - 1.0)
        for name, target, known in zip(names, exact, ("s12", "s11", "s22")):
            values = [run[name] / G for run in runs]
            limit = eliminate(values, [2, 4, 6])
            worst = max(worst, abs(limit - target) / math.sin(float(g)))
            listed_worst = max(listed_worst, abs(limit - listed[f"{known}_over_G"]))
            if float(g) >= 0.1 and abs(values[-1] - target) > 1e-9:
                orders.append(order(*values[-2:], target))
        worst = max(worst, max(abs(run["stress_zz"]) for run in runs) / G)
    scenes.below("elastic simple shear to g = pi/2: order of convergence apart from 2",
                 max(abs(o - 2.0) for o in orders), 0.02)
    scenes.below("elastic simple shear, extrapolated, against G sin g, G (1 - cos g)", worst, EXACT)
    scenes.below("elastic simple shear, extrapolated, against listed values over G",
                 listed_worst, EXACT)


def plastic_shear():
    """Perfectly plastic: s12 = sqrt(tau^2 - tau^4/G^2), s11 = tau^2/G in the end; first order."""
    oracle = ORACLES["simple_shear_perfect_plastic"]
    tau = YIELD / math.sqrt(3.0)
    target = {"stress_xy": math.sqrt(tau ** 2 - tau ** 4 / G ** 2), "stress_xx": tau ** 2 / G}
    card = material(linear_eos(BULK), von_mises(YIELD), G)
    steady = [drive(card, SHEAR, 1.0, steps, final=list(target))
              for steps in (8000, 16000, 32000, 64000)]
    for name, exact in target.items():
        values = [run[name] for run in steady]
        scenes.below(f"perfectly plastic simple shear, {name} at g = 1, 64000 steps: order of "
                     "convergence apart from 1", abs(order(*values[-2:], exact) - 1.0), 0.02)
        scenes.below("the same, extrapolated, over flow stress in shear",
                     abs(eliminate(values, [1, 2, 3]) - exact) / tau, EXACT)
    scenes.below("the same, steady values against the listed ones, relative",
                 max(apart(target["stress_xy"], oracle["steady_s12"]),
                     apart(target["stress_xx"], oracle["steady_s11"])), EXACT)
    runs = [drive(card, SHEAR, 0.1, steps, history=list(target))
            for steps in (2000, 4000, 8000, 16000)]
    worst = 0.0
    for g in ("0.01", "0.02", "0.1"):
        for name, known in (("stress_xy", "s12"), ("stress_xx", "s11")):
            values = [run[name][round(float(g) * 10 * (len(run[name]) - 1))] for run in runs]
            worst = max(worst, abs(eliminate(values, [1, 1]) - oracle["at"][g][known]) / tau)
    scenes.below("the same at g = 0.01, 0.02, 0.1 on the way, extrapolated, against listed values "
                 "over flow stress in shear", worst, 1e-6)


# ---- uniaxial stress ----------------------------------------------------------------------------

def stretch_of(stress, hardening):
    """Log strain under uniaxial stress, exact for pressure = K compression."""
    plastic = max(stress - YIELD, 0.0) / hardening
    return stress / (3 * G) + plastic - math.log1p(-stress / (3 * BULK)) / 3


def uniaxial_stress():
    oracle = ORACLES["uniaxial_stress_linear_hardening"]
    hardening = oracle["H"]
    card = material(linear_eos(BULK), von_mises(YIELD, hardening), G)
    pull = {"xx": {"log_strain": 0.05}, "yy": {"stress": "0 Pa"}, "zz": {"stress": "0 Pa"}}
    got = drive(card, pull, 1.0, 1000, history=["stress_xx", "stress_yy", ("log_strain", "xx")])
    worst = max(apart(stretch_of(stress, hardening), strain) for stress, strain in
                zip(got["stress_xx"][1:], got["log_strain_xx"][1:]))
    scenes.below("uniaxial stress, linear hardening, to strain 0.05: strain of every stress, "
                 "relative", worst, EXACT)
    small = max(apart(got["stress_xx"][round(float(strain) * 20000)], stress)
                for strain, stress in oracle["stress"].items())
    scenes.below("the same against listed values of small strain (apart by Y E / (18 K^2) at most)",
                 small, YIELD * oracle["E"] / (18 * BULK ** 2))
    coarse = drive(card, pull, 1.0, 10, final=["stress_xx", ("log_strain", "xx")])
    scenes.below("the same with 10 steps: the step's own strain is off by its square / 12",
                 apart(stretch_of(coarse["stress_xx"], hardening), 0.05), 0.005 ** 2 / 12)
    push = {"xx": {"stress": rows([(0, 0), (0.01, -790e6), (1, -850e6)], "Pa")},
            "yy": {"stress": "0 Pa"}, "zz": {"stress": "0 Pa"}, "xy": {"stress": "0 Pa"}}
    pushed = drive(card, push, 1.0, 1000, final=[("log_strain", "xx"), "plastic_strain"])
    due = -850e6 / (3 * G) - 58e6 / hardening - math.log1p(850e6 / (3 * BULK)) / 3
    scenes.below("uniaxial stress pushed by stress to -850 MPa: strain, relative",
                 apart(pushed["log_strain_xx"], due), EXACT)
    scenes.below("the same: plastic strain, relative", apart(pushed["plastic_strain"], 0.058),
                 EXACT)


# ---- uniaxial strain ----------------------------------------------------------------------------

def uniaxial_strain():
    """stress_xx = -(p(mu) + 2/3 Y), mu = exp(e) - 1 for a compression by the log strain e."""
    names = ["stress_xx", "stress_yy", "energy", "compression"]
    card = material(linear_eos(BULK), von_mises(YIELD), G)
    worst = 0.0
    for steps in (1, 7, 100):
        got = drive(card, {"xx": {"log_strain": -0.1}}, 1e-6, steps, final=names)
        mu = math.expm1(0.1)
        worst = max(worst, apart(got["stress_xx"], -(BULK * mu + 2 / 3 * YIELD)),
                    apart(got["stress_yy"], -(BULK * mu - YIELD / 3)))
    scenes.below("uniaxial strain -0.1 in 1, 7, 100 steps: stress, relative", worst, EXACT)
    eos = {"model": "mie_gruneisen", **MIE_GRUNEISEN, "C0": "4569 m/s"}
    card = material(eos, von_mises(YIELD), G)
    got = drive(card, {"xx": {"log_strain": -0.1}}, 1e-6, 50, history=names)
    worst = 0.0
    for i in range(5, 51, 5):
        point = evaluate("eos/mie_gruneisen", MIE_GRUNEISEN,
                         {"compression": got["compression"][i], "energy": got["energy"][i],
                          "reference_density": 7830.0})
        due = -(point["outputs"]["pressure"] + 2 / 3 * YIELD)
        worst = max(worst, apart(got["stress_xx"][i], due))
    scenes.below("uniaxial strain, Mie-Gruneisen: stress against -(p + 2/3 Y) at the point's own "
                 "compression and energy, relative", worst, EXACT)


# ---- what a path must keep ----------------------------------------------------------------------

def rotation():
    """A stretched point that is turned: the stress turns with it, whatever the step."""
    card = material(linear_eos(BULK), None, G)
    quarter = math.pi / 2
    path = {"xx": {"log_strain": rows([(0, 0), (1, 0.001), (2, 0.001)], "")},
            "xy": {"velocity_gradient": rows([(1, 0), (1, -quarter)], "1/s")},
            "yx": {"velocity_gradient": rows([(1, 0), (1, quarter)], "1/s")}}
    names = ["stress_xx", "stress_yy", "stress_zz", "stress_xy", ("log_strain", "yy")]
    worst = 0.0
    for steps in (2, 6, 20):
        got = drive(card, path, 2.0, steps, final=names, history=())
        unturned = drive(card, {"xx": {"log_strain": 0.001}}, 1.0, steps // 2, final=names)
        worst = max(worst, apart(got["stress_yy"], unturned["stress_xx"]),
                    apart(got["stress_xx"], unturned["stress_yy"]),
                    abs(got["stress_xy"] / got["stress_yy"]),
                    apart(got["log_strain_yy"], 0.001))
    scenes.below("stretched, then turned by 90 degrees in 1, 3, 10 steps: stress and strain",
                 worst, EXACT)


def tables():
    """Rates of a table are integrated exactly; an engineering strain is reached."""
    card = material(linear_eos(BULK), None, G)
    ramp = {"xx": {"strain_rate": rows([(0, 0), (0.3, 0.2), (0.3, -0.1), (1, 0.1)], "1/s")}}
    worst = 0.0
    for steps in (1, 3, 11):
        got = drive(card, ramp, 1.0, steps, final=[("log_strain", "xx")])
        worst = max(worst, apart(got["log_strain_xx"], 0.03))
    scenes.below("strain of a table of rates with a jump, in 1, 3, 11 steps, relative", worst,
                 EXACT)
    got = drive(card, {"xx": {"engineering_strain": 0.02}}, 1.0, 7,
                final=[("log_strain", "xx"), ("engineering_strain", "xx")])
    scenes.below("engineering strain 0.02, relative", max(
        apart(got["engineering_strain_xx"], 0.02), apart(got["log_strain_xx"], math.log(1.02))),
                 EXACT)


def refused():
    """Paths that no point can go: the component, or the place in the scene, is named."""
    card = material(linear_eos(BULK), von_mises(YIELD), G)
    free = {"yy": {"stress": "0 Pa"}, "zz": {"stress": "0 Pa"}}
    fluid = material(linear_eos(BULK), None, 0.0)
    cases = (
        ("stress beyond flow", card, {"xx": {"stress": "900 MPa"}, **free}, 5, "stress xx of body"),
        ("shear stress of a fluid", fluid, {"xy": {"stress": "1 MPa"}}, 5, "stress xy of body"),
        ("strain and stress at once", card, {"xx": {"stress": "0 Pa", "log_strain": 0.1}}, 3,
         "xx is controlled twice"),
        ("mirror image moved twice", card, {"xy": {"stress": "0 Pa"}, "yx": {
            "velocity_gradient": "1 1/s"}}, 3, "solver.control.yx"),
        ("time that goes back", card, {"xx": {"stress": rows([(1, 0), (0, 0)], "Pa")}}, 3, "row 2"),
        ("no control", card, {}, 3, "no component is controlled"),
        ("no length left", card, {"xx": {"engineering_strain": -1}}, 3, "leaves no length"))
    for name, metal, control, code, words in cases:
        got, said = 0, ""
        try:
            drive(metal, control, 1.0, 4)
        except scenes.Failed as failure:
            got, said = failure.code, failure.said
        scenes.report(got == code and words in said,
                      f"{name}: exit {got} (due {code}), naming '{words}'", [said])


elastic_shear()
plastic_shear()
uniaxial_stress()
uniaxial_strain()
rotation()
tables()
refused()
scenes.done()
