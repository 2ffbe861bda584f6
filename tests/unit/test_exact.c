/* Exact sums: known ones, in every mode of rounding, against whole numbers of 2,144 bits. The same
 * against Python's fsum: tests/unit/exact_sums.py, which has this program sum files of doubles:
 *
 *   test_exact FILE PARTS STRIDE     value i is number i STRIDE of the file, modulo their count
 */
#include <fenv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exact/exact.h"
#include "tests/tap.h"

enum { MOST = 10 };

struct known {
  const char *name;
  size_t count;
  double value[MOST], sum;
};

/* Largest double, and half of what its last bit stands for. */
static const double largest = 0x1.fffffffffffffp1023, half_last = 0x1p970;

static const struct known knowns[] = {
    {"nothing", 0, {0}, 0.0},
    {"large ones that cancel", 4, {1e300, 1.0, -1e300, 0x1p-1074}, 1.0},
    {"a tie broken by the least double", 3, {1.0, 0x1p-53, 0x1p-1074}, 1.0 + 0x1p-52},
    {"a tie, to even below", 2, {1.0, 0x1p-53}, 1.0},
    {"a tie, to even above", 2, {1.0 + 0x1p-52, 0x1p-53}, 1.0 + 0x1p-51},
    {"a tie broken downwards", 3, {1.0, 0x1p-53, -0x1p-1074}, 1.0},
    {"a carry through all digits", 2, {2.0 - 0x1p-52, 0x1p-53}, 2.0},
    {"ten tenths", 10, {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}, 1.0},
    {"the least double", 1, {-5e-324}, -5e-324},
    {"subnormal ones", 3, {0x1p-1074, 0x1.8p-1060, -0x1p-1062}, 0x1.4004p-1060},
    {"to the least normal one", 2, {0x1p-1022 - 0x1p-1074, 0x1p-1074}, 0x1p-1022},
    {"below the least normal one", 2, {0x1p-1022, -0x1p-1074}, 0x1p-1022 - 0x1p-1074},
    {"opposites", 4, {1e308, -1e-308, -1e308, 1e-308}, 0.0},
    {"zeros below zero", 2, {-0.0, -0.0}, 0.0},
    {"just below one", 2, {1.0, -0x1p-1074}, 1.0},
    {"below one by a half place", 2, {1.0, -0x1p-54}, 1.0},
    {"below one by more", 3, {1.0, -0x1p-54, -0x1p-1074}, 1.0 - 0x1p-53},
    {"beyond the largest, and back", 3, {0x1p1023, 0x1p1023, -0x1p1023}, 0x1p1023},
    {"the largest", 2, {0x1.fffffffffffffp1023, 0x1.fffffep969}, 0x1.fffffffffffffp1023},
    {"beyond the largest", 2, {0x1.fffffffffffffp1023, 0x1p970}, INFINITY},
    {"far beyond it", 3, {0x1.fffffffffffffp1023, 0x1p1023, 0x1p1023}, INFINITY},
    {"an infinity", 3, {1.0, INFINITY, 2.0}, NAN},
    {"two infinities", 2, {INFINITY, -INFINITY}, NAN},
    {"no number", 2, {1.0, NAN}, NAN},
};

static bool same(double a, double b)
{
  return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0;
}

static double sum_of(const double *value, size_t count)
{
  struct exact e;
  exact_begin(&e);
  exact_add(&e, value, count, 1);
  return exact_value(&e);
}

/* As given, with all signs turned, from the end, and each addend in a sum of its own. */
static void check_known(const struct known *k, const char *mode)
{
  double turned[MOST], back[MOST];
  struct exact merged, one;
  exact_begin(&merged);
  for (size_t i = 0; i < k->count; i++) {
    turned[i] = -k->value[i];
    back[k->count - 1 - i] = k->value[i];
    exact_begin(&one);
    exact_add(&one, &k->value[i], 1, 1);
    exact_merge(&merged, &one);
  }
  const double got = sum_of(k->value, k->count), minus = sum_of(turned, k->count);
  tap_ok(same(got, k->sum) && same(minus, k->sum == 0.0 ? 0.0 : -k->sum) &&
             same(sum_of(back, k->count), k->sum) && same(exact_value(&merged), k->sum),
         "%s, rounding %s: %.17g, due %.17g (0 apart)", k->name, mode, got, k->sum);
}

static void check_knowns(void)
{
  static const struct {
    const char *name;
    int mode;
  } modes[] = {{"to nearest", FE_TONEAREST},
               {"up", FE_UPWARD},
               {"down", FE_DOWNWARD},
               {"to zero", FE_TOWARDZERO}};
  for (size_t m = 0; m < sizeof modes / sizeof *modes; m++) {
    fesetround(modes[m].mode);
    for (size_t i = 0; i < sizeof knowns / sizeof *knowns; i++)
      check_known(&knowns[i], modes[m].name);
  }
  fesetround(FE_TONEAREST);
  const double bound[2] = {largest, half_last};
  tap_ok(isinf(sum_of(bound, 2)), "half of the last place above the largest is an infinity");
}

/* More addends than fit between two carries, by doubling a sum: 2^36 times the same. */
static void check_many(void)
{
  static const double values[] = {0x1.fffffffffffffp-1022, -0x1.fffffffffffffp10, 0x1p-1074};
  for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
    struct exact sum, copy;
    exact_begin(&sum);
    exact_add(&sum, &values[i], 1, 1);
    for (int k = 0; k < 36; k++) {
      copy = sum;
      exact_merge(&sum, &copy);
    }
    const double got = exact_value(&sum), due = ldexp(values[i], 36);
    tap_ok(same(got, due), "2^36 times %.17g: %.17g, due %.17g (0 apart)", values[i], got, due);
    copy = sum;
    for (size_t n = 0; n < EXACT_LIMBS; n++)
      copy.limb[n] = -copy.limb[n];
    exact_merge(&sum, &copy);
    tap_ok(same(exact_value(&sum), 0.0), "and with its opposite nothing is left");
  }
}

static void check_columns(void)
{
  const double table[3][2] = {{1e300, 1.0}, {-1e300, 0x1p-53}, {2.0, 0x1p-1074}};
  double total[2] = {7.0, 7.0};
  exact_columns(&table[0][0], 3, 2, total);
  tap_ok(total[0] == 2.0 && total[1] == 1.0 + 0x1p-52, "columns of a table: %g, %.17g", total[0],
         total[1]);
  exact_columns(&table[0][0], 0, 2, total);
  tap_ok(total[0] == 0.0 && total[1] == 0.0, "columns without rows: 0");
  const double some[] = {-3.0, 5.0, -0.0, NAN};
  tap_ok(exact_most(some, 3) == 5.0 && exact_most(some, 1) == -3.0, "the largest: 5, -3");
  tap_ok(exact_most(some, 0) == -INFINITY, "the largest of none: minus infinity");
  tap_ok(isnan(exact_most(some, 4)), "the largest, with no number among them: no number");
  tap_ok(!signbit(exact_most(some + 2, 1)), "the largest of -0: 0");
}

/* The doubles of a file, dealt over `parts` sums that are merged from the last one on. */
static int sum_file(const char *path, size_t parts, size_t stride)
{
  FILE *file = fopen(path, "rb");
  double value, *all = NULL;
  size_t count = 0, room = 0;
  while (file && fread(&value, sizeof value, 1, file) == 1) {
    if (count == room) {
      room = 2 * room + 1024;
      double *more = realloc(all, room * sizeof *all);
      if (!more)
        abort();
      all = more;
    }
    all[count++] = value;
  }
  if (file)
    fclose(file);
  struct exact *sum = calloc(parts, sizeof *sum);
  if (!sum || !file)
    abort();
  for (size_t p = 0; p < parts; p++)
    exact_begin(&sum[p]);
  for (size_t i = 0; i < count; i++)
    exact_add(&sum[i % parts], &all[i * stride % count], 1, 1);
  for (size_t p = parts - 1; p > 0; p--)
    exact_merge(&sum[p - 1], &sum[p]);
  printf("%a\n", exact_value(&sum[0]));
  free(sum);
  free(all);
  return 0;
}

int main(int count, char **word)
{
  if (count == 4)
    return sum_file(word[1], strtoul(word[2], NULL, 10), strtoul(word[3], NULL, 10));
  check_knowns();
  check_many();
  check_columns();
  return tap_done();
}
