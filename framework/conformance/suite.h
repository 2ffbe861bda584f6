/* A plugin of laws with the bench that its suite works on. */
#ifndef GAMUT_SUITE_H
#define GAMUT_SUITE_H

#include "conformance/laws.h"

struct suite {
  struct proof *proof;
  struct specimen specimen;
  struct laws laws;
  struct bench *bench;
  struct block block;
};

/* Makes the base specimen and a block. On failure the check fails with the reason. */
bool suite_new(struct suite *, struct proof *);
void suite_free(struct suite *);
/* The checks of any kernel on one operation; fails if a required one is missing. */
void suite_work(struct suite *, size_t operation, const char *label);
/* Every variant agrees with the whole formula where its condition holds. */
void suite_variants(struct suite *);
/* What a law depends on: slopes, jumps, parameters without influence. */
void prove_dependence(struct suite *);
/* Two threads in one kernel at once. */
void prove_threads(struct suite *, kernel_function);
/* Derivatives by parameters; `operation` is the number of the plugin's own. */
void suite_derivatives(struct suite *, size_t operation);

#endif
