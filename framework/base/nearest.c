#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

enum { WORD_MAX = 64 };

/* Lower case without '-', '_' and ' '. Returns the length; words beyond WORD_MAX are cut, which is
 * more than enough to recognise a slip of the finger. */
static size_t fold(const char *word, char folded[WORD_MAX])
{
  size_t length = 0;
  for (; *word != '\0' && length < WORD_MAX; word++)
    if (*word != '-' && *word != '_' && *word != ' ')
      folded[length++] = (char)tolower((unsigned char)*word);
  return length;
}

static size_t least(size_t a, size_t b)
{
  return a < b ? a : b;
}

/* Damerau-Levenshtein distance, optimal string alignment: insert, delete, replace, swap neighbours.
 */
static size_t distance(const char *a, size_t m, const char *b, size_t n)
{
  size_t rows[3][WORD_MAX + 1];
  size_t *before = rows[0], *above = rows[1], *row = rows[2];
  for (size_t j = 0; j <= n; j++)
    above[j] = before[j] = j;
  for (size_t i = 1; i <= m; i++) {
    row[0] = i;
    for (size_t j = 1; j <= n; j++) {
      size_t replaced = above[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = least(replaced, least(above[j], row[j - 1]) + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = least(row[j], before[j - 2] + 1);
    }
    size_t *oldest = before;
    before = above;
    above = row;
    row = oldest;
  }
  return above[n];
}

const char *nearest(const char *word, const char *const *candidates, size_t count)
{
  char one[WORD_MAX], other[WORD_MAX];
  size_t length = fold(word, one);
  size_t allowed = length / 3 > 1 ? length / 3 : 1;
  size_t best = allowed + 1;
  const char *found = NULL;
  for (size_t k = 0; k < count; k++) {
    if (candidates[k] == NULL)
      continue;
    size_t size = fold(candidates[k], other);
    size_t away = distance(one, length, other, size);
    /* A word that shares no letter is no slip: "x" is not near "y". */
    if (away < best && away < (length > size ? length : size)) {
      best = away;
      found = candidates[k];
    }
  }
  return found;
}
