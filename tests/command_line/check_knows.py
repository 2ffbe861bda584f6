"""What a scene can be told before its first step: laws that would have no effect, fields that
nobody writes, what run would refuse, memory, counts and hours."""
import os
import re
import resource
import sys
import tempfile
import time

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tap import done, figure, gamut, report  # noqa: E402

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
BONDS = """gamut: 1
solver: {model: gamut_bar, bonds: 10000000}
materials:
  metal:
    density: 2800 kg/m3
    strength: {model: ramberg_osgood, youngs_modulus: 70 GPa, yield_stress: 500 MPa, n: 20,
               failure_stress: 600 MPa, failure_strain: 0.1}
bodies: {bar: {material: metal, length: 100 mm, area: 100 mm2}}
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


def settings_of(words):
    return [word for setting in words for word in ("--set", setting)]


def agreement(scratch):
    """check and run end alike, whoever refuses: reader, plan, solver, effect or start."""
    scene = os.path.join(scratch, "agree.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(BAR)
    point = "at: {body: bar, point: [0 mm, 1 mm]}"
    short = [SHEAR, "solver.end=0.2 us"]
    for name, code, words in (
            ("a good scene", 0, short),
            ("no shear", 3, short[1:]),
            ("axis z", 3, short + ["quantities.z={measure: extent, axis: z}"]),
            ("diameter along z", 3, short + ["quantities.z={measure: diameter, along: z}"]),
            ("field velocity", 3, short + ["quantities.f={measure: mean, field: velocity}"]),
            ("field von_mises", 0, short + ["quantities.f={measure: mean, field: von_mises}"]),
            ("field position_y", 0, short + ["quantities.f={measure: mean, field: position_y}"]),
            ("domains without gimp", 3, short + ["quantities.f={measure: long_domains}"]),
            ("wall in the bar", 3, short + ["effects.wall.plane.point=[0 mm, 9 mm]"]),
            ("velocity without value", 3, short + ['bodies.bar.velocity=["0", "1/(y-y)"]']),
            ("pressure without energy", 3, short + ["materials.cu.eos={model: linear, "
                                                    "bulk_modulus: 140 GPa}",
                                                    "bodies.bar.pressure=1 GPa"]),
            ("an effect that is off", 3, short + ["effects.wall.enabled=off",
                                                  "quantities.f={measure: normal_force}"]),
            ("tension without a sound speed", 5, short + ["bodies.bar.energy=-1e12 J/m3"]),
            ("a point of nowhere", 0, short + [f"quantities.v={{measure: velocity_y, {point}}}"])):
        checked = gamut("check", scene, *settings_of(words))
        ran = gamut("run", scene, "-o", os.path.join(scratch, "agree"), "--force",
                    *settings_of(words))
        report(checked.code == ran.code == code,
               f"{name}: check {checked.code}, run {ran.code}, due {code}", ran)


def warnings(scratch):
    scene = os.path.join(scratch, "warn.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(BAR)
    short = [SHEAR, "solver.end=0.2 us"]
    for name, told, words in (
            ("a bar that flies away from its wall", "moves away from this wall",
             short + ["bodies.bar.velocity=[0 m/s, 150 m/s]"]),
            ("a wall that flees", "moves away from this wall",
             short + ["effects.wall.velocity=[0 m/s, -300 m/s]"]),
            ("a point 80 mm off", "80 mm from it",
             short + ["quantities.v={measure: velocity_y, "
                      "at: {body: bar, point: [0 mm, 100 mm]}}"]),
            ("a place 80 mm off", "80 mm from it",
             short + ["quantities.v={measure: velocity_y, "
                      "at: {body: bar, point: [0 mm, 100 mm], follow: space}}"]),
            ("an end of hours", "hours on this machine", [SHEAR, "solver.end=100 s"]),
            ("a step for hours", "hours on this machine",
             [SHEAR, "solver.step=1e-14 s", "solver.end=0.001 s"])):
        answer = gamut("check", scene, *settings_of(words))
        report(answer.code == 0 and told in answer.said, f"{name}: warned of", answer)
    for name, words in (("a bar that meets its wall", short),
                        ("a bar at rest", short + ["bodies.bar.velocity=[0 m/s, 0 m/s]"])):
        answer = gamut("check", scene, *settings_of(words))
        report(answer.code == 0 and "warning" not in answer.said, f"{name}: no word", answer)


def spent(scene, *words):
    """Answer of a check, its seconds of processor and the most memory of any check so far, MB."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.monotonic()
    answer = gamut("check", scene, *settings_of(words))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (answer, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
            after.ru_maxrss / 1024, time.monotonic() - begun)


def memory(scratch):
    """Large scenes are planned, not laid out, and refused with both figures."""
    scene = os.path.join(scratch, "large.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(BAR)
    for name, words in (("4e11 points", ["solver.cell=10 nm"]),
                        ("1.3e9 points in space",
                         ["solver.geometry=3d", "solver.cell=0.04 mm", "bodies.bar.velocity="
                          "[0 m/s, -1 m/s, 0 m/s]", "bodies.bar.shape={box: {min: [0 mm, 0 mm, "
                          "0 mm], max: [22 mm, 22 mm, 22 mm]}}", "effects={}"])):
        answer, cpu, _, _ = spent(scene, SHEAR, *words)
        figures = re.search(r"take (\S+) GB, this machine has (\S+) GB", answer.said)
        report(answer.code == 3 and (figures or ("more than 2e9 points" in answer.said and
                                                 "4e11" in name)),
               f"{name}: refused with what is needed and what there is", answer)
        figure(cpu, 2.0, f"{name}: processor time of check [s]")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(BONDS)
    answer, cpu, most, _ = spent(scene)
    report(answer.code == 0 and "not started" in answer.said,
           "1e7 bonds: fine, and what was not checked is said", answer)
    figure(cpu, 2.0, "1e7 bonds: processor time of check [s]")
    figure(most, 600.0, "1e7 bonds: memory of check [MB]")


def main():
    with tempfile.TemporaryDirectory() as scratch:
        laws(scratch)
        fields(scratch)
        agreement(scratch)
        warnings(scratch)
        memory(scratch)
    done()


if __name__ == "__main__":
    main()
