"""Slips that keep the dimension are warned of, with the unit that was most likely meant; scenes and
cards of the tree are free of such warnings; every parameter with a unit says what it may be."""
import glob
import os
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tap import ROOT, done, gamut, report  # noqa: E402

SCENE = """gamut: 1
solver: {model: material_point_method, geometry: axisymmetric, cell: 2 mm, end: 1 us}
materials:
  cu: {density: 8960 kg/m3, eos: {model: mie_gruneisen, C0: 3940 m/s, S1: 1.489, gamma0: 2.02},
       strength: {model: johnson_cook, A: 90 MPa, B: 292 MPa, n: 0.31, C: 0.025, m: 1.09,
                  T_melt: 1356 K},
       elasticity: {shear_modulus: 47.27 GPa}, specific_heat: 385 J/(kg K)}
bodies:
  bar: {material: cu, velocity: [0 m/s, -150 m/s],
        shape: {cylinder: {radius: 4 mm, length: 20 mm}}}
effects: {wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}}
quantities: {length: {measure: extent, axis: y, reduce: at end}}
"""
# What is set, and the words that follow "did you mean".
SLIPS = (("strength.A=90 mPa", "90 MPa?"), ("strength.A=90", None),
         ("density=8.96 kg/m3", "8.96 g/cm3?"), ("eos.C0=3.94 m/s", "3.94 km/s?"),
         ("strength.n=31", "0.31?"), ("elasticity.shear_modulus=47.27 Pa", "47.27 GPa?"),
         ("strength.B=292 Pa", "292 MPa?"), ("eos.S1=14.89", "1.489?"),
         ("eos.gamma0=20.2", "2.02?"), ("strength.C=2.5", "0.025?"),
         ("strength.T_melt=13560 K", "1356 K?"), ("specific_heat=385 J/(g K)", "385 mJ/(g K)?"),
         ("eos={model: linear, bulk_modulus: 1.4 mbar}", "1.4 Mbar?"),
         ("eos.tension_limit=-1.35 mPa", "-1.35 GPa?"),
         ("strength.reference_rate=1e9 1/s", ""),
         ("strength={model: von_mises, yield_stress: 90 mPa}", "90 MPa?"),
         ("strength.A={mean: 90 mPa, cv: 0.1}", "90 MPa?"),
         ("density=8.96e-9 ton/mm3", "tonne or t, 1000 kg"))
FINE = ("strength.A=0.9 kbar", "density=8.96 g/cm3", "strength.B=0 MPa", "strength.C=0",
        "eos.tension_limit=-1.35 GPa", "density=8.96e-9 t/mm3", "strength.T_melt=1083 degC",
        "eos={model: ideal_gas}", "scaled=true")


def slips(scene):
    for setting, words in SLIPS:
        answer = gamut("check", scene, "--set", "materials.cu." + setting)
        if words is None:
            report(answer.code == 3, f"{setting}: no unit is refused as before", answer)
            continue
        report(answer.code == 0 and words in answer.said and "warning" in answer.said and
               f"materials.cu.{setting.split('=')[0]}" in answer.said,
               f"{setting}: warned of, {words or 'without a guess'}", answer)
    for setting in FINE:
        answer = gamut("check", scene, "--set", "materials.cu." + setting)
        report(answer.code == 0 and "unusual" not in answer.said and "ton" not in answer.said,
               f"{setting}: no word", answer)
    answer = gamut("check", scene, "--set", "materials.cu.strength.A=90 mPa", "--set",
                   "materials.cu.scaled=true")
    report(answer.code == 0 and "unusual" not in answer.said, "scaled numbers are not judged",
           answer)
    answer = gamut("check", scene, "--set", "materials.cu.scaled=maybe")
    report(answer.code == 3 and "true or false" in answer.said, "scaled: maybe is refused", answer)


def tree():
    files = [f for pattern in ("inputs/*.yaml", "inputs/materials/*.yaml",
                               "plugins/*/*/*.scene.yaml")
             for f in sorted(glob.glob(os.path.join(ROOT, pattern)))]
    for path in files:
        answer = gamut("check", path)
        report(answer.code == 0 and "unusual" not in answer.said and "short ton" not in answer.said,
               f"{os.path.relpath(path, ROOT)}: nothing unusual", answer)


def unbounded(parameters, path):
    """Parameters with a unit that say neither what is possible nor what is usual."""
    for name, p in parameters.items():
        here = f"{path}.{name}"
        if p.get("members"):
            yield from unbounded(p["members"], here)
        elif p.get("type", "real") in ("real", "vector") and p.get("unit", "1") != "1" and not any(
                k in p for k in ("physical", "fit", "usual")):
            yield here


def ranges():
    found = []
    names = [line.split()[0] for line in gamut("list").out.splitlines()
             if line.startswith("  ") and "/" in line.split()[0]]
    for name in names:
        d = gamut("show", name, "--json").json()
        for key in ("parameters", "material_parameters", "body_parameters"):
            found += unbounded((d or {}).get(key) or {}, name)
    report(len(names) > 15 and not found,
           f"{len(names)} plugins: every parameter with a unit has a range {found}")


def main():
    with tempfile.TemporaryDirectory() as scratch:
        scene = os.path.join(scratch, "scene.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE)
        slips(scene)
    tree()
    ranges()
    done()


if __name__ == "__main__":
    main()
