"""Large scenes are read, or refused, in a time that grows with their length: within a limit of processor
time, and twice the length takes less than three times as long. Prints TAP.

With --seconds it prints what each takes instead (see tests/bench/reading.sh)."""
import os
import resource
import subprocess
import sys
import tempfile

import big_scenes

HERE = os.path.dirname(os.path.abspath(__file__))
GAMUT = os.environ.get("GAMUT", os.path.join(HERE, "../../build/gamut"))
LIMIT = 20  # s of processor time
RATIO = 3.0
START = 0.25  # s: below it what a program takes to begin says nothing of the length


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 1))


def seconds(scene):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([GAMUT, "--no-user-plugins", "check", scene], preexec_fn=limits,
                          stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, used, len(done.stderr.splitlines())


def main():
    full = sys.argv[1:] == ["--seconds"]
    count = failures = 0
    with tempfile.TemporaryDirectory() as folder:
        half = big_scenes.write(os.path.join(folder, "half"), 0.5)
        whole = big_scenes.write(os.path.join(folder, "whole"))
        for name, scene in whole.items():
            code, long, lines = seconds(scene)
            if full:
                print(f"{name:22s} exit {code}  {long:5.2f} s")
                continue
            short = seconds(half[name])[1]
            ratio = long / max(short, START)
            good = code in (0, 3) and long < LIMIT and ratio < RATIO and lines < 300
            count += 1
            failures += not good
            print(("ok" if good else "not ok") + f" {count} - {name}: exit {code}, {long:.2f} s "
                  f"(at most {LIMIT}), {ratio:.2f} times that of half (below {RATIO:g}), "
                  f"{lines} lines of errors (below 300)")
            sys.stdout.flush()
    if not full:
        print(f"1..{count}")
    sys.exit(failures > 0)


main()
