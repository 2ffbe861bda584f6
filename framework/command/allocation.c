/* The program's malloc, calloc, realloc and free. UDUNITS, muParser and HDF5 crash, throw or exit
 * where an allocation of theirs fails: inside of them it ends the program, in order; while a file
 * is half written, after that, for which some memory is kept. Elsewhere the failure goes to whoever
 * asked. A library may not do this to the program that embeds it: this file
 * is the program's alone. */
#include <dlfcn.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
typedef void free_function(void *memory);

static malloc_function *_Atomic next_malloc;
static calloc_function *_Atomic next_calloc;
static realloc_function *_Atomic next_realloc;
static free_function *_Atomic next_free;

/* dlsym() may ask for memory itself, and does without. */
static _Thread_local bool looking;

static void look(void)
{
  looking = true;
  atomic_store(&next_calloc, (calloc_function *)dlsym(RTLD_NEXT, "calloc"));
  atomic_store(&next_realloc, (realloc_function *)dlsym(RTLD_NEXT, "realloc"));
  atomic_store(&next_free, (free_function *)dlsym(RTLD_NEXT, "free"));
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

/* What is kept: a flush of a file takes a few kilobytes at a time. One thread writes a file, it is
 * given out once and never taken back, since the program ends soon after. Zero from the start. */
enum { KEPT = 1 << 20 };
struct piece {
  size_t size;
  max_align_t content[];
};
static _Alignas(max_align_t) unsigned char kept[KEPT];
static size_t given;

static bool is_kept(const void *memory)
{
  const unsigned char *byte = memory;
  return byte >= kept && byte < kept + KEPT;
}

static void *take_kept(size_t size)
{
  const size_t align = _Alignof(max_align_t), all = KEPT - given;
  if (size > all || all - size < sizeof(struct piece) + align)
    return NULL;
  struct piece *piece = (struct piece *)(void *)(kept + given);
  piece->size = size;
  given += sizeof *piece + (size + align - 1) / align * align;
  return piece->content;
}

static void *checked(void *memory, size_t size)
{
  if (memory || size == 0 || !exclusive_is_mine())
    return memory;
  memory = memory_overdraw() ? take_kept(size) : NULL;
  if (!memory)
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
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes))
    bytes = SIZE_MAX;
  return found() ? checked(next_calloc(count, size), bytes) : NULL;
}

REPLACED void *realloc(void *memory, size_t size)
{
  if (!found())
    return NULL;
  const bool was_kept = is_kept(memory);
  void *grown = checked(was_kept ? next_malloc(size) : next_realloc(memory, size), size);
  if (!grown || (!was_kept && !is_kept(grown)))
    return grown;
  /* what could not grow in its place stays as it was, never freed */
  const size_t before = was_kept ? ((struct piece *)memory - 1)->size : malloc_usable_size(memory);
  if (memory)
    memcpy(grown, memory, before < size ? before : size);
  return grown;
}

REPLACED void free(void *memory)
{
  if (memory && !is_kept(memory) && found())
    next_free(memory);
}

#endif
