double hardening_of_a_library(double plastic_strain);

double hardening_of_a_library(double plastic_strain)
{
  return 1e8 * plastic_strain;
}
