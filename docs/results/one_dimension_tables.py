"""Measures again the tables of one_dimension.md and ../shapes_and_transfers.md between
<!-- NAME --> and <!-- end -->, and their pictures. Takes about ten minutes.

    GAMUT=build/gamut python3 docs/results/one_dimension_tables.py [NAME ...]
"""
import math
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import make  # noqa: E402
import scenes  # noqa: E402
import waves  # noqa: E402
import one_dimension as tests  # noqa: E402
import one_dimension_cases as cases  # noqa: E402

PAGES = (os.path.join(HERE, "one_dimension.md"),
         os.path.join(HERE, "../shapes_and_transfers.md"))
GRIDS = (8, 16, 32, 64, 128, 256)


def attempted(function, *arguments, form=str, **more):
    """What a run gives, as text; or that it stops, or is refused."""
    try:
        return form(function(*arguments, **more))
    except scenes.Failed as failed:
        return {3: "refused", 5: "stops"}.get(failed.code, f"exit {failed.code}")


def number(value):
    return "0" if abs(value) < 1e-9 else f"{value:.1e}" if abs(value) < 1e-3 else f"{value:.3f}"


def with_orders(errors):
    shown = []
    for i, error in enumerate(errors):
        before = errors[i - 1] if i else None
        shown.append("stops" if error is None else f"{error:.2e}" if not before
                     else f"{error:.2e} ({math.log2(before / error):.2f})")
    return shown


def motion_errors(grids, *arguments, **more):
    found = []
    for cells in grids:
        try:
            found.append(cases.manufactured(cells, *arguments, **more)["error"])
        except scenes.Failed:
            found.append(None)
    return found


def one_reference():
    rows = []
    for shape in cases.SHAPES:
        rows.append([shape] + [max((attempted(tests.off_reference, shape, t, o, form=float)
                                    for _, t, o in tests.each([shape], orders=(o,))))
                               for o in cases.ORDERS])
    return make.table(["shape", *cases.ORDERS],
                      [[r[0], *(f"{v:.0e}" for v in r[1:])] for r in rows])


def one_kept():
    rows = []
    for transfer in cases.TRANSFERS:
        row = [transfer]
        for shape in ("linear", "gimp", "quadratic", "cubic"):
            row.append(" / ".join(attempted(cases.standing, n, shape, transfer, "usl",
                                            form=lambda k: number(k[-1])) for n in (8, 16, 32)))
        rows.append(row + [" / ".join(number(k) for k in tests.KEPT[transfer])])
    return make.table(["usl; 8 / 16 / 32 cells a wavelength", "linear", "gimp", "quadratic",
                       "cubic", "CPDI (other program)"], rows)


def one_drift():
    rows = []
    for shape in cases.SHAPES:
        rows.append([shape] + [attempted(cases.drift, shape, "flip", order, courant,
                                         form=lambda d: make.percent(d))
                               for order in cases.ORDERS for courant in (0.1, 0.5)])
    return make.table(["shape"] + [f"{o}, courant {c}" for o in cases.ORDERS for c in (0.1, 0.5)],
                      rows)


def one_vibrating():
    def form(f):
        return (f"{make.percent(f['omega'])}, {make.percent(f['amplitude'])}, "
                f"{make.percent(f['energy'])}")
    rows = []
    for transfer in cases.TRANSFERS:
        rows.append([transfer] + [attempted(cases.vibrating, 20, shape, transfer, "auto", form=form)
                                  for shape in ("linear", "gimp", "quadratic", "cubic")])
    for order in ("usl", "musl", "usf"):
        rows.append([f"flip, {order}"] + [
            attempted(cases.vibrating, 50, shape, "flip", order, form=form)
            for shape in ("linear", "gimp", "quadratic", "cubic")])
        rows[-1][0] += ", 50 cells"
    return make.table(["frequency, amplitude, energy a period", "linear", "gimp", "quadratic",
                       "cubic"], rows)


def motion(amplitude, points):
    return [[shape, str(p), *with_orders(motion_errors(GRIDS, amplitude, shape, points=p))]
            for shape in cases.SHAPES for p in points]


def one_motion_small():
    return make.table(["shape", "points a cell", *(f"{n} cells" for n in GRIDS)],
                      motion(1e-4, (2,)))


def one_motion():
    return make.table(["shape", "points a cell", *(f"{n} cells" for n in GRIDS)],
                      motion(0.05, (1, 2, 4)))


def one_motion_transfers():
    rows = []
    for shape, points in (("gimp", 2), ("quadratic", 4), ("cubic", 4)):
        for transfer in cases.TRANSFERS:
            rows.append([f"{shape}, {points}", transfer, "usl", *with_orders(
                motion_errors(GRIDS[1:5], 0.05, shape, transfer, "usl", points))])
        for order in ("musl", "usf"):
            rows.append([f"{shape}, {points}", "flip", order, *with_orders(
                motion_errors(GRIDS[1:5], 0.05, shape, "flip", order, points))])
    return make.table(["shape, points a cell", "transfer", "stress update",
                       *(f"{n} cells" for n in GRIDS[1:5])], rows)


def one_column():
    rows = []
    for shape in cases.SHAPES:
        for order in ("usl", "musl"):
            row = [shape, order]
            for cells in (12, 25, 50, 100):
                row.append(attempted(cases.column, cells, shape, "pic 0.001", order, form=lambda f:
                                     f"{f['place']:.1e}, {f['stress']:.1e}"))
            rows.append(row)
    return make.table(["shape", "stress update", "12 cells", "25", "50", "100"], rows)


def one_tension():
    def form(f):
        force = "" if f["force"] is None else f" ({100 * f['force']:.1f} %)"
        return f"{f['end']} at {f['stretch']:.2f}{force}"
    rows = []
    for shape in cases.SHAPES:
        for transfer, order in (("flip", "usl"), ("flip", "musl"), ("apic", "usl"),
                                ("apic", "musl"), ("xpic 2", "usl"), ("xpic 5", "musl")):
            if tests.offered(shape, transfer):
                rows.append([shape, transfer, order, *(
                    attempted(cases.tension, p, shape, transfer, order, form=form)
                    for p in (1, 2, 4))])
    return make.table(["shape", "transfer", "stress update", "1 point a cell", "2", "4"], rows)


def one_sod():
    rows = []
    for shape, transfer in ([(s, None) for s in cases.SHAPES]
                            + [("gimp", t) for t in ("apic", "xpic 2", "xpic 5")]
                            + [("quadratic", "apic")]):
        row, before = [shape, transfer or "flip, pic 0.02"], None
        for cell in (10.0, 5.0, 2.5, 1.25):
            try:
                norm = waves.sod(cell, cases.settings(shape, transfer))[0][0]
            except scenes.Failed as failed:
                row.append(f"stops, exit {failed.code}")
                before = None
                continue
            row.append(f"{norm:.5f}" + (f" ({math.log2(before / norm):.2f})" if before else ""))
            before = norm
        rows.append(row)
    return make.table(["shape", "transfer", "100 cells", "200", "400", "800"], rows)


def one_free():
    rows = []
    for shape in cases.SHAPES:
        for order in cases.ORDERS:
            row, momentum = [shape, order], 0.0
            for transfer in cases.TRANSFERS:
                try:
                    found = cases.free(shape, transfer, order)
                    row.append(make.percent(found["energy"], 1))
                    momentum = max(momentum, abs(found["momentum"]))
                except scenes.Failed as failed:
                    row.append({3: "refused"}.get(failed.code, "stops"))
            rows.append(row[:2] + [f"{momentum:.0e}"] + row[2:])
    return make.table(["shape", "stress update", "momentum", *cases.TRANSFERS], rows)


def one_noise():
    rows = []
    for shape in cases.SHAPES:
        for order in ("usl", "musl"):
            row = [shape, order]
            for transfer in cases.TRANSFERS:
                row.append(" / ".join(attempted(cases.noise, shape, transfer, order, v,
                                                form=lambda f: number(f["kept"]))
                                      for v in (cases.NULL, cases.WHITE)))
            rows.append([*row[:2], *(c.replace("refused / refused", "refused") for c in row[2:])])
    return make.table(["shape", "stress update", *cases.TRANSFERS], rows)


def one_ladder():
    numbers = (0.1, 0.5, 0.7, 0.9, 1.0, 1.1, 1.2, 1.5, 2.0)
    rows = []
    for shape in cases.SHAPES:
        for order in cases.ORDERS:
            found = [cases.ladder(shape, order, n) for n in numbers]
            rows.append([shape, order] + [f"{f['kept']:.2f}" if f["exit"] == 0
                                          else f"exit {f['exit']}" for f in found])
    return make.table(["shape", "stress update", *(str(n) for n in numbers)], rows)


def one_places():
    rows = []
    for shape in cases.SHAPES:
        for order in cases.ORDERS:
            try:
                smooth = cases.near_face(None, shape, order=order)["acceleration"]
                most = max(cases.near_face(k, shape, order=order)["acceleration"]
                           for k in range(1, 13)) / smooth
                shown = f"{most:.3f}"
            except scenes.Failed as failed:
                shown = f"stops, exit {failed.code}"
            rows.append([shape, order, f"{cases.flight(shape, 'flip', order):.0e}",
                         f"{cases.on_nodes(shape, 'flip', order):.0e}", shown])
    return make.table(["shape", "stress update", "1000 cells: stress over E",
                       "on nodes: rate of strain",
                       "near a node: acceleration"], rows)


def fill(name, text):
    for path in PAGES:
        if not os.path.exists(path):
            continue
        with open(path, encoding="utf-8") as page:
            old = page.read()
        new = re.sub(rf"(<!-- {name} -->\n).*?(<!-- end -->)",
                     lambda m: m.group(1) + text + "\n" + m.group(2), old, flags=re.S)
        if new != old:
            with open(path, "w", encoding="utf-8") as page:
                page.write(new)


if __name__ == "__main__":
    import one_dimension_cost as priced  # noqa: E402
    TABLES = {f.__name__: f for f in (
        one_reference, one_kept, one_drift, one_vibrating, one_motion_small, one_motion,
        one_motion_transfers, one_column, one_tension, one_sod, one_free, one_noise, one_ladder,
        one_places, priced.one_cost, priced.one_rate, priced.one_keeps)}
    for each in sys.argv[1:] or [*TABLES, "pictures"]:
        print(each, flush=True)
        if each == "pictures":
            priced.pictures()
        else:
            fill(each, TABLES[each]())
