"""The length of a plane's normal does not matter, however long or short: walls, boundaries and open
planes act alike. Prints TAP."""
import scenes

SCENE = """gamut: 1
solver: {{model: material_point_method, geometry: plane_strain, cell: 0.5 mm, end: 4 us}}
materials:
  metal: {{density: 8000 kg/m3, eos: {{model: linear, bulk_modulus: 140 GPa}},
          elasticity: {{model: hypoelastic, shear_modulus: 48 GPa}}}}
bodies:
  block: {{material: metal, velocity: [20 m/s, -150 m/s],
          shape: {{box: {{min: [0 mm, 0 mm], max: [2 mm, 2 mm]}}}}}}
effects: {{plane: {{model: {model}, plane: {{point: [0 mm, 0 mm], normal: {normal}}}}}}}
quantities:
  px: {{measure: momentum, axis: x, reduce: at end}}
  py: {{measure: momentum, axis: y, reduce: at end}}
"""
DIRECTIONS = {"straight": (0.0, 1.0), "oblique": (0.0625, 1.0)}
LENGTHS = (1e200, 1e308, 1e-200, 1e-300)


def momenta(model, normal):
    file = scenes.written("normal", SCENE.format(model=model, normal=normal))
    result = scenes.run(file)
    found = [result.value(name) for name in ("px", "py")]
    scenes.drop(result)
    return found


for name, model in (("wall", "rigid_wall"), ("symmetry", "boundary, kind: symmetry"),
                    ("open plane", "outflow")):
    for way, direction in DIRECTIONS.items():
        due = momenta(model, list(direction))
        start = 8000 * 4e-6 * -150
        scenes.report(abs(due[1] - start) > 0.1 * abs(start),
                      f"{name}, {way}: the plane acts, momentum {due[1]:.6g} of {start:.6g}")
        for length in LENGTHS:
            normal = [length * n for n in direction]
            found = momenta(model, normal)
            apart = max(abs(a - b) for a, b in zip(found, due)) / abs(start)
            scenes.below(f"{name}, {way}, a normal of {length:g}: momentum", apart, 1e-12)
scenes.done()
