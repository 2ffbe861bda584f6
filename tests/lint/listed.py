"""Nothing lies in the tree that no Makefile.inc knows."""

import os

import tap


def words(*paths):
    found = set()
    for path in paths:
        if os.path.exists(os.path.join(tap.ROOT, path)):
            for line in tap.read(path).split("\n"):
                found.update(line.split("#")[0].split())
    return found


fragments = [p for p in tap.files("framework", "plugins", "tests", "inputs")
             if p.endswith("Makefile.inc")]
listed = words("Makefile.am", *fragments)
kinds = sorted({"/".join(p.split("/")[1:3]) for p in tap.files("plugins") if p.count("/") > 2})

tap.check("every source of the framework is listed",
          [p for p in tap.files("framework", suffixes=(".c",)) if p not in listed])
tap.check("every public header is listed",
          [p for p in tap.files("framework/include", suffixes=(".h",)) if p not in listed])
tap.check("every source of a plugin is listed",
          [p for p in tap.files("plugins", suffixes=(".c",)) if p not in listed])
tap.check("every plugin is listed", [k for k in kinds if k not in listed])
def without(ending, kinds):
    return [f"plugins/{k}/{k.split('/')[1]}{ending}" for k in kinds
            if not os.path.exists(os.path.join(tap.ROOT, "plugins", k, k.split("/")[1] + ending))]


tap.check("every scene and card is listed",
          [p for p in tap.files("inputs", suffixes=(".yaml",)) if p not in listed])
tap.check("every plugin has its descriptor", without(".yaml", kinds))
tap.check("every law has its known answers",
          without(".test.yaml", [k for k in kinds if k.startswith(("eos/", "strength/", "elast"))]))
tap.check("every unit test is listed",
          [p for p in tap.files("tests/unit", suffixes=(".c",))
           if p not in listed and p[:-2] not in listed])
tap.check("every listed file is there",
          [w for w in sorted(listed) if w.endswith((".c", ".h", ".sh", ".py")) and "/" in w
           and "$" not in w and w.split("/")[0] in ("framework", "plugins", "tests")
           and not os.path.exists(os.path.join(tap.ROOT, w))])
tap.done()
