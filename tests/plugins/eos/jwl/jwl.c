#include "jwl.gamut.h"

static void jwl_pressure(const struct jwl *b)
{
  GAMUT_EACH (i, b) {
    double ratio = 1.0 + b->compression[i], V = 1.0 / ratio, e = b->energy[i];
    double R1 = b->R1[i], R2 = b->R2[i], omega = b->omega[i], F = b->burn_fraction[i];
    double hard = b->A[i] * gamut_exp(-R1 * V), soft = b->B[i] * gamut_exp(-R2 * V);
    double x1 = 1.0 - omega / (R1 * V), x2 = 1.0 - omega / (R2 * V);
    double K = b->unreacted_bulk_modulus[i], mu = b->compression[i];
    double by_V = F * (hard * (omega / (R1 * V * V) - R1 * x1) +
                       soft * (omega / (R2 * V * V) - R2 * x2) - omega * e / (V * V));
    double p = F * (hard * x1 + soft * x2 + omega * e / V) + (1.0 - F) * K * mu;
    double by_mu = -V * V * by_V + (1.0 - F) * K, by_e = F * omega / V;
    double square = (by_mu + p * by_e * V * V) / b->reference_density[i];
    b->pressure[i] = p;
    b->pressure_slope_compression[i] = by_mu;
    b->pressure_slope_energy[i] = by_e;
    b->sound_speed[i] = sqrt(square > 0.0 ? square : 0.0);
    GAMUT_FLAG(b, i, !(square > 0.0), JWL_SOFT);
    GAMUT_FLAG(b, i, ratio <= 0.0, JWL_VACUUM);
  }
}

GAMUT_EOS(jwl, .pressure = jwl_pressure)
