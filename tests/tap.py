"""TAP from Python: one line a check, what was said only where it failed, the plan at the end; and
calling gamut. For the scripts of all folders here; the lint scripts have their own."""
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.environ.get("srcdir") or os.path.join(HERE, ".."))
GAMUT = os.environ.get("GAMUT", os.path.join(ROOT, "build/gamut"))
LINES = 40  # of what is shown of one note
results = []


class Answer:
    """What a command said: exit code, standard output, standard error."""

    def __init__(self, done):
        self.code, self.out, self.said = done.returncode, done.stdout, done.stderr

    def json(self):
        try:
            return json.loads(self.out)
        except ValueError:
            return None

    def __str__(self):
        return "\n".join([f"exit {self.code}", "stdout:", *self.out.splitlines()[:LINES // 2],
                          "stderr:", *self.said.splitlines()[:LINES // 2]])


def gamut(*arguments, cwd=None, timeout=300):
    return Answer(subprocess.run([GAMUT, "--no-user-plugins", *arguments], cwd=cwd, text=True,
                                 timeout=timeout, stdin=subprocess.DEVNULL, capture_output=True,
                                 errors="replace"))


def report(passed, name, *notes):
    """One line of TAP; returns whether it passed."""
    results.append(bool(passed))
    print(("ok" if passed else "not ok") + f" {len(results)} - {name}")
    for one in notes if not passed else ():
        for part in one if isinstance(one, (list, tuple)) else (one,):
            for line in str("" if part is None else part).splitlines()[-LINES:]:
                print("#   " + line)
    sys.stdout.flush()
    return passed


def note(text):
    print("# " + text)
    sys.stdout.flush()


def figure(measured, tolerance, name):
    """A line with the measured figure beside its tolerance."""
    return report(measured <= tolerance, f"{name}: {measured:.3g} (at most {tolerance:.3g})")


def done():
    """The plan, and the end of the script."""
    print(f"1..{len(results)}")
    sys.exit(0 if all(results) else 1)
