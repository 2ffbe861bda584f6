/* Text that is safe to show on a terminal: no control characters, no endless lines. */
#ifndef GAMUT_ERROR_EXCERPT_H
#define GAMUT_ERROR_EXCERPT_H

#include <stddef.h>

enum { EXCERPT_COLUMNS = 120 };

/* A source line cut around what is to be underlined. */
struct excerpt {
  char *text;        /* owned; null if there was no line or no memory */
  int before, width; /* columns left of the caret, columns to underline */
};

/* `column` from 1, both counted in characters of UTF-8. */
struct excerpt excerpt_of(const char *line, int column, int width);

/* A copy of at most `most` characters; line ends and control characters become blanks and '?', and
 * what is cut ends in "...". Null for null or if there is no memory. */
char *shown_text(const char *text, size_t most);

#endif
