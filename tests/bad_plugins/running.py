"""Plugins that crash, end the program or hang while gamut uses them: the plugin is named, the exit
code is 4, whatever command it is, and SIGTERM ends a run within 5 s. Prints TAP."""
import os
import signal
import sys
import tempfile

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import kernels  # noqa: E402
from tap import done, report  # noqa: E402

LATE = "b->plastic_strain[i] > 0.01"
HANG = "#include <unistd.h>\n"
WRONG = {
    "writes_nowhere": ("", f"    if ({LATE}) *(volatile double *)8 = 1;\n"),
    "calls_nothing": ("", f"    void (*volatile f)(void) = 0;\n    if ({LATE}) f();\n"),
    "divides_by_zero": ("", f"    volatile int z = !({LATE}), k = 7 / z;\n    (void)k;\n"),
    "aborts": ("#include <stdlib.h>\n", f"    if ({LATE}) abort();\n"),
    "traps": ("", f"    if ({LATE}) __builtin_trap();\n"),
    "no_end_of_stack": ("static double deep(volatile double x)\n{\n  volatile double a[512];\n"
                        "  a[0] = x;\n  return deep(a[0] + 1) + a[0];\n}\n",
                        f"    if ({LATE}) b->flow_stress[i] = deep(1);\n"),
    "exits": ("#include <stdlib.h>\n", f"    if ({LATE}) exit(0);\n"),
}
EFFECT_YAML = """plugin: effect/{name}
version: "1.0"
summary: an effect for a test
source: [by hand]
"""
def named(what, plugin, code, said):
    report(code == 4 and f"plugin {plugin} " in said, f"{what}: exit {code}, {plugin} named", said)


def save(root, name, text):
    with open(os.path.join(root, name), "w", encoding="utf-8") as file:
        file.write(text)
    return name


def at_once(root):
    path = ["--plugin-path", root]
    for name, (top, more) in WRONG.items():
        kernels.strength(root, name, kernels.STRENGTH + more, top)
        scene = save(root, name + ".yaml", kernels.scene(name))
        code, said = kernels.gamut(path + ["run", scene, "-o", name + "-r"], root)
        named(f"run, {name}", "strength/" + name, code, said)
        report(not os.path.exists(os.path.join(root, name + "-r", "summary.json")),
               f"run, {name}: no summary of a run that did not end")
    for name in ("writes_nowhere", "exits"):
        code, said = kernels.gamut(["eval", "./strength/" + name, "--param", "y0=90e6", "--param",
                                    "h=1e8", "--at", "plastic_strain=0.1"], root)
        named(f"eval, {name}", "strength/" + name, code, said)
        code, said = kernels.gamut(path + ["explain", name + ".yaml"], root)
        named(f"explain, {name}", "strength/" + name, code, said)
        code, said = kernels.gamut(["verify", "./strength/" + name], root)
        report(code == 4 and "not ok" in said and name in said,
               f"verify, {name}: exit {code}", said)


def effect(root, name, create, top=""):
    source = (f'#include "{name}.gamut.h"\n{top}\n'
              "static gamut_status create(struct gamut_run *run, const struct gamut_values *values,"
              f" void **self)\n{{\n  (void)run, (void)values;\n  *self = 0;\n{create}"
              f"  return GAMUT_OK;\n}}\nGAMUT_EFFECT({name}, .create = create)\n")
    kernels.write(root, "effect", name, EFFECT_YAML.format(name=name), source)
    return save(root, name + ".yaml",
                kernels.scene(more=f"effects:\n  odd: {{model: {name}}}\n"))


def other_places(root):
    """The same where no kernel runs: a law of another kind, an effect's create."""
    path = ["--plugin-path", root]
    kernels.eos(root, "eos_crashes",
                kernels.EOS + "    if (b->compression[i] != 0) *(volatile double *)8 = 1;\n")
    scene = save(root, "eos_crashes.yaml", kernels.scene(eos_model="eos_crashes"))
    code, said = kernels.gamut(path + ["run", scene], root)
    named("run, an eos that crashes", "eos/eos_crashes", code, said)
    for name, create, top in (("create_exits", "  exit(0);\n", "#include <stdlib.h>"),
                              ("create_crashes", "  *(volatile double *)8 = 1;\n", "")):
        scene = effect(root, name, create, top)
        for command in ("check", "explain", "run"):
            code, said = kernels.gamut(path + [command, scene], root)
            named(f"{command}, {name}", "effect/" + name, code, said)


def terminate(root, scene, what, plugin):
    code, said, took = kernels.terminated(root, scene, what + "-r")
    named(f"SIGTERM, {what}", plugin, code, said)
    report(took < 5, f"SIGTERM, {what}: ended after {took:.2f} s (at most 5)")


def hanging(root):
    kernels.strength(root, "waits", kernels.STRENGTH + f"    if ({LATE}) for (;;) pause();\n", HANG)
    terminate(root, save(root, "waits.yaml", kernels.scene("waits")), "a kernel that hangs",
              "strength/waits")
    # Deaf in itself: the signal is blocked in the thread that hangs.
    kernels.strength(root, "deaf", kernels.STRENGTH + f"    if ({LATE}) {{\n      sigset_t all;\n"
                     "      sigfillset(&all);\n      pthread_sigmask(SIG_SETMASK, &all, 0);\n"
                     "      for (;;) pause();\n    }\n", HANG + "#include <signal.h>\n")
    terminate(root, save(root, "deaf.yaml", kernels.scene("deaf")), "a kernel that blocks signals",
              "strength/deaf")
    terminate(root, effect(root, "create_waits", "  for (;;) pause();\n", HANG.strip()),
              "a create that hangs", "effect/create_waits")


def main():
    if kernels.sanitized():
        print("1..0 # SKIP sanitizers take over the signals of a crash")
        return 77
    with tempfile.TemporaryDirectory() as root:
        at_once(root)
        other_places(root)
        hanging(root)
    done()


if __name__ == "__main__":
    main()
