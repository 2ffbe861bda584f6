#include "command/help.h"
#include "base/array.h"

#include <string.h>

#include "command/command.h"

static const struct entry {
  const char *name, *arguments, *line;
} entries[] = {
#define HELP_ENTRY(name, function, arguments, line) {name, arguments, line},
    COMMAND_LIST(HELP_ENTRY)
#undef HELP_ENTRY
};
enum { ENTRIES = ARRAY_SIZE(entries) };

static const struct details {
  const char *name, *text;
} details[] = {
    {"run",
     "The scene is checked first; when it is wrong nothing is written.\n"
     "\n"
     "  -o DIR             folder of the results (default: the scene's name with -results)\n"
     "  --set path=value   overrides a value of the scene, e.g. --set 'solver.cell=0.2 mm'\n"
     "  --threads N        threads (default: OMP_NUM_THREADS, or all cores)\n"
     "  --resume           goes on from the last checkpoint in DIR, to the same bits; of a study:\n"
     "                     repeats no finished run. Only solver.end and outputs may differ\n"
     "  --retry-failed     as --resume, and makes the runs again that failed\n"
     "  --force            replaces a result that is already there\n"
     "  --json             prints the summary as JSON\n"
     "\n"
     "DIR holds results.h5, results.xdmf, history.csv, summary.json and scene.yaml.\n"
     "A scene with uncertainty.estimator is a study: its runs go side by side on the threads,\n"
     "each finished one is kept in study.log, and study.csv has a row a run. Ctrl-C or a TERM\n"
     "signal stops it with exit code 75; --resume goes on.\n"
     "When the numbers fail the last state is written and the exit code is 5. On Ctrl-C, TERM or\n"
     "HUP the step is finished, the results so far (\"status\": \"interrupted\") and a\n"
     "checkpoint are written, and the exit code is 75. outputs.checkpoint in the scene leaves one\n"
     "every so often: {every: 10 us} of the run, or 10 min by the clock.\n"},
    {"check", "Prints every mistake with its place. Opens no plugin and writes nothing.\n"
              "\n"
              "  --set path=value   overrides a value of the scene\n"},
    {"explain",
     "Plans the run and says which effects are on or off and why, which tasks run in which\n"
     "order, which fields are stored, and the bytes a point and in all. Runs nothing.\n"
     "\n"
     "  --set path=value   overrides a value of the scene\n"
     "  --json             prints the plan as JSON\n"},
    {"eval",
     "PLUGIN is an eos or a strength, e.g. eos/linear.\n"
     "\n"
     "  --param k=v        a parameter; several after one option, or separated by commas.\n"
     "                     A value may carry a unit ('bulk_modulus=10 GPa'); a bare number is SI\n"
     "  --at k=v           an input: compression, energy, reference_density of an eos;\n"
     "                     plastic_strain, plastic_strain_rate, temperature of a strength.\n"
     "                     k=from:to:count is a range: it gives count points\n"
     "  --derivatives      first and second derivatives by the parameters\n"
     "  --json             one JSON object, all in SI, full precision\n"
     "\n"
     "Inputs that are not given: energy, compression, plastic strain and rate are 0,\n"
     "temperature is 298 K; reference_density must be given where the law reads it.\n"},
    {"list", "  --paths            where plugins are looked for, and what was skipped\n"
             "  --json             as JSON\n"},
    {"show", "  --json             as JSON\n"},
    {"verify", "Prints TAP: each line has the measured figure beside its tolerance.\n"
               "\n"
               "  PLUGIN             an installed one, e.g. strength/johnson_cook\n"
               "  FOLDER             of a plugin that is being written, e.g. ./mine\n"
               "  --all              every plugin that can be found\n"
               "  --kind KIND        with --all: only those of one kind\n"},
    {"new", "KIND is eos, strength, elasticity, effect, random_field, estimator or solver. The\n"
            "skeleton is a whole, small plugin: it builds with make and passes gamut verify.\n"
            "\n"
            "  -o FOLDER          where (default: NAME in the current folder)\n"},
    {"header", "Prints NAME.gamut.h, which the plugin's C file includes.\n"},
    {"schema", "  -o FILE            writes the file instead of printing\n"},
    {"plot", "  --field NAME       colour of the body (default: one that is there)\n"
             "  --frame N          which frame (default: the last)\n"
             "  -o DIR             where the pictures go (default: DIR of the result)\n"},
};

static const char common[] = "Common options:\n"
                             "  --plugin-path DIR  looks for plugins there first\n"
                             "  --no-user-plugins  does not look in the user's own plugin folder\n"
                             "  --help             this text; after a command: its own\n"
                             "  --version          the version\n";

void help_all(FILE *out)
{
  fputs("gamut runs material and impact models that are put together from plugins.\n\n"
        "Usage: gamut COMMAND ...\n\n",
        out);
  for (size_t i = 0; i < ENTRIES; i++)
    fprintf(out, "  %-9s %s\n", entries[i].name, entries[i].line);
  fprintf(out, "\n%s\nExit codes:\n", common);
#define HELP_CODE(name, code, text) fprintf(out, "  %2d  %s\n", code, text);
  GAMUT_STATUS_LIST(HELP_CODE)
#undef HELP_CODE
  fputs("\n'gamut help COMMAND' says more about one command.\n", out);
}

bool help_command(const char *name, FILE *out)
{
  for (size_t i = 0; i < ENTRIES; i++) {
    if (strcmp(entries[i].name, name) != 0)
      continue;
    fprintf(out, "gamut %s: %s\n\nUsage: gamut %s %s\n\n", name, entries[i].line, name,
            entries[i].arguments);
    for (size_t k = 0; k < ARRAY_SIZE(details); k++)
      if (strcmp(details[k].name, name) == 0)
        fprintf(out, "%s\n", details[k].text);
    fputs(common, out);
    return true;
  }
  return false;
}
