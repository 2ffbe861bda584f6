/* Numbers that read well and are still most likely slips: 90 mPa for 90 MPa, 8.96 kg/m3 for g/cm3.
 */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_private.h"

/* Prefixes of the SI that people mix up, and units that they mean but do not write. */
static const char *const prefix[] = {"", "k", "M", "G", "m", "u", "n", "c"};
static const char *const other_unit[] = {"g/cm3", "t/m3"};

/* What is most likely meant, and how near it lies to the middle of the range. */
struct guess_of_unit {
  const struct scene_reader *reader;
  const struct parameter *parameter;
  const struct range *range;
  char text[96];
  double distance;
};

/* Of the magnitude where the range leaves out zero and numbers may be negative. */
static bool is_usual(const struct parameter *parameter, const struct range *range, double value)
{
  const struct range *physical = &parameter->physical;
  bool negative = !physical->stated || physical->lower < 0;
  return value == 0 || range_holds(range, value) ||
         (negative && range->lower > 0 && range_holds(range, fabs(value)));
}

/* Distance from the middle of the range, in powers of e. */
static double off_middle(const struct range *range, double value)
{
  double high = fmax(fabs(range->lower), fabs(range->upper));
  double low = fmin(fabs(range->lower), fabs(range->upper));
  high = isfinite(high) && high > 0 ? high : 1e6 * low;
  low = low > 0 ? low : 1e-2 * high;
  return fabs(log(fabs(value)) - 0.5 * (log(low) + log(high)));
}

static void try_text(struct guess_of_unit *guess, const char *text, double bonus)
{
  double value;
  const char *unit = unit_is_pure(guess->parameter->unit) ? "1" : guess->parameter->unit;
  if (unit_read(guess->reader->units, text, unit, &value) != UNIT_OK || value == 0 ||
      !is_usual(guess->parameter, guess->range, value))
    return;
  double distance = off_middle(guess->range, value) - bonus;
  if (distance >= guess->distance || strlen(text) >= sizeof guess->text)
    return;
  guess->distance = distance;
  strcpy(guess->text, text);
}

/* The same number with other prefixes; the one that differs in its case alone comes first. */
static void try_prefixes(struct guess_of_unit *guess, const char *number, const char *unit)
{
  enum { CASE_ALONE = 100 };
  char text[160];
  for (size_t i = 0; i < ARRAY_SIZE(other_unit); i++) {
    snprintf(text, sizeof text, "%s %s", number, other_unit[i]);
    try_text(guess, text, 0);
  }
  for (size_t from = 0; from < ARRAY_SIZE(prefix); from++) {
    size_t length = strlen(prefix[from]);
    if (strncmp(unit, prefix[from], length) != 0 || unit[length] == 0)
      continue;
    for (size_t to = 0; to < ARRAY_SIZE(prefix); to++) {
      bool alike = length == 1 && from != to && strlen(prefix[to]) == 1 &&
                   tolower((unsigned char)prefix[from][0]) == tolower((unsigned char)prefix[to][0]);
      snprintf(text, sizeof text, "%s %s%s", number, prefix[to], unit + length);
      try_text(guess, text, alike ? CASE_ALONE : 0);
    }
  }
}

/* The same digits with the point elsewhere. */
static void try_decimals(struct guess_of_unit *guess, double number, const char *unit)
{
  enum { PLACES = 9 };
  char text[160];
  for (int k = -PLACES; k <= PLACES; k++) {
    snprintf(text, sizeof text, "%.10g%s%s", number * pow(10.0, k), *unit ? " " : "", unit);
    try_text(guess, text, 0);
  }
}

static void find_guess(struct guess_of_unit *guess, const struct tree *node)
{
  char number[64];
  char *after;
  double digits = strtod(node->text, &after);
  snprintf(number, sizeof number, "%.*s", (int)(after - node->text), node->text);
  while (*after == ' ')
    after++;
  if (*after && !unit_is_pure(guess->parameter->unit))
    try_prefixes(guess, number, after);
  if (!guess->text[0])
    try_decimals(guess, digits, after);
}

void usual_check(struct scene_reader *reader, const struct parameter *parameter,
                 const struct range *range, const struct tree *node, double value)
{
  char words[160], expected[320];
  if (!range->stated || !reader->units || reader->scaled || !node || node == parameter->standard ||
      node->kind != TREE_SCALAR || is_usual(parameter, range, value))
    return;
  struct guess_of_unit guess = {reader, parameter, range, "", INFINITY};
  find_guess(&guess, node);
  range_text(range, parameter->unit, words, sizeof words);
  snprintf(expected, sizeof expected, "usual is %s%s%s%s", words,
           guess.text[0] ? "; did you mean " : "", guess.text, guess.text[0] ? "?" : "");
  bool pure = unit_is_pure(parameter->unit);
  warn_value(reader, node, expected, "%s = %.6g%s%s is unusual", parameter->name, value,
             pure ? "" : " ", pure ? "" : parameter->unit);
}

void unit_words_check(struct scene_reader *reader, const struct tree *node)
{
  static const struct {
    const char *word, *is, *instead;
  } odd[] = {{"ton", "the short ton of 907.185 kg", "tonne or t, 1000 kg"},
             {"tons", "short tons of 907.185 kg", "tonne or t, 1000 kg"}};
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  for (const char *at = node->text; *at;) {
    size_t length = strspn(at, letters);
    for (size_t i = 0; i < ARRAY_SIZE(odd); i++)
      if (length == strlen(odd[i].word) && strncmp(at, odd[i].word, length) == 0)
        warn_value(reader, node, odd[i].instead, "'%s' is %s", odd[i].word, odd[i].is);
    at += length ? length : 1;
  }
}
