/* Blocks of material points, as a kernel sees them.
 *
 * A kernel is a pure function of one block. The block is a struct that `gamut header` generates
 * from the plugin's YAML: a count, a status word a point, then one pointer per parameter, input,
 * output, state variable and scratch array, in declared order. All arrays are plain, 64-byte
 * aligned, hold `count` values and are borrowed for the call. Uniform or varying in space: the
 * kernel cannot tell.
 *
 * Data that the plugin prepared of the values for its kernels is a pointer `data` in the block, see
 * `prepare` in <gamut/kernel.h>: one for all threads, constant.
 *
 * Rules. A kernel keeps no state between calls, allocates nothing, prints nothing, writes every
 * output of every point, never writes an input, and calls nothing but <gamut/math.h>, sqrt, fabs,
 * copysign and the laws that the core bound into its block (see <gamut/kernel.h>). Different
 * threads call it with different blocks at once.
 */
#ifndef GAMUT_BLOCK_H
#define GAMUT_BLOCK_H

#include <stddef.h>
#include <stdint.h>

#define GAMUT_LANES 8 /* blocks and chunks are padded to a multiple of this many points */
#ifndef GAMUT_CHUNK_MAX
#define GAMUT_CHUNK_MAX 1024 /* the most points a chunk can hold */
#endif

/* Loops over the points of a block. The pragma is what lets the compiler vectorise: with a dozen
 * pointers its alias analysis gives up in silence. The body must not carry anything from one point
 * to the next. */
#if defined(__cplusplus)
#define GAMUT_EACH(i, block) for (size_t i = 0; i < (block)->count; i++)
#else
#define GAMUT_EACH(i, block) _Pragma("omp simd") for (size_t i = 0; i < (block)->count; i++)
#endif

/* A point's status is 0 (fine) or a message declared in the descriptor under `messages`. The
 * generated header has one constant per message, e.g. MIE_GRUNEISEN_BEYOND_POLE; greater is worse.
 * note: counted. warn: counted, and the first is printed. stop: the run ends (exit 5) and names the
 * point, its place, state and parameters. */
enum gamut_severity { GAMUT_FINE = 0, GAMUT_NOTE = 1, GAMUT_WARN = 2, GAMUT_STOP = 3 };
#define GAMUT_MESSAGE(severity, index) ((int64_t)(severity) * 256 + (index))

/* Flags point i with `message` where `condition` holds, keeping a worse one that stands there. */
#define GAMUT_FLAG(block, i, condition, message)                                                   \
  gamut_flag(&(block)->status[i], (condition) ? (int64_t)(message) : 0)
static inline void gamut_flag(int64_t *status, int64_t raised)
{
  *status = *status < raised ? raised : *status;
}

/* Stores a derivative where the core asked for it (the pointer is null otherwise). */
#define GAMUT_PUT(pointer, i, value)                                                               \
  do {                                                                                             \
    if (pointer)                                                                                   \
      (pointer)[i] = (value);                                                                      \
  } while (0)

/* A law of the material bound by the core into the block of an elasticity plugin (its callee).
 *
 * The caller writes trial arguments into the argument arrays (scratch of the core, `count` values
 * each, filled with the values at the beginning of the step), calls `evaluate`, and reads the
 * results. It may do so as often as its iteration needs. `lane` lists the points to evaluate
 * (borrowed, `lanes` entries, ascending); null means all. Results of other points are left as they
 * were. The status that a law raised in its last evaluation of a point is counted by the core under
 * the law's own messages; the caller need not look. */
struct gamut_strength_law {
  void (*evaluate)(const struct gamut_strength_law *law, const uint32_t *lane, size_t lanes);
  double *plastic_strain;      /* argument: equivalent plastic strain, 1 */
  double *plastic_strain_rate; /* argument: its rate, 1/s */
  double *temperature;         /* argument: K */
  double *pressure;    /* argument: of the eos, without viscous pressure, Pa; null: not read */
  double *compression; /* argument: rho/rho0 - 1 at the end of the step; null: not read */
  double *flow_stress;                           /* result: Pa, never negative */
  double *flow_stress_slope_plastic_strain;      /* result: Pa; zero if the law declares none */
  double *flow_stress_slope_plastic_strain_rate; /* result: Pa s; zero if the law declares none */
  double *flow_stress_slope_temperature;         /* result: Pa/K; zero if the law declares none */
  double *shear_modulus_factor; /* result: what the shear modulus is multiplied by, never negative;
                                   null: the law leaves it as it is */
};

struct gamut_eos_law {
  void (*evaluate)(const struct gamut_eos_law *law, const uint32_t *lane, size_t lanes);
  double *compression; /* argument: rho/rho0 - 1, 1 */
  double *energy;      /* argument: internal energy per reference volume, J/m3 */
  double *pressure;                   /* result: Pa, positive in compression */
  double *pressure_slope_compression; /* result: dp/dmu at constant energy, Pa */
  double *pressure_slope_energy;      /* result: dp/de at constant mu, 1; zero if not declared */
  double *sound_speed;                /* result: bulk sound speed, m/s */
};

static inline void gamut_evaluate_strength(const struct gamut_strength_law *law,
                                           const uint32_t *lane, size_t lanes)
{
  law->evaluate(law, lane, lanes);
}
static inline void gamut_evaluate_eos(const struct gamut_eos_law *law, const uint32_t *lane,
                                      size_t lanes)
{
  law->evaluate(law, lane, lanes);
}
#endif
