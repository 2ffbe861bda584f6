"""No plugin takes a branch by a text: what `gamut header` makes of a choice or of the measures is
an enum, and a `switch` over it without `default` lets the compiler find what the code lacks."""

import re

import tap

LITERAL = r'\\?"(?:[^"\\]|\\.)*\\?"'
RULES = (
    ("compares with a literal", re.compile(r"\bstr(?:n|case|ncase)?cmp\s*\([^;{]*?" + LITERAL)),
    ("looks for a literal", re.compile(
        r"\bstr(?:str|chr|casestr)\s*\([^;{]*?(?:" + LITERAL + r"|'.')")),
    ("takes a letter of a text", re.compile(r"\bgamut_text\s*\([^;()]*\)\s*\[")),
    ("compares the text of a choice", re.compile(r"\bstr\w*cmp\s*\([^;{]*?\bgamut_text\b")),
    ("has a switch with `default`", re.compile(r'^\s*(?:"\s*)?default\s*:(?!\s*\w+[,}])', re.M)),
    ("compares a letter", re.compile(
        r"\b(?:name|kind|text|word|wanted|mode)\s*\[\s*\d\s*\]\s*[!=]=")),
)
WRONG = (
    'load->kind = strcmp(kind, "cyclic") == 0 ? CYCLIC : MONOTONIC;',
    'if (strcmp(name,\n           "work") == 0)',
    'bool dense = strncmp(wanted, "dense", 5) == 0;',
    'bool truly = strstr(name, "_true") != NULL;',
    "noise_read(values, gamut_text(values, \"distribution\")[0] == 'w')",
    "while (strcmp(component[c], gamut_text(arguments, \"component\")) != 0)",
    "return name[0] == 'x' ? 0 : 1;",
    "switch (spall_mode_of(values)) {\n  default:\n    return 0;\n  }",
    '    "  if (strcmp(name, \\"mean_position_x\\") != 0)\\n"',
)
RIGHT = (
    "while (strcmp(point->body, body_name) != 0)",
    'gamut_fail(m->run, GAMUT_SCENE, "the shape is %s", gamut_text(values, "shape"));',
    "switch (spall_mode_of(values)) {\n  case SPALL_MODE_TEAR:\n    return 0;\n  }",
)


def findings(path, text):
    text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.S)
    return [f"{path}:{text.count(chr(10), 0, match.start()) + 1}: {what}: {match[0][:60]!r}"
            for what, rule in RULES for match in rule.finditer(text)]


def main():
    tap.check("each of these is seen", [wrong for wrong in WRONG if not findings("", wrong)])
    tap.check("none of these is taken for one",
              [found for right in RIGHT for found in findings("", right)])
    sources = tap.files("plugins", suffixes=(".c", ".h"))
    tap.check(f"no plugin of the tree does so ({len(sources)} files)",
              [f for path in sources for f in findings(path, tap.read(path))])
    skeletons = [p for p in tap.files("framework/command", suffixes=(".c",)) if "new_template" in p]
    tap.check(f"nor a skeleton ({len(skeletons)} files)",
              [f for path in skeletons for f in findings(path, tap.read(path))])
    rules = tap.read("plugins/rules.mk")
    tap.check("a switch that lacks a case does not compile in a plugin",
              [] if "-Werror=switch" in rules else ["plugins/rules.mk: -Werror=switch is missing"])


main()
tap.done()
