/* Correlated normal variables by Cholesky's factor of their correlation matrix. */
#ifndef GAMUT_CORRELATION_H
#define GAMUT_CORRELATION_H

#include <stdbool.h>
#include <stddef.h>

/* What rounding leaves of an eigenvalue that is 0. */
#define CORRELATION_LEAST 1e-12

/* Smallest eigenvalue of a symmetric n x n matrix, row by row; NaN when out of memory. */
double correlation_smallest(const double *matrix, size_t n);
/* Lower triangle L with L L' = matrix, row by row, zeros above. An eigenvalue may be 0 (a variable
 * that follows from others, as with a correlation of 1). False if one is below 0 or out of memory.
 */
bool correlation_factor(const double *matrix, size_t n, double *lower);

#endif
