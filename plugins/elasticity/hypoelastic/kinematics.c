/* The step's motion: strain, rotation, volume, and the trial deviator that follows from them. */
#include "hypoelastic.h"

struct hypoelastic_symmetric {
  double xx, yy, zz, xy, yz, zx;
};
struct hypoelastic_full {
  double xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

GAMUT_INLINE double hypoelastic_twice_contracted(struct hypoelastic_symmetric a,
                                                 struct hypoelastic_symmetric b)
{
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.yz * b.yz + a.zx * b.zx);
}

/* r s r', where r is the rotation with axis t and tan(angle / 2) = |t|. The change of s is added to
 * it, so that the rounding of many small rotations does not add up. */
GAMUT_INLINE struct hypoelastic_symmetric hypoelastic_rotated(struct hypoelastic_symmetric s,
                                                              double tx, double ty, double tz)
{
  double f = 2.0 / (1.0 + tx * tx + ty * ty + tz * tz);
  /* w = r - I = f (T + T^2), T v = t x v */
  struct hypoelastic_full w = {.xx = -f * (ty * ty + tz * tz),
                               .xy = f * (tx * ty - tz),
                               .xz = f * (tz * tx + ty),
                               .yx = f * (tx * ty + tz),
                               .yy = -f * (tz * tz + tx * tx),
                               .yz = f * (ty * tz - tx),
                               .zx = f * (tz * tx - ty),
                               .zy = f * (ty * tz + tx),
                               .zz = -f * (tx * tx + ty * ty)};
  struct hypoelastic_full a = {.xx = w.xx * s.xx + w.xy * s.xy + w.xz * s.zx,
                               .xy = w.xx * s.xy + w.xy * s.yy + w.xz * s.yz,
                               .xz = w.xx * s.zx + w.xy * s.yz + w.xz * s.zz,
                               .yx = w.yx * s.xx + w.yy * s.xy + w.yz * s.zx,
                               .yy = w.yx * s.xy + w.yy * s.yy + w.yz * s.yz,
                               .yz = w.yx * s.zx + w.yy * s.yz + w.yz * s.zz,
                               .zx = w.zx * s.xx + w.zy * s.xy + w.zz * s.zx,
                               .zy = w.zx * s.xy + w.zy * s.yy + w.zz * s.yz,
                               .zz = w.zx * s.zx + w.zy * s.yz + w.zz * s.zz};
  /* s + a + a' + a w' */
  struct hypoelastic_symmetric sum = {
      .xx = s.xx + (2.0 * a.xx + (a.xx * w.xx + a.xy * w.xy + a.xz * w.xz)),
      .yy = s.yy + (2.0 * a.yy + (a.yx * w.yx + a.yy * w.yy + a.yz * w.yz)),
      .zz = s.zz + (2.0 * a.zz + (a.zx * w.zx + a.zy * w.zy + a.zz * w.zz)),
      .xy = s.xy + (a.xy + a.yx + (a.xx * w.yx + a.xy * w.yy + a.xz * w.yz)),
      .yz = s.yz + (a.yz + a.zy + (a.yx * w.zx + a.yy * w.zy + a.yz * w.zz)),
      .zx = s.zx + (a.zx + a.xz + (a.zx * w.xx + a.zy * w.xy + a.zz * w.xz))};
  return sum;
}

GAMUT_INLINE struct hypoelastic_full hypoelastic_gradient_step(const struct hypoelastic *b,
                                                               size_t i)
{
  double dt = b->time_step[i];
  struct hypoelastic_full g = {
      .xx = dt * b->velocity_gradient[0][i],
      .xy = dt * b->velocity_gradient[1][i],
      .xz = dt * b->velocity_gradient[2][i],
      .yx = dt * b->velocity_gradient[3][i],
      .yy = dt * b->velocity_gradient[4][i],
      .yz = dt * b->velocity_gradient[5][i],
      .zx = dt * b->velocity_gradient[6][i],
      .zy = dt * b->velocity_gradient[7][i],
      .zz = dt * b->velocity_gradient[8][i],
  };
  return g;
}

/* det(I + g) - 1, without loss for small g. */
GAMUT_INLINE double hypoelastic_volume_change(struct hypoelastic_full g)
{
  double minors =
      (g.xx * g.yy - g.xy * g.yx) + (g.yy * g.zz - g.yz * g.zy) + (g.zz * g.xx - g.zx * g.xz);
  double product = g.xx * (g.yy * g.zz - g.yz * g.zy) - g.xy * (g.yx * g.zz - g.yz * g.zx) +
                   g.xz * (g.yx * g.zy - g.yy * g.zx);
  return (g.xx + g.yy + g.zz) + (minors + product);
}

/* h = g (I + g/2)^-1, the displacement gradient of the step over the configuration at its middle.
 */
GAMUT_INLINE struct hypoelastic_full hypoelastic_at_middle(struct hypoelastic_full g,
                                                           double *determinant)
{
  struct hypoelastic_full m = {1.0 + 0.5 * g.xx, 0.5 * g.xy,       0.5 * g.xz,
                               0.5 * g.yx,       1.0 + 0.5 * g.yy, 0.5 * g.yz,
                               0.5 * g.zx,       0.5 * g.zy,       1.0 + 0.5 * g.zz};
  struct hypoelastic_full c = {.xx = m.yy * m.zz - m.yz * m.zy, /* the adjugate of m */
                               .xy = m.xz * m.zy - m.xy * m.zz,
                               .xz = m.xy * m.yz - m.xz * m.yy,
                               .yx = m.yz * m.zx - m.yx * m.zz,
                               .yy = m.xx * m.zz - m.xz * m.zx,
                               .yz = m.xz * m.yx - m.xx * m.yz,
                               .zx = m.yx * m.zy - m.yy * m.zx,
                               .zy = m.xy * m.zx - m.xx * m.zy,
                               .zz = m.xx * m.yy - m.xy * m.yx};
  *determinant = m.xx * c.xx + m.xy * c.yx + m.xz * c.zx;
  double f = 1.0 / *determinant;
  struct hypoelastic_full h = {.xx = f * (g.xx * c.xx + g.xy * c.yx + g.xz * c.zx),
                               .xy = f * (g.xx * c.xy + g.xy * c.yy + g.xz * c.zy),
                               .xz = f * (g.xx * c.xz + g.xy * c.yz + g.xz * c.zz),
                               .yx = f * (g.yx * c.xx + g.yy * c.yx + g.yz * c.zx),
                               .yy = f * (g.yx * c.xy + g.yy * c.yy + g.yz * c.zy),
                               .yz = f * (g.yx * c.xz + g.yy * c.yz + g.yz * c.zz),
                               .zx = f * (g.zx * c.xx + g.zy * c.yx + g.zz * c.zx),
                               .zy = f * (g.zx * c.xy + g.zy * c.yy + g.zz * c.zy),
                               .zz = f * (g.zx * c.xz + g.zy * c.yz + g.zz * c.zz)};
  return h;
}

GAMUT_INLINE struct hypoelastic_symmetric hypoelastic_deviator_begin(const struct hypoelastic *b,
                                                                     size_t i)
{
  double xx = b->stress_begin[0][i], yy = b->stress_begin[1][i], zz = b->stress_begin[2][i];
  double mean = (xx + yy + zz) * (1.0 / 3.0);
  struct hypoelastic_symmetric s = {xx - mean,
                                    yy - mean,
                                    zz - mean,
                                    b->stress_begin[3][i],
                                    b->stress_begin[4][i],
                                    b->stress_begin[5][i]};
  return s;
}

GAMUT_INLINE void hypoelastic_put(const struct hypoelastic *b, size_t i,
                                  struct hypoelastic_symmetric s)
{
  b->scratch[HYPOELASTIC_TRIAL + 0][i] = s.xx;
  b->scratch[HYPOELASTIC_TRIAL + 1][i] = s.yy;
  b->scratch[HYPOELASTIC_TRIAL + 2][i] = s.zz;
  b->scratch[HYPOELASTIC_TRIAL + 3][i] = s.xy;
  b->scratch[HYPOELASTIC_TRIAL + 4][i] = s.yz;
  b->scratch[HYPOELASTIC_TRIAL + 5][i] = s.zx;
}

void hypoelastic_volume(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    double change = hypoelastic_volume_change(hypoelastic_gradient_step(b, i)),
           J = b->volume_ratio_begin[i];
    /* J1 - 1 before it is rounded into J1: a strain of 1e-12 keeps its digits in the compression.
     */
    double step = J * change, above = (J - 1.0) + step;
    b->scratch[HYPOELASTIC_VOLUME_STEP][i] = step;
    b->scratch[HYPOELASTIC_COMPRESSION][i] = -above / (1.0 + above);
    b->volume_ratio[i] = 1.0 + above;
    GAMUT_FLAG(b, i, !(1.0 + above > 0.0), HYPOELASTIC_INVERTED);
  }
}

void hypoelastic_trial(const struct hypoelastic *b)
{
  const double *shear = hypoelastic_shear(b);
  GAMUT_EACH (i, b) {
    double determinant;
    struct hypoelastic_full h =
        hypoelastic_at_middle(hypoelastic_gradient_step(b, i), &determinant);
    double mean = (h.xx + h.yy + h.zz) * (1.0 / 3.0);
    struct hypoelastic_symmetric e = {h.xx - mean,         h.yy - mean,
                                      h.zz - mean,         0.5 * (h.xy + h.yx),
                                      0.5 * (h.yz + h.zy), 0.5 * (h.zx + h.xz)};
    /* Half the axial vector of skew h is the axis times tan(angle / 2); from it tan(angle / 4). */
    double tx = 0.25 * (h.zy - h.yz), ty = 0.25 * (h.xz - h.zx), tz = 0.25 * (h.yx - h.xy);
    double f = 1.0 / (1.0 + sqrt(1.0 + (tx * tx + ty * ty + tz * tz)));
    tx *= f, ty *= f, tz *= f;
    struct hypoelastic_symmetric s =
        hypoelastic_rotated(hypoelastic_deviator_begin(b, i), tx, ty, tz);
    b->scratch[HYPOELASTIC_WORK_BEGIN][i] = hypoelastic_twice_contracted(s, e);
    double twice = 2.0 * shear[i];
    s.xx += twice * e.xx, s.yy += twice * e.yy, s.zz += twice * e.zz;
    s.xy += twice * e.xy, s.yz += twice * e.yz, s.zx += twice * e.zx;
    b->scratch[HYPOELASTIC_WORK_TRIAL][i] = hypoelastic_twice_contracted(s, e);
    b->scratch[HYPOELASTIC_TRIAL_SIZE][i] = sqrt(1.5 * hypoelastic_twice_contracted(s, s));
    b->scratch[HYPOELASTIC_STRAIN_SIZE][i] = sqrt((2.0 / 3.0) * hypoelastic_twice_contracted(e, e));
    b->scratch[HYPOELASTIC_TURN + 0][i] = tx;
    b->scratch[HYPOELASTIC_TURN + 1][i] = ty;
    b->scratch[HYPOELASTIC_TURN + 2][i] = tz;
    hypoelastic_put(b, i, s);
    GAMUT_FLAG(b, i, !(determinant > 0.0), HYPOELASTIC_INVERTED);
  }
}

/* The second half of the rotation, of the deviator that the return has left. */
void hypoelastic_turn(const struct hypoelastic *b)
{
  GAMUT_EACH (i, b) {
    struct hypoelastic_symmetric s = {
        b->scratch[HYPOELASTIC_TRIAL + 0][i], b->scratch[HYPOELASTIC_TRIAL + 1][i],
        b->scratch[HYPOELASTIC_TRIAL + 2][i], b->scratch[HYPOELASTIC_TRIAL + 3][i],
        b->scratch[HYPOELASTIC_TRIAL + 4][i], b->scratch[HYPOELASTIC_TRIAL + 5][i]};
    hypoelastic_put(b, i,
                    hypoelastic_rotated(s, b->scratch[HYPOELASTIC_TURN + 0][i],
                                        b->scratch[HYPOELASTIC_TURN + 1][i],
                                        b->scratch[HYPOELASTIC_TURN + 2][i]));
  }
}
