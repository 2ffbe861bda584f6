"""Settings that make each scene of inputs/ coarse and short: for tests that run them all."""
import os
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import needs  # noqa: E402

needs.modules("yaml")
import yaml  # noqa: E402

INPUTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../inputs")

BAR = ["solver.bonds=40"]
SHOT = ["solver.cell=0.635 mm", "solver.end=24 us"]
SHORT = {
    "colliding_disks": ["solver.cell=0.05 m", "solver.end=2 s"],
    "driver_johnson_cook": ["solver.steps=1000"],
    "mms_axis_aligned": ["solver.cell=0.1 m"],
    "plate_impact": ["solver.cell=0.25 mm"],
    "rotating_block": ["solver.cell=0.05 m", "solver.end=1 s"],
    "self_weight": ["solver.cell=2 m", "solver.end=20 s"],
    "sod": ["solver.cell=20 mm"],
    "taylor_bar_3d": ["solver.cell=1.27 mm", "solver.end=16 us"],
    "taylor_bar_benchmark": ["solver.cell=0.8 mm", "solver.end=24 us"],
    "taylor_bar_quarter": ["solver.cell=1.27 mm", "solver.end=16 us"],
    "tension_bar": ["solver.cell=0.05 m", "solver.end=20 s"],
    "vibrating_bar": ["solver.cell=1 m"],
    "vortex": ["solver.cell=0.1 m", "solver.end=0.2 s"],
}


def scenes():
    """Name, path, what it says, and settings of each; of a study two runs are enough."""
    for file in sorted(os.listdir(INPUTS)):
        if not file.endswith(".yaml"):
            continue
        name, path = file[:-5], os.path.join(INPUTS, file)
        with open(path, encoding="utf-8") as opened:
            scene = yaml.safe_load(opened)
        point = scene["solver"]["model"] == "material_point_method"
        settings = list(SHORT.get(name, SHOT if point else BAR))
        if is_study(scene):
            settings.append("uncertainty.estimator.runs=2")
        yield name, path, scene, settings


def is_study(scene):
    return "estimator" in (scene.get("uncertainty") or {})
