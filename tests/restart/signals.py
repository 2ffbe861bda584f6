"""Signals by which batch systems end a job, and disks that are full: a checkpoint and exit 75, or
exit 7 with results that can be read; --resume then gives the same bits. Prints TAP."""
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import time
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import needs  # noqa: E402

needs.modules("h5py", "numpy")
import h5py  # noqa: E402

from same import GAMUT, INPUTS, checkpoint_step, differences, done, report, run

SCENE = os.path.join(INPUTS, "taylor_bar.yaml")
SHOT = ["solver.cell=0.635 mm", "solver.end=20 us", *(
    f"quantities.{name}.every=0.5 us" for name in (
        "length", "wall_force", "kinetic_energy", "final_length", "foot_diameter",
        "diameter_at_0.2L"))]
STOPPING = ("SIGUSR1", "SIGUSR2", "SIGXCPU", "SIGHUP", "SIGTERM", "SIGINT")


class Ended:
    def __init__(self, code, said):
        self.code, self.out, self.said = code, "", said


def words(out, *more, settings=()):
    command = [GAMUT, "--no-user-plugins", "run", SCENE, "-o", out, "--threads", "1", *more]
    for setting in (*SHOT, *settings):
        command += ["--set", setting]
    return command


def signalled(out, number, times):
    """Runs until there is a checkpoint, then sends a signal so many times."""
    child = subprocess.Popen(words(out, "--resume", settings=["outputs.checkpoint={every: 1 us}"]),
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
    path, end = os.path.join(out, "checkpoint.h5"), time.time() + 60
    began = os.stat(path).st_mtime_ns if os.path.exists(path) else 0
    while child.poll() is None and time.time() < end:
        if os.path.exists(path) and os.stat(path).st_mtime_ns > began:
            break
        time.sleep(0.001)
    for _ in range(times):
        child.send_signal(number)
    said = child.communicate()[1]
    return Ended(child.returncode, said)


def batch_signals(folder, whole):
    out = os.path.join(folder, "batch")
    for name in STOPPING:
        number = getattr(signal, name)
        answer = signalled(out, number, 2 if name in STOPPING[:3] else 1)
        report(answer.code == 75 and "--resume" in answer.said,
               f"{name}: exit 75 (exit {answer.code}), step {checkpoint_step(out)}", answer)
    answer = run(SCENE, out, SHOT, "--resume")
    wrong = differences(whole, out)
    report(answer.code == 0 and not wrong,
           f"stopped {len(STOPPING)} times and resumed: the same bits {wrong[:5]}", answer)


def readable(out):
    """Frames of results.h5, each read to its end; -1 where there is no such file."""
    try:
        with h5py.File(os.path.join(out, "results.h5"), "r") as file:
            for frame in file["frames"].values():
                for body in frame.values():
                    for data in body.values():
                        data[()]
            return len(file["frames"])
    except FileNotFoundError:
        return -1


def limited(out, limit, *more, settings=()):
    def lower():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    ended = subprocess.run(words(out, *more, settings=settings), check=False, text=True,
                           capture_output=True, preexec_fn=lower)
    return Ended(ended.returncode, ended.stderr)


def full(folder, whole):
    """Files that may not grow, which stands for a full disk: in results, checkpoint and tables."""
    cases = {"results.h5": (300_000, ["outputs.every=0.1 us"]),
             "the first checkpoint": (450_000, ["outputs.every=100 us",
                                                "outputs.checkpoint={every: 1 us}"]),
             "anything": (0, []), "the scene": (1000, []), "the start": (9000, [])}
    for number, (what, (limit, settings)) in enumerate(cases.items()):
        out = os.path.join(folder, f"full-{number}")
        answer = limited(out, limit, settings=settings)
        frames = readable(out)
        report(answer.code == 7 and "File too large" in answer.said,
               f"no room for {what}: exit 7 (exit {answer.code}), {frames} frames can be read",
               answer)
        answer = run(SCENE, out, SHOT, "--resume")
        wrong = differences(whole, out) if answer.code == 0 else ["it failed"]
        report(answer.code == 0 and not wrong, f"and with room again: the same bits {wrong[:5]}",
               answer)


def small_disk(folder, whole):
    """A disk of 700 kB, where one may be mounted."""
    disk = os.path.join(folder, "disk")
    os.mkdir(disk)
    made = shutil.which("mount") and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=700k", "none", disk], check=False,
        capture_output=True).returncode == 0
    if not made:
        report(True, "a full disk # SKIP no disk can be mounted here")
        return
    try:
        out = os.path.join(disk, "out")
        answer = run(SCENE, out, [*SHOT, "outputs.every=0.5 us"])
        frames = readable(out)
        report(answer.code == 7 and "No space left" in answer.said and frames > 0,
               f"a full disk: exit 7 (exit {answer.code}), {frames} frames can be read", answer)
        kept = os.path.join(folder, "kept")
        shutil.copytree(out, kept)
    finally:
        subprocess.run(["umount", disk], check=False)
    answer = run(SCENE, kept, SHOT, "--resume")
    wrong = differences(whole, kept) if answer.code == 0 else ["it failed"]
    report(answer.code == 0 and not wrong, f"and elsewhere: the same bits {wrong[:5]}", answer)


with tempfile.TemporaryDirectory() as scratch:
    whole = os.path.join(scratch, "whole")
    report(run(SCENE, whole, SHOT).code == 0, "the run in one go")
    batch_signals(scratch, whole)
    full(scratch, whole)
    small_disk(scratch, whole)
done()
