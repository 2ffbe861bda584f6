"""maximum, mean and front of what is worked out from the fields of a point (von Mises stress,
density, pressure): the figures are those of the frames, to the last digits."""
import scenes

NAMES = ("von_mises", "density", "compression", "pressure", "total_pressure", "plastic_strain")
LEVELS = {"von_mises": "50 MPa", "density": "8970 kg/m3", "compression": "0.001",
          "pressure": "100 MPa", "total_pressure": "100 MPa", "plastic_strain": "0.001"}
SCENE = """gamut: 1
solver: {model: material_point_method, geometry: axisymmetric, cell: 1 mm, end: 3 us}
materials:
  copper:
    density: 8960 kg/m3
    eos: {model: linear, bulk_modulus: 140 GPa}
    strength: {model: von_mises, yield_stress: 90 MPa, hardening_modulus: 300 MPa}
    elasticity: {model: hypoelastic, shear_modulus: 47 GPa}
bodies:
  bar: {material: copper, shape: {cylinder: {radius: 4 mm, length: 20 mm}},
        velocity: [0 m/s, -150 m/s]}
effects:
  wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}
quantities:
QUANTITIES
outputs: {frames: 1, fields: [mass, volume_ratio, FIELDS]}
"""


def written(fields):
    lines = []
    for name in NAMES:
        lines += [f"  {how}_{name}: {{measure: {how}, body: bar, field: {name}, reduce: at end}}"
                  for how in ("maximum", "mean")]
        lines.append(f"  front_{name}: {{measure: front, body: bar, field: {name}, axis: y, "
                     f"level: {LEVELS[name]}, reduce: at end}}")
    return SCENE.replace("QUANTITIES", "\n".join(lines)).replace("FIELDS", ", ".join(fields))


def main():
    result = scenes.run(scenes.written("derived", written(NAMES)))
    lean = scenes.run(scenes.written("lean", written(["velocity"])))
    import h5py  # noqa: PLC0415
    scale = {"50 MPa": 50e6, "100 MPa": 100e6, "8970 kg/m3": 8970.0, "0.001": 0.001}
    with h5py.File(result.file("results.h5"), "r") as file:
        frame = file["frames"][sorted(file["frames"])[-1]]["bar"]
        volume = frame["mass"][:] * frame["volume_ratio"][:]
        place = frame["position"][:][:, 1]
        for name in NAMES:
            there = frame[name][:]
            level = scale[LEVELS[name]]
            due = {"maximum": there.max(), "mean": (volume * there).sum() / volume.sum(),
                   "front": place[there >= level].max()}
            for how, number in due.items():
                got = result.value(f"{how}_{name}")
                scenes.below(f"{how} of {name}: {got:.9g}, of the last frame {number:.9g}, "
                             "relative", abs(got / number - 1.0), 1e-12)
                scenes.below(f"{how} of {name}, where no frame has it",
                             abs(got - lean.value(f"{how}_{name}")), 0.0)


main()
scenes.done()
