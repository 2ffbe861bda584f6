/* The points of a run that goes on from a checkpoint. */
#include <stdlib.h>

#include "run/restart.h"

/* A field that is kept now but was not then is one that a step writes before anybody reads it; but
 * a state would be lost. */
static gamut_status get_component(const struct reading_back *r, const struct point_set *set,
                                  const struct packed *packed, const struct field *field,
                                  unsigned component, double *row)
{
  char path[RESTART_PATH], name[RESTART_PATH];
  restart_path(path, "bodies", set->open.body, restart_component(name, field, component));
  if (checkpoint_has(r->file, path)) {
    gamut_status status = resume_fill(r, path, CHECKPOINT_REAL, row, packed->rows);
    if (status == GAMUT_OK)
      unpack(packed, row, set_stored(set, field->handle, component));
    return status;
  }
  if (!field->history)
    return GAMUT_OK;
  return trace_fail_at(
      r->run->trace, GAMUT_SCENE, NULL, "outputs", "leave it out, or --force to run the scene anew",
      "'%s' is asked for now; it was not worked out in the run in '%s'", field->name, r->folder);
}

/* Padding has no id. */
static void unpack_ids(const struct packed *packed, const int64_t *row, int64_t *id)
{
  unpack(packed, row, id);
  for (size_t b = 0; b < packed->blocks; b++)
    for (size_t i = packed->first[b] + (size_t)packed->count[b]; i < packed->first[b + 1]; i++)
      id[i] = -1;
}

static gamut_status shape_set(const struct reading_back *r, struct point_set *set,
                              struct packed *packed)
{
  gamut_status status;
  char path[RESTART_PATH];
  const char *body = set->open.body;
  int64_t points, *id = NULL;
  void *row = NULL, *count = NULL;
  size_t rows, blocks;
  TRY(resume_fill(r, restart_path(path, "bodies", body, "points"), CHECKPOINT_WHOLE, &points, 1));
  TRY(resume_get(r, restart_path(path, "bodies", body, "id"), CHECKPOINT_WHOLE, &row, &rows));
  TRY(resume_get(r, restart_path(path, "bodies", body, "block_points"), CHECKPOINT_WHOLE, &count,
                 &blocks));
  TRY(packed_from(count, blocks, rows, packed, r->run->trace));
  id = malloc((packed->first[packed->blocks] + 1) * sizeof *id);
  if (!id) {
    status = trace_fail(r->run->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  unpack_ids(packed, row, id);
  TRY(set_reshape(set, (size_t)points, id, packed->first[packed->blocks], packed->first, blocks,
                  r->run->trace));
done:
  free(id);
  free(row);
  free(count);
  return status;
}

/* As the sort leaves it, padding has no mass. */
static void clear_padding(struct gamut_run *run, const struct point_set *set)
{
  const struct field *mass = fields_find(run->fields, "mass");
  double *array = mass && mass->stored ? set_stored(set, mass->handle, 0) : NULL;
  for (size_t i = 0; array && i < set->open.slots; i++)
    if (set->open.id[i] < 0)
      array[i] = 0.0;
}

gamut_status resume_set(const struct reading_back *r, struct point_set *set)
{
  gamut_status status;
  struct packed packed = {0};
  double *row = NULL;
  TRY(shape_set(r, set, &packed));
  row = malloc((packed.rows + 1) * sizeof *row);
  if (!row) {
    status = trace_fail(r->run->trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  for (size_t f = 0; f < fields_count(r->run->fields); f++) {
    const struct field *field = fields_at(r->run->fields, f);
    for (unsigned k = 0; k < field->handle.components; k++)
      if (set_stored(set, field->handle, k))
        TRY(get_component(r, set, &packed, field, k, row));
  }
  clear_padding(r->run, set);
done:
  free(row);
  packed_free(&packed);
  return status;
}
