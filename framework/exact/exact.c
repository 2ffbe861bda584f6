#include "exact/exact.h"

#include <math.h>
#include <string.h>

#define LIMB_BITS 32
#define BASE (INT64_C(1) << LIMB_BITS)
#define FRACTION ((UINT64_C(1) << 52) - 1)
#define UNIT (UINT64_C(1) << 52) /* the leading bit that is not stored */

enum { STRANGE = 2047 }; /* exponent of infinities and of what is no number */

/* An addend changes a limb by less than 2^32, a carry leaves less than 2^32: twice as many would
 * still fit. */
static const uint64_t most_addends = UINT64_C(1) << 30;

void exact_begin(struct exact *e)
{
  memset(e, 0, sizeof *e);
  e->low = EXACT_LIMBS;
}

/* Lower limbs become 0 to 2^32 - 1; the highest one in use keeps the sign, and is at most 2^32 away
 * from zero where there is one above it. */
static void carry(struct exact *e)
{
  int64_t over = 0;
  for (size_t i = e->low; i < e->end; i++) {
    const int64_t whole = e->limb[i] + over, rest = whole & (BASE - 1);
    const int highest = i + 1 == e->end;
    if (highest && (i + 1 == EXACT_LIMBS || (whole > -BASE && whole < BASE))) {
      e->limb[i] = whole;
      break;
    }
    over = (whole - rest) / BASE;
    e->limb[i] = rest;
    e->end += (size_t)highest;
  }
  e->since = 1;
}

static inline void add_one(struct exact *e, double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  uint64_t exponent = bits >> 52 & STRANGE, fraction = bits & FRACTION;
  if (exponent == STRANGE) {
    e->strange++;
    return;
  }
  if ((exponent | fraction) == 0)
    return;
  if (exponent > 0)
    fraction |= UNIT;
  else
    exponent = 1; /* subnormal */
  const size_t at = exponent / LIMB_BITS;
  const unsigned up = exponent % LIMB_BITS;
  const uint64_t below = fraction << up, above = fraction >> 1 >> (63 - up);
  const int64_t minus = -(int64_t)(bits >> 63);
  e->limb[at] += ((int64_t)(below & (uint64_t)(BASE - 1)) ^ minus) - minus;
  e->limb[at + 1] += ((int64_t)(below >> LIMB_BITS) ^ minus) - minus;
  e->limb[at + 2] += ((int64_t)above ^ minus) - minus;
  e->low = at < e->low ? at : e->low;
  e->end = at + 3 > e->end ? at + 3 : e->end;
}

void exact_add(struct exact *e, const double *value, size_t count, size_t stride)
{
  while (count > 0) {
    if (e->since >= most_addends)
      carry(e);
    const uint64_t room = most_addends - e->since, now = count < room ? count : room;
    for (size_t i = 0; i < now; i++)
      add_one(e, value[i * stride]);
    e->since += now;
    value += now * stride;
    count -= now;
  }
}

void exact_merge(struct exact *e, const struct exact *other)
{
  if (e->since + other->since > most_addends)
    carry(e);
  for (size_t i = other->low; i < other->end; i++)
    e->limb[i] += other->limb[i];
  e->low = other->low < e->low ? other->low : e->low;
  e->end = other->end > e->end ? other->end : e->end;
  e->since += other->since;
  e->strange += other->strange;
}

/* The limb as a digit; 0 below the lowest. */
static uint64_t digit(const struct exact *e, size_t top, size_t down)
{
  return down <= top ? (uint64_t)e->limb[top - down] : 0;
}

/* Bits of the double nearest to a sum above zero, all of whose limbs are digits, the highest one
 * `top`. */
static uint64_t nearest(const struct exact *e, size_t top)
{
  unsigned lead = 0; /* zeros before the highest digit */
  while (!(digit(e, top, 0) << lead >> (LIMB_BITS - 1)))
    lead++;
  /* the highest 64 bits, and whether there is more below them */
  const uint64_t third = digit(e, top, 2) << lead;
  const uint64_t high = (digit(e, top, 0) << LIMB_BITS | digit(e, top, 1)) << lead |
                        third >> LIMB_BITS;
  uint64_t more = third & (uint64_t)(BASE - 1);
  for (size_t i = e->low; i + 2 < top; i++)
    more |= (uint64_t)e->limb[i];
  /* the place of the last of these 64 bits; that of a double's last bit is its exponent, 1 at least
   */
  const int place = LIMB_BITS * ((int)top - 1) - (int)lead, exponent = place + 11;
  if (exponent < 1)
    return high >> (1 - place); /* subnormal: there is nothing below its last bit */
  if (exponent >= STRANGE)
    return (uint64_t)STRANGE << 52;
  const uint64_t kept = high >> 11, rest = high & 2047, half = 1024;
  const uint64_t up = rest > half || (rest == half && (more || (kept & 1)));
  /* a carry out of the fraction raises the exponent, that of the largest double to infinity */
  return ((uint64_t)(exponent - 1) << 52) + kept + up;
}

double exact_value(const struct exact *sum)
{
  struct exact e = *sum;
  if (e.strange > 0)
    return NAN;
  carry(&e);
  while (e.end > e.low && e.limb[e.end - 1] == 0)
    e.end--;
  if (e.end <= e.low)
    return 0.0;
  const uint64_t minus = e.limb[e.end - 1] < 0;
  if (minus) {
    for (size_t i = e.low; i < e.end; i++)
      e.limb[i] = -e.limb[i];
    carry(&e);
    while (e.limb[e.end - 1] == 0)
      e.end--;
  }
  const uint64_t bits = nearest(&e, e.end - 1) | minus << 63;
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

void exact_columns(const double *value, size_t rows, size_t columns, double *total)
{
  for (size_t c = 0; c < columns; c++) {
    struct exact sum;
    exact_begin(&sum);
    exact_add(&sum, value + c, rows, columns);
    total[c] = exact_value(&sum);
  }
}

double exact_most(const double *value, size_t count)
{
  double most = -INFINITY;
  for (size_t i = 0; i < count && !isnan(most); i++)
    most = value[i] <= most ? most : value[i];
  return most == 0.0 ? 0.0 : most;
}
