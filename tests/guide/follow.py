"""Does what a page of the documents says, from its text, and checks what it says comes out: the
plugin guide here, README and manual in pages.py.

Marks in a page, each before a fenced block:
  <!-- file: NAME -->        the block is written to NAME
  <!-- add to: NAME -->      ... added at its end
  <!-- run -->               ... run by a shell
  <!-- prints -->            its lines stand in what the last run printed
  <!-- part of: KIND NAME --> it is part of that file of `gamut new KIND/trial`
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile

GAMUT = os.environ["GAMUT"]
SOURCE = os.environ.get("srcdir", "")
INSTALLED = os.environ.get("pkgdatadir")
BLOCK = re.compile(r"^<!-- (file|add to|run|prints|part of)(?:: (.*?))? -->\n```\w*\n(.*?)^```$",
                   re.MULTILINE | re.DOTALL)

scratch = tempfile.mkdtemp()
results = []
folder = scratch
printed = ""


def environment():
    """The shell's: gamut in the path, pkg-config knows it, a plugin folder of its own."""
    shell = dict(os.environ, XDG_DATA_HOME=os.path.join(scratch, "data"), OMP_NUM_THREADS="1",
                 PATH=os.path.dirname(GAMUT) + os.pathsep + os.environ["PATH"])
    for name in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "GAMUT_PLUGIN_PATH", "CFLAGS"):
        shell.pop(name, None)
    shell.pop("GAMUT")  # pkg-config says where it is
    shell.setdefault("PYTHON", sys.executable)
    if not INSTALLED:
        write_uninstalled(shell)
    return shell


def write_uninstalled(shell):
    """pkg-config for the gamut of the build tree: its .pc file, with other folders."""
    with open(os.path.join(os.environ["builddir"], "gamut.pc"), encoding="utf-8") as stream:
        text = stream.read()
    for name, value in (("gamut", GAMUT),
                        ("includedir", os.path.join(SOURCE, "framework", "include"))):
        text = re.sub(rf"^{name}=.*$", f"{name}={value}", text, flags=re.MULTILINE)
    path = os.path.join(scratch, "pkgconfig")
    os.mkdir(path)
    with open(os.path.join(path, "gamut.pc"), "w", encoding="utf-8") as stream:
        stream.write(text)
    shell["PKG_CONFIG_PATH"] = path


def tell(good, name, why=""):
    results.append(good)
    print(f"{'ok' if good else 'not ok'} {len(results)} - {name}")
    for line in "" if good else why.splitlines()[-40:]:
        print(f"# {line}")
    sys.stdout.flush()


def write(name, text, mode):
    with open(os.path.join(folder, name), mode, encoding="utf-8") as stream:
        stream.write(text)


def lacking(text, shell):
    """What an optional program or module would be needed for, but is not there."""
    if "gamut plot" in text and not shutil.which("gnuplot"):
        return "gnuplot"
    if "h5py" in text and subprocess.run([shell["PYTHON"], "-c", "import h5py"], check=False,
                                         stderr=subprocess.DEVNULL).returncode:
        return "h5py"
    return None


def run(text, shell):
    global folder, printed
    name, missing = "runs: " + text.splitlines()[0].split(" #")[0].strip(), lacking(text, shell)
    if missing:
        tell(True, f"{name} # SKIP no {missing}")
        return
    done = subprocess.run(["bash", "-e", "-c", text + "\npwd > \"$PLACE\"\n"], cwd=folder,
                          env=dict(shell, PLACE=os.path.join(scratch, "place")),
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=240, check=False)
    printed = done.stdout
    if done.returncode == 0:
        with open(os.path.join(scratch, "place"), encoding="utf-8") as stream:
            folder = stream.read().strip()
    tell(done.returncode == 0, name, printed)


def figure(word):
    """A number as seven digits, however it is written; a word as it is."""
    try:
        return f"{float(word):.7g}"
    except ValueError:
        return word


def plain(text):
    """One blank between words; no numbers of checks, which come and go."""
    return re.sub(r"^ok \d+ - ", "ok - ", " ".join(figure(word) for word in text.split()))


def compare(text):
    lines = {plain(line) for line in printed.splitlines()}
    for line in text.splitlines():
        tell(plain(line) in lines, "prints: " + plain(line).replace("#", ""), printed)


def part_of(where, text, shell):
    kind, name = where.split()
    place = os.path.join(scratch, kind)
    if not os.path.isdir(place):
        subprocess.run([GAMUT, "new", f"{kind}/trial", "-o", place], env=shell, check=True,
                       stdout=subprocess.DEVNULL)
    with open(os.path.join(place, name), encoding="utf-8") as stream:
        tell(text in stream.read(), f"part of a new {kind}: {text.splitlines()[0].strip()}")


def follow(page, shell):
    blocks = BLOCK.findall(page)
    tell(len(blocks) == page.count("<!-- ") and blocks, "every mark has its block",
         f"{len(blocks)} blocks, {page.count('<!-- ')} marks")
    for mark, name, text in blocks:
        if mark == "file":
            write(name, text, "w")
        elif mark == "add to":
            write(name, text, "a")
        elif mark == "run":
            run(text.rstrip("\n"), shell)
        elif mark == "prints":
            compare(text)
        else:
            part_of(name, text, shell)


def ten_lines(page):
    formula = re.search(r"GAMUT_EACH.*?\n  }\n", page, re.DOTALL).group(0)
    count = formula.count("\n")
    tell(count <= 10, f"lines of the first formula: {count} (at most 10)")


def main(*pages):
    """Each page in the order of its marks, beside a folder `inputs`; then the end of the test."""
    global folder
    try:
        shell = environment()
        os.symlink(os.path.join(INSTALLED or SOURCE, "inputs"), os.path.join(scratch, "inputs"))
        for name in pages:
            folder = scratch
            with open(os.path.join(INSTALLED or SOURCE, name), encoding="utf-8") as stream:
                page = stream.read()
            follow(page, shell)
            if name.endswith("plugin_guide.md"):
                ten_lines(page)
    finally:
        shutil.rmtree(scratch)
    print(f"1..{len(results)}")
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main("docs/plugin_guide.md")
