"""Reference formulas in 60-digit arithmetic, calls of gamut eval, scenes for the driver."""
import json
import math
import os
import subprocess
from decimal import Decimal, getcontext

import scenes

getcontext().prec = 60
ORACLES = json.load(open(os.path.join(scenes.HERE, "material_oracles.json"), encoding="utf-8"))
STEP = Decimal(10) ** -14

UNITS = {"C0": "m/s", "reference_density": "kg/m3", "energy": "J/m3", "A": "Pa", "B": "Pa",
         "reference_rate": "1/s", "T_room": "K", "T_melt": "K", "temperature": "K",
         "plastic_strain_rate": "1/s"}


# ---- the laws, written down a second time -------------------------------------------------------

def mie_gruneisen(v):
    mu, e = v["compression"], v["energy"]
    gamma = v["gamma0"] + v["a"] * mu
    stiffness = v["reference_density"] * v["C0"] ** 2
    if mu <= 0:
        return stiffness * mu + gamma * e
    x = mu / (1 + mu)
    pole = 1 - (v["S1"] - 1) * mu - v["S2"] * mu * x - v["S3"] * mu * x * x
    over = 1 + (1 - v["gamma0"] / 2) * mu - v["a"] / 2 * mu ** 2
    return stiffness * mu * over / pole ** 2 + gamma * e


def johnson_cook(v):
    strain, room, melt = v["plastic_strain"], v["T_room"], v["T_melt"]
    rate = max(v["plastic_strain_rate"] / v["reference_rate"], Decimal(1))
    warm = min(max((v["temperature"] - room) / (melt - room), Decimal(0)), Decimal(1))
    power = (v["n"] * strain.ln()).exp() if strain > 0 else Decimal(0)
    heat = (v["m"] * warm.ln()).exp() if warm > 0 else Decimal(0)
    return (v["A"] + v["B"] * power) * (1 + v["C"] * rate.ln()) * (1 - heat)


def exact(values):
    """The numbers that the program sees, digit by digit."""
    return {name: Decimal(value) for name, value in values.items()}


def differences(law, values, names):
    """First and second derivatives by central differences, good to more than 20 digits."""
    values = exact(values)
    step = {name: STEP * max(abs(values[name]), Decimal(1)) for name in names}

    def at(**moved):
        return law({**values, **{name: values[name] + by for name, by in moved.items()}})

    first, second = {}, {name: {} for name in names}
    for i in names:
        h = step[i]
        first[i] = (at(**{i: h}) - at(**{i: -h})) / (2 * h)
        second[i][i] = (at(**{i: h}) - 2 * at() + at(**{i: -h})) / h ** 2
        for j in names[:names.index(i)]:
            k = step[j]
            second[i][j] = second[j][i] = (
                at(**{i: h, j: k}) - at(**{i: h, j: -k}) - at(**{i: -h, j: k})
                + at(**{i: -h, j: -k})) / (4 * h * k)
    return law(values), first, second


# ---- gamut eval ---------------------------------------------------------------------------------

def pairs(values):
    return ",".join(f"{name}={float(value)!r} {UNITS.get(name, '')}".strip()
                    for name, value in values.items())


def evaluate(plugin, parameters, at, *extra):
    done = subprocess.run([scenes.GAMUT, "eval", plugin, "--no-user-plugins", "--json",
                           "--param", pairs(parameters), "--at", pairs(at), *extra],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise scenes.Failed(done.returncode, done.stderr)
    return json.loads(done.stdout)["points"][0]


# ---- the material driver ------------------------------------------------------------------------

def seconds(value):
    return f"{value!r} s"


def rows(table, unit):
    """Rows of time and value, as a scene writes them."""
    return [[seconds(float(t)), f"{float(v)!r} {unit}".strip() if unit else float(v)]
            for t, v in table]


def material(eos, strength, shear_modulus, density=7830.0, specific_heat=477.0):
    card = {"density": f"{density!r} kg/m3", "eos": eos,
            "elasticity": {"model": "hypoelastic", "shear_modulus": f"{shear_modulus!r} Pa"},
            "specific_heat": f"{specific_heat!r} J/(kg K)"}
    if strength:
        card["strength"] = strength
    return card


def linear_eos(bulk_modulus):
    return {"model": "linear", "bulk_modulus": f"{bulk_modulus!r} Pa"}


def von_mises(yield_stress, hardening_modulus=0.0):
    return {"model": "von_mises", "yield_stress": f"{yield_stress!r} Pa",
            "hardening_modulus": f"{hardening_modulus!r} Pa"}


def drive(card, control, end, steps, history=(), final=(), adiabatic=False, temperature=298.0,
          effects=None, extra=()):
    """Runs one point; `history` and `final` are names of fields or (measure, component)."""
    quantities = {}
    for names, when in ((history, {"every": seconds(end / steps)}), (final, {"reduce": "at end"})):
        for name in names:
            measure, component = name if isinstance(name, tuple) else (name, None)
            key = measure if component is None else f"{measure}_{component}"
            quantities[key] = {"measure": measure, **when}
            if component:
                quantities[key]["component"] = component
    scene = {"gamut": 1,
             "solver": {"model": "material_driver", "end": seconds(end), "steps": steps,
                        "control": control},
             "materials": {"metal": card},
             "bodies": {"sample": {"material": "metal", "temperature": f"{temperature!r} K"}},
             "quantities": quantities}
    scene["effects"] = dict(effects or {})
    if adiabatic:
        scene["effects"]["heat"] = {"model": "adiabatic_heating", "taylor_quinney": 0.9}
    path = scenes.written("driver", json.dumps(scene, indent=1))
    result = scenes.run(path, extra=extra)
    scenes.drop(result)
    return {name: entry.get("value", entry.get("values"))
            for name, entry in result.summary["quantities"].items()}


# ---- orders -------------------------------------------------------------------------------------

def order(coarse, fine, target):
    """Order of convergence from the errors at a step and at its half; infinite if they swing."""
    before, after = coarse - target, fine - target
    return math.log2(before / after) if before * after > 0.0 else math.inf


def eliminate(values, exponents):
    """Richardson: values at steps h, h/2, h/4, ..., errors in h to these powers."""
    values = list(values)
    for power in exponents[:len(values) - 1]:
        factor = 2.0 ** power
        values = [(factor * fine - coarse) / (factor - 1.0)
                  for coarse, fine in zip(values, values[1:])]
    return values[-1]


def apart(value, target):
    return abs(value - target) / abs(target)
