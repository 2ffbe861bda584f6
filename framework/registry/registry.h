/* Finds descriptors, opens shared objects. Discovery reads YAML only; a shared object is opened
 * when a plan needs it, and stays until the program ends. */
#ifndef GAMUT_REGISTRY_H
#define GAMUT_REGISTRY_H

#include <fenv.h>

#include <gamut/plugin.h>

#include "base/error.h"
#include "descriptor/descriptor.h"
#include "unit/unit.h"

struct registry;

/* Where plugins are looked for, in order: --plugin-path, GAMUT_PLUGIN_PATH (ignored when the
 * program is privileged), $XDG_DATA_HOME/gamut/plugins (off with user_plugins false), the plugins
 * beside the build tree's command when it runs in place, then the installed folder. Only absolute
 * folders that belong to the user, to root or to the owner of the running program, and that nobody
 * else may write; others are skipped with a warning (the build tree of the running program may be
 * shared with a group). The first of two plugins with one id wins; the shadowed one is noted if it
 * is another edition (version, interface). A plugin whose YAML has faults is skipped with a
 * warning; where a scene names it, its faults are reported.
 *
 * Below such a folder a plugin is KIND/NAME/NAME.yaml, NAME/NAME.yaml or NAME.yaml, with its shared
 * objects beside it or in .libs there. The build tree keeps the two apart: a file `plugins.path` in
 * the folder of the running executable has lines "YAMLDIR SODIR" (one blank, both relative to that
 * folder, e.g. "../plugins plugins"), and SODIR/KIND/NAME/NAME.so belongs to
 * YAMLDIR/KIND/NAME/NAME.yaml. The installed folder is the one beside the running program, which
 * may have been moved with it, or else GAMUT_PLUGIN_FOLDER, as the build defines it. A folder with
 * a plugins.path may also be named in --plugin-path or GAMUT_PLUGIN_PATH (tests do). */
struct registry_options {
  const char *plugin_path;
  bool user_plugins;
};

gamut_status registry_new(const struct registry_options *, const struct units *, struct trace *,
                          struct registry **);
void registry_free(struct registry *);

size_t registry_count(const struct registry *);
const struct descriptor *registry_at(const struct registry *, size_t index); /* sorted by id */
/* By "kind/name"; null if not installed. */
const struct descriptor *registry_find(const struct registry *, const char *id);
/* By kind and name. On failure records GAMUT_SCENE at `place`: suggests the nearest of that kind,
 * or says that NAME is a plugin of another kind. */
const struct descriptor *registry_expect(const struct registry *, enum gamut_kind, const char *name,
                                         const struct place *, const char *path, struct trace *);
/* Adds one plugin from its YAML file, or from a folder NAME with NAME.yaml
 * (`gamut verify ./mine`). It wins over others with its id. */
gamut_status registry_add(struct registry *, const char *path, struct trace *,
                          const struct descriptor **);

/* Opens the plugin's shared object (once) and checks it: symbol, sizes, ABI, kind, name, digest,
 * block size, floating-point flags unchanged by loading. Refused with GAMUT_PLUGIN and the real
 * reason, naming the file. Any thread.
 *
 * Each instruction-set level is a shared object of its own, and all export the plain symbol
 * NAME_LTX_gamut_plugin. Of these the first that exists and that this processor can run is opened:
 *   NAME.v4.so  x86-64-v4   __builtin_cpu_supports("x86-64-v4")
 *   NAME.v3.so  x86-64-v3   __builtin_cpu_supports("x86-64-v3")
 *   NAME.so     baseline    always there
 * NAME.so alone is a whole plugin; that is what a stranger builds. The environment's GAMUT_LEVEL
 * (baseline, v3 or v4) sets the highest level to take. */
gamut_status registry_open(struct registry *, const struct descriptor *, struct trace *,
                           const struct gamut_plugin **);
/* What a plugin must leave alone: rounding, flushing of small numbers, traps. */
bool same_arithmetic(const fenv_t *before, const fenv_t *after);
/* Instruction-set level that was picked ("x86-64-v4", "baseline"); null if not opened. */
const char *registry_level(const struct registry *, const struct descriptor *);
/* The file that was opened, or would be; false if there is none. */
bool registry_object(const struct registry *, const struct descriptor *, char *file, size_t size);
bool registry_is_open(const struct registry *, const struct descriptor *);
/* Where a folder that was to be installed at `folder` (as the build was configured) stands beside a
 * program that runs in the folder `program`: "PREFIX/lib/gamut/plugins" for
 * "/usr/lib/gamut/plugins" and "PREFIX/bin". False where the program does not stand in a folder of
 * programs. */
bool installed_beside(const char *program, const char *folder, char *path, size_t size);
/* Where a file or folder that comes with gamut is, by its place in the tree ("inputs/x.yaml",
 * "share/templates/eos"): in the tree of a program that was built in place, beside an installed
 * one, or where it was to be installed. False if it is nowhere. */
bool installed_data(const char *name, char *path, size_t size);
/* Prints where was looked, what was skipped and why, what is shadowed. */
void registry_paths(const struct registry *, FILE *);

#endif
