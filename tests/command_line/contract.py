"""The contract of the command line: exit codes, streams, JSON shapes, help texts."""
import math
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from tap import GAMUT, ROOT, done, figure, gamut, report  # noqa: E402

COMMANDS = ["run", "check", "explain", "eval", "list", "show", "verify", "new", "header", "schema",
            "plot"]
LINEAR = ["eval", "eos/linear", "--param", "bulk_modulus=1e10", "--at", "compression=0.1", "--at",
          "reference_density=7830"]
SCENE = """gamut: 1
title: one point under shear
solver: {model: material_driver, end: 1 ms, steps: 20, control: {xy: {velocity_gradient: 100 1/s}}}
materials:
  metal: {density: 8000 kg/m3, eos: {model: linear, bulk_modulus: 140 GPa},
          strength: {model: von_mises, yield_stress: 90 MPa, hardening_modulus: 300 MPa},
          elasticity: {model: hypoelastic, shear_modulus: 48 GPa}}
bodies:
  sample: {material: metal}
quantities:
  strain: {measure: plastic_strain, body: sample, reduce: at end}
  shear: {measure: stress_xy, body: sample, every: 0.1 ms}
"""


def help_texts():
    answer = gamut("--version")
    report(answer.code == 0 and answer.out.startswith("gamut ") and not answer.said, "--version",
           answer)
    answer = gamut("help")
    report(answer.code == 0 and all(f"  {name} " in answer.out for name in COMMANDS)
           and not answer.said, "help lists every command", answer)
    report(gamut("--help").out == answer.out, "--help says the same")
    for name in COMMANDS:
        after, before = gamut(name, "--help"), gamut("help", name)
        report(after.code == 0 and f"Usage: gamut {name}" in after.out and not after.said
               and after.out == before.out, f"{name} --help", after)


def usage():
    cases = [
        ([], "no command given"),
        (["verfy"], "did you mean 'verify'?"),
        (["help", "verfy"], "did you mean 'verify'?"),
        (["qqqqqqqq"], "unknown command 'qqqqqqqq'"),
        (["run"], "something is missing"),
        (["run", "a.yaml", "b.yaml"], "one argument too many: 'b.yaml'"),
        (["run", "a.yaml", "--threads", "0"], "--threads wants a positive whole number"),
        (["run", "a.yaml", "--threads", "two"], "--threads wants a positive whole number"),
        (["run", "a.yaml", "--threads"], "--threads wants a value"),
        (["run", "a.yaml", "--thread", "1"], "did you mean '--threads'?"),
        (["run", "a.yaml", "--set", "solver.cell"], "--set wants path=value"),
        (["run", "a.yaml", "--json=yes"], "--json takes no value"),
        (["check"], "something is missing"),
        (["explain"], "something is missing"),
        (["verify"], "verify wants a plugin"),
        (["verify", "--all", "eos/linear"], "not both"),
        (["new", "strength"], "a plugin is named KIND/NAME"),
        (["new", "strenth/mine"], "did you mean 'strength'?"),
        (["new", "strength/Mine"], "cannot be a plugin's name"),
        (["new", "strength/double"], "cannot be a plugin's name"),
        (["eval"], "something is missing"),
        (["eval", "eos/linear", "--param", "bulk_modulus"], "--param wants name=value"),
        (["eval", "eos/linear", "--param", "bulk_modulus=1e10,bulk_modulus=2e10"], "given twice"),
        (["eval", "eos/linear", "--param", "bulk_modulus=1e10", "--param", "K=2e10"],
         "'K' is given twice"),
        (LINEAR + ["compression=0.2"], "--at: 'compression' is given twice"),
        (["eval", "eos/linear", "--param", "bulk_modulos=1"], "did you mean 'bulk_modulus'?"),
        (["eval", "eos/linear", "--param", "bulk_modulus=1 kg"], "another dimension than Pa"),
        (["eval", "eos/linear", "--param", "bulk_modulus=39ab"], "is not a finite number"),
        (["eval", "eos/linear", "--param", "bulk_modulus=nan"], "is not a finite number"),
        (LINEAR[:-2], "needs --at reference_density"),
        (LINEAR + ["--at", "temperature=1"], "has no input 'temperature'"),
        (LINEAR + ["--at", "compression=0:1:x"], "a range is from:to:count"),
        (["eval", "elasticity/hypoelastic"], "material_driver"),
        (["eval", "effect/gravity"], "eval works on eos and strength"),
    ]
    for arguments, words in cases:
        answer = gamut(*arguments)
        report(answer.code == 2 and words in answer.said and not answer.out,
               "exit 2: gamut " + " ".join(arguments), answer)


def refusals():
    cases = [
        (4, ["eval", "eos/linaer"], "did you mean 'eos/linear'?"),
        (4, ["verify", "./there_is_none"], "there_is_none"),
        (4, ["show", "eos/linaer"], "eos/linear"),
        (3, ["eval", "eos/linear", "--at", "reference_density=1"], "bulk_modulus"),
        (3, ["eval", "eos/linear", "--param", "bulk_modulus=-1", "--at", "reference_density=1"],
         "bulk_modulus"),
        (3, ["check", "there_is_none.yaml"], "there_is_none.yaml"),
        (3, ["run", "there_is_none.yaml"], "there_is_none.yaml"),
        (3, ["explain", "there_is_none.yaml"], "there_is_none.yaml"),
    ]
    for code, arguments, words in cases:
        answer = gamut(*arguments)
        report(answer.code == code and words in answer.said and not answer.out,
               f"exit {code}: gamut " + " ".join(arguments), answer)


def relative(got, want):
    return math.inf if got is None else abs(got - want) / (abs(want) or 1)


def evaluate():
    answer = gamut(*LINEAR, "--derivatives", "--json")
    result = answer.json()
    point = (result or {}).get("points", [{}])[0]
    report(answer.code == 0 and result and result["plugin"] == "eos/linear"
           and len(result["points"]) == 1 and point["status"] == "ok" and not answer.said,
           "eval --json prints one object and nothing else", answer)
    report(point.get("inputs") == {"compression": 0.1, "reference_density": 7830.0},
           "eval --json says the inputs", answer)
    outputs = point.get("outputs", {})
    figure(relative(outputs.get("pressure"), 1e9), 1e-15, "pressure")
    figure(relative(outputs.get("sound_speed"), math.sqrt(1e10 / 7830)), 1e-15, "sound speed")
    first = point.get("derivatives", {}).get("pressure", {})
    figure(relative(first.get("bulk_modulus"), 0.1), 1e-12, "derivative by bulk modulus")
    second = point.get("second_derivatives", {}).get("pressure", {})
    figure(abs(second.get("bulk_modulus", {}).get("bulk_modulus", math.inf)), 1e-20,
           "second derivative by bulk modulus")
    same = gamut("eval", "eos/linear", "--param", "K=10 GPa", "--at",
                 "compression=0.1,reference_density=7.83 g/cm3", "--json").json()
    report(same and same["points"][0]["outputs"] == outputs,
           "symbols, units and commas give the same")
    same = gamut("eval", "eos/linear", "--at", "compression=0.1", "reference_density=7830",
                 "--param", "K=1e10", "--json").json()
    report(same and same["points"][0]["outputs"] == outputs, "several k=v after one option")
    given = gamut("eval", "eos/linear", "--param", "E=200e9,nu=0.3", "--at",
                  "compression=0.1,reference_density=7830", "--json", "--derivatives").json()
    point = given["points"][0] if given else {}
    figure(relative(point.get("outputs", {}).get("pressure"), 200e9 / 1.2 * 0.1), 1e-15,
           "pressure from Young's modulus and Poisson's ratio")
    first = point.get("derivatives", {}).get("pressure", {})
    figure(relative(first.get("youngs_modulus"), 0.1 / 1.2), 1e-10,
           "derivative by Young's modulus through the given set")


def curves_and_flags():
    answer = gamut("eval", "strength/von_mises", "--param", "yield_stress=90 MPa",
                   "hardening_modulus=300 MPa", "--at", "plastic_strain=0:1:11", "--json")
    points = (answer.json() or {"points": []})["points"]
    strains = [p["inputs"]["plastic_strain"] for p in points]
    report(answer.code == 0 and len(points) == 11 and strains[0] == 0 and strains[-1] == 1,
           "a range gives a curve with both ends", answer)
    worst = max((relative(p["outputs"]["flow_stress"], 90e6 + 300e6 * e)
                 for p, e in zip(points, strains)), default=math.inf)
    figure(worst, 1e-15, "flow stress along the curve")
    answer = gamut("eval", "strength/von_mises", "--param", "yield_stress=90 MPa", "--at",
                   "plastic_strain=0.1")
    report(answer.code == 0 and "hardening_modulus" in answer.out and "default" in answer.out
           and "flow_stress" in answer.out, "eval as text says which defaults were used", answer)
    answer = gamut("eval", "eos/mie_gruneisen", "--param", "C0=3940,S1=1.489,gamma0=2.02", "--at",
                   "compression=2.2,reference_density=8930", "--json")
    points = (answer.json() or {"points": [{}]})["points"]
    report(answer.code == 5 and points[0].get("status") == "beyond_pole"
           and points[0]["severity"] == "stop" and points[0]["outputs"]["pressure"] is None
           and "beyond_pole" in answer.said,
           "beyond the pole: status, null, exit 5", answer)


def runs(folder):
    scene = os.path.join(folder, "shear.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(SCENE)
    answer = gamut("check", scene)
    report(answer.code == 0 and answer.out and not answer.said, "check of a good scene", answer)
    answer = gamut("explain", scene)
    report(answer.code == 0 and "hypoelastic" in answer.out and not answer.said, "explain", answer)
    report(isinstance(gamut("explain", scene, "--json").json(), dict), "explain --json")
    report(os.listdir(folder) == ["shear.yaml"], "check and explain write nothing")
    answer = gamut("run", scene, "--json", cwd=folder)
    summary = answer.json()
    report(answer.code == 0 and summary and {"gamut", "scene", "solver", "seed", "plugins",
                                             "quantities", "ledger", "cost"} <= set(summary),
           "run --json prints the summary", answer)
    result = os.path.join(folder, "shear-results")
    names = set(os.listdir(result)) if os.path.isdir(result) else set()
    report({"results.h5", "results.xdmf", "history.csv", "summary.json", "scene.yaml"} <= names,
           "results stand in shear-results")
    quantities = (summary or {}).get("quantities", {})
    report("value" in quantities.get("strain", {}) and "unit" in quantities.get("strain", {})
           and len(quantities.get("shear", {}).get("times", [])) == 11,
           "scalars have value and unit, histories times and values")
    again = gamut("run", scene, cwd=folder)
    report(again.code == 7 and "shear-results" in again.said and not again.out,
           "exit 7: an existing result", again)
    forced = gamut("run", scene, "--force", cwd=folder)
    report(forced.code == 0 and "strain" in forced.out, "--force replaces it; a table is printed",
           forced)
    other = gamut("run", scene, "--set", "materials.metal.strength.yield_stress=180 MPa", "--json",
                  "-o", "other", cwd=folder).json()
    report(other and summary and other["quantities"]["shear"]["values"][-1]
           > quantities["shear"]["values"][-1], "--set reaches the law")
    bad = gamut("run", scene, "--set", "solver.stepss=3", "-o", "bad", cwd=folder)
    report(bad.code == 3 and not os.path.exists(os.path.join(folder, "bad")),
           "exit 3: a wrong --set, nothing written", bad)


def refused_late(folder):
    """Faults that show when a run begins: the right exit code, words, and nothing on the disk."""
    bar = os.path.join(ROOT, "inputs", "taylor_bar.yaml")
    for code, setting, words in (
            (3, "effects.wall.plane.normal=[0, -1]",
             "effect wall: body 'bar' reaches behind a plane"),
            (3, "effects.wall.plane.normal=[0, -1]", "\n(effects.wall)"),
            (3, "quantities.length.axis=z", "no axis z"),
            (3, "quantities.length.axis=z", "\n(quantities.length)"),
            (3, "effects.top={model: rigid_wall, plane: {point: [0 mm, 30.01 mm], "
             "normal: [0, -1]}}", "effect top: planes at y"),
            (3, "quantities.length.every=1e-15 s", "that makes 8e+10 samples"),
            (2, "solver.cell", "usage: gamut run SCENE"),
            (3, 'bodies.bar.velocity=["1 / (x - x)", "0"]', "the velocity of body 'bar'"),
            (3, 'bodies.bar.velocity=["", "0"]', "the formula is empty"),
            (3, "solver.cell=0.3 um", "more than 2e9 points"),
            (3, "effects.more={model: adiabatic_heating}", "both set temperature"),
            (2, "gamut=2", "belongs to a file"),
            (2, "include=[a.yaml]", "belongs to a file")):
        result = os.path.join(folder, "late")
        answer = gamut("run", bar, "-o", result, "--set", setting)
        report(answer.code == code and words in answer.said and not os.path.exists(result),
               f"{setting}: exit {code}, nothing written", answer)
    answer = gamut("run", bar, "-o", result, "--threads", "100000")
    report(answer.code == 2 and "at most" in answer.said, "too many threads: exit 2", answer)
    for setting, code, words in (("solver.step=1e-30 s", 3, "that makes 8e+25 steps"),
                                 ("bodies.bar.velocity=[0 m/s, -1e18 m/s]", 5, "would never end")):
        answer = gamut("run", bar, "-o", result, "--set", setting)
        same = gamut("check", bar, "--set", setting)
        report(answer.code == same.code == code and words in answer.said and words in same.said,
               f"{setting}, a step that gets nowhere: exit {code}, also from check", answer)
    answer = gamut("check", bar, "--set", "quantities.diameter_at_0.2L.height=0.3")
    report(answer.code == 0, "a name with a dot can be set", answer)


def interrupted(folder):
    """A run that is told to stop leaves its summary and a checkpoint."""
    result = os.path.join(folder, "cut")
    run = subprocess.Popen([GAMUT, "--no-user-plugins", "run", os.path.join(folder, "shear.yaml"),
                            "--set", "solver.steps=50000000", "-o", result], text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    end = time.time() + 60
    while not os.path.exists(os.path.join(result, "scene.yaml")) and time.time() < end:
        time.sleep(0.05)
    time.sleep(0.5)
    run.send_signal(signal.SIGTERM)
    try:
        run.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        run.kill()
        run.communicate()
    summary = os.path.join(result, "summary.json")
    text = open(summary, encoding="utf-8").read() if os.path.exists(summary) else ""
    report(run.returncode == 75 and '"interrupted"' in text,
           f"a TERM signal ends a run in order (ended with {run.returncode})")


def streams():
    full = subprocess.run(f"'{GAMUT}' help > /dev/full", shell=True, text=True, capture_output=True)
    report(full.returncode == 7 and "standard output" in full.stderr,
           f"exit 7: standard output is full (exit {full.returncode})")
    pipe = subprocess.run(f"'{GAMUT}' schema | head -c 10", shell=True, text=True,
                          capture_output=True)
    report(pipe.returncode == 0 and not pipe.stderr, "a reader that leaves is no error")
    german = subprocess.run([GAMUT, "--no-user-plugins", *LINEAR, "--json"], text=True,
                            capture_output=True, env={**os.environ, "LC_ALL": "de_DE.UTF-8"})
    report(german.stdout == gamut(*LINEAR, "--json").out, "numbers do not depend on the locale")


def verify():
    answer = gamut("verify", "eos/linear")
    lines = answer.out.splitlines()
    results = [line for line in lines if line.startswith(("ok ", "not ok "))]
    report(answer.code == 0 and lines[-1] == f"1..{len(results)}" and not answer.said,
           "verify prints TAP", answer)
    folder = gamut("verify", os.path.join(ROOT, "plugins/eos/linear/linear.yaml"))
    report(folder.code in (0, 4), "verify takes a YAML file", folder)


def main():
    help_texts()
    usage()
    refusals()
    evaluate()
    curves_and_flags()
    with tempfile.TemporaryDirectory() as folder:
        runs(folder)
        refused_late(folder)
        interrupted(folder)
    streams()
    verify()
    done()


if __name__ == "__main__":
    main()
