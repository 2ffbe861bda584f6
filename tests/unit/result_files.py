"""The files of a result as other programs see them: HDF5 by h5py, XDMF by an XML parser."""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import needs  # noqa: E402

needs.modules("h5py", "numpy")
import h5py  # noqa: E402
import numpy  # noqa: E402

checks = 0
failures = 0


def ok(passed, name):
    global checks, failures
    checks += 1
    failures += not passed
    print(f"{'' if passed else 'not '}ok {checks} - {name}")


def check_items(domain, results):
    """Every item of the XDMF is a whole dataset with the dimensions it states."""
    items = wrong = 0
    for item in domain.iter("DataItem"):
        items += 1
        name, path = item.text.strip().split(":", 1)
        stated = tuple(int(number) for number in item.get("Dimensions").split())
        kind = {"Float": "f", "Int": "i"}[item.get("NumberType")]
        data = results.get(path)
        good = (name == "results.h5" and data is not None and data.shape == stated
                and data.dtype.kind == kind and data.dtype.itemsize == int(item.get("Precision")))
        if not good:
            wrong += 1
            print(f"# {item.text}: stated {stated}, found {data}")
    ok(items == 5 * 2 * 7 and wrong == 0, f"{items} XDMF items, {wrong} wrong")


def check_grids(domain):
    times = domain.findall("Grid")
    ok(len(times) == 1 and times[0].get("CollectionType") == "Temporal", "one series in time")
    frames = times[0].findall("Grid")
    ok([float(frame.find("Time").get("Value")) for frame in frames]
       == [20e-6 * n for n in range(5)], "a time for each frame")
    ok(all(frame.get("CollectionType") == "Spatial" for frame in frames), "bodies side by side")
    names = [grid.get("Name") for grid in frames[0].findall("Grid")]
    ok(names == ["bar", "anvil"], f"bodies {names}")
    types = {attribute.get("Name"): attribute.get("AttributeType")
             for attribute in frames[0].find("Grid").findall("Attribute")}
    ok(types == {"id": "Scalar", "plastic_strain": "Scalar", "velocity": "Vector",
                 "stress": "Tensor", "velocity_gradient": "Tensor"}, f"types {types}")


def check_results(results):
    bar = results["frames/00000004/bar"]
    ok(results["frames/00000004"].attrs["time"] == 80e-6
       and results["frames/00000004"].attrs["step"] == 400, "time and step of a frame")
    ok(bar["position"].shape == (960, 3) and numpy.all(bar["position"][:, 2] == 0),
       "position has three columns")
    ok(list(bar["id"][:]) == list(range(960)), "ids")
    units = {name: data.attrs["unit"].decode() if isinstance(data.attrs["unit"], bytes)
             else data.attrs["unit"] for name, data in bar.items()}
    ok(units == {"position": "m", "id": "1", "plastic_strain": "1", "velocity": "m/s",
                 "stress": "Pa", "velocity_gradient": "1/s"}, f"units {units}")
    ok(all("meaning" in data.attrs for data in bar.values()), "every dataset says what it means")
    order = bar["stress"].attrs["components"]
    order = order.decode() if isinstance(order, bytes) else order
    ok(order == "xx xy xz yx yy yz zx zy zz", f"columns of a symmetric tensor: {order}")
    # the sample's k-th component is k + 4 in the order xx yy zz xy yz zx
    factor = numpy.array([4, 7, 9, 7, 5, 8, 9, 8, 6])
    off = numpy.abs(bar["stress"][0] / bar["stress"][0, 0] * 4 / factor - 1).max()
    ok(off < 1e-14, f"each column is what it says, off by {off:.1e} (allowed 1e-14)")
    length = results["quantities/length"]
    ok(list(results["vertices/00000960"][:]) == list(range(960)), "vertices are all points")
    ok(length["time"].shape == (81,) and abs(length["value"][80] - 0.01905) < 1e-16
       and length["value"].attrs["unit"] in ("m", b"m"), "a history")
    ok("summary" in results and "scene" in results, "summary and scene are inside")


def check_table(path):
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    ok(lines[0] == "quantity,unit,time,value" and len(lines) == 1 + 2 * 81, "history.csv")
    name, unit, time, value = lines[81].split(",")
    ok((name, unit) == ("length", "m") and float(time) == 80e-6
       and abs(float(value) - 0.01905) < 1e-16, f"a row: {lines[81]}")


def main():
    program = os.path.join(os.environ.get("builddir", "."), "tests", "unit", "test_store")
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "result")
        done = subprocess.run([program, result], check=False)
        ok(done.returncode == 0, "the sample is written")
        domain = tree.parse(os.path.join(result, "results.xdmf")).getroot().find("Domain")
        with h5py.File(os.path.join(result, "results.h5"), "r") as results:
            check_items(domain, results)
            check_grids(domain)
            check_results(results)
        check_table(os.path.join(result, "history.csv"))
        files = sorted(os.listdir(result))
        ok(files == ["history.csv", "results.h5", "results.xdmf", "scene.yaml", "summary.json"],
           f"files {files}")
    print(f"1..{checks}")
    return failures > 0


sys.exit(main())
