#include "exact/exact.h"
#include "run/host.h"

void host_sum(struct gamut_run *run, const double *value, size_t rows, size_t columns,
              double *total)
{
  (void)run;
  exact_columns(value, rows, columns, total);
}

double host_most(struct gamut_run *run, const double *value, size_t count)
{
  (void)run;
  return exact_most(value, count);
}
