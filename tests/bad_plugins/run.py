"""Bad plugins: each folder here is a plugin with one fault, and `expected` says what must come.

First line `refused`: eval, verify and run do not use it, exit code 4, and say the other lines.
First line `caught`: it loads, but `gamut verify` finds the fault (exit code 4), prints the lines.
Prints TAP. Everything is built with $CC in a folder of its own."""
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(1, os.path.join(HERE, ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

SCENE = """gamut: 1
solver: {{model: material_driver, end: 1 s, steps: 10, control: {{xx: {{log_strain: 0.01}}}}}}
materials:
  metal: {{density: 8000 kg/m3, eos: {{model: linear, bulk_modulus: 140 GPa}},
          strength: {{model: {name}}}, elasticity: {{model: hypoelastic, shear_modulus: 48 GPa}}}}
bodies:
  sample: {{material: metal}}
"""


def call(command, folder):
    return subprocess.run(command, cwd=folder, timeout=300, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace")


def build(name, folder):
    """Makes NAME.so as its author did. Returns what went wrong, or None."""
    source = os.path.join(folder, name + ".c")
    text = os.path.join(folder, name + ".so.txt")
    if os.path.exists(text):
        shutil.copy(text, os.path.join(folder, name + ".so"))
    if not os.path.exists(source):
        return None
    declared = os.path.join("before", name + ".yaml")
    if not os.path.exists(os.path.join(folder, declared)):
        declared = name + ".yaml"
    header = subprocess.run([kernels.GAMUT, "header", declared], cwd=folder, text=True,
                            capture_output=True)
    if header.returncode != 0:
        return header.stderr
    with open(os.path.join(folder, name + ".gamut.h"), "w", encoding="utf-8") as file:
        file.write(header.stdout)
    libraries = []
    if os.path.exists(os.path.join(folder, "library.c")):
        gone = "libhardening_of_a_library.so"
        done = call(kernels.CC + kernels.FLAGS + ["-o", gone, "library.c"], folder)
        if done.returncode != 0:
            return done.stdout
        libraries = ["-L.", "-lhardening_of_a_library"]
    done = call(kernels.CC + kernels.FLAGS + ["-o", name + ".so", name + ".c", *libraries, "-lm"],
                folder)
    if libraries:
        os.remove(os.path.join(folder, gone))
    return done.stdout if done.returncode != 0 else None


def judge(what, code, said, lines):
    missing = [line for line in lines if line not in said]
    report(code == 4 and not missing, what, f"exit {code}", "not said:", "\n".join(missing),
           "said:", said)


def refused(name, folder, lines, scratch):
    code, said = kernels.gamut(["eval", "./" + name], os.path.dirname(folder))
    judge(f"{name}: eval refuses it with the reason", code, said, lines)
    code, said = kernels.gamut(["verify", folder], scratch)
    judge(f"{name}: verify says the reason", code, said, lines)
    scene = os.path.join(scratch, "scene.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(SCENE.format(name=name))
    code, said = kernels.gamut(["--plugin-path", scratch, "run", scene, "-o", "result"], scratch)
    judge(f"{name}: run refuses it with the reason", code, said, lines)
    report(not os.path.exists(os.path.join(scratch, "result")), f"{name}: nothing is written")


def caught(name, folder, lines, scratch):
    code, said = kernels.gamut(["verify", folder], scratch)
    judge(f"{name}: verify catches it", code, said, lines)
    plan = [line for line in said.splitlines() if line.startswith("1..")]
    results = [line for line in said.splitlines() if line.startswith(("ok ", "not ok "))]
    report(plan == [f"1..{len(results)}"], f"{name}: what verify prints is whole TAP", said)


def try_one(name):
    with open(os.path.join(HERE, name, "expected"), encoding="utf-8") as file:
        kind, *lines = file.read().splitlines()
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.join(scratch, "strength", name)
        shutil.copytree(os.path.join(HERE, name), folder)
        for base, folders, _ in os.walk(scratch):
            for one in folders:
                os.chmod(os.path.join(base, one), 0o755)
        fault = build(name, folder)
        if fault:
            report(False, f"{name}: it can be built", fault)
        else:
            {"refused": refused, "caught": caught}[kind](name, folder, lines, scratch)


def main():
    for name in sorted(os.listdir(HERE)):
        if os.path.exists(os.path.join(HERE, name, "expected")):
            try_one(name)
    done()


if __name__ == "__main__":
    main()
