"""docs/reference.md is what docs/make_reference.py writes now."""

import difflib
import os
import subprocess
import sys

ROOT = os.environ["srcdir"]
made = subprocess.run([sys.executable, os.path.join(ROOT, "docs", "make_reference.py"),
                       os.environ["GAMUT"]], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                      text=True, check=False)
with open(os.path.join(ROOT, "docs", "reference.md"), encoding="utf-8") as stream:
    there = stream.read()
print("1..2")
print(f"{'not ' if made.returncode else ''}ok 1 - the reference can be made")
same = made.stdout == there
print(f"{'' if same else 'not '}ok 2 - docs/reference.md is up to date")
if not same:
    print("# make it anew: python3 docs/make_reference.py build/gamut > docs/reference.md")
    for line in list(difflib.unified_diff(there.splitlines(), made.stdout.splitlines(),
                                          lineterm="", n=0))[:30]:
        print("# " + line)
sys.exit(1 if made.returncode or not same else 0)
