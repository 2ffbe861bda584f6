"""Runs the tests of closed forms and writes docs/results/exact_solutions.md: what each measured
beside what is allowed.

    GAMUT=build/gamut python3 docs/results/exact_solutions.py
"""
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.join(HERE, "../../tests/verification")
HEAD = """# Exact solutions

Runs beside closed forms, which [the theory](../theory/exact_solutions.md) derives; what is allowed
follows from there. Each figure is also held by `make check`. Made by

    GAMUT=build/gamut python3 docs/results/exact_solutions.py
"""
PARTS = (("exact_flows.py", "Material that flies apart or together"),
         ("exact_points.py", "A point that tears or is heated; the axis"),
         ("exact_solutions.py", "Shells and bars"),
         ("exact_transfers.py", "Transfers and steps"))


def rows(script):
    """(what, measured, allowed) of each check, from its line of TAP."""
    said = subprocess.run([sys.executable, os.path.join(TESTS, script)], capture_output=True,
                          text=True, check=True).stdout
    for line in said.split("\n"):
        found = re.match(r"ok \d+ - (.*?): ([^:]*?)(?: \((allowed |at least )(.*)\))?$", line)
        if found:
            name, figure, word, limit = found.groups()
            allowed = "" if limit is None else word.replace("allowed ", "") + limit
            yield name.strip(), figure, allowed


def page():
    lines = [HEAD]
    for script, title in PARTS:
        lines += [f"## {title}", "", f"`tests/verification/{script}`", "",
                  "| what | measured | allowed |", "|---|---|---|"]
        lines += [f"| {' | '.join(cell.replace('|', '/') for cell in row)} |"
                  for row in rows(script)]
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    text = page()
    with open(os.path.join(HERE, "exact_solutions.md"), "w", encoding="utf-8") as file:
        file.write(text)
