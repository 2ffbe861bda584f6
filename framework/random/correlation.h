/* Correlated normal variables by Cholesky's factor of their correlation matrix. */
#ifndef GAMUT_CORRELATION_H
#define GAMUT_CORRELATION_H

#include <stdbool.h>
#include <stddef.h>

/* What rounding leaves of an eigenvalue that is 0: a matrix whose smallest one is not above this is
 * not positive definite. */
#define CORRELATION_LEAST 1e-12

/* Smallest eigenvalue of a symmetric n x n matrix, row by row; NaN when out of memory. */
double correlation_smallest(const double *matrix, size_t n);
/* Lower triangle L with L L' = matrix, row by row, zeros above. False if it is not positive
 * definite or out of memory. */
bool correlation_factor(const double *matrix, size_t n, double *lower);

#endif
