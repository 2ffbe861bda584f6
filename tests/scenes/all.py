"""Every scene of inputs/ runs to its end: exit 0, a summary that is whole, quantities in sensible
bounds, mass and momentum to round-off, a ledger that closes. Prints TAP."""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../verification"))
import scenes  # noqa: E402

# Lower and upper bound in SI of what the scenes measure; histories are held to them at their ends.
BOUNDS = {
    "taylor_bar": {"final_length": (16e-3, 18.5e-3), "foot_diameter": (12e-3, 16e-3),
                   "diameter_at_0.2L": (9e-3, 11e-3), "wall_force": (-1e5, 1e5),
                   "kinetic_energy": (0.0, 5.0)},
    "taylor_bar_3d": {"final_length": (16e-3, 18.5e-3), "foot_diameter": (12e-3, 16e-3),
                      "diameter_at_0.2L": (9e-3, 11e-3)},
    "taylor_bar_4340": {"final_length": (22e-3, 23.5e-3), "foot_diameter": (9.7e-3, 12.5e-3),
                        "diameter_at_0.2L": (7.9e-3, 8.8e-3)},
    "taylor_bar_benchmark": {"final_length": (21e-3, 22.2e-3), "foot_diameter": (14e-3, 14.7e-3)},
    "taylor_bar_42crmo4": {"final_length": (26.3e-3, 26.8e-3), "foot_diameter": (11e-3, 11.5e-3)},
    "plate_impact": {"plateau_pressure": (9.56e9, 9.76e9), "shock_speed": (4269.0, 4355.0)},
    "sod": {"plateau_pressure": (0.300, 0.306), "plateau_velocity": (0.918, 0.937),
            "shock_speed": (1.73, 1.77)},
    "vibrating_bar": {"mean_velocity": (0.062, 0.065), "kinetic_energy": (0.0, 0.0626)},
}


def numbers(quantity):
    """Of a run, or of a study."""
    for key in ("value", "mean"):
        if key in quantity:
            return [quantity[key]]
    return quantity.get("values", quantity.get("means", []))


def check(name):
    try:
        result = scenes.run(name)
    except scenes.Failed as failed:
        scenes.report(False, f"{name} runs", [failed])
        return
    summary = result.summary
    written = ["results.h5", "summary.json", "scene.yaml"]
    # A study has a row a run in the place of frames.
    written += ["study.csv"] if "study" in summary else ["results.xdmf", "history.csv"]
    files = [f for f in written if not os.path.exists(result.file(f))]
    scenes.report(not files and summary["status"] == "done", f"{name} runs to its end", files)
    quantities = summary["quantities"]
    for key, q in quantities.items():
        if "reason" in q:
            scenes.note(f"{name}: {key} has no value: {q['reason']}")
    quantities = {key: q for key, q in quantities.items() if "reason" not in q}
    bad = [key for key, q in quantities.items() if not numbers(q)
           or not all(isinstance(v, (int, float)) and math.isfinite(v) for v in numbers(q))]
    scenes.report(not bad, f"{name}: {len(quantities)} quantities, all finite", bad)
    outside = [f"{key} = {numbers(quantities[key])[-1]:g}, not in {bounds}"
               for key, bounds in BOUNDS.get(name, {}).items()
               if not bounds[0] <= numbers(quantities[key])[-1] <= bounds[1]]
    scenes.report(not outside, f"{name}: quantities are sensible", outside)
    for account, line in summary.get("ledger", {}).items():
        limit = 1e-10 if account == "energy" else 1e-12
        scenes.below(f"{name}: ledger of {account} closes to", line["relative_residual"], limit)


for file in sorted(os.listdir(scenes.INPUTS)):
    if file.endswith(".yaml"):
        check(file[:-5])
scenes.done()
