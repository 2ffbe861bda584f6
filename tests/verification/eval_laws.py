"""Values, first and second derivatives of Mie-Gruneisen and Johnson-Cook, relative 1e-12."""
import random

import scenes
from laws import ORACLES, differences, evaluate, exact, johnson_cook, mie_gruneisen

TOLERANCE = 1e-12
EOS = ("eos/mie_gruneisen", "pressure", mie_gruneisen,
       ["C0", "S1", "S2", "S3", "gamma0", "a", "reference_density"],
       ["compression", "energy", "reference_density"])
STRENGTH = ("strength/johnson_cook", "flow_stress", johnson_cook, ["A", "B", "C", "n", "m"],
            ["plastic_strain", "plastic_strain_rate", "temperature"])


def got(kind, values):
    plugin, output, _, by, at = kind
    point = evaluate(plugin, {k: v for k, v in values.items() if k not in at},
                     {k: values[k] for k in at}, "--derivatives")
    return (point["outputs"][output], {i: point["derivatives"][output][i] for i in by},
            {i: {j: point["second_derivatives"][output][i][j] for j in by} for i in by})


def off(value, target):
    """Relative; where the target is zero, zero is due."""
    target = float(target)
    return abs(value - target) / abs(target) if abs(target) > 1e-200 else abs(value)


def clean(target, scale):
    """A derivative that is zero comes out of differences as their rounding."""
    return target if abs(target) > scale * exact({"x": 1e-18})["x"] else target * 0


def distances(kind, values, reference):
    value, first, second = got(kind, values)
    by, (target, targets, pair_targets) = kind[3], reference
    return (off(value, target), max(off(first[i], targets[i]) for i in by),
            max(off(second[i][j], pair_targets[i][j]) for i in by for j in by))


def told(name, worst):
    for what, figure in zip(("value", "first derivatives", "second derivatives"), worst):
        scenes.below(f"{name}: {what}", figure, TOLERANCE)


def oracle(kind, key, names, values):
    """A listed state; `names` translates the oracle's parameters."""
    entry = ORACLES["derivatives"][key]
    own = [names.get(p, p) for p in entry["params"]]
    first = dict(zip(own, entry["first"]))
    second = {i: dict(zip(own, row)) for i, row in zip(own, entry["second"])}
    told(f"{kind[0]}, listed state {key}",
         distances(kind, values, (entry["value"], first, second)))


def listed():
    for key in ("eos_compression_generic", "eos_compression_steel", "eos_expansion_steel"):
        s = dict(ORACLES["derivatives"][key]["state"])
        s = {"compression": s.pop("mu"), "energy": s.pop("e"), "reference_density": s.pop("rho0"),
             **s}
        oracle(EOS, key, {"rho0": "reference_density"}, s)
    s = dict(ORACLES["derivatives"]["jc_generic"]["state"])
    s = {"plastic_strain": s.pop("eps"), "plastic_strain_rate": s.pop("r"),
         "temperature": 298.0 + s.pop("T") * 1495.0, "T_room": 298.0, "T_melt": 1793.0,
         "reference_rate": 1.0, **s}
    oracle(STRENGTH, "jc_generic", {}, s)


def draw_eos(pick, expanded):
    return {"C0": pick(1500, 6000), "S1": pick(1.0, 2.2), "S2": pick(-0.5, 0.5),
            "S3": pick(-0.3, 0.3), "gamma0": pick(0.5, 2.5), "a": pick(0, 1),
            "reference_density": pick(1000, 9000),
            "compression": pick(-0.15, -1e-4) if expanded else pick(1e-4, 0.4),
            "energy": pick(0.2e9, 9e9)}


def draw_strength(pick, _):
    room = pick(280, 300)
    melt = pick(900, 2000)
    return {"A": pick(5e7, 1e9), "B": pick(1e8, 1e9), "C": pick(0.005, 0.06), "n": pick(0.1, 0.9),
            "m": pick(0.5, 1.5), "reference_rate": pick(0.1, 10), "T_room": room, "T_melt": melt,
            "plastic_strain": 10 ** pick(-6, 0.3), "plastic_strain_rate": 10 ** pick(1.5, 7),
            "temperature": room + pick(0.02, 0.95) * (melt - room)}


def zeros_cleaned(reference, values, by):
    value, first, second = reference
    size = {i: abs(value) / max(abs(exact(values)[i]), exact({"x": 1.0})["x"]) for i in by}
    return (value, first, {i: {j: clean(second[i][j], size[i] * size[j] / abs(value))
                               for j in by} for i in by})


def drawn(kind, draw, count, seed):
    generator = random.Random(seed)
    worst = [0.0, 0.0, 0.0]
    for n in range(count):
        values = draw(generator.uniform, n % 4 == 3)
        if kind is EOS and n % 4 == 2:
            values["S2"] = values["S3"] = 0.0
        reference = zeros_cleaned(differences(kind[2], values, kind[3]), values, kind[3])
        worst = [max(w, d) for w, d in zip(worst, distances(kind, values, reference))]
    told(f"{kind[0]}, {count} drawn states, against differences with 60 digits", worst)


def limits():
    """Johnson-Cook where strain is none or tiny, rate is low, temperature outside."""
    steel = {"A": 792e6, "B": 510e6, "C": 0.014, "n": 0.26, "m": 1.03, "reference_rate": 1.0,
             "T_room": 298.0, "T_melt": 1793.0}
    cases = {"no plastic strain": (0.0, 1e3, 400.0), "plastic strain 1e-300": (1e-300, 1e3, 400.0),
             "plastic strain 1e-12": (1e-12, 1e3, 400.0), "no rate": (0.1, 0.0, 400.0),
             "half the reference rate": (0.1, 0.5, 400.0), "below room": (0.1, 1e3, 200.0),
             "hair above room": (0.1, 1e3, 298.0 + 1495e-9), "melt": (0.1, 1e3, 1793.0),
             "above melt": (0.1, 1e3, 2500.0)}
    worst = 0.0
    for strain, rate, temperature in cases.values():
        at = {"plastic_strain": strain, "plastic_strain_rate": rate, "temperature": temperature}
        point = evaluate("strength/johnson_cook", steel, at, "--derivatives")
        target = johnson_cook(exact({**steel, **at}))
        worst = max(worst, off(point["outputs"]["flow_stress"], target))
        numbers = [*point["outputs"].values(), *point["derivatives"]["flow_stress"].values()]
        worst = max([worst] + [1.0 for x in numbers if x is None])
    scenes.below(f"strength/johnson_cook, {len(cases)} limits: flow stress, all numbers finite",
                 worst, TOLERANCE)


listed()
drawn(EOS, draw_eos, 40, 1)
drawn(STRENGTH, draw_strength, 40, 2)
limits()
scenes.done()
