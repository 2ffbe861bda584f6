/* The struct that a kernel sees, and its digest. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "catalogue/catalogue.h"
#include "descriptor/descriptor_private.h"

/* First pass: slots is null, slots and characters are counted. Second pass: both are written into
 * one allocation, so that the caller frees one pointer. */
struct layout {
  struct slot *slots;
  char *text;
  size_t count, length;
};

static const char *layout_text(struct layout *layout, const char *one, const char *two,
                               const char *three, const char *four)
{
  size_t length = strlen(one) + strlen(two) + strlen(three) + strlen(four) + 1;
  const char *result = NULL;
  if (layout->text) {
    char *to = layout->text + layout->length;
    snprintf(to, length, "%s%s%s%s", one, two, three, four);
    result = to;
  }
  layout->length += length;
  return result;
}

static void add(struct layout *layout, enum slot_kind kind, size_t index, size_t other,
                unsigned components, const char *name, const char *unit)
{
  for (unsigned k = 0; k < components; k++) {
    if (layout->slots)
      layout->slots[layout->count] = (struct slot){.kind = kind,
                                                   .index = index,
                                                   .other = other,
                                                   .component = k,
                                                   .components = components,
                                                   .name = name,
                                                   .unit = unit};
    layout->count++;
  }
}

static void add_parameters(struct layout *layout, enum slot_kind kind,
                           const struct parameter *parameter, size_t count)
{
  for (size_t i = 0; i < count; i++)
    if (kernel_sees(&parameter[i]))
      add(layout, kind, i, 0, 1, parameter[i].name, parameter[i].unit ? parameter[i].unit : "1");
}

static void add_uses(struct layout *layout, enum slot_kind kind, const struct field_use *use,
                     size_t count)
{
  for (size_t i = 0; i < count; i++)
    add(layout, kind, i, 0, use[i].components, use[i].name, use[i].unit);
}

static const char *by_unit(const struct descriptor *d, size_t index)
{
  const struct parameter *parameter =
      parameter_named(d->parameter, d->parameters, d->derivative_by[index]);
  if (parameter) /* none where it could not be read, or is no number */
    return parameter->unit ? parameter->unit : "1";
  for (size_t i = 0; i < d->inputs; i++)
    if (strcmp(d->input[i].name, d->derivative_by[index]) == 0)
      return d->input[i].unit;
  return "1";
}

static const char *quotient(struct layout *layout, const char *over, const char *under)
{
  if (strcmp(under, "1") == 0)
    return layout_text(layout, over, "", "", "");
  bool simple = !strpbrk(under, " /.*");
  return layout_text(layout, over, simple ? "/" : "/(", under, simple ? "" : ")");
}

static void add_derivatives(struct layout *layout, const struct descriptor *d)
{
  const char *of = d->derivative_of, *unit = "1";
  for (size_t i = 0; i < d->outputs; i++)
    if (of && strcmp(d->output[i].name, of) == 0)
      unit = d->output[i].unit;
  for (size_t i = 0; i < d->derivatives; i++) {
    const char *name = layout_text(layout, of, "_by_", d->derivative_by[i], "");
    const char *first = quotient(layout, unit, by_unit(d, i));
    add(layout, SLOT_DERIVATIVE, i, 0, 1, name, first);
  }
  for (size_t i = 0; i < d->derivatives; i++)
    for (size_t j = i; j < d->derivatives; j++) {
      const char *pair = layout_text(layout, d->derivative_by[i], "_", d->derivative_by[j], "");
      const char *name = layout_text(layout, of, "_by_", pair ? pair : d->derivative_by[i],
                                     pair ? "" : d->derivative_by[j]);
      /* In the first pass `pair` does not exist yet; its '_' is counted here. */
      if (!pair)
        layout->length++;
      const char *first = quotient(layout, unit, by_unit(d, i));
      const char *second = quotient(layout, first ? first : unit, by_unit(d, j));
      if (!first)
        layout->length += strlen(by_unit(d, i)) + 3;
      add(layout, SLOT_SECOND_DERIVATIVE, i, j, 1, name, second);
    }
}

static void lay_out(struct layout *layout, const struct descriptor *d)
{
  add_parameters(layout, SLOT_PARAMETER, d->parameter, d->parameters);
  add_parameters(layout, SLOT_MATERIAL_PARAMETER, d->material_parameter, d->material_parameters);
  add_uses(layout, SLOT_INPUT, d->input, d->inputs);
  add_uses(layout, SLOT_OUTPUT, d->output, d->outputs);
  for (size_t i = 0; i < d->states; i++) {
    const struct state_variable *state = &d->state[i];
    add(layout, SLOT_STATE_BEGIN, i, 0, state->components,
        layout_text(layout, state->name, "_begin", "", ""), state->unit);
    add(layout, SLOT_STATE_END, i, 0, state->components, state->name, state->unit);
  }
  for (size_t i = 0; i < d->laws; i++)
    add(layout, SLOT_LAW, i, 0, 1, d->law[i].name, "1");
  if (d->prepare)
    add(layout, SLOT_DATA, 0, 0, 1, "data", "1");
  if (d->scratch)
    add(layout, SLOT_SCRATCH, 0, 0, (unsigned)d->scratch, "scratch", "1");
  if (d->inverse) {
    add(layout, SLOT_INVERSE_INPUT, 0, 0, 1, "flow_stress_given", "Pa");
    add(layout, SLOT_INVERSE_OUTPUT, 0, 0, 1, "plastic_strain_inverse", "1");
  }
  add_derivatives(layout, d);
}

size_t descriptor_layout(const struct descriptor *descriptor, struct slot **slots)
{
  struct layout layout = {0};
  lay_out(&layout, descriptor);
  size_t head = (layout.count + 1) * sizeof(struct slot);
  struct slot *memory = calloc(1, head + layout.length + 1);
  if (!memory)
    memory_ended();
  layout = (struct layout){.slots = memory, .text = (char *)memory + head};
  lay_out(&layout, descriptor);
  *slots = memory;
  return layout.count;
}

static uint64_t digest_text(uint64_t digest, const char *text)
{
  return hash_bytes(digest, text, strlen(text) + 1);
}

static uint64_t digest_number(uint64_t digest, size_t number)
{
  char text[32];
  snprintf(text, sizeof text, "%zu", number);
  return digest_text(digest, text);
}

static uint64_t digest_choices(uint64_t digest, const struct parameter *parameter, size_t count)
{
  for (size_t i = 0; i < count; i++) {
    if (parameter[i].type == VALUE_CHOICE)
      digest = digest_text(digest, parameter[i].name);
    for (size_t k = 0; parameter[i].type == VALUE_CHOICE && k < parameter[i].choices; k++)
      digest = digest_text(digest, parameter[i].choice[k]);
    if (parameter[i].members)
      digest = digest_choices(digest_text(digest, parameter[i].name), parameter[i].member,
                              parameter[i].members);
    if (parameter[i].of)
      digest = digest_choices(digest, parameter[i].of, 1);
  }
  return digest;
}

void descriptor_seal(struct descriptor *d)
{
  struct slot *slots;
  size_t count = descriptor_layout(d, &slots);
  uint64_t digest = digest_text(HASH_START, d->id);
  for (size_t i = 0; i < count; i++) {
    digest = digest_number(digest, slots[i].kind);
    digest = digest_number(digest, slots[i].component);
    digest = digest_text(digest_text(digest, slots[i].name), slots[i].unit);
  }
  free(slots);
  digest = digest_choices(digest, d->parameter, d->parameters);
  digest = digest_choices(digest, d->material_parameter, d->material_parameters);
  digest = digest_choices(digest, d->body_parameter, d->body_parameters);
  for (size_t i = 0; i < d->measures; i++)
    digest = digest_choices(digest_text(digest, d->measure[i].name), d->measure[i].argument,
                            d->measure[i].arguments);
  for (size_t i = 0; i < d->messages; i++)
    digest = digest_number(digest_text(digest, d->message[i].name), d->message[i].severity);
  for (size_t i = 0; i < d->variants; i++)
    digest = digest_text(digest, d->variant[i].kernel);
  for (size_t i = 0; i < d->tasks; i++)
    digest = digest_text(digest, d->task[i].kernel);
  snprintf(d->digest, sizeof d->digest, "%016" PRIx64, digest);
}

static const char *section_of(enum slot_kind kind)
{
  switch (kind) {
  case SLOT_PARAMETER:
    return "parameters";
  case SLOT_MATERIAL_PARAMETER:
    return "material_parameters";
  case SLOT_INPUT:
    return "inputs";
  case SLOT_OUTPUT:
    return "outputs";
  case SLOT_STATE_BEGIN:
  case SLOT_STATE_END:
    return "state";
  case SLOT_LAW:
    return "laws";
  case SLOT_SCRATCH:
    return "scratch";
  case SLOT_INVERSE_INPUT:
  case SLOT_INVERSE_OUTPUT:
    return "inverse";
  case SLOT_DERIVATIVE:
  case SLOT_SECOND_DERIVATIVE:
    return "derivatives";
  case SLOT_DATA:
    return "prepare";
  }
  return "parameters";
}

/* The node to blame: the declaration in its section, else the section. */
static const struct tree *declaration(const struct tree *root, const struct slot *slot)
{
  const struct tree *section = tree_get(root, section_of(slot->kind));
  if (!section)
    return root;
  const struct tree *child = tree_get(section, slot->name);
  if (child)
    return child;
  size_t length = strlen(slot->name);
  for (size_t i = 0; section->kind == TREE_SEQUENCE && i < section->children; i++)
    if (strncmp(section->child[i]->text, slot->name, length) == 0)
      return section->child[i];
  return section;
}

void check_layout(struct reader *reader, const struct tree *root)
{
  struct slot *slots;
  size_t count = descriptor_layout(reader->descriptor, &slots);
  for (size_t i = 0; i < count; i++) {
    const struct tree *node = declaration(root, &slots[i]);
    if (slots[i].component != 0)
      continue;
    if (is_reserved(slots[i].name))
      reader_error_at_key(reader, node, "another name", "'%s' has a meaning in C or in formulas",
                          slots[i].name);
    for (size_t k = 0; k < i; k++)
      if (slots[k].component == 0 && strcmp(slots[k].name, slots[i].name) == 0)
        reader_error_at_key(reader, node,
                            slots[k].kind == SLOT_INPUT && slots[i].kind == SLOT_OUTPUT
                                ? "a field that is read and written belongs under 'state'"
                                : "another name",
                            "'%s' is declared twice, under '%s' and under '%s'", slots[i].name,
                            section_of(slots[k].kind), section_of(slots[i].kind));
  }
  free(slots);
}
