"""Python modules that a script cannot do without: where one is missing it is skipped, with the
exit code that says so. To be called before they are imported."""
import importlib.util
import sys

SKIPPED = 77


def modules(*names):
    missing = [name for name in names if importlib.util.find_spec(name) is None]
    if missing:
        print(f"1..0 # SKIP not installed: {', '.join(missing)}")
        sys.exit(SKIPPED)
