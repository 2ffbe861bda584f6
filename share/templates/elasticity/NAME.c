#include "@NAME@.gamut.h"

/* Numbers of the components xx yy zz xy yz zx in a matrix stored row by row. */
static const int @NAME@_place[6] = {0, 4, 8, 1, 5, 6};

/* F at the end: (I + dt L) F. */
static void @NAME@_move(const struct @NAME@ *b, size_t i, double *f)
{
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      f[3 * r + c] = b->displacement_gradient_begin[3 * r + c][i] + (r == c);
      for (int k = 0; k < 3; k++)
        f[3 * r + c] += b->time_step[i] * b->velocity_gradient[3 * r + k][i] *
                        (b->displacement_gradient_begin[3 * k + c][i] + (k == c));
      b->displacement_gradient[3 * r + c][i] = f[3 * r + c] - (r == c);
    }
}

/* E of F, and the energy in it. */
static double @NAME@_strain(const double *f, double lame, double shear, double *e)
{
  double square = 0;
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      e[3 * r + c] = r == c ? -0.5 : 0.0;
      for (int k = 0; k < 3; k++)
        e[3 * r + c] += 0.5 * f[3 * k + r] * f[3 * k + c];
      square += e[3 * r + c] * e[3 * r + c];
    }
  double trace = e[0] + e[4] + e[8];
  return 0.5 * lame * trace * trace + shear * square;
}

static double @NAME@_determinant(const double *f)
{
  return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
         f[2] * (f[3] * f[7] - f[4] * f[6]);
}

static double @NAME@_energy_at_begin(const struct @NAME@ *b, size_t i, double lame)
{
  double f[9], e[9];
  for (int k = 0; k < 9; k++)
    f[k] = b->displacement_gradient_begin[k][i] + (k % 4 == 0);
  return @NAME@_strain(f, lame, b->shear_modulus[i], e);
}

static void @NAME@_stress(const struct @NAME@ *b)
{
  for (size_t i = 0; i < b->count; i++) {
    double f[9], e[9], g = b->shear_modulus[i], q = b->viscous_pressure[i];
    double lame = b->bulk_modulus[i] - 2.0 / 3.0 * g;
    double before = @NAME@_energy_at_begin(b, i, lame);
    @NAME@_move(b, i, f);
    double j = @NAME@_determinant(f), after = @NAME@_strain(f, lame, g, e),
           trace = e[0] + e[4] + e[8];
    for (int k = 0; k < 6; k++) {
      int r = @NAME@_place[k] / 3, c = @NAME@_place[k] % 3;
      double sum = 0;
      for (int m = 0; m < 9; m++) /* F S F' */
        sum += f[3 * r + m / 3] * ((m % 4 == 0 ? lame * trace : 0.0) + 2 * g * e[m]) *
               f[3 * c + m % 3];
      b->stress[k][i] = sum / j - (r == c ? q : 0.0);
    }
    b->volume_ratio[i] = j;
    b->energy[i] = b->energy_begin[i] + after - before - q * (j - b->volume_ratio_begin[i]);
    b->sound_speed[i] = sqrt((b->bulk_modulus[i] + 4.0 / 3.0 * g) / b->reference_density[i]);
    GAMUT_FLAG(b, i, !(j > 0), @UPPER@_INVERTED);
  }
}

GAMUT_ELASTICITY(@NAME@, .stress = @NAME@_stress)
