"""Makes again the pictures and tables of gamut_bar_figures.md: runs the bars, writes the pictures
in docs/pictures/gamut_bar and what stands between <!-- NAME --> and <!-- end --> of the page.
Needs h5py and gnuplot; takes some minutes on one core.

    GAMUT=build/gamut python3 docs/results/gamut_bar_figures.py [FOLDER]

Runs are kept in FOLDER, if one is named, and not made again when they are there.
"""
import math
import os
import re
import subprocess
import sys
import tempfile

import gamut_bar_runs as runs
from gamut_bar_runs import CARD, GRIDS, NAME

PICTURES = os.path.join(runs.TREE, "docs/pictures/gamut_bar")
RED, BLUE, GREY, BLACK, GREEN = "#b03060", "#3060b0", "#bbbbbb", "#000000", "#308050"
COLOURS = (BLUE, GREEN, "#d08000", RED, "#8050a0")


def lines(colour, width=1.5, extra=""):
    return f"lines lw {width} {extra} lc rgb '{colour}'"


def dots(colour, size=0.4, kind=7):
    return f"points pt {kind} ps {size} lc rgb '{colour}'"


class Panel:
    """One plot: title, labels of the axes, gnuplot settings, series of (points, style, title)."""

    def __init__(self, title, x, y, settings, *series):
        self.title, self.x, self.y, self.settings, self.series = title, x, y, settings, series


def picture(name, rows, columns, *panels):
    with tempfile.TemporaryDirectory(prefix="gamut-plot-") as scratch:
        script = ["set terminal pngcairo size "
                  f"900,{290 * rows + 20} font 'sans,9'",
                  f"set output '{os.path.join(PICTURES, name)}.png'",
                  f"set multiplot layout {rows},{columns}", "set key samplen 2 spacing 1.1",
                  "set grid lc rgb '#dddddd'", "set tics nomirror"]
        for p, panel in enumerate(panels):
            parts = []
            for s, (points, style, title) in enumerate(panel.series):
                with open(os.path.join(scratch, f"{p}-{s}"), "w", encoding="utf-8") as file:
                    file.writelines("\n" if point is None else
                                    " ".join(f"{v:.9g}" for v in point) + "\n" for point in points)
                parts.append(f"'{p}-{s}' with {style} "
                             + (f"title \"{title}\"" if title else "notitle"))
            script += ["unset logscale; set autoscale; set key default; "
                       "set key top right noreverse Right samplen 2; set offsets; set ytics auto; "
                       "set xtics auto; unset yrange; unset xrange",
                       f"set title \"{panel.title}\"", f"set xlabel \"{panel.x}\"",
                       f"set ylabel \"{panel.y}\"", panel.settings, "plot " + ", ".join(parts)]
        subprocess.run(["gnuplot"], input="\n".join(script) + "\nunset multiplot\n", text=True,
                       check=True, cwd=scratch)


def zipped(x, y, scale=1.0, less=0.0):
    return [(a, (b - less) * scale) for a, b in zip(x, y)]


def softness_curves(bars):
    panels = []
    for material, (modulus, _, _, _, _, failure) in CARD.items():
        series = [([(0, 0), (1.2e11 / modulus, 1200)],
                   lines(BLACK, 1, "dt 4"), "linear elastic")]
        for colour, xi in zip((BLUE, GREEN, BLACK, "#d08000", RED), (-0.2, -0.1, 0, 0.1, 0.2)):
            rows = ", ".join([f"[1, 1, 1, {xi}, 1]"] * 20)
            folder = bars.single(f"softness-{material}-{xi}", material,
                                 ["bonds: 20", f"bond_table: [{rows}]", "rupture: report",
                                  f"strain_limit: {failure}"])
            series.append((runs.curve(folder), lines(colour, 2.5 if xi == 0 else 1.5),
                           f"noise {xi:+g}" if xi else "no noise"))
        panels.append(Panel(NAME[material], "strain, %", "stress, MPa",
                            "set xrange [0:5]; set yrange [0:1200]; set key bottom right", *series))
    picture("softness_curves", 1, 2, *panels)


def weight_distributions(bars):
    bond = 249
    even = runs.weights(bars, "al7075", bond, 0)
    sharp = [(x, abs(x) ** -6) for x, _ in even]
    total = sum(w for _, w in sharp)
    sharp = [(x, w / total) for x, w in sharp]
    noisy = [(runs.weights(bars, "al7075", bond, seed), dots(colour, 0.3), f"noise, seed {seed}")
             for colour, seed in zip(COLOURS, (1, 2, 3))]
    x, y = "distance of the nonlocal bond, mm", "weight"
    picture("weight_distributions", 1, 2,
            Panel("bond at the middle", x, y, "set yrange [0:0.022]", *noisy,
                  (even, lines(BLACK, 2.5), "no noise")),
            Panel("the same beside the pair potential", x, y,
                  "set logscale y; set yrange [1e-7:100]; set format y '10^{%T}'", *noisy,
                  (even, lines(BLACK, 2.5), "no noise"),
                  (sharp, lines(RED, 1.5, "dt 4"), "pair potential")))


def grids(bars):
    spacing = runs.fields_of(bars, "al7075", "random")
    place, nodes = 0.0, []
    for length in spacing["bond_length"]:
        nodes.append((place, 2))
        place += 1e3 * length
    even = [(1e3 * runs.LENGTH * i / runs.BONDS, 1) for i in range(runs.BONDS)]
    picture("grids", 1, 2,
            Panel("nodes near the left end", "place, mm", "",
                  "set xrange [0:8]; set yrange [0.5:2.5]; set ytics ('uniform' 1, 'random' 2)",
                  (nodes, dots(RED, 0.7), ""), (even, dots(BLUE, 0.7), "")),
            Panel("lengths of the bonds, whole bar", "place, mm", "length, mm",
                  "set xrange [0:100]; set yrange [0:0.4]",
                  (zipped(spacing["x"], spacing["bond_length"], 1e3), dots(RED), "random"),
                  ([(0, 0.2), (100, 0.2)], lines(BLUE, 2), "uniform")))


def modulus(bars):
    panels = []
    for material, card in CARD.items():
        mean = card[0] / 1e9
        of = {}
        for grid in GRIDS:
            got = runs.fields_of(bars, material, grid)
            of[grid] = zipped(got["x"], got["bond_modulus"], 1e-9)
        limits = f"set yrange [{0.65 * mean}:{1.5 * mean}]; "
        axes = ("place, mm", "Young's modulus, GPa")
        even = ([(0, mean), (100, mean)], lines(BLACK, 2), "deterministic")
        panels += [Panel(f"{NAME[material]}, uniform grid", *axes, limits + "set xrange [0:100]",
                         (of["uniform"], lines(RED, 0.7), "one realisation"), even),
                   Panel("the same, first 10 mm", *axes, limits + "set xrange [0:10]",
                         *[(of[grid], f"linespoints pt 7 ps 0.4 lw 1 lc rgb '{colour}'",
                            f"{grid} grid") for grid, colour in zip(GRIDS, (RED, BLUE))], even)]
    picture("modulus", 2, 2, *panels)


def softness(bars):
    panels = []
    for material in CARD:
        got = runs.fields_of(bars, material, "uniform")
        even = runs.plain(bars, material)["softness"][0]
        low = 0.65 if material == "al7075" else 0.94
        panels += [Panel(f"{NAME[material]}: parts", "place, mm", "modulus of softness R",
                         "set xrange [0:100]; set yrange [-0.5:1.5]",
                         ([(0, even), (100, even)], lines(BLACK, 2), "deterministic"),
                         (zipped(got["x"], got["softness"], 10, even), lines(BLUE, 0.8),
                          "random part, 10 times")),
                   Panel(f"{NAME[material]}: sum", "place, mm", "modulus of softness R",
                         f"set xrange [0:100]; set yrange [{low}:1]; set key bottom right",
                         (zipped(got["x"], got["softness"]), lines(RED, 0.8), "one realisation"),
                         ([(0, even), (100, even)], lines(BLACK, 2), "deterministic"))]
    picture("softness", 2, 2, *panels)


def weights(bars):
    panels = []
    for material in CARD:
        parts, sums = [], []
        for bond, words, colour in ((0, "L = 0", RED), (62, "L/8", BLUE)):
            even = runs.weights(bars, material, bond, 0)
            noisy = dict(runs.weights(bars, material, bond, runs.SEED[material]))
            shift = 1e3 * runs.LENGTH * (bond + 0.5) / runs.BONDS
            gap = [None if i and b[0] - even[i - 1][0] > 0.3 else b for i, b in enumerate(even)]
            parts += [([p and (p[0] + shift, p[1]) for p in gap], lines(colour, 2), words),
                      ([(x + shift, noisy.get(x, 0) - w) for x, w in even], lines(colour, 0.8),
                       words + ", random part")]
            sums += [([(x + shift, noisy[x]) for x in sorted(noisy)], dots(colour, 0.35), words),
                     ([p and (p[0] + shift, p[1]) for p in gap], lines(BLACK, 1.2), "")]
        panels += [Panel(f"{NAME[material]}: parts", "place of the nonlocal bond, mm", "weight",
                         "set xrange [0:60]; set yrange [-0.006:0.02]", *parts),
                   Panel(f"{NAME[material]}: sum", "place of the nonlocal bond, mm", "weight",
                         "set xrange [0:60]; set yrange [0:0.024]", *sums)]
    picture("weights", 2, 2, *panels)


def interaction(bars):
    panels = []
    for material in CARD:
        got = {grid: runs.fields_of(bars, material, grid) for grid in GRIDS}
        even = runs.plain(bars, material)
        random = [(x, 1e5 * (a - b)) for x, a, b in zip(
            even["x"], got["uniform"]["interaction_length"], even["interaction_length"])]
        base = zipped(even["x"], even["interaction_length"], 1e3)
        panels += [Panel(f"{NAME[material]}: parts, uniform grid", "place, mm",
                         "standard deviation d, mm", "set xrange [0:100]; set yrange [-4:16]",
                         (base, lines(BLACK, 2), "deterministic"),
                         (random, lines(BLUE, 1), "random part, 100 times")),
                   Panel(f"{NAME[material]}: sum", "place, mm", "standard deviation d, mm",
                         "set xrange [0:100]; set yrange [5:14]",
                         (zipped(got["random"]["x"], got["random"]["interaction_length"], 1e3),
                          dots(GREY, 0.35), "random grid"),
                         (zipped(even["x"], got["uniform"]["interaction_length"], 1e3),
                          dots(RED, 0.25), "uniform grid"),
                         (base, lines(BLACK, 1.2), "deterministic"))]
    picture("interaction_length", 2, 2, *panels)


def theory(material, most):
    strains = [most * (i / 300) ** 3 for i in range(301)]
    return [(100 * e, runs.ramberg_osgood(material, e) / 1e6) for e in strains]


def realisations(bars):
    panels = []
    for material, card in CARD.items():
        for grid in GRIDS:
            strain, _, every = runs.curves(bars.study(material, grid))
            flat = []
            for run in every:
                flat += [(100 * e, s / 1e6) for e, s in zip(strain, run)] + [None]
            panels.append(Panel(f"{NAME[material]}, {grid} grid", "engineering strain, %",
                                "engineering stress, MPa",
                                f"set xrange [0.3:1.8]; set yrange [{0.4 * card[1] / 1e6}:*]; "
                                "set key bottom right",
                                (flat, lines(BLUE, 0.6), "30 realisations"),
                                (theory(material, card[5]), lines(BLACK, 2), "deterministic")))
    picture("realisations", 2, 2, *panels)


def mean_curves(bars):
    panels = []
    for material, card in CARD.items():
        series, offs = [], []
        with_theory = theory(material, card[5])
        series.append((with_theory, lines(GREY, 5), "Ramberg and Osgood"))
        plain = bars.single(f"plain-curve-{material}", material, ["load: monotonic"])
        series.append((runs.curve(plain), lines(BLACK, 1.5), "deterministic bar"))
        for grid, colour in zip(GRIDS, (BLUE, RED)):
            folder = bars.study(material, grid)
            strain, mean, _ = runs.curves(folder)
            series.append(([(100 * e, s / 1e6) for e, s in zip(strain, mean)],
                           lines(colour, 1.5, "dt 2"), f"mean of 30, {grid} grid"))
            offs.append((runs.off(material, folder), lines(colour), f"{grid} grid"))
        panels += [Panel(NAME[material], "engineering strain, %", "engineering stress, MPa",
                         f"set xrange [0:{100 * card[5]:g}]; set yrange [0:*]; "
                         "set key bottom right", *series),
                   Panel("mean curve less the theory", "engineering strain, %",
                         "difference in stress, %",
                         f"set logscale x; set xrange [0.2:{100 * card[5]:g}]; "
                         "set key bottom right", *offs)]
    picture("mean_curves", 2, 2, *panels)


def loops(bars):
    panels = [Panel(f"{NAME[material]}, {grid} grid", "engineering strain, %",
                    "engineering stress, MPa", "set format x '%g'",
                    (runs.curve(runs.cyclic(bars, material, grid)), lines(BLUE, 0.8), ""))
              for material in CARD for grid in GRIDS]
    picture("loops", 2, 2, *panels)


def fits(bars):
    panels = []
    for material in CARD:
        for grid in GRIDS:
            series = []
            found = runs.tips(material, runs.curve(runs.cyclic(bars, material, grid)))
            for points, words, colour in zip(found, ("engineering", "true"), (BLUE, RED)):
                logs = [(math.log10(p), math.log10(s)) for p, s in points]
                slope, start = runs.line(logs)
                series += [(logs, dots(colour, 0.8), words),
                           ([(x, slope * x + start) for x, _ in logs], lines(colour, 1.2),
                            f"n' = {slope:.4f}, K' = {10 ** start:.1f} MPa")]
            panels.append(Panel(f"{NAME[material]}, {grid} grid",
                                "log_{10} of the plastic strain amplitude",
                                "log_{10} of the stress amplitude, MPa",
                                "set key top left Left reverse; "
                                "set offsets graph 0.05, graph 0.05, graph 0.7, graph 0.05",
                                *series))
    picture("fits", 2, 2, *panels)


def exponents(bars):
    panels = []
    for key, words, scale, column in (("n_prime", "n'", 1, 0), ("K_prime", "K', MPa", 1e6, 1)):
        for material in CARD:
            series = []
            for kind, dot in (("_true", 7), ("", 6)):
                for grid, colour in zip(GRIDS, (BLUE, RED)):
                    rows = runs.table_of(bars.study(material, grid))
                    points = [(i + 1, float(row[key + kind]) / scale)
                              for i, row in enumerate(rows)]
                    series.append((points, dots(colour, 0.7, dot), f"{grid} grid, "
                                   + ("true" if kind else "engineering")))
            paper = float(runs.PAPER[material][column][2])
            series.append(([(0, paper), (31, paper)], lines(BLACK, 1.5, "dt 2"),
                           "paper, deterministic"))
            panels.append(Panel(NAME[material], "realisation", words,
                                "set xrange [0:31]; "
                                "set offsets 0, 0, graph 0.95, graph 0.05",
                                *series))
    picture("exponents", 2, 2, *panels)


def expansion(bars):
    def field(seed, energy):
        got = runs.frame(bars.single(f"kl-{seed}-{energy}", "al7075",
                                     ["load: table", "load_table: [[1, 100 MPa]]",
                                      noise_of_modulus(energy)], "position, bond_modulus", seed))
        return zipped(got["x"], got["bond_modulus"], 100 / CARD["al7075"][0],
                      CARD["al7075"][0])

    def noise_of_modulus(energy):
        return runs.noise(("modulus",), energy)

    whole = field(6, 1)
    energies = (0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 1)
    size = math.sqrt(sum(v * v for _, v in whole))
    rest = [(100 * energy, 100 * math.sqrt(sum((a[1] - b[1]) ** 2 for a, b in zip(
        field(6, energy), whole))) / size) for energy in energies]
    place, noise = "place, mm", "noise of the modulus, %"
    picture("expansion", 2, 2,
            Panel("realisations of the process", place, noise,
                  "set xrange [0:15]; set yrange [-25:38]",
                  *[(field(seed, 1), lines(colour, 1), f"seed {seed}")
                    for colour, seed in zip(COLOURS, (4, 5, 6))]),
            *[Panel(f"one realisation, {100 * energy:g} % of the variance", place, noise,
                    "set xrange [0:15]; set yrange [-25:38]", (whole, lines(BLACK, 2), "process"),
                    (field(6, energy), lines(RED, 1.2), "expansion")) for energy in (0.6, 0.95)],
            Panel("what the expansion leaves", "variance that is kept, %",
                  "rest over process, root mean square, %", "set yrange [0:100]",
                  (rest, "linespoints pt 7 ps 0.8 lw 1.5 lc rgb '" + RED + "'", "")))


def claims(bars):
    panels = []
    for material in CARD:
        series = [(runs.off(material, bars.study(material, "random", by)), lines(colour),
                   f"divisor {by}") for by, colour in zip(runs.DIVISORS, COLOURS)]
        panels.append(Panel(f"{NAME[material]}, random grid", "strain, %",
                            "mean stress less theory, %",
                            "set logscale x; set xrange [0.2:10]; set key bottom right", *series))
    for material in CARD:
        even = runs.off(material, bars.study(material, "uniform"))
        series = []
        for spread, colour in zip(reversed(runs.SPREADS), (RED, BLUE, BLACK)):
            uneven = runs.off(material, bars.study(material, "random", 10, spread))
            apart = [(e, d - runs.at_strain(even, e)) for e, d in uneven if e < 10]
            series.append(([p for p in apart if not math.isnan(p[1])], lines(colour),
                           f"range {spread}"))
        panels.append(Panel(f"{NAME[material]}, divisor 10", "strain, %",
                            "less the uniform grid's mean, %",
                            "set logscale x; set xrange [0.2:10]; "
                            "set yrange [-0.05:0.15]", *series))
    picture("claims", 2, 2, *panels)


ALL = (softness_curves, weight_distributions, grids, modulus, softness, weights, interaction,
       realisations, mean_curves, loops, fits, exponents, expansion, claims)


def main():
    with tempfile.TemporaryDirectory(prefix="gamut-figures-") as scratch:
        bars = runs.Bars(sys.argv[1] if len(sys.argv) > 1 else scratch)
        os.makedirs(PICTURES, exist_ok=True)
        for make in ALL:
            print(make.__name__, flush=True)
            make(bars)
        path = os.path.join(runs.HERE, "gamut_bar_figures.md")
        with open(path, encoding="utf-8") as file:
            page = file.read()
        for make in (runs.table_1, runs.divisors, runs.spreads):
            text = make(bars)
            page = re.sub(rf"(<!-- {make.__name__} -->\n).*?(<!-- end -->)",
                          lambda m, new=text: m.group(1) + new + "\n" + m.group(2), page,
                          flags=re.S)
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)


if __name__ == "__main__":
    main()
