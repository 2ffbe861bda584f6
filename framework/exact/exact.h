/* Sums of doubles without error: each addend is added to a whole number of 2,144 bits, which covers
 * all that a double can be, and the sum is rounded once, at the end, to the nearest double, ties to
 * even. Whole numbers add up to the same in any order and in any grouping, so that a sum has the
 * same bits however its addends are cut into blocks, lists, threads or machines.
 *
 * As the "small superaccumulator" of R. M. Neal, Fast exact summation using small and large
 * superaccumulators, arXiv:1505.05571 (2015): limbs of 32 bits in signed 64 bit numbers, so that a
 * carry is due after 2^30 addends only.
 *
 *     struct exact sum;
 *     exact_begin(&sum);
 *     exact_add(&sum, value, count, 1);
 *     exact_merge(&sum, &other);
 *     double total = exact_value(&sum);
 *
 * Values   An infinity or no number among the addends makes the sum no number: inf + 1 - inf has no
 *          value, and one that depended on what else is summed could not be relied on. A sum that
 *          rounds to more than the largest double is an infinity of its sign; partial sums beyond
 *          it do no harm. A sum of nothing, or that is zero, is +0, also of addends that are -0.
 * Rounding Only whole numbers are calculated with: the mode of rounding of the processor, and
 *          whether it flushes subnormal numbers, do not matter.
 * Cost     About 50 instructions an addend, 15 one that is 0; 200 for the rest; 570 bytes.
 * Limits   2^62 addends.
 * Threads  A sum belongs to one thread. Threads that share the work have a sum each, merged in any
 *          order. Nothing is allocated, nothing fails. */
#ifndef GAMUT_EXACT_H
#define GAMUT_EXACT_H

#include <stddef.h>
#include <stdint.h>

/* Limb i counts units of 2^(32 i - 1075). The largest double ends in limb 65; there is room for
 * carries of 2^62 of them above. */
enum { EXACT_LIMBS = 67 };

struct exact {
  int64_t limb[EXACT_LIMBS];
  size_t low, end;  /* limbs outside low <= i < end are zero */
  uint64_t since;   /* addends since carries were taken, at most */
  uint64_t strange; /* addends that are infinite or no number */
};

void exact_begin(struct exact *);
/* Adds value[0], value[stride], ..., `count` of them. */
void exact_add(struct exact *, const double *value, size_t count, size_t stride);
/* Adds all that `other` has. */
void exact_merge(struct exact *, const struct exact *other);
/* The sum so far. More may be added afterwards. */
double exact_value(const struct exact *);

/* The sum of each column of a table of rows; 0 without rows. */
void exact_columns(const double *value, size_t rows, size_t columns, double *total);
/* The largest value: no number if there is one such, minus infinity of none, +0 for zeros. */
double exact_most(const double *value, size_t count);

#endif
