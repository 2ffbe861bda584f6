/* `gamut show`: a plugin's declaration for people. */
#include <string.h>

#include "catalogue/catalogue.h"
#include "descriptor/descriptor_private.h"

/* Text of several lines, each indented; blank lines at the end are left out. */
static void put_lines(FILE *file, const char *text, const char *indent)
{
  size_t length = strlen(text);
  while (length && (text[length - 1] == '\n' || text[length - 1] == ' '))
    length--;
  const char *end = text + length;
  while (text < end) {
    const char *stop = memchr(text, '\n', (size_t)(end - text));
    if (!stop)
      stop = end;
    fprintf(file, "%s%.*s\n", stop > text ? indent : "", (int)(stop - text), text);
    text = stop < end ? stop + 1 : end;
  }
}

static void put_section(FILE *file, const char *title, const char *text)
{
  if (!text)
    return;
  fprintf(file, "\n%s\n", title);
  put_lines(file, text, "  ");
}

static void put_names(FILE *file, const char *before, const char *const *name, size_t count)
{
  if (count == 0)
    return;
  fputs(before, file);
  for (size_t i = 0; i < count; i++)
    fprintf(file, "%s%s", i ? ", " : "", name[i]);
  fputc('\n', file);
}

static void put_value(FILE *file, const struct tree *value)
{
  if (value->kind == TREE_SCALAR) {
    fputs(value->text, file);
    return;
  }
  bool mapping = value->kind == TREE_MAPPING;
  fputc(mapping ? '{' : '[', file);
  for (size_t i = 0; i < value->children; i++) {
    fprintf(file, "%s%s%s", i ? ", " : "", mapping ? value->child[i]->key : "",
            mapping ? ": " : "");
    put_value(file, value->child[i]);
  }
  fputc(mapping ? '}' : ']', file);
}

static void put_size(FILE *file, const struct parameter *parameter)
{
  fprintf(file, " of %zu", parameter->size_min);
  if (parameter->size_max > parameter->size_min)
    fprintf(file, " to %zu", parameter->size_max);
}

/* "real in Pa", "vector of 1 to 3 in m", "choice of linear, quadratic", "map of 1 to 3: group" */
static void put_type(FILE *file, const struct parameter *parameter)
{
  fputs(value_type_name(parameter->type), file);
  if (parameter->type == VALUE_VECTOR || parameter->of)
    put_size(file, parameter);
  if (parameter->type == VALUE_TABLE && parameter->size_min > 1)
    fprintf(file, " of at least %zu rows", parameter->size_min);
  if (parameter->of) {
    fputs(": ", file);
    put_type(file, parameter->of);
    return;
  }
  if (parameter->type == VALUE_ENTRY)
    fprintf(file, " of '%s'", parameter->entry_of);
  if (parameter->type == VALUE_PLUGIN)
    fprintf(file, " of kind %s", kind_name(parameter->kind));
  if (parameter->unit_of)
    fprintf(file, " in the unit of '%s'", parameter->unit_of);
  else if (parameter->unit && parameter->type != VALUE_INTEGER) {
    if (strcmp(parameter->unit, "1") == 0)
      fputs(", a pure number", file);
    else
      fprintf(file, " in %s", parameter->unit);
  }
  for (size_t i = 0; i < parameter->choices; i++) {
    fputs(i ? ", " : parameter->type == VALUE_CHOICE ? " of " : " over ", file);
    fputs(parameter->choice[i], file);
    if (parameter->choice_unit)
      fprintf(file, " (%s)", parameter->choice_unit[i]);
  }
}

static void put_range(FILE *file, const char *name, const struct range *range, const char *unit,
                      const char *indent)
{
  char text[160];
  if (range->stated)
    fprintf(file, "%s    %s: %s\n", indent, name, range_text(range, unit, text, sizeof text));
}

/* `d` is null where no set can give the parameters. */
static bool stands_in_set(const struct descriptor *d, const char *name)
{
  for (size_t g = 0; d && g < d->givens; g++) {
    for (size_t i = 0; i < d->given[g].names; i++)
      if (strcmp(d->given[g].name[i], name) == 0)
        return true;
    for (size_t i = 0; i < d->given[g].derivations; i++)
      if (strcmp(d->given[g].derived[i], name) == 0)
        return true;
  }
  return false;
}

static void put_need(FILE *file, const struct descriptor *d, const struct parameter *parameter)
{
  if (stands_in_set(d, parameter->name))
    fputs("; by one of the sets below", file);
  else if (parameter->optional)
    fputs("; optional", file);
  else if (parameter->set)
    fputs("; where it is chosen", file);
  else if (parameter->type != VALUE_GROUP)
    fputs("; required", file);
}

static void put_alternatives(FILE *file, const struct alternatives *one_of,
                             const struct parameter *parameter, size_t count, const char *indent)
{
  char text[512];
  if (one_of->sets)
    fprintf(file, "%s%s of: %s\n", indent, one_of->needed ? "one" : "at most one",
            alternatives_text(parameter, count, text, sizeof text));
}

static void put_parameters(FILE *file, const struct descriptor *d,
                           const struct parameter *parameter, size_t count, const char *indent)
{
  for (size_t i = 0; i < count; i++) {
    const struct parameter *p = &parameter[i];
    fprintf(file, "%s%s", indent, p->name);
    if (p->symbol && strcmp(p->symbol, p->name) != 0)
      fprintf(file, " (%s)", p->symbol);
    fputs(": ", file);
    put_type(file, p);
    if (p->standard) {
      fputs("; default ", file);
      put_value(file, p->standard);
    } else {
      put_need(file, d, p);
    }
    fputs(p->random ? "; may be random\n" : "\n", file);
    char deeper[64];
    snprintf(deeper, sizeof deeper, "%s    ", indent);
    if (p->doc)
      put_lines(file, p->doc, deeper);
    put_range(file, "physical", &p->physical, p->unit, indent);
    put_range(file, "fit", &p->fit, p->unit, indent);
    put_range(file, "usual", &p->usual, p->unit, indent);
    if (p->source)
      fprintf(file, "%ssource: %s\n", deeper, p->source);
    const struct parameter *inner = p->of ? p->of : p;
    put_alternatives(file, &inner->one_of, inner->member, inner->members, deeper);
    put_parameters(file, NULL, inner->member, inner->members, deeper);
  }
}

static void put_parameter_section(FILE *file, const char *title, const struct descriptor *d,
                                  const struct parameter *parameter, size_t count)
{
  if (count == 0)
    return;
  fprintf(file, "\n%s\n", title);
  if (d)
    put_alternatives(file, &d->one_of, parameter, count, "  ");
  put_parameters(file, d, parameter, count, "  ");
}

static void put_rules(FILE *file, const struct descriptor *d)
{
  if (d->constraints)
    fputs("\nconstraints\n", file);
  for (size_t i = 0; i < d->constraints; i++)
    fprintf(file, "  %s\n", d->constraint[i]);
  if (d->needs)
    fputs("\nneeds of whoever calls it\n", file);
  for (size_t i = 0; i < d->needs; i++) {
    char range[128];
    fprintf(file, "  %s %s\n", d->need[i].parameter,
            range_text(&d->need[i].range, NULL, range, sizeof range));
  }
  if (d->givens)
    fputs("\ngive one of these sets\n", file);
  for (size_t i = 0; i < d->givens; i++) {
    put_names(file, "  ", d->given[i].name, d->given[i].names);
    for (size_t k = 0; k < d->given[i].derivations; k++)
      fprintf(file, "    then %s = %s\n", d->given[i].derived[k], d->given[i].formula[k]);
  }
  if (d->variants)
    fputs("\nvariants\n", file);
  for (size_t i = 0; i < d->variants; i++) {
    fprintf(file, "  %s where %s\n", d->variant[i].kernel, d->variant[i].when);
    put_names(file, "    without ", d->variant[i].drop, d->variant[i].drops);
  }
}

static void put_uses(FILE *file, const char *title, const struct field_use *use, size_t count)
{
  if (count == 0)
    return;
  fprintf(file, "\n%s\n", title);
  for (size_t i = 0; i < count; i++) {
    const struct field_info *entry = catalogue_find(use[i].name);
    fprintf(file, "  %s", use[i].name);
    if (use[i].components > 1)
      fprintf(file, "[%u]", use[i].components);
    if (use[i].unit)
      fprintf(file, " in %s", use[i].unit);
    fputs(use[i].optional ? ", optional" : "", file);
    if (use[i].optional && use[i].absent != 0.0)
      fprintf(file, ", %g where absent", use[i].absent);
    fprintf(file, "%s%s\n", entry ? ": " : "", entry ? entry->meaning : "");
  }
}

static void put_fields(FILE *file, const struct descriptor *d)
{
  put_uses(file, "inputs", d->input, d->inputs);
  put_uses(file, "outputs", d->output, d->outputs);
  if (d->states)
    fputs("\nstate\n", file);
  for (size_t i = 0; i < d->states; i++) {
    fprintf(file, "  %s", d->state[i].name);
    if (d->state[i].components > 1)
      fprintf(file, "[%u]", d->state[i].components);
    fprintf(file, " in %s, initially %g: %s\n", d->state[i].unit, d->state[i].initial,
            d->state[i].doc ? d->state[i].doc : "");
  }
  put_uses(file, "laws that it calls", d->law, d->laws);
  if (d->prepare)
    fputs("\nprepares data of its own for its kernels\n", file);
  if (d->inverse)
    fputs("\noffers its inverse: plastic strain from flow stress\n", file);
  if (d->derivatives) {
    fprintf(file, "\nfirst and second derivatives of %s\n", d->derivative_of);
    put_names(file, "  by ", d->derivative_by, d->derivatives);
  }
}

static void put_tasks(FILE *file, const struct descriptor *d)
{
  static const char *const severity[] = {"fine", "note", "warn", "stop"};
  if (d->tasks)
    fputs("\ntasks\n", file);
  for (size_t i = 0; i < d->tasks; i++) {
    fprintf(file, "  %s, in phase '%s'\n", d->task[i].kernel, d->task[i].phase);
    put_names(file, "    reads ", d->task[i].read, d->task[i].reads);
    put_names(file, "    writes ", d->task[i].write, d->task[i].writes);
    put_names(file, "    adds to ", d->task[i].add, d->task[i].adds);
    put_names(file, "    scales ", d->task[i].scale, d->task[i].scales);
    put_names(file, "    lowers ", d->task[i].lower, d->task[i].lowers);
  }
  if (d->messages)
    fputs("\nmessages\n", file);
  for (size_t i = 0; i < d->messages; i++)
    fprintf(file, "  %s (%s): %s\n", d->message[i].name, severity[d->message[i].severity],
            d->message[i].text);
}

static void put_services(FILE *file, const struct descriptor *d)
{
  static const char *const place[] = {"point", "body", "run"};
  put_names(file, "\nrequires ", d->require, d->requirements);
  put_names(file, "\nprovides ", d->provide, d->provisions);
  put_names(file, "\nphases of a step: ", d->phase, d->phases);
  if (d->axis)
    fprintf(file, "\nmarches in %s (%s)\n", d->axis, d->axis_unit);
  if (d->kind == GAMUT_KIND_ESTIMATOR)
    fprintf(file, "\nyields %s\n%s\n%s\n",
            d->yields_table ? "a table: each run stands for itself" : "moments of its runs",
            d->adaptive ? "decides by results which runs it asks for"
                        : "knows beforehand which runs it asks for",
            d->omits_failed_runs ? "leaves out runs that failed" : "no run may fail");
  if (d->measures)
    fputs("\nmeasures\n", file);
  for (size_t i = 0; i < d->measures; i++) {
    const struct measure *m = &d->measure[i];
    fprintf(file, "  %s in %s%s%s, per %s: %s\n", m->name, m->unit_of ? "the unit of '" : "",
            m->unit_of ? m->unit_of : m->unit, m->unit_of ? "'" : "", place[m->at], m->doc);
    if (m->formula)
      fprintf(file, "    = %s\n", m->formula);
    put_parameters(file, NULL, m->argument, m->arguments, "    ");
  }
}

void descriptor_show(const struct descriptor *d, FILE *file)
{
  fprintf(file, "%s %s: %s\n", d->id, d->version, d->summary);
  put_names(file, "source: ", d->source, d->sources);
  fprintf(file, "file: %s\ninterface: %s\n", d->file, d->digest);
  put_section(file, "formula", d->formula);
  put_section(file, "notes", d->notes);
  put_parameter_section(file, "parameters", d, d->parameter, d->parameters);
  put_parameter_section(file, "parameters of each material", NULL, d->material_parameter,
                        d->material_parameters);
  put_parameter_section(file, "parameters of each body", NULL, d->body_parameter,
                        d->body_parameters);
  put_rules(file, d);
  put_fields(file, d);
  put_tasks(file, d);
  put_services(file, d);
}
