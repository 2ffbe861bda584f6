"""Kernels are fit for a graphics processor, where a block is one point (<gamut/kernel.h>): the
rules D1 to D8 but D4, which `gamut verify` tries, each on a made-up file that breaks it too. They
are all sources of an eos, a strength or an elasticity, and of an effect or where there is a
`prepare` those that define GAMUT_KERNEL. Needs clang."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import tap

GAMUT = os.environ.get("GAMUT", os.path.join(tap.ROOT, "build/gamut"))
INCLUDE = os.path.join(tap.ROOT, "framework/include")
CALLED = {"sqrt", "fabs", "copysign", "memcpy"}
EVALUATE = {"gamut_evaluate_strength", "gamut_evaluate_eos"}
FRAME = 512  # bytes on the stack, where a block is one point
STUBS = {
    "math.h": "#define HUGE_VAL __builtin_huge_val()\n#define NAN __builtin_nanf(\"\")\n"
              "double sqrt(double);\ndouble fabs(double);\ndouble copysign(double, double);\n",
    "string.h": "#include <stddef.h>\nvoid *memcpy(void *, const void *, size_t);\n",
    "assert.h": "#define static_assert _Static_assert\n"}

WORD = re.compile(r"\b(half|kernel|global|local|constant|private|generic|pipe)\b")
NO_TYPE = re.compile(r"\b(long double|__int128|_Complex|fenv|errno)\b")
NAMES = (re.compile(r"^(?!typedef)\w[\w ]*[ *]+(\w+)\([^;{)]*(?:\([^)]*\)[^;{)]*)*\)\s*[;{]",
                    re.M),
         re.compile(r"^(?:struct|enum|union) (\w+) \{", re.M),
         re.compile(r"^typedef .*?(\w+);", re.M),
         re.compile(r"^(?:static|const)\b[^;(={]*?\b(\w+)(?:\[[^\]]*\])*(?: =|;)", re.M),
         re.compile(r"^#define (\w+)", re.M))
ENUM = re.compile(r"^enum \w*\s*\{(.*?)\}", re.M | re.S)
INCLUDED = re.compile(r'^#include ([<"])([^">]+)[">]', re.M)
ALLOWED = {"gamut/kernel.h", "gamut/math.h", "gamut/block.h"}


def without_comments(text):
    return re.sub(r"/\*.*?\*/", lambda c: "\n" * c.group().count("\n"), text, flags=re.DOTALL)


def file_level(text):
    for pattern in NAMES:
        yield from pattern.findall(text)
    for inside in ENUM.findall(text):
        yield from re.findall(r"(?:^|,)\s*(\w+)", inside)


def command(*words):
    done = subprocess.run(words, text=True, capture_output=True, check=False)
    return done.returncode, done.stdout, done.stderr


def first_error(said):
    return next((line for line in said.splitlines() if "error" in line), said[:200])


class Plugin:
    """One plugin, copied into a folder with its generated header."""

    def __init__(self, scratch, name, kind, sources, descriptor):
        self.name, self.kind, self.home = name, kind, scratch
        for path, text in sources.items():
            with open(os.path.join(scratch, path), "w", encoding="utf-8") as file:
                file.write(text)
        with open(os.path.join(scratch, name + ".yaml"), "w", encoding="utf-8") as file:
            file.write(descriptor)
        code, header, said = command(GAMUT, "header", os.path.join(scratch, name + ".yaml"))
        if code:
            raise SystemExit(said)
        with open(os.path.join(scratch, name + ".gamut.h"), "w", encoding="utf-8") as file:
            file.write(header)
        for stub, text in STUBS.items():
            os.makedirs(os.path.join(scratch, "stubs"), exist_ok=True)
            with open(os.path.join(scratch, "stubs", stub), "w", encoding="utf-8") as file:
                file.write(text)
        self.text = {path: without_comments(text) for path, text in sources.items()}
        mixed = kind == "effect" or re.search(r"^prepare: true", descriptor, re.M)
        self.kernels = [path for path in sorted(sources) if path.endswith(".c") and (
            not mixed or re.search(r"^#define GAMUT_KERNEL$", self.text[path], re.M))]

    def compiled(self, path, compiler, *options):
        return command(compiler, *options, "-I", INCLUDE, "-I", self.home, "-Wno-unknown-pragmas",
                       "-o", "-", os.path.join(self.home, path))

    def by_device(self):
        """D1, D2: what a device compiler makes of the kernels."""
        codes = []
        for path in self.kernels:
            code, made, said = self.compiled(
                path, "clang", "--target=nvptx64", "-ffreestanding", "-nostdlibinc", "-std=gnu11",
                "-isystem", os.path.join(self.home, "stubs"), "-O0", "-S", "-emit-llvm",
                "-Werror=implicit-function-declaration", "-Werror=vla", "-Werror=alloca")
            if code:
                rule = "D2" if "vla" in said or "alloca" in said else "D1"
                yield rule, f"{path}: {first_error(said)}"
            codes.append(made)
        whole = "\n".join(codes)
        defined = set(re.findall(r"^define [^@]*@([\w.]+)\(", whole, re.M))
        for name in sorted(set(re.findall(r"^declare [^@]*@([\w.]+)\(", whole, re.M)) - defined):
            if not name.startswith("llvm.") and name not in CALLED:
                yield "D1", f"calls {name}"
        for line in re.findall(r"^@[\w.]+ = (?!.*\bconstant\b).*$", whole, re.M):
            yield "D2", f"a variable that outlives a call: {line[:80]}"
        yield from calls(whole)

    def by_frame(self):
        """D3: local arrays of a few numbers, or of a block."""
        for path in self.kernels:
            code, _, said = self.compiled(path, "clang", "-std=gnu11", "-O2", "-S",
                                          "-fno-math-errno", "-DGAMUT_CHUNK_MAX=1",
                                          f"-Wframe-larger-than={FRAME}",
                                          "-Werror=frame-larger-than")
            if code and "stack frame" in said:
                yield "D3", f"{path}: {first_error(said)}"

    def by_names(self):
        """D5, D6, and the texts of D7."""
        for path, text in self.text.items():
            if path.endswith(".c") and path not in self.kernels:
                continue
            for word in sorted(set(WORD.findall(re.sub(r"^#include.*$", "", text, flags=re.M)))):
                yield "D5", f"{path}: a name '{word}'"
            for word in sorted(set(NO_TYPE.findall(text))):
                yield "D7", f"{path}: {word}"
            for name in sorted(set(file_level(text)) - {"GAMUT_KERNEL"}):
                if not name.lower().startswith(self.name.lower()):
                    yield "D6", f"{path}: '{name}' does not begin with '{self.name}'"

    def by_standard(self):
        """D7: what is C11 is C++20 too."""
        for path in self.kernels:
            code, _, said = self.compiled(path, "clang++", "-x", "c++", "-std=c++20",
                                          "-pedantic-errors", "-fsyntax-only", "-O0")
            if code:
                yield "D7", f"{path}: {first_error(said)}"

    def by_includes(self):
        """D8: a kernel asks nothing of the core."""
        for path, text in self.text.items():
            if path.endswith(".c") and path not in self.kernels:
                if re.search(rf"\b{self.name}\w*\(const struct {self.name} \*\w+", text):
                    yield "D8", f"{path}: a kernel in a source without GAMUT_KERNEL"
                continue
            for bracket, included in INCLUDED.findall(text):
                if included not in (ALLOWED if bracket == "<" else {*self.text,
                                                                    self.name + ".gamut.h"}):
                    yield "D8", f"{path}: includes {included}"

    def faults(self):
        for part in (self.by_device, self.by_frame, self.by_names, self.by_standard,
                     self.by_includes):
            yield from part()


def calls(code):
    """Calls through pointers but those of the laws, and functions that come back to themselves."""
    graph = {}
    for function in re.finditer(r"^define [^@]*@([\w.]+)\(.*?^\}", code, re.M | re.S):
        name, body = function.group(1), function.group()
        graph[name] = set(re.findall(r"\bcall [^@\n%]*@([\w.]+)\(", body))
        if name not in EVALUATE and re.search(r"\bcall [^@\n]*? %\w+\(", body):
            yield "D2", f"{name} calls through a pointer"
    for name in sorted(graph):
        seen, left = set(), set(graph[name])
        while left:
            one = left.pop()
            if one not in seen:
                seen.add(one)
                left |= graph.get(one, set())
        if name in seen:
            yield "D2", f"{name} comes back to itself"


def twice(plugins):
    """D6: no name stands in two sources of the shipped kernels."""
    where = {}
    for plugin in plugins:
        for path in plugin.kernels:
            for name in set(file_level(plugin.text[path])) - {"GAMUT_KERNEL"}:
                if not re.search(rf"\b{name}\([^;{{]*\);", plugin.text[path]):
                    where.setdefault(name, set()).add(plugin.name + "/" + path)
    return [f"{name}: {' and '.join(sorted(paths))}" for name, paths in sorted(where.items())
            if len(paths) > 1]


def of_tree(scratch):
    """Shipped plugins and the skeletons."""
    for kind in ("eos", "strength", "elasticity", "effect"):
        for name in sorted({p.split("/")[2] for p in tap.files(f"plugins/{kind}",
                                                               suffixes=(".yaml",))}):
            home = f"plugins/{kind}/{name}"
            sources = {os.path.basename(p): tap.read(p)
                       for p in tap.files(home, suffixes=(".c", ".h"))
                       if not p.endswith(".gamut.h")}
            yield kind, name, sources, tap.read(f"{home}/{name}.yaml")
    for kind in ("eos", "strength", "elasticity", "effect"):
        home = os.path.join(scratch, "new_" + kind)
        code, _, said = command(GAMUT, "new", f"{kind}/fresh", "-o", home)
        if code:
            raise SystemExit(said)
        folder = home if os.path.exists(os.path.join(home, "fresh.yaml")) else \
            os.path.join(home, "fresh")
        sources = {}
        for path in os.listdir(folder):
            if path.endswith(".c"):
                with open(os.path.join(folder, path), encoding="utf-8") as file:
                    sources[path] = file.read()
        with open(os.path.join(folder, "fresh.yaml"), encoding="utf-8") as file:
            yield kind, "fresh", sources, file.read()


BAD = (
    ("D1", "sqrt(b->bulk", "sinh(b->bulk"),
    ("D1", "GAMUT_EACH (i, b) {", 'GAMUT_EACH (i, b) {\n    abort();'),
    ("D2", "static void linear_pressure(const struct linear *b)\n{",
     "static size_t linear_calls;\nstatic void linear_pressure(const struct linear *b)\n{\n"
     "  linear_calls += b->count;"),
    ("D2", "  GAMUT_EACH", "  double linear[b->count];\n  linear[0] = 0.0;\n  (void)linear;\n"
                           "  GAMUT_EACH"),
    ("D2", "static void linear_pressure(const struct linear *b)\n{",
     "static size_t linear_sum(size_t n)\n{\n  return n > 0 ? linear_sum(n - 1) : n;\n}\n\n"
     "static void linear_pressure(const struct linear *b)\n{\n  (void)linear_sum(b->count);"),
    ("D2", "  GAMUT_EACH", "  double (*linear_root)(double) = b->count ? sqrt : fabs;\n"
                           "  b->pressure[0] = linear_root(1.0);\n  GAMUT_EACH"),
    ("D3", "  GAMUT_EACH", "  volatile double table[100];\n  for (int k = 0; k < 100; k++)\n"
                           "    table[k] = b->bulk_modulus[0];\n  GAMUT_EACH"),
    ("D5", "static void linear_pressure(const struct linear *b)\n{", "static void linear_pressure("
     "const struct linear *b)\n{\n  const double half = 0.5;\n  (void)half;"),
    ("D6", "linear_pressure", "pressure"),
    ("D6", "static void linear_pressure", "enum { LIMIT = 3 };\n\nstatic void linear_pressure"),
    ("D7", "static void linear_pressure", "struct linear_pair {\n  double a, b;\n};\n\n"
     "static struct linear_pair linear_one(void)\n{\n"
     "  return (struct linear_pair){1.0, 2.0};\n}\n\nstatic void linear_pressure"),
    ("D7", "static void linear_pressure", "struct linear_pair {\n  double a, b;\n};\n\n"
     "static const struct linear_pair linear_one = {.b = 1.0, .a = 2.0};\n\n"
     "static void linear_pressure"),
    ("D7", "  GAMUT_EACH", "  long double sum = 0.0L;\n  (void)sum;\n  GAMUT_EACH"),
    ("D8", '#include "linear', '#include <gamut/host.h>\n#include "linear'),
)


def bad(scratch):
    """Each made-up fault is found by its rule, and by no other."""
    text = tap.read("plugins/eos/linear/linear.c")
    descriptor = tap.read("plugins/eos/linear/linear.yaml")
    for number, (rule, old, new) in enumerate(BAD):
        home = os.path.join(scratch, f"bad_{number}")
        os.makedirs(home)
        if old not in text:
            yield f"{old} does not stand in linear.c"
        plugin = Plugin(home, "linear", "eos", {"linear.c": text.replace(old, new)}, descriptor)
        found = {r for r, _ in plugin.faults()}
        if rule not in found:
            yield f"{rule} does not see {new!r}, only {sorted(found)}"
    home = os.path.join(scratch, "bad_effect")
    os.makedirs(home)
    path = "plugins/effect/adiabatic_heating/adiabatic_heating"
    plugin = Plugin(home, "adiabatic_heating", "effect",
                    {"adiabatic_heating.c": tap.read(path + ".c").replace(
                        "#define GAMUT_KERNEL\n", "")}, tap.read(path + ".yaml"))
    if "D8" not in {r for r, _ in plugin.faults()}:
        yield "D8 does not see a kernel of an effect in a source that may ask the core"


if not shutil.which("clang") or not shutil.which("clang++"):
    print("1..0 # SKIP no clang, which compiles for a device")
    sys.exit(77)
if "nvptx64" not in command("clang", "--print-targets")[1]:
    print("1..0 # SKIP this clang does not compile for nvptx64")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    every = []
    found = {f"D{k}": [] for k in (1, 2, 3, 5, 6, 7, 8)}
    for n, (of_kind, own_name, files, yaml) in enumerate(of_tree(folder)):
        place = os.path.join(folder, str(n))
        os.makedirs(place)
        every.append(Plugin(place, own_name, of_kind, files, yaml))
        for broken, what in every[-1].faults():
            found[broken].append(f"{of_kind}/{own_name}: {what}")
    for header in sorted(ALLOWED):
        code_of = without_comments(tap.read("framework/include/" + header))
        found["D5"] += [f"<{header}>: a name '{word}'" for word in sorted(set(WORD.findall(
            re.sub(r"^#include.*$", "", code_of, flags=re.M))))]
    found["D6"] += twice([p for p in every if p.name != "fresh"])
    for broken, meaning in (("D1", "no calls but those of <gamut/math.h> and laws"),
                            ("D2", "no variables that outlive a call, pointers to functions, "
                                   "recursion, arrays of any length"),
                            ("D3", f"at most {FRAME} bytes on the stack for a block of one"),
                            ("D5", "no names that device compilers keep for themselves"),
                            ("D6", "names at file level begin with the plugin's, each once"),
                            ("D7", "C11 and C++20 both"),
                            ("D8", "kernels include no more than <gamut/kernel.h>")):
        tap.check(f"{broken}: {meaning} ({sum(len(p.kernels) for p in every)} sources)",
                  found[broken])
    tap.check(f"and {len(BAD) + 1} made-up faults are found", list(bad(folder)))
tap.done()
