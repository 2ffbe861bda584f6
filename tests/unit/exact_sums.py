"""Exact sums of random values against Python's fsum, in several orders and over several sums."""

import array
import math
import os
import random
import subprocess
import sys
import tempfile

PROGRAM = os.path.join(os.environ.get("builddir", "build"), "tests", "unit", "test_exact")
COUNT = 100_000
STRIDES = (1, COUNT - 1, 61_803)  # none divides COUNT: all values, in three orders
PARTS = (1, 2, 7)
failures = checks = 0


def spread(source, exponents, cancel):
    """Values over so many powers of two; with `cancel` most of them meet their opposite."""
    highest = min(exponents // 2, 1000)
    values = [math.ldexp(source.uniform(-1.0, 1.0), source.randint(highest - exponents, highest))
              for _ in range(COUNT)]
    if cancel:
        half = COUNT // 2
        values[half:] = [-value for value in values[:half]]
        for _ in range(9):
            values[source.randrange(COUNT)] = math.ldexp(source.random(), -source.randrange(1074))
        source.shuffle(values)
    return values


def check(name, values, folder):
    global failures, checks
    path = os.path.join(folder, "values")
    with open(path, "wb") as file:
        array.array("d", values).tofile(file)
    due = math.fsum(values)
    got = [float.fromhex(subprocess.run([PROGRAM, path, str(parts), str(stride)], check=True,
                                        capture_output=True, text=True).stdout)
           for stride in STRIDES for parts in PARTS]
    apart = max(abs(value - due) for value in got)
    checks += 1
    failures += apart != 0.0
    print(f"{'ok' if apart == 0.0 else 'not ok'} {checks} - {name}: {due!r}, "
          f"{len(STRIDES)} orders over {PARTS} sums: {apart:.3g} apart (0 allowed)")


with tempfile.TemporaryDirectory() as scratch:
    for seed, exponents in enumerate((10, 60, 600, 1900, 2000)):
        for cancel in (False, True):
            numbers = spread(random.Random(seed), exponents, cancel)
            low, high = (math.frexp(find(abs(n) for n in numbers if n != 0.0))[1]
                         for find in (min, max))
            check(f"{COUNT} values over {high - low} powers of two"
                  f"{', most with their opposite' if cancel else ''}", numbers, scratch)
print(f"1..{checks}")
sys.exit(1 if failures else 0)
