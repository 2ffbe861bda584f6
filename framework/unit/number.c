#include "unit/number.h"
#include "base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char blanks[] = " \t\r\n";

static bool is_digit(char c)
{
  return c >= '0' && c <= '9';
}

static bool is_letter(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (unsigned char)c >= 0x80;
}

/* "nan", "inf", "infinity" with or without a sign: what strtod would take for a number. */
static bool is_no_finite_word(const char *word, size_t length)
{
  static const char *const words[] = {"nan", "inf", "infinity"};
  for (; length > 0 && (*word == '+' || *word == '-' || *word == '.'); length--)
    word++;
  for (size_t k = 0; k < ARRAY_SIZE(words); k++)
    if (strlen(words[k]) == length && strncasecmp(word, words[k], length) == 0)
      return true;
  return false;
}

enum unit_result number_read(const char *text, locale_t c, double *value, const char **rest)
{
  text += strspn(text, blanks);
  size_t length = strcspn(text, blanks);
  if (is_no_finite_word(text, length))
    return UNIT_NAN;
  if (length == 0 || strspn(text, "0123456789+-.eE") < length) /* no hexadecimal numbers */
    return UNIT_NOT_A_NUMBER;
  char *end;
  locale_t before = uselocale(c);
  *value = strtod(text, &end);
  uselocale(before);
  if (end != text + length)
    return UNIT_NOT_A_NUMBER;
  *rest = end + strspn(end, blanks);
  return isfinite(*value) ? UNIT_OK : UNIT_NAN;
}

/* Whether the digits at `k` are an exponent: behind a letter or '^' or "**", with or without a
 * sign. */
static bool is_exponent(const char *text, size_t k)
{
  if (k > 0 && (text[k - 1] == '-' || text[k - 1] == '+'))
    k--;
  if (k == 0)
    return false;
  return is_letter(text[k - 1]) || text[k - 1] == '^' ||
         (k > 1 && text[k - 1] == '*' && text[k - 2] == '*');
}

bool unit_text(const char *text, char copy[UNIT_TEXT_MAX])
{
  text += strspn(text, blanks);
  size_t length = strlen(text);
  while (length > 0 && strchr(blanks, text[length - 1]) != NULL)
    length--;
  if (length >= UNIT_TEXT_MAX)
    return false;
  memcpy(copy, text, length);
  copy[length] = '\0';
  if (strcmp(copy, "1") == 0)
    return true;
  for (size_t k = 0; k < length; k++) {
    if (copy[k] == '@' || (unsigned char)copy[k] < ' ')
      return false;
    if (!is_digit(copy[k]) || (k > 0 && is_digit(copy[k - 1])))
      continue;
    bool one = k == 0 && copy[0] == '1' && copy[1 + strspn(copy + 1, " ")] == '/';
    if (!one && !is_exponent(copy, k))
      return false;
  }
  return true;
}
