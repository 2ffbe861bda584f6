/* The shared object: what it calls and what it could remember between calls. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/conformance_private.h"
#include "registry/elf.h"

enum library { LIBC, LIBM, OTHER, NOWHERE };

static enum library library_of(const char *name)
{
  Dl_info info;
  void *address = dlsym(RTLD_DEFAULT, name);
  if (!address || !dladdr(address, &info) || !info.dli_fname)
    return NOWHERE;
  const char *slash = strrchr(info.dli_fname, '/'), *file = slash ? slash + 1 : info.dli_fname;
  if (strncmp(file, "libm.", 5) == 0 || strncmp(file, "libmvec", 7) == 0)
    return LIBM;
  return strncmp(file, "libc.", 5) == 0 || strncmp(file, "ld-", 3) == 0 ? LIBC : OTHER;
}

static bool begins_with_one(const char *const *list, const char *name)
{
  for (; *list; list++)
    if (strncmp(name, *list, strlen(*list)) == 0)
      return true;
  return false;
}

/* What the compiler itself calls, in any plugin. */
static const char *const of_compiler[] = {
    "_ITM_",      "__gmon_start__", "__cxa_finalize", "__stack_chk_fail", "memcpy",
    "memset",     "memmove",        "memcmp",         "__memcpy_chk",     "__memset_chk",
    "__errno_location", "__tls_get_addr", NULL};
/* Of instrumented builds. */
static const char *const of_tools[] = {"__asan_", "__ubsan_", "__tsan_", "__sanitizer_",
                                       "__gcov_", "__llvm_",  NULL};
/* Where values are read and memory is made, outside of kernels. */
static const char *const of_create[] = {"str",  "malloc", "calloc", "realloc", "free",
                                        "qsort", "bsearch", "snprintf", "vsnprintf",
                                        "__snprintf_chk", "__str", "aligned_alloc",
                                        "__assert_fail", NULL};
static const char *const of_openmp[] = {"GOMP_", "omp_", "__kmpc_", NULL};
/* The mathematical library's switches. */
static const char *const of_state[] = {"fesetround", "fesetenv", "feupdateenv", "feholdexcept",
                                       "feenableexcept", "fedisableexcept", "signgam", NULL};

static bool is_law(enum gamut_kind kind)
{
  return kind == GAMUT_KIND_EOS || kind == GAMUT_KIND_STRENGTH || kind == GAMUT_KIND_ELASTICITY;
}

struct look {
  enum gamut_kind kind;
  bool prepares, instrumented;
  size_t imports, variables;
  char import[256], variable[256];
};

static bool may_call(const struct look *look, const char *name)
{
  const enum gamut_kind kind = look->kind;
  const enum library library = library_of(name);
  if (begins_with_one(of_state, name))
    return false;
  if (library == LIBM || begins_with_one(of_compiler, name) || begins_with_one(of_tools, name))
    return true;
  if (is_law(kind) && !look->prepares)
    return false;
  if (begins_with_one(of_create, name))
    return true;
  return !is_law(kind) && kind != GAMUT_KIND_EFFECT &&
         (begins_with_one(of_openmp, name) || library != LIBC);
}

static void append(char *text, size_t size, const char *name)
{
  size_t used = strlen(text);
  if (used + 1 < size)
    snprintf(text + used, size - used, "%s%s", used ? ", " : ": ", name);
}

static void take_import(void *self, const char *name)
{
  struct look *look = self;
  look->instrumented |= begins_with_one(of_tools, name);
  if (may_call(look, name))
    return;
  look->imports++;
  append(look->import, sizeof look->import, name);
}

static void take_variable(void *self, const char *name)
{
  struct look *look = self;
  look->variables++;
  append(look->variable, sizeof look->variable, name);
}

void prove_object(struct proof *proof)
{
  struct checks *checks = &proof->checks;
  struct look look = {.kind = proof->descriptor->kind, .prepares = proof->descriptor->prepare};
  struct elf_file elf;
  char file[4096];
  check_begin(checks, "what the shared object calls");
  if (!registry_object(proof->registry, proof->descriptor, file, sizeof file) ||
      !elf_read(&elf, file))
    return;
  elf_imports(&elf, take_import, &look);
  elf_variables(&elf, take_variable, &look);
  elf_free(&elf);
  check_figure(checks, (double)look.imports, 0, "functions called that %s may not call%s",
               is_law(look.kind) ? "a law" : "such a plugin", look.import);
  if (look.instrumented)
    check_skip(checks, "built with sanitizers", "variables that outlive a call");
  else if (look.kind != GAMUT_KIND_SOLVER) /* OpenMP keeps its locks there */
    check_figure(checks, (double)look.variables, 0, "variables that outlive a call%s",
                 look.variable);
}
