"""Runs and studies that are killed (SIGKILL) at random moments and resumed, again and
again: always the same bits in the end. How many kills: the first argument, else eight. Prints
TAP."""
import os
import random
import subprocess
import sys
import tempfile
import time

from same import GAMUT, INPUTS, content, differences, done, report

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../study"))
from scenes import PLATE, write  # noqa: E402

KILLS_A_ROUND = 4
SHOT = ["solver.cell=0.635 mm", "solver.end=20 us", "outputs.every=1 us", *(
    f"quantities.{name}.every=0.5 us" for name in (
        "length", "wall_force", "kinetic_energy", "final_length", "foot_diameter",
        "diameter_at_0.2L"))]
STUDY = PLATE.replace("cell: 1 mm", "cell: 0.1 mm") + """uncertainty:
  estimator: {model: monte_carlo, runs: 12}
"""


def study_differences(one, other):
    return [name for name in ("study.csv", "history.csv")
            if content(one, name) != content(other, name)]


class Kind:
    """A scene, its result in one go, and how long that takes."""

    def __init__(self, name, scene, settings, differ, folder):
        self.name, self.scene, self.settings, self.differ = name, scene, settings, differ
        self.whole = os.path.join(folder, name + "-whole")
        began = time.time()
        code, said = self.call(self.whole, None)
        self.time = time.time() - began
        report(code == 0, f"{name} in one go, {self.time:.2f} s: {said[-200:] if code else ''}")

    def call(self, out, kill_after, *more):
        words = [GAMUT, "--no-user-plugins", "run", self.scene, "-o", out, "--threads", "1", *more]
        for setting in self.settings:
            words += ["--set", setting]
        child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                 text=True)
        try:
            said = child.communicate(timeout=kill_after)[1]
        except subprocess.TimeoutExpired:
            child.kill()
            said = child.communicate()[1]
        return child.returncode, said


def one_round(kind, number, folder):
    """Up to four kills; how many there were, and what is wrong in the end."""
    out, killed = os.path.join(folder, f"{kind.name}-{number}"), 0
    first = random.random() < 0.25  # of some rounds what is replaced is a whole result
    if first:
        kind.call(out, None, "--resume")
    for turn in range(KILLS_A_ROUND):
        more = "--force" if first and turn == 0 else "--resume"
        code, said = kind.call(out, random.uniform(0.0, 1.1 * kind.time), more)
        killed += code == -9
        if code not in (0, -9):
            return killed, [f"exit {code}: {said[-500:]}"]
    code, said = kind.call(out, None, "--resume")
    if code != 0:
        return killed, [f"exit {code}: {said[-500:]}"]
    return killed, kind.differ(kind.whole, out)


def main(wanted):
    random.seed(wanted)
    with tempfile.TemporaryDirectory() as scratch:
        bar = os.path.join(INPUTS, "taylor_bar.yaml")
        plate = write(scratch, "plate.yaml", STUDY)
        often = "outputs.checkpoint={every: 2 us}"
        kinds = [Kind("checkpoints", bar, [*SHOT, often], differences, scratch),
                 Kind("study", plate, [], study_differences, scratch),
                 Kind("none", bar, SHOT, differences, scratch)]
        killed = rounds = good = 0
        faults = []
        while killed < wanted and rounds < 3 * wanted:
            count, wrong = one_round(kinds[rounds % len(kinds)], rounds, scratch)
            rounds, killed, good = rounds + 1, killed + count, good + (not wrong)
            faults += [f"{kinds[(rounds - 1) % len(kinds)].name}: {w}" for w in wrong]
        for fault in faults[:20]:
            print("#   " + fault.replace("\n", "\n#   "))
        report(killed >= wanted and good == rounds,
               f"{killed} kills (wanted {wanted}) in {rounds} rounds, the same bits in {good} of "
               f"{rounds}")
    done()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
