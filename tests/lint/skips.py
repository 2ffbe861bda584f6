"""A script that needs a Python module which is not there skips with exit 77, whichever of them it
is: never a success that tested nothing, never a fault."""

import ast
import os
import re
import subprocess
import sys
import tempfile

import tap

FOREIGN = ("numpy", "h5py", "yaml")
PATHS = ("../verification", "../scenes", "../command_line", "../lint", "..",
         "../../tests/verification")


def beside(path, name):
    """The tree's own module of that name: folders that the file names come before its own."""
    folder = os.path.dirname(path)
    for other in (*re.findall(r'"(\.\./\w+)"', tap.read(path)), "", *PATHS):
        found = os.path.normpath(os.path.join(folder, other, name + ".py"))
        if os.path.exists(os.path.join(tap.ROOT, found)):
            return found
    return None


def wanted(path, seen):
    """Foreign modules that a file imports when it starts, itself or by modules beside it."""
    if path is None or path in seen:
        return set()
    seen.add(path)
    names, found = set(), set()
    for node in ast.parse(tap.read(path)).body:
        if isinstance(node, ast.Import):
            names.update(alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or "").split(".")[0])
    for name in names:
        if name in FOREIGN:
            found.add(name)
        found |= wanted(beside(path, name), seen)
    return found


def without(path, module):
    """Exit code of the script where that module is not installed."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "sitecustomize.py"), "w", encoding="utf-8") as stream:
            stream.write(f"""import importlib.util, sys
class Blind:
    def find_spec(self, name, path=None, target=None):
        if name == "{module}":
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Blind())
real = importlib.util.find_spec
importlib.util.find_spec = lambda name, *more: None if name == "{module}" else real(name, *more)
""")
        shell = dict(os.environ, PYTHONPATH=folder, PYTHONDONTWRITEBYTECODE="1")
        try:
            done = subprocess.run([sys.executable, os.path.join(tap.ROOT, path)], cwd=folder,
                                  env=shell, stdin=subprocess.DEVNULL, capture_output=True,
                                  text=True, timeout=20, check=False)
        except subprocess.TimeoutExpired:
            return "it ran"
    plan = re.search(r"^1\.\.0 # SKIP ", done.stdout, re.M)
    return done.returncode if plan or done.returncode != 77 else "77 without a word"


listed = set()
for fragment in tap.files("tests", suffixes=("Makefile.inc",)):
    listed.update(re.findall(r"tests/\S+\.py", re.sub(r"#.*", "", tap.read(fragment))))
listed |= {p for p in tap.files("docs/results", suffixes=(".py",))
           if '__name__ == "__main__"' in tap.read(p)}
count = 0
wrong = []
for script in sorted(listed):
    for module in sorted(wanted(script, set())):
        count += 1
        code = without(script, module)
        if code != 77:
            wrong.append(f"{script} without {module}: {code}")
tap.check(f"{count} scripts that lack a module of theirs skip with exit 77", wrong)
tap.done()
