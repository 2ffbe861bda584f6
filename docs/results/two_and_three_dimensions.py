"""Measures again what stands in two_and_three_dimensions.md: rewrites the tables between
<!-- NAME --> and <!-- end -->, and the pictures in docs/pictures. Takes about half an hour.

    GAMUT=build/gamut python3 docs/results/two_and_three_dimensions.py [NAME ...]
Pictures of the motions and of the bar are drawn from the tables.
"""
import os
import re
import sys

import make  # finds the verification's modules
import scenes
import bar_schemes
import free_bodies
import manufactured
import patches
import rigid_motion
import schemes

GRIDS = (10, 20, 40)
ALL = schemes.table()


def power(value, digits=1):
    return f"{value:.{digits}e}".replace("e-0", "e-").replace("e+0", "e")


def row(scheme, measure, columns, *before):
    """A scheme's figures, or how its run ended in the first column."""
    shape, transfer, order = scheme
    value, why = schemes.outcome(measure, *before, schemes.scheme(*scheme))
    found = [show(value) for _, show in columns] if value is not None else (
        [why.split(":")[0]] + [""] * (len(columns) - 1))
    return [shape, transfer, order] + found


def rows(measure, columns, *before, wanted=None):
    return make.table(["shape", "transfer", "stress update"] + [head for head, _ in columns],
                      [row(s, measure, columns, *before) for s in wanted or ALL])


def ladder_row(scheme, case, grids):
    errors, why = manufactured.ladder(case, grids, schemes.scheme(*scheme))
    rates = schemes.orders(errors, [1 / n for n in grids])
    cells = [f"{e:.2e}" for e in errors] + [why.split(":")[0]] * (len(errors) < len(grids))
    return cells + [""] * (len(grids) - len(cells)) + [", ".join(f"{r:.2f}" for r in rates)]


def ladders(case, grids, wanted):
    return make.table(["shape", "transfer", "stress update", *(f"{n} cells" for n in grids),
                       "orders"],
                      [list(s) + ladder_row(s, case, grids) for s in wanted])


def two_axes():
    return ladders("two axes", GRIDS, ALL)


def two_axes_fine():
    return ladders("two axes", (*GRIDS, 80), [(s, "flip", "auto") for s in schemes.SHAPES]
                   + [("quadratic", "apic", "auto")])


def vortex():
    return ladders("vortex", GRIDS, schemes.table(transfers=("flip",)) + schemes.table(
        ("gimp", "quadratic"), tuple(t for t in schemes.TRANSFERS if t != "flip")))


def three_axes():
    return ladders("three axes", (10, 20), [(s, "flip", "auto") for s in schemes.SHAPES])


def spin():
    return rows(rigid_motion.spin, [
        ("kinetic energy", lambda f: make.percent(f["kinetic"])),
        ("angular momentum", lambda f: power(f["angular"])),
        ("stress / E", lambda f: power(f["stress"])),
        ("volume", lambda f: power(f["volume"])),
        ("time", lambda f: f"{f['time']:.2f} s")])


def flight():
    def both(settings):
        found = [schemes.outcome(rigid_motion.translation, axes, settings) for axes in (1, 2, 3)]
        return [power(v["stress"]) if v is not None else why.split(":")[0] for v, why in found]
    return rows(both, [(h, lambda f, k=k: f[k])
                       for k, h in enumerate(("1 axis", "2 axes", "3 axes"))],
                wanted=schemes.table(transfers=("flip", "pic", "apic", "xpic 2")))


def on_nodes():
    def both(settings):
        return [rigid_motion.on_nodes(axes, turning, settings)[0]
                for axes in (2, 3) for turning in (False, True)]
    heads = ("2 axes, flight", "2 axes, spin", "3 axes, flight", "3 axes, spin")
    return rows(both, [(h, lambda f, k=k: power(f[k])) for k, h in enumerate(heads)],
                wanted=schemes.table(transfers=("flip", "apic")))


def patch():
    lines = []
    offsets = [i / 20 for i in range(20)]
    for shape in schemes.SHAPES:
        settings = schemes.scheme(shape)
        whole = max(patches.patch(a, o, settings, s) for a in (1, 2, 3) for o in offsets[::5]
                    for s in (1.0, 0.5, 1 / 3))
        lines.append([shape, power(whole)]
                     + [power(max(patches.patch(2, o, settings, s) for o in offsets))
                        for s in (0.45, 0.55, 0.9)]
                     + [power(patches.stretched(schemes.scheme(shape, order="usl"), s))
                        for s in (1.1, 1.3, 1.5)])
    return make.table(["shape", "1, 2, 3 points a cell", "0.45 cells apart", "0.55", "0.9",
                       "flown apart by 1.1", "1.3", "1.5"], lines)


def beyond():
    lines = []
    for shape in schemes.SHAPES:
        for order in schemes.ORDERS:
            found = [schemes.outcome(patches.beyond_a_face, axes, 10.0 ** -k, t,
                                     schemes.scheme(shape, order=order))
                     for axes in (2, 3) for k in range(1, 13) for t in (0.0, 0.25, 0.5)]
            good = [v for v, _ in found if v is not None]
            lines.append([shape, order] + [power(max(f[key] for f in good)) for key in (
                "acceleration", "rate", "momentum")]
                         + [f"{len(found) - len(good)} of {len(found)}"])
    return make.table(["shape", "stress update", "acceleration", "velocity gradient",
                       "momentum lost",
                       "runs that stop"], lines)


def free():
    def both(settings):
        return [free_bodies.free(axes, settings) for axes in (2, 3)]
    return rows(both, [
        ("momentum, 2 axes", lambda f: power(f[0]["momentum"])),
        ("3 axes", lambda f: power(f[1]["momentum"])),
        ("angular momentum, 2 axes", lambda f: power(f[0]["spin"])),
        ("3 axes", lambda f: power(f[1]["spin"])),
        ("energy, 2 axes", lambda f: make.percent(f[0]["energy"], 1)),
        ("3 axes", lambda f: make.percent(f[1]["energy"], 1)),
        ("ledger", lambda f: power(max(g["residual"] for g in f)))])


DISKS = [("energy kept", lambda f: f"{f['kept'] + f['vibration']:.4f}"),
         ("kinetic alone", lambda f: f"{f['kept']:.3f}"),
         ("of the motion as a whole", lambda f: f"{f['speed'] ** 2:.3f}"),
         ("lost in transfer", lambda f: f"{f['transfer']:+.3f}"),
         ("stress remainder", lambda f: f"{f['remainder']:+.3f}"),
         ("time", lambda f: f"{f['time']:.2f} s")]


def disks():
    return rows(free_bodies.disks, DISKS)


def disks_grids():
    lines = []
    for order in ("usl", "musl"):
        for cells, points in ((10, 4), (10, 9), (10, 16), (20, 9), (40, 9)):
            settings = {**schemes.scheme("quadratic", order=order),
                        "solver.cell": f"{0.2 / cells} m",
                        "bodies.lower.points_per_cell": points,
                        "bodies.upper.points_per_cell": points}
            found = free_bodies.disks(settings)
            lines.append([order, str(cells), str(points)] + [show(found) for _, show in DISKS[:-1]]
                         + [f"{found['contact']:.3f} s"])
    return make.table(["stress update", "cells in the radius", "points a cell"]
                      + [head for head, _ in DISKS[:-1]] + ["contact"], lines)


def bar_of(scheme, cells):
    """Best of two by processor time; of one on the finest grid."""
    found = [schemes.outcome(bar_schemes.bar, cells, schemes.scheme(*scheme))
             for _ in range(1 if cells > 8 else 2)]
    best = min((v for v, _ in found if v is not None), key=lambda v: v["time"], default=None)
    return best, found[0][1]


def bar():
    lines = []
    for scheme in ALL:
        line = list(scheme)
        for cells in (4, 8, 16):
            found, why = bar_of(scheme, cells)
            line += [why.split(":")[0], ""] if found is None else [
                f"{make.percent(found['foot'])}, {1e3 * found['length']:.3f} mm",
                f"{found['time']:.2f} s"]
        lines.append(line)
    return make.table(["shape", "transfer", "stress update", "4 cells: foot, length", "time",
                       "8 cells", "time", "16 cells", "time"], lines)


TABLES = {f.__name__: f for f in (two_axes, two_axes_fine, vortex, three_axes, spin, flight,
                                  on_nodes, patch, beyond, free, disks, disks_grids, bar)}
COLOURS = {"linear": "#d08000", "gimp": "#b03060", "gimp, fixed": "#e090b0", "quadratic": "#2060b0",
           "cubic": "#208040"}
POINTS = {"flip": 7, "flip, pic 0.01": 6, "pic": 1, "apic": 5, "xpic 2": 8, "xpic 5": 9}


def curves(found):
    """gnuplot's blocks of data and its list of what to draw. `found`: name, style, places."""
    data = "\n\n\n".join("\n".join(f"{x!r} {y!r}" for x, y in places) for _, _, places in found)
    return data + "\n", ", ".join(f"'data' index {i} with {style} title '{name}'"
                                  for i, (name, style, _) in enumerate(found))


def lines_of(name):
    """The rows of a table of the page, by shape, transfer, order."""
    with open(os.path.join(make.HERE, "two_and_three_dimensions.md"), encoding="utf-8") as page:
        text = re.search(rf"<!-- {name} -->\n(.*?)<!-- end -->", page.read(), re.S).group(1)
    cells = [[c.strip() for c in line.strip("|\n").split("|")] for line in text.splitlines()[2:]]
    return {tuple(c[:3]): c[3:] for c in cells}


def usual(shape, transfer):
    return shape, transfer, "auto" if transfer != "flip" else "musl" if shape == "linear" else "usl"


def picture_manufactured():
    for name, file in (("two_axes_fine", "manufactured.png"), ("vortex", "vortex.png")):
        table, grids = lines_of(name), (*GRIDS, 80) if name == "two_axes_fine" else GRIDS
        found = []
        for shape in schemes.SHAPES:
            scheme = usual(shape, "flip") if name == "vortex" else (shape, "flip", "auto")
            errors = table[scheme][:len(grids)]
            found.append((shape, f"linespoints lw 2 pt 7 lc rgb '{COLOURS[shape]}'",
                          [(1 / n, float(e)) for n, e in zip(grids, errors)]))
        start = found[3][2][0][1]
        found.append(("order 2", "lines dt 2 lc rgb 'black'",
                      [(1 / n, 0.5 * start * (GRIDS[0] / n) ** 2) for n in grids]))
        data, drawn = curves(found)
        make.plot(data, "set logscale xy\nset xlabel 'cell, m'\n"
                  "set xtics (0.0125, 0.025, 0.05, 0.1)\n"
                  f"set xrange [{0.8 / grids[-1]}:0.125]\n"
                  "set ylabel 'error of displacement'\nset key outside\n"
                  f"set title '{'vortex' if name == 'vortex' else 'two axes'}, flip'\n"
                  f"plot {drawn}", file)


def picture_bar():
    table = lines_of("bar")
    found = []
    for shape in schemes.SHAPES:
        for transfer in POINTS:
            cells = table[usual(shape, transfer)]
            places = [(float(time.split()[0]), abs(float(foot.split()[0])))
                      for foot, time in zip(cells[::2], cells[1::2]) if time]
            if places and (shape != "gimp, fixed" or transfer == "flip"):
                found.append((f"{shape}, {transfer}", f"linespoints lw 1.5 pt {POINTS[transfer]} "
                              f"lc rgb '{COLOURS[shape]}'", places))
    data, drawn = curves(found)
    make.plot(data, "set logscale xy\nset xlabel 'processor time, s'\n"
              "set ylabel 'error of the foot, %'\nset key outside font ',8'\n" + f"plot {drawn}",
              "bar_schemes.png")


def picture_disks():
    found = []
    for name, scheme, colour in (
            ("flip, usl", ("quadratic", "flip", "usl"), "#2060b0"),
            ("flip, musl", ("quadratic", "flip", "musl"), "#208040"),
            ("flip, usf", ("quadratic", "flip", "usf"), "#40c0a0"),
            ("flip, pic 0.01", ("quadratic", "flip, pic 0.01", "auto"), "#7080e0"),
            ("apic", ("quadratic", "apic", "auto"), "#b03060"),
            ("xpic 2", ("quadratic", "xpic 2", "auto"), "#d08000"),
            ("xpic 5", ("quadratic", "xpic 5", "auto"), "#e0c000"),
            ("pic", ("quadratic", "pic", "auto"), "#808080")):
        result = scenes.run("colliding_disks", {
            **schemes.scheme(*scheme), "solver.end": "6 s",
            "quantities.internal": "{measure: internal_energy, body: lower}"})
        times, kinetic = result.history("kinetic_lower")
        internal = result.history("internal")[1]
        total = [(t, (k + i) / kinetic[0]) for t, k, i in zip(times, kinetic, internal)]
        found.append((name, f"lines lw 2 lc rgb '{colour}'", total))
        if name == "flip, musl":
            found.append(("its kinetic part", f"lines lw 1 dt 2 lc rgb '{colour}'",
                          [(t, k / kinetic[0]) for t, k in zip(times, kinetic)]))
        scenes.drop(result)
    data, drawn = curves(found)
    make.plot(data, "set xlabel 'time, s'\nset yrange [0:1.05]\nset key outside\n"
              f"set ylabel 'energy of a disk over that at the start'\nplot {drawn}", "disks.png")


PICTURES = {f.__name__: f for f in (picture_manufactured, picture_bar, picture_disks)}

if __name__ == "__main__":
    for each in sys.argv[1:] or list(TABLES) + list(PICTURES):
        print(each, flush=True)
        if each in PICTURES:
            PICTURES[each]()
        else:
            make.replace(each, TABLES[each]())
