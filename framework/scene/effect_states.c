/* The fields of effects' states. A state that the catalogue does not know belongs to its effect
 * alone. Its field has the state's name, unless somebody else keeps a state of that name on the
 * same body: then the field of each such effect is called EFFECT.STATE. */
#include <string.h>

#include "catalogue/catalogue.h"
#include "scene/scene_private.h"

static bool keeps(const struct descriptor *descriptor, const char *state)
{
  for (size_t i = 0; descriptor && i < descriptor->states; i++)
    if (strcmp(descriptor->state[i].name, state) == 0)
      return true;
  return false;
}

static bool is_on(const struct effect *effect)
{
  return effect->enabled != EFFECT_OFF && effect->instance.descriptor;
}

/* Whether two effects with that state work on one body. */
static bool effects_meet(const struct scene *scene, const char *state)
{
  for (size_t b = 0; b < scene->bodies; b++) {
    size_t here = 0;
    for (size_t i = 0; i < scene->effects; i++)
      here += is_on(&scene->effect[i]) && scene->effect[i].on_body[b] &&
              keeps(scene->effect[i].instance.descriptor, state);
    if (here > 1)
      return true;
  }
  return false;
}

static bool kept_by_others(const struct scene *scene, const char *state)
{
  bool kept = keeps(scene->solver.descriptor, state);
  for (size_t i = 0; i < scene->materials && !kept; i++)
    kept = keeps(scene->material[i].elasticity.descriptor, state) ||
           keeps(scene->material[i].strength.descriptor, state) ||
           keeps(scene->material[i].eos.descriptor, state);
  return kept;
}

/* A reader of a state of that name could not say whose. */
static void check_input(struct scene_reader *reader, const struct instance *instance)
{
  const struct descriptor *d = instance->descriptor;
  char expected[WORDS_SIZE];
  for (size_t i = 0; d && i < d->inputs; i++) {
    const char *whose = effect_states_words(reader, d->input[i].name, expected, sizeof expected);
    if (whose)
      error_at_key(reader, instance->node, "one of them, or `bodies:` that they do not share",
                   "%s reads '%s', which several effects of this scene keep: %s", d->id,
                   d->input[i].name, whose);
  }
}

const char *effect_states_words(const struct scene_reader *reader, const char *name, char *buffer,
                                size_t size)
{
  const struct scene *scene = reader->scene;
  const char *own[EFFECTS_MAX];
  size_t count = 0;
  for (size_t i = 0; i < scene->effects; i++) {
    const struct instance *one = &scene->effect[i].instance;
    for (size_t s = 0; one->state_field && s < one->descriptor->states; s++)
      if (strcmp(one->descriptor->state[s].name, name) == 0 &&
          strcmp(one->state_field[s], name) != 0)
        own[count++] = one->state_field[s];
  }
  return count > 0 ? list_text(own, count, buffer, size) : NULL;
}

const char *effect_states_expected(const struct scene_reader *reader, const char *name,
                                   char *buffer, size_t size)
{
  char whose[WORDS_SIZE];
  if (!effect_states_words(reader, name, whose, sizeof whose))
    return NULL;
  snprintf(buffer, size, "several effects keep one on the same body: %.700s", whose);
  return buffer;
}

const char *instance_state_field(const struct instance *instance, size_t state)
{
  return instance->state_field ? instance->state_field[state]
                               : instance->descriptor->state[state].name;
}

const char *instance_field(const struct instance *instance, const char *name)
{
  for (size_t s = 0; instance->state_field && s < instance->descriptor->states; s++)
    if (strcmp(instance->descriptor->state[s].name, name) == 0)
      return instance->state_field[s];
  return name;
}

void effect_states_name(struct scene_reader *reader)
{
  struct scene *scene = reader->scene;
  for (size_t i = 0; i < scene->effects; i++) {
    struct instance *one = &scene->effect[i].instance;
    const struct descriptor *d = one->descriptor;
    if (!is_on(&scene->effect[i]))
      continue;
    one->state_field = scene_keep(reader, d->states + 1, sizeof *one->state_field);
    for (size_t s = 0; s < d->states; s++) {
      const char *state = d->state[s].name;
      const bool own =
          !catalogue_find(state) && (effects_meet(scene, state) || kept_by_others(scene, state));
      one->state_field[s] = own ? scene_text(reader, "%s.%s", one->name, state) : state;
    }
  }
  for (size_t i = 0; i < scene->effects; i++)
    check_input(reader, &scene->effect[i].instance);
  for (size_t i = 0; i < scene->materials; i++) {
    check_input(reader, &scene->material[i].eos);
    check_input(reader, &scene->material[i].strength);
    check_input(reader, &scene->material[i].elasticity);
  }
}
