/* What opens and closes a block of points: nodes come in, boxes and sums are left. */
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "step/step.h"

static int thread_number(void)
{
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

gamut_status load_block(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  grid_load(&m->grid, &m->grid.source[chunk->serial], m->work[chunk->thread]->tile);
  return GAMUT_OK;
}

gamut_status flush_box(struct model *m, struct work *w, size_t serial)
{
  struct point_block *s = &m->grid.source[serial];
  if (m->transfer.finish != NULL)
    m->transfer.finish(w);
  for (unsigned k = 0; k < m->dimension; k++) {
    s->lower[k] = w->lower[k];
    s->upper[k] = w->upper[k];
    w->lower[k] = m->grid.tile;
    w->upper[k] = 0;
  }
  return grid_leave(&m->grid, serial, w->sums);
}

/* In the sweep that moves the points. */
static void flush_speed(struct model *m, struct work *w, size_t serial)
{
  m->block_most[serial].speed = w->speed;
  w->speed = 0.0;
}

gamut_status flush_momentum(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  struct work *w = m->work[chunk->thread];
  if (m->stress_update == UPDATE_USF)
    flush_speed(m, w, chunk->serial);
  return flush_box(m, w, chunk->serial);
}

gamut_status flush_sums(struct model *m, struct work *w, size_t serial)
{
  const gamut_status status = flush_box(m, w, serial);
  for (size_t q = 0; q < POINT_SUMS; q++) {
    double sum = 0.0;
    for (size_t l = 0; l < GAMUT_LANES; l++)
      sum += w->point_sum[q * GAMUT_LANES + l];
    m->block_sum[serial * POINT_SUMS + q] = sum;
  }
  memset(w->point_sum, 0, POINT_SUMS * GAMUT_LANES * sizeof *w->point_sum);
  m->block_most[serial].omega_squared = w->omega_squared;
  w->omega_squared = 0.0;
  if (m->stress_update != UPDATE_USF)
    flush_speed(m, w, serial);
  return status;
}

gamut_status flush_block(void *self, const struct gamut_chunk *chunk)
{
  struct model *m = self;
  return flush_sums(m, m->work[chunk->thread], chunk->serial);
}

static gamut_status first_block(struct model *m, const struct body *body, size_t block,
                                size_t serial, struct work *w)
{
  const struct gamut_set *set = body->set;
  const size_t slot = set->first[block], end = set->first[block + 1];
  for (size_t at = slot; at < end; at += GAMUT_CHUNK_MAX) {
    struct point_view view = {.count = end - at < GAMUT_CHUNK_MAX ? end - at : GAMUT_CHUNK_MAX};
    for (unsigned k = 0; k < 3; k++) {
      view.position[k] = m->host->stored(set, m->field.position, k) + at;
      view.velocity[k] = m->host->stored(set, m->field.velocity, k) + at;
    }
    for (unsigned k = 0; k < 6; k++)
      view.stress[k] = m->host->stored(set, m->field.stress, k) + at;
    for (unsigned k = 0; m->shape == SHAPE_GIMP && k < 3; k++)
      view.length[k] = m->host->stored(set, m->field.domain_length, k) + at;
    for (unsigned k = 0; m->rule == RULE_APIC && k < 9; k++)
      view.affine[k] = m->host->stored(set, m->field.affine_velocity, k) + at;
    view.mass = m->host->stored(set, m->field.mass, 0) + at;
    view.volume_ratio = m->host->stored(set, m->field.volume_ratio, 0) + at;
    const double *energy = m->host->stored(set, m->field.energy, 0);
    const gamut_status status =
        scatter_view(m, w, set, serial, at, &view, energy == NULL ? NULL : energy + at);
    if (status != GAMUT_OK)
      return status;
  }
  return flush_sums(m, w, serial);
}

gamut_status each_block(struct model *m, block_work *run)
{
  size_t serial = 0;
  for (size_t b = 0; b < m->bodies; b++) {
    const size_t blocks = m->body[b].set->blocks;
    gamut_status worst = GAMUT_OK;
#pragma omp parallel for schedule(dynamic)                                                         \
    num_threads(m->threads) if (m->grid.sources >= FEW_BLOCKS)
    for (size_t k = 0; k < blocks; k++) {
      const gamut_status status = run(m, &m->body[b], k, serial + k, m->work[thread_number()]);
      if (status != GAMUT_OK) {
#pragma omp atomic write
        worst = status;
      }
    }
    if (worst != GAMUT_OK)
      return worst;
    serial += blocks;
  }
  return GAMUT_OK;
}

gamut_status step_first_scatter(struct model *m)
{
  return each_block(m, first_block);
}
