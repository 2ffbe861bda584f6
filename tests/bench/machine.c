/* What this machine gives in this minute: memory by a triad, arithmetic by chains of fused
 * multiply-adds, on one thread or as many as asked for. Prints GB/s and GFlop/s, double precision.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { LENGTH = 1 << 24, REPEATS = 5, LANES = 128, ROUNDS = 2000000 };

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double triad(double *restrict a, const double *restrict b, const double *restrict c)
{
  double best = 1e300;
  for (int r = 0; r < REPEATS; r++) {
    const double start = now();
#pragma omp parallel for simd
    for (size_t i = 0; i < LENGTH; i++)
      a[i] = b[i] + 3.0 * c[i];
    const double took = now() - start;
    best = took < best ? took : best;
  }
  return 24e-9 * LENGTH / best;
}

static double multiply_adds(double *sum)
{
  double best = 1e300, threads = 0.0;
  for (int r = 0; r < REPEATS; r++) {
    double total = 0.0, count = 0.0;
    const double start = now();
#pragma omp parallel reduction(+ : total, count)
    {
      double x[LANES];
      for (int l = 0; l < LANES; l++)
        x[l] = 1e-3 * l;
      for (int k = 0; k < ROUNDS; k++)
#pragma omp simd
        for (int l = 0; l < LANES; l++)
          x[l] = x[l] * 0.999999 + 1e-6;
      for (int l = 0; l < LANES; l++)
        total += x[l];
      count += 1.0;
    }
    const double took = now() - start;
    best = took < best ? took : best;
    threads = count;
    *sum += total;
  }
  return 2e-9 * LANES * (double)ROUNDS * threads / best;
}

int main(void)
{
  double *a = malloc(LENGTH * sizeof *a), *b = malloc(LENGTH * sizeof *b),
         *c = malloc(LENGTH * sizeof *c), sum = 0.0;
  if (a == NULL || b == NULL || c == NULL)
    return 1;
#pragma omp parallel for simd
  for (size_t i = 0; i < LENGTH; i++) {
    a[i] = 0.0;
    b[i] = 1.0;
    c[i] = (double)i;
  }
  const double bandwidth = triad(a, b, c), flops = multiply_adds(&sum);
  printf("%.1f %.1f %g\n", bandwidth, flops, sum + a[LENGTH / 2]);
  free(a);
  free(b);
  free(c);
  return 0;
}
