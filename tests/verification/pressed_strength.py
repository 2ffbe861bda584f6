"""A strength that sees pressure and compression and changes the shear modulus."""
import math

import made
import scenes
from laws import apart, drive, linear_eos, material

EXACT = 1e-12
K, G, RHO = 137e9, 47.7e9, 8930.0
A, B = 2.83e-11, 3.8e-4


def law(y0):
    return {"model": "steinberg_guinan", "y0": f"{y0!r} Pa", "y_max": "1000 GPa", "beta": 36,
            "n": 0.45, "A": f"{A!r} 1/Pa", "B": f"{B!r} 1/K"}


def factor(J):
    mu = 1.0 / J - 1.0
    return 1.0 + A * K * mu / (1.0 + mu) ** (1.0 / 3.0) - B * (298.0 - 300.0)


def squeeze(y0):
    names = ["stress_xx", "pressure", "von_mises", "plastic_strain", "volume_ratio", "sound_speed"]
    return drive(material(linear_eos(K), law(y0), G, density=RHO), {"xx": {"log_strain": -0.2}},
                 1.0, 40, history=names, extra=["--plugin-path", FOLDER])


def elastic():
    """The deviator grows by 2 G f de, f at the end of each step."""
    run = squeeze(1e12)
    h, s, off, sound = 2.0 * math.tanh(-0.2 / 40 / 2.0), 0.0, 0.0, 0.0
    for i in range(1, 41):
        J = run["volume_ratio"][i]
        s += 2.0 * G * factor(J) * (2.0 / 3.0) * h
        off = max(off, apart(run["stress_xx"][i] + run["pressure"][i], s))
        fast = math.sqrt((K + 4.0 / 3.0 * G * factor(J) * J) / RHO)
        sound = max(sound, apart(run["sound_speed"][i], fast))
    scenes.note(f"shear modulus at the end {factor(run['volume_ratio'][-1]):.3f} times the first")
    scenes.below("elastic squeeze: deviator of each step, relative", off, EXACT)
    scenes.below("its sound speed, relative", sound, EXACT)


def plastic():
    run = squeeze(120e6)
    off = max(apart(run["von_mises"][i], factor(run["volume_ratio"][i]) * 120e6
                    * (1.0 + 36 * run["plastic_strain"][i]) ** 0.45) for i in range(1, 41))
    scenes.below("squeeze with flow: flow stress of each step, relative", off, EXACT)


FOLDER = made.of_tree("strength/steinberg_guinan")
made.verified("strength/steinberg_guinan")
elastic()
plastic()
scenes.done()
