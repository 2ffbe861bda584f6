"""Makes formulas wrong, one at a time (mutations.yaml), in a copy of the tree, builds what changed,
and runs the tests that must notice: "caught" or "SURVIVED" for each. By hand; takes half an hour.

    python3 tests/bench/mutations.py [--scratch FOLDER] [--table] [WORD ...]

WORDs choose mutations by their name. A copy in FOLDER is kept and used again, with what was found
(mutations.json), so that several calls may share the work. --table writes docs/results/mutations.md
from what was found of all."""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import needs  # noqa: E402

needs.modules("yaml")
import yaml  # noqa: E402

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGE = os.path.join(TREE, "docs/results/mutations.md")
LONGEST = 1800


class Copy:
    """The copy of the tree, built in its folder build/."""

    def __init__(self, folder):
        self.folder, self.build = folder, os.path.join(folder, "build")
        self.pending = set()  # targets whose sources are right again, but not their objects
        listed = subprocess.run(["git", "-C", TREE, "ls-files", "-co", "--exclude-standard"],
                                capture_output=True, text=True, check=True).stdout.split("\n")
        for name in filter(None, listed):
            self.take(name)
        if not os.path.exists(os.path.join(self.build, "Makefile")):
            self.prepare()
        self.make(["all"])

    def take(self, name):
        """A file as it is in the tree; its time changes only with its text."""
        source, to = os.path.join(TREE, name), os.path.join(self.folder, name)
        if not os.path.isfile(source):
            return
        os.makedirs(os.path.dirname(to), exist_ok=True)
        with open(source, "rb") as text:
            new = text.read()
        if os.path.exists(to):
            with open(to, "rb") as text:
                if text.read() == new:
                    return
        shutil.copy(source, to)
        os.utime(to)

    def prepare(self):
        os.makedirs(self.build, exist_ok=True)
        self.call(["autoreconf", "-fi"], self.folder)
        self.call(["../configure", "--disable-levels"], self.build)

    def call(self, words, folder):
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(words)} failed:\n{(done.stdout + done.stderr)[-3000:]}")

    def make(self, targets):
        self.call(["make", "-s", *sorted(targets)], self.build)

    def path(self, name):
        return os.path.join(self.folder, name)


def read(path):
    with open(path, encoding="utf-8") as text:
        return text.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def targets_of(mutation):
    """What make must build for a changed file: one plugin's shared object, or everything."""
    plugin = re.match(r"plugins/(\w+)/(\w+)/", mutation["file"])
    named = mutation.get("build") or ([f"{plugin[1]}/{plugin[2]}"] if plugin else [])
    objects = {f"plugins/{p}/{p.split('/')[1]}.so" for p in named}
    programs = {t for t in mutation["tests"]
                if re.match(r"tests/(unit/test_\w+|random_field/modes)$", t)}
    return (objects | programs) if objects else ({"all"} | programs)


def run_test(copy, test):
    """Whether the test passes, and the first line that says it does not."""
    environment = {**os.environ, "srcdir": copy.folder, "builddir": copy.build, "PYTHON":
                   sys.executable, "GAMUT": copy.path("build/gamut"), "CC": "gcc",
                   "OMP_WAIT_POLICY": "passive"}
    if test.startswith("verify "):
        words = [environment["GAMUT"], "--no-user-plugins", "verify", test.split()[1]]
    elif test.endswith(".py"):
        words = [sys.executable, copy.path(test)]
    elif test.endswith(".sh"):
        words = ["bash", copy.path(test)]
    else:
        words = [os.path.join(copy.build, test)]
    try:
        done = subprocess.run(words, cwd=copy.build, env=environment, capture_output=True,
                              text=True, timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return False, f"no end within {LONGEST} s"
    said = done.stdout.split("\n") + done.stderr.split("\n")
    line = next((x.strip() for x in said if re.match(r"\s*not ok", x)), "")
    if done.returncode != 0 and not line:
        line = next((x for x in reversed(said) if x.strip()), "")
    if done.returncode == 77 or re.search(r"^1\.\.0 # SKIP", done.stdout, re.M):
        raise SystemExit(f"{test} was skipped: nothing can be said")
    return done.returncode == 0, re.sub(r"^not ok \d+( - )?", "", line)


def mutate(copy, mutation):
    path = copy.path(mutation["file"])
    whole = read(path)
    if whole.count(mutation["old"]) != 1:
        raise SystemExit(f"mutations.yaml, '{mutation['name']}': its text stands "
                         f"{whole.count(mutation['old'])} times in {mutation['file']}, not once")
    write(path, whole.replace(mutation["old"], mutation["new"]))
    targets = targets_of(mutation)
    copy.make(targets | copy.pending)
    copy.pending.clear()
    found = [(test, *run_test(copy, test)) for test in mutation["tests"]]
    write(path, whole)
    copy.pending |= targets
    return found


def check_texts(mutations):
    for m in mutations:
        count = read(os.path.join(TREE, m["file"])).count(m["old"])
        if count != 1:
            raise SystemExit(f"mutations.yaml, '{m['name']}': its text stands {count} times in "
                             f"{m['file']}, not once")


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;")[:110]


def table(mutations, kept):
    missing = [m["name"] for m in mutations if m["name"] not in kept]
    if missing:
        raise SystemExit("no table: not tried yet: " + "; ".join(missing))
    rows = [(m, kept[m["name"]]) for m in mutations]
    caught = sum(not any(passed for _, passed, _ in found) for _, found in rows)
    lines = ["# Mutations", "",
             "Formulas made wrong on purpose, one at a time, and whether the tests named for them",
             "notice. Without a mutation all of these tests pass. Made by", "",
             "    python3 tests/bench/mutations.py --table", "",
             f"{caught} of {len(rows)} were caught by every test named for them.", "",
             "| mutation | file | test | what it said |", "|---|---|---|---|"]
    for mutation, found in rows:
        for test, passed, line in found:
            lines.append(f"| {cell(mutation['name'])} | `{mutation['file'].split('/', 1)[1]}` | "
                         f"`{test}` | {'**survived**' if passed else cell(line)} |")
    lines += ["", "`verify KIND/NAME` is what `tests/conformance/all.sh` does for every plugin."]
    write(PAGE, "\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scratch")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("words", nargs="*")
    arguments = parser.parse_args()
    mutations = yaml.safe_load(read(os.path.join(TREE, "tests/bench/mutations.yaml")))
    chosen = [m for m in mutations
              if not arguments.words or any(w in m["name"] for w in arguments.words)]
    check_texts(mutations)
    folder = arguments.scratch or tempfile.mkdtemp(prefix="gamut-mutations-")
    copy = Copy(folder)
    copy.make({t for m in chosen for t in targets_of(m)})
    for test in sorted({t for m in chosen for t in m["tests"]}):
        passed, line = run_test(copy, test)
        print(f"{'passes' if passed else 'FAILS'} without a mutation: {test} {line}", flush=True)
        if not passed:
            raise SystemExit("a test that fails anyway catches nothing")
    kept_file = os.path.join(folder, "mutations.json")
    kept = json.loads(read(kept_file)) if os.path.exists(kept_file) else {}
    survivors = 0
    for mutation in chosen:
        begin = time.time()
        found = kept[mutation["name"]] = mutate(copy, mutation)
        write(kept_file, json.dumps(kept, indent=1))
        survived = any(passed for _, passed, _ in found)
        survivors += survived
        print(f"{'SURVIVED' if survived else 'caught'}: {mutation['name']} "
              f"({time.time() - begin:.0f} s)", flush=True)
        for test, passed, line in found:
            print(f"    {test}: {'passes' if passed else line}", flush=True)
    print(f"{len(chosen) - survivors} of {len(chosen)} caught")
    if arguments.table:
        table(mutations, kept)
    if not arguments.scratch:
        shutil.rmtree(folder)
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
