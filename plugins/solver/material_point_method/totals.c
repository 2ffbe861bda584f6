/* Sums over blocks: room for them, and the largest values. What a block has is added up where its
 * points or nodes are at hand; over blocks the core adds, exactly, so that the numbers of blocks
 * and of threads cannot matter. */
#include "model.h"

/* An array with room for `wanted` numbers. */
static gamut_status widen(struct model *m, double **array, size_t *capacity, size_t wanted)
{
  if (wanted <= *capacity)
    return GAMUT_OK;
  gamut_release(m->run, *array);
  *capacity = 0;
  *array = gamut_allocate(m->run, "sums", (wanted + wanted / 8) * sizeof(double));
  if (*array == NULL)
    return GAMUT_INTERNAL;
  *capacity = wanted + wanted / 8;
  return GAMUT_OK;
}

gamut_status totals_room(struct model *m)
{
  struct totals *t = &m->totals;
  const size_t sources = m->grid.sources + 16, nodes = m->grid.blocks + 16;
  gamut_status status = GAMUT_OK;
  if (sources > t->most_capacity) {
    const size_t capacity = sources + sources / 8;
    gamut_release(m->run, m->block_most);
    m->block_most = gamut_allocate(m->run, "sums", capacity * sizeof *m->block_most);
    t->most_capacity = m->block_most != NULL ? capacity : 0;
    status = m->block_most != NULL ? GAMUT_OK : GAMUT_INTERNAL;
  }
  if (status == GAMUT_OK)
    status = widen(m, &m->block_sum, &t->sum_capacity, sources * POINT_SUMS);
  if (status == GAMUT_OK)
    status = widen(m, &t->measured, &t->measured_capacity, sources * MEASURED);
  if (status == GAMUT_OK)
    status = widen(m, &m->node_sum, &t->node_capacity, nodes * TOTAL_SUMS);
  if (status == GAMUT_OK)
    status = widen(m, &m->node_speed, &t->speed_capacity, nodes);
  return status == GAMUT_OK ? removal_room(m) : status;
}

gamut_status totals_planes_room(struct model *m)
{
  const size_t rows = m->planes.of_nodes / m->grid.block_nodes;
  const size_t columns = PLANE_SUMS + EACH_PLANE_SUMS * m->planes.count;
  return widen(m, &m->planes.row, &m->planes.row_capacity, (rows + 1) * columns);
}

void totals_destroy(struct model *m)
{
  gamut_release(m->run, m->block_sum);
  gamut_release(m->run, m->block_most);
  gamut_release(m->run, m->totals.measured);
  gamut_release(m->run, m->node_sum);
  gamut_release(m->run, m->node_speed);
  gamut_release(m->run, m->planes.row);
}
