"""What stands where a plugin's YAML is due and is no file (a pipe, a device, a folder, a link to
nothing) is told and waited for by nobody; the plugins beside it are found. Prints TAP."""
import os
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

ODD = (("a named pipe", os.mkfifo), ("a folder", os.mkdir),
       ("a device", lambda path: os.symlink("/dev/zero", path)),
       ("cannot open the file", lambda path: os.symlink("nowhere", path)))
PLACES = ("{0}.yaml", "{0}/{0}.yaml", "eos/{0}/{0}.yaml")


def main():
    with tempfile.TemporaryDirectory() as root:
        root = os.path.realpath(root)
        kernels.strength(root, "mine")
        made = []
        for i, place in enumerate(PLACES):
            for k, (words, make) in enumerate(ODD):
                path = os.path.join(root, place.format(f"odd_{i}_{k}"))
                os.makedirs(os.path.dirname(path), mode=0o755, exist_ok=True)
                make(path)
                made.append((path, words))
        code, said = kernels.gamut(["--plugin-path", root, "list"], root, timeout=20)
        report(code == 0 and "strength/mine" in said, f"list: exit {code}, the others are found",
               said)
        for path, words in made:
            lines = [line for line in said.splitlines() if line.startswith(path + ":")]
            report(len(lines) == 1 and words in lines[0] and "skipped" in lines[0],
                   f"list: {os.path.relpath(path, root)}, {words}", said)
        for path, words in made:
            asked = path if path.count("odd") == 1 else os.path.dirname(path)
            if not os.path.exists(path) or os.path.isdir(path):
                continue
            code, said = kernels.gamut(["verify", asked], root, timeout=20)
            report(code == 4 and words in said,
                   f"verify {os.path.relpath(asked, root)}: exit {code}, {words}", said)
        os.mkfifo(os.path.join(root, "plugins.path"))
        code, said = kernels.gamut(["--plugin-path", root, "list"], root, timeout=20)
        report(code == 0 and "strength/mine" in said and "plugins.path: warning" in said and
               "it is passed over: " in said and "a named pipe" in said,
               f"list: plugins.path, a named pipe: exit {code}", said)
    done()


if __name__ == "__main__":
    main()
