"""Sums over blocks are the core's: a solver or an effect that goes through the slots of a set, or
through blocks, and adds real numbers up there is refused, but in files that call `sum`. Counts are
whole numbers, and an array with an entry a slot or block is no sum: both may be added to."""

import re

import tap

# Loops to the end of a set's slots, or over blocks of points or of nodes: up, down, by a pointer,
# and where the number has another name.
LOOP = re.compile(r"\b(?:for|while) \(")
BOUND = r"\b(?:slots|blocks)\b"
RENAMED = re.compile(rf"\b(\w+) = (?:\w+(?:->|\.))*{BOUND}\s*[,;]")
COUNTER = re.compile(r"\(\s*(?:const )?(?:\w+ )?\*?(\w+)")
ADDED = re.compile(r"(?<![\w\])>.])([*(]*(?:\w+(?:\[[^\]]*\])?(?:->|\.))*(\w+)\)*((?:\[[^\]]*\])*))"
                   r"\s*[+-]=")
CALL = re.compile(r"\bgamut_sum\(|->sum\(")

BAD = ("double sum = 0.0;\nfor (size_t i = 0; i < set->slots; i++)\n  sum += mass[i];",
       "double *work;\nfor (size_t b = 0; b < m->blocks; b++) {\n  if (full(b))\n"
       "    *work += block[b].work;\n}",
       "double total[3];\nfor (size_t b = 0; b < set->blocks; b++)\n  for (int k = 0; k < 3; k++)\n"
       "    total[k] += row[b][k];",
       "struct sums { double mass; };\nfor (size_t i = 0; i < c->set->slots; i++)\n"
       "  s->mass += mass[i];",
       "double sum = 0.0;\nfor (size_t i = set->slots; i-- > 0;)\n  sum += mass[i];",
       "double sum = 0.0;\nfor (size_t i = 0; i != set->slots; i++)\n  sum += mass[i];",
       "double sum = 0.0;\nfor (const double *p = mass; p < mass + set->slots; p++)\n  sum += *p;",
       "double sum = 0.0;\nsize_t i = 0;\nwhile (i < set->slots)\n  sum += mass[i++];",
       "double sum = 0.0;\nconst size_t count = set->slots;\nfor (size_t i = 0; i < count; i++)\n"
       "  sum += mass[i];",
       "double sum = 0.0;\nfor (size_t i = 0, end = set->slots; i < end; i++)\n  sum += mass[i];")
GOOD = ("size_t count = 0;\nfor (size_t i = 0; i < set->slots; i++)\n  count += id[i] >= 0;",
        "double *force;\nfor (size_t i = 0; i < set->slots; i++)\n  force[i] += mass[i] * g;",
        "for (size_t b = 0; b < set->blocks; b++) {\n  double own = 0.0;\n"
        "  for (size_t i = first[b]; i < first[b + 1]; i++)\n    own += mass[i];\n"
        "  row[b] = own;\n}",
        "double sum = 0.0;\nfor (size_t i = first; i < last; i++)\n  sum += mass[i];",
        "double sum = 0.0;\nconst size_t count = set->slots / parts;\n"
        "for (size_t i = 0; i < count; i++)\n  sum += mass[i];",
        "double *force;\nfor (size_t i = set->slots; i-- > 0;)\n  force[i] += mass[i] * g;",
        BAD[0] + "\ngamut_sum(run, row, rows, 1, &sum);")


def closing(text, at):
    """Where the bracket that opens at `at` is closed."""
    depth = 0
    for i in range(at, len(text)):
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i
    return len(text) - 1


def repeated(text, start):
    """What the loop at `start` repeats: the rest of a statement, or a block in braces."""
    at = closing(text, text.index("(", start)) + 1
    for i in range(at, len(text)):
        if text[i] == "{":
            return text[at:closing(text, i)]
        if text[i] == "(":
            continue
        if text[i] == ";" and text.count("(", at, i) == text.count(")", at, i):
            return text[at:i + 1]
    return text[at:]


def is_real(name, text):
    return re.search(rf"\bdouble\b[^;(){{}}]*\b{name}\b", text) is not None


def without_comments(text):
    return re.sub(r"/\*.*?\*/", lambda c: "\n" * c.group().count("\n"), text, flags=re.DOTALL)


def sums(source, headers=""):
    """Numbers of the lines where a loop adds real numbers up."""
    text = without_comments(source)
    if CALL.search(text):
        return
    members = text + without_comments(headers)
    for loop in LOOP.finditer(text):
        inside = repeated(text, loop.start())
        function = text[text.rfind("\n}", 0, loop.start()) + 1:loop.start()]
        head = text[loop.start():closing(text, loop.end() - 1) + 1]
        names = "|".join([BOUND, *(rf"\b{name}\b" for name in RENAMED.findall(function))])
        if not re.search(names, head):
            continue
        counter = COUNTER.search(head).group(1)
        for added in ADDED.finditer(inside):
            whole, name, index = added.groups()
            by_entry = re.search(rf"\[[^\]]*\b{counter}\b", whole + index)
            known = members if "." in whole or "->" in whole else function
            if is_real(name, inside) or by_entry or not is_real(name, known):
                continue
            yield text.count("\n", 0, text.index(inside, loop.start()) + added.start()) + 1


found = []
for folder in sorted({"/".join(p.split("/")[:3])
                      for p in tap.files("plugins/solver", "plugins/effect", suffixes=(".c",))}):
    paths = tap.files(folder, suffixes=(".c", ".h"))
    headers = "\n".join(tap.read(path) for path in paths if path.endswith(".h"))
    for path in paths:
        found += [f"{path}:{number}: call sum of <gamut/host.h>"
                  for number in sums(tap.read(path), headers)]
tap.check("solvers and effects add over blocks by sum", found)
tap.check("and the check finds those that do not",
          [f"not found: {text}" for text in BAD if not list(sums(text))] +
          [f"refused: {text}" for text in GOOD if list(sums(text))])
tap.done()
