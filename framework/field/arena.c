#include "field/field.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Each piece carries its size and label in front, so that giving it back needs no search by
 * size. */
struct piece {
  struct piece *next, *previous;
  size_t bytes;
  size_t label;
};
enum { HEAD = 64 };

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
 * for. */
static size_t memory_of_machine(void)
{
  long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
  return pages > 0 && size > 0 ? (size_t)pages * (size_t)size : SIZE_MAX / 2;
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

bool arena_has_room(const struct arena *arena, size_t bytes)
{
  return arena->bytes <= arena->limit && bytes <= arena->limit - arena->bytes;
}

void *arena_take(struct arena *arena, const char *label, size_t bytes)
{
  size_t number;
  if (!arena_has_room(arena, bytes))
    return NULL;
  if (!label_number(arena, label, &number))
    return NULL;
  size_t whole = (HEAD + bytes + 63) & ~(size_t)63;
  struct piece *piece = aligned_alloc(64, whole);
  if (!piece)
    return NULL;
  memset(piece, 0, whole);
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
