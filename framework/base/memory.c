#include "base/memory.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* What the program wants belongs to the process, as memory does. */
static void (*_Atomic at_end)(void);

void memory_at_end(void (*end)(void))
{
  atomic_store(&at_end, end);
}

_Noreturn void memory_ended(void)
{
  void (*end)(void) = atomic_load(&at_end);
  if (end)
    end();
  abort();
}

static _Thread_local bool must_last, overdrawn;

void memory_must_last(void)
{
  must_last = true;
}

bool memory_overdraw(void)
{
  overdrawn = overdrawn || must_last;
  return must_last;
}

void memory_may_end(void)
{
  must_last = false;
  if (overdrawn)
    memory_ended();
}

char *memory_copy(const char *text)
{
  char *copy = text ? strdup(text) : NULL;
  if (text && !copy)
    memory_ended();
  return copy;
}

char *memory_close(FILE *stream, char **text)
{
  bool failed = ferror(stream) != 0;
  failed = fclose(stream) != 0 || failed;
  if (failed || !*text)
    memory_ended();
  return *text;
}
