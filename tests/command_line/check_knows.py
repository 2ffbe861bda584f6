"""What a scene can be told before its first step: laws that would have no effect, fields that
nobody writes."""
import os
import tempfile

from tap import done, figure, gamut, report

BAR = """gamut: 1
solver: {model: material_point_method, geometry: axisymmetric, cell: 0.8 mm, end: 30 us}
materials:
  cu: {density: 8960 kg/m3, eos: {model: mie_gruneisen, C0: 3940 m/s, S1: 1.489, gamma0: 2.02},
       strength: {model: johnson_cook, A: 90 MPa, B: 292 MPa, n: 0.31, C: 0.025, m: 1.09,
                  T_melt: 1356 K}}
bodies:
  bar: {material: cu, velocity: [0 m/s, -150 m/s], temperature: 400 K,
        shape: {cylinder: {radius: 4 mm, length: 20 mm}}}
effects: {wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}}
quantities: {length: {measure: extent, axis: y, reduce: at end}}
"""
DRIVER = """gamut: 1
solver: {model: material_driver, end: 1 us, steps: 10, control: {xx: {strain_rate: 1000 1/s}}}
materials:
  m: {density: 8960 kg/m3, eos: {model: linear, bulk_modulus: 140 GPa},
      elasticity: {shear_modulus: 47 GPa}}
bodies: {s: {material: m, temperature: 400 K}}
quantities: {T: {measure: temperature, reduce: at end}}
"""
SHEAR = "materials.cu.elasticity={shear_modulus: 47 GPa}"


def run(scratch, text, *settings):
    """Answer of a run and its quantities."""
    scene = os.path.join(scratch, "scene.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(text)
    options = [word for setting in settings for word in ("--set", setting)]
    answer = gamut("run", scene, "-o", os.path.join(scratch, "results"), "--force", "--json",
                   *options)
    return answer, {k: v["value"] for k, v in (answer.json() or {}).get("quantities", {}).items()}


def laws(scratch):
    """A shear modulus alone is hypoelastic; a fluid may say so."""
    cold = "bodies.bar.temperature=298 K"
    answer, of = run(scratch, BAR, cold, SHEAR)
    figure(abs(of.get("length", 0) - 16.41e-3), 0.05e-3,
           "length of a bar with a shear modulus alone, off 16.41 mm by [m]")
    same, other = run(scratch, BAR, cold, "materials.cu.elasticity={model: hypoelastic, "
                      "shear_modulus: 47 GPa}")
    report(of == other and same.code == 0, f"it is that of hypoelastic: {other}", same)
    for name, setting, code in (
            ("none", "materials.cu.strength=none", 0),
            ("a fluid without strength", "materials.cu.strength={model: none}", 0),
            ("an elastic bar has no strength to lose",
             "materials.cu.elasticity={youngs_modulus: 120 GPa, poissons_ratio: 0.3}", 0),
            ("von_mises", "materials.cu.strength={model: von_mises, yield_stress: 90 MPa}", 3),
            ("ramberg_osgood", "materials.cu.strength={model: ramberg_osgood, "
             "youngs_modulus: 120 GPa, yield_stress: 90 MPa, n: 5}", 3)):
        answer, _ = run(scratch, BAR, "solver.end=1 us", setting)
        report(answer.code == code, f"{name}: exit {code}", answer)


def fields(scratch):
    """What nobody changes is the body's, with a word; what nobody writes is refused."""
    answer, of = run(scratch, DRIVER)
    report(answer.code == 0 and of.get("T") == 400.0 and "never changes" in answer.said,
           f"temperature without heating is the body's: {of}", answer)
    probe = "at: {body: bar, point: [0 mm, 1 mm], follow: material}"
    answer, of = run(scratch, BAR, SHEAR, "solver.end=1 us",
                     f"quantities.T={{measure: temperature, {probe}, reduce: at end}}")
    report(answer.code == 0 and of.get("T") == 400.0 and "never changes" in answer.said,
           f"also beside a law that reads it: {of}", answer)
    answer, of = run(scratch, BAR, SHEAR, "solver.end=1 us", "quantities.hot={measure: maximum, "
                     "field: temperature, reduce: at end}",
                     "outputs={frames: 1, fields: [temperature]}")
    report(answer.code == 0 and of.get("hot") == 400.0, f"also over a whole body: {of}", answer)
    answer, of = run(scratch, BAR, SHEAR, "solver.end=1 us",
                     "effects.burn={model: erosion, temperature: 1000 K}",
                     "quantities.gone={measure: eroded_mass, reduce: at end}")
    report(answer.code == 0 and of.get("gone") == 0.0 and "never changes" in answer.said,
           f"an effect that waits for heat hears that there is none: {of}", answer)
    answer, of = run(scratch, BAR, SHEAR, "solver.end=5 us", "materials.cu.specific_heat="
                     "385 J/(kg K)", "effects.heat={model: adiabatic_heating}",
                     f"quantities.T={{measure: temperature, {probe}, reduce: at end}}")
    report(answer.code == 0 and of.get("T", 0) > 401.0 and "never changes" not in answer.said,
           f"with heating it changes, without a word: {of}", answer)
    answer, of = run(scratch, BAR, SHEAR, "solver.end=1 us",
                     f"quantities.m={{measure: mass, {probe}, reduce: at end}}")
    report(answer.code == 0 and of.get("m", 0) > 0.0 and "never changes" not in answer.said,
           f"what the solver gives is there: {of}", answer)


def main():
    with tempfile.TemporaryDirectory() as scratch:
        laws(scratch)
        fields(scratch)
    done()


if __name__ == "__main__":
    main()
