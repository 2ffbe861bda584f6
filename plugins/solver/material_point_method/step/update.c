/* The update of the grid, as tasks done once a step. */
#include <math.h>
#include <string.h>

#include "step/step.h"

enum { BLOCK_NODES_MAX = 64 };

gamut_status step_collect(struct model *m)
{
  struct grid *g = &m->grid;
  if (grid_open_reached(g) != GAMUT_OK)
    return GAMUT_INTERNAL;
#pragma omp parallel for schedule(dynamic, 8) num_threads(m->threads) if (g->blocks >= FEW_BLOCKS)
  for (size_t b = 0; b < g->blocks; b++)
    if (g->block[b].line != NULL)
      grid_collect(g, &g->block[b], g->block[b].line);
  return grid_forget_boxes(g);
}

double step_slow_mass(const struct model *m, double mass, double square)
{
  const double least = m->limited ? fabs(square) / mass : m->grid.empty;
  return mass > least ? mass : least;
}

static void add_node(const double *line, const double x[3], const double v[3],
                     const double change[3], const double angular_momentum[3], struct nodes *s)
{
  const double mass = line[NODE_MASS];
  double before = 0.0, after = 0.0, work = 0.0;
  for (int k = 0; k < 3; k++) {
    const double old = v[k] - change[k];
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    before += old * old;
    after += v[k] * v[k];
    work += change[k] * (v[k] - 0.5 * change[k]);
    s->speed = fabs(v[k]) > s->speed ? fabs(v[k]) : s->speed;
    s->sum[TOTAL_ANGULAR_MOMENTUM + k] += x[a] * angular_momentum[b] - x[b] * angular_momentum[a];
  }
  s->sum[TOTAL_BEFORE] += 0.5 * mass * before;
  s->sum[TOTAL_AFTER] += 0.5 * mass * after;
  s->sum[TOTAL_WORK] += mass * work;
}

static void update_node(const struct model *m, double *line, const double x[3], double step,
                        struct nodes *s)
{
  const double mass = line[NODE_MASS], square = line[NODE_SQUARE];
  const bool touched = square < 0.0;
  const double over = 1.0 / mass;
  const bool heavy = mass > m->grid.empty && !m->limited;
  const double slow = heavy ? over : 1.0 / step_slow_mass(m, mass, square);
  double v[3], change[3], whole[3], angular_momentum[3];
  for (int k = 0; k < 3; k++) {
    const double push = step * line[NODE_FORCE + k];
    change[k] = push * slow;
    whole[k] = push * over;
    angular_momentum[k] = line[NODE_MOMENTUM + k] + push;
    v[k] = line[NODE_MOMENTUM + k] * over + change[k];
  }
  if (!touched)
    add_node(line, x, v, change, angular_momentum, s);
  for (int k = 0; k < 3; k++) {
    line[NODE_VELOCITY + k] = v[k];
    line[NODE_CHANGE + k] = touched ? change[k] : whole[k] + m->give_old * (v[k] - change[k]);
  }
  line[NODE_FRACTION] = mass;
  line[NODE_SLOW] = mass * slow;
}

static void update_block(struct model *m, size_t b, double step)
{
  struct nodes sums = {0};
  const struct node_block *block = &m->grid.block[b];
  const int side = m->grid.side, nx = side, ny = m->dimension > 1 ? side : 1,
            nz = m->dimension > 2 ? side : 1;
  double *line = block->line, x[3] = {0.0, 0.0, 0.0};
  double corner[3] = {0.0, 0.0, 0.0};
  for (unsigned k = 0; k < m->dimension; k++)
    corner[k] = m->grid.origin[k] + m->cell * (double)block->at[k] * side;
  for (int k = 0; k < nz && line != NULL; k++) {
    x[2] = corner[2] + m->cell * k;
    for (int j = 0; j < ny; j++) {
      x[1] = corner[1] + m->cell * j;
      for (int i = 0; i < nx; i++, line += NODE_SIZE) {
        x[0] = corner[0] + m->cell * i;
        if (line[NODE_MASS] > 0.0)
          update_node(m, line, x, step, &sums);
        else
          memset(line, 0, NODE_SIZE * sizeof *line);
      }
    }
  }
  memcpy(m->node_sum + b * TOTAL_SUMS, sums.sum, sizeof sums.sum);
  m->node_speed[b] = sums.speed;
}

gamut_status step_update_grid(void *self, const struct gamut_chunk *chunk)
{
  (void)chunk;
  struct model *m = self;
  const double step = gamut_time_step(m->run);
  if (!m->collected && step_collect(m) != GAMUT_OK)
    return GAMUT_INTERNAL;
  if ((m->planes.any_moves || m->grid.opened) && planes_find(m) != GAMUT_OK)
    return GAMUT_INTERNAL;
  m->collected = false;
  planes_before_update(m);
#pragma omp parallel for schedule(dynamic, 8)                                                      \
    num_threads(m->threads) if (m->grid.blocks >= FEW_BLOCKS)
  for (size_t b = 0; b < m->grid.blocks; b++)
    update_block(m, b, step);
  gamut_sum(m->run, m->node_sum, m->grid.blocks, TOTAL_SUMS, m->nodes.sum);
  m->nodes.speed = fmax(0.0, gamut_most(m->run, m->node_speed, m->grid.blocks));
  for (size_t b = 0; b < m->grid.blocks; b++)
    *m->counts.node_lines += m->grid.block[b].line != NULL ? m->grid.block_nodes : 0;
  if (planes_after_update(m, step) != GAMUT_OK)
    return GAMUT_INTERNAL;
  const gamut_status status = m->rule == RULE_XPIC ? step_filter(m) : GAMUT_OK;
  planes_report(m, step);
  return status;
}

static void project_block(struct model *m, size_t b, bool carry)
{
  double sum[BLOCK_NODES_MAX * NODE_SIZE] __attribute__((aligned(64)));
  double *lines = m->grid.block[b].line;
  if (lines == NULL)
    return;
  grid_collect(&m->grid, &m->grid.block[b], sum);
  for (size_t i = 0; i < m->grid.block_nodes; i++) {
    double *line = lines + i * NODE_SIZE;
    const double *from = sum + i * NODE_SIZE;
    for (int k = 0; k < 3; k++) {
      if (carry)
        line[NODE_CHANGE + k] = line[NODE_VELOCITY + k];
      line[NODE_VELOCITY + k] = from[NODE_MOMENTUM + k];
    }
    line[NODE_FRACTION] = from[NODE_MASS];
  }
}

static void divide_block(struct model *m, size_t b)
{
  double *lines = m->grid.block[b].line;
  for (size_t i = 0; i < m->grid.block_nodes && lines != NULL; i++) {
    double *line = lines + i * NODE_SIZE;
    const double over = line[NODE_FRACTION] > 0.0 ? 1.0 / line[NODE_FRACTION] : 0.0;
    for (int k = 0; k < 3; k++)
      line[NODE_VELOCITY + k] *= over;
  }
}

void step_settle(struct model *m)
{
  planes_before_second(m);
#pragma omp parallel for schedule(dynamic, 8)                                                      \
    num_threads(m->threads) if (m->grid.blocks >= FEW_BLOCKS)
  for (size_t b = 0; b < m->grid.blocks; b++)
    divide_block(m, b);
  planes_after_second(m);
}

gamut_status step_project(struct model *m, bool carry)
{
  if (grid_open_reached(&m->grid) != GAMUT_OK)
    return GAMUT_INTERNAL;
#pragma omp parallel for schedule(dynamic, 8)                                                      \
    num_threads(m->threads) if (m->grid.blocks >= FEW_BLOCKS)
  for (size_t b = 0; b < m->grid.blocks; b++)
    project_block(m, b, carry);
  return grid_forget_boxes(&m->grid);
}

gamut_status step_update_again(void *self, const struct gamut_chunk *chunk)
{
  (void)chunk;
  struct model *m = self;
  if (m->removal.lost_points.count > 0)
    return lost_point_fail(m);
  if (step_project(m, true) != GAMUT_OK)
    return GAMUT_INTERNAL;
  step_settle(m);
  return GAMUT_OK;
}
