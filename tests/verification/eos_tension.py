"""A law that is said to hold down to a tension limit has a real sound speed in all of that, however
far the material has opened and however hot it is; without one the message says what to do, with one
no message advises it."""
import json
import math
import subprocess

import scenes

# published cards: C0, S1, gamma0, a, reference density
CARDS = {"steel": (4569, 1.49, 2.17, 0.46, 7830), "copper": (3940, 1.489, 2.02, 0.0, 8960),
         "lead": (2092, 1.45, 2.0, 0.0, 11350), "aluminium": (5328, 1.338, 2.0, 0.48, 2785),
         "water": (1490, 1.79, 1.65, 0.0, 1000)}
LIMITS = (-1e6, -1e8, -1.35e9, -5e10)
ENERGIES = (-1e8, 0.0, 1e9, 2.4304e10, 1e11)


def points(card, energy, limit):
    C0, S1, gamma0, a, density = CARDS[card]
    parameters = f"C0={C0},S1={S1},gamma0={gamma0},a={a}"
    if limit is not None:
        parameters += f",tension_limit={limit}"
    done = subprocess.run([scenes.GAMUT, "--no-user-plugins", "eval", "eos/mie_gruneisen",
                           "--param", parameters, "--at",
                           f"compression=-0.999:0:300,energy={energy},"
                           f"reference_density={density}", "--json"], capture_output=True,
                          text=True, check=False)
    return json.loads(done.stdout)["points"]


def main():
    for card, (C0, _, gamma0, a, density) in CARDS.items():
        slow, low, high = 0, math.inf, -math.inf
        for limit in LIMITS:
            for energy in ENERGIES:
                for point in points(card, energy, limit):
                    mu, speed = point["inputs"]["compression"], point["outputs"]["sound_speed"]
                    p = point["outputs"]["pressure"]
                    if gamma0 + a * mu < 0 or C0 * C0 * density + a * energy <= 0:
                        continue
                    stops = point["status"] not in ("ok", "at_tension_limit")
                    slow += stops or speed is None or not speed > 0
                    if speed and p < 0 and p > limit:
                        square = C0 * C0 + a * energy / density
                        low, high = min(low, speed ** 2 / square), max(high, speed ** 2 / square)
        scenes.below(f"{card}: states above a limit without a real sound speed", slow, 0)
        scenes.below(f"{card}: in tension, sound speed squared against dp/dmu over density, "
                     "relative",
                     max(abs(low - 1), abs(high - 1)), 1e-12)
    unlimited = [p for p in points("lead", 2.4304e10, None) if p["status"] == "pulled_beyond"]
    scenes.report(len(unlimited) > 0, "lead, hot and open, without a limit: told to state one",
                  [f"{len(unlimited)} of 300 states"])


main()
scenes.done()
