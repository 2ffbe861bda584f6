"""Large but legal scene files: each must be read, or refused, in a time that grows with their length.
Usage: big_scenes.py FOLDER [SHARE], where SHARE (1) is the part of the full length."""
import os
import sys

HEAD = """gamut: 1
include: [materials/copper.yaml]
solver: {model: material_point_method, geometry: 1d, cell: 1 mm, end: 1 us}
"""
BODY = "bodies: {b: {material: copper, shape: {box: {size: [5 mm]}}}}\n"
BAR = """gamut: 1
include: [materials/7075.yaml]
solver: {model: gamut_bar, bonds: %d}
bodies: {bar: {material: al7075, length: 100 mm, area: 100 mm2}}
"""


def many(before, item, n, after):
    return before + ", ".join(item(i) for i in range(n)) + after


def scenes(share=1.0):
    def n(full):
        return max(1, round(full * share))

    return {
        "unknown_body_keys": many(HEAD + "bodies: {b: {", lambda i: f"k{i}: 1", n(190000), "}}\n"),
        "bodies": many(
            HEAD + "bodies: {",
            lambda i: f"b{i}: {{material: copper, shape: {{box: {{min: [{3 * i} mm], "
                      f"max: [{3 * i + 2} mm]}}}}}}", n(20000), "}\n"),
        "unknown_fields": many(HEAD + BODY + "outputs: {every: 1 us, fields: [",
                               lambda i: f"v{i}", n(190000), "]}\n"),
        "quantities": many(HEAD + BODY + "quantities: {",
                           lambda i: f"q{i}: {{measure: extent, axis: x}}", n(60000), "}\n"),
        "misspelt_quantities": many(HEAD + BODY + "quantities: {",
                                    lambda i: f"q{i}: {{measure: extnt, axis: x}}", n(60000),
                                    "}\n"),
        "effects": many(HEAD + BODY + "effects: {",
                        lambda i: f"e{i}: {{model: gravity, acceleration: [1 m/s2]}}", n(40000),
                        "}\n"),
        "union": many(HEAD + "bodies: {b: {material: copper, shape: {union: [",
                      lambda i: f"{{box: {{min: [{i} mm], max: [{i + 1} mm]}}}}", n(30000),
                      "]}}}\n"),
        "bar_of_1e7_bonds": BAR % n(10000000),
    }


def write(folder, share=1.0):
    os.makedirs(folder, exist_ok=True)
    paths = {}
    for name, text in scenes(share).items():
        paths[name] = os.path.join(folder, name + ".yaml")
        with open(paths[name], "w", encoding="ascii") as file:
            file.write(text)
    return paths


if __name__ == "__main__":
    write(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 1.0)
