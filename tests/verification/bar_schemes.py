"""The benchmark bar of taylor_bars.py by shape and transfer; hard scenes for linear shapes. TAP."""
import re

import scenes
import schemes
import taylor_bars


def bar(cells, settings):
    """Off by, and what it cost; `cells` in the radius."""
    found = taylor_bars.benchmark(cells, settings)
    cost = found["run"].summary["cost"]
    scenes.drop(found["run"])
    return {"foot": 0.5 * found["foot"] / taylor_bars.BENCHMARK_RADIUS - 1,
            "length": found["length"], "time": cost["cpu_s"], "points": cost["points"],
            "steps": cost["steps"]}


def ends_or_tells(name, changes):
    """Ends well, or exit 5 with the point, its place and the step named."""
    process, _ = scenes.attempt(name, changes)
    said = process.stderr
    told = process.returncode == 0 or (
        process.returncode == 5 and re.search(r"[Pp]oint \d+ of body '\w+'.*position", said)
        and re.search(r"step \d+", said))
    lines = [line for line in said.splitlines() if "error" in line]
    return bool(told), f"exit {process.returncode}" + (f", {lines[0][:110]}" if lines else "")


def test_bar(cells, asked):
    """Radius of the foot beside the benchmark's. 2 % is what is asked; apic, which flattens the
    velocity's curvature, needs a finer grid for it."""
    for scheme, limit in asked:
        name = f"bar, {cells} cells in the radius, {schemes.name(*scheme)}"
        found = schemes.tell(name, bar, cells, schemes.scheme(*scheme))
        if scenes.report(found is not None, f"{name}: ends"):
            scenes.below(f"{name}: radius of the foot off", found["foot"], limit)


def test_usl(bars):
    """Linear functions with usl throw points: the run ends or says which."""
    for scene in bars:
        told, how = ends_or_tells(scene, {"solver.shape": "linear", "solver.stress_update": "usl"})
        scenes.report(told, f"{scene}, linear, usl: ends, or stops and names the point ({how})")


def main(fine):
    test_bar(8, [(("linear", "flip", "auto"), 0.02), (("gimp", "flip", "auto"), 0.02),
                 (("quadratic", "flip", "auto"), 0.02), (("cubic", "flip", "auto"), 0.02),
                 (("quadratic", "apic", "auto"), 0.035)])
    test_usl(("taylor_bar", "taylor_bar_benchmark", "taylor_bar_3d") if fine else
             ("taylor_bar_benchmark",))
    if fine:
        for scheme in schemes.table():
            for cells in (4, 8, 16):
                schemes.tell(f"bar, {cells} cells in the radius, {schemes.name(*scheme)}", bar,
                             cells, schemes.scheme(*scheme))


if __name__ == "__main__":
    main(False)
    scenes.done()
