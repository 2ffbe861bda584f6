#include <stdlib.h>

#include "registry/guard.h"
#include "schedule/schedule_private.h"

#ifdef _OPENMP
#include <omp.h>
#endif

static gamut_status list_pieces(struct schedule *schedule, const struct step_context *context)
{
  size_t pieces = 0;
  for (size_t s = 0; s < context->sets; s++)
    pieces += context->set[s]->open.blocks;
  if (pieces > schedule->piece_capacity) {
    struct piece *grown = realloc(schedule->piece, 2 * pieces * sizeof *grown);
    if (!grown)
      return GAMUT_INTERNAL;
    schedule->piece = grown;
    schedule->piece_capacity = 2 * pieces;
  }
  schedule->pieces = 0;
  for (size_t s = 0; s < context->sets; s++)
    for (size_t b = 0; b < context->set[s]->open.blocks; b++)
      schedule->piece[schedule->pieces++] = (struct piece){s, b};
  return GAMUT_OK;
}

static gamut_status run_task(const struct task *task, const struct gamut_chunk *chunk)
{
  if (!task->plugin)
    return task->run(task->self, chunk);
  const char *before = chunk ? guard_enter(task->plugin) : guard_enter_long(task->plugin);
  gamut_status status = task->run(task->self, chunk);
  guard_leave(before);
  return status;
}

/* What the task is the first to share in this step. */
static void start_shared(const struct task *task, const struct gamut_chunk *chunk, bool early)
{
  for (size_t c = 0; c < task->clears; c++) {
    const struct clear *clear = &task->clear[c];
    const bool due = clear->early == early && clear->on_set[chunk->set->index];
    double *to = due ? chunk->end[clear->component] : NULL;
    for (size_t i = 0; to && i < chunk->count; i++)
      to[i] = clear->start;
  }
}

static gamut_status run_tasks(struct task *const *task, size_t tasks,
                              const struct gamut_chunk *chunk)
{
  for (size_t i = 0; i < tasks; i++) {
    if (!task_on_set(task[i], chunk->set->index))
      continue;
    start_shared(task[i], chunk, false);
    gamut_status status = run_task(task[i], chunk);
    if (status != GAMUT_OK)
      return status;
  }
  return GAMUT_OK;
}

static gamut_status sweep_block(const struct sweep *sweep, const struct step_context *context,
                                struct piece piece, size_t serial, int thread, size_t components)
{
  gamut_status status = GAMUT_OK;
  struct point_set *set = context->set[piece.set];
  struct lane_scratch *scratch = context->scratch[thread];
  const unsigned char *source = sweep->source + piece.set * components;
  size_t first = set->open.first[piece.block], end = set->open.first[piece.block + 1];
  struct gamut_chunk chunk = {.set = &set->open,
                              .block = piece.block,
                              .serial = serial,
                              .slot = first,
                              .thread = thread};
  TRY(run_tasks(sweep->open, sweep->opens, &chunk));
  for (size_t slot = first; slot < end; slot += context->chunk) {
    size_t count = end - slot < context->chunk ? end - slot : context->chunk;
    scratch_bind(scratch, set, source, context->uniform, slot, count, &chunk);
    for (size_t i = 0; i < sweep->chunks; i++)
      start_shared(sweep->chunk[i], &chunk, true);
    TRY(run_tasks(sweep->chunk, sweep->chunks, &chunk));
    scratch_commit(scratch, source, &chunk);
  }
  chunk.slot = first;
  chunk.count = 0;
  TRY(run_tasks(sweep->close, sweep->closes, &chunk));
done:
  return status;
}

static gamut_status run_sweep(struct schedule *schedule, const struct sweep *sweep,
                              const struct step_context *context)
{
  size_t components = context->sets ? fields_components(context->set[0]->fields) : 0;
  size_t failed = SIZE_MAX;
  gamut_status failure = GAMUT_OK;
#pragma omp parallel num_threads(context->threads)
  {
#ifdef _OPENMP
    int thread = omp_get_thread_num();
#else
    int thread = 0;
#endif
#pragma omp for schedule(dynamic, 1)
    for (size_t p = 0; p < schedule->pieces; p++) {
      gamut_status status = sweep_block(sweep, context, schedule->piece[p], p, thread, components);
      if (status == GAMUT_OK)
        continue;
#pragma omp critical(gamut_failed_block)
      if (p < failed) {
        failed = p;
        failure = status;
      }
    }
  }
  return failure;
}

gamut_status schedule_step(struct schedule *schedule, const struct step_context *context)
{
  gamut_status status = GAMUT_OK;
  TRY(list_pieces(schedule, context));
  for (size_t s = 0; s < schedule->sweeps; s++) {
    const struct sweep *sweep = &schedule->sweep[s];
    if (sweep->once)
      TRY(run_task(sweep->chunk[0], NULL));
    else
      TRY(run_sweep(schedule, sweep, context));
  }
done:
  return status;
}
