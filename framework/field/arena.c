#include "field/field.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Each piece carries its size and label in front, so that giving it back needs no search by
 * size. */
struct piece {
  struct piece *next, *previous;
  size_t bytes;
  size_t label;
};
enum { HEAD = 64 };
/* From so many bytes on a piece is pages of its own that the system hands out zeroed when they are
 * touched: what is only planned costs nothing. */
static const size_t large = (size_t)32 << 20;

struct label {
  char *text;
  size_t bytes;
};

struct arena {
  struct piece pieces; /* ring */
  struct label *label;
  size_t labels;
  size_t bytes, peak;
  size_t limit;
};

/* Linux promises more memory than there is and kills who uses it: what cannot fit is not asked
 * for. What it can give without pushing others out is known where the kernel says it. */
static size_t memory_of_machine(void)
{
  long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
  size_t bytes = pages > 0 && size > 0 ? (size_t)pages * (size_t)size : SIZE_MAX / 2;
  FILE *file = fopen("/proc/meminfo", "r");
  char line[128];
  unsigned long long kilobytes;
  while (file && fgets(line, sizeof line, file))
    if (sscanf(line, "MemAvailable: %llu kB", &kilobytes) == 1 && kilobytes < bytes / 1024)
      bytes = (size_t)kilobytes * 1024;
  if (file)
    fclose(file);
  return bytes;
}

static size_t whole_size(size_t bytes)
{
  return (HEAD + bytes + 63) & ~(size_t)63;
}

static void *zeroed(size_t whole)
{
  if (whole >= large) {
    void *pages = mmap(NULL, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return pages == MAP_FAILED ? NULL : pages;
  }
  void *memory = aligned_alloc(64, whole);
  return memory ? memset(memory, 0, whole) : NULL;
}

struct arena *arena_new(void)
{
  struct arena *arena = calloc(1, sizeof *arena);
  if (arena) {
    arena->pieces.next = arena->pieces.previous = &arena->pieces;
    arena->limit = memory_of_machine();
  }
  return arena;
}

void arena_free(struct arena *arena)
{
  if (!arena)
    return;
  while (arena->pieces.next != &arena->pieces)
    arena_give(arena, (char *)arena->pieces.next + HEAD);
  for (size_t i = 0; i < arena->labels; i++)
    free(arena->label[i].text);
  free(arena->label);
  free(arena);
}

static bool label_number(struct arena *arena, const char *text, size_t *number)
{
  for (size_t i = 0; i < arena->labels; i++)
    if (strcmp(arena->label[i].text, text) == 0) {
      *number = i;
      return true;
    }
  struct label *grown = realloc(arena->label, (arena->labels + 1) * sizeof *grown);
  char *copy = strdup(text);
  if (grown)
    arena->label = grown;
  if (!grown || !copy) {
    free(copy);
    return false;
  }
  arena->label[arena->labels] = (struct label){.text = copy};
  *number = arena->labels++;
  return true;
}

size_t arena_room(const struct arena *arena)
{
  return arena->bytes < arena->limit ? arena->limit - arena->bytes : 0;
}

bool arena_has_room(const struct arena *arena, size_t bytes)
{
  return bytes <= arena_room(arena);
}

void *arena_take(struct arena *arena, const char *label, size_t bytes)
{
  size_t number;
  if (!arena_has_room(arena, bytes))
    return NULL;
  if (!label_number(arena, label, &number))
    return NULL;
  struct piece *piece = zeroed(whole_size(bytes));
  if (!piece)
    return NULL;
  piece->bytes = bytes;
  piece->label = number;
  piece->next = arena->pieces.next;
  piece->previous = &arena->pieces;
  piece->next->previous = piece;
  arena->pieces.next = piece;
  arena->label[number].bytes += bytes;
  arena->bytes += bytes;
  if (arena->bytes > arena->peak)
    arena->peak = arena->bytes;
  return (char *)piece + HEAD;
}

void arena_give(struct arena *arena, void *memory)
{
  if (!memory)
    return;
  struct piece *piece = (struct piece *)(void *)((char *)memory - HEAD);
  piece->next->previous = piece->previous;
  piece->previous->next = piece->next;
  assert(arena->bytes >= piece->bytes);
  arena->bytes -= piece->bytes;
  arena->label[piece->label].bytes -= piece->bytes;
  const size_t whole = whole_size(piece->bytes);
  if (whole >= large)
    munmap(piece, whole);
  else
    free(piece);
}

size_t arena_bytes(const struct arena *arena)
{
  return arena->bytes;
}

size_t arena_peak(const struct arena *arena)
{
  return arena->peak;
}

bool arena_label(const struct arena *arena, size_t index, const char **label, size_t *bytes)
{
  if (index >= arena->labels)
    return false;
  *label = arena->label[index].text;
  *bytes = arena->label[index].bytes;
  return true;
}
