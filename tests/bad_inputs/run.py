"""Wrong inputs: each NAME.yaml here is refused by `gamut check` and `gamut run` with the words of
NAME.expected, exit code 3, and nothing written. Prints TAP.

With --update the .expected files are written anew from what `gamut check` says: read the difference
before it is kept."""
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tap  # noqa: E402
from tap import report  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
GAMUT = os.environ.get("GAMUT", os.path.join(HERE, "../../build/gamut"))
GOOD = "good.yaml"
MILLION = 1000000


def gamut(arguments, folder):
    done = subprocess.run([GAMUT, "--no-user-plugins"] + arguments, cwd=folder, timeout=120,
                          stdin=subprocess.DEVNULL, capture_output=True)
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(
        errors="replace")


def installed(kind):
    """What a message lists, so that a new plugin needs no new words here."""
    names = [line.split()[0] for line in gamut(["list"], ".")[1].splitlines()
             if line.strip().startswith(kind + "/")]
    return ", ".join(sorted(name.split("/")[1] for name in names))


def words(path):
    """The expected text; <installed strength> stands for the plugins of that kind."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for kind in ("eos", "strength", "elasticity", "effect", "estimator", "random_field", "solver"):
        mark = f"<installed {kind}>"
        if mark in text:
            text = text.replace(mark, installed(kind))
    return text


def marked(text):
    """The reverse of words()."""
    for kind in ("eos", "strength", "elasticity", "effect", "estimator", "random_field", "solver"):
        text = text.replace("installed: " + installed(kind), f"installed: <installed {kind}>")
    return text


def listing(folder):
    return sorted(os.path.join(at, name) for at, _, names in os.walk(folder) for name in names)


def refused(name, folder, expected, before):
    """One file through both commands; `before` is what stands in the folder."""
    code, out, said = gamut(["check", name], folder)
    report(code == 3 and said == expected and out == "", f"check {name}: exit 3 and its message",
           [f"exit {code}", "said:", said, "expected:", expected, out])
    with tempfile.TemporaryDirectory() as scratch:
        result = os.path.join(scratch, "result")
        code, out, said = gamut(["run", name, "-o", result], folder)
        written = os.listdir(scratch) + [f for f in listing(folder) if f not in before]
        report(code == 3 and said == expected and not written,
               f"run {name}: the same, nothing written", [f"exit {code}", said, written])


def generated(folder):
    """Files too large or too odd to keep."""
    made = {
        "binary.yaml": b"\x7fELF\x02\x01\x01\x00" + bytes(range(256)) * 16,
        "zero_byte.yaml": b"gamut: 1\ntitle: a\x00b\n",
        "not_utf8.yaml": b"gamut: 1\ntitle: caf\xe9\n",
        "long_line.yaml": b"gamut: 1\ntitle: " + b"x" * (10 * MILLION) + b"\n",
        "deep.yaml": b"gamut: 1\ntitle: " + b"[" * 2000 + b"]" * 2000 + b"\n",
        "many_nodes.yaml": b"gamut: 1\ntitle: [" + b"a," * (1 * MILLION) + b"]\n",
    }
    for name, content in made.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)
    os.mkdir(os.path.join(folder, "folder.yaml"))
    return list(made) + ["folder.yaml", "missing_file.yaml"]


def expectation(name):
    return words(os.path.join(HERE, name[:-len(".yaml")] + ".expected"))


def outputs():
    """A folder that cannot be written, and one that holds a result: exit 7."""
    with tempfile.TemporaryDirectory() as scratch:
        blocker = os.path.join(scratch, "file")
        with open(blocker, "w", encoding="ascii"):
            pass
        code, _, said = gamut(["run", GOOD, "-o", os.path.join(blocker, "result")], HERE)
        report(code == 7 and blocker in said, "a folder that cannot be made: exit 7",
               [f"exit {code}", said])
        result = os.path.join(scratch, "result")
        code, _, said = gamut(["run", GOOD, "-o", result], HERE)
        report(code == 0, "a good scene runs", [f"exit {code}", said])
        if code != 0:
            return
        before = {f: open(f, "rb").read() for f in listing(result)}
        code, _, said = gamut(["run", GOOD, "-o", result], HERE)
        after = {f: open(f, "rb").read() for f in listing(result)}
        report(code == 7 and before == after and "--force" in said,
               "an existing result is refused and left alone: exit 7", [f"exit {code}", said])
        code, _, said = gamut(["run", GOOD, "-o", result, "--force"], HERE)
        report(code == 0, "with --force it is replaced", [f"exit {code}", said])
        os.chmod(scratch, 0o500)
        if os.geteuid() != 0:
            code, _, said = gamut(["run", GOOD, "-o", os.path.join(scratch, "new")], HERE)
            report(code == 7, "a folder without permission: exit 7", [f"exit {code}", said])
        os.chmod(scratch, 0o700)


def overrides():
    for setting, words in (("solver.cel=1 mm", "did you mean 'cell'?"),
                           ("bodies.bar.velocity=3 m/s", "a vector is due"),
                           ("bodies.bar.shape.cylinder.length=-1 mm", "greater than 0"),
                           ("solver.cell=0.2", "has no unit")):
        code, _, said = gamut(["check", GOOD, "--set", setting], HERE)
        path = setting.split("=")[0]
        report(code == 3 and words in said and "--set " + path in said, f"--set {setting}",
               [f"exit {code}", said])
    for setting in ("bodies.bar.velocity=[0 m/s, -200 m/s]", "solver.cell=1 mm", "solver.end=1 us",
                    "bodies.bar.shape.cylinder.length=30 mm", "solver.shape=linear"):
        code, _, said = gamut(["check", GOOD, "--set", setting], HERE)
        report(code == 0, f"--set {setting}", [f"exit {code}", said])


def update(names):
    with tempfile.TemporaryDirectory() as scratch:
        for name in generated(scratch) + names:
            folder = HERE if name in names else scratch
            code, _, said = gamut(["check", name], folder)
            if code != 3:
                print(f"{name}: exit {code}, not 3: left as it is")
                continue
            with open(os.path.join(HERE, name[:-len(".yaml")] + ".expected"), "w",
                      encoding="utf-8") as file:
                file.write(marked(said))


def main():
    names = sorted(n for n in os.listdir(HERE) if n.endswith(".yaml") and n != GOOD)
    if "--update" in sys.argv:
        update(names)
        return 0
    before = listing(HERE)
    for name in names:
        refused(name, HERE, expectation(name), before)
    scratch = tempfile.mkdtemp()
    try:
        odd = generated(scratch)
        there = listing(scratch)
        for name in odd:
            refused(name, scratch, expectation(name), there)
    finally:
        shutil.rmtree(scratch)
    overrides()
    outputs()
    tap.done()


if __name__ == "__main__":
    main()
