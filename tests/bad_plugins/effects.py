"""Effects that bring no scene of their own: `gamut verify` tries them in the usual one, and refuses
those that cannot run there or need what nobody provides. Prints TAP."""
import os
import shutil
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

ROOT = kernels.ROOT
YAML = """plugin: effect/{name}
version: "1.0"
summary: an effect for a test
source: [by hand]
{more}"""
SHIPPED = ("gravity", "adiabatic_heating", "spall", "artificial_viscosity")
def line_of(said):
    lines = [line for line in said.splitlines() if "are tried in runs to its end" in line]
    return lines[0] if lines else ""


def shipped(root):
    """Effects of the tree without their scenes run in the usual one."""
    for name in SHIPPED:
        source = os.path.join(ROOT, "plugins/effect", name)
        folder = os.path.join(root, "effect", name)
        objects = os.path.join(os.path.dirname(kernels.GAMUT), "plugins/effect", name)
        os.makedirs(folder)
        shutil.copy(os.path.join(source, name + ".yaml"), folder)
        for place in (objects, os.path.join(objects, ".libs")):
            if os.path.exists(os.path.join(place, name + ".so")):
                shutil.copy(os.path.join(place, name + ".so"), folder)
        code, said = kernels.gamut(["verify", "./effect/" + name], root)
        report(code == 0 and line_of(said).startswith("ok"),
               f"{name} without its scene: exit {code}",
               said)


KERNEL = """#include "{name}.gamut.h"
static void push(const struct {name} *b)
{{
  for (size_t i = 0; i < b->count; i++)
    b->external_force[0][i] += {value};
}}
GAMUT_EFFECT({name}, .push = push)
"""


def tried(root, name, more, reads, value="0"):
    task = (f"outputs: [external_force]\ntasks:\n  - {{kernel: push, phase: forces, "
            f"reads: [{reads}], adds: [external_force]}}\n")
    kernels.write(root, "effect", name, YAML.format(name=name, more=more + task),
                  KERNEL.format(name=name, value=value))
    return kernels.gamut(["verify", "./effect/" + name], root)


def written(root):
    code, said = tried(root, "pushes", "inputs: [mass]\n", "mass", "b->mass[i] * 10")
    report(code == 0 and line_of(said).startswith("ok"), f"an effect that runs: exit {code}", said)
    wrong = {
        "reads_flow_stress": ("inputs: [flow_stress]\n", "flow_stress", "flow_stress"),
        "reads_slope": ("inputs: [mass, pressure_slope_energy]\n", "mass, pressure_slope_energy",
                        "pressure_slope_energy"),
        "reads_compression": ("inputs: [compression]\n", "compression", "compression"),
        "wants_provider": ("inputs: [mass]\nrequires: [chemistry]\n", "mass", "chemistry"),
    }
    for name, (more, reads, word) in wrong.items():
        code, said = tried(root, name, more, reads)
        report(code == 4 and line_of(said).startswith("not ok") and word in said,
               f"{name}: exit {code}, {word} named", said)


def main():
    with tempfile.TemporaryDirectory() as root:
        shipped(root)
        written(root)
    done()


if __name__ == "__main__":
    main()
