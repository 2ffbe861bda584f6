#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tree/tree_private.h"

/* Bytes of the character of UTF-8 at `at`; 0 if the bytes are none. */
static size_t character(const unsigned char *at, size_t left, uint32_t *code)
{
  size_t length = at[0] < 0x80 ? 1 : at[0] < 0xC2 ? 0 : at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
  if (length == 0 || length > left || at[0] > 0xF4)
    return 0;
  *code = length == 1 ? at[0] : at[0] & (0xFFu >> (length + 1));
  for (size_t k = 1; k < length; k++) {
    if ((at[k] & 0xC0) != 0x80)
      return 0;
    *code = *code << 6 | (at[k] & 0x3F);
  }
  bool overlong = (length == 3 && *code < 0x800) || (length == 4 && *code < 0x10000);
  bool surrogate = *code >= 0xD800 && *code < 0xE000;
  return overlong || surrogate || *code > 0x10FFFF ? 0 : length;
}

/* Whether YAML admits the character. */
static bool is_text(uint32_t code)
{
  if (code < 0x20)
    return code == '\t' || code == '\n' || code == '\r';
  return code != 0x7F && !(code >= 0x80 && code < 0xA0 && code != 0x85) && code != 0xFEFF &&
         code != 0xFFFE && code != 0xFFFF;
}

/* The place of a byte, counted as the parser counts. */
static struct place place_of(const struct origin *origin, const char *text, size_t offset)
{
  size_t line = 1, column = 1;
  while (line < origin->lines && (size_t)(origin->line[line] - origin->text) <= offset)
    line++;
  for (size_t k = (size_t)(origin->line[line - 1] - origin->text); k < offset; k++)
    column += (text[k] & 0xC0) != 0x80;
  return origin_place(origin, line, column, 1);
}

gamut_status source_check(const struct origin *origin, const char *text, size_t size,
                          gamut_status blame, struct trace *trace)
{
  const unsigned char *byte = (const unsigned char *)text;
  struct place file = origin_place(origin, 0, 0, 1);
  if (size >= 2 && ((byte[0] == 0xFE && byte[1] == 0xFF) || (byte[0] == 0xFF && byte[1] == 0xFE)))
    return trace_fail_at(trace, blame, &file, NULL, "save it as UTF-8",
                         "the file is in UTF-16, or it is a binary file");
  for (size_t k = 0; k < size;) {
    uint32_t code = 0;
    size_t length = character(byte + k, size - k, &code);
    if (length > 0 && is_text(code)) {
      k += length;
      continue;
    }
    struct place place = place_of(origin, text, k);
    if (length == 0 || code == 0)
      return trace_fail_at(trace, blame, &place, NULL, "if it is text, save it as UTF-8",
                           "this looks like a binary file: byte 0x%02X is no text", byte[k]);
    char expected[64];
    snprintf(expected, sizeof expected, "remove it, or write it as \\u%04X in \"quotes\"",
             (unsigned)code);
    return trace_fail_at(trace, blame, &place, NULL, expected,
                         "the control character U+%04X is not allowed", (unsigned)code);
  }
  return GAMUT_OK;
}
