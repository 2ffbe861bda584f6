/* `gamut show --json`: the same for programs. Numbers are SI; keys are those of the YAML. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "descriptor/descriptor_private.h"

static void set_text(json_t *object, const char *key, const char *text)
{
  if (text)
    json_object_set_new(object, key, json_string(text));
}

static json_t *texts(const char *const *text, size_t count)
{
  json_t *array = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(array, json_string(text[i]));
  return array;
}

static json_t *value_of(const struct tree *tree)
{
  if (tree->kind == TREE_SCALAR)
    return json_string(tree->text);
  json_t *value = tree->kind == TREE_MAPPING ? json_object() : json_array();
  for (size_t i = 0; i < tree->children; i++)
    if (tree->kind == TREE_MAPPING)
      json_object_set_new(value, tree->child[i]->key, value_of(tree->child[i]));
    else
      json_array_append_new(value, value_of(tree->child[i]));
  return value;
}

/* An end at infinity is null: JSON has no infinity. */
static void set_range(json_t *object, const char *key, const struct range *range)
{
  if (!range->stated)
    return;
  json_t *value = json_object();
  json_object_set_new(value, "lower",
                      isfinite(range->lower) ? json_real(range->lower) : json_null());
  json_object_set_new(value, "upper",
                      isfinite(range->upper) ? json_real(range->upper) : json_null());
  json_object_set_new(value, "lower_open", json_boolean(range->lower_open));
  json_object_set_new(value, "upper_open", json_boolean(range->upper_open));
  json_object_set_new(object, key, value);
}

/* Lists of the members of each alternative. */
static void set_alternatives(json_t *object, const struct alternatives *one_of,
                             const struct parameter *member, size_t count)
{
  if (!one_of->sets)
    return;
  json_t *list = json_array();
  for (size_t set = 1; set <= one_of->sets; set++) {
    json_t *names = json_array();
    for (size_t i = 0; i < count; i++)
      if (member[i].set == set)
        json_array_append_new(names, json_string(member[i].name));
    json_array_append_new(list, names);
  }
  json_object_set_new(object, "one_of", list);
}

static json_t *parameters(const struct parameter *, size_t count);

static json_t *declared(const struct parameter *p)
{
  json_t *value = json_object();
  set_text(value, "type", value_type_name(p->type));
  set_text(value, "symbol", p->symbol);
  set_text(value, "unit", p->unit_of ? NULL : p->unit);
  set_text(value, "unit_of", p->unit_of);
  set_text(value, "doc", p->doc);
  set_text(value, "source", p->source);
  if (p->standard)
    json_object_set_new(value, "default", value_of(p->standard));
  json_object_set_new(value, "optional", json_boolean(p->optional));
  json_object_set_new(value, "random", json_boolean(p->random));
  set_range(value, "fit", &p->fit);
  set_range(value, "physical", &p->physical);
  set_range(value, "usual", &p->usual);
  if (p->prepared)
    json_object_set_new(value, "prepared", json_true());
  if (p->type == VALUE_VECTOR || (p->type == VALUE_TABLE && p->size_min > 1) || p->of)
    json_object_set_new(value, "size", json_pack("[i, i]", (int)p->size_min, (int)p->size_max));
  if (p->type == VALUE_CHOICE)
    json_object_set_new(value, "choices", texts(p->choice, p->choices));
  if (p->type == VALUE_EXPRESSION)
    json_object_set_new(value, "variables", texts(p->choice, p->choices));
  if (p->type == VALUE_TABLE) {
    json_t *columns = json_object();
    for (size_t k = 0; k < p->choices; k++)
      set_text(columns, p->choice[k], p->choice_unit[k]);
    json_object_set_new(value, "columns", columns);
  }
  if (p->type == VALUE_PLUGIN)
    set_text(value, "kind", kind_name(p->kind));
  if (p->members)
    json_object_set_new(value, p->type == VALUE_ONE_OF ? "forms" : "members",
                        parameters(p->member, p->members));
  set_alternatives(value, &p->one_of, p->member, p->members);
  if (p->of)
    json_object_set_new(value, "of", declared(p->of));
  set_text(value, "of", p->entry_of);
  return value;
}

static json_t *parameters(const struct parameter *parameter, size_t count)
{
  json_t *list = json_object();
  for (size_t i = 0; i < count; i++)
    json_object_set_new(list, parameter[i].name, declared(&parameter[i]));
  return list;
}

static json_t *uses(const struct field_use *use, size_t count)
{
  json_t *list = json_array();
  for (size_t i = 0; i < count; i++) {
    json_t *value = json_object();
    set_text(value, "name", use[i].name);
    json_object_set_new(value, "optional", json_boolean(use[i].optional));
    if (use[i].optional && use[i].components)
      json_object_set_new(value, "absent",
                          isfinite(use[i].absent) ? json_real(use[i].absent) : json_string("inf"));
    set_text(value, "unit", use[i].unit);
    if (use[i].components)
      json_object_set_new(value, "components", json_integer(use[i].components));
    json_array_append_new(list, value);
  }
  return list;
}

static json_t *states(const struct descriptor *d)
{
  json_t *list = json_object();
  for (size_t i = 0; i < d->states; i++) {
    json_t *value = json_object();
    set_text(value, "unit", d->state[i].unit);
    set_text(value, "doc", d->state[i].doc);
    json_object_set_new(value, "components", json_integer(d->state[i].components));
    json_object_set_new(value, "initial", json_real(d->state[i].initial));
    json_object_set_new(list, d->state[i].name, value);
  }
  return list;
}

static json_t *given_sets(const struct descriptor *d)
{
  json_t *list = json_array();
  for (size_t i = 0; i < d->givens; i++) {
    json_t *value = json_object(), *then = json_object();
    json_object_set_new(value, "set", texts(d->given[i].name, d->given[i].names));
    for (size_t k = 0; k < d->given[i].derivations; k++)
      set_text(then, d->given[i].derived[k], d->given[i].formula[k]);
    json_object_set_new(value, "then", then);
    json_array_append_new(list, value);
  }
  return list;
}

static json_t *variants(const struct descriptor *d)
{
  json_t *list = json_array();
  for (size_t i = 0; i < d->variants; i++) {
    json_t *value = json_object();
    set_text(value, "when", d->variant[i].when);
    set_text(value, "kernel", d->variant[i].kernel);
    json_object_set_new(value, "drops", texts(d->variant[i].drop, d->variant[i].drops));
    json_array_append_new(list, value);
  }
  return list;
}

static json_t *messages(const struct descriptor *d)
{
  static const char *const severity[] = {"fine", "note", "warn", "stop"};
  json_t *list = json_object();
  for (size_t i = 0; i < d->messages; i++) {
    json_t *value = json_object();
    set_text(value, "severity", severity[d->message[i].severity]);
    set_text(value, "text", d->message[i].text);
    json_object_set_new(list, d->message[i].name, value);
  }
  return list;
}

static json_t *tasks(const struct descriptor *d)
{
  json_t *list = json_array();
  for (size_t i = 0; i < d->tasks; i++) {
    json_t *value = json_object();
    set_text(value, "kernel", d->task[i].kernel);
    set_text(value, "phase", d->task[i].phase);
    json_object_set_new(value, "reads", texts(d->task[i].read, d->task[i].reads));
    json_object_set_new(value, "writes", texts(d->task[i].write, d->task[i].writes));
    json_object_set_new(value, "adds", texts(d->task[i].add, d->task[i].adds));
    json_object_set_new(value, "scales", texts(d->task[i].scale, d->task[i].scales));
    json_object_set_new(value, "lowers", texts(d->task[i].lower, d->task[i].lowers));
    json_array_append_new(list, value);
  }
  return list;
}

static json_t *measures(const struct descriptor *d)
{
  static const char *const place[] = {"point", "body", "run"};
  json_t *list = json_object();
  for (size_t i = 0; i < d->measures; i++) {
    json_t *value = json_object();
    set_text(value, "unit", d->measure[i].unit_of ? NULL : d->measure[i].unit);
    set_text(value, "unit_of", d->measure[i].unit_of);
    set_text(value, "at", place[d->measure[i].at]);
    set_text(value, "formula", d->measure[i].formula);
    set_text(value, "doc", d->measure[i].doc);
    if (d->measure[i].arguments)
      json_object_set_new(value, "arguments",
                          parameters(d->measure[i].argument, d->measure[i].arguments));
    json_object_set_new(list, d->measure[i].name, value);
  }
  return list;
}

static void set_interface(json_t *object, const struct descriptor *d)
{
  json_object_set_new(object, "inputs", uses(d->input, d->inputs));
  json_object_set_new(object, "outputs", uses(d->output, d->outputs));
  json_object_set_new(object, "state", states(d));
  json_object_set_new(object, "laws", uses(d->law, d->laws));
  json_object_set_new(object, "scratch", json_integer((json_int_t)d->scratch));
  json_object_set_new(object, "prepare", json_boolean(d->prepare));
  json_object_set_new(object, "inverse", json_boolean(d->inverse));
  if (d->derivatives) {
    json_t *value = json_object();
    set_text(value, "of", d->derivative_of);
    json_object_set_new(value, "by", texts(d->derivative_by, d->derivatives));
    json_object_set_new(object, "derivatives", value);
  }
}

void descriptor_show_json(const struct descriptor *d, FILE *file)
{
  json_t *object = json_object();
  set_text(object, "plugin", d->id);
  set_text(object, "version", d->version);
  set_text(object, "summary", d->summary);
  set_text(object, "formula", d->formula);
  set_text(object, "notes", d->notes);
  json_object_set_new(object, "source", texts(d->source, d->sources));
  set_text(object, "file", d->file);
  set_text(object, "digest", d->digest);
  json_object_set_new(object, "parameters", parameters(d->parameter, d->parameters));
  json_object_set_new(object, "material_parameters",
                      parameters(d->material_parameter, d->material_parameters));
  json_object_set_new(object, "body_parameters", parameters(d->body_parameter, d->body_parameters));
  set_alternatives(object, &d->one_of, d->parameter, d->parameters);
  json_object_set_new(object, "constraints", texts(d->constraint, d->constraints));
  json_t *needs = json_object();
  for (size_t i = 0; i < d->needs; i++)
    set_range(needs, d->need[i].parameter, &d->need[i].range);
  json_object_set_new(object, "needs", needs);
  json_object_set_new(object, "given", given_sets(d));
  json_object_set_new(object, "variants", variants(d));
  set_interface(object, d);
  json_object_set_new(object, "messages", messages(d));
  json_object_set_new(object, "tasks", tasks(d));
  json_object_set_new(object, "requires", texts(d->require, d->requirements));
  json_object_set_new(object, "provides", texts(d->provide, d->provisions));
  json_object_set_new(object, "phases", texts(d->phase, d->phases));
  if (d->axis) {
    json_t *axis = json_object();
    set_text(axis, "name", d->axis);
    set_text(axis, "unit", d->axis_unit);
    json_object_set_new(object, "axis", axis);
  }
  if (d->kind == GAMUT_KIND_ESTIMATOR) {
    set_text(object, "yields", d->yields_table ? "table" : "moments");
    json_object_set_new(object, "adaptive", json_boolean(d->adaptive));
    json_object_set_new(object, "omits_failed_runs", json_boolean(d->omits_failed_runs));
  }
  json_object_set_new(object, "measures", measures(d));
  json_dumpf(object, file, JSON_INDENT(2));
  fputc('\n', file);
  json_decref(object);
}
