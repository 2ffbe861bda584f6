/* Opens a plugin's shared object and checks that it is what its YAML says. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <dlfcn.h>
#include <errno.h>
#include <fenv.h>
#include <limits.h>
#include <ltdl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/exclusive.h"
#include "base/memory.h"
#include "registry/elf.h"
#include "registry/guard.h"
#include "registry/registry_private.h"

typedef void (*operation)(void);

/* Keeps the reason and records it. */
static gamut_status refuse(struct entry *entry, struct trace *trace, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static gamut_status refuse(struct entry *entry, struct trace *trace, const char *format, ...)
{
  char words[3 * PATH_MAX];
  int length = snprintf(words, sizeof words, "plugin %s is refused: ", entry->descriptor->id);
  va_list list;
  va_start(list, format);
  vsnprintf(words + length, sizeof words - (size_t)length, format, list);
  va_end(list);
  free(entry->refusal);
  entry->refusal = memory_copy(words);
  return trace_fail(trace, GAMUT_PLUGIN, "%s", words);
}

static const struct {
  const char *suffix, *level, *word;
} levels[] = {{".v4", "x86-64-v4", "v4"}, {".v3", "x86-64-v3", "v3"}, {"", "baseline", "baseline"}};
enum { LEVELS = ARRAY_SIZE(levels) };

static bool processor_has(size_t level)
{
  if (level == LEVELS - 1)
    return true;
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
  __builtin_cpu_init();
  return level == 0 ? __builtin_cpu_supports("x86-64-v4") : __builtin_cpu_supports("x86-64-v3");
#else
  return false;
#endif
}

/* The highest level that GAMUT_LEVEL allows. */
static size_t level_allowed(struct trace *trace)
{
  const char *word = secure_getenv("GAMUT_LEVEL");
  if (!word || !word[0])
    return 0;
  for (size_t i = 0; i < LEVELS; i++)
    if (strcmp(word, levels[i].word) == 0 || strcmp(word, levels[i].level) == 0)
      return i;
  static const struct place nowhere = {0};
  trace_warn_at(trace, &nowhere, NULL, "baseline, v3 or v4",
                "GAMUT_LEVEL is '%s', which is no level; it is ignored", word);
  return 0;
}

static bool find_object(struct entry *entry, struct trace *trace, char *file, size_t size)
{
  static const char *const below[] = {"", "/.libs"};
  for (size_t i = level_allowed(trace); i < LEVELS; i++)
    for (size_t k = 0; processor_has(i) && k < ARRAY_SIZE(below); k++) {
      snprintf(file, size, "%s%s/%s%s.so", entry->objects, below[k], entry->descriptor->name,
               levels[i].suffix);
      if (is_file(file)) {
        entry->level = levels[i].level;
        return true;
      }
    }
  return false;
}

bool same_arithmetic(const fenv_t *before, const fenv_t *after)
{
#if defined(__x86_64__)
  /* Bits 0 to 5 of MXCSR only say what has happened. */
  return before->__control_word == after->__control_word &&
         (before->__mxcsr & 0xFFC0U) == (after->__mxcsr & 0xFFC0U);
#else
  return memcmp(before, after, sizeof *before) == 0;
#endif
}

static gamut_status load_object(struct registry *registry, struct entry *entry, const char *file,
                                struct trace *trace, lt_dlhandle *handle)
{
  /* Never undone: what was opened stays until the program ends. */
  if (!registry->started && lt_dlinit() != 0)
    return trace_fail(trace, GAMUT_INTERNAL, "libltdl does not start: %s", lt_dlerror());
  registry->started = true;
  /* libltdl binds late and calls every failure "file not found"; this binds all symbols now and
   * knows the reason. */
  const char *before = guard_enter_long(entry->descriptor->id);
  void *early = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  guard_leave(before);
  if (!early)
    return refuse(entry, trace, "its shared object cannot be loaded: %s", dlerror());
  lt_dladvise advise;
  if (lt_dladvise_init(&advise) != 0 || lt_dladvise_local(&advise) != 0 ||
      lt_dladvise_resident(&advise) != 0)
    return trace_fail(trace, GAMUT_INTERNAL, "libltdl: %s", lt_dlerror());
  *handle = lt_dlopenadvise(file, advise);
  lt_dladvise_destroy(&advise);
  dlclose(early);
  if (!*handle)
    return refuse(entry, trace, "'%s' cannot be loaded: %s", file, lt_dlerror());
  return GAMUT_OK;
}

static gamut_status load_unchanged(struct registry *registry, struct entry *entry, const char *file,
                                   struct trace *trace, lt_dlhandle *handle)
{
  fenv_t before, after;
  fegetenv(&before);
  gamut_status status = load_object(registry, entry, file, trace, handle);
  fegetenv(&after);
  fesetenv(&before);
  if (status == GAMUT_OK && !same_arithmetic(&before, &after))
    status = refuse(entry, trace,
                    "loading '%s' changes the processor's rounding, flush-to-zero or trap flags; "
                    "build it without -ffast-math and its like",
                    file);
  return status;
}

static gamut_status check_plugin(struct entry *entry, const char *file,
                                 const struct gamut_plugin *plugin, struct trace *trace)
{
  const struct descriptor *d = entry->descriptor;
  if (plugin->abi != GAMUT_ABI)
    return refuse(entry, trace,
                  "'%s' was built for plugin ABI %u and this gamut has ABI %d: build it again with "
                  "the <gamut/plugin.h> of this gamut",
                  file, (unsigned)plugin->abi, GAMUT_ABI);
  if (plugin->size != sizeof *plugin)
    return refuse(
        entry, trace,
        "the plugin record in '%s' has %zu bytes and this gamut's has %zu: build it again "
        "with the <gamut/plugin.h> of this gamut",
        file, plugin->size, sizeof *plugin);
  if (!plugin->name || !plugin->digest || !plugin->ops)
    return refuse(entry, trace,
                  "the plugin record in '%s' is not filled in: register with "
                  "GAMUT_EOS(name, ...) and its like",
                  file);
  if (plugin->kind != (uint32_t)d->kind)
    return refuse(entry, trace, "'%s' is registered as %s and %s.yaml says %s", file,
                  plugin->kind < GAMUT_KINDS ? kind_name((enum gamut_kind)plugin->kind)
                                             : "an unknown kind",
                  d->name, kind_name(d->kind));
  if (strcmp(plugin->name, d->name) != 0)
    return refuse(entry, trace, "'%s' is registered as '%s' and the YAML says '%s'", file,
                  plugin->name, d->name);
  if (strcmp(plugin->digest, d->digest) != 0)
    return refuse(
        entry, trace,
        "'%s' was built from another version of %s.yaml (interface %s, now %s): build the "
        "plugin again (make)",
        file, d->name, plugin->digest, d->digest);
  struct slot *slots;
  size_t count = descriptor_layout(d, &slots);
  free(slots);
  size_t block = sizeof(size_t) + sizeof(int64_t *) + count * sizeof(double *);
  if (plugin->block_size != block)
    return refuse(entry, trace,
                  "the struct of a block in '%s' has %zu bytes and %s.yaml asks for %zu: write "
                  "%s.gamut.h again with `gamut header` and build",
                  file, plugin->block_size, d->name, block, d->name);
  return GAMUT_OK;
}

static bool measures_by_code(const struct descriptor *d)
{
  for (size_t i = 0; i < d->measures; i++)
    if (!d->measure[i].formula && d->measure[i].at != MEASURE_POINT)
      return true;
  return false;
}

static bool is_required(const struct descriptor *d, const char *name)
{
  static const char *const required[GAMUT_KINDS][8] = {
      [GAMUT_KIND_EOS] = {"pressure"},
      [GAMUT_KIND_STRENGTH] = {"flow_stress"},
      [GAMUT_KIND_ELASTICITY] = {"stress"},
      [GAMUT_KIND_RANDOM_FIELD] = {"sample"},
      [GAMUT_KIND_ESTIMATOR] = {"create", "destroy", "ask", "tell", "save", "restore"},
      [GAMUT_KIND_SOLVER] = {"create", "destroy", "start", "next"},
  };
  for (size_t i = 0; i < 8 && required[d->kind][i]; i++)
    if (strcmp(required[d->kind][i], name) == 0)
      return true;
  if (strcmp(name, "prepare") == 0 || strcmp(name, "release") == 0)
    return d->prepare;
  if (strcmp(name, "inverse") == 0)
    return d->inverse;
  if (d->kind == GAMUT_KIND_ESTIMATOR && strcmp(name, "report") == 0)
    return !d->yields_table;
  return strcmp(name, "measure") == 0 && measures_by_code(d);
}

static bool is_null(const void *operations, size_t index)
{
  operation found;
  memcpy(&found, (const char *)operations + sizeof(size_t) + index * sizeof found, sizeof found);
  return !found;
}

static gamut_status check_operations(struct entry *entry, const char *file, const void *operations,
                                     struct trace *trace)
{
  const struct descriptor *d = entry->descriptor;
  size_t own = 0, size;
  while (descriptor_operation(d, own))
    own++;
  const size_t expected = sizeof(size_t) + own * sizeof(operation);
  own -= d->variants + d->tasks;
  memcpy(&size, operations, sizeof size);
  if (size != expected)
    return refuse(entry, trace,
                  "the table of operations in '%s' has %zu bytes and should have %zu: write "
                  "%s.gamut.h again with `gamut header` and build",
                  file, size, expected, d->name);
  for (size_t i = 0; i < own + d->variants + d->tasks; i++) {
    const char *name = descriptor_operation(d, i);
    if (is_null(operations, i) && (i >= own || is_required(d, name)))
      return refuse(entry, trace, "'%s' registers no '%s', which %s", file, name,
                    i < own ? "plugins like this need" : "its YAML names as a kernel");
  }
  return GAMUT_OK;
}

/* Calls that end or replace the program where nothing can say whose they were. exit() and abort()
 * are named when they happen. */
static void take_ending(void *self, const char *name)
{
  static const char *const ending[] = {"_exit",  "_Exit", "quick_exit", "execv",   "execve",
                                       "execvp", "execl", "execlp",     "syscall", "vfork"};
  const char **found = self;
  for (size_t i = 0; i < ARRAY_SIZE(ending); i++)
    if (strcmp(name, ending[i]) == 0)
      *found = ending[i];
}

static gamut_status check_object(struct entry *entry, const char *file, struct trace *trace)
{
  struct elf_file elf;
  const char *ending = NULL;
  char why[3 * PATH_MAX];
  if (elf_load(&elf, file) && !digest_holds(file, elf.bytes, elf.size, why, sizeof why)) {
    elf_free(&elf);
    return refuse(entry, trace, "%s", why);
  }
  if (elf.why || !elf_check(&elf))
    return refuse(entry, trace, "its shared object cannot be loaded: '%s': %s", file, elf.why);
  elf_imports(&elf, take_ending, &ending);
  elf_free(&elf);
  /* What was read is what the path was judged by. */
  struct stat info;
  if (stat(file, &info) != 0 || info.st_uid != elf.owner || info.st_mode != elf.mode)
    return refuse(entry, trace, "'%s' changes while it is opened", file);
  if (ending)
    return refuse(entry, trace, "'%s' calls %s(), by which a plugin would end the program", file,
                  ending);
  return GAMUT_OK;
}

/* Whoever can change a folder on the way, the YAML or the shared object runs code as its user. */
static gamut_status check_owners(struct entry *entry, const char *file, struct trace *trace)
{
  const char *const path[] = {file, entry->file};
  for (size_t i = 0; i < ARRAY_SIZE(path); i++) {
    char part[PATH_MAX];
    const char *why = path_unsafe(path[i], part, sizeof part);
    if (why)
      return refuse(entry, trace,
                    "'%s' %s; plugins, and the folders on the way to them, belong to you or root "
                    "and may be written by their owner alone",
                    part, why);
  }
  return GAMUT_OK;
}

static gamut_status open_entry(struct registry *registry, struct entry *entry, struct trace *trace)
{
  const struct descriptor *d = entry->descriptor;
  char file[2 * PATH_MAX], symbol[160];
  lt_dlhandle handle = NULL;
  gamut_status status = GAMUT_OK;
  if (!find_object(entry, trace, file, sizeof file))
    return refuse(entry, trace, "there is no '%s/%s.so'; build the plugin first", entry->objects,
                  d->name);
  TRY(check_owners(entry, file, trace));
  TRY(check_object(entry, file, trace));
  TRY(load_unchanged(registry, entry, file, trace, &handle));
  snprintf(symbol, sizeof symbol, "%s_LTX_gamut_plugin", d->name);
  const struct gamut_plugin *plugin = lt_dlsym(handle, symbol);
  if (!plugin) {
    status = refuse(entry, trace,
                    "'%s' exports no '%s': end the C file with a registration line, "
                    "such as GAMUT_EOS(%s, ...)",
                    file, symbol, d->name);
    goto done;
  }
  TRY(check_plugin(entry, file, plugin, trace));
  TRY(check_operations(entry, file, plugin->ops, trace));
  entry->plugin = plugin;

done:
  return status;
}

static gamut_status open_once(struct registry *registry, const struct descriptor *descriptor,
                              struct trace *trace, const struct gamut_plugin **plugin)
{
  struct entry *entry = registry_entry(registry, descriptor);
  gamut_status status = GAMUT_OK;
  *plugin = NULL;
  if (!entry)
    return trace_fail(trace, GAMUT_INTERNAL, "plugin %s belongs to no registry", descriptor->id);
  if (entry->refusal)
    return trace_fail(trace, GAMUT_PLUGIN, "%s", entry->refusal);
  if (!entry->plugin)
    status = open_entry(registry, entry, trace);
  if (status != GAMUT_OK)
    entry->level = NULL;
  *plugin = entry->plugin;
  return status;
}

gamut_status registry_open(struct registry *registry, const struct descriptor *descriptor,
                           struct trace *trace, const struct gamut_plugin **plugin)
{
  EXCLUSIVE;
  return open_once(registry, descriptor, trace, plugin);
}

bool registry_object(const struct registry *registry, const struct descriptor *descriptor,
                     char *file, size_t size)
{
  struct entry *entry = registry_entry(registry, descriptor);
  struct trace *silent = trace_new();
  const char *level = entry ? entry->level : NULL;
  bool found = entry && silent && find_object(entry, silent, file, size);
  if (entry)
    entry->level = level;
  trace_free(silent);
  return found;
}

const char *registry_level(const struct registry *registry, const struct descriptor *descriptor)
{
  const struct entry *entry = registry_entry(registry, descriptor);
  return entry && entry->plugin ? entry->level : NULL;
}

bool registry_is_open(const struct registry *registry, const struct descriptor *descriptor)
{
  return registry_level(registry, descriptor) != NULL;
}
