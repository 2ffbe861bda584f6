#include "driver.h"

static void product(const double a[9], const double b[9], double out[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

static double largest(const double a[9])
{
  double most = 0.0;
  for (int k = 0; k < 9; k++)
    most = fmax(most, fabs(a[k]));
  return most;
}

static bool is_diagonal(const double a[9])
{
  return a[1] == 0.0 && a[2] == 0.0 && a[3] == 0.0 && a[5] == 0.0 && a[6] == 0.0 && a[7] == 0.0;
}

/* The series of exp(A) - I for a small A. */
static void series(const double A[9], double G[9])
{
  double term[9], next[9];
  for (int k = 0; k < 9; k++)
    term[k] = G[k] = A[k];
  for (int n = 2; n < 30 && largest(term) > 1e-18 * largest(G); n++) {
    product(term, A, next);
    for (int k = 0; k < 9; k++) {
      term[k] = next[k] / n;
      G[k] += term[k];
    }
  }
}

void exponential_less_one(const double A[9], double G[9])
{
  double small[9], square[9];
  int halvings = 0;
  if (is_diagonal(A)) {
    for (int k = 0; k < 9; k++)
      G[k] = k % 4 == 0 ? expm1(A[k]) : 0.0;
    return;
  }
  for (double size = largest(A); size > 0.25 && size < HUGE_VAL; size *= 0.5)
    halvings++;
  for (int k = 0; k < 9; k++)
    small[k] = ldexp(A[k], -halvings);
  series(small, G);
  /* exp(2 A) - I = 2 G + G^2 */
  for (; halvings > 0; halvings--) {
    product(G, G, square);
    for (int k = 0; k < 9; k++)
      G[k] = 2.0 * G[k] + square[k];
  }
}

void compose(const double G[9], const double H[9], double out[9])
{
  product(G, H, out);
  for (int k = 0; k < 9; k++)
    out[k] += G[k] + H[k];
}

double volume_change(const double H[9])
{
  double minors =
      (H[0] * H[4] - H[1] * H[3]) + (H[4] * H[8] - H[5] * H[7]) + (H[8] * H[0] - H[6] * H[2]);
  double whole = H[0] * (H[4] * H[8] - H[5] * H[7]) - H[1] * (H[3] * H[8] - H[5] * H[6]) +
                 H[2] * (H[3] * H[7] - H[4] * H[6]);
  return (H[0] + H[4] + H[8]) + (minors + whole);
}

/* Jacobi's method: makes the symmetric matrix a diagonal, its axes are the columns of v. */
static void diagonalise(double a[3][3], double v[3][3])
{
  static const int row[] = {0, 0, 1}, column[] = {1, 2, 2};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      v[i][j] = i == j;
  for (int turn = 0; turn < 60; turn++) {
    int p = row[turn % 3], q = column[turn % 3];
    if (a[p][q] == 0.0)
      continue;
    double half = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    double t = (half < 0.0 ? -1.0 : 1.0) / (fabs(half) + sqrt(half * half + 1.0));
    double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < 3; k++) {
      double kp = a[k][p], kq = a[k][q];
      a[k][p] = c * kp - s * kq;
      a[k][q] = s * kp + c * kq;
    }
    for (int k = 0; k < 3; k++) {
      double pk = a[p][k], qk = a[q][k], kp = v[k][p], kq = v[k][q];
      a[p][k] = c * pk - s * qk;
      a[q][k] = s * pk + c * qk;
      v[k][p] = c * kp - s * kq;
      v[k][q] = s * kp + c * kq;
    }
    a[p][q] = a[q][p] = 0.0;
  }
}

/* From F F' - I, so that small strains keep their digits. */
void log_strain(const double H[9], double strain[6])
{
  static const int row[] = {0, 1, 2, 0, 1, 2}, column[] = {0, 1, 2, 1, 2, 0};
  double a[3][3], v[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      a[i][j] = H[3 * i + j] + H[3 * j + i];
      for (int k = 0; k < 3; k++)
        a[i][j] += H[3 * i + k] * H[3 * j + k];
    }
  diagonalise(a, v);
  for (int c = 0; c < SYMMETRIC; c++) {
    strain[c] = 0.0;
    for (int k = 0; k < 3; k++)
      strain[c] += 0.5 * log1p(a[k][k]) * v[row[c]][k] * v[column[c]][k];
  }
}
