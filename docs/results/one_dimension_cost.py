"""Error against processor time, price of a point-step, pictures: for one_dimension_tables.py."""
import make
import scenes
import one_dimension as tests
import one_dimension_cases as cases

COLOURS = {"linear": "#888888", "gimp": "#b03060", "gimp fixed": "#d08020", "quadratic": "#2060b0",
           "cubic": "#208040"}
COST_GRIDS = (16, 32, 64, 128, 256)


def best(cells, shape, transfer="flip", points=2, repeats=3):
    """Error, and the least processor time of some runs."""
    found = [cases.manufactured(cells, 0.05, shape, transfer, "auto", points)
             for _ in range(repeats)]
    return found[0]["error"], min(f["cpu"] for f in found)


def curve(shape, transfer, points):
    found = []
    for cells in COST_GRIDS:
        try:
            found.append((cells, *best(cells, shape, transfer, points)))
        except scenes.Failed:
            continue
    return found


CURVES = (("linear", "flip", 2), ("gimp", "flip", 1), ("gimp", "flip", 2), ("gimp", "apic", 2),
          ("gimp", "xpic 5", 2), ("gimp fixed", "flip", 2), ("quadratic", "flip", 2),
          ("quadratic", "flip", 4), ("quadratic", "apic", 4), ("cubic", "flip", 2),
          ("cubic", "flip", 4), ("cubic", "apic", 4))


def one_cost():
    rows = []
    for key in CURVES:
        found = {cells: (error, time) for cells, error, time in curve(*key)}
        rows.append([key[0], key[1], str(key[2])] + [
            f"{found[n][0]:.1e}, {1e3 * found[n][1]:.0f} ms" if n in found else "stops"
            for n in COST_GRIDS])
    return make.table(["shape", "transfer", "points a cell", *(f"{n} cells" for n in COST_GRIDS)],
                      rows)


def rate(shape, transfer, order="auto", repeats=3):
    """Nanoseconds a point and step: a copper bar in three dimensions, one thread."""
    times = []
    for _ in range(repeats):
        result = scenes.run("taylor_bar_3d", {**cases.settings(shape, transfer, order),
                                              "solver.end": "5 us"})
        part = cases.cost(result)
        scenes.drop(result)
        times.append(1e9 * part["cpu"] / part["point_steps"])
    return min(times)


def one_rate():
    rows = []
    for shape in cases.SHAPES:
        rows.append([shape] + [f"{rate(shape, t):.0f}" if tests.offered(shape, t) else "refused"
                               for t in cases.TRANSFERS]
                    + [f"{rate(shape, 'flip', o):.0f}" for o in ("usl", "musl", "usf")])
    return make.table(["ns", *cases.TRANSFERS, "flip, usl", "flip, musl", "flip, usf"], rows)


def one_keeps():
    rows, plain = [], rate("quadratic", "flip")
    for transfer in cases.TRANSFERS:
        waves = [f"{abs(cases.standing(16, shape, transfer, 'usl')[-1]):.2f}"
                 for shape in ("gimp", "quadratic")]
        noise = cases.noise("quadratic", transfer, "usl", cases.NULL)["kept"]
        price = rate("quadratic", transfer) / plain
        rows.append([transfer, *waves, f"{noise:.2f}", f"{price:.1f}"])
    return make.table(["transfer", "wave, gimp", "wave, quadratic", "noise", "price"], rows)


def pictures():
    data, lines = [], []
    for i, (shape, points) in enumerate((s, p) for s in cases.SHAPES for p in (2, 4)):
        for cells in (8, 16, 32, 64, 128, 256):
            try:
                error = cases.manufactured(cells, 0.05, shape, points=points)["error"]
            except scenes.Failed:
                continue
            data.append(f"{cells} {error}")
        data += ["", ""]
        lines.append(f"'data' index {i} with linespoints lw 1.5 dt {1 if points == 2 else 2} "
                     f"pt {7 if points == 2 else 6} ps 0.7 lc rgb '{COLOURS[shape]}' "
                     f"title '{shape}, {points} points a cell'")
    make.plot("\n".join(data) + "\n",
              "set logscale xy\nset xlabel 'cells in the bar'\nset ylabel 'error'\n"
              "set format y '10^{%L}'\nset key outside right\nset xrange [7:300]\n"
              "set xtics (8, 16, 32, 64, 128, 256)\n"
              "plot 15/x**2 with lines lc rgb '#cccccc' title 'second order', "
              + ", ".join(lines), "motion_by_shape.png")
    data, lines = [], []
    for i, (shape, transfer, points) in enumerate(CURVES):
        data += [f"{time} {error}" for _, error, time in curve(shape, transfer, points)] + ["", ""]
        kind = {"flip": 1, "apic": 2, "xpic 5": 3}[transfer]
        lines.append(f"'data' index {i} with linespoints lw 1.5 dt {kind} "
                     f"pt {({1: 5, 2: 7, 4: 6})[points]} ps 0.7 lc rgb '{COLOURS[shape]}' "
                     f"title '{shape}, {transfer}, {points}'")
    make.plot("\n".join(data) + "\n",
              "set logscale xy\nset xlabel 'processor time, s'\nset ylabel 'error'\n"
              "set format y '10^{%L}'\nset format x '10^{%L}'\nset key outside right\n"
              "plot " + ", ".join(lines), "error_against_time.png")
