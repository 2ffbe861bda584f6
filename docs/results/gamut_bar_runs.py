"""Runs and readings behind gamut_bar_figures.py: bars, curves, fields, and the tables."""
import csv
import json
import math
import os
import subprocess
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tests"))
import needs  # noqa: E402

needs.modules("h5py")
import h5py  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
TREE = os.path.dirname(os.path.dirname(HERE))
GAMUT = os.path.abspath(os.environ.get("GAMUT", os.path.join(TREE, "build/gamut")))
INPUTS = os.path.join(TREE, "inputs")

# Young's modulus, yield stress, n, K, failure stress, failure strain, as in
# inputs/materials.
CARD = {"al7075": (71.6e9, 538.6e6, 17.8702, 0.002, 665.8e6, 0.115),
        "ti64": (115.7e9, 867e6, 47.61, 0.002, 933e6, 0.516)}
NAME = {"al7075": "material 1 (7075)", "ti64": "material 2 (Ti-6Al-4V)"}
SEED = {"al7075": 30, "ti64": 60}
GRIDS = ("uniform", "random")
NOISY = ("modulus", "softness", "density", "weights")
BONDS = 500
LENGTH = 0.1
# Table 1 of the paper: stochastic grid, uniform grid, deterministic, measured.
PAPER = {"al7075": (("0.0777", "0.0612", "0.06244", "0.0662"),
                    ("774.16", "774.44", "791.6", "792.8")),
         "ti64": (("0.0381", "0.0481", "0.04762", "0.0484"),
                  ("1032.3", "1091.1", "1105.4", "1340.5 to 1537.6"))}


class Bars:
    """Runs scenes into a folder, each one once."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        os.makedirs(folder, exist_ok=True)

    def run(self, name, path, changes=()):
        out = os.path.join(self.folder, name)
        if not os.path.exists(os.path.join(out, "summary.json")):
            sets = [part for change in changes for part in ("--set", change)]
            done = subprocess.run([GAMUT, "run", path, "-o", out, "--threads", "1", "--force",
                                   *sets], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(f"{name}: exit {done.returncode}\n{done.stderr}")
        return out

    def single(self, name, material, solver, fields="", seed=1):
        """One bar; `solver` are lines of its solver."""
        path = os.path.join(self.folder, name + ".yaml")
        with open(path, "w", encoding="utf-8") as scene:
            scene.write(f"gamut: 1\ntitle: {name}\n"
                        f"include: [{os.path.join(INPUTS, f'bar_{material}.yaml')}]\n"
                        "solver:\n" + "".join(f"  {line}\n" for line in solver)
                        + f"uncertainty: {{seed: {seed}}}\n"
                        + (f"outputs: {{every: 1, fields: [{fields}]}}\n" if fields else ""))
        return self.run(name, path, () if fields else ("outputs.every=100000",))

    def study(self, material, grid, divisor=10, spread=0.65):
        """Thirty realisations of bar_MATERIAL_random.yaml."""
        changes = [f"solver.grid={grid}", f"solver.grid_range={spread}"]
        changes += [f"solver.noise.{field}.divisor={divisor}" for field in NOISY]
        return self.run(f"study-{material}-{grid}-{divisor}-{spread}",
                        os.path.join(INPUTS, f"bar_{material}_random.yaml"), changes)


def noise(fields=NOISY, energy=0.95):
    law = (f"{{model: karhunen_loeve, from: samples, samples: 30, energy: {energy}, "
           "distribution: weibull}")
    return "noise: {" + ", ".join(f"{field}: {law}" for field in fields) + "}"


def frame(folder):
    """Fields of the last frame, by name."""
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        bar = file["frames"][sorted(file["frames"])[-1]]["bar"]
        found = {name: bar[name][()].tolist() for name in bar}
    found["x"] = [1e3 * place[0] for place in found["position"]]
    return found


def curve(folder):
    """Strain in percent and stress in MPa of a single run."""
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        group = file["quantities/stress_strain"]
        return [(100 * e, s / 1e6) for e, s in zip(group["strain"][()].tolist(),
                                                   group["value"][()].tolist())]


def curves(folder):
    """Strain, mean stress, and the stress of every run of a study, in SI."""
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        group = file["study/curves/stress_strain"]
        return tuple(group[name][()].tolist() for name in ("strain", "mean", "runs"))


def table_of(folder):
    with open(os.path.join(folder, "study.csv"), encoding="utf-8", newline="") as file:
        return [{key.split(" [")[0]: value for key, value in row.items()}
                for row in csv.DictReader(file)]


def moments(folder, name):
    values = [float(row[name]) for row in table_of(folder) if row["run"] != "-1"]
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1))


def ramberg_osgood(material, strain):
    """Stress at a strain, by bisection of the closed form."""
    modulus, yielding, n, offset = CARD[material][:4]
    low, high = 0.0, modulus * strain
    for _ in range(100):
        middle = 0.5 * (low + high)
        if middle / modulus + offset * (middle / yielding) ** n < strain:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def line(points):
    """Slope and value at 0 of the straight line through points."""
    n = len(points)
    x, y = (sum(p[k] for p in points) / n for k in (0, 1))
    slope = (sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points))
    return slope, y - slope * x


def fields_of(bars, material, grid):
    """Fields of one noisy bar at a load far below yielding."""
    return frame(bars.single(f"fields-{material}-{grid}", material,
                             [f"grid: {grid}", "load: table", "load_table: [[1, 100 MPa]]",
                              noise()],
                             "position, bond_modulus, softness, interaction_length, bond_length",
                             SEED[material]))


def plain(bars, material):
    """The same of a bar without noise on the uniform grid."""
    return frame(bars.single(f"plain-{material}", material,
                             ["load: table", "load_table: [[1, 100 MPa]]"],
                             "position, bond_modulus, softness, interaction_length, bond_length"))


def weights(bars, material, bond, seed):
    """Weights of the family of a bond over distance (mm); seed 0: without noise.

    While nothing yields, the strain of family p is stress / sum_q w_pq E_q: a modulus that is
    changed at one bond by a thousandth shows the weights of that bond, w_pq = w_qp here.
    """
    change = 1e-3
    rows = ", ".join(f"[1, 1, {1 + change if i == bond else 1}, 0, 1]" for i in range(BONDS))
    solver = [f"bond_table: [{rows}]", "load: table", "load_table: [[1, 100 MPa]]"]
    if seed:
        solver.append(noise(("weights",)))
    got = frame(bars.single(f"weights-{material}-{bond}-{seed}", material, solver,
                            "position, family_strain", seed or 1))
    found = [(100e6 / (strain * CARD[material][0]) - 1) / change for strain in got["family_strain"]]
    if abs(sum(found) - 1) > 1e-6:
        sys.exit(f"the weights of bond {bond} have the sum {sum(found)}")
    return [(1e3 * LENGTH * (i - bond) / BONDS, w) for i, w in enumerate(found)
            if i != bond and w > 1e-8]


def tips(material, points):
    """Plastic strain and stress (MPa) of the ten tensile tips: engineering, and true."""
    modulus, yielding = CARD[material][:2]
    engineering, true = [], []
    for k in range(10):
        stress = yielding * 1.01 ** k
        strain = [e / 100 for e, s in points if abs(1e6 * s / stress - 1) < 1e-9][-1]
        engineering.append((strain - stress / modulus, stress / 1e6))
        real = stress * (1 + strain)
        true.append((math.log1p(strain) - real / modulus, real / 1e6))
    return engineering, true


def cyclic(bars, material, grid):
    return bars.single(f"cyclic-{material}-{grid}", material,
                       [f"grid: {grid}", "load: cyclic", "rupture: report", noise()],
                       seed=SEED[material])


def off(material, folder):
    """Strain (percent) and mean curve against Ramberg and Osgood (percent)."""
    strain, mean, _ = curves(folder)
    return [(100 * e, 100 * (s / ramberg_osgood(material, e) - 1))
            for e, s in zip(strain, mean) if e > 0]


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def table_1(bars):
    rows = []
    for material in CARD:
        plain_run = bars.run(f"deterministic-{material}",
                             os.path.join(INPUTS, f"bar_{material}.yaml"))
        with open(os.path.join(plain_run, "summary.json"), encoding="utf-8") as file:
            deterministic = json.load(file)["quantities"]
        for symbol, quantity, paper, scale, form in (
                ("n'", "n_prime", PAPER[material][0], 1, ".4f"),
                ("K', MPa", "K_prime", PAPER[material][1], 1e6, ".1f")):
            rows.append([NAME[material], symbol, "paper", *paper])
            for words, key in (("true, ten levels", quantity + "_true"), ("engineering", quantity)):
                cells = []
                for grid in ("random", "uniform"):
                    mean, deviation = moments(bars.study(material, grid), key)
                    cells.append(f"{mean / scale:{form}} +- {deviation / scale:{form}}")
                value = deterministic[key]
                value = value["value"] if isinstance(value, dict) else value
                rows.append(["", "", f"gamut, {words}", *cells, f"{value / scale:{form}}", ""])
    return markdown(["material", "", "", "random grid", "uniform grid", "deterministic",
                     "measured"], rows)


def claim_row(material, words, folder):
    """What the mean of a study is off, the scatter, the modulus."""
    offs = off(material, folder)
    _, mean, every = curves(folder)
    at = next(i for i, (e, _) in enumerate(offs) if e > 1) + 1
    scatter = math.sqrt(sum((run[at] - mean[at]) ** 2 for run in every) / (len(every) - 1))
    modulus, deviation = moments(folder, "initial_modulus")
    nominal = CARD[material][0]
    return [NAME[material], words, f"{max(abs(d) for _, d in offs):.3f} %",
            f"{max(abs(d) for e, d in offs if e >= 1):.3f} %", f"{100 * scatter / mean[at]:.3f} %",
            f"{100 * (modulus / nominal - 1):+.3f} % +- {100 * deviation / nominal:.3f} %"]


def at_strain(points, strain):
    """Value of a curve at a strain, on the straight line between its points."""
    for (a, u), (b, v) in zip(points, points[1:]):
        if a <= strain <= b:
            return u + (v - u) * (strain - a) / (b - a)
    return math.nan


def pair(bars, material, spread):
    """At 2 % strain: runs on random grids less the same runs on the uniform one, percent."""
    # Every study has an axis of its own; what runs are off the theory is smooth between its points.
    even, uneven = (
        [at_strain([(e, 100 * (s / ramberg_osgood(material, e) - 1))
                    for e, s in zip(strain[1:], run[1:])], 0.02) for run in every]
        for strain, _, every in (curves(bars.study(material, "uniform")),
                                 curves(bars.study(material, "random", 10, spread))))
    apart = [a - b for a, b in zip(uneven, even)]
    mean = sum(apart) / len(apart)
    deviation = math.sqrt(sum((d - mean) ** 2 for d in apart) / (len(apart) - 1))
    return [f"{mean:+.3f} % +- {deviation / math.sqrt(len(apart)):.3f} %", f"{deviation:.3f} %"]


CLAIM_HEAD = ["material", "setting", "mean curve off the theory, at most", "beyond 1 % strain",
              "scatter at 1 % strain", "initial modulus off, mean +- deviation"]
PAIR_HEAD = ["less the uniform grid at 2 % strain, mean +- its error", "deviation of one run"]
DIVISORS = (5, 10, 20, 40)
SPREADS = (0.1, 0.65, 0.9)


def divisors(bars):
    return markdown(CLAIM_HEAD, [claim_row(material, f"divisor {by}",
                                           bars.study(material, "random", by))
                                 for material in CARD for by in DIVISORS])


def spreads(bars):
    rows = []
    for material in CARD:
        rows.append(claim_row(material, "uniform grid", bars.study(material, "uniform")) + [""] * 2)
        rows += [claim_row(material, f"range {spread}", bars.study(material, "random", 10, spread))
                 + pair(bars, material, spread) for spread in SPREADS]
    return markdown(CLAIM_HEAD + PAIR_HEAD, rows)
