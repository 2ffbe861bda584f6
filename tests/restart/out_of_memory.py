"""Allocations that fail, one alone and all from one on: each command ends in order, with a message,
and what a run had written can be read; where it goes on, its results are the whole ones. How many
places of each command and way: the first argument, else few. Prints TAP."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

from same import GAMUT, HERE, INPUTS, content, done, report, tables

sys.path.insert(0, os.path.join(HERE, "../bad_plugins"))
sys.path.insert(0, os.path.join(HERE, "../study"))
from kernels import sanitized  # noqa: E402
from scenes import PLATE, write  # noqa: E402

FAILED = {1, 3, 4, 5, 7}
BEFORE_THE_SCENE, AFTERWARDS = 68500, 50000
CRASHED = ("SIG", "terminate called", "Assertion", "corrupt", "free(): ")
SHOT = ["solver.cell=0.635 mm", "solver.end=3 us", "outputs.every=1 us"]
STUDY = PLATE.replace("cell: 1 mm", "cell: 0.2 mm") + """uncertainty:
  estimator: {model: monte_carlo, runs: 3}
"""


def skip(why):
    print(f"1..0 # SKIP {why}")
    sys.exit(77)


def build_shim(folder):
    shim = os.path.join(folder, "allocation_shim.so")
    words = [*os.environ.get("CC", "cc").split(), "-shared", "-fPIC", "-O1", "-o", shim,
             os.path.join(HERE, "allocation_shim.c")]
    if not shutil.which(words[0]) or subprocess.run(words, capture_output=True).returncode != 0:
        skip("the shim cannot be built")
    return shim


class Case:
    """A command, what it gives with all the memory it wants, and how often it asks for some."""

    def __init__(self, name, words, shim, folder, writes=(), flushes=False):
        self.name, self.words, self.shim, self.writes = name, words, shim, writes
        self.flushes = flushes
        self.folder = os.path.join(folder, name.replace(" ", "_"))
        self.counted = os.path.join(folder, "count")
        answer = self.call(0, False)
        self.said, self.whole = answer.stdout, self.written()
        with open(self.counted, encoding="ascii") as file:
            self.allocations = int(file.read())
        least = 20 if flushes else 100
        report(answer.returncode == 0 and self.allocations >= least,
               f"{name}: {self.allocations} allocations (at least {least})")

    def call(self, at, on):
        shutil.rmtree(self.folder, ignore_errors=True)
        os.mkdir(self.folder)
        given = dict(os.environ, LD_PRELOAD=self.shim, GAMUT_FAIL_AT=str(at),
                     GAMUT_FAIL_COUNT=self.counted, OMP_NUM_THREADS="1")
        if on:
            given["GAMUT_FAIL_ON"] = "1"
        if self.flushes:
            given["GAMUT_FAIL_IN_FLUSH"] = "1"
        return subprocess.run([GAMUT, "--no-user-plugins", *self.words], env=given, text=True,
                              cwd=self.folder, timeout=120, stdin=subprocess.DEVNULL,
                              capture_output=True, errors="replace")

    def places(self, count):
        """A quarter while plugins and units are read, as for every command, the rest later; of
        those in a flush four times as many."""
        if self.flushes:
            return range(1, self.allocations + 1, max(1, self.allocations // (4 * count)))
        begin = min(BEFORE_THE_SCENE, self.allocations // 2)
        first, rest = max(1, count // 4), max(1, count - count // 4)
        last = min(self.allocations, begin + AFTERWARDS)
        return sorted({1 + begin * k // first for k in range(first)} |
                      {begin + 1 + (last - begin - 1) * k // rest for k in range(rest)})

    def written(self):
        return [content(os.path.join(self.folder, "out"), name) for name in self.writes]

    def unreadable(self):
        """What of the results so far cannot be read; a folder without any is none."""
        out = os.path.join(self.folder, "out")
        try:
            if os.path.exists(os.path.join(out, "results.h5")):
                tables(out)
            if os.path.exists(os.path.join(out, "summary.json")):
                json.loads(content(out, "summary.json"))
        except (OSError, ValueError, RuntimeError, KeyError) as fault:
            return f"unreadable: {fault}"
        return ""

    def wrong(self, at, on):
        """What is not in order when this allocation fails; empty if nothing."""
        try:
            answer = self.call(at, on)
        except subprocess.TimeoutExpired:
            return "does not end"
        said = answer.stderr
        if answer.returncode < 0 or any(word in said for word in CRASHED):
            return f"crashed, exit {answer.returncode}: {said[-200:]}"
        if answer.returncode == 0:
            same = self.writes and self.written() == self.whole
            return "" if same or (not self.writes and answer.stdout == self.said) else \
                "exit 0 with other results"
        if answer.returncode not in FAILED or not said.strip():
            return f"exit {answer.returncode}: {said[-200:] or 'no message'}"
        return self.unreadable()


def cases(shim, folder):
    bar = os.path.join(INPUTS, "taylor_bar.yaml")
    shot = [word for setting in SHOT for word in ("--set", setting)]
    plate = write(folder, "plate.yaml", STUDY)
    run = ["run", "-o", "out", "--threads", "1"]
    often = [*run, bar, *shot, "--set", "outputs.checkpoint={every: 2 us}"]
    yield Case("run, as a frame is flushed", [*run, bar, *shot], shim, folder,
               ("history.csv", "results.xdmf"), flushes=True)
    yield Case("run", often, shim, folder, ("history.csv", "results.xdmf"))
    kept = os.path.join(folder, "kept")
    shutil.move(os.path.join(folder, "run", "out"), kept)
    yield Case("study", [*run, plate], shim, folder, ("study.csv", "history.csv"))
    yield Case("check", ["check", bar], shim, folder)
    yield Case("eval", ["eval", "strength/johnson_cook", "--derivatives", "--at",
                        "plastic_strain=0:0.3:4,plastic_strain_rate=1000", "--param",
                        "A=90 MPa,B=292 MPa,n=0.31,C=0.025,m=1.09,reference_rate=1 Hz,T_room=298 K,"
                        "T_melt=1356 K"], shim, folder)
    yield Case("explain", ["explain", bar], shim, folder)
    yield Case("plot", ["plot", kept], shim, folder)


def main(places):
    if sanitized():
        skip("sanitizers have an allocator of their own")
    with tempfile.TemporaryDirectory() as folder:
        shim = build_shim(folder)
        for case in list(cases(shim, folder)):
            for on in False, True:
                tried = case.places(places)
                faults = {at: wrong for at in tried if (wrong := case.wrong(at, on))}
                for at, wrong in list(faults.items())[:20]:
                    print(f"#   allocation {at}: " + wrong.strip().replace("\n", " / "))
                report(not faults, f"{case.name}, {'all from one on' if on else 'one'} failing: "
                       f"out of order {len(faults)} of {len(tried)} (at most 0)")
    done()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
