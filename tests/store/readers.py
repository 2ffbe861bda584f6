"""Every output is opened: by h5py, by an XML parser, and by ParaView's readers where they are
installed (pvpython, or PVPYTHON says which; else a Python with VTK). Prints TAP."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

HERE = os.path.dirname(os.path.abspath(__file__))
for folder in ("../verification", "../scenes"):
    sys.path.insert(0, os.path.join(HERE, folder))
import scenes  # noqa: E402  before h5py and numpy: it skips the test where they are missing
import short  # noqa: E402
import h5py  # noqa: E402
import numpy  # noqa: E402

TEXTS = ("scene", "summary")
CLOSE = 1e-12


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def bodies(frame):
    """Those that have points; the others are not in the XDMF."""
    return {name: body for name, body in frame.items() if len(body["id"]) > 0}


def without_unit(file):
    wrong = []

    def look(name, item):
        if isinstance(item, h5py.Dataset) and name not in TEXTS:
            item[()]
            if item.dtype.kind in "fi" and not text(item.attrs.get("unit", "")):
                wrong.append(name)
    file.visititems(look)
    return wrong


def wrong_frames(file):
    wrong, last = [], -1.0
    for number, key in enumerate(sorted(file["frames"])):
        frame = file["frames"][key]
        good = key == f"{number:08d}" and frame.attrs["time"] > last and frame.attrs["step"] >= 0
        last = frame.attrs["time"]
        for name, body in frame.items():
            count = len(body["id"])
            good &= body["position"].shape == (count, 3) and len(set(body["id"][:])) == count
            good &= all(len(data) == count and text(data.attrs["meaning"])
                        for data in body.values())
        if not good:
            wrong.append(key)
    return wrong


def wrong_items(root, file):
    """Items of the XDMF that are not whole datasets of the stated size and type."""
    wrong, items = [], 0
    for item in root.iter("DataItem"):
        items += 1
        name, path = item.text.strip().split(":", 1)
        stated = tuple(int(n) for n in item.get("Dimensions").split())
        data = file.get(path)
        if (name != "results.h5" or data is None or data.shape != stated
                or data.dtype.kind != {"Float": "f", "Int": "i"}[item.get("NumberType")]
                or data.dtype.itemsize != int(item.get("Precision"))):
            wrong.append(f"{item.text}: stated {stated}, found {data}")
    return wrong, items


def wrong_grids(root, file):
    """What the XDMF says of frames, bodies and arrays against what is in the file."""
    wrong, found = [], root.findall("Domain/Grid/Grid")
    keys = sorted(file["frames"])
    if len(found) != len(keys):
        return [f"{len(found)} grids, {len(keys)} frames"]
    for grid, key in zip(found, keys):
        frame = file["frames"][key]
        if float(grid.find("Time").get("Value")) != frame.attrs["time"]:
            wrong.append(f"time of {key}")
        there = {g.get("Name"): {a.get("Name") for a in g.findall("Attribute")}
                 for g in grid.findall("Grid")}
        if there != {n: set(b) - {"position"} for n, b in bodies(frame).items()}:
            wrong.append(f"{key}: {there}")
    return wrong


def check_files(name, folder, study):
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        wrong = without_unit(file)
        scenes.report(not wrong, f"{name}: h5py reads all of it, every number has a unit", wrong)
        if study:
            scenes.report("frames" not in file or len(file["frames"]) == 0,
                          f"{name}: a study has no frames")
            return
        wrong = wrong_frames(file)
        scenes.report(not wrong, f"{name}: {len(file['frames'])} frames are whole", wrong)
        root = tree.parse(os.path.join(folder, "results.xdmf")).getroot()
        wrong, items = wrong_items(root, file)
        wrong += wrong_grids(root, file)
        scenes.report(not wrong, f"{name}: {items} items of the XDMF are as stated", wrong)


def mark_of(data):
    """As look.py adds up: the sum, and the sum of absolute values to measure its error by."""
    numbers = numpy.asarray(data[:], dtype=float).ravel()
    factor = 1 + numpy.arange(numbers.size) % 97
    return float((numbers * factor).sum()), float((abs(numbers) * factor).sum())


def off(seen, data):
    """How far a reader's sum of an array lies off; infinite where it has another shape."""
    points, columns, mark = seen
    own, scale = mark_of(data)
    shape = (points,) if len(data.shape) == 1 else (points, columns)
    return abs(mark - own) / max(scale, 1e-300) if shape == data.shape else float("inf")


def compare_frame(seen, frame, order):
    """Faults and the largest relative error of one frame. Some readers give pieces no names: they
    are in the order of the XDMF."""
    wrong, worst, own = [], 0.0, bodies(frame)
    if len(seen) != len(own):
        return [f"{len(seen)} pieces, {len(own)} bodies"], 0.0
    for place, (name, told) in enumerate(seen):
        body = own.get(name or order[place])
        if body is None:
            return [f"a piece '{name}'"], 0.0
        count = len(body["id"])
        if (told["points"], told["cells"]) != (count, count) or told["precision"] != 8:
            wrong.append(f"{told['points']} points, {told['cells']} cells of {count}, "
                         f"{told['precision']} bytes a number")
        if set(told["arrays"]) != set(body) - {"position"}:
            wrong.append(f"arrays {sorted(told['arrays'])}")
            continue
        errors = [off(told["arrays"][key], body[key]) for key in told["arrays"]]
        worst = max([worst, *errors, off([count, 3, told["place"]], body["position"])])
    return wrong, worst


def compare(told, folder):
    wrong, worst = [], 0.0
    grids = tree.parse(os.path.join(folder, "results.xdmf")).getroot().findall("Domain/Grid/Grid")
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        keys = sorted(file["frames"])
        times = [float(file["frames"][key].attrs["time"]) for key in keys]
        if told["times"] != times:
            return [f"times {told['times']}"], 0.0
        for seen, key, grid in zip(told["frames"], keys, grids):
            order = [body.get("Name") for body in grid.findall("Grid")]
            faults, error = compare_frame(seen, file["frames"][key], order)
            wrong += [f"{key}: {fault}" for fault in faults]
            worst = max(worst, error)
    return wrong, worst


def viewer():
    """The command that runs look.py, or null and why there is none."""
    named = os.environ.get("PVPYTHON") or shutil.which("pvpython")
    if named:
        return [named]
    done = subprocess.run([sys.executable, "-c", "import vtkmodules.vtkIOXdmf2"], check=False,
                          stderr=subprocess.DEVNULL)
    return [sys.executable] if done.returncode == 0 else None


def check_viewer(folders):
    command = viewer()
    if command is None:
        scenes.report(True, "ParaView opens them # SKIP no pvpython, no VTK")
        return
    done = subprocess.run([*command, os.path.join(HERE, "look.py"), *folders.values()],
                          check=False, capture_output=True, text=True,
                          env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
    lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    scenes.report(done.returncode == 0 and lines, "the readers end well",
                  [done.stderr[-2000:]])
    for name, folder in folders.items():
        for told in lines:
            if told["folder"] != folder:
                continue
            wrong, worst = compare(told, folder)
            scenes.report(not wrong and worst <= CLOSE,
                          f"{name}: {told['version']}, {told['reader']}: {len(told['frames'])} "
                          f"frames, numbers off by {worst:.1e} (allowed {CLOSE:g})", wrong)


def run(name, path, settings, scratch):
    folder = os.path.join(scratch, name)
    words = [word for setting in settings for word in ("--set", setting)]
    done = subprocess.run([scenes.GAMUT, "run", path, "-o", folder, "--threads", "1",
                           "--no-user-plugins", *words], check=False, capture_output=True,
                          text=True)
    return folder if scenes.report(done.returncode == 0, f"{name} runs", [done.stderr]) else None


# A block that flies out of the run beside one that stays.
LEAVING = os.path.join(scenes.TREE, "plugins/effect/outflow/outflow.scene.yaml")
FRAMES = ["outputs={every: 1 us, fields: [velocity, stress]}", "solver.end=25 us"]


def check_leaving(folder):
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        counts = [[len(file["frames"][key][name]["id"]) for name in ("block", "still")]
                  for key in sorted(file["frames"])]
    scenes.report(counts[0] == [256, 64] and counts[-1] == [0, 64]
                  and any(0 < block < 256 for block, _ in counts),
                  f"points leave the run: {counts[0]} to {counts[-1]}", counts)


def main():
    folders = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, path, scene, settings in short.scenes():
            folder = run(name, path, settings, scratch)
            if folder:
                check_files(name, folder, short.is_study(scene))
                if not short.is_study(scene):
                    folders[name] = folder
        folders["outflow"] = run("outflow", LEAVING, FRAMES, scratch)
        check_files("outflow", folders["outflow"], False)
        check_leaving(folders["outflow"])
        sample = os.path.join(scenes.TREE if "builddir" not in os.environ
                              else os.environ["builddir"], "tests/unit/test_store")
        for name, words in (("sample", []), ("points that go", ["shrinking"])):
            folder = os.path.join(scratch, name.replace(" ", "_"))
            subprocess.run([sample, folder, *words], check=False, stdout=subprocess.DEVNULL)
            check_files(name, folder, False)
            folders[name] = folder
        check_viewer(folders)
    scenes.done()


main()
