"""Laws that carry data: an eos tabulated from files, prepared once a binding and let go again."""
import csv
import json
import math
import os
import subprocess

import made
import scenes

RHO, C0, S1, GAMMA0 = 8930.0, 3940.0, 1.489, 2.0
BESIDE = os.path.join(scenes.SCRATCH, "scenes")
SCENE = """gamut: 1
solver: {{model: material_driver, end: 1 us, steps: 40, control: {{xx: {{log_strain: -0.2}}}}}}
materials:
  metal:
    density: 8930 kg/m3
    elasticity: {{model: hypoelastic, shear_modulus: 48 GPa}}
    eos: {{{eos}}}
bodies:
  point: {{material: metal}}
{more}
quantities:
  pressure: {{measure: pressure, every: 0.025 us}}
  stress: {{measure: stress_xx, reduce: at end}}
"""
ANALYTIC = f"model: mie_gruneisen, C0: {C0} m/s, S1: {S1}, gamma0: {GAMMA0}"
CURVE = f"model: tabulated, curve: {{file: curve.csv}}, gamma0: {GAMMA0}"
STUDY = "uncertainty: {estimator: {model: monte_carlo, runs: 3}, seed: 1}"


def reference(mu):
    """The pressure of eos/mie_gruneisen without energy."""
    stiff = RHO * C0 ** 2
    if mu <= 0:
        return stiff * mu
    return stiff * mu * (1 + (1 - GAMMA0 / 2) * mu) / (1 - (S1 - 1) * mu) ** 2


def write(name, text):
    with open(os.path.join(BESIDE, name), "w", encoding="utf-8") as file:
        file.write(text)


def rows(count):
    return [(mu, reference(mu)) for mu in (-0.1 + 0.5 * k / count for k in range(count + 1))]


def write_curve(count):
    write("curve.csv", "compression,pressure [GPa]\n"
          + "".join(f"{mu!r},{p / 1e9!r}\n" for mu, p in rows(count)))


def attempt(eos, more="", folder=None, changes=None):
    scene = scenes.written("tabulated", SCENE.format(eos=eos, more=more))
    return scenes.attempt(scene, changes, extra=("--plugin-path", folder or FOLDER))


def run(eos, more=""):
    process, folder = attempt(eos, more)
    if process.returncode:
        raise scenes.Failed(process.returncode, [process.stderr])
    return scenes.read(folder, process)


def converges():
    exact = run(ANALYTIC).history("pressure")[1]
    off = []
    for count in (20, 40, 80):
        write_curve(count)
        got = run(CURVE).history("pressure")[1]
        off.append(max(abs(a - b) for a, b in zip(got, exact)) / max(exact))
    scenes.note("pressures off eos/mie_gruneisen: " + ", ".join(f"{x:.3g}" for x in off))
    scenes.below("a run with 80 intervals against the law that they are of", off[2], 1e-4)
    order = math.log2(off[0] / off[2]) / 2
    scenes.report(order >= 1.8, f"order of the interpolation: {order:.3f} (at least 1.8, linear)")


def same_by_pairs():
    write_curve(40)
    write("pairs.txt", "".join(f"{mu!r} {p!r}\n" for mu, p in rows(40)))
    one = run(CURVE)
    other = run(f"model: tabulated, pairs: pairs.txt, gamma0: {GAMMA0}")
    off = max(abs(a - b) for a, b in zip(one.history("pressure")[1], other.history("pressure")[1]))
    scenes.below("a file that the plugin reads by itself gives the table's pressures",
                 off / max(other.history("pressure")[1]), 1e-14)


def random_numbers():
    """What is prepared of a random number is prepared in each run."""
    spread = ", stiffness: {distribution: uniform, lower: 0.5, upper: 2}"
    process, folder = attempt(CURVE + spread, STUDY)
    scenes.report(process.returncode == 0, "a study of a prepared number", [process.stderr])
    with open(os.path.join(folder, "study.csv"), encoding="utf-8") as file:
        done = [row for row in csv.DictReader(file) if row["status"] == "ok"]
    for row in done:
        stiffness = row["materials.metal.eos.stiffness"]
        alone = run(CURVE + f", stiffness: {stiffness}").value("stress")
        scenes.report(alone == float(row["stress [Pa]"]), f"stiffness {stiffness}: stress "
                      f"{row['stress [Pa]']}, of a run alone {alone!r} (the same bits)")
    scenes.report(len({row["stress [Pa]"] for row in done}) == 3, f"{len(done)} runs differ (3)")


def refused(eos, code, words, more="", folder=None):
    process, _ = attempt(eos, more, folder)
    scenes.report(process.returncode == code and all(w in process.stderr for w in words),
                  f"exit {process.returncode} ({code}), {words[-1]}", [process.stderr])


def wrong_tables():
    refused(CURVE.replace("curve.csv", "none.csv"), 3,
            ["tabulated.yaml:7:43", "No such file", "table file"])
    for lines, place, words in (
            (["0,0", "0.1,6"], "4:1", "the table 'curve' ends after 2 rows"),
            (["0,0", "0.1,six", "0.2,14"], "4:5", "'six' is no value of 'pressure'"),
            (["0,0", "0.1", "0.2,14"], "4:1", "1 cell where the first line names 2"),
            (["0,0", "", "0.1,6", "0.1,14"], "6:1", "the curve turns back")):
        write("wrong.csv", "\n".join(["compression,pressure [GPa]", "# by hand", *lines, ""]))
        refused(CURVE.replace("curve.csv", "wrong.csv"), 3,
                [f"{BESIDE}/wrong.csv:{place}", "(materials.metal.eos.curve", words])
    refused(f"model: tabulated, curve: [[0, 0 Pa], [1, 1 GPa]], gamma0: {GAMMA0}", 3,
            ["tabulated.yaml:7", "at least 3 rows", "the table 'curve' has 2 rows"])


def wrong_files():
    pairs = f"model: tabulated, pairs: FILE, gamma0: {GAMMA0}"
    refused(pairs.replace("FILE", "none.txt"), 3,
            ["tabulated.yaml:7:36", "(materials.metal.eos.pairs)", "No such file"])
    refused(pairs.replace("FILE", "."), 3, ["tabulated.yaml:7:36", "this is a folder, not a file"])
    refused(pairs.replace("FILE", "[a, b]"), 3, ["tabulated.yaml:7", "'pairs' names no file"])
    write("wrong.txt", "0 0\n0.1 6e9\n0.2 x\n")
    refused(pairs.replace("FILE", "wrong.txt"), 3,
            ["wrong.txt:3:1", "0.2 x", "(materials.metal.eos.pairs)", "no pair of numbers"])
    write("wrong.txt", "0 0\n0.1 6e9\n")
    refused(pairs.replace("FILE", "wrong.txt"), 3, ["wrong.txt:2:1", "the curve ends after 2"])
    refused(f"{CURVE}, pairs: pairs.txt", 3, ["'curve' and 'pairs' are both given"])


def wrong_numbers(source, described):
    """What is prepared once cannot differ from point to point, nor be what kernels see."""
    field = "{mean: 1, cv: 0.1, field: {model: white_noise}}"
    refused(f"{CURVE}, stiffness: {field}", 3, ["tabulated.yaml:7", "stiffness"])
    folder = variant("asking", source, described.replace(", prepared: true", ""))
    refused(CURVE, 4, ["the plugin with the values 'materials.metal.eos' asks for 'stiffness'",
                       "which its kernels see at each point"], folder=folder)


def variant(name, source, described):
    """The plugin from a changed source, in a folder of its own."""
    before, made.FOLDER = made.FOLDER, os.path.join(scenes.SCRATCH, name)
    try:
        return made.plugin("eos/tabulated", described, source)
    finally:
        made.FOLDER = before


def counts(said):
    lines = said.splitlines()
    return lines.count("prepared"), lines.count("released")


def released(source, described):
    source = source.replace("*out = data;", '(*out = data, fputs("prepared\\n", stderr));')
    source = source.replace("GAMUT_EOS(tabulated", """
static void counted(struct tabulated_data *data)
{
  fputs("released\\n", stderr);
  release(data);
}

GAMUT_EOS(tabulated""").replace(".release = release", ".release = counted")
    folder = variant("counted", source, described)
    write("short.csv", "compression,pressure [GPa]\n-0.1,-10\n0,0\n0.01,1\n")
    spread = ", stiffness: {distribution: uniform, lower: 0.5, upper: 2}"
    both = {"solver.control.xx": "{log_strain: -0.2, stress: 1 Pa}"}
    for name, eos, more, changes, code, due in (
            ("a run", CURVE, "", {}, 0, 1),
            ("a study of 3 runs and the run at the means", CURVE + spread, STUDY, {}, 0, 4),
            ("a run that stops beyond the table", CURVE.replace("curve.csv", "short.csv"), "", {},
             5, 1),
            ("a scene refused by its solver, when its laws are bound", CURVE, "", both, 3, 1)):
        process, _ = attempt(eos, more, folder, changes)
        found = counts(process.stderr)
        scenes.report(process.returncode == code and found == (due, due),
                      f"{name}: exit {process.returncode} ({code}), prepared and released "
                      f"{found} times ({due}, {due})", [process.stderr])
    done = subprocess.run([scenes.GAMUT, "eval", "eos/tabulated", "--json", "--plugin-path", folder,
                           "--param", f"curve={{file: {BESIDE}/curve.csv}},gamma0=2",
                           "--at", "compression=0.1,energy=0,reference_density=8930"],
                          capture_output=True, text=True, check=False)
    pressure = json.loads(done.stdout)["points"][0]["outputs"]["pressure"] if done.stdout else None
    scenes.report(counts(done.stderr) == (1, 1) and pressure == reference(0.1),
                  f"eval: {counts(done.stderr)} times (1, 1), pressure {pressure}", [done.stderr])


os.makedirs(BESIDE, exist_ok=True)
EFFECT = """plugin: effect/marked
version: "1.0"
summary: marks each point with the sum of a list
source: [by hand]
prepare: true
parameters:
  numbers: {type: list, of: {unit: 1}, doc: what is added up}
outputs: [{mark: {unit: 1, components: 1}}]
tasks:
  - {kernel: write, phase: after material, writes: [mark]}
"""
MARKS = r"""
#include <stdio.h>
#include <stdlib.h>
#include "marked.gamut.h"

struct marked_data { double sum; };

static gamut_status prepare(struct gamut_run *run, const struct gamut_values *values,
                            struct marked_data **data)
{
  char path[32];
  *data = calloc(1, sizeof **data);
  for (size_t k = 0; *data && k < gamut_entries(values, "numbers"); k++) {
    snprintf(path, sizeof path, "numbers.%zu", k);
    (*data)->sum += gamut_real(values, path);
  }
  return *data ? GAMUT_OK : gamut_fail(run, GAMUT_INTERNAL, "out of memory");
}

static void release(struct marked_data *data) { free(data); }

static void write(const struct marked *b)
{
  GAMUT_EACH (i, b)
    b->mark[i] = b->data->sum;
}

GAMUT_EFFECT(marked, .prepare = prepare, .release = release, .write = write)
"""


def of_effects():
    folder = made.plugin("effect/marked", EFFECT, MARKS)
    more = "effects: {marks: {model: marked, numbers: [1, 2.5, 4]}}"
    process, result = attempt(ANALYTIC, more, folder,
                              {"quantities.mark": "{measure: mark, reduce: at end}"})
    found = scenes.read(result, process).value("mark") if process.returncode == 0 else None
    scenes.report(found == 7.5, f"an effect's kernel finds what it prepared: {found} (7.5)",
                  [process.stderr])


FOLDER = made.of_tree("eos/tabulated")
HOME = os.path.join(scenes.TREE, "tests/plugins/eos/tabulated/tabulated")
made.verified("eos/tabulated")
converges()
same_by_pairs()
random_numbers()
wrong_tables()
wrong_files()
with open(HOME + ".c", encoding="utf-8") as code, open(HOME + ".yaml", encoding="utf-8") as words:
    SOURCE, DESCRIBED = code.read(), words.read()
wrong_numbers(SOURCE, DESCRIBED)
released(SOURCE, DESCRIBED)
of_effects()
scenes.done()
