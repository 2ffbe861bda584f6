"""pressure leaves the artificial viscous pressure out, total_pressure holds it: at points, over a
body, in frames, with and without viscosity, and after a restart."""
import scenes

LEAD = """gamut: 1
solver: {model: material_point_method, geometry: 1d, cell: 0.1 mm, end: 0.2 us, courant: 0.3}
materials: {lead: {density: 11350 kg/m3, eos: {model: mie_gruneisen, C0: 2092 m/s, S1: 1.45,
                                               gamma0: 2.0, tension_limit: -0.1 GPa}}}
bodies:
  a: {material: lead, points_per_cell: 4, shape: {box: {min: [0 mm], max: [6.36 mm]}},
      velocity: [6580 m/s]}
  b: {material: lead, points_per_cell: 4, shape: {box: {min: [6.36 mm], max: [12.72 mm]}}}
EFFECTS
quantities:
  p: {measure: pressure, at: {body: b, point: [6.8 mm]}, every: 0.001 us}
  t: {measure: total_pressure, at: {body: b, point: [6.8 mm]}, every: 0.001 us}
  most_p: {measure: maximum, body: b, field: pressure, every: 0.001 us}
  most_t: {measure: maximum, body: b, field: total_pressure, every: 0.001 us}
  stress: {measure: stress_xx, at: {body: b, point: [6.8 mm]}, every: 0.001 us}
VISCOUSoutputs: {frames: 4, fields: [FIELDS]}
"""
HUGONIOT = 11350.0 * (2092.0 + 1.45 * 3290.0) * 3290.0
SCALE = 1e-12 * HUGONIOT


def run(name, viscous, fields="pressure, total_pressure"):
    text = LEAD.replace("EFFECTS", "effects: {viscosity: {model: artificial_viscosity}}" if viscous
                        else "").replace("FIELDS", fields)
    one = "  q: {measure: viscous_pressure, at: {body: b, point: [6.8 mm]}, every: 0.001 us}\n"
    return scenes.run(scenes.written(name, text.replace("VISCOUS", one if viscous else "")))


def values(result, name):
    return result.history(name)[1]


def main():
    viscous = run("viscous", True)
    p, t, q, stress = (values(viscous, n) for n in ("p", "t", "q", "stress"))
    scenes.below("largest distance of pressure + viscous_pressure from total_pressure, Pa",
                 max(abs(a + b - c) for a, b, c in zip(p, q, t)), SCALE)
    scenes.below("of total_pressure from -stress_xx (a fluid), Pa",
                 max(abs(a + b) for a, b in zip(t, stress)), SCALE)
    scenes.report(max(q) > 0.2 * HUGONIOT,
                  f"the viscous pressure is a part: {max(q) / 1e9:.0f} GPa "
                  f"at a Hugoniot of {HUGONIOT / 1e9:.0f}")
    most_p, most_t = values(viscous, "most_p"), values(viscous, "most_t")
    scenes.report(all(a <= b for a, b in zip(most_p, most_t)) and most_t[5] > most_p[5],
                  "over the body as well: the largest total_pressure is above the largest pressure")
    import h5py  # noqa: PLC0415
    with h5py.File(viscous.file("results.h5"), "r") as file:
        frame = file["frames"][sorted(file["frames"])[2]]["b"]
        gap = frame["total_pressure"][:] - frame["pressure"][:]
        scenes.report(gap.min() >= 0 and gap.max() > 0.05 * HUGONIOT,
                      f"in frames: total_pressure - pressure up to {gap.max() / 1e9:.0f} GPa, "
                      "nowhere below zero")
    plain = run("plain", False)
    scenes.below("without viscosity both are the same, Pa",
                 max(abs(a - b) for a, b in zip(values(plain, "p"), values(plain, "t"))), 0.0)
    lean = run("lean", True, "velocity")
    scenes.below("asked for in quantities alone: the same numbers, Pa",
                 max(abs(a - b) for a, b in zip(p, values(lean, "p"))), 0.0)


main()
scenes.done()
