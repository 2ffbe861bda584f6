#include "bar.h"

/* Parts of fixed length are added lane by lane, then one after the other. */
enum { PART = 1024 };

static double part_of_products(size_t count, const double *x, const double *y)
{
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (size_t i = 0; i < count; i++)
    sum += x[i] * y[i];
  return sum;
}

double sum_of_products(size_t count, const double *x, const double *y)
{
  double sum = 0.0;
  for (size_t from = 0; from < count; from += PART) {
    size_t part = count - from < PART ? count - from : PART;
    sum += part_of_products(part, x + from, y + from);
  }
  return sum;
}

double largest(size_t count, const double *x)
{
  double most = 0.0, poison = 0.0;
#pragma omp simd reduction(max : most) reduction(+ : poison)
  for (size_t i = 0; i < count; i++) {
    double a = fabs(x[i]);
    most = a > most ? a : most;
    poison += x[i] * 0.0;
  }
  return most + poison;
}
