#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "descriptor/descriptor_private.h"

static const char *skip_blanks(const char *text)
{
  while (*text == ' ' || *text == '\t')
    text++;
  return text;
}

/* Reads one end up to `stop`; in SI if `written` (the unit in the text) is empty. */
static bool read_end(const char **text, char stop, const char *written, const char *unit,
                     const struct units *units, double *value, char *why, size_t size)
{
  char *after;
  const char *begin = skip_blanks(*text);
  *value = strtod(begin, &after);
  if (after == begin || isnan(*value)) {
    snprintf(why, size, "a number is missing at '%s'", begin);
    return false;
  }
  const char *next = skip_blanks(after);
  if (*next != stop) {
    snprintf(why, size, "'%c' is missing at '%s'", stop, next);
    return false;
  }
  *text = next + 1;
  if (!isfinite(*value) || written[0] == 0)
    return true;
  char number[256];
  snprintf(number, sizeof number, "%.*s %s", (int)(after - begin), begin, written);
  if (unit_read(units, number, unit, value) != UNIT_OK) {
    snprintf(why, size, "'%s' is no quantity with the dimension of '%s'", number, unit);
    return false;
  }
  return true;
}

bool range_read(const char *text, const char *unit, const struct units *units, struct range *range,
                char *why, size_t size)
{
  const char *at = skip_blanks(text);
  const char *close = strpbrk(at, "])");
  if ((*at != '[' && *at != '(') || !close) {
    snprintf(why, size, "a range is written \"[a, b]\", \"(a, b)\" or \"[a, b) UNIT\"");
    return false;
  }
  const char *written = skip_blanks(close + 1);
  range->stated = true;
  range->lower_open = *at == '(';
  range->upper_open = *close == ')';
  at++;
  if (!read_end(&at, ',', written, unit, units, &range->lower, why, size) ||
      !read_end(&at, *close, written, unit, units, &range->upper, why, size))
    return false;
  bool point = !(range->lower < range->upper);
  if (point && (range->lower > range->upper || range->lower_open || range->upper_open)) {
    snprintf(why, size, "the range is empty");
    return false;
  }
  return true;
}

bool range_holds(const struct range *range, double value)
{
  if (!range->stated)
    return true;
  bool above = range->lower_open ? value > range->lower : value >= range->lower;
  bool below = range->upper_open ? value < range->upper : value <= range->upper;
  return above && below;
}

bool range_within(const struct range *inner, const struct range *outer)
{
  if (!inner->stated || !outer->stated)
    return true;
  bool low = inner->lower > outer->lower ||
             (inner->lower == outer->lower && (inner->lower_open || !outer->lower_open));
  bool high = inner->upper < outer->upper ||
              (inner->upper == outer->upper && (inner->upper_open || !outer->upper_open));
  return low && high;
}

char *range_text(const struct range *range, const char *unit, char *buffer, size_t size)
{
  bool low = range->stated && isfinite(range->lower),
       high = range->stated && isfinite(range->upper);
  char lower[64] = "", upper[64] = "";
  if (low)
    snprintf(lower, sizeof lower, "%s %.10g", range->lower_open ? "greater than" : "at least",
             range->lower);
  if (high)
    snprintf(upper, sizeof upper, "%s %.10g", range->upper_open ? "less than" : "at most",
             range->upper);
  bool pure = !unit || unit[0] == 0 || strcmp(unit, "1") == 0;
  if (!low && !high)
    snprintf(buffer, size, "any number");
  else
    snprintf(buffer, size, "%s%s%s%s%s", lower, low && high ? " and " : "", upper, pure ? "" : " ",
             pure ? "" : unit);
  return buffer;
}
