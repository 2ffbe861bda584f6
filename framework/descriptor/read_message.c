/* What a kernel can say (messages) and the kernels of an effect (tasks). */
#include <string.h>

#include "catalogue/catalogue.h"
#include "descriptor/descriptor_private.h"

static bool read_severity(struct reader *reader, const struct tree *node,
                          enum gamut_severity *severity)
{
  static const char *const known[] = {"note", "warn", "stop"};
  const char *text = read_text(reader, node, "severity", true);
  for (size_t i = 0; text && i < ARRAY_SIZE(known); i++)
    if (strcmp(text, known[i]) == 0) {
      *severity = (enum gamut_severity)(GAMUT_NOTE + (int)i);
      return true;
    }
  if (text)
    reader_error_at_unknown(reader, tree_get(node, "severity"), false, known, ARRAY_SIZE(known),
                            "unknown severity '%s'", text);
  return false;
}

static void read_message_list(struct reader *reader, const struct tree *node)
{
  static const char *const keys[] = {"severity", "text"};
  struct descriptor *d = reader->descriptor;
  if (!node)
    return;
  if (node->kind != TREE_MAPPING || node->children > 256) {
    reader_error_at_value(reader, node, "{name: {severity: stop, text: ...}}, at most 256",
                          "'messages' is no mapping of messages");
    return;
  }
  d->message = reader_keep(reader, node->children, sizeof *d->message);
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *child = node->child[i];
    struct message *message = &d->message[d->messages];
    message->name = child->key;
    check_name(reader, child, true, child->key);
    if (strcmp(child->key, "scratch") == 0)
      reader_error_at_key(reader, child, NULL,
                          "a message cannot be called 'scratch': the generated header "
                          "has that constant");
    if (!check_keys(reader, child, keys, ARRAY_SIZE(keys), "a message"))
      continue;
    message->text = read_text(reader, child, "text", true);
    if (read_severity(reader, child, &message->severity) && message->text)
      d->messages++;
  }
}

static bool is_state(const struct descriptor *d, const char *name)
{
  for (size_t i = 0; i < d->states; i++)
    if (strcmp(d->state[i].name, name) == 0)
      return true;
  return false;
}

static bool is_field(const struct descriptor *d, const char *name, bool written)
{
  for (size_t i = 0; !written && i < d->inputs; i++)
    if (strcmp(d->input[i].name, name) == 0)
      return true;
  for (size_t i = 0; written && i < d->outputs; i++)
    if (strcmp(d->output[i].name, name) == 0)
      return true;
  return is_state(d, name);
}

/* The keys of a task that name fields, and what each does to them. */
static const struct access_key {
  const char *key;
  enum gamut_access access;
} access_keys[] = {{"reads", GAMUT_READ},
                   {"writes", GAMUT_WRITE},
                   {"adds", GAMUT_ADD},
                   {"scales", GAMUT_SCALE},
                   {"lowers", GAMUT_LEAST}};

static const char *key_of(enum gamut_access access)
{
  size_t k = 0;
  while (access_keys[k].access != access)
    k++;
  return access_keys[k].key;
}

/* What several may change they change in one way; a state is set by whose it is. */
static void check_access(struct reader *reader, const struct tree *node, const char *name,
                         enum gamut_access access)
{
  const struct field_info *entry = catalogue_find(name);
  const bool shared = access == GAMUT_SCALE || access == GAMUT_LEAST;
  char expected[96];
  if (access == GAMUT_READ)
    return;
  if (entry && entry->access != GAMUT_WRITE && entry->access != access) {
    snprintf(expected, sizeof expected, "%s: [%s]", key_of(entry->access), name);
    reader_error_at_value(reader, node, expected,
                          "several effects may change '%s', and all of them in one way", name);
  } else if (shared && is_state(reader->descriptor, name)) {
    reader_error_at_value(reader, node, "writes: [..]",
                          "'%s' is a state of this plugin: it begins a step as the last one ended",
                          name);
  }
}

static const char **read_accesses(struct reader *reader, const struct tree *task,
                                  enum gamut_access access, size_t *count)
{
  const char *key = key_of(access);
  const struct tree *node = tree_get(task, key);
  const char **list = read_texts(reader, node, key, count);
  bool written = access != GAMUT_READ;
  for (size_t i = 0; i < *count; i++) {
    const struct tree *item = node->kind == TREE_SEQUENCE ? node->child[i] : node;
    if (is_field(reader->descriptor, list[i], written))
      check_access(reader, item, list[i], access);
    else
      reader_error_at_value(reader, item,
                            written ? "declare it under 'outputs' or 'state'"
                                    : "declare it under 'inputs' or 'state'",
                            "'%s' is no field of this plugin", list[i]);
  }
  return list;
}

static void read_tasks(struct reader *reader, const struct tree *node)
{
  static const char *const keys[] = {"kernel", "phase",  "reads", "writes",
                                     "adds",   "scales", "lowers"};
  struct descriptor *d = reader->descriptor;
  if (!node)
    return;
  if (node->kind != TREE_SEQUENCE) {
    reader_error_at_value(reader, node,
                          "[{kernel: heat, phase: after material, reads: [..], writes: [..]}]",
                          "'tasks' is no list");
    return;
  }
  d->task = reader_keep(reader, node->children, sizeof *d->task);
  for (size_t i = 0; i < node->children; i++) {
    const struct tree *item = node->child[i];
    struct kernel_task *task = &d->task[d->tasks];
    if (!check_keys(reader, item, keys, ARRAY_SIZE(keys), "a task"))
      continue;
    task->kernel = read_text(reader, item, "kernel", true);
    task->phase = read_text(reader, item, "phase", true);
    task->read = read_accesses(reader, item, GAMUT_READ, &task->reads);
    task->write = read_accesses(reader, item, GAMUT_WRITE, &task->writes);
    task->add = read_accesses(reader, item, GAMUT_ADD, &task->adds);
    task->scale = read_accesses(reader, item, GAMUT_SCALE, &task->scales);
    task->lower = read_accesses(reader, item, GAMUT_LEAST, &task->lowers);
    if (task->writes + task->adds + task->scales + task->lowers == 0)
      reader_error_at_value(reader, item,
                            "one of writes: [..], adds: [..], scales: [..], lowers: [..]",
                            "this task changes nothing");
    if (task->kernel && task->phase)
      d->tasks++;
  }
}

static void check_kernel(struct reader *reader, const struct tree *item, const char *const *earlier,
                         size_t count, const char *kernel)
{
  const struct tree *node = tree_get(item, "kernel");
  const char *operation;
  if (!check_name(reader, node, false, kernel))
    return;
  bool taken = strcmp(kernel, "size") == 0;
  for (size_t i = 0; (operation = kind_operation(reader->descriptor->kind, i)); i++)
    taken = taken || strcmp(operation, kernel) == 0;
  taken = taken || strcmp(kernel, "prepare") == 0 || strcmp(kernel, "release") == 0;
  for (size_t i = 0; i < count && !taken; i++)
    taken = strcmp(earlier[i], kernel) == 0;
  if (taken)
    reader_error_at_value(reader, node, "another name", "a kernel '%s' is there already", kernel);
}

/* Kernels of variants and tasks become members of one struct. */
static void check_kernels(struct reader *reader, const struct tree *root)
{
  const struct descriptor *d = reader->descriptor;
  const char **names = reader_keep(reader, d->variants + d->tasks, sizeof *names);
  size_t count = 0;
  const char *const sections[] = {"variants", "tasks"};
  for (size_t s = 0; s < ARRAY_SIZE(sections); s++) {
    const struct tree *list = tree_get(root, sections[s]);
    for (size_t i = 0; list && i < list->children; i++) {
      const struct tree *kernel = tree_get(list->child[i], "kernel");
      if (!kernel || kernel->kind != TREE_SCALAR || count == d->variants + d->tasks)
        continue;
      check_kernel(reader, list->child[i], names, count, kernel->text);
      names[count++] = kernel->text;
    }
  }
}

void read_messages(struct reader *reader, const struct tree *root)
{
  read_message_list(reader, tree_get(root, "messages"));
  read_tasks(reader, tree_get(root, "tasks"));
  check_kernels(reader, root);
}
