/* Values that fields have though no task writes them. */
#include <string.h>

#include "run/run_private.h"

/* Fields that have values though no task writes them: a body's temperature, what the solver says
 * that it puts out, and parameters with a random field. */
void given_mark(struct gamut_run *run)
{
  const struct descriptor *solver = run->scene->solver.descriptor;
  for (size_t f = 0; f < fields_count(run->fields); f++) {
    struct field *field = fields_at(run->fields, f);
    bool own = field->drawn;
    for (size_t i = 0; i < solver->outputs; i++)
      own = own || strcmp(solver->output[i].name, field->name) == 0;
    bool state = false;
    for (size_t i = 0; i < solver->states; i++)
      state = state || strcmp(solver->state[i].name, field->name) == 0;
    field->given = own                                       ? GIVEN_BY_SOLVER
                   : state                                   ? GIVEN_AT_START
                   : strcmp(field->name, "temperature") == 0 ? GIVEN_BY_BODY
                                                             : GIVEN_BY_NOBODY;
  }
}

/* A solver without materials starts none, and their temperature is the body's all the same. */
void given_fill(struct gamut_run *run)
{
  const struct field *field = fields_find(run->fields, "temperature");
  for (size_t s = 0; field && s < run->scene->bodies; s++) {
    double *array = set_stored(run->set[s], field->handle, 0);
    for (size_t i = 0; array && i < run->set[s]->capacity; i++)
      array[i] = run->scene->body[s].temperature;
  }
}
