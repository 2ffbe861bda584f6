#include "base/excerpt.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { CHARACTER_BYTES = 4, DOTS = 3 };

/* Length in bytes of the character at `text`, and its code; code 0 where the bytes are not UTF-8.
 */
static size_t decode(const char *text, uint32_t *code)
{
  const unsigned char *byte = (const unsigned char *)text;
  size_t length = byte[0] < 0x80   ? 1
                  : byte[0] < 0xC2 ? 0
                  : byte[0] < 0xE0 ? 2
                  : byte[0] < 0xF0 ? 3
                  : byte[0] < 0xF5 ? 4
                                   : 0;
  static const unsigned char lead[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
  *code = 0;
  if (length == 0)
    return 1;
  uint32_t value = byte[0] & lead[length];
  for (size_t k = 1; k < length; k++) {
    if ((byte[k] & 0xC0) != 0x80)
      return 1;
    value = value << 6 | (byte[k] & 0x3F);
  }
  *code = value;
  return length;
}

/* Characters that move the cursor or turn the direction of writing can make a message lie. */
static bool is_harmless(uint32_t code)
{
  return code >= 0x20 && !(code >= 0x7F && code < 0xA0) && !(code >= 0x200B && code <= 0x200F) &&
         !(code >= 0x2028 && code <= 0x202E) && !(code >= 0x2060 && code <= 0x206F) &&
         code != 0xFEFF;
}

/* Copies one character in its safe form; moves both pointers. */
static void copy_character(char **to, const char **from)
{
  uint32_t code;
  size_t length = decode(*from, &code);
  if (is_harmless(code)) {
    memcpy(*to, *from, length);
    *to += length;
  } else {
    *(*to)++ = **from == '\t' || **from == '\n' || **from == '\r' ? ' ' : '?';
  }
  *from += length;
}

static void copy_dots(char **to)
{
  memcpy(*to, "...", DOTS);
  *to += DOTS;
}

/* Moves over up to `count` characters; returns how many there were. */
static size_t skip(const char **text, size_t count)
{
  size_t done = 0;
  for (uint32_t code; done < count && **text != '\0'; done++)
    *text += decode(*text, &code);
  return done;
}

char *shown_text(const char *text, size_t most)
{
  if (text == NULL)
    return NULL;
  const char *end = text;
  size_t count = skip(&end, most);
  char *copy = malloc(count * CHARACTER_BYTES + DOTS + 1);
  if (copy == NULL)
    return NULL;
  char *to = copy;
  while (text < end)
    copy_character(&to, &text);
  if (*end != '\0')
    copy_dots(&to);
  *to = '\0';
  return copy;
}

struct excerpt excerpt_of(const char *line, int column, int width)
{
  enum { LEAD = EXCERPT_COLUMNS / 3 };
  struct excerpt excerpt = {.text = NULL};
  if (line == NULL)
    return excerpt;
  const char *reach = line;
  size_t length = skip(&reach, (size_t)(column > 1 ? column - 1 : 0) + EXCERPT_COLUMNS);
  size_t caret = column > 1 ? (size_t)column - 1 : 0;
  if (caret > length)
    caret = length;

  size_t first = length <= EXCERPT_COLUMNS || caret < 2 * LEAD ? 0 : caret - LEAD;
  const char *from = line;
  skip(&from, first);
  const char *end = from;
  size_t count = skip(&end, EXCERPT_COLUMNS);
  excerpt.text = malloc(count * CHARACTER_BYTES + 2 * DOTS + 1);
  if (excerpt.text == NULL)
    return excerpt;

  char *to = excerpt.text;
  if (first > 0)
    copy_dots(&to);
  while (from < end)
    copy_character(&to, &from);
  if (*end != '\0')
    copy_dots(&to);
  *to = '\0';

  size_t room = first + count > caret ? first + count - caret : 1;
  excerpt.before = (int)(caret - first) + (first > 0 ? DOTS : 0);
  excerpt.width = width < 1 ? 1 : (size_t)width > room ? (int)room : width;
  return excerpt;
}
