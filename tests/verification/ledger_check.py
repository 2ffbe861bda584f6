"""A ledger that does not close ends the run with exit 5 and says which account is off and by how
much; one that closes never fails by rounding, also where nothing moves. Prints TAP."""
import re

import made
import scenes

EFFECT = """plugin: effect/thief
version: "1.0"
summary: books what it never gave
formula: "supplied += part of the mass, the momentum or the energy that is there"
source: [made for a test]
parameters:
  account: {type: choice, choices: [mass, momentum_x, energy, spare], doc: where}
  unit: {type: text, doc: of the account}
  amount: {unit: 1, doc: how much in each step}
  after: {type: integer, unit: 1, default: 0, doc: from which step on}
inputs: [mass]
"""
CODE = """#include "thief.gamut.h"
struct accomplice {
  struct gamut_run *run; double *line, amount; long after;
};
static gamut_status book(void *self, const struct gamut_chunk *chunk)
{
  struct accomplice *t = self;
  (void)chunk;
  if ((long)GAMUT_HOST(t->run)->step(t->run) >= t->after)
    *t->line += t->amount;
  return GAMUT_OK;
}
static gamut_status create(struct gamut_run *run, const struct gamut_values *values, void **self)
{
  static const struct gamut_use uses[] = {{"mass", GAMUT_READ}};
  struct accomplice *t = gamut_allocate(run, "thief", sizeof *t);
  if (!t)
    return GAMUT_INTERNAL;
  t->run = run;
  t->amount = gamut_real(values, "amount");
  t->after = gamut_integer(values, "after");
  const struct gamut_task task = {.name = "book", .phase = "forces", .extent = GAMUT_ONCE,
    .uses = uses, .use_count = 1, .essential = true, .run = book, .self = t};
  gamut_status status = GAMUT_HOST(run)->ledger(run, gamut_text(values, "account"), "thief",
    gamut_text(values, "unit"), GAMUT_SUPPLIED, &t->line);
  if (status == GAMUT_OK)
    status = gamut_add_task(run, &task);
  *self = t;
  return status;
}
GAMUT_EFFECT(thief, .create = create)
"""
SCENE = """gamut: 1
solver: {{model: material_point_method, geometry: {geometry}, cell: 0.25 mm, end: 2 us{solver}}}
materials:
  metal: {{density: 8000 kg/m3, eos: {{model: {eos}}},
          elasticity: {{model: hypoelastic, shear_modulus: {shear}}}}}
bodies: {{block: {{material: metal, shape: {{box: {{min: {low}, max: {high}}}}}{body}}}}}
effects: {{q: {{model: artificial_viscosity}}{effects}}}
quantities: {{p: {{measure: momentum, axis: x, reduce: at end}}}}
"""


def written(name, geometry="1d", eos="linear, bulk_modulus: 140 GPa", shear="48 GPa", body="",
            effects="", solver=""):
    axes = 1 if geometry == "1d" else 2
    return scenes.written(re.sub(r"\W+", "_", name), SCENE.format(
        geometry=geometry, eos=eos, shear=shear, body=body, effects=effects, solver=solver,
        low=str(["0 mm"] * axes).replace("'", ""), high=str(["4 mm"] * axes).replace("'", "")))


def stolen(account, unit, amount, after, due):
    """The block has 32 kg, moves at 10 m/s and has 1600 J."""
    name = f"{amount:g} {unit} of {account} from step {after} on"
    effect = (f", thief: {{model: thief, account: {account}, unit: {unit}, amount: {amount!r}, "
              f"after: {after}}}")
    process, _ = scenes.attempt(written(name, body=", velocity: [10 m/s]", effects=effect),
                                extra=("--plugin-path", folder))
    words = ("does not close: " + account, unit, f"step {after + 1}") if due else ()
    missing = [w for w in words if w not in process.stderr]
    scenes.report(process.returncode == due and not missing,
                  f"{name}: exit {process.returncode} (due {due})",
                  [missing, process.stderr[-1000:]])


def closes(name, **changes):
    result = scenes.run(written(name, **changes))
    accounts = result.summary["ledger"]
    worst = max(accounts, key=lambda a: abs(accounts[a]["relative_residual"]))
    scenes.below(f"{name}: largest residual ({worst}), {accounts[worst]['residual']:.2g} of "
                 f"{accounts[worst]['scale']:.2g}", result.residual(), 1e-10)


folder = made.plugin("effect/thief", EFFECT, CODE)
for account, unit, whole in (("mass", "kg", 32.0), ("momentum_x", "kg m/s", 320.0),
                             ("energy", "J", 1600.0)):
    stolen(account, unit, 1e-6 * whole, 0, 5)
    stolen(account, unit, 1e-9 * whole, 7, 5)
    stolen(account, unit, 1e-15 * whole, 0, 0)
stolen("spare", "widget", 1.0, 3, 5)
WALLS = ", ".join(f"{n}: {{model: boundary, kind: symmetry, plane: {{point: {p}, normal: {d}}}}}"
                  for n, p, d in (("w", "[0 mm, 0 mm]", "[1, 0]"), ("s", "[0 mm, 0 mm]", "[0, 1]"),
                                  ("e", "[4 mm, 4 mm]", "[-1, 0]"),
                                  ("n", "[4 mm, 4 mm]", "[0, -1]")))
GAS = {"eos": "ideal_gas, gamma: 1.4", "shear": "0 Pa", "body": ", energy: 1 GPa"}
closes("a block at rest")
closes("a block at rest, two axes", geometry="plane_strain")
closes("gas at rest in a box", geometry="plane_strain", effects=", " + WALLS, **GAS)
closes("gas that spreads", geometry="plane_strain", **GAS)
closes("a bar that swings",
       body=', velocity: ["100 * sin(3.14159265358979 * x / 0.004 - 1.5707963)"]')
closes("a bar that swings, xpic", solver=", transfer: {model: xpic, order: 12}",
       body=', velocity: ["100 * sin(3.14159265358979 * x / 0.004 - 1.5707963)"]')
closes("a block that falls", geometry="plane_strain",
       effects=", g: {model: gravity, acceleration: [0 m/s2, -9.81 m/s2]}")
closes("a block so slow that squares vanish", geometry="plane_strain",
       body=", velocity: [1e-170 m/s, 0 m/s]")
scenes.done()
