#!/usr/bin/env python3
"""Choices that the code of a plugin does not know: a descriptor that offers another is refused, and
code that lacks one does not compile."""
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

BUILD = os.environ.get("builddir", os.path.join(kernels.ROOT, "build"))


def check(name, good, told):
    report(good, name, told)


def edited(folder, kind, name, changes):
    """A copy of a plugin of the tree with another descriptor."""
    home = os.path.join(folder, "plugins", kind, name)
    os.makedirs(home)
    for path in (os.path.join(folder, "plugins"), os.path.dirname(home), home):
        os.chmod(path, 0o755)
    built = os.path.join(BUILD, "plugins", kind, name)
    for file in os.listdir(built):
        if file.endswith(".so"):
            shutil.copy(os.path.join(built, file), home)
    with open(os.path.join(kernels.ROOT, "plugins", kind, name, name + ".yaml"),
              encoding="utf-8") as file:
        text = file.read()
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    with open(os.path.join(home, name + ".yaml"), "w", encoding="utf-8") as file:
        file.write(text)
    return home


IMPACT = """gamut: 1
solver: {model: material_point_method, geometry: plane_strain, cell: 0.5 mm, end: 0.2 us, MORE}
materials:
  metal: {density: 8 g/cm3, eos: {model: linear, bulk_modulus: 100 GPa}}
bodies:
  block: {material: metal, velocity: [0 m/s, -100 m/s],
          shape: {box: {min: [0 mm, 0 mm], max: [2 mm, 2 mm]}}}
effects:
  wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}
quantities:
  width: {measure: diameter, body: block, height: 0.5}
"""
BAR = """gamut: 1
solver: {model: gamut_bar, bonds: 20, strain_limit: 0.01, MORE}
materials:
  metal: {density: 8 g/cm3, strength: {model: ramberg_osgood, n: 18,
          youngs_modulus: 70 GPa, yield_stress: 540 MPa, failure_stress: 670 MPa, failure_strain: 0.1}}
bodies:
  bar: {material: metal, length: 10 mm, area: 1 mm2}
"""
MPM, BONDS = ("solver", "material_point_method"), ("solver", "gamut_bar")
OTHERS = (
    ("of a group, one more", MPM, IMPACT, "transfer: {model: tpic}",
     [("[flip, pic, apic, xpic]", "[flip, pic, apic, xpic, tpic]")]),
    ("of a group, in another order", MPM, IMPACT, "transfer: {model: pic}",
     [("[flip, pic, apic, xpic]", "[pic, flip, apic, xpic]")]),
    ("of a group, with another name", MPM, IMPACT, "gimp: {domain: frozen}, shape: gimp",
     [("[contiguous, fixed]", "[contiguous, frozen]")]),
    ("of an argument of a measure", MPM, IMPACT, "transfer: {model: flip}",
     [("[initial, current], default: initial", "[current, initial], default: initial")]),
    ("a measure more", MPM, IMPACT, "transfer: {model: flip}",
     [("measures:\n", "measures:\n  depth: {unit: m, at: body, doc: how deep}\n")]),
    ("of a parameter", BONDS, BAR, "load: cyclic",
     [("[monotonic, cyclic, table]", "[monotonic, table, cyclic]")]),
    ("of a parameter, one more", BONDS, BAR, "rupture: heal",
     [("[stop, report]", "[stop, report, heal]")]),
)


def descriptors():
    for name, plugin, scene, more, changes in OTHERS:
        with tempfile.TemporaryDirectory() as folder:
            edited(folder, *plugin, changes)
            with open(os.path.join(folder, "s.yaml"), "w", encoding="utf-8") as file:
                file.write(scene.replace(", MORE", ", " + more
                                                                        if more else ""))
            code, told = kernels.gamut(["--plugin-path", os.path.join(folder, "plugins"), "run", "s.yaml"], folder)
            check(f"{name}: exit {code}, refused before it is run (4)",
                  code == 4 and plugin[1] in told and "summary" not in told, told)
    with tempfile.TemporaryDirectory() as folder:
        home = edited(folder, *MPM, [("axisymmetric, 3d]", "axisymmetric, 3d, sphere]")])
        code, told = kernels.gamut(["verify", home], folder)
        check(f"a geometry that no scene knows: exit {code} of verify (4)",
              code == 4 and "no scene knows the geometry 'sphere'" in told, told)
    for name, plugin, scene in (("material_point_method", MPM, IMPACT), ("gamut_bar", BONDS, BAR)):
        with tempfile.TemporaryDirectory() as folder:
            edited(folder, *plugin, [])
            with open(os.path.join(folder, "s.yaml"), "w", encoding="utf-8") as file:
                file.write(scene.replace(", MORE", ""))
            code, told = kernels.gamut(["--plugin-path", os.path.join(folder, "plugins"), "run", "s.yaml"], folder)
            check(f"{name} as it is: exit {code} (0)", code == 0, told)


YAML = """plugin: effect/chooser
version: "1.0"
summary: chooses
source: [by hand]
parameters:
  way: {type: choice, choices: [left, right, WAYS], doc: where to}
  more: {type: group, doc: more, members: {deep: {type: choice, choices: [in, out], doc: so}}}
measures:
  far: {unit: m, at: run, doc: far}
  near: {unit: m, at: run, doc: near}
"""
CODE = """#include "chooser.gamut.h"
int chooser(const struct gamut_values *v, const char *name);
int chooser(const struct gamut_values *v, const char *name)
{
  switch (chooser_way_of(v)) {
  case CHOOSER_WAY_LEFT: return 1;
  case CHOOSER_WAY_RIGHT: return 2;
  case CHOOSER_WAY_UP: return 3;
  }
  switch (chooser_more_deep_of(v)) {
  case CHOOSER_MORE_DEEP_IN: return 4;
  case CHOOSER_MORE_DEEP_OUT: return 5;
  }
  switch (chooser_measure_of(name)) {
  case CHOOSER_MEASURE_FAR: return 6;
  case CHOOSER_MEASURE_NEAR: return 7;
  }
  return 0;
}
"""


def compiles(code):
    with tempfile.TemporaryDirectory() as folder:
        home = os.path.join(folder, "chooser")
        os.makedirs(home)
        with open(os.path.join(home, "chooser.yaml"), "w", encoding="utf-8") as file:
            file.write(YAML.replace("WAYS", "up"))
        with open(os.path.join(home, "chooser.c"), "w", encoding="utf-8") as file:
            file.write(code)
        header = subprocess.run([kernels.GAMUT, "header", "chooser.yaml"], cwd=home, check=True,
                                capture_output=True, text=True).stdout
        with open(os.path.join(home, "chooser.gamut.h"), "w", encoding="utf-8") as file:
            file.write(header)
        ran = subprocess.run(kernels.CC + kernels.FLAGS + ["-Wall", "-Wextra", "-Werror", "-c",
                                                           "chooser.c", "-o", "chooser.o"],
                             cwd=home, capture_output=True, text=True, check=False)
        return ran.returncode == 0, ran.stderr


def sources():
    good, told = compiles(CODE)
    check("code that knows every choice compiles without a warning", good, told)
    for case in ("CHOOSER_WAY_UP: return 3;", "CHOOSER_MORE_DEEP_OUT: return 5;",
                 "CHOOSER_MEASURE_NEAR: return 7;"):
        good, told = compiles(CODE.replace("  case " + case + "\n", ""))
        check(f"without {case.split(':')[0]} it does not", not good and "=switch" in told, told)


descriptors()
sources()
done()
