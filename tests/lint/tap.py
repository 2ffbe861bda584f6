"""TAP for the lint scripts: collect findings, then report each check with what was found."""

import os
import sys

ROOT = os.environ.get("srcdir", os.getcwd())
_results = []


def files(*folders, suffixes=None):
    """Paths below the given folders, relative to the tree, in a fixed order."""
    found = []
    for folder in folders:
        for base, names, entries in os.walk(os.path.join(ROOT, folder)):
            names[:] = sorted(n for n in names if not n.startswith(".") and n != "__pycache__")
            for entry in sorted(entries):
                if suffixes is None or entry.endswith(tuple(suffixes)):
                    found.append(os.path.relpath(os.path.join(base, entry), ROOT))
    return found


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8", errors="surrogateescape") as stream:
        return stream.read()


def check(name, findings):
    _results.append(not findings)
    print(f"{'ok' if not findings else 'not ok'} {len(_results)} - {name}")
    for finding in findings:
        print(f"# {finding}")


def done():
    print(f"1..{len(_results)}")
    sys.exit(0 if all(_results) else 1)
