"""Inputs that may be absent; fields that several effects scale or lower in one step."""
import json
import math
import os
import subprocess

import made
import scenes
from laws import apart, drive, linear_eos, material, von_mises

EXACT = 1e-12
TNT = {"model": "jwl", "A": "371.213 GPa", "B": "3.2306 GPa", "R1": 4.15, "R2": 0.95,
       "omega": 0.30, "unreacted_bulk_modulus": "10 GPa"}
Y, SHEAR = 300e6, 48e9


def jwl(mu, energy, fraction):
    v = 1.0 / (1.0 + mu)

    def part(stiffness, r):
        return stiffness * (1.0 - 0.30 / (r * v)) * math.exp(-r * v)

    burnt = part(371.213e9, 4.15) + part(3.2306e9, 0.95) + 0.30 * energy / v
    return fraction * burnt + (1.0 - fraction) * 10e9 * mu


def absent_inputs():
    strain, names = -0.1, ["pressure", "energy", "volume_ratio"]
    run = drive(material(TNT, None, 0.0, density=1630.0), {"xx": {"log_strain": strain}}, 1.0, 20,
                final=names, extra=EXTRA)
    mu = 1.0 / run["volume_ratio"] - 1.0
    scenes.below("explosive that nobody burns: pressure against JWL of what is all burnt, relative",
                 apart(run["pressure"], jwl(mu, run["energy"], 1.0)), EXACT)
    quantities = {name: {"measure": "pressure", "body": name, "reduce": "at end",
                         "at": {"body": name, "point": [f"{x} mm"]}}
                  for name, x in (("held", 1), ("free", 21))}
    for entry in quantities.values():
        del entry["body"]
    box = [{"box": {"min": [f"{x} mm"], "max": [f"{x + 2} mm"]}} for x in (0, 20)]
    bodies = {name: {"material": "tnt", "shape": shape, "energy": "7 GJ/m3"}
              for name, shape in zip(("held", "free"), box)}
    scene = {"gamut": 1, "solver": {"model": "material_point_method", "geometry": "1d",
                                    "cell": "0.5 mm", "end": "1 ns"},
             "materials": {"tnt": {"density": "1630 kg/m3", "eos": TNT,
                                   "elasticity": {"model": "hypoelastic"}}},
             "bodies": bodies,
             "effects": {"burn": {"model": "burn", "fraction": 0, "bodies": ["held"]}},
             "quantities": quantities}
    result = scenes.run(scenes.written("two_charges", json.dumps(scene)), extra=EXTRA)
    scenes.below("body that an effect keeps from burning: pressure over that of the other",
                 result.value("held") / result.value("free"), 1e-3)
    scenes.within("the other body, on which nobody writes the burn fraction", result.value("free"),
                  jwl(0.0, 7e9, 1.0), 1e-3, "GPa", 1e9)
    scenes.drop(result)


# ---- flow stress that effects scale -------------------------------------------------------------

def pulled(effects, names=("von_mises", "plastic_strain"), hardening=0.0, extra=()):
    return drive(material(linear_eos(140e9), von_mises(Y, hardening), SHEAR),
                 {"xx": {"strain_rate": "100 1/s"}, "yy": {"stress": "0 Pa"},
                  "zz": {"stress": "0 Pa"}},
                 1e-3, 100, history=names, effects=effects, extra=[*EXTRA, *extra])


def scaled():
    half, most = {"model": "soften", "left": 0.5}, {"model": "soften", "left": 0.8}
    bare = pulled({})
    one = pulled({"half": half})
    both = pulled({"half": half, "most": most}, names=("von_mises", "flow_stress_factor"))
    turned = pulled({"most": most, "half": half})
    scenes.below("one effect leaves half: flow stress, relative",
                 apart(one["von_mises"][-1], 0.5 * Y), EXACT)
    scenes.below("two effects leave 0.5 and 0.8: flow stress, relative",
                 apart(both["von_mises"][-1], 0.4 * Y), EXACT)
    scenes.report(both["flow_stress_factor"][0] == 1.0 and both["flow_stress_factor"][1:] ==
                  [0.4] * 100, "their product is a field: 1 before the first step, then 0.4")
    scenes.report(both["von_mises"] == turned["von_mises"], "in either order the same bits")
    scenes.report(pulled({"none": {"model": "soften", "left": 1}}) == bare,
                  "a factor of 1 gives the bits of no effect")


def damaged():
    """The factor of the step before, so that each step can be worked out."""
    limit, hardening = 0.2, 1e9
    run = pulled({"wear": {"model": "soften", "vanishing_strain": limit}}, hardening=hardening)
    stress, strain = run["von_mises"], run["plastic_strain"]
    off = max(apart(stress[i], (1.0 - strain[i - 1] / limit) * (Y + hardening * strain[i]))
              for i in range(10, len(stress)))
    scenes.note(f"plastic strain {strain[-1]:.4f}, flow stress {stress[-1] / 1e6:.1f} MPa")
    scenes.below("softening and hardening together: flow stress of each step, relative", off, EXACT)


def least():
    run = pulled({"three": {"model": "limit", "tension": "3 GPa"},
                  "two": {"model": "limit", "tension": "2 GPa"}}, names=("opening_tension",))
    scenes.report(run["opening_tension"][1:] == [2e9] * 100, "the lesser of two limits holds")


def refused():
    card = material(linear_eos(140e9), von_mises(Y), SHEAR)
    scene = {"gamut": 1, "solver": {"model": "material_driver", "end": "1 ms", "steps": 10,
                                    "control": {"xx": {"strain_rate": "100 1/s"}}},
             "materials": {"metal": card}, "bodies": {"sample": {"material": "metal"}},
             "effects": {"wear": {"model": "soften", "left": -0.5}}}
    done, _ = scenes.attempt(scenes.written("negative", json.dumps(scene)), extra=EXTRA)
    scenes.report(done.returncode == 5 and "flow_stress_factor of -0.5" in done.stderr,
                  "a factor below 0 ends the run with exit 5 and is named", [done.stderr])


def keeps():
    """An effect that sets what it should scale; its header is right."""
    text = "plugin: effect/setter\nversion: '1'\nsummary: a\nsource: [a]\n" \
           "outputs: [flow_stress_factor]\n" \
           "tasks: [{kernel: k, phase: after material, scales: [flow_stress_factor]}]\n"
    code = '#include "setter.gamut.h"\n' \
           "static void k(const struct setter *b)\n" \
           "{\n  GAMUT_EACH (i, b)\n    b->flow_stress_factor[i] = 0.5;\n}\n" \
           "GAMUT_EFFECT(setter, .k = k)\n"
    made.plugin("effect/setter", text, code)
    done = subprocess.run([scenes.GAMUT, "verify", os.path.join(made.FOLDER, "effect/setter")],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    scenes.report(done.returncode == 4 and "not multiply the flow_stress_factor" in done.stdout,
                  "verify finds an effect that sets what it should scale", [done.stdout])


for identity in ("eos/jwl", "effect/soften", "effect/burn", "effect/limit"):
    EXTRA = ["--plugin-path", made.of_tree(identity)]
    made.verified(identity)
absent_inputs()
scaled()
damaged()
least()
refused()
keeps()
scenes.done()
