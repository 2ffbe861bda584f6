"""CSV files: what they may look like, and what is refused with file:line:column. Prints TAP."""
import os
import subprocess
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tap  # noqa: E402
from tap import report  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
GAMUT = os.environ.get("GAMUT", os.path.join(HERE, "../../build/gamut"))
POINTS = """gamut: 1
solver: {model: material_point_method, geometry: plane_strain, cell: 1 mm, end: 1 us}
materials: {m: {density: 8000 kg/m3, eos: {model: linear, bulk_modulus: 100 GPa}}}
bodies: {b: {material: m, shape: {points: {file: p.csv%s}}}}
"""
WIDE = ",".join(f"c{k}" for k in range(100))


def read(folder, text, spacing=True):
    with open(os.path.join(folder, "p.csv"), "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())
    with open(os.path.join(folder, "s.yaml"), "w", encoding="utf-8") as file:
        file.write(POINTS % (", spacing: 1 mm" if spacing else ""))
    done = subprocess.run([GAMUT, "--no-user-plugins", "explain", "s.yaml"], cwd=folder, timeout=60,
                          stdin=subprocess.DEVNULL, capture_output=True)
    return done.returncode, (done.stdout + done.stderr).decode(errors="replace")


# name, text, points
FINE = (
    ("plain", "x,y\n0.001,0\n0.002,0\n", 2),
    ("line ends of Windows", "x,y\r\n0.001,0\r\n0.002,0\r\n", 2),
    ("line ends of old", "x,y\r0.001,0\r0.002,0\r", 2),
    ("no last line end", "x,y\n0.001,0\n0.002,0", 2),
    ("a byte order mark", b"\xef\xbb\xbfx,y\n0.001,0\n0.002,0\n", 2),
    ("a quoted first line", '"x","y"\n0.001,0\n0.002,0\n', 2),
    ("quoted cells", 'x,y\n"0.001","0"\n"0.002",0\n', 2),
    ("units in the first line", "x [mm],y [m]\n1,0\n2,0\n", 2),
    ("quoted units", '"x [mm]","y [m]"\n1,0\n2,0\n', 2),
    ("units in cells", "x,y\n1 mm,0\n2 mm,0\n", 2),
    ("blanks around cells", " x [mm] ,\ty\n 1 , 0\t\n2 ,0\n", 2),
    ("powers of ten", "x [mm],y\n1e0,0E+1\n+2.0e+0,-0e-3\n.5e1,0.\n", 3),
    ("comments and blank lines", "# places\n\nx,y\n# more\n0.001,0\n   \n0.002,0\n#", 2),
    ("a line of 6000 bytes", "x,y\n0.001," + "0" * 6000 + "\n0.002,0\n", 2),
    ("the 65th column and beyond", f"{WIDE},x,y\n{WIDE.replace('c', '')},0.001,0\n", 1),
    ("a cell that is not asked for", "x,note,y\n0.001,\"a, \"\"b\"\"\nc\",0\n0.002,,0\n", 2),
)
# name, text, where, words
WRONG = (
    ("nothing in it", "", "1:1", "there is nothing in it"),
    ("only the first line", "x,y\n", "1:1", "no rows"),
    ("a column twice", "x,y,x\n0,0,1\n", "1:5", "column 'x' stands twice"),
    ("an unused column twice", "x,y,a,a\n0,0,1,1\n", "1:7", "column 'a' stands twice"),
    ("a zero byte", b"x,y\n0.001,0\n0.0\x0002,0\n", "3:4", "a zero byte"),
    ("UTF-16", "x,y\n0,0\n".encode("utf-16"), "1:4", "a zero byte"),
    ("a cell too many", "x,y\n0.001,0\n0.002,0,7\n", "3:9", "more than the 2 cells"),
    ("a comma at the end of a row", "x,y\n0.001,0,\n", "2:9", "more than the 2 cells"),
    ("a comma at the end of the first line", "x,y,\n0.001,0,\n", "1:5", "has no name"),
    ("a cell too few", "x,y\n0.001,0\n0.002\n", "3:1", "1 cell where the first line names 2"),
    ("an empty cell", "x,y\n0.001,\n", "2:7", "'' is no value of 'y'"),
    ("nan", "x,y\n0.001,nan\n", "2:7", "'nan' is no value of 'y'"),
    ("infinity", "x,y\n-inf,0\n", "2:1", "'-inf' is no value of 'x'"),
    ("a number too large", "x,y\n1e999,0\n", "2:1", "'1e999' is no value of 'x'"),
    ("a word", "x,y\n0.001,0\nend,0\n", "3:1", "'end' is no value of 'x'"),
    ("a decimal comma", "x,y\n0,5,0\n", "2:5", "more than the 2 cells"),
    ("semicolons", "x;y\n0;0\n", "1:1", "column 'x' is missing"),
    ("a column missing", "x,z\n0,0\n", "1:1", "column 'y' is missing"),
    ("a unit of another kind", "x [us],y\n0,0\n", "1:1", "has the unit 'us'"),
    ("a unit twice", "x [mm],y\n1 mm,0\n", "2:1", "'1 mm' is no value of 'x'"),
    ("a bracket open", "x [mm,y\n1,0\n", "1:1", "no name with a unit in brackets"),
    ("text behind a unit", "x [mm] a,y\n1,0\n", "1:1", "no name with a unit in brackets"),
    ("quotes inside a cell", "x,y\n0.0\"01,0\n", "2:4", "quotes inside"),
    ("quotes that are not closed", "x,y\n\"0.001,0\n", "2:1", "quotes are not closed"),
    ("two points at one place", "x [mm],y\n1,0\n2,0\n1.0,-0\n", "4:1",
     "point 3 is where point 1 is, of line 2"),
)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for name, text, points in FINE:
            code, said = read(folder, text)
            report(code == 0 and f" {points} point" in said, f"{name}: {points} points", said)
        for name, text, where, words in WRONG:
            code, said = read(folder, text)
            report(code == 3 and f"p.csv:{where}: error:" in said and words in said,
                   f"{name}: refused at {where}", said)
        code, said = read(folder, "x,y,volume\n0.001,0,1e-6\n0.002,0,0\n", False)
        report(code == 3 and "p.csv:3:1: error: point 2 has volume = 0" in said,
               "a point without volume: refused at 3:1", said)
    tap.done()


main()
