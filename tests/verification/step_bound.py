"""What bounds the time step: a run whose material has no sound speed, or one that is no number,
ends with exit 5 and names the point; a moving plane bounds the step as well. Prints TAP."""
import re

import made
import scenes

EOS = """plugin: eos/mute
version: "1.0"
summary: pressure zero, and a sound speed as wrong as is asked for
formula: "pressure = 0; sound_speed = speed / nought + sqrt(square)"
source: [made for a test]
parameters:
  speed: {unit: m/s, doc: its sound speed}
  nought: {unit: 1, default: 1, doc: what it is divided by}
  square: {unit: m2/s2, default: 0 m2/s2, doc: what its root is added of}
inputs: [compression, energy, reference_density]
outputs: [pressure, pressure_slope_compression, sound_speed]
"""
CODE = """#include "mute.gamut.h"
static void pressure(const struct mute *b)
{
  GAMUT_EACH (i, b) {
    b->pressure[i] = 0.0;
    b->pressure_slope_compression[i] = 0.0;
    b->sound_speed[i] = b->speed[i] / b->nought[i] + sqrt(b->square[i]);
  }
}
GAMUT_EOS(mute, .pressure = pressure)
"""
SCENE = """gamut: 1
solver: {{model: material_point_method, geometry: {geometry}, cell: 0.2 mm, end: 12 us{solver}}}
materials: {{gas: {{density: 1630 kg/m3, eos: {{{eos}}}}}}}
bodies: {{charge: {{material: gas, shape: {{{shape}}}, {body}}}}}
effects: {{q: {{model: artificial_viscosity}}{effects}}}
quantities: {{p: {{measure: momentum, axis: x, reduce: at end}}}}
"""
SHAPE = {"1d": "box: {min: [0 mm], max: [8 mm]}",
         "plane_strain": "box: {min: [0 mm, 0 mm], max: [2 mm, 2 mm]}",
         "axisymmetric": "cylinder: {radius: 1 mm, length: 2 mm}",
         "3d": "box: {min: [0 mm, 0 mm, 0 mm], max: [1 mm, 1 mm, 1 mm]}"}
GAS, COLD = "model: ideal_gas, gamma: 1.4", "energy: 0 J/m3"
SYMMETRY = ", wall: {model: boundary, kind: symmetry, plane: {point: [0 mm], normal: [1]}}"


def attempt(name, eos=GAS, geometry="1d", body=COLD, solver="", effects="", extra=()):
    text = SCENE.format(geometry=geometry, solver=solver, eos=eos, shape=SHAPE[geometry],
                        body=body, effects=effects)
    return scenes.attempt(scenes.written(re.sub(r"\W+", "_", name), text),
                          extra=extra)[0]


def fails(name, words, **changes):
    process = attempt(name, **changes)
    missing = [w for w in ("of body 'charge'", "Position", *words) if w not in process.stderr]
    scenes.report(process.returncode == 5 and not missing,
                  f"{name}: exit {process.returncode} (due 5), the point is named",
                  [missing, process.stderr[-1200:]])


def ends(name, **changes):
    process = attempt(name, **changes)
    scenes.report(process.returncode == 0, f"{name}: exit {process.returncode} (due 0)",
                  [process.stderr[-1200:]])


for kind in SHAPE:
    fails(f"no sound, {kind}", ["nothing bounds the time step", "sound speed of 0", "solver.step"],
          geometry=kind)
fails("no sound before a wall", ["nothing bounds the time step"], effects=SYMMETRY)
ends("no sound, but a step of the scene's own", solver=", step: 0.1 us")
ends("no sound, but energy", body="energy: 1 GPa")
PISTON = (", piston: {model: boundary, kind: velocity, velocity: [-500 m/s], "
          "plane: {point: [10 mm], normal: [-1]}}" + SYMMETRY)
folder = made.plugin("eos/mute", EOS, CODE)
OWN = ("--plugin-path", folder)
ends("no sound, but material that flies", eos="model: mute, speed: 0 m/s",
     body="velocity: [100 m/s]", extra=OWN)
fails("no sound of a plugin", ["nothing bounds the time step"], eos="model: mute, speed: 0 m/s",
      extra=OWN)
for what, eos in (("0 / 0", "speed: 0 m/s, nought: 0"), ("1 / 0", "speed: 1 m/s, nought: 0"),
                  ("the root of -1", "speed: 0 m/s, square: -1 m2/s2"),
                  ("1e300 m/s", "speed: 1e300 m/s")):
    fails(f"a sound speed of {what}", ["its sound speed is no number, without end, or negative"],
          eos="model: mute, " + eos, extra=OWN)
# The piston is 2 mm away from cold gas: one step of the whole run would put it through it.
name = scenes.written("piston", SCENE.format(
    geometry="1d", solver="", eos="model: mute, speed: 0 m/s", shape=SHAPE["1d"], body=COLD,
    effects=PISTON))
result = scenes.run(name, extra=OWN)
steps = result.summary["cost"]["steps"]
least = 12e-6 * 500 / (0.5 * 0.2e-3)
scenes.report(steps >= least, f"a piston that comes from afar: {steps} steps (at least {least:g}: "
              "half a cell each)")
scenes.done()
