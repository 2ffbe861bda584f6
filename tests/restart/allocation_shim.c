/* Preloaded by out_of_memory.py: makes the allocation number GAMUT_FAIL_AT fail, counted from the
 * start of the program, or with GAMUT_FAIL_ON all from there on; with GAMUT_FAIL_IN_FLUSH those
 * inside of H5Fflush() alone are counted. Writes their count to the file GAMUT_FAIL_COUNT at the
 * end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);

static atomic_bool armed;
static atomic_long calls;
static long fail_at;
static bool fail_on, flushes_only;
static _Thread_local bool flushing;
static int told = -1;

__attribute__((constructor)) static void begin(void)
{
  const char *at = getenv("GAMUT_FAIL_AT"), *count = getenv("GAMUT_FAIL_COUNT");
  fail_at = at ? atol(at) : 0;
  fail_on = getenv("GAMUT_FAIL_ON") != NULL;
  flushes_only = getenv("GAMUT_FAIL_IN_FLUSH") != NULL;
  if (count)
    told = open(count, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  unsetenv("LD_PRELOAD"); /* programs that are started have the memory they want */
  atomic_store(&armed, true);
}

__attribute__((destructor)) static void end(void)
{
  char text[32];
  atomic_store(&armed, false);
  int length = snprintf(text, sizeof text, "%ld", atomic_load(&calls));
  if (told >= 0 && write(told, text, (size_t)length) != length)
    _exit(99);
}

/* For a debugger to stop at. */
__attribute__((noinline)) void allocation_shim_failed(void)
{
  errno = ENOMEM;
}

static bool fails(void)
{
  if (!atomic_load(&armed) || (flushes_only && !flushing))
    return false;
  long call = atomic_fetch_add(&calls, 1) + 1;
  bool failed = fail_at > 0 && (call == fail_at || (fail_on && call > fail_at));
  if (failed)
    allocation_shim_failed();
  return failed;
}

void *malloc(size_t size)
{
  return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
  return fails() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
  return fails() ? NULL : __libc_realloc(memory, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
  return fails() ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
  void *taken = fails() ? NULL : __libc_memalign(alignment, size);
  if (taken)
    *memory = taken;
  return taken ? 0 : ENOMEM;
}

int H5Fflush(int64_t file, int scope)
{
  int (*next)(int64_t, int) = (int (*)(int64_t, int))dlsym(RTLD_NEXT, "H5Fflush");
  flushing = true;
  int result = next(file, scope);
  flushing = false;
  return result;
}
