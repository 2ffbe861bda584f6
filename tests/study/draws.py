"""What is drawn: spreads of temperatures, truncation to a constraint, a correlation of one."""
import math
import os
import statistics
import tempfile

from scenes import column, runs_of, summary, table, write
from tap import done, figure, gamut, report

POINT = """gamut: 1
solver: {{model: material_driver, end: 1 us, steps: 4, control: {{xx: {{strain_rate: 1000 1/s}}}}}}
materials:
  m:
    density: 8960 kg/m3
    specific_heat: 383 J/(kg K)
    eos: {{model: linear, bulk_modulus: 140 GPa}}
    strength: {{model: johnson_cook, A: {a}, B: {b}, n: 0.31, C: 0.025, m: 1.09, T_melt: {melt}}}
    elasticity: {{model: hypoelastic, {elastic}}}
bodies: {{s: {{material: m}}}}
effects: {{heat: {{model: adiabatic_heating}}}}
quantities: {{s: {{measure: stress_xx, reduce: at end}}}}
uncertainty: {{estimator: {{model: monte_carlo, runs: {runs}}}, correlation: {correlation}}}
"""
MELT = "materials.m.strength.T_melt"
A, B = "materials.m.strength.A", "materials.m.strength.B"


def point(folder, name, melt="1356 K", a="90 MPa", b="292 MPa", runs=40, correlation="[]",
          elastic="shear_modulus: 47 GPa"):
    return write(folder, name + ".yaml", POINT.format(
        melt=melt, a=a, b=b, runs=runs, elastic=elastic, correlation=correlation))


def drawn(out, path, unit="K"):
    return [float(row[f"{path} [{unit}]"]) for row in runs_of(out)]


def run(folder, name, *words, **changes):
    out = os.path.join(folder, name)
    return out, gamut("run", point(folder, name, **changes), "-o", out, *words)


def temperatures(folder):
    """A spread is a difference: the same draws whatever the scale, to rounding."""
    reference, _ = run(folder, "kelvin", melt="{mean: 1356.15 K, sd: 20 K}")
    wanted = drawn(reference, MELT)
    figure(abs(statistics.stdev(wanted) / 20 - 1), 4 / math.sqrt(2 * 40),
           "sd: 20 K, deviation of 40 draws off by")
    for name, law in (("celsius", "{mean: 1083 degC, sd: 20 degC}"),
                      ("mixed", "{mean: 1083 degC, sd: 20 K}"),
                      ("fahrenheit", "{mean: 1981.4 degF, sd: 36 degF}"),
                      ("kelvin_celsius", "{mean: 1356.15 K, sd: 20 degC}")):
        out, answer = run(folder, name, melt=law)
        figure(max(abs(x - y) for x, y in zip(drawn(out, MELT), wanted)), 1e-9,
               f"{law}: draws off those in K by")
    low, _ = run(folder, "beta", melt="{distribution: beta, mean: 1083 degC, sd: 20 degC, "
                                      "lower: 1000 degC, upper: 1150 degC}")
    high, _ = run(folder, "beta_k", melt="{distribution: beta, mean: 1356.15 K, sd: 20 K, "
                                         "lower: 1273.15 K, upper: 1423.15 K}")
    figure(max(abs(x - y) for x, y in zip(drawn(low, MELT), drawn(high, MELT))), 1e-9,
           "a beta law's sd is a difference, its ends are temperatures: off by")
    out, _ = run(folder, "ends", melt="{mean: 1083 degC, sd: 20 degC, truncate: [1070 degC, inf]}")
    least = min(drawn(out, MELT))
    report(least >= 1343.15, f"truncated at 1070 degC: least {least} K")
    answer = gamut("check", point(folder, "cv", melt="{mean: 1083 degC, cv: 0.02}"))
    report(answer.code == 3 and "a zero of its own" in answer.said, "cv of a mean in degC: exit 3",
           answer)
    answer = gamut("check", point(folder, "cv_k", melt="{mean: 1356 K, cv: 0.02}"))
    report(answer.code == 0, "cv of a mean in K", answer)


def constraint(folder):
    """Draws against T_melt > T_room are made again; the same ones for any threads, and resumed."""
    law = "{mean: 320 K, sd: 30 K, truncate: true}"
    outs = []
    for threads in ("1", "3"):
        out, answer = run(folder, "again" + threads, "--threads", threads, melt=law, runs=200)
        outs.append(out)
    rows = runs_of(outs[0])
    report(answer.code == 0 and all(row["status"] == "ok" for row in rows)
           and min(drawn(outs[0], MELT)) > 298, "no run fails, none is below T_room", answer)
    report(table(outs[0]) == table(outs[1]), "the same draws for 1 and 3 threads")
    said = summary(outs[0])["study"]["truncation"][0]
    cut = 0.5 * math.erfc((320 - 298) / 30 / math.sqrt(2))
    figure(abs(said["cut_off"] - cut), 4 * math.sqrt(cut * (1 - cut) / 4096),
           f"the mass that the constraint cuts off, {said['cut_off']:.3f}, off by")
    report(said["constraint"] == "T_melt > T_room" and said["runs_drawn_again"] > 20
           and "T_melt > T_room" in answer.said, "it is told, in the summary and on the terminal",
           answer)
    values = drawn(outs[0], MELT)
    lower = (298 - 320) / 30
    tail = math.exp(-lower ** 2 / 2) / math.sqrt(2 * math.pi) / (1 - cut)
    mean, spread = 320 + 30 * tail, 30 * math.sqrt(1 + lower * tail - tail ** 2)
    figure(abs(statistics.mean(values) - mean), 4 * spread / math.sqrt(len(values)),
           "mean of what is left, off the truncated normal's by, K")
    whole, _ = run(folder, "more", melt=law, runs=20)
    report(runs_of(whole) == rows[:20],
           "the first runs of a longer study are those of a shorter one")
    with open(os.path.join(whole, "study.log"), "rb") as file:
        lines = file.read().split(b"\n")
    with open(os.path.join(whole, "study.log"), "wb") as file:
        file.write(b"\n".join(lines[:-8]) + b"\n")
    before = table(whole)
    answer = gamut("run", os.path.join(folder, "more.yaml"), "-o", whole, "--resume")
    report(answer.code == 0 and table(whole) == before, "resumed: the same draws", answer)
    out, answer = run(folder, "plain", melt="{mean: 320 K, sd: 30 K}", runs=40)
    report(answer.code == 5 and "T_melt" in answer.said, "without truncate such runs fail", answer)


def constraint_with_others(folder):
    """Correlated parameters are drawn again together, and what is derived counts too."""
    out, answer = run(folder, "vector", melt="{mean: 320 K, sd: 30 K, truncate: true}",
                      a="{mean: 90 MPa, cv: 0.1}", runs=300, correlation=f"[[{MELT}, {A}, 0.8]]")
    melt, stress = drawn(out, MELT), drawn(out, A, "Pa")
    # the regression of one normal variable on the other is untouched by truncation of the other
    x = [(value - 320) / 30 for value in melt]
    y = [(value - 90e6) / 9e6 for value in stress]
    slope = statistics.covariance(x, y) / statistics.variance(x)
    figure(abs(slope - 0.8), 4 * 0.6 / math.sqrt(300 * statistics.variance(x)),
           "correlated: the slope of the other on it, off 0.8 by")
    report(answer.code == 0 and min(melt) > 298, "correlated: none against the constraint", answer)
    elastic = ("youngs_modulus: 124 GPa, "
               "poissons_ratio: {mean: 0.45, sd: 0.05, truncate: true}")
    answer = gamut("check", point(folder, "ratio", elastic=elastic))
    report(answer.code == 0 and "cut off by 'truncate'" in answer.said,
           "what a physical range cuts off is told", answer)
    gamma = "{distribution: gamma, mean: 300 K, cv: 30, truncate: true}"
    answer = gamut("check", point(folder, "nothing", melt=gamma))
    report(answer.code == 3 and "nothing is left to draw" in answer.said
           and "T_melt > T_room" in answer.said and "% of the draws" in answer.said,
           "nearly all against the constraint: exit 3, with the constraint and the mass", answer)


def correlation_of_one(folder):
    for sign in (1, -1):
        out, answer = run(folder, f"one{sign}", a="{mean: 90 MPa, cv: 0.1}",
                          b="{mean: 292 MPa, cv: 0.1}", correlation=f"[[{A}, {B}, {sign}]]")
        worst = max(abs((x - 90e6) / 9e6 - sign * (y - 292e6) / 29.2e6)
                    for x, y in zip(drawn(out, A, "Pa"), drawn(out, B, "Pa")))
        figure(worst, 1e-7, f"a correlation of {sign}: one variable, off by")


def one_run(folder):
    scene = point(folder, "off", a="{mean: 90 MPa, cv: 0.1}")
    answer = gamut("run", scene, "-o", os.path.join(folder, "off"), "--json", "--set",
                   "uncertainty.estimator=off")
    report(answer.code == 0 and "value" in answer.json()["quantities"]["s"]
           and "taken at its mean" in answer.said, "estimator off: one run at the means", answer)
    value = answer.json()["quantities"]["s"]["value"]
    out, answer = run(folder, "nominal", a="{mean: 90 MPa, cv: 0.1}")
    first = table(out)[0]
    report(first["run"] == "-1" and first["status"] == "nominal", "row -1 is the run at the means")
    figure(abs(float(first["s [Pa]"]) - value), 0, "it is that run, difference")
    figure(abs(summary(out)["quantities"]["s"]["mean"]
               / statistics.mean(column(table(out), "s [Pa]")) - 1), 1e-14,
           "it is in no statistic: mean of the others, off by")


def costs(folder):
    """What explain says of a study: its runs, their cost, what is drawn."""
    scene = point(folder, "costs", melt="{mean: 1083 degC, sd: 20 degC}", runs=5000)
    told = gamut("explain", scene, "--json").json()
    one, all_of_it = told["seconds"], told["study"]["seconds"]
    threads = told["study"]["threads"]
    report(told["study"]["runs"] == 5000 and told["study"]["nominal"], "explain counts the runs")
    figure(abs(all_of_it / (one * (math.ceil(5000 / threads) + 1)) - 1), 1e-9,
           "their time is that of one, by threads, off by")
    report(told["study"]["bytes"] >= threads * told["bytes"], "their memory grows with the threads")
    figure(abs(told["study"]["parameters"][0]["sd"] - 20), 1e-12, "the spread in K, off 20 by")
    answer = gamut("explain", scene)
    report("monte_carlo: 5000 runs and the run at the means" in answer.out
           and "standard deviation 20 K" in answer.out, "for people too", answer)
    sweep = gamut("explain", scene, "--json", "--set",
                  "uncertainty.estimator={model: sweep, over: {solver.steps: [4, 8, 16]}}").json()
    report(sweep["study"]["runs"] == 3 and not sweep["study"]["nominal"], "a sweep: its levels")


with tempfile.TemporaryDirectory() as scratch:
    costs(scratch)
    temperatures(scratch)
    constraint(scratch)
    constraint_with_others(scratch)
    correlation_of_one(scratch)
    one_run(scratch)
done()
