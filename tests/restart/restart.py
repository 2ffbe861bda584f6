"""A run that is stopped, killed, whose checkpoint is damaged, whose scene or plugin is another one,
and what --resume makes of it. Prints TAP."""
import os
import shutil
import signal
import subprocess
import tempfile
import time

from same import (GAMUT, INPUTS, checkpoint_step, content, differences, done, forget_the_end, gamut,
                  report, run, steps)

SCENE = os.path.join(INPUTS, "taylor_bar.yaml")
# Samples of histories that are not told how often are a share of the end.
SHOT = ["solver.cell=0.635 mm", "solver.end=20 us", *(
    f"quantities.{name}.every=0.5 us" for name in (
        "length", "wall_force", "kinetic_energy", "final_length", "foot_diameter",
        "diameter_at_0.2L"))]
OFTEN = "outputs.checkpoint={every: 6 us}"


def interrupted(out, number, until):
    """Runs or resumes until a file of the result is new, then sends a signal."""
    words = [GAMUT, "--no-user-plugins", "run", SCENE, "-o", out, "--threads", "1", "--resume",
             "--set", "outputs.checkpoint={every: 1 us}"]
    for setting in SHOT:
        words += ["--set", setting]
    path = os.path.join(out, until)
    began = os.stat(path).st_mtime_ns if os.path.exists(path) else 0
    child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
    end = time.time() + 60
    while child.poll() is None and time.time() < end:
        if os.path.exists(path) and os.stat(path).st_mtime_ns > began:
            break
        time.sleep(0.001)
    child.send_signal(number)
    said = child.communicate()[1]
    return child.returncode, said


def stopped(folder, whole):
    out = os.path.join(folder, "term")
    code, said = interrupted(out, signal.SIGTERM, "checkpoint.h5")
    report(code == 75 and "--resume" in said and b'"interrupted"' in content(out, "summary.json")
           and "no result in" in said,
           f"TERM: exit 75 (exit {code}) and a word how to go on; --resume of nothing begins anew")
    for number in (signal.SIGINT, signal.SIGHUP):
        code, said = interrupted(out, number, "checkpoint.h5")
        report(code == 75, f"{number.name}: the same (exit {code})")
    answer = run(SCENE, out, SHOT, "--resume", threads=2)
    wrong = differences(whole, out)
    report(answer.code == 0 and not wrong,
           f"stopped three times and resumed: the same bits {wrong[:5]}", answer)
    answer = run(SCENE, out, SHOT, "--resume", "--json")
    report(answer.code == 0 and "nothing to do" in answer.said and answer.json()
           and not differences(whole, out), "resumed at its end: nothing to do, exit 0", answer)


def killed(folder, whole):
    out = os.path.join(folder, "kill")
    code, _ = interrupted(out, signal.SIGKILL, "checkpoint.previous.h5")
    at, total = checkpoint_step(out), steps(whole)
    answer = run(SCENE, out, SHOT, "--resume")
    wrong = differences(whole, out) if answer.code == 0 else ["it failed"]
    report(code == -signal.SIGKILL and at < total and not wrong,
           f"killed after the checkpoint at step {at} of {total}: the same bits {wrong[:5]}",
           answer)


def damaged(folder, whole, cut):
    for what in ("one bit", "its end"):
        out = os.path.join(folder, "damaged")
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(cut, out)
        path = os.path.join(out, "checkpoint.h5")
        bytes_ = bytearray(content(out, "checkpoint.h5"))
        if what == "one bit":
            bytes_[len(bytes_) // 2] ^= 16
        else:
            del bytes_[len(bytes_) // 2:]
        with open(path, "wb") as file:
            file.write(bytes_)
        answer = run(SCENE, out, SHOT, "--resume")
        report(answer.code == 0 and "broken" in answer.said and "before it" in answer.said
               and not differences(whole, out),
               f"a checkpoint that lacks {what}: the one before it, said so, the same bits", answer)
    forget_the_end(out)
    for name in ("checkpoint.h5", "checkpoint.previous.h5"):
        with open(os.path.join(out, name), "wb") as file:
            file.write(b"nothing of use")
    answer = run(SCENE, out, SHOT, "--resume")
    report(answer.code == 7 and "no checkpoint can be read" in answer.said,
           "both broken: exit 7", answer)


def refused(folder, whole, cut):
    out = os.path.join(folder, "refused")
    shutil.copytree(cut, out)
    cases = [("solver.courant=0.2", "solver.courant", 3), ("solver.cell=0.6 mm", "solver.cell", 3),
             ("materials.copper.strength.A=91 MPa", "materials.copper.strength.A", 3),
             ("effects.wall.friction=0.1", "effects.wall.friction", 3),
             ("solver.end=1 us", "solver.end", 3)]
    for setting, name, code in cases:
        answer = run(SCENE, out, [*SHOT, setting], "--resume")
        report(answer.code == code and name in answer.said, f"{setting}: refused by name", answer)
    answer = run(SCENE, out, SHOT, "--resume", "--force")
    report(answer.code == 2, "--resume with --force: exit 2", answer)
    for name in ("checkpoint.h5", "checkpoint.previous.h5"):
        os.remove(os.path.join(out, name))
    with open(os.path.join(out, "summary.json"), "w", encoding="utf-8") as file:
        file.write('{"status": "interrupted"}')
    answer = run(SCENE, out, SHOT, "--resume")
    report(answer.code == 7 and "no checkpoint" in answer.said,
           "a result that ended in order and has no checkpoint: exit 7", answer)
    answer = run(SCENE, out, SHOT)
    report(answer.code == 7 and "--resume" in answer.said, "no --resume: exit 7, says so", answer)
    os.remove(os.path.join(out, "summary.json"))
    answer = run(SCENE, out, [*SHOT, "solver.courant=0.2"], "--resume")
    report(answer.code == 3 and "solver.courant" in answer.said,
           "one killed before its first checkpoint, another scene: refused by name", answer)
    answer = run(SCENE, out, SHOT, "--resume")
    report(answer.code == 0 and "begins anew" in answer.said and not differences(whole, out),
           "the same scene: begun anew, said so, the same bits", answer)


def another_plugin(folder, cut):
    """The same strength with another version, found first."""
    plugins = os.path.join(folder, "plugins")
    os.makedirs(plugins)
    source = os.path.join(os.path.dirname(INPUTS), "plugins/strength/johnson_cook")
    objects = os.path.join(os.path.dirname(GAMUT), "plugins/strength/johnson_cook")
    shutil.copytree(source, os.path.join(plugins, "strength/johnson_cook"))
    for name in os.listdir(objects):
        if ".so" in name:
            shutil.copy(os.path.join(objects, name), os.path.join(plugins, "strength/johnson_cook"))
    path = os.path.join(plugins, "strength/johnson_cook/johnson_cook.yaml")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace('version: "', 'version: "99.', 1))
    words = []
    for setting in SHOT:
        words += ["--set", setting]
    answer = gamut("--plugin-path", plugins, "run", SCENE, "-o", cut, *words, "--resume")
    report(answer.code == 4 and "strength/johnson_cook" in answer.said and "99." in answer.said,
           "a plugin of another version: exit 4, by name", answer)


def longer(folder, cut):
    """Another end, other frames; then the end again."""
    out, whole = os.path.join(folder, "longer"), os.path.join(folder, "longer-whole")
    shutil.copytree(cut, out)
    more = [*SHOT, "solver.end=25 us", "outputs.every=2 us"]
    answer = run(SCENE, out, more, "--resume")
    report(answer.code == 0 and run(SCENE, whole, more).code == 0
           and content(out, "history.csv") == content(whole, "history.csv"),
           "a later end and more frames: histories as in one go", answer)
    answer = run(SCENE, out, more, "--resume")
    report(answer.code == 0 and "nothing to do" in answer.said, "and then nothing to do", answer)


def effects(folder):
    """Walls that move and rub, and forces on points, keep a state of their own in the solver."""
    for number, more in enumerate((
            ["effects.wall.velocity=[0 m/s, 20 m/s]", "effects.wall.friction=0.3"],
            ["effects.wall.velocity=[0 m/s, 20 m/s]", "solver.shape=linear"],
            ["effects.pull={model: gravity, acceleration: [0 m/s2, -1e6 m/s2]}"])):
        one, two = (os.path.join(folder, f"effects-{number}-{name}") for name in ("whole", "cut"))
        settings = [*SHOT, *more]
        good = run(SCENE, one, settings).code == 0
        good &= run(SCENE, two, [*settings, "outputs.checkpoint={every: 11 us}"]).code == 0
        if good:
            forget_the_end(two)
        answer = run(SCENE, two, settings, "--resume", threads=2)
        wrong = differences(one, two) if answer.code == 0 else ["it failed"]
        report(good and not wrong, f"{', '.join(more)}: the same bits {wrong[:5]}", answer)


with tempfile.TemporaryDirectory() as scratch:
    whole, cut = os.path.join(scratch, "whole"), os.path.join(scratch, "cut")
    answer = run(SCENE, whole, SHOT)
    report(answer.code == 0 and not os.path.exists(os.path.join(whole, "checkpoint.h5")),
           "a run leaves no checkpoint unless it is asked to", answer)
    answer = run(SCENE, cut, [*SHOT, OFTEN])
    report(answer.code == 0 and not differences(whole, cut), "checkpoints change no bit", answer)
    longer(scratch, cut)
    forget_the_end(cut)
    effects(scratch)
    stopped(scratch, whole)
    killed(scratch, whole)
    damaged(scratch, whole, cut)
    refused(scratch, whole, cut)
    another_plugin(scratch, cut)
    answer = run(SCENE, cut, [*SHOT, OFTEN], "--force")
    report(answer.code == 0, "--force replaces a result with its checkpoints", answer)
done()
