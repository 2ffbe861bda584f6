/* Parameters that hold others: lists, maps, forms of a `one of`, and members of which a scene gives
 * some in place of others. */
#include <stdio.h>
#include <string.h>

#include "descriptor/descriptor_private.h"

static bool of_words(const struct parameter *of)
{
  return of && (of->type == VALUE_TEXT || of->type == VALUE_BODY);
}

unsigned parameter_forms(const struct parameter *parameter)
{
  enum { SCALAR = 1 << TREE_SCALAR, SEQUENCE = 1 << TREE_SEQUENCE, MAPPING = 1 << TREE_MAPPING };
  unsigned forms = 0;
  switch (parameter->type) {
  case VALUE_REAL:
    return parameter->random ? SCALAR | MAPPING : SCALAR;
  case VALUE_INTEGER:
  case VALUE_BOOLEAN:
  case VALUE_CHOICE:
  case VALUE_TEXT:
  case VALUE_BODY:
  case VALUE_FILE:
  case VALUE_EXPRESSION:
  case VALUE_ENTRY:
    return SCALAR;
  case VALUE_VECTOR:
    return SEQUENCE;
  case VALUE_LIST:
    return of_words(parameter->of) ? SCALAR | SEQUENCE : SEQUENCE;
  case VALUE_TABLE:
    return parameter->choices == 2 ? SCALAR | SEQUENCE | MAPPING : SEQUENCE | MAPPING;
  case VALUE_PLUGIN:
    return SCALAR | MAPPING;
  case VALUE_LEVELS:
  case VALUE_MAP:
  case VALUE_GROUP:
    return MAPPING;
  case VALUE_ONE_OF:
    for (size_t i = 0; i < parameter->members; i++)
      forms |= parameter_forms(&parameter->member[i]);
    return forms;
  }
  return forms;
}

bool parameter_is_word(const struct parameter *parameter)
{
  return parameter->type == VALUE_CHOICE || parameter->type == VALUE_BOOLEAN;
}

/* What stands for a value that is always there: it cannot lack, so nothing stands in for it. */
static void refuse_absence(struct reader *reader, const struct tree *node, const char *what)
{
  static const char *const key[] = {"default", "optional"};
  for (size_t i = 0; i < ARRAY_SIZE(key); i++)
    if (tree_get(node, key[i]))
      reader_error_at_key(reader, tree_get(node, key[i]), NULL, "'%s' has no meaning for %s",
                          key[i], what);
}

void read_entries(struct reader *reader, const struct tree *node, struct parameter *parameter)
{
  const struct tree *of = tree_get(node, "of");
  if (!of) {
    reader_error_at_key(reader, node, "of: {type: group, members: {..}}",
                        "nothing says what an entry of '%s' is", parameter->name);
    return;
  }
  struct parameter *entry = reader_keep(reader, 1, sizeof *entry);
  read_parameter(reader, of, DECLARED_ENTRY, entry);
  entry->name = parameter->name;
  refuse_absence(reader, of, "an entry");
  parameter->of = entry;
}

void read_forms(struct reader *reader, const struct tree *node, struct parameter *parameter)
{
  const struct tree *forms = tree_get(node, "forms");
  unsigned taken = 0;
  if (!forms || forms->kind != TREE_MAPPING || forms->children < 2) {
    reader_error_at_key(reader, forms ? forms : node, "forms: {number: {..}, law: {..}}",
                        "'%s' has no forms", parameter->name);
    return;
  }
  parameter->members = read_parameters(reader, forms, DECLARED_PARAMETER, &parameter->member);
  for (size_t i = 0; i < parameter->members; i++) {
    const struct parameter *form = &parameter->member[i];
    const unsigned own = parameter_is_word(form) ? 0 : parameter_forms(form);
    if (own & taken)
      reader_error_at_key(reader, forms->child[i],
                          "at most one that is written as a plain value, one as a list, one as a "
                          "mapping; words of choices beside them",
                          "the form '%s' of '%s' cannot be told from another one", form->name,
                          parameter->name);
    refuse_absence(reader, forms->child[i], "a form");
    taken |= own;
  }
}

static struct parameter *member_named(struct parameter *member, size_t members, const char *name)
{
  for (size_t i = 0; i < members; i++)
    if (strcmp(member[i].name, name) == 0)
      return &member[i];
  return NULL;
}

/* One alternative: a name or a list of them. Whether one of its members must be given. */
static bool read_set(struct reader *reader, const struct tree *item, struct parameter *member,
                     size_t members, unsigned number)
{
  bool needed = false;
  size_t count;
  const char **name = read_texts(reader, item, "one_of", &count);
  for (size_t k = 0; k < count; k++) {
    struct parameter *p = member_named(member, members, name[k]);
    if (!p)
      reader_error_at_value(reader, item, NULL, "'one_of' names '%s', which is not declared here",
                            name[k]);
    else if (p->set)
      reader_error_at_value(reader, item, NULL, "'%s' stands in two alternatives", name[k]);
    else if (p->standard)
      reader_error_at_value(reader, item, NULL,
                            "'%s' has a default, so that it would stand beside the others",
                            name[k]);
    if (!p)
      continue;
    p->set = number;
    needed = needed || !p->optional;
  }
  return needed;
}

void read_one_of(struct reader *reader, const struct tree *node, struct parameter *member,
                 size_t members, struct alternatives *alternatives)
{
  size_t needed = 0;
  if (!node)
    return;
  if (node->kind != TREE_SEQUENCE || node->children < 2) {
    reader_error_at_value(reader, node, "[one, other], or [[one, its_companion], [other]]",
                          "'one_of' is no list of alternatives");
    return;
  }
  for (size_t i = 0; i < node->children; i++)
    needed += read_set(reader, node->child[i], member, members, (unsigned)i + 1);
  if (needed > 0 && needed < node->children)
    reader_error_at_value(reader, node, "optional members in all alternatives, or in none",
                          "some of the alternatives must be given and some need not");
  *alternatives = (struct alternatives){node->children, needed > 0};
}

void check_entry_of(struct reader *reader, const struct tree *node,
                    const struct parameter *argument)
{
  const struct descriptor *d = reader->descriptor;
  if (argument->type != VALUE_ENTRY || !argument->entry_of)
    return;
  const struct parameter *map = parameter_named(d->parameter, d->parameters, argument->entry_of);
  if (d->kind == GAMUT_KIND_ELASTICITY)
    reader_error_at_value(reader, tree_get(node, "of"), NULL,
                          "each material has an elasticity of its own: '%s' would be an entry of "
                          "several maps",
                          argument->name);
  else if (!map || map->type != VALUE_MAP)
    reader_error_at_value(reader, tree_get(node, "of"), "the name of a parameter of type map",
                          "'%s' is no map of this plugin", argument->entry_of);
}

char *alternatives_text(const struct parameter *member, size_t count, char *buffer, size_t size)
{
  size_t length = 0;
  unsigned last = 0;
  buffer[0] = 0;
  for (unsigned set = 1; set <= count; set++)
    for (size_t i = 0; i < count && length < size; i++) {
      if (member[i].set != set)
        continue;
      const char *before = last == set ? " with " : last ? ", or " : "";
      length += (size_t)snprintf(buffer + length, size - length, "%s%s", before, member[i].name);
      last = set;
    }
  return buffer;
}
