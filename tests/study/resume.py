"""A study that is killed, told to stop, damaged or changed, and what --resume makes of it."""
import os
import signal
import subprocess
import tempfile
import time

from scenes import PLATE, content, runs_of, write
from tap import GAMUT, done, gamut, report

RUNS = 40


def finished(out):
    """Numbers of the runs in the log, in its order; whole lines only."""
    try:
        lines = content(out, "study.log").split(b"\n")[:-1]
    except FileNotFoundError:
        return []
    return [int(line.split()[1]) for line in lines if line.startswith(b"run ")]


def stopped(scene, out, least, number, threads):
    """Runs until the log has some runs, then sends a signal."""
    child = subprocess.Popen([GAMUT, "--no-user-plugins", "run", scene, "-o", out, "--resume",
                              "--threads", threads], stdout=subprocess.DEVNULL,
                             stderr=subprocess.PIPE, text=True)
    end = time.time() + 120
    while len(finished(out)) < least and child.poll() is None and time.time() < end:
        time.sleep(0.005)
    child.send_signal(number)
    said = child.communicate()[1]
    return child.returncode, said


def same_tables(one, other):
    return all(content(one, name) == content(other, name) for name in ("study.csv", "history.csv"))


with tempfile.TemporaryDirectory() as scratch:
    scene = write(scratch, "plate.yaml", PLATE.replace("cell: 1 mm", "cell: 0.05 mm")
                  + f"uncertainty: {{estimator: {{model: monte_carlo, runs: {RUNS}}}}}\n")
    whole, out = os.path.join(scratch, "whole"), os.path.join(scratch, "cut")
    answer = gamut("run", scene, "-o", whole)
    report(answer.code == 0 and len(finished(whole)) == RUNS, "the study in one go", answer)

    code, _ = stopped(scene, out, 4, signal.SIGKILL, "2")
    killed = finished(out)
    report(code == -signal.SIGKILL and 4 <= len(killed) < RUNS,
           f"killed after {len(killed)} of {RUNS} runs")
    code, said = stopped(scene, out, len(killed) + 4, signal.SIGTERM, "1")
    told = finished(out)
    report(code == 75 and told[:len(killed)] == killed and len(told) < RUNS and "--resume" in said,
           f"told to stop after {len(told)} runs: exit {code}")
    answer = gamut("run", scene, "-o", out)
    report(answer.code == 7 and "--resume" in answer.said, "without --resume: exit 7", answer)
    answer = gamut("run", scene, "-o", out, "--resume", "--threads", "3")
    logged = finished(out)
    report(answer.code == 0 and logged[:len(told)] == told and sorted(logged) == list(range(RUNS)),
           "resumed to the end, no run made twice", answer)
    report(same_tables(whole, out), "the same tables, bit for bit")

    before = content(out, "study.log")
    answer = gamut("run", scene, "-o", out, "--resume")
    report(answer.code == 0 and content(out, "study.log") == before and same_tables(whole, out),
           "resumed when it is done: nothing is run", answer)

    for setting in ("uncertainty.seed=9", "materials.copper.eos.S1=1.5",
                    "uncertainty.estimator.runs=50"):
        answer = gamut("run", scene, "-o", out, "--resume", "--set", setting)
        report(answer.code == 7 and "is another than it was" in answer.said
               and content(out, "study.log") == before, f"not with {setting}: exit 7", answer)

    lines = before.split(b"\n")
    with open(os.path.join(out, "study.log"), "wb") as file:
        file.write(b"\n".join(lines[:-2]) + b"\n" + lines[-2][:40])
    answer = gamut("run", scene, "-o", out, "--resume")
    report(answer.code == 0 and len(finished(out)) == RUNS and same_tables(whole, out),
           "a last line that was cut off is made again", answer)
    with open(os.path.join(out, "study.log"), "wb") as file:
        file.write(before.replace(b" ok ", b" oj ", 1))
    answer = gamut("run", scene, "-o", out, "--resume")
    report(answer.code == 7 and "damaged" in answer.said, "a damaged line: exit 7", answer)
    answer = gamut("run", scene, "-o", out, "--force", "--set", "uncertainty.estimator.runs=2")
    report(answer.code == 0 and len(runs_of(out)) == 2, "--force begins anew", answer)

    scene = write(scratch, "fail.yaml", PLATE + """uncertainty:
  estimator: {model: sweep, over: {solver.step: [20 ns, 1 us]}}
  failures: 0.5
""")
    out = os.path.join(scratch, "fail")
    gamut("run", scene, "-o", out)
    gamut("run", scene, "-o", out, "--resume")
    kept = finished(out)
    answer = gamut("run", scene, "-o", out, "--retry-failed")
    report(answer.code == 0 and sorted(kept) == [0, 1] and finished(out) == kept + [1],
           "a failed run is kept by --resume and made again by --retry-failed", answer)
done()
