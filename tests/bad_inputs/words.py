"""Messages of a new user's stumbles: names of other codes, blanks, commas, options. Prints TAP."""
import os
import subprocess
import sys

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tap  # noqa: E402
from tap import report  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
GAMUT = os.environ.get("GAMUT", os.path.join(HERE, "../../build/gamut"))
BAR = "bodies.bar."
FRONT = "quantities.f={measure: front, body: bar, axis: y, "
LARGEST = "quantities.f={measure: maximum, body: bar, "
# an option, the exit code, words of the message
STUMBLES = (
    ("solver.cell=0.8mm", 3, "a blank before the unit: '0.8 mm'"),
    ("solver.cell=0.8mmm", 3, "such as '25.4 mm'"),
    ("solver.cell=1e-3m", 3, "a blank before the unit: '1e-3 m'"),
    (BAR + "velocity=[0 m/s, -190m/s]", 3, "m/s"),
    ("materials.copper.strength.A=90MPa", 3, "a blank before the unit: '90 MPa'"),
    ("materials.copper.strength.A=5,5 MPa", 3, "write a decimal point: '5.5 MPa'"),
    ("materials.copper.strength={model: von_mises, yield_stress: 5,5 MPa}", 3, "a comma ends a value: write a decimal point"),
    (BAR + "shape.cylinder={diameter: 4 mm, length: 2 mm}", 3, "'radius', half of it"),
    (BAR + "shape.cylinder={radius: 4 mm, height: 2 mm}", 3, "shapes have 'length'"),
    ("materials.copper.damage=1", 3, "'spall' tears material"),
    ("contact=1", 3, "bodies meet on the grid"),
    ("materials.copper.strength.D1=0.5", 3, "no damage law"),
    ("solver.dt=1 us", 3, "'solver.courant'"),
    ("solver.timestep=1 us", 3, "'solver.courant'"),
    ("mesh=1 mm", 3, "'solver.cell'"),
    ("solver.dx=1 mm", 3, "'solver.cell'"),
    ("solver.tmax=1 us", 3, "'solver.end'"),
    ("gravity=1", 3, "model: gravity"),
    ("materials.copper.elasticity.E=1 GPa", 3, "'youngs_modulus'"),
    ("materials.copper.elasticity.nu=0.3", 3, "'poissons_ratio'"),
    ("materials.copper.rho=8960 kg/m3", 3, "'density'"),
    ("materials.copper.strength.sigma_y=90 MPa", 3, "yield stress is a parameter"),
    ("solver.cell={mean: 1 mm, cv: 0.1}", 3, "'cell' may not be random"),
    ("solver.cell={value: 1 mm}", 3, "'cell' is a mapping where a number is due"),
    ("uncertainty.seed=9223372036854775808", 3, "from 0 to 9223372036854775807"),
    ("uncertainty.seed=99999999999999999999999", 3, "'seed' is too large"),
    ("uncertainty.seed=9223372036854775807", 0, ""),
    ("uncertainty.seed=9007199254740993", 0, ""),
    ("uncertainty.seed=1.5", 3, "'seed' is no whole number"),
    (BAR + "points_per_cell=18014398509481985", 3, "from -2^53 to 2^53"),
    ("solver.order=usl", 3, "what was called 'order' is called 'stress_update' now"),
    (BAR + "order=usl", 3, "known: "),
    ("solver.transfer={model: xpic, order: 3}", 0, ""),
    ("outputs.fields=[pieces]", 3, "what was called 'pieces' is called 'fragments' now"),
    ("outputs.fields=[spalled]", 3, "what was called 'spalled' is called 'damage' now"),
    ("quantities.q.measure=pieces", 3, "what was called 'pieces' is called 'fragments' now"),
    ("quantities.q.measure=spalled", 3, "what was called 'spalled' is called 'damage' now"),
    (LARGEST + "field: spalled}", 3, "what was called 'spalled' is called 'damage' now"),
    (FRONT + "field: pressure, level: 1 GPa}", 0, ""),
    (FRONT + "field: total_pressure, level: 10 kbar}", 0, ""),
    (FRONT + "field: plastic_strain, level: 0.1}", 0, ""),
    (FRONT + "field: temperature, level: 20 degC}", 0, ""),
    (FRONT + "field: pressure, level: 1e9}", 3, "a unit like Pa is due"),
    (LARGEST + "field: pressure, reduce: {time_of: 1 GPa}}", 0, ""),
    (LARGEST + "field: total_pressure, reduce: {time_of: 1e9}}", 3, "a unit like Pa is due"),
)


def main():
    for option, expected, words in STUMBLES:
        done = subprocess.run([GAMUT, "--no-user-plugins", "check", "good.yaml", "--set", option],
                              cwd=HERE, timeout=120, stdin=subprocess.DEVNULL, capture_output=True)
        said = done.stderr.decode(errors="replace")
        blamed = expected == 0 or f"--set {option}: error: " in said
        report(done.returncode == expected and words in said and blamed,
               f"--set '{option}': {words or 'fine'}", f"exit {done.returncode}\n{said}")
    tap.done()


main()
