"""Runs scenes in a temporary folder and reads what came out; a voice for TAP."""
import atexit
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(1, os.path.join(HERE, ".."))
import needs  # noqa: E402
from tap import done, note, report  # noqa: E402,F401

needs.modules("h5py", "numpy")
TREE = os.path.abspath(os.environ.get("srcdir", os.path.join(HERE, "../..")))
GAMUT = os.environ.get("GAMUT", os.path.join(TREE, "build/gamut"))
INPUTS = os.path.join(TREE, "inputs")
SCRATCH = tempfile.mkdtemp(prefix="gamut-verification-")
atexit.register(shutil.rmtree, SCRATCH, ignore_errors=True)

# Threads that wait leave the core to others: tests run side by side.
PATIENT = {**os.environ, "OMP_WAIT_POLICY": "passive"}

runs = 0


def within(name, value, target, relative, unit="", scale=1.0):
    """A figure beside its target; `scale` is what one shown unit is in SI."""
    off = value / target - 1.0
    return report(abs(off) <= relative,
                  f"{name}: {value / scale:.6g} {unit}, target {target / scale:.6g}, "
                  f"{100 * off:+.3f} % (allowed {100 * relative:g} %)")


def below(name, value, limit, form=".3g"):
    return report(abs(value) <= limit, f"{name}: {value:{form}} (allowed {limit:g})")


class Failed(Exception):
    """A run that did not end as it should."""

    def __init__(self, code, said):
        super().__init__(f"exit {code}\n{said}")
        self.code, self.said = code, said


class Result:
    """What a run left behind: its summary, and the files in `folder`."""

    def __init__(self, folder, summary, said=""):
        self.folder, self.summary, self.said = folder, summary, said

    def value(self, name):
        return self.summary["quantities"][name]["value"]

    def history(self, name):
        quantity = self.summary["quantities"][name]
        return quantity["times"], quantity["values"]

    def file(self, name):
        return os.path.join(self.folder, name)

    def residual(self):
        """The largest relative residual of the ledger."""
        return max(abs(line["relative_residual"]) for line in self.summary["ledger"].values())


def scene(name):
    return name if os.path.isabs(name) else os.path.join(INPUTS, name + ".yaml")


def command(name, changes, extra=()):
    arguments = [GAMUT, "run", scene(name), "--no-user-plugins"]
    for path, value in changes.items():
        arguments += ["--set", f"{path}={value}"]
    return arguments + list(extra)


def attempt(name, changes=None, threads=1, extra=()):
    """The finished process of a run, and its folder."""
    global runs
    runs += 1
    folder = os.path.join(SCRATCH, f"run-{runs}")
    done_run = subprocess.run(
        command(name, changes or {}, ["-o", folder, "--threads", str(threads), *extra]),
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=3600, check=False,
        env=PATIENT)
    return done_run, folder


def run(name, changes=None, threads=1, extra=()):
    """A run that must end well."""
    process, folder = attempt(name, changes, threads, extra)
    if process.returncode != 0:
        raise Failed(process.returncode, process.stderr[-2000:])
    return read(folder, process)


def read(folder, process):
    """What a finished run left."""
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as text:
        return Result(folder, json.load(text), process.stderr)


def written(name, text):
    """A scene of our own, which may include the tree's cards as materials/NAME.yaml."""
    folder = os.path.join(SCRATCH, "scenes")
    os.makedirs(folder, exist_ok=True)
    cards = os.path.join(folder, "materials")
    if not os.path.exists(cards):
        os.symlink(os.path.join(INPUTS, "materials"), cards)
    path = os.path.join(folder, name + ".yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def drop(result):
    """Frees the disk of a result that is no longer needed."""
    shutil.rmtree(result.folder, ignore_errors=True)
