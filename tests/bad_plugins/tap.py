"""TAP of the tests of bad plugins: one line a check; what was said only where it failed."""
import sys

results = []


def report(passed, name, *notes):
    results.append(bool(passed))
    print(("ok" if passed else "not ok") + f" {len(results)} - {name}")
    for note in notes if not passed else ():
        for line in str(note).splitlines():
            print("#   " + line)
    sys.stdout.flush()


def finish():
    """Prints the plan; returns the exit code."""
    print(f"1..{len(results)}")
    return 0 if all(results) else 1
