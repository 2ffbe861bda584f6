/* The registry: discovery, order, shadowing, unsafe folders, suggestions; plugins compiled on the
 * fly where there is a compiler. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <fenv.h>
#include <ftw.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/tap.h"
#include "registry/registry.h"

static struct units *units;
static char folder[PATH_MAX];

static void write_file(const char *path, const char *text)
{
  FILE *file = fopen(path, "w");
  if (file) {
    fputs(text, file);
    fclose(file);
  }
}

/* Makes ROOT/KIND/NAME/NAME.yaml. */
static void make_plugin(const char *root, const char *kind, const char *name, const char *rest)
{
  char path[PATH_MAX * 2], text[2048];
  snprintf(path, sizeof path, "mkdir -p '%s/%s/%s/%s'", folder, root, kind, name);
  if (system(path) != 0)
    return;
  snprintf(path, sizeof path, "%s/%s/%s/%s/%s.yaml", folder, root, kind, name, name);
  snprintf(text, sizeof text, "plugin: %s/%s\nversion: \"1\"\nsummary: %s\n%s", kind, name, root,
           rest);
  write_file(path, text);
}

#define EOS_REST "inputs: [compression]\noutputs: [pressure, sound_speed]\n"
#define STRENGTH_REST "inputs: [plastic_strain]\noutputs: [flow_stress]\n"

static struct registry *make_registry(const char *paths, struct trace *trace)
{
  struct registry *registry = NULL;
  struct registry_options options = {.plugin_path = paths, .user_plugins = false};
  tap_ok(registry_new(&options, units, trace, &registry) == GAMUT_OK, "registry over %s",
         paths ? "the given folders" : "nothing");
  return registry;
}

static char *told(struct trace *trace)
{
  static char words[16384];
  FILE *file = tmpfile();
  trace_print(trace, file);
  rewind(file);
  words[fread(words, 1, sizeof words - 1, file)] = 0;
  fclose(file);
  return words;
}

static void test_discovery(void)
{
  char paths[3 * PATH_MAX];
  struct place place = {.file = "scene.yaml", .line = 1, .column = 1, .width = 1};
  struct trace *trace = trace_new();
  make_plugin("first", "eos", "linear", EOS_REST);
  make_plugin("first", "strength", "voce", STRENGTH_REST);
  make_plugin("second", "eos", "linear",
              "inputs: [compression]\n"
              "outputs: [pressure, sound_speed, pressure_slope_compression]\n");
  make_plugin("second", "eos", "cubic", EOS_REST);
  make_plugin("second", "eos", "broken",
              "inputs: [compresion]\noutputs: [pressure, sound_speed]\n");
  snprintf(paths, sizeof paths, "%s/first:%s/second", folder, folder);
  struct registry *registry = make_registry(paths, trace);
  tap_ok(registry_count(registry) == 3, "%zu plugins, 3 expected", registry_count(registry));
  tap_text("sorted by id", registry_at(registry, 0)->id, "eos/cubic");
  tap_text("the first folder wins", registry_find(registry, "eos/linear")->summary, "first");
  tap_ok(!registry_find(registry, "eos/broken"), "a faulty YAML is no plugin");
  const char *words = told(trace);
  tap_ok(strstr(words, "is shadowed by") && strstr(words, "/second/eos/linear"),
         "the shadowed one of another interface is noted");
  tap_ok(strstr(words, "broken.yaml") && trace_errors(trace) == 0, "the faulty one is a warning");

  tap_ok(registry_expect(registry, GAMUT_KIND_EOS, "cubic", &place, "a", trace) != NULL,
         "expected");
  tap_ok(!registry_expect(registry, GAMUT_KIND_EOS, "lineer", &place, "a", trace) &&
             strstr(told(trace), "did you mean 'linear'?"),
         "the nearest is suggested");
  tap_ok(!registry_expect(registry, GAMUT_KIND_EOS, "voce", &place, "a", trace) &&
             strstr(told(trace), "plugin of kind strength"),
         "another kind is named");
  tap_ok(trace_worst(trace) == GAMUT_SCENE, "blamed on the scene");
  tap_ok(!registry_expect(registry, GAMUT_KIND_EOS, "broken", &place, "a", trace) &&
             strstr(told(trace), "did you mean 'compression'?"),
         "the faults of a YAML that is wanted are told");

  FILE *file = tmpfile();
  registry_paths(registry, file);
  tap_ok(ftell(file) > 100, "folders are listed");
  fclose(file);
  registry_free(registry);
  trace_free(trace);
}

static void test_unsafe(void)
{
  char paths[3 * PATH_MAX], open_folder[PATH_MAX + 16];
  struct trace *trace = trace_new();
  make_plugin("open", "eos", "linear", EOS_REST);
  snprintf(open_folder, sizeof open_folder, "%s/open", folder);
  chmod(open_folder, 0777);
  snprintf(paths, sizeof paths, "%s:relative/folder:%s/absent", open_folder, folder);
  struct registry *registry = make_registry(paths, trace);
  const char *words = told(trace);
  tap_ok(registry_count(registry) == 0, "nothing comes from unsafe folders");
  tap_ok(strstr(words, "everybody may write to it") != NULL, "writable by all: said");
  tap_ok(strstr(words, "it is not absolute") != NULL, "relative: said");
  tap_ok(strstr(words, "it does not exist") != NULL, "absent: said");
  registry_free(registry);
  chmod(open_folder, 0775);
  registry = make_registry(open_folder, trace);
  tap_ok(registry_count(registry) == 0 && strstr(told(trace), "its group may write to it"),
         "writable by the group: skipped and said");
  registry_free(registry);
  chmod(open_folder, 0755);
  registry = make_registry(open_folder, trace);
  tap_ok(registry_count(registry) == 1, "safe again: found");
  registry_free(registry);
  trace_free(trace);
}

static void test_add(void)
{
  char path[PATH_MAX + 64];
  const struct descriptor *added = NULL, *again = NULL;
  struct trace *trace = trace_new();
  snprintf(path, sizeof path, "%s/first", folder);
  struct registry *registry = make_registry(path, trace);
  snprintf(path, sizeof path, "%s/second/eos/linear", folder);
  tap_ok(registry_add(registry, path, trace, &added) == GAMUT_OK, "a folder is added");
  tap_text("and wins", registry_find(registry, "eos/linear")->summary, "second");
  snprintf(path, sizeof path, "%s/second/eos/linear/linear.yaml", folder);
  tap_ok(registry_add(registry, path, trace, &again) == GAMUT_OK && again == added,
         "the same file again is the same plugin");
  snprintf(path, sizeof path, "%s/second/eos/none", folder);
  tap_ok(registry_add(registry, path, trace, &again) == GAMUT_PLUGIN, "an absent one is refused");
  snprintf(path, sizeof path, "%s/second/eos/broken", folder);
  tap_ok(registry_add(registry, path, trace, &again) == GAMUT_PLUGIN &&
             strstr(told(trace), "compresion"),
         "a faulty one is refused with its faults");
  registry_free(registry);
  trace_free(trace);
}

static void test_pairs(void)
{
  char path[PATH_MAX + 64];
  const struct gamut_plugin *plugin;
  struct trace *trace = trace_new();
  snprintf(path, sizeof path, "mkdir -p '%s/build/plugins'", folder);
  tap_ok(system(path) == 0, "a build tree");
  snprintf(path, sizeof path, "%s/build/plugins.path", folder);
  write_file(path, "../first plugins\n");
  snprintf(path, sizeof path, "%s/build", folder);
  struct registry *registry = make_registry(path, trace);
  const struct descriptor *d = registry_find(registry, "eos/linear");
  tap_ok(d != NULL, "plugins.path is followed");
  snprintf(path, sizeof path, "%s/build/plugins/eos/linear/linear.so", folder);
  if (d)
    tap_ok(registry_open(registry, d, trace, &plugin) == GAMUT_PLUGIN && strstr(told(trace), path),
           "the shared object is looked for in the second folder");
  registry_free(registry);
  trace_free(trace);
}

static const char source[] =
    "#include <stddef.h>\n#include <stdint.h>\n"
    "struct plugin { size_t size; uint32_t abi, kind; const char *name, *digest; size_t block;\n"
    "  const void *ops; };\n"
    "struct ops { size_t size; void (*pressure)(const void *), (*derivatives)(const void *); };\n"
    "static void pressure(const void *b) { (void)b; }\n"
    "static const struct ops ops = {sizeof ops, PRESSURE, 0};\n"
    "void missing_function(void);\n"
    "#ifdef MISSING\nvoid use(void) { missing_function(); }\n#endif\n"
    "#ifdef ROUND\n#include <fenv.h>\n"
    "__attribute__((constructor)) static void round_up(void) { fesetround(FE_UPWARD); }\n#endif\n"
    "const struct plugin SYMBOL = {sizeof(struct plugin), ABI, KIND, NAME, DIGEST, BLOCK, &ops};\n";

static bool compile(const struct descriptor *d, const char *suffix, const char *flags)
{
  char command[4 * PATH_MAX];
  snprintf(command, sizeof command, "%s/plugin.c", folder);
  write_file(command, source);
  /* The compiler takes the last of two definitions of a name, so `flags` wins. */
  snprintf(command, sizeof command,
           "cc -w -shared -fPIC -DSYMBOL=%s_LTX_gamut_plugin -DABI=%d -DKIND=%d "
           "-DNAME='\"%s\"' -DDIGEST='\"%s\"' -DBLOCK=%zu -DPRESSURE=pressure %s -o '%s/%s%s.so' "
           "'%s/plugin.c' -lm 2>/dev/null",
           d->name, GAMUT_ABI, (int)d->kind, d->name, d->digest, 5 * sizeof(void *), flags,
           d->folder, d->name, suffix, folder);
  return system(command) == 0;
}

/* Each case is a plugin of its own: a shared object stays loaded. */
static void test_open(void)
{
  static const struct {
    const char *name, *flags, *words; /* null words: opens */
  } cases[] = {
      {"good", "", NULL},
      {"old", "-UABI -DABI=77", "ABI 77"},
      {"stale", "-UDIGEST -DDIGEST='\"0\"'", "built from another version of stale.yaml"},
      {"alias", "-UNAME -DNAME='\"other\"'", "registered as 'other'"},
      {"wrongkind", "-UKIND -DKIND=1", "registered as strength"},
      {"small", "-UBLOCK -DBLOCK=16", "has 16 bytes"},
      {"nosymbol", "-USYMBOL -DSYMBOL=other", "exports no 'nosymbol_LTX_gamut_plugin'"},
      {"empty", "-UPRESSURE -DPRESSURE=0", "registers no 'pressure'"},
      {"undefined", "-DMISSING", "undefined symbol: missing_function"},
      {"rounding", "-DROUND", "changes the processor's rounding"},
  };
  char root[PATH_MAX + 16];
  struct trace *trace = trace_new();
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    make_plugin("objects", "eos", cases[i].name, EOS_REST);
  make_plugin("objects", "eos", "junk", EOS_REST);
  snprintf(root, sizeof root, "%s/objects", folder);
  struct registry *registry = make_registry(root, trace);
  const struct gamut_plugin *plugin;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char id[64];
    snprintf(id, sizeof id, "eos/%s", cases[i].name);
    const struct descriptor *d = registry_find(registry, id);
    if (!d || !compile(d, "", cases[i].flags)) {
      tap_skip(cases[i].name, "no compiler");
      continue;
    }
    gamut_status status = registry_open(registry, d, trace, &plugin);
    const char *words = told(trace);
    bool good = cases[i].words ? status == GAMUT_PLUGIN && strstr(words, cases[i].words) && !plugin
                               : status == GAMUT_OK && plugin && registry_level(registry, d);
    if (!tap_ok(good, "%s: %s", cases[i].name, cases[i].words ? cases[i].words : "opens"))
      printf("# %s\n", words);
    tap_ok(fegetround() == FE_TONEAREST, "%s: rounding is as before", cases[i].name);
    tap_ok(registry_open(registry, d, trace, &plugin) == status, "%s: the same again",
           cases[i].name);
  }
  const struct descriptor *junk = registry_find(registry, "eos/junk");
  char path[PATH_MAX + 64];
  snprintf(path, sizeof path, "%s/objects/eos/junk/junk.so", folder);
  write_file(path, "not a shared object");
  tap_ok(registry_open(registry, junk, trace, &plugin) == GAMUT_PLUGIN &&
             strstr(told(trace), "no ELF file"),
         "junk: the real reason");
  registry_free(registry);
  trace_free(trace);
}

static void test_level(void)
{
  char root[PATH_MAX + 16];
  const struct gamut_plugin *plugin;
  struct trace *trace = trace_new();
  make_plugin("levels", "eos", "capped", EOS_REST);
  snprintf(root, sizeof root, "%s/levels", folder);
  struct registry *registry = make_registry(root, trace);
  const struct descriptor *d = registry_find(registry, "eos/capped");
  setenv("GAMUT_LEVEL", "baseline", 1);
  if (!compile(d, "", "") || !compile(d, ".v3", "") || !compile(d, ".v4", "")) {
    tap_skip("levels", "no compiler");
  } else {
    tap_ok(!registry_is_open(registry, d), "not open before it is asked for");
    tap_ok(registry_open(registry, d, trace, &plugin) == GAMUT_OK, "opens");
    tap_text("GAMUT_LEVEL caps", registry_level(registry, d), "baseline");
  }
  unsetenv("GAMUT_LEVEL");
  registry_free(registry);
  trace_free(trace);
}

static int remove_item(const char *path, const struct stat *info, int type, struct FTW *where)
{
  (void)info;
  (void)type;
  (void)where;
  return remove(path);
}

int main(void)
{
  char why[256], made[] = "test_registry_XXXXXX";
  umask(022);
  unsetenv("GAMUT_PLUGIN_PATH");
  unsetenv("GAMUT_LEVEL");
  units = units_new(why, sizeof why);
  if (!units || !mkdtemp(made) || !realpath(made, folder))
    return 99;
  test_discovery();
  test_unsafe();
  test_add();
  test_pairs();
  test_open();
  test_level();
  nftw(folder, remove_item, 16, FTW_DEPTH | FTW_PHYS);
  units_free(units);
  return tap_done();
}
