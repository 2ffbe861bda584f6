"""A room includes only headers of the rooms below it; a plugin only public ones."""

import os
import re
import sys

import tap

# The one place where the order is written, lowest first.
ROOMS = """base exact catalogue unit tree expression descriptor registry random scene field
schedule material quantity store run bench study embed report conformance command""".split()

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def room_findings(path, room):
    for _, target in INCLUDE.findall(tap.read(path)):
        other = target.split("/")[0]
        if target.startswith("gamut/") or other not in ROOMS:
            continue
        if ROOMS.index(other) > ROOMS.index(room):
            yield f"{path} includes {target}, which stands above {room}"


def private_findings(path, room):
    for _, target in INCLUDE.findall(tap.read(path)):
        other, _, name = target.partition("/")
        if name.endswith("_private.h") and (other != room or name != f"{room}_private.h"):
            yield f"{path} includes {target}, which is private to {other}"


def relative_findings(path):
    for mark, target in INCLUDE.findall(tap.read(path)):
        if mark != '"':
            continue
        if ".." in target.split("/") or not os.path.exists(
            os.path.join(tap.ROOT, "framework", target)
        ):
            yield f"{path} includes \"{target}\": paths are relative to framework/"


def plugin_findings(path):
    folder = "/".join(path.split("/")[:3])
    for mark, target in INCLUDE.findall(tap.read(path)):
        own = os.path.join(tap.ROOT, folder, target)
        if mark == '"' and not target.endswith(".gamut.h") and not os.path.exists(own):
            yield f"{path} includes \"{target}\", not a file of {folder}"
        if mark == "<" and target.split("/")[0] in ROOMS:
            yield f"{path} includes <{target}>, a private header"


def public_findings(path):
    for mark, target in INCLUDE.findall(tap.read(path)):
        if mark == '"':
            yield f"{path} includes \"{target}\": public headers include <gamut/...>"


sources = tap.files("framework", suffixes=(".c", ".h"))
rooms = sorted({path.split("/")[1] for path in sources} - {"include"})
tap.check("every room has its place in the order",
          [f"framework/{room} is not listed in tests/lint/rooms.py"
           for room in rooms if room not in ROOMS])
for room in rooms:
    own = [path for path in sources if path.startswith(f"framework/{room}/")]
    if room in ROOMS:
        tap.check(f"{room} uses only rooms below it",
                  [f for path in own for f in room_findings(path, room)])
    tap.check(f"{room} has private headers of its own only",
              [f for path in own for f in private_findings(path, room)])
    tap.check(f"{room} names headers from framework/",
              [f for path in own for f in relative_findings(path)])
sys.path.insert(0, os.path.join(tap.ROOT, "docs"))
import make_house  # noqa: E402

tap.check("the picture of the rooms is that of the includes",
          [] if make_house.picture() == tap.read("docs/pictures/house.svg") else
          ["make it anew: python3 docs/make_house.py > docs/pictures/house.svg"])
tap.check("public headers use only public headers",
          [f for path in sources if path.startswith("framework/include/")
           for f in public_findings(path)])
tap.check("plugins use only public headers and their own",
          [f for path in tap.files("plugins", suffixes=(".c", ".h"))
           for f in plugin_findings(path)])
tap.done()
