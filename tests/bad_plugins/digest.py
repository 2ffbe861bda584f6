"""A shared object that lies beside a digest (NAME.so.sha256) and is not the one that it was made of
is refused before it is opened; so is one beside a file that holds no digest. Prints TAP."""
import hashlib
import os
import shutil
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

PLACES = 12
EVAL = ["eval", "strength/mine", "--param", "y0=90e6", "--param", "h=300e6", "--at",
        "plastic_strain=0.1"]


def sum_of(content):
    return hashlib.sha256(content).hexdigest()


def put(path, content):
    if os.path.isdir(path) and not os.path.islink(path):
        os.rmdir(path)
    elif os.path.lexists(path):
        os.remove(path)
    if content is not None:
        with open(path, "wb") as file:
            file.write(content)


def judge(root, what, due, *words, command=None):
    code, said = kernels.gamut(["--plugin-path", root, *(command or EVAL)], root, timeout=20)
    missing = [word for word in words if word not in said]
    report(code == due and not missing, f"{what}: exit {code} (due {due})", "not said:",
           "\n".join(missing), "said:", said)


def changed(root, name, whole):
    """Byte by byte, cut off, longer: names the file, what was due and what there is."""
    def other(what, content, command=None):
        put(name, content)
        judge(root, what, 4, f"'{name}'", sum_of(whole), sum_of(content), "install it again",
              command=command)

    for i in range(PLACES):
        at = (2 * i + 1) * len(whole) // (2 * PLACES)
        flipped = bytes([whole[at] ^ 1 << i % 8])
        other(f"bit {i % 8} of byte {at} of {len(whole)} flipped",
              whole[:at] + flipped + whole[at + 1:])
    for share in (0.9, 0.5, 0.0):
        other(f"cut off at {share}", whole[:int(share * len(whole))])
    other("a byte longer", whole + b"\0")
    with open(os.path.join(root, "scene.yaml"), "w", encoding="utf-8") as file:
        file.write(kernels.scene("mine"))
    for command in ("check", "run"):
        other(f"{command}, a byte longer", whole + b"\0", command=[command, "scene.yaml"])
    put(name, whole)
    judge(root, "whole again", 0)


def broken(root, name, whole):
    """What lies there as a digest is none."""
    digest, stated = name + ".sha256", sum_of(whole)
    said = (f"'{digest}'", "holds no digest")
    for what, content in (("empty", b""), ("cut off", stated[:63].encode()),
                          ("too long", (stated + "0  mine.so\n").encode()),
                          ("no digits", ("g" + stated[1:] + "  mine.so\n").encode()),
                          ("of no file", stated.encode() + b"\n"),
                          ("of another file", (stated + "  other.so\n").encode()),
                          ("of two files", (stated + "  mine.so\n").encode() * 2),
                          ("binary", b"\0" * 80), ("a megabyte", b"a" * (1 << 20))):
        put(digest, content)
        judge(root, f"a digest, {what}", 4, *said)
    put(digest, None)
    os.mkdir(digest)
    judge(root, "a digest, a folder", 4, *said)
    put(digest, None)
    os.mkfifo(digest)
    judge(root, "a digest, a pipe", 4, *said)
    put(digest, None)
    os.symlink("nowhere", digest)
    judge(root, "a digest, a link to nothing", 4, *said)
    put(digest, (stated + " *mine.so\n").encode())
    judge(root, "as `sha256sum -b` writes it", 0)
    put(digest, None)
    judge(root, "without a digest", 0)


def levels(root, name, whole):
    """The shared object of another instruction set has a digest of its own."""
    above = name.replace(".so", ".v3.so")
    shutil.copy(name, above)
    put(above + ".sha256", (sum_of(whole + b"\0") + "  mine.v3.so\n").encode())
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        if " avx2 " not in file.read():
            print("# no processor for mine.v3.so: not tried")
            return
    judge(root, "the digest of mine.v3.so is another", 4, f"'{above}'")


def main():
    with tempfile.TemporaryDirectory() as root:
        root = os.path.realpath(root)
        name = os.path.join(kernels.strength(root, "mine"), "mine.so")
        with open(name, "rb") as file:
            whole = file.read()
        put(name + ".sha256", (sum_of(whole) + "  mine.so\n").encode())
        judge(root, "as installed", 0)
        changed(root, name, whole)
        broken(root, name, whole)
        if os.uname().machine == "x86_64":
            levels(root, name, whole)
    done()


if __name__ == "__main__":
    main()
