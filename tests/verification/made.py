"""Builds plugins for tests, as a stranger would: with a compiler and the public headers."""
import os
import shlex
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
