"""What the scripts of this folder share: calling gamut, reporting TAP."""
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.path.join(HERE, "../.."))
GAMUT = os.environ.get("GAMUT", os.path.join(ROOT, "build/gamut"))
count = 0
failures = 0


class Answer:
    def __init__(self, done):
        self.code, self.out, self.said = done.returncode, done.stdout, done.stderr

    def json(self):
        try:
            return json.loads(self.out)
        except ValueError:
            return None


def gamut(*arguments, cwd=None, timeout=300):
    return Answer(subprocess.run([GAMUT, "--no-user-plugins", *arguments], cwd=cwd, text=True,
                                 timeout=timeout, stdin=subprocess.DEVNULL, capture_output=True,
                                 errors="replace"))


def report(passed, name, answer=None):
    global count, failures
    count += 1
    failures += not passed
    print(("ok" if passed else "not ok") + f" {count} - {name}")
    if answer is not None and not passed:
        for line in [f"exit {answer.code}", "stdout:", *answer.out.splitlines()[:20], "stderr:",
                     *answer.said.splitlines()[:20]]:
            print("#   " + line)
    sys.stdout.flush()
    return passed


def figure(measured, tolerance, name):
    """A line with the measured figure beside its tolerance."""
    return report(measured <= tolerance, f"{name}: {measured:.3g} (at most {tolerance:.3g})")


def done():
    print(f"1..{count}")
    sys.exit(failures > 0)
