"""Whose the folder of a result is: one process at a time writes there, and nothing is written
through links that somebody planted under the names of files to come. Prints TAP."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from same import GAMUT, INPUTS, differences, done, gamut, report, run

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../study"))
from scenes import PLATE, write  # noqa: E402

SCENE = os.path.join(INPUTS, "plate_impact.yaml")
SHOT = ["solver.cell=0.2 mm", "solver.end=1 us", "outputs={every: 0.1 us, fields: [stress]}"]
STUDY = PLATE + "uncertainty: {estimator: {model: monte_carlo, runs: 4}}\n"
PARTIAL = ("results.partial.h5", "checkpoint.partial.h5", "results.xdmf.partial",
           "history.csv.partial", "summary.json.partial", "scene.yaml.partial",
           "study.csv.partial", "study.log.partial")


def started(scene, out, settings, until):
    words = [w for s in settings for w in ("--set", s)]
    child = subprocess.Popen([GAMUT, "--no-user-plugins", "run", scene, "-o", out, "--threads", "1",
                              *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.time() + 60
    while not os.path.exists(os.path.join(out, until)) and time.time() < end:
        time.sleep(0.001)
    child.send_signal(signal.SIGSTOP)
    return child


def held(folder, name, scene, settings, until):
    """A run that sleeps in the middle of its work holds its folder; a killed one does not."""
    out, whole = os.path.join(folder, name), os.path.join(folder, name + "-whole")
    run(scene, whole, settings)
    child = started(scene, out, settings, until)
    for more in ((), ("--resume",), ("--force",)):
        answer = run(scene, out, settings, *more)
        report(answer.code == 7 and ("in use" in answer.said or not more),
               f"{name}: a second process {' '.join(more) or 'without a word'}: exit 7", answer)
    child.kill()
    child.wait()
    answer = run(scene, out, settings, "--resume")
    report(answer.code == 0, f"{name}: the folder of a killed one is free", answer)
    if name == "run":
        report(not differences(whole, out), "and the bits are the same")


def planted(folder, victim, names):
    os.makedirs(folder, exist_ok=True)
    for name in names:
        os.symlink(victim, os.path.join(folder, name))


def untouched(victim):
    with open(victim, encoding="utf-8") as file:
        return file.read() == "precious\n"


def links(folder):
    victim = os.path.join(folder, "victim")
    with open(victim, "w", encoding="utf-8") as file:
        file.write("precious\n")
    for name, scene, settings in (
            ("a run", SCENE, [*SHOT, "outputs.checkpoint={every: 0.4 us}"]),
            ("a study", write(folder, "study.yaml", STUDY), [])):
        out = os.path.join(folder, name)
        planted(out, victim, PARTIAL)
        answer = run(scene, out, settings)
        left = [n for n in os.listdir(out) if os.path.islink(os.path.join(out, n))]
        report(answer.code == 0 and untouched(victim) and not left,
               f"{name} writes through none of {len(PARTIAL)} links", answer)
    out = os.path.join(folder, "a run")
    for name in ("results.h5", "checkpoint.h5", "summary.json", "history.csv", "scene.yaml",
                 "results.xdmf", "study.log"):
        planted(os.path.join(folder, "named-" + name), victim, [name])
        answer = run(SCENE, os.path.join(folder, "named-" + name), SHOT)
        report(answer.code == 7 and untouched(victim), f"a link named {name}: exit 7", answer)
    pictures(folder, out, victim)
    target = os.path.join(folder, "schema")
    os.symlink(victim, target)
    answer = gamut("schema", "-o", target)
    report(answer.code == 7 and "link" in answer.said and untouched(victim),
           "schema -o to a link: exit 7", answer)
    os.remove(target)
    os.symlink(victim, target + ".partial")
    answer = gamut("schema", "-o", target)
    report(answer.code == 0 and untouched(victim) and os.path.getsize(target) > 1000,
           "schema -o beside a link: written", answer)
    os.symlink(victim, os.path.join(folder, "mine"))
    answer = gamut("new", "strength/mine", cwd=folder)
    report(answer.code == 7 and untouched(victim), "new to a link: exit 7", answer)


def pictures(folder, out, victim):
    if not shutil.which("gnuplot"):
        report(True, "pictures # SKIP no gnuplot")
        return
    gamut("plot", out)
    inside = os.path.join(out, "pictures")
    names = os.listdir(inside)
    for name in names:
        os.remove(os.path.join(inside, name))
    planted(inside, victim, [*names, "gnuplot.log"])
    answer = gamut("plot", out)
    report(answer.code == 0 and untouched(victim)
           and not any(os.path.islink(os.path.join(inside, name)) for name in names),
           f"plot writes through none of {len(names) + 1} links", answer)
    theirs = os.path.join(folder, "theirs")
    shutil.move(inside, theirs)
    os.symlink(theirs, inside)
    before = {name: os.stat(os.path.join(theirs, name)).st_mtime_ns for name in os.listdir(theirs)}
    answer = gamut("plot", out)
    same = before == {name: os.stat(os.path.join(theirs, name)).st_mtime_ns
                      for name in os.listdir(theirs)}
    report(answer.code == 7 and "link" in answer.said and same,
           "pictures/ is a link: exit 7", answer)
    answer = run(SCENE, out, SHOT, "--force")
    report(answer.code == 0 and sorted(os.listdir(theirs)) == sorted(before),
           "--force removes no pictures behind it", answer)


with tempfile.TemporaryDirectory() as scratch:
    held(scratch, "run", SCENE, [*SHOT, "solver.cell=0.05 mm"], "results.xdmf")
    held(scratch, "study", write(scratch, "plate.yaml", STUDY), ["solver.cell=0.2 mm"],
         "study.log")
    links(scratch)
done()
