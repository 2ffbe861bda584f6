"""Small plugins that are wrong on purpose, written from a few lines of C and built with $CC."""
import os
import shutil
import signal
import subprocess
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
GAMUT = os.environ.get("GAMUT", os.path.join(ROOT, "build/gamut"))
CC = os.environ.get("CC", "cc").split()
FLAGS = ["-std=gnu11", "-O1", "-fPIC", "-shared", "-fopenmp-simd", "-ffp-contract=off",
         "-I" + os.path.join(ROOT, "framework/include")]

STRENGTH_YAML = """plugin: strength/{name}
version: "1.0"
summary: a law for a test
formula: "y0 + h p"
source: [by hand]
parameters:
  y0: {{unit: Pa, physical: "(0, inf)", random: true, doc: flow stress at the beginning}}
  h: {{unit: Pa, physical: "[0, inf)", random: true, doc: hardening}}
inputs: [plastic_strain]
outputs: [flow_stress, flow_stress_slope_plastic_strain]
"""
STRENGTH_TEST = """tests:
  - name: ten percent
    source: by hand
    parameters: {y0: 90 MPa, h: 300 MPa}
    at: {plastic_strain: 0.1}
    expect: {flow_stress: 120e6, flow_stress_slope_plastic_strain: 300e6}
"""
STRENGTH = """    b->flow_stress[i] = b->y0[i] + b->h[i] * b->plastic_strain[i];
    b->flow_stress_slope_plastic_strain[i] = b->h[i];
"""
EOS_YAML = """plugin: eos/{name}
version: "1.0"
summary: a law for a test
formula: "K compression"
source: [by hand]
parameters:
  K: {{unit: Pa, physical: "(0, inf)", random: true, doc: bulk modulus}}
inputs: [compression, reference_density]
outputs: [pressure, pressure_slope_compression, sound_speed]
messages:
  vacuum: {{severity: stop, text: "density is zero or negative"}}
"""
EOS_TEST = """tests:
  - name: ten percent
    source: by hand
    parameters: {K: 10 GPa}
    at: {compression: 0.1, reference_density: 2500}
    expect: {pressure: 1e9, pressure_slope_compression: 10e9}
"""
EOS = """    b->pressure[i] = b->K[i] * b->compression[i];
    b->pressure_slope_compression[i] = b->K[i];
    b->sound_speed[i] = sqrt(b->K[i] / b->reference_density[i]);
    gamut_flag(&b->status[i], b->compression[i] <= -1 ? {NAME}_VACUUM : 0);
"""


def kernel(name, kind, operation, body, top=""):
    """The C file of a law: `body` is run for every point i of the block b."""
    return (f'#include "{name}.gamut.h"\n{top}\n'
            f"static void {operation}(const struct {name} *b)\n{{\n"
            f"  for (size_t i = 0; i < b->count; i++) {{\n{body}  }}\n}}\n\n"
            f"GAMUT_{kind.upper()}({name}, .{operation} = {operation})\n")


def write(root, kind, name, yaml, source, test="tests: []\n", libraries=("-lm",), flags=()):
    """Makes root/KIND/NAME with its shared object; returns the folder."""
    folder = os.path.join(root, kind, name)
    os.makedirs(folder)
    for path in (os.path.dirname(folder), folder):
        os.chmod(path, 0o755)
    for suffix, text in ((".yaml", yaml), (".c", source), (".test.yaml", test)):
        if text is not None:
            with open(os.path.join(folder, name + suffix), "w", encoding="utf-8") as file:
                file.write(text)
    header = subprocess.run([GAMUT, "header", name + ".yaml"], cwd=folder, check=True,
                            capture_output=True, text=True).stdout
    with open(os.path.join(folder, name + ".gamut.h"), "w", encoding="utf-8") as file:
        file.write(header)
    subprocess.run(CC + FLAGS + list(flags) + ["-o", name + ".so", name + ".c", *libraries],
                   cwd=folder, check=True)
    return folder


def strength(root, name, body=STRENGTH, top="", yaml=STRENGTH_YAML, test=STRENGTH_TEST, flags=()):
    return write(root, "strength", name, yaml.format(name=name),
                 kernel(name, "strength", "flow_stress", body, top), test, flags=flags)


def eos(root, name, body=EOS, top="", yaml=EOS_YAML, test=EOS_TEST, flags=()):
    body = body.replace("{NAME}", name.upper())
    return write(root, "eos", name, yaml.format(name=name),
                 kernel(name, "eos", "pressure", body, top), test, flags=flags)


def scene(strength_model=None, eos_model=None, more=""):
    """One material point that is stretched into plastic flow."""
    law = (f"{{model: {strength_model}, y0: 90 MPa, h: 300 MPa}}" if strength_model
           else "{model: von_mises, yield_stress: 90 MPa}")
    pressure = (f"{{model: {eos_model}, K: 140 GPa}}" if eos_model
                else "{model: linear, bulk_modulus: 140 GPa}")
    return f"""gamut: 1
solver: {{model: material_driver, end: 1 s, steps: 20, control: {{xx: {{log_strain: 0.3}}}}}}
materials:
  metal: {{density: 8000 kg/m3, eos: {pressure}, strength: {law},
          elasticity: {{model: hypoelastic, shear_modulus: 48 GPa}}}}
bodies:
  sample: {{material: metal}}
{more}"""


def gamut(arguments, folder, timeout=300):
    done = subprocess.run([GAMUT, "--no-user-plugins"] + arguments, cwd=folder, timeout=timeout,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    return done.returncode, done.stdout


def terminated(root, scene, output):
    """A run that gets SIGTERM after 0.7 s: its exit code, what it said, and how long it took on."""
    process = subprocess.Popen([GAMUT, "--no-user-plugins", "--plugin-path", root, "run", scene,
                                "-o", output], cwd=root, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    time.sleep(0.7)
    begun = time.monotonic()
    process.send_signal(signal.SIGTERM)
    try:
        said, _ = process.communicate(timeout=20)
    except subprocess.TimeoutExpired:
        process.kill()
        said, _ = process.communicate()
    return process.returncode, said, time.monotonic() - begun


def sanitized():
    """Whether gamut itself is built with sanitizers, which take over the signals of a crash."""
    tool = shutil.which("nm")
    if not tool:
        return False
    names = subprocess.run([tool, "-D", GAMUT], capture_output=True, text=True, check=False).stdout
    return "__asan_init" in names
