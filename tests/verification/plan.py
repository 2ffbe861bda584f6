"""What `gamut explain` says is what happens: bytes as allocated, only the plugins that a scene
names opened, nothing stored that nobody asked for. Prints TAP."""
import json
import os
import re
import subprocess

import scenes

ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1"}
IDS_AND_SORTING = 16  # bytes a point beside the fields


def explain(name, changes=None, environment=None):
    arguments = [scenes.GAMUT, "explain", scenes.scene(name), "--json", "--no-user-plugins"]
    for path, value in (changes or {}).items():
        arguments += ["--set", f"{path}={value}"]
    done = subprocess.run(arguments, capture_output=True, text=True, check=False, timeout=300,
                          env={**ENVIRONMENT, **(environment or {})})
    return (json.loads(done.stdout) if done.returncode == 0 else {}), done.stderr


def resident(name, changes):
    """Largest memory of the whole process of `explain`, by the kernel, and the bytes told."""
    arguments = [scenes.GAMUT, "explain", scenes.scene(name), "--json", "--no-user-plugins"]
    for path, value in changes.items():
        arguments += ["--set", f"{path}={value}"]
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               env=ENVIRONMENT)
    told = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return used.ru_maxrss * 1024, json.loads(told)["bytes"]


def test_sums(name):
    plan, _ = explain(name)
    memory = plan["memory"]
    stored = [f for f in plan["fields"] if f["kept"] == "stored"]
    scenes.report(sum(memory.values()) == plan["bytes"],
                  f"{name}: the parts add up to {plan['bytes']} bytes")
    a_number = {memory[f["name"]] / f["components"] for f in stored}
    scenes.report(len(a_number) == 1 and min(a_number) >= 8 * plan["points"],
                  f"{name}: {len(stored)} stored fields, each {min(a_number):.0f} bytes a "
                  f"component for {plan['points']} points", sorted(a_number))
    declared = sum(f["bytes_per_point"] for f in stored) + IDS_AND_SORTING
    scenes.report(declared == plan["declared_bytes_per_point"],
                  f"{name}: {declared} bytes a point in fields, ids and sorting")
    others = [f["name"] for f in plan["fields"] if f["kept"] != "stored" and f["name"] in memory]
    scenes.report(not others, f"{name}: no memory for a field that is not stored", others)


def test_run():
    """A run of as many steps as `explain` tries has the same peak."""
    fixed = {"solver.step": "10 ns", "solver.end": "50 ns", "outputs": "{frames: 1}"}
    plan, _ = explain("taylor_bar", fixed)
    cost = scenes.run("taylor_bar", fixed).summary["cost"]
    ratio = cost["peak_bytes"] / plan["bytes"]
    scenes.report(0.999 <= ratio <= 1.06, f"taylor_bar: peak of a run over what explain says "
                                          f"{ratio:.4f} (1 to 1.06)")


def test_kernel():
    """The growth of the process from a small to a large body, against the growth that is told. What
    stands in memory twice for a moment (arrays that grow) makes the first the larger. The kernel
    hands on the peak of the calling Python: even the small body must need more."""
    small, large = (resident("taylor_bar_3d", {"solver.cell": f"{cell} mm"})
                    for cell in (0.381, 0.28))
    grown, said = large[0] - small[0], large[1] - small[1]
    scenes.report(0.95 <= grown / said <= 1.2,
                  f"taylor_bar_3d: the process grows by {grown / 1e6:.1f} MB where "
                  f"{said / 1e6:.1f} MB are told (0.95 to 1.2 of it)")


def opened(said):
    """Plugins whose shared object the dynamic linker loaded."""
    found = set()
    for path in re.findall(r"file=(\S+\.so)\b[^\n]*generating link map", said):
        parts = path.split("/")
        if len(parts) > 3 and parts[-1].split(".")[0] == parts[-2]:
            found.add("/".join(parts[-3:-1]))
    return found


def test_opened(name, expected):
    plan, said = explain(name, environment={"LD_DEBUG": "files"})
    scenes.report(set(plan.get("plugins", ())) == expected,
                  f"{name}: {len(expected)} plugins are named", plan.get("plugins"))
    loaded = opened(said)
    scenes.report(loaded == expected, f"{name}: the linker loads just these", sorted(loaded))


def test_unused():
    off = {"effects.heat.enabled": "off", "effects.viscosity.enabled": "off",
           "outputs.fields": "[velocity]"}
    full, _ = explain("taylor_bar")
    less, _ = explain("taylor_bar", off)
    live = [t["name"] for t in less["tasks"] if t["live"]]
    scenes.report("heat" not in live and "viscosity" not in live, "effects that are off do not run",
                  live)
    for plugin in ("effect/adiabatic_heating", "effect/artificial_viscosity"):
        scenes.report(plugin in full["plugins"] and plugin not in less["plugins"],
                      f"{plugin} is opened only where it is on", less["plugins"])
    scenes.report(less["bytes"] < full["bytes"],
                  f"{full['bytes']} bytes become {less['bytes']} with both off")


for each in ("taylor_bar", "plate_impact", "taylor_bar_3d"):
    test_sums(each)
test_run()
test_kernel()
METHOD = {"solver/material_point_method", "elasticity/hypoelastic"}
test_opened("sod", METHOD | {"eos/ideal_gas", "effect/boundary", "effect/artificial_viscosity"})
test_opened("vibrating_bar", METHOD | {"eos/linear", "effect/boundary"})
test_opened("taylor_bar", METHOD | {"eos/mie_gruneisen", "strength/johnson_cook",
                                    "effect/rigid_wall", "effect/adiabatic_heating",
                                    "effect/artificial_viscosity"})
test_unused()
scenes.done()
