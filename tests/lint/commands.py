"""A page of results that shows figures in a table names the command in the tree that they come
from, before the first of them, and every file that a page names is there."""

import re

import tap

NAMED = re.compile(r"(?<![\w/.])"
                   r"(?:tests|docs|inputs|plugins|framework)/[\w/.]+\.(?:py|sh|yaml|c|h)\b")
# "inputs/NAME.yaml" and "test_x.c" stand for a name.
ANY = re.compile(r"[A-Z]{4}|_x\.")
FIGURES = re.compile(r"^\|[^`\n]*\d", re.MULTILINE)
# Where to look, not what was measured.
INDEX = ("docs/results/README.md", "docs/results/faults.md")


def command_first(path):
    """Whether a script is named before the first row with a figure."""
    text = tap.read(path)
    figure, command = FIGURES.search(text), NAMED.search(text)
    return figure is None or (command is not None and command.start() < figure.start())


def not_there(path):
    return [f"{path} names {name}" for name in sorted(set(NAMED.findall(tap.read(path))))
            if not ANY.search(name) and not tap.os.path.exists(tap.os.path.join(tap.ROOT, name))]


pages = [p for p in tap.files("docs", suffixes=(".md",)) if "/results/" in p]
tap.check("figures of results stand behind the command that makes them",
          [p for p in pages if p not in INDEX and not command_first(p)])
tap.check("files that the documents name are there",
          [f for p in [*tap.files("docs", suffixes=(".md",)), "README.md", "CONTRIBUTING.md"]
           for f in not_there(p)])
tap.done()
