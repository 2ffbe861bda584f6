/* The program's malloc, calloc and realloc. UDUNITS, muParser and HDF5 crash, throw or exit where
 * an allocation of theirs fails: inside of them it ends the program, in order. Elsewhere the
 * failure goes to whoever asked. A library may not do this to the program that embeds it: this file
 * is the program's alone. */
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/exclusive.h"
#include "base/memory.h"

/* Sanitizers have an allocator of their own, which none may stand before. gcc says by a macro that
 * there is one, clang otherwise. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED
#endif

#ifndef SANITIZED

typedef void *malloc_function(size_t size);
typedef void *calloc_function(size_t count, size_t size);
typedef void *realloc_function(void *memory, size_t size);

static malloc_function *_Atomic next_malloc;
static calloc_function *_Atomic next_calloc;
static realloc_function *_Atomic next_realloc;

/* dlsym() may ask for memory itself, and does without. */
static _Thread_local bool looking;

static void look(void)
{
  looking = true;
  atomic_store(&next_calloc, (calloc_function *)dlsym(RTLD_NEXT, "calloc"));
  atomic_store(&next_realloc, (realloc_function *)dlsym(RTLD_NEXT, "realloc"));
  atomic_store(&next_malloc, (malloc_function *)dlsym(RTLD_NEXT, "malloc"));
  looking = false;
}

static bool found(void)
{
  if (looking)
    return false;
  if (!atomic_load_explicit(&next_malloc, memory_order_acquire))
    look();
  return true;
}

static void *checked(void *memory, size_t size)
{
  if (!memory && size > 0 && exclusive_is_mine())
    memory_ended();
  return memory;
}

#define REPLACED __attribute__((visibility("default")))

REPLACED void *malloc(size_t size)
{
  return found() ? checked(next_malloc(size), size) : NULL;
}

REPLACED void *calloc(size_t count, size_t size)
{
  return found() ? checked(next_calloc(count, size), count && size) : NULL;
}

REPLACED void *realloc(void *memory, size_t size)
{
  return found() ? checked(next_realloc(memory, size), size) : NULL;
}

#endif
