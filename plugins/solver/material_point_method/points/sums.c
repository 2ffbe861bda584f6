/* Sums over the points of a chunk, by lane and in the order of slots, for the ledger. */
#include "model.h"

#define ADD(quantity, value) sum[(quantity)*GAMUT_LANES + l] += (value)

/* With B the first moments of velocity and D the second ones of the weights: moment of momentum is
 * mass (B - B^T) off the diagonal, kinetic energy half the mass times the sum of B_ck^2 / D_k. */
static void add_affine(double *restrict sum, const struct work *w, const struct point_view *p,
                       unsigned dimension, size_t i)
{
  const double mean = w->mean_second;
  for (size_t l = 0; l < GAMUT_LANES; l++) {
    const size_t j = i + l;
    const double mass = p->mass[j];
    double moment[9] = {0.0}, energy = 0.0;
    for (size_t c = 0; c < dimension; c++)
      for (size_t k = 0; k < dimension; k++) {
        moment[3 * c + k] = mean * p->affine[3 * c + k][j];
        energy += moment[3 * c + k] * moment[3 * c + k] / w->second[k][j];
      }
    ADD(SUM_KINETIC, 0.5 * mass * energy);
    for (size_t k = 0; k < 3; k++) {
      const size_t a = (k + 1) % 3, b = (k + 2) % 3;
      const double angular_momentum = mass * (moment[3 * b + a] - moment[3 * a + b]);
      ADD(SUM_ANGULAR_MOMENTUM + k, angular_momentum);
      ADD(SUM_ROUND + k, angular_momentum > 0.0 ? angular_momentum : 0.0);
    }
  }
}

void sums_motion(struct work *w, const struct point_view *p, unsigned dimension,
                 const double *energy)
{
  double *restrict sum = w->point_sum;
  const double over = energy == NULL ? 0.0 : 1.0 / p->density;
  const double *e = energy == NULL ? p->mass : energy;
  for (size_t i = 0; i < p->count; i += GAMUT_LANES) {
#pragma omp simd
    for (size_t l = 0; l < GAMUT_LANES; l++) {
      const size_t j = i + l;
      const double mass = p->mass[j];
      const double x = p->position[0][j], y = p->position[1][j], z = p->position[2][j];
      const double u = p->velocity[0][j], v = p->velocity[1][j], t = p->velocity[2][j];
      ADD(SUM_MASS, mass);
      const double push[3] = {mass * u, mass * v, mass * t};
      const double angular_momentum[3] = {y * push[2] - z * push[1], z * push[0] - x * push[2],
                                          x * push[1] - y * push[0]};
      for (size_t k = 0; k < 3; k++) {
        ADD(SUM_MOMENTUM + k, push[k]);
        ADD(SUM_FORWARD + k, push[k] > 0.0 ? push[k] : 0.0);
        ADD(SUM_ANGULAR_MOMENTUM + k, angular_momentum[k]);
        ADD(SUM_ROUND + k, angular_momentum[k] > 0.0 ? angular_momentum[k] : 0.0);
      }
      ADD(SUM_KINETIC, 0.5 * mass * (u * u + v * v + t * t));
      ADD(SUM_INTERNAL, mass * over * e[j]);
    }
    if (p->affine[0] != NULL && i < p->real)
      add_affine(sum, w, p, dimension, i);
  }
}

void sums_forces(struct work *w, const struct point_view *p)
{
  double *restrict sum = w->point_sum;
  for (size_t i = 0; i < p->count; i += GAMUT_LANES) {
#pragma omp simd
    for (size_t l = 0; l < GAMUT_LANES; l++) {
      const size_t j = i + l;
      const double mass = p->mass[j], real = mass > 0.0 ? 1.0 : 0.0;
      const double x = p->position[0][j], y = p->position[1][j], z = p->position[2][j];
      const double a = real * p->force[0][j], b = real * p->force[1][j], c = real * p->force[2][j];
      ADD(SUM_FORCE, a);
      ADD(SUM_FORCE + 1, b);
      ADD(SUM_FORCE + 2, c);
      ADD(SUM_TORQUE, y * c - z * b);
      ADD(SUM_TORQUE + 1, z * a - x * c);
      ADD(SUM_TORQUE + 2, x * b - y * a);
      ADD(SUM_POWER, a * p->velocity[0][j] + b * p->velocity[1][j] + c * p->velocity[2][j]);
      ADD(SUM_MOBILITY, real * 0.5 * (a * a + b * b + c * c) / (mass > 0.0 ? mass : 1.0));
    }
  }
}
#undef ADD
