#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "random/correlation.h"
#include "scene/scene_private.h"

/* All random values of a scene, then put in the order of the file. */
struct collection {
  struct random_parameter *item;
  size_t count, room;
};

static void collect(struct collection *all, struct random_parameter found)
{
  if (all->count == all->room) {
    size_t room = 2 * all->room + 16;
    struct random_parameter *grown = scene_take(room, sizeof *grown);
    if (all->count)
      memcpy(grown, all->item, all->count * sizeof *grown);
    free(all->item);
    all->item = grown;
    all->room = room;
  }
  all->item[all->count++] = found;
}

static void collect_values(struct collection *all, struct values *values, struct values *owner,
                           const struct descriptor *descriptor)
{
  for (size_t i = 0; values && i < values->count; i++) {
    struct value *value = &values->value[i];
    if (value->random && !value->model) /* a field is drawn by its own plugin */
      collect(all, (struct random_parameter){.parameter = value->parameter,
                                             .node = value->node,
                                             .distribution = value->random,
                                             .number = &value->real,
                                             .values = owner,
                                             .descriptor = descriptor});
    collect_values(all, value->group, owner, descriptor);
  }
}

static void collect_instance(struct collection *all, const struct instance *instance)
{
  collect_values(all, instance->values, instance->values, instance->descriptor);
}

static void collect_scene(struct collection *all, struct scene *scene)
{
  collect_instance(all, &scene->solver);
  for (size_t i = 0; i < scene->materials; i++) {
    struct material *material = &scene->material[i];
    if (material->density_random)
      collect(all, (struct random_parameter){.parameter = material_density(),
                                             .node = tree_get(material->node, "density"),
                                             .distribution = material->density_random,
                                             .number = &material->density});
    collect_instance(all, &material->eos);
    collect_instance(all, &material->strength);
    collect_instance(all, &material->elasticity);
    collect_values(all, material->extra, material->extra, NULL);
  }
  for (size_t i = 0; i < scene->bodies; i++)
    collect_values(all, scene->body[i].solver_values, scene->body[i].solver_values, NULL);
  for (size_t i = 0; i < scene->effects; i++)
    collect_instance(all, &scene->effect[i].instance);
  for (size_t i = 0; i < scene->quantities; i++)
    collect_values(all, scene->quantity[i].arguments, scene->quantity[i].arguments, NULL);
}

static int by_node(const void *one, const void *other)
{
  const uintptr_t a = (uintptr_t)((const struct random_parameter *)one)->node;
  const uintptr_t b = (uintptr_t)((const struct random_parameter *)other)->node;
  return (a > b) - (a < b);
}

/* `all` is sorted by node; a node stands for one parameter. */
static void put_in_order(struct scene_reader *reader, const struct collection *all,
                         const struct tree *node)
{
  struct scene *scene = reader->scene;
  char path[PATH_SIZE];
  const struct random_parameter wanted = {.node = node};
  const struct random_parameter *found =
      bsearch(&wanted, all->item, all->count, sizeof *all->item, by_node);
  if (found) {
    struct random_parameter *next = &scene->random_parameter[scene->random_parameters++];
    *next = *found;
    next->path = scene_text(reader, "%s", tree_path(node, path, sizeof path));
  }
  for (size_t i = 0; i < node->children; i++)
    put_in_order(reader, all, node->child[i]);
}

static void random_parameters_read(struct scene_reader *reader)
{
  struct scene *scene = reader->scene;
  struct collection all = {0};
  collect_scene(&all, scene);
  scene->random_parameter = scene_keep(reader, all.count + 1, sizeof *scene->random_parameter);
  if (all.count > 0) {
    qsort(all.item, all.count, sizeof *all.item, by_node);
    put_in_order(reader, &all, scene->tree);
  }
  free(all.item);
}

static struct scene_reader judge(struct trace *trace, const struct random_parameter *random)
{
  return (struct scene_reader){.trace = trace, .here = random->node};
}

gamut_status scene_draw(struct scene *scene, const double *drawn, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct random_parameter *random = scene->random_parameter;
  for (size_t i = 0; i < scene->random_parameters; i++) {
    struct scene_reader reader = judge(trace, &random[i]);
    *random[i].number = drawn[i];
    range_check(&reader, random[i].parameter, random[i].node, drawn[i]);
    status = status ? status : reader.first;
  }
  /* What follows from them and what must hold between them, once a plugin. */
  for (size_t i = 0; status == GAMUT_OK && i < scene->random_parameters; i++) {
    char what[160];
    struct scene_reader reader = judge(trace, &random[i]);
    const struct descriptor *descriptor = random[i].descriptor;
    if (!descriptor || (i > 0 && random[i - 1].values == random[i].values))
      continue;
    snprintf(what, sizeof what, "%s '%s'", kind_name(descriptor->kind), descriptor->name);
    values_check(&reader, random[i].values, descriptor, what);
    status = reader.first;
  }
  return status;
}

/* The first of the parameters from i on, all of one plugin, that is to be what its plugin takes. */
static const struct random_parameter *conforming(const struct scene *scene, size_t i)
{
  const struct random_parameter *random = scene->random_parameter;
  for (size_t k = i; k < scene->random_parameters && random[k].values == random[i].values; k++)
    if (random[k].distribution->conforms)
      return &random[k];
  return NULL;
}

const struct random_parameter *scene_conflict(struct scene *scene, const double *drawn,
                                              char *conflict, size_t size)
{
  const struct random_parameter *random = scene->random_parameter, *found = NULL;
  for (size_t i = 0; i < scene->random_parameters; i++)
    *random[i].number = drawn[i];
  for (size_t i = 0; i < scene->random_parameters && !found; i++) {
    const struct random_parameter *mends = conforming(scene, i);
    if (mends && random[i].descriptor && (i == 0 || random[i - 1].values != random[i].values) &&
        values_conflict(random[i].values, random[i].descriptor, conflict, size))
      found = mends;
  }
  return found;
}

static bool random_named(struct scene_reader *reader, const struct tree *node, size_t *index)
{
  const struct scene *scene = reader->scene;
  char expected[WORDS_SIZE];
  const char *path = text_read(reader, node, "correlation");
  if (!path)
    return false;
  const char **name = scene_take(scene->random_parameters, sizeof *name);
  bool found = false;
  for (size_t i = 0; i < scene->random_parameters; i++) {
    name[i] = scene->random_parameter[i].path;
    if (strcmp(name[i], path) != 0)
      continue;
    *index = i;
    found = true;
  }
  if (!found)
    error_at_value(
        reader, node,
        scene->random_parameters && !tree_at(scene->tree, path)
            ? suggest(reader, path, name, scene->random_parameters, expected, sizeof expected)
            : "give it a spread, such as {mean: 90 MPa, cv: 0.1}",
        "'%.200s' is no random parameter of this scene", path);
  free(name);
  return found;
}

static bool row_read(struct scene_reader *reader, const struct tree *row)
{
  struct scene *scene = reader->scene;
  size_t n = scene->random_parameters, i, k;
  double number;
  if (row->kind != TREE_SEQUENCE || row->children != 3) {
    error_at_value(reader, row, "[path, path, number]", "this is no row of the correlation");
    return false;
  }
  if (!random_named(reader, row->child[0], &i) || !random_named(reader, row->child[1], &k) ||
      !amount_read(reader, row->child[2], "correlation", "1", &number))
    return false;
  if (i == k) {
    error_at_value(reader, row->child[1], "two different parameters",
                   "a parameter is always fully correlated with itself");
    return false;
  }
  if (!(fabs(number) <= 1)) {
    error_at_value(reader, row->child[2], "from -1 to 1",
                   "%.6g is no correlation of two parameters", number);
    return false;
  }
  if (scene->correlation[i * n + k] != 0) {
    error_at_value(reader, row, "one row for each pair", "this pair was given before");
    return false;
  }
  scene->correlation[i * n + k] = scene->correlation[k * n + i] = number;
  return true;
}

static void correlation_read(struct scene_reader *reader, const struct tree *node)
{
  struct scene *scene = reader->scene;
  size_t n = scene->random_parameters;
  bool fine = true;
  if (!node)
    return;
  if (node->kind != TREE_SEQUENCE) {
    error_at_value(reader, node, "[[path, path, number], ...]", "'correlation' is no list of rows");
    return;
  }
  if (node->children == 0)
    return;
  scene->correlation = scene_keep(reader, n * n + 1, sizeof *scene->correlation);
  for (size_t i = 0; i < node->children; i++)
    fine = row_read(reader, node->child[i]) && fine;
  for (size_t i = 0; i < n; i++)
    scene->correlation[i * n + i] = 1;
  if (!fine)
    return;
  double least = correlation_smallest(scene->correlation, n);
  if (!(least >= -CORRELATION_LEAST))
    error_at_value(reader, node, "make some of them smaller",
                   "no random parameters have these correlations together: the smallest eigenvalue "
                   "of their matrix is %.3g, below 0",
                   least);
}

static void seed_read(struct scene_reader *reader, const struct tree *node)
{
  reader->scene->seed = 1;
  if (!node)
    return;
  const char *text = node->kind == TREE_SCALAR && !node->quoted ? node->text : "";
  size_t digits = strspn(text, "0123456789");
  static const char range[] = "a whole number from 0 to 9223372036854775807";
  if (digits == 0 || text[digits]) {
    error_at_value(reader, node, range, "'seed' is no whole number");
    return;
  }
  errno = 0;
  const unsigned long long seed = strtoull(text, NULL, 10);
  if (errno == ERANGE || seed > INT64_MAX) /* whole numbers of JSON, in the summary, end there */
    error_at_value(reader, node, range, "'seed' is too large: %.60s", text);
  else
    reader->scene->seed = seed;
}

/* Room for sound that is faster than at the means by up to a quarter. */
#define STEP_MARGIN 0.2

static void failures_read(struct scene_reader *reader, const struct tree *node)
{
  reader->scene->failures = 0.1;
  if (!node || !amount_read(reader, node, "failures", "1", &reader->scene->failures))
    return;
  if (!(reader->scene->failures >= 0 && reader->scene->failures < 1))
    error_at_value(reader, node, "at least 0 and less than 1",
                   "'failures' is the share of runs that may fail");
}

/* In place of a value: off. */
static bool says_off(const struct tree *node)
{
  return node->kind == TREE_SCALAR && strcmp(node->text, "off") == 0;
}

/* `off`: each run takes its own steps. */
static void step_margin_read(struct scene_reader *reader, const struct tree *node)
{
  double *margin = &reader->scene->step_margin;
  *margin = STEP_MARGIN;
  if (node && says_off(node)) {
    *margin = NAN;
    return;
  }
  if (!node || !amount_read(reader, node, "step_margin", "1", margin))
    return;
  if (!(*margin >= 0 && *margin < 1))
    error_at_value(reader, node, "at least 0 and less than 1, or off",
                   "'step_margin' is the share by which the steps of all runs are shorter than "
                   "those at the means");
}

void uncertainty_read(struct scene_reader *reader, const struct tree *root)
{
  static const char *const known[] = {"estimator", "correlation", "seed", "failures",
                                      "step_margin"};
  const struct tree *node = tree_get(root, "uncertainty"), *estimator;
  random_parameters_read(reader);
  if (node && (!expect_mapping(reader, node, "'uncertainty'")))
    node = NULL;
  if (node)
    expect_keys(reader, node, known, ARRAY_SIZE(known), "'uncertainty'");
  seed_read(reader, tree_get(node, "seed"));
  failures_read(reader, tree_get(node, "failures"));
  step_margin_read(reader, tree_get(node, "step_margin"));
  correlation_read(reader, tree_get(node, "correlation"));
  estimator = tree_get(node, "estimator");
  if (estimator && !says_off(estimator))
    instance_read(reader, GAMUT_KIND_ESTIMATOR, "estimator", estimator, NULL, 0,
                  &reader->scene->estimator);
}
