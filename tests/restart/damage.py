"""Results and checkpoints with a byte changed, of another run, removed or replaced while a run
writes: --resume refuses with exit 7 and what to do, or gives the same bits. How many places of each
file: the first argument, else 4. Prints TAP."""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from same import GAMUT, INPUTS, content, differences, done, forget_the_end, gamut, report, run

SCENE = os.path.join(INPUTS, "plate_impact.yaml")
SHOT = ["solver.cell=0.2 mm", "solver.end=1 us",
        "outputs={every: 0.1 us, fields: [stress, velocity]}"]
OFTEN = "outputs.checkpoint={every: 0.55 us}"


class Ended:
    def __init__(self, code, said):
        self.code, self.out, self.said = code, "", said


def end_in_order(out):
    """Leaves a result as one that was stopped."""
    with open(os.path.join(out, "summary.json"), "w", encoding="utf-8") as file:
        json.dump({"status": "interrupted"}, file)


def flipped(folder, whole, cut, name, places):
    """A byte changed at so many places of a file."""
    size, same, refused, wrong = len(content(cut, name)), 0, 0, []
    for place in range(places):
        out = os.path.join(folder, "flipped")
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(cut, out)
        at = (2 * place + 1) * size // (2 * places)
        with open(os.path.join(out, name), "r+b") as file:
            file.seek(at)
            byte = file.read(1)[0]
            file.seek(at)
            file.write(bytes([byte ^ (1 << place % 8)]))
        answer = run(SCENE, out, SHOT, "--resume")
        if answer.code == 7 and ("--force" in answer.said or "another folder" in answer.said):
            refused += 1
        elif answer.code == 0 and not differences(whole, out):
            same += 1
        else:
            wrong.append(f"byte {at}: exit {answer.code} {answer.said[-300:]}")
    for line in wrong[:5]:
        print("# " + line.replace("\n", "\n# "))
    report(not wrong, f"{name}, a byte changed at {places} places: refused {refused}, the same "
           f"bits {same}, wrong {len(wrong)} (allowed 0)")


def seen_by_plot(folder, whole):
    """A frame that is damaged is not drawn."""
    out, wrong, refused = os.path.join(folder, "seen"), [], 0
    size = len(content(whole, "results.h5"))
    for place in range(3):
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(whole, out)
        with open(os.path.join(out, "results.h5"), "r+b") as file:
            file.seek(size // 3 + place * size // 5)
            file.write(bytes(64 * [0x41 + place]))
        codes = {gamut("plot", out, "--frame", str(frame)).code for frame in range(8)}
        refused += 7 in codes
        wrong += [str(codes)] if not codes <= {0, 7} else []
    report(refused >= 1 and not wrong, f"plot refuses damaged frames: in {refused} of 3 {wrong}")


def another(folder, whole, cut):
    """Results of another scene, and of another run of the same scene."""
    for name, settings in (("another scene", ["bodies.flyer.velocity=[400 m/s]"]),
                           ("another run of it", [])):
        other, out = os.path.join(folder, name), os.path.join(folder, name + "-in")
        run(SCENE, other, [*SHOT, *settings])
        shutil.copytree(cut, out)
        shutil.copy(os.path.join(other, "results.h5"), os.path.join(out, "results.h5"))
        answer = run(SCENE, out, SHOT, "--resume")
        report(answer.code == 7 and "another run" in answer.said, f"results of {name}: exit 7",
               answer)
        os.remove(os.path.join(out, "results.h5"))
        answer = run(SCENE, out, SHOT, "--resume")
        report(answer.code == 7 and "missing" in answer.said,
               "results that are gone: exit 7", answer)
        answer = run(SCENE, out, SHOT, "--force")
        report(answer.code == 0 and not differences(whole, out), "and --force is the way out",
               answer)


def killed(folder, whole, cut):
    """Broken results of a run that did not end in order: it was cut off while it wrote."""
    out = os.path.join(folder, "killed")
    shutil.copytree(cut, out)
    os.remove(os.path.join(out, "summary.json"))
    with open(os.path.join(out, "results.h5"), "r+b") as file:
        file.truncate(len(content(cut, "results.h5")) // 2)
    answer = run(SCENE, out, SHOT, "--resume")
    report(answer.code == 0 and "anew" in answer.said and not differences(whole, out),
           "results that a kill broke: begun anew, said so, the same bits", answer)


def meanwhile(folder, name, change):
    """Starts a run and, once there are frames, does something to its folder."""
    out = os.path.join(folder, "meanwhile-" + name.replace(" ", "-"))
    child = subprocess.Popen([GAMUT, "--no-user-plugins", "run", SCENE, "-o", out, "--threads", "1",
                              *(w for s in [*SHOT, "solver.cell=0.01 mm"] for w in ("--set", s))],
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    end = time.time() + 60
    while not os.path.exists(os.path.join(out, "results.xdmf")) and time.time() < end:
        time.sleep(0.001)
    child.send_signal(signal.SIGSTOP)
    change(out)
    child.send_signal(signal.SIGCONT)
    said = child.communicate()[1]
    report(child.returncode == 7, f"{name} while the run writes: exit 7 (exit {child.returncode})",
           Ended(child.returncode, said))


def main(places):
    with tempfile.TemporaryDirectory() as scratch:
        whole, cut = os.path.join(scratch, "whole"), os.path.join(scratch, "cut")
        report(run(SCENE, whole, SHOT).code == 0 and run(SCENE, cut, [*SHOT, OFTEN]).code == 0,
               "two runs")
        forget_the_end(cut)
        end_in_order(cut)
        flipped(scratch, whole, cut, "results.h5", places)
        flipped(scratch, whole, cut, "checkpoint.h5", places)
        if shutil.which("gnuplot"):
            seen_by_plot(scratch, whole)
        another(scratch, whole, cut)
        killed(scratch, whole, cut)
        other = os.path.join(whole, "results.h5")
        meanwhile(scratch, "results.h5 removed",
                  lambda out: os.remove(os.path.join(out, "results.h5")))
        meanwhile(scratch, "results.h5 replaced", lambda out: (
            shutil.copy(other, out + ".h5"),
            os.rename(out + ".h5", os.path.join(out, "results.h5"))))
        meanwhile(scratch, "the folder removed", shutil.rmtree)
        meanwhile(scratch, "the folder moved", lambda out: os.rename(out, out + "-elsewhere"))
    done()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4)
