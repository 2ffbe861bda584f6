"""The ledger closes in all four rounding modes of the processor, for scenes of every solver and
scheme, and the figures stay. The mode is set in each thread before the program begins. Prints
TAP."""
import os
import shlex
import subprocess
import sys

import scenes

MODES = ("nearest", "downward", "upward", "toward zero")
CODE = """#include <fenv.h>
#include <stdlib.h>
__attribute__((constructor)) static void set(void)
{
  static const int mode[] = {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO};
  const char *number = getenv("ROUNDING");
  fesetround(mode[number ? atoi(number) : 0]);
}
"""
SHORT = {"outputs.frames": "1"}
CASES = [("plate_impact", {"solver.end": "1.9 us"}, "plateau_pressure"),
         ("plate_impact", {"solver.end": "1.9 us", "solver.shape": "linear"}, "plateau_pressure"),
         ("plate_impact", {"solver.end": "1.9 us", "solver.shape": "gimp",
                           "solver.stress_update": "musl"},
          "plateau_pressure"),
         ("plate_impact", {"solver.end": "1.9 us",
                           "solver.transfer": "{model: xpic, order: 3}"}, "plateau_pressure"),
         ("sod", {}, None), ("vibrating_bar", {"solver.end": "20 us"}, None),
         ("taylor_bar", {"solver.end": "5 us"}, None),
         ("taylor_bar_benchmark", {"solver.end": "5 us", "solver.shape": "cubic"}, None),
         ("colliding_disks", {"solver.end": "0.1 s"}, None),
         ("rotating_block", {"solver.end": "1 us"}, None),
         ("driver_johnson_cook", {}, None), ("bar_ti64", {}, None)]


def library():
    source = os.path.join(scenes.SCRATCH, "rounding.c")
    with open(source, "w", encoding="utf-8") as file:
        file.write(CODE)
    made = os.path.join(scenes.SCRATCH, "rounding.so")
    subprocess.run([*shlex.split(os.environ.get("CC", "cc")), "-shared", "-fPIC", "-o", made,
                    source, "-lm"], check=True)
    return made


def check(scene, changes, quantity):
    name = " ".join([scene, *(c for k, c in changes.items() if k != "solver.end")])
    values = []
    for mode, word in enumerate(MODES):
        scenes.PATIENT["ROUNDING"] = str(mode)
        process, folder = scenes.attempt(scene, changes)
        if not scenes.report(process.returncode == 0,
                             f"{name}, rounding {word}: exit {process.returncode}",
                             [process.stderr[-1500:]]):
            continue
        result = scenes.read(folder, process)
        scenes.below(f"{name}, rounding {word}: residual of the ledger", result.residual(), 1e-10)
        if quantity:
            values.append(result.value(quantity))
        scenes.drop(result)
    if quantity:
        spread = max(values) / min(values) - 1.0
        scenes.below(f"{name}: {quantity} over the modes", spread, 1e-6)


if sys.platform != "linux":
    print("1..0 # SKIP the dynamic linker takes no LD_PRELOAD here")
    sys.exit(77)
scenes.PATIENT["LD_PRELOAD"] = library()
for case in CASES:
    check(*case)
scenes.done()
