"""Plugins that somebody else could change are refused, wherever on the way that is; a shared object
that is cut off is refused before it is opened. As root, and as a user. Prints TAP."""
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

STRANGER, USER = 1, 65534
def judge(root, what, due, words="", prefix=()):
    command = [*prefix, kernels.GAMUT, "--no-user-plugins", "--plugin-path",
               os.path.join(root, "p"), "eval", "strength/mine", "--param", "y0=90e6", "--param",
               "h=300e6", "--at", "plastic_strain=0.1"]
    done = subprocess.run(command, cwd="/", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    report(done.returncode == due and words in done.stdout,
           f"{what}: exit {done.returncode} (due {due}), said: {words}", done.stdout)


def cut(root):
    name = os.path.join(root, "p/strength/mine/mine.so")
    with open(name, "rb") as file:
        whole = file.read()
    for share in (0.9, 0.5, 0.1, 0.0):
        os.remove(name)
        with open(name, "wb") as file:
            file.write(whole[:int(share * len(whole))])
        judge(root, f"cut off at {share}", 4, "cut off" if share > 0.05 else "no ELF file")
    os.remove(name)
    with open(name, "wb") as file:
        file.write(whole)
    judge(root, "whole again", 0)


def owned(root):
    folder = os.path.join(root, "p/strength/mine")
    other = "belongs to another user"
    for part in ("mine.so", "mine.yaml", "", ".."):
        path = os.path.normpath(os.path.join(folder, part))
        os.chown(path, STRANGER, -1)
        judge(root, f"another's {os.path.basename(path)}", 4, f"'{path}' {other}")
        os.chown(path, 0, -1)
    for part, mode in (("mine.so", 0o755), ("mine.yaml", 0o644), ("", 0o755)):
        path = os.path.normpath(os.path.join(folder, part))
        os.chmod(path, mode | 0o002)
        judge(root, f"{os.path.basename(path)} that all may write", 4, "written by everybody")
        os.chmod(path, mode)
    elsewhere = os.path.join(root, "elsewhere")
    os.mkdir(elsewhere, 0o755)
    shutil.move(os.path.join(folder, "mine.so"), elsewhere)
    os.symlink(os.path.join(elsewhere, "mine.so"), os.path.join(folder, "mine.so"))
    judge(root, "a link to a file of mine", 0)
    os.chown(elsewhere, STRANGER, -1)
    judge(root, "a link into another's folder", 4, f"'{elsewhere}' {other}")
    os.chown(elsewhere, 0, -1)
    os.chown(os.path.join(elsewhere, "mine.so"), STRANGER, -1)
    judge(root, "a link to another's file", 4, other)
    os.chown(os.path.join(elsewhere, "mine.so"), 0, -1)


def as_user(root):
    prefix = ("setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups")
    tried = subprocess.run([*prefix, kernels.GAMUT, "--version"], capture_output=True, check=False)
    if tried.returncode != 0:
        print("# a user cannot run this gamut: not tried as a user")
        return
    judge(root, "a user, root's plugin", 0, "", prefix)
    file = os.path.join(root, "elsewhere/mine.so")
    os.chown(file, USER, -1)
    judge(root, "a user, the user's own file", 0, "", prefix)
    os.chown(file, STRANGER, -1)
    judge(root, "a user, a third's file", 4, "belongs to another user", prefix)


def main():
    if os.geteuid() != 0 or not shutil.which("setpriv"):
        print("1..0 # SKIP owners can be changed by root alone")
        return 77
    with tempfile.TemporaryDirectory() as root:
        os.chmod(root, 0o755)
        os.mkdir(os.path.join(root, "p"), 0o755)
        kernels.strength(os.path.join(root, "p"), "mine")
        judge(root, "all mine", 0)
        cut(root)
        owned(root)
        as_user(root)
    done()


if __name__ == "__main__":
    main()
