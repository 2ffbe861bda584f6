"""Only regular files are read, never without end: pipes, devices, folders and sockets are refused at
once, and so are includes that multiply. Prints TAP."""
import os
import socket
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tap  # noqa: E402
from tap import report  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
GAMUT = os.environ.get("GAMUT", os.path.join(HERE, "../../build/gamut"))
GOOD = open(os.path.join(HERE, "good.yaml"), encoding="utf-8").read()
POINTS = """gamut: 1
solver: {model: material_point_method, geometry: plane_strain, cell: 1 mm, end: 1 us}
materials: {m: {density: 8000 kg/m3, eos: {model: linear, bulk_modulus: 100 GPa}}}
bodies: {b: {material: m, shape: {points: {file: odd, spacing: 1 mm}}}}
"""
KINDS = {"pipe": "named pipe", "device": "device", "folder": "folder", "socket": "socket"}
LIMIT = 5.0  # s, of waiting: a pipe would be waited for without end


def gamut(folder, *arguments):
    before = os.times()
    try:
        done = subprocess.run([GAMUT, "--no-user-plugins", *arguments], cwd=folder, timeout=120,
                              stdin=subprocess.DEVNULL, capture_output=True)
    except subprocess.TimeoutExpired:
        return -1, "still running after 120 s", LIMIT
    after = os.times()
    used = after.children_user + after.children_system
    used -= before.children_user + before.children_system
    return done.returncode, done.stderr.decode(errors="replace"), used


def put(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def make(kind, path):
    if os.path.islink(path) or (os.path.exists(path) and not os.path.isdir(path)):
        os.unlink(path)
    elif os.path.isdir(path):
        os.rmdir(path)
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        os.symlink("/dev/zero", path)
    elif kind == "folder":
        os.mkdir(path)
    else:
        made = socket.socket(socket.AF_UNIX)
        made.bind(path)
        made.close()


def refused(what, kind, answer, codes=(3,)):
    code, said, used = answer
    words = "No such device or address" if kind == "socket" else KINDS[kind]
    report(code in codes and words in said and used < LIMIT,
           f"{what} is a {kind}: refused in {used:.2f} s (below {LIMIT:g})", f"exit {code}\n{said}")


def odd_files(folder):
    odd = os.path.join(folder, "odd")
    put(folder, "includes.yaml", GOOD + "include: [odd]\n")
    put(folder, "points.yaml", POINTS)
    for kind in KINDS:
        make(kind, odd)
        refused("a scene", kind, gamut(folder, "check", "odd"))
        refused("an include", kind, gamut(folder, "check", "includes.yaml"))
        refused("a table", kind, gamut(folder, "check", "points.yaml"))


def odd_plugins(folder):
    """A descriptor, and the tests of a plugin."""
    plugin = os.path.join(folder, "plugins/eos/odd")
    os.makedirs(plugin)
    for kind in KINDS:
        make(kind, os.path.join(plugin, "odd.yaml"))
        code, said, used = gamut(folder, "list", "--plugin-path", os.path.join(folder, "plugins"))
        report(code in (0, 2) and used < LIMIT,
               f"a descriptor is a {kind}: passed over in {used:.2f} s (below {LIMIT:g})", said)


def includes(folder):
    """Files that each include the next ten times: 10^15 files if nobody counts."""
    for k in range(16):
        following = f"include: [{', '.join([f'f{k + 1}.yaml'] * 10)}]\n" if k < 15 else ""
        put(folder, f"f{k}.yaml", "gamut: 1\n" + following)
    code, said, used = gamut(folder, "check", "f0.yaml")
    report(code == 3 and "more than 100 files are read for one scene" in said
           and said.count("more than 100") == 1 and used < LIMIT,
           f"includes that multiply: refused in {used:.2f} s (below {LIMIT:g})", said)
    put(folder, "large.yaml", "gamut: 1\nmaterials: {" + ", ".join(
        f"m{k}: {{density: 1 kg/m3}}" for k in range(60000)) + "}\n")
    put(folder, "twice.yaml", GOOD + "include: [large.yaml, large.yaml]\n")
    code, said, used = gamut(folder, "check", "twice.yaml")
    report(code == 3 and "more than 200000 values" in said and used < LIMIT,
           f"includes with too many values: refused in {used:.2f} s (below {LIMIT:g})", said)
    put(folder, "many.yaml", GOOD + "include: [" + ", ".join(
        f"c{k}.yaml" for k in range(90)) + "]\n")
    for k in range(90):
        put(folder, f"c{k}.yaml", "gamut: 1\n")
    code, said, _ = gamut(folder, "check", "many.yaml")
    report(code == 0, "90 includes are read", said)


def main():
    with tempfile.TemporaryDirectory() as folder:
        odd_files(folder)
        odd_plugins(folder)
        includes(folder)
    tap.done()


main()
