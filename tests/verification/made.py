"""Builds plugins for tests, as a stranger would: with a compiler and the public headers."""
import os
import shlex
import shutil
import subprocess

import scenes

FOLDER = os.path.join(scenes.SCRATCH, "plugins")


def plugin(identity, described, source):
    """Builds kind/name; gives the folder to name by --plugin-path."""
    home = os.path.join(FOLDER, identity)
    name = os.path.basename(identity)
    os.makedirs(home)
    for ending, text in ((".yaml", described), (".c", source)):
        with open(os.path.join(home, name + ending), "w", encoding="utf-8") as file:
            file.write(text)
    header = subprocess.run([scenes.GAMUT, "header", os.path.join(home, name + ".yaml")],
                            capture_output=True, text=True, check=True).stdout
    with open(os.path.join(home, name + ".gamut.h"), "w", encoding="utf-8") as file:
        file.write(header)
    subprocess.run([*shlex.split(os.environ.get("CC", "cc")), "-std=gnu11", "-O2", "-fPIC",
                    "-fopenmp-simd", "-shared", "-I", home,
                    "-I", os.path.join(scenes.TREE, "framework/include"), "-o",
                    os.path.join(home, name + ".so"), os.path.join(home, name + ".c"), "-lm"],
                   check=True)
    return FOLDER


def of_tree(identity):
    """Builds the test plugin tests/plugins/kind/name with all that stands beside it."""
    source = os.path.join(scenes.TREE, "tests/plugins", identity)
    name = os.path.basename(identity)
    with open(os.path.join(source, name + ".yaml"), encoding="utf-8") as described, \
            open(os.path.join(source, name + ".c"), encoding="utf-8") as code:
        folder = plugin(identity, described.read(), code.read())
    for beside in os.listdir(source):
        if not beside.endswith((".c", name + ".yaml")):
            shutil.copy(os.path.join(source, beside), os.path.join(folder, identity, beside))
    return folder


def verified(identity):
    """One line of TAP: the plugin passes `gamut verify`."""
    done = subprocess.run([scenes.GAMUT, "verify", os.path.join(FOLDER, identity)],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    failed = [line for line in done.stdout.splitlines() if line.startswith(("not ok", "#"))]
    scenes.report(done.returncode == 0, f"{identity} passes gamut verify", [done.stderr, *failed])
