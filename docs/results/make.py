"""Measures again what stands in these pages: rewrites the tables between <!-- NAME --> and
<!-- end --> of the .md files beside it, and the pictures in docs/pictures. Takes about ten minutes.

    python3 docs/results/make.py [NAME ...]        the named tables only; `pictures` for those
"""
import os
import platform
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
TREE = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(TREE, "tests/verification"))
import scenes  # noqa: E402
import impact  # noqa: E402
import references  # noqa: E402
import taylor_bars  # noqa: E402
import waves  # noqa: E402

PICTURES = os.path.join(TREE, "docs/pictures")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def percent(part, digits=2):
    return f"{100 * part:+.{digits}f} %"


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        models = set(re.findall(r"model name\s*: (.*)", info.read()))
    version = subprocess.run([scenes.GAMUT, "--version"], capture_output=True, text=True,
                             check=True).stdout.split("\n")[0]
    compiler = subprocess.run([os.environ.get("CC", "gcc"), "--version"], capture_output=True,
                              text=True, check=True).stdout.split("\n")[0]
    return (f"{version}; {', '.join(sorted(models))}, {os.cpu_count()} cores; "
            f"{platform.system()}; {compiler}; one thread.")


def hugoniot():
    rows = []
    for metal in (references.COPPER, references.STEEL):
        for speed in (200, 500, 1000, 2000):
            f = impact.shock(metal, speed)
            rows.append([metal["name"], f"{speed} m/s", f"{f['pressure_target'] / 1e9:.4f} GPa",
                         percent(f["pressure"] / f["pressure_target"] - 1),
                         f"{f['speed_target']:.1f} m/s",
                         percent(f["speed"] / f["speed_target"] - 1)])
    return table(["metal", "impact", "rho0 Us up", "gamut", "Us", "gamut"], rows)


def hugoniot_grids():
    rows = []
    for label, changes in (("quadratic, 50 cells", {"solver.cell": "0.2 mm"}),
                           ("quadratic, 100 cells", {}),
                           ("quadratic, 200 cells", {"solver.cell": "0.05 mm"}),
                           ("linear, 100 cells", {"solver.shape": "linear"}),
                           ("linear, 200 cells", {"solver.shape": "linear",
                                                  "solver.cell": "0.05 mm"})):
        row = [label]
        for speed in (200, 500, 1000, 2000):
            f = impact.shock(references.COPPER, speed, changes)
            row.append(percent(f["pressure"] / f["pressure_target"] - 1) + ", "
                       + percent(f["speed"] / f["speed_target"] - 1))
        rows.append(row)
    return table(["copper", "200 m/s", "500 m/s", "1000 m/s", "2000 m/s"], rows)


def release():
    rows = []
    for (name, speed), target in impact.RELEASE.items():
        metal = references.COPPER if name == "copper" else references.STEEL
        offs = [impact.release(metal, speed, f"{10 / n} mm") / target - 1 for n in (100, 200, 400)]
        rows.append([name, f"{speed} m/s", f"{target:.1f} m/s"] + [percent(o) for o in offs])
    return table(["metal", "impact", "free surface", "100 cells", "200 cells", "400 cells"], rows)


def strong():
    exact = impact.strong_targets()
    grids = {cells: impact.strong(cells, exact) for cells in (100, 200, 400, 800)}
    shown = {"precursor_stress": ("stress of the precursor", 1e9, "GPa"),
             "precursor_speed": ("speed of the precursor", 1, "m/s"),
             "plateau_stress": ("stress behind the plastic shock", 1e9, "GPa"),
             "plastic_speed": ("speed of the plastic shock", 1, "m/s"),
             "first_surface_velocity": ("free surface, behind the precursor", 1, "m/s"),
             "last_surface_velocity": ("free surface, behind the plastic shock", 1, "m/s")}
    return table(["what", "target"] + [f"{n} cells" for n in grids],
                 [[words, f"{exact[key] / scale:.4f} {unit}"]
                  + [percent(grids[n][key]) for n in grids]
                  for key, (words, scale, unit) in shown.items()])


def vibrating():
    rows = []
    for shape, order in (("quadratic", "usl"), ("quadratic", "musl"), ("linear", "usl"),
                         ("linear", "musl")):
        for cell in (2.5, 1.25, 0.5):
            name = [shape, order, f"{25 / cell:g}"]
            try:
                f = waves.vibrating(cell, shape, order)
                rows.append(name + [percent(f["omega"], 3), percent(f["amplitude"], 3),
                                    percent(f["energy"], 3)])
            except scenes.Failed as failed:
                rows.append(name + [f"stops, exit {failed.code}", "", ""])
    return table(["shape", "stress update", "cells", "frequency", "amplitude",
                  "energy a period"], rows)


def kept():
    rows = []
    for shape in ("quadratic", "linear"):
        for order in ("usl", "musl"):
            rows.append([f"{shape}, {order}"]
                        + [f"{waves.kept(n, shape, order):.4f}" for n in waves.KEPT_CPDI])
    rows.append(["CPDI, usl (other program)"] + [f"{v:.4f}" for v in waves.KEPT_CPDI.values()])
    return table(["flip", "8", "16", "32 cells a wavelength"], rows)


def sod():
    rows = []
    for label, changes in (("quadratic", {}), ("linear", {"solver.shape": "linear"})):
        before = None
        for cell in (10.0, 5.0, 2.5, 1.25):
            norms, off = waves.sod(cell, changes)
            orders = ["" if before is None else f" ({waves.math.log2(b / n):.2f})"
                      for b, n in zip(before or norms, norms)]
            rows.append([label, f"{1000 / cell:g}"]
                        + [f"{n:.5f}{o}" for n, o in zip(norms, orders)]
                        + [percent(off[k]) for k in ("plateau_pressure", "plateau_velocity",
                                                     "density_left", "density_right",
                                                     "shock_speed")])
            before = norms
    return table(["shape", "cells", "L1 density", "L1 velocity", "L1 pressure", "p*", "u*",
                  "rho* left", "rho* right", "shock"], rows)


def millimetres(value):
    return f"{1e3 * value:.3f}"


def benchmark():
    rows = []
    for label, cells, changes in (
            [("quadratic", n, {}) for n in (4, 8, 16, 32)]
            + [("quadratic, wall lets go", 16, {"effects.wall.unilateral": "true"})]
            + [("linear, pic 0.05", n, {"solver.shape": "linear",
                                        "solver.transfer": "{pic: 0.05}"}) for n in (8, 16)]):
        rows.append([label, str(cells)] + benchmark_row(
            lambda: taylor_bars.benchmark(cells, changes)))  # noqa: B023
    for cells in (4, 8):
        rows.append(["quadratic, three dimensions", str(cells)]
                    + benchmark_row(lambda: taylor_bars.benchmark_3d(cells)))  # noqa: B023
    return table(["shape", "cells in the radius", "length, mm", "radius of the foot, mm", "of 7.22",
                  "points", "time"], rows)


def two_codes():
    rows = [["two codes", ""] + [f"{low / scale:.5g} to {high / scale:.5g}"
                                 for _, _, low, high, _, _, scale, _ in taylor_bars.TWO_CODES]]
    for cells in (5, 10, 20):
        values, _ = taylor_bars.two_codes(cells)
        rows.append(["gamut", str(cells)] + [f"{value / entry[6]:.5g}" for value, entry
                                             in zip(values, taylor_bars.TWO_CODES)])
    return table(["", "cells in the radius", "length, mm", "foot, mm", "plastic strain on the axis",
                  "temperature there, degC"], rows)


def benchmark_row(measure):
    try:
        f = measure()
    except scenes.Failed as failed:
        return [f"stops, exit {failed.code}", "", "", "", ""]
    cost = f["run"].summary["cost"]
    return [millimetres(f["length"]), millimetres(0.5 * f["foot"]),
            percent(0.5 * f["foot"] / taylor_bars.BENCHMARK_RADIUS - 1), str(cost["points"]),
            f"{cost['cpu_s']:.1f} s"]


def shots():
    rows = []
    for scene, speed, old, length, foot, waist in taylor_bars.SHOTS:
        f = taylor_bars.shot(scene, speed, old, 24)
        rows.append([taylor_bars.name_of(scene, speed, old), f"{length}",
                     millimetres(f["length"]), percent(1e3 * f["length"] / length - 1, 1),
                     f"{foot}", millimetres(f["foot"]), percent(1e3 * f["foot"] / foot - 1, 1),
                     f"{waist}", percent(1e3 * f["waist"] / waist - 1, 1)])
    return table(["shot", "length measured, mm", "gamut", "off", "foot measured", "gamut", "off",
                  "0.2 L measured", "off"], rows)


def grids():
    rows = []
    for scene, speed, old, *_ in taylor_bars.SHOTS:
        for label, changes, many in (
                ("quadratic", {}, (6, 12, 18, 24)),
                ("linear, pic 0.05", {"solver.shape": "linear", "solver.transfer": "{pic: 0.05}"},
                 (6, 12, 18))):
            cells = []
            found = []
            for n in many:
                try:
                    f = taylor_bars.shot(scene, speed, old, n, changes)
                    found.append(f)
                    cells.append(f"{millimetres(f['length'])}, {millimetres(f['foot'])}")
                except scenes.Failed as failed:
                    cells.append(f"stops, exit {failed.code}")
            cells += [""] * (4 - len(many))
            last = ""
            if len(found) > 1:
                last = ", ".join(percent(found[-1][k] / found[-2][k] - 1)
                                 for k in ("length", "foot"))
            rows.append([taylor_bars.name_of(scene, speed, old), label] + cells + [last])
    return table(["shot", "shape", "6", "12", "18", "24 cells in the radius", "last step"], rows)


def what_if():
    rows = []
    for label, changes in (
            ("as published, no friction", {}),
            ("friction 0.02", {"effects.wall.friction": "0.02"}),
            ("friction 0.05", {"effects.wall.friction": "0.05"}),
            ("friction 0.1", {"effects.wall.friction": "0.1"}),
            ("no heating", {"effects.heat.enabled": "off"}),
            ("all plastic work is heat", {"effects.heat.taylor_quinney": "1"}),
            ("295 K", {"bodies.bar.temperature": "295 K"}),
            ("8920 kg/m3", {"materials.copper.density": "8920 kg/m3"}),
            ("foot held to the wall", {"effects.wall.unilateral": "false"}),
            ("no artificial viscosity", {"effects.viscosity.enabled": "off"}),
            ("end at 120 us", {"solver.end": "120 us"})):
        _, speed, old, length, foot, waist = taylor_bars.SHOTS[0]
        f = taylor_bars.shot("taylor_bar", speed, old, 12, changes)
        rows.append([label] + [percent(1e3 * f[k] / v - 1, 1)
                               for k, v in (("length", length), ("foot", foot), ("waist", waist))])
    return table(["copper, 130 m/s, 12 cells in the radius", "length", "foot", "at 0.2 L"], rows)


def ledger():
    rows = []
    for name in ("vibrating_bar", "plate_impact", "sod", "taylor_bar", "taylor_bar_4340",
                 "taylor_bar_benchmark", "taylor_bar_3d"):
        s = scenes.run(name).summary
        lines = s["ledger"]["energy"]["lines"]
        start = lines["kinetic"]["start"] + lines["internal"]["start"]
        worst = max(abs(a["relative_residual"]) for k, a in s["ledger"].items()
                    if "momentum" in k)
        transfer = lines["scatter loss"]["value"] + lines["gather loss"]["value"]
        rows.append([f"`{name}.yaml`", f"{abs(s['ledger']['mass']['relative_residual']):.0e}",
                     f"{worst:.0e}", f"{abs(s['ledger']['energy']['relative_residual']):.0e}",
                     percent(transfer / start),
                     percent(lines["stress remainder"]["value"] / start)])
    return table(["scene", "mass", "momentum", "energy", "lost in transfer", "stress remainder"],
                 rows)


TABLES = {f.__name__: f for f in (machine, hugoniot, hugoniot_grids, release, strong, vibrating,
                                  kept, sod, benchmark, two_codes, shots, grids, what_if, ledger)}


def plot(data, commands, name):
    path = os.path.join(PICTURES, name)
    script = ("set terminal pngcairo size 800,420 font 'sans,10'\n"
              f"set output '{path}'\nset grid\n{commands}\n")
    with open(os.path.join(scenes.SCRATCH, "data"), "w", encoding="utf-8") as file:
        file.write(data)
    subprocess.run(["gnuplot"], input=script, text=True, check=True, cwd=scenes.SCRATCH)


def pictures():
    exact = impact.strong_targets()
    times, speeds = references.plates(references.STEEL, impact.YIELD, impact.STRONG_IMPACT, 1000,
                                      2.99e-6)
    changes = impact.strong_changes(200, exact)
    t, v = scenes.run("plate_impact", changes).history("free_surface_velocity")
    data = "\n".join(f"{a * 1e6} {b}" for a, b in zip(t, v)) + "\n\n\n" + "\n".join(
        f"{a * 1e6} {b}" for a, b in zip(times, speeds)) + "\n"
    plot(data, "set xlabel 'time, us'\nset ylabel 'velocity of the free surface, m/s'\n"
         "set key bottom right\nset xrange [1.4:3]\n"
         "plot 'data' index 1 with lines lw 3 lc rgb '#bbbbbb' "
         "title 'Lagrangian code, 1000 cells a plate', "
         "'data' index 0 with lines lw 1.5 lc rgb '#b03060' title 'gamut, 200 cells a plate'",
         "precursor.png")
    waves.sod(5.0)
    import h5py  # noqa: PLC0415
    with h5py.File(os.path.join(scenes.SCRATCH, f"run-{scenes.runs}", "results.h5"), "r") as file:
        frame = file["frames"][sorted(file["frames"])[-1]]
        rows = [f"{x[0]} {d}" for body in ("left", "right") for x, d in zip(
            frame[body]["position"], frame[body]["density"])]
    grid = [i / 2000 for i in range(2001)]
    rows += ["", ""] + [f"{x} {d}" for x, d in zip(grid, references.Sod().at(grid, 0.2)[0])]
    plot("\n".join(rows) + "\n", "set xlabel 'x, m'\nset ylabel 'density, kg/m3'\n"
         "plot 'data' index 0 with points pt 6 ps 0.4 lc rgb '#b03060' title 'gamut, 200 cells', "
         "'data' index 1 with lines lw 1.5 lc rgb 'black' title 'exact'", "sod.png")


def replace(name, text):
    for file in sorted(os.listdir(HERE)):
        path = os.path.join(HERE, file)
        if not file.endswith(".md"):
            continue
        with open(path, encoding="utf-8") as page:
            old = page.read()
        new = re.sub(rf"(<!-- {name} -->\n).*?(<!-- end -->)",
                     lambda m: m.group(1) + text + "\n" + m.group(2), old, flags=re.S)
        if new != old:
            with open(path, "w", encoding="utf-8") as page:
                page.write(new)


if __name__ == "__main__":
    wanted = sys.argv[1:] or list(TABLES) + ["pictures"]
    for each in wanted:
        print(each, flush=True)
        if each == "pictures":
            pictures()
        else:
            replace(each, TABLES[each]())
