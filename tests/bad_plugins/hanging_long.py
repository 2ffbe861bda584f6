"""A kernel that takes more than 60 s over one block of points is ended and named; the last
checkpoint is kept. Prints TAP."""
import os
import sys
import tempfile
import time

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402


def main():
    with tempfile.TemporaryDirectory() as root:
        # Beyond the strains at which a law is tried before the first step (0.13), and reached (0.2).
        kernels.strength(root, "waits", kernels.STRENGTH +
                         "    if (b->plastic_strain[i] > 0.15) for (;;) pause();\n",
                         "#include <unistd.h>\n")
        with open(os.path.join(root, "waits.yaml"), "w", encoding="utf-8") as file:
            file.write(kernels.scene("waits", more="outputs: {checkpoint: {every: 0.1 s}}\n"))
        begun = time.monotonic()
        code, said = kernels.gamut(["--plugin-path", root, "run", "waits.yaml", "-o", "r"], root)
        took = time.monotonic() - begun
        report(code == 4 and "plugin strength/waits hangs" in said,
               f"exit {code} (due 4) and the plugin's name", said)
        report(59 < took < 63, f"after {took:.1f} s (59 to 63)", said)
        report(os.path.exists(os.path.join(root, "r", "checkpoint.h5")),
               "the last checkpoint is kept", said)
    done()


if __name__ == "__main__":
    main()
