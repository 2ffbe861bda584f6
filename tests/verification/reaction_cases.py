"""Scenes in which planes give momentum, and what is wrong with what they report, for every
transfer, shape and order; for reaction_schemes.py and reaction_schemes_fine.py."""
import scenes  # before numpy: it skips the test where it is missing

scenes.needs.modules("yaml")
import numpy  # noqa: E402
import yaml  # noqa: E402

METAL = {"density": "8000 kg/m3", "eos": {"model": "linear", "bulk_modulus": "140 GPa"},
         "strength": {"model": "von_mises", "yield_stress": "90 MPa",
                      "hardening_modulus": "300 MPa"},
         "elasticity": {"model": "hypoelastic", "shear_modulus": "48 GPa"}}
AXES = {"1d": 1, "plane_strain": 2, "axisymmetric": 2, "3d": 3}
TRANSFERS = [{"model": "flip"}, {"model": "flip", "pic": 0.2}, {"model": "pic"}, {"model": "apic"},
             *({"model": "xpic", "order": m} for m in (1, 2, 3, 6))]
SHAPES = ("linear", "gimp", "quadratic", "cubic")
ORDERS = ("musl", "usl", "usf")
SIZE, CLOSE = 1e-3, 1e-12


def vector(numbers, unit):
    return [f"{n!r} {unit}" for n in numbers]


def along(axes, axis, value):
    return [float(value) if k == axis else 0.0 for k in range(axes)]


def plane(axes, axis, place, sign):
    return {"point": vector(along(axes, axis, place), "m"), "normal": along(axes, axis, sign)}


def described(geometry, effects, velocity, solver, end):
    """A block with what the planes and the block have at every step."""
    axes = AXES[geometry]
    shape = ({"cylinder": {"radius": f"{SIZE} m", "length": f"{SIZE} m"}}
             if geometry == "axisymmetric" else
             {"box": {"min": vector([0.0] * axes, "m"), "max": vector([SIZE] * axes, "m")}})
    found = {f"momentum_{k}": {"measure": "momentum", "axis": k} for k in "xyz"[:axes]}
    for name, effect in effects.items():
        for k in "xyz"[:axes]:
            found[f"{name}_impulse_{k}"] = {"measure": "impulse", "effect": name, "axis": k}
        if effect["model"] == "rigid_wall":
            found[f"{name}_normal_force"] = {"measure": "normal_force", "effect": name}
    return {"gamut": 1,
            "solver": {"model": "material_point_method", "geometry": geometry,
                       "cell": f"{SIZE / 5} m", "end": end, **solver},
            "materials": {"metal": METAL},
            "bodies": {"block": {"material": "metal", "shape": shape,
                                 "velocity": vector(velocity, "m/s")}},
            "effects": effects,
            "quantities": {name: {**q, "every": "1 ns"} for name, q in found.items()}}


def series(result, name):
    return numpy.array(result.history(name)[1])


class Worst:
    """The worst of many figures, and which scheme had it."""

    def __init__(self):
        self.value, self.where, self.count = 0.0, "", 0

    def take(self, value, where):
        self.count += 1
        if not value <= self.value:
            self.value, self.where = value, where

    def told(self, name, limit):
        scenes.report(self.value <= limit, f"{name}, {self.count} figures: {self.value:.3g} at "
                      f"{self.where or 'none'} (allowed {limit:g})")


def wall(axes, axis, place, sign, **more):
    return {"model": "rigid_wall", "plane": plane(axes, axis, place, sign), **more}


def squeezed(geometry):
    """A block that flies at a wall that rubs and, but for one dimension, into a corner, pushed by a
    plane that moves."""
    axes = AXES[geometry]
    axis = 0 if axes == 1 else 1
    effects = {"foot": wall(axes, axis, 0.0, 1, friction=0.3 if axes > 1 else 0.0),
               "press": {"model": "boundary", "kind": "velocity",
                         "plane": plane(axes, axis, SIZE, -1),
                         "velocity": vector(along(axes, axis, -20.0), "m/s")}}
    if geometry == "plane_strain":
        effects["side"] = wall(2, 0, SIZE, -1)
    if geometry == "3d":
        effects["side"] = {"model": "boundary", "kind": "symmetry", "plane": plane(3, 0, 0.0, 1)}
    velocity = along(axes, axis, -60.0)
    velocity[0] += 40.0 if geometry == "plane_strain" else 0.0
    return effects, velocity


def oblique():
    """A block that flies into a corner of two oblique walls, one of which moves."""
    return {"left": {"model": "rigid_wall", "friction": 0.2,
                     "plane": {"point": vector([-0.1e-3, 0.0], "m"), "normal": [1.0, 1.0]}},
            "right": {"model": "rigid_wall", "velocity": vector([-10.0, 0.0], "m/s"),
                      "plane": {"point": vector([SIZE + 0.1e-3, 0.0], "m"),
                                "normal": [-1.0, 2.0]}}}, [5.0, -100.0]


def leaves():
    """A bar that meets a wall and leaves it."""
    return {"wall": wall(1, 0, 0.0, 1)}, [-100.0]


# Name, geometry, effects and velocity, end.
CASES = [("a bar meets a wall and leaves it", "1d", leaves(), "0.8 us"),
         *((f"a block is squeezed, {kind}", kind, squeezed(kind), "0.4 us") for kind in AXES),
         ("a corner of two oblique walls", "plane_strain", oblique(), "1.5 us")]


def schemes():
    """Shape, order and transfer of all that go together."""
    return [(shape, order, transfer) for shape in SHAPES for order in ORDERS
            for transfer in TRANSFERS if transfer["model"] != "apic" or shape != "linear"]


class Figures:
    """The worst of what was measured."""

    def __init__(self):
        self.momentum, self.pull, self.residual = Worst(), Worst(), Worst()

    def measure(self, case, scheme):
        name, geometry, (effects, velocity), end = case
        shape, order, transfer = scheme
        where = f"{name}, {shape} {order} {' '.join(str(v) for v in transfer.values())}"
        result = scenes.run(scenes.written("reaction", yaml.safe_dump(described(
            geometry, effects, velocity,
            {"shape": shape, "stress_update": order, "transfer": transfer}, end))))
        # Around an axis there is no momentum along the radius.
        axes = "y" if geometry == "axisymmetric" else "xyz"[:AXES[geometry]]
        given = {k: [series(result, f"{e}_impulse_{k}") for e in effects] for k in axes}
        change = {k: series(result, f"momentum_{k}") for k in axes}
        scale = max(abs(numbers).max() for k in axes for numbers in (*given[k], change[k]))
        for k in axes:
            self.momentum.take(abs(change[k] - change[k][0] + sum(given[k])).max() / scale, where)
        for e, effect in effects.items():
            if effect["model"] == "rigid_wall":
                force = series(result, f"{e}_normal_force")
                self.pull.take(-force.min() / abs(force).max(), where)
        self.residual.take(result.residual(), where)
        scenes.drop(result)

    def told(self, name):
        self.momentum.told(f"{name}: momentum lost by the material against the impulse on planes",
                           CLOSE)
        self.pull.told(f"{name}: pull of a wall over its largest push", CLOSE)
        self.residual.told(f"{name}: residual of the ledger", 1e-10)
