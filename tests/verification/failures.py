"""Runs whose numbers fail: exit 5, and which point, where, in what state; the last state is kept.
Prints TAP."""
import json
import os
import re

import scenes

STEPS = (("taylor_bar", "0.5 us"), ("taylor_bar", "0.12 us"), ("taylor_bar", "0.08 us"),
         ("taylor_bar_3d", "1 us"), ("taylor_bar_3d", "0.3 us"), ("plate_impact", "50 ns"),
         ("vibrating_bar", "0.2 s"), ("vibrating_bar", "0.06 s"), ("sod", "10 ms"), ("sod", "4 ms"),
         ("taylor_bar_benchmark", "0.1 us"))
POINT = re.compile(r"\bpoint \d+ of body '\w+'", re.IGNORECASE)
STATE = re.compile(r"position (\S+ ){3}m; velocity (\S+ ){3}m/s; volume_ratio \S+ ?; "
                   r"stress (\S+ ){6}Pa\b", re.IGNORECASE)


def fails(name, scene, changes, words):
    process, folder = scenes.attempt(scene, changes)
    said = process.stderr
    missing = [w for w in words if w not in said]
    if not POINT.search(said):
        missing.append("which point")
    if not STATE.search(said):
        missing.append("its place and state")
    if not re.search(r"at t = \S+ s, step \d+", said):
        missing.append("time and step")
    scenes.report(process.returncode == 5 and not missing, f"{name}: exit 5, the point is named",
                  [f"exit {process.returncode}, missing: {missing}", said[-1500:]])
    summary = os.path.join(folder, "summary.json")
    if os.path.exists(summary):
        with open(summary, encoding="utf-8") as text:
            status = json.load(text)["status"]
    else:
        status = "no summary"
    frames = os.path.exists(os.path.join(folder, "results.h5"))
    scenes.report(status == "failed" and frames, f"{name}: the summary says so, the last state is "
                                                 "kept", [status, frames])


for scene, step in STEPS:
    fails(f"{scene} with a forced step of {step}", scene, {"solver.step": step}, ("step",))
fails("a bar that leaves the domain at its foot", "taylor_bar",
      {"solver.domain": "{min: [-1 mm, 0 mm], max: [4 mm, 30 mm]}"}, ("left the domain", "'bar'"))
fails("a plate that leaves the domain", "plate_impact",
      {"solver.domain": "{min: [-1 mm], max: [20.2 mm]}"}, ("left the domain", "'target'"))
fails("a bar in three dimensions that leaves the domain", "taylor_bar_3d",
      {"solver.domain": "{min: [-4 mm, 0 mm, -4 mm], max: [4 mm, 30 mm, 4 mm]}"},
      ("left the domain", "'bar'"))
fails("plates at 200 km/s", "plate_impact", {"bodies.flyer.velocity": "[200 km/s]"},
      ("mie_gruneisen", "pole"))
scenes.done()
