"""Draws the rooms of framework/ and who includes whom, from the includes.

    python3 docs/make_house.py > docs/pictures/house.svg

A row is a room, the lowest at the foot; a square says that a file of it includes a header of the
column's room, the darker the more different headers. All squares lie left of the diagonal: no room
uses one above it. `tests/lint/rooms.py` holds the order and compares the picture.
"""

import os
import re
import sys

ROOT = os.environ.get("srcdir") or os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CELL, LEFT, TOP = 24, 110, 100


def order():
    with open(os.path.join(ROOT, "tests/lint/rooms.py"), encoding="utf-8") as file:
        return re.search(r'ROOMS = """([^"]*)"""', file.read())[1].split()


def headers_used(room, rooms):
    """By room: the different headers of it that files of `room` include."""
    used = {}
    folder = os.path.join(ROOT, "framework", room)
    for name in sorted(os.listdir(folder)):
        if name.endswith((".c", ".h")):
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                for target in re.findall(r'^#include "(\w+)/(\w+\.h)"', file.read(), re.MULTILINE):
                    if target[0] in rooms and target[0] != room:
                        used.setdefault(target[0], set()).add(target[1])
    return {other: len(names) for other, names in used.items()}


def text(x, y, words, more=""):
    return f'<text x="{x}" y="{y}" {more}>{words}</text>'


def drawn(rooms):
    size = CELL * len(rooms)
    yield (f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + size + 60}" '
           f'height="{TOP + size + 10}" font-family="sans-serif" font-size="13">')
    yield "<title>Rooms of framework/ (rows) and the rooms whose headers they include</title>"
    yield '<rect width="100%" height="100%" fill="white"/>'
    for column, room in enumerate(rooms):
        x = LEFT + CELL * column
        yield text(0, 0, room, f'transform="translate({x + 16} {TOP - 8}) rotate(-60)"')
    for row, room in enumerate(reversed(rooms)):
        y, own = TOP + CELL * row, len(rooms) - 1 - row
        yield text(LEFT - 8, y + 17, room, 'text-anchor="end"')
        used = headers_used(room, rooms)
        for column, other in enumerate(rooms):
            x, count = LEFT + CELL * column, used.get(other, 0)
            fill = "#d0d0d0" if column == own else \
                "white" if count == 0 else ("#b5cde6", "#6f9fd0", "#2f6fae")[min(count, 3) - 1]
            if column > own and count:
                fill = "#c0392b"
            yield (f'<rect x="{x}" y="{y}" width="{CELL}" height="{CELL}" fill="{fill}" '
                   'stroke="#e4e4e4"/>')
            if count:
                ink = "#24476b" if count == 1 else "white"
                yield text(x + CELL // 2, y + 17, count, f'text-anchor="middle" fill="{ink}"')
    yield "</svg>"


def picture():
    return "\n".join(drawn(order())) + "\n"


if __name__ == "__main__":
    sys.stdout.write(picture())
