/* A small run whose files the harnesses of the store change: every kind of thing that is kept. */
#ifndef GAMUT_TESTS_FUZZ_BASE_RUN_H
#define GAMUT_TESTS_FUZZ_BASE_RUN_H

#include <stddef.h>
#include <stdint.h>

#include "run/run.h"

/* The scene, read once; runs are made of it one after the other. */
struct scene *base_scene(void);
/* Whole files as the run left them, held in memory. */
struct base_file {
  uint8_t *data;
  size_t size;
};
/* Where its frames have come to. */
const struct store_place *base_place(void);
const struct base_file *base_checkpoint(void);
const struct base_file *base_results(void);

#endif
