/* Subcommands: one file each. */
#ifndef GAMUT_COMMAND_H
#define GAMUT_COMMAND_H

#include "base/error.h"
#include "registry/registry.h"
#include "unit/unit.h"

/* What every command gets: made in main, after the common options were taken out of argv
 * (--plugin-path DIR, --no-user-plugins). argv[0] is the subcommand's name. */
struct command {
  int argc;
  char **argv;
  struct trace *trace;
  struct units *units;
  struct registry *registry;
};

/* X(name, function, arguments, one line) */
#define COMMAND_LIST(X)                                                                            \
  X("run", command_run,                                                                            \
    "SCENE [-o DIR] [--set path=value]... [--threads N] [--resume] [--retry-failed] [--force] "    \
    "[--json]",                                                                                    \
    "runs a scene, or a study of many runs")                                                       \
  X("check", command_check, "SCENE [--set path=value]...", "validates a scene, runs nothing")      \
  X("explain", command_explain, "SCENE [--set path=value]... [--json]",                            \
    "what a run would do: effects, tasks, fields, bytes")                                          \
  X("eval", command_eval, "PLUGIN [--param k=v]... [--at k=v]... [--derivatives] [--json]",        \
    "one kernel at given states")                                                                  \
  X("list", command_list, "[--paths] [--json]", "what is installed and where it was found")        \
  X("show", command_show, "PLUGIN [--json]", "one plugin's declaration")                           \
  X("verify", command_verify, "PLUGIN|FOLDER|--all", "the checks that any plugin must pass")       \
  X("new", command_new, "KIND/NAME [-o FOLDER]", "a plugin skeleton that builds and verifies")     \
  X("header", command_header, "FILE.yaml", "the C declarations of a plugin")                       \
  X("schema", command_schema, "[-o FILE]", "JSON Schema of scenes, for editors")                   \
  X("plot", command_plot, "DIR [--field NAME] [--frame N] [-o DIR]", "pictures of a result")

#define COMMAND_DECLARE(name, function, arguments, line)                                           \
  gamut_status function(struct command *);
COMMAND_LIST(COMMAND_DECLARE)
#undef COMMAND_DECLARE

#endif
