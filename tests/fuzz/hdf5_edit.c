#include "tests/fuzz/hdf5_edit.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS_MAX = 1 << 16, WORD = 256, LINES_MAX = 64 };

struct edit {
  hid_t file, links; /* links: property list that makes groups on the way */
  char verb[16], path[WORD], rest[4096];
};

/* Whether each link on the way to a path is there. */
static bool is_there(hid_t file, const char *path)
{
  char part[WORD];
  size_t length = 0;
  do {
    length += strcspn(path + length + 1, "/") + 1;
    snprintf(part, sizeof part, "%.*s", (int)length, path);
    if (H5Lexists(file, part, H5P_DEFAULT) <= 0)
      return false;
  } while (path[length]);
  return true;
}

static void drop(const struct edit *edit)
{
  if (is_there(edit->file, edit->path))
    H5Ldelete(edit->file, edit->path, H5P_DEFAULT);
}

static void put(const struct edit *edit, hid_t type, hid_t space, hid_t memory, const void *data)
{
  drop(edit);
  hid_t made =
      H5Dcreate2(edit->file, edit->path, type, space, edit->links, H5P_DEFAULT, H5P_DEFAULT);
  if (made >= 0 && data)
    H5Dwrite(made, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  if (made >= 0)
    H5Dclose(made);
}

static void put_numbers(const struct edit *edit, hid_t type)
{
  char *at = NULL;
  hsize_t extent[2] = {strtoull(edit->rest, &at, 10), 1};
  int rank = *at == 'x' ? 2 : 1;
  if (rank == 2)
    extent[1] = strtoull(at + 1, &at, 10);
  if (extent[0] > NUMBERS_MAX || extent[1] > NUMBERS_MAX || extent[0] * extent[1] > NUMBERS_MAX)
    return;
  size_t count = (size_t)(extent[0] * extent[1]);
  bool whole = !H5Tequal(type, H5T_IEEE_F64LE) && !H5Tequal(type, H5T_IEEE_F32LE);
  double *real = calloc(count + 1, sizeof *real), last = 0;
  long long *number = calloc(count + 1, sizeof *number), last_whole = 0;
  for (size_t i = 0; real && number && i < count; i++) {
    char *end, *end_whole;
    double next = strtod(at, &end);
    long long next_whole = strtoll(at, &end_whole, 10);
    if (end != at) {
      last = next;
      last_whole = next_whole;
      at = end > end_whole ? end : end_whole;
    }
    real[i] = last;
    number[i] = last_whole;
  }
  hid_t space = H5Screate_simple(rank, extent, NULL);
  if (space >= 0 && real && number)
    put(edit, type, space, whole ? H5T_NATIVE_LLONG : H5T_NATIVE_DOUBLE,
        count == 0 ? NULL : whole ? (void *)number : (void *)real);
  if (space >= 0)
    H5Sclose(space);
  free(real);
  free(number);
}

static hid_t text_type(size_t size)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, size);
  return type;
}

/* Replaces "\n" in place. */
static void unfold(char *text)
{
  for (char *at = text; (at = strstr(at, "\\n"));) {
    *at = '\n';
    memmove(at + 1, at + 2, strlen(at + 2) + 1);
  }
}

static void put_text(struct edit *edit, bool variable)
{
  const char *words = edit->rest;
  unfold(edit->rest);
  hid_t space = H5Screate(H5S_SCALAR),
        type = text_type(variable ? H5T_VARIABLE : strlen(words) + 1);
  put(edit, type, space, type, variable ? (const void *)&words : words);
  H5Tclose(type);
  H5Sclose(space);
}

/* Lists too: who expects one value must not take more. */
static void make_attribute(hid_t at, const char *name, bool text, const char *value, size_t count)
{
  hsize_t extent = count;
  size_t size = text ? strlen(value) + 1 : sizeof(double);
  char *data = calloc(count, size);
  double real = strtod(value, NULL);
  hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &extent, NULL);
  hid_t type = text ? text_type(size) : H5Tcopy(H5T_NATIVE_DOUBLE);
  hid_t made = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  for (size_t i = 0; data && i < count; i++)
    memcpy(data + i * size, text ? value : (const char *)&real, size);
  if (made >= 0) {
    H5Awrite(made, type, data);
    H5Aclose(made);
  }
  free(data);
  H5Tclose(type);
  H5Sclose(space);
}

static void put_attribute(struct edit *edit)
{
  char name[WORD] = "", kind[16] = "";
  int from = 0;
  if (!is_there(edit->file, edit->path) ||
      sscanf(edit->rest, "%255s %15s %n", name, kind, &from) < 2)
    return;
  hid_t at = H5Oopen(edit->file, edit->path, H5P_DEFAULT);
  if (at < 0)
    return;
  if (H5Aexists(at, name) > 0)
    H5Adelete(at, name);
  char *value = edit->rest + from;
  bool text = strncmp(kind, "text", 4) == 0;
  size_t count = 1;
  if (strcmp(kind, "texts") == 0 || strcmp(kind, "reals") == 0)
    count = strtoull(value, &value, 10);
  if ((text || strncmp(kind, "real", 4) == 0) && count > 0 && count < 4096)
    make_attribute(at, name, text, value, count);
  H5Oclose(at);
}

/* The dataset's bytes, one more for a zero behind; null unless it is one of small fixed type. */
static char *bytes_of(hid_t opened, hid_t type, hid_t space, size_t *size)
{
  hssize_t count = H5Sget_simple_extent_npoints(space);
  *size = H5Tget_size(type) * (size_t)(count > 0 ? count : 0);
  bool fixed = H5Tis_variable_str(type) <= 0 && *size > 0 && *size < (1 << 20);
  char *bytes = fixed ? calloc(*size + 1, 1) : NULL;
  if (bytes && H5Dread(opened, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) < 0) {
    free(bytes);
    return NULL;
  }
  return bytes;
}

static void write_swapped(const struct edit *edit, hid_t type, const char *bytes, size_t size)
{
  bool text = H5Tget_class(type) == H5T_STRING;
  hsize_t extent = text ? 1 : size;
  hid_t space = text ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &extent, NULL);
  hid_t kind = text ? text_type(size + 1) : H5Tcopy(H5T_STD_U8LE);
  put(edit, kind, space, kind, bytes);
  H5Tclose(kind);
  H5Sclose(space);
}

static void swap(struct edit *edit)
{
  char *bar = strstr(edit->rest, " | "), *found;
  hid_t opened = is_there(edit->file, edit->path) && bar
                     ? H5Dopen2(edit->file, edit->path, H5P_DEFAULT)
                     : -1;
  if (opened < 0)
    return;
  size_t size = 0;
  hid_t type = H5Dget_type(opened), space = H5Dget_space(opened);
  char *bytes = bytes_of(opened, type, space, &size), *made = NULL;
  H5Dclose(opened);
  *bar = 0;
  char *old = edit->rest, *new = bar + 3;
  unfold(old);
  unfold(new);
  if (bytes && *old && (found = strstr(bytes, old))) {
    size_t before = (size_t)(found - bytes), after = strlen(found + strlen(old));
    made = calloc(before + strlen(new) + after + 1, 1);
    if (made) {
      memcpy(made, bytes, before);
      memcpy(made + before, new, strlen(new));
      memcpy(made + before + strlen(new), found + strlen(old), after);
      write_swapped(edit, type, made, before + strlen(new) + after);
    }
  }
  free(made);
  free(bytes);
  H5Tclose(type);
  H5Sclose(space);
}

static void link_to(const struct edit *edit, bool soft)
{
  char target[WORD] = "";
  if (sscanf(edit->rest, "%255s", target) != 1)
    return;
  if (soft) {
    drop(edit);
    H5Lcreate_soft(target, edit->file, edit->path, edit->links, H5P_DEFAULT);
  } else if (target[0] == '/' && is_there(edit->file, target)) {
    H5Lcreate_hard(edit->file, target, edit->file, edit->path, edit->links, H5P_DEFAULT);
  }
}

static void group(const struct edit *edit)
{
  drop(edit);
  hid_t made = H5Gcreate2(edit->file, edit->path, edit->links, H5P_DEFAULT, H5P_DEFAULT);
  if (made >= 0)
    H5Gclose(made);
}

static void apply(struct edit *edit)
{
  static const char *const verbs[] = {"real", "float", "whole", "byte",      "text", "string",
                                      "group", "drop", "link",  "attribute", "soft", "swap"};
  size_t which = 0;
  while (which < sizeof verbs / sizeof verbs[0] && strcmp(verbs[which], edit->verb) != 0)
    which++;
  switch (which) {
  case 0: put_numbers(edit, H5T_IEEE_F64LE); break;
  case 1: put_numbers(edit, H5T_IEEE_F32LE); break;
  case 2: put_numbers(edit, H5T_STD_I64LE); break;
  case 3: put_numbers(edit, H5T_STD_U8LE); break;
  case 4: put_text(edit, false); break;
  case 5: put_text(edit, true); break;
  case 6: group(edit); break;
  case 7: drop(edit); break;
  case 8: link_to(edit, false); break;
  case 9: put_attribute(edit); break;
  case 10: link_to(edit, true); break;
  case 11: swap(edit); break;
  default: break;
  }
}

void hdf5_edit(hid_t file, const uint8_t *text, size_t size)
{
  struct edit edit = {.file = file, .links = H5Pcreate(H5P_LINK_CREATE)};
  H5Pset_create_intermediate_group(edit.links, 1);
  char *copy = calloc(size + 1, 1), *rest = copy, *line;
  if (copy)
    memcpy(copy, text, size);
  for (int n = 0; copy && n < LINES_MAX && (line = strsep(&rest, "\n")); n++) {
    int from = 0;
    if (sscanf(line, "%15s %255s %n", edit.verb, edit.path, &from) < 2 || edit.path[0] != '/')
      continue;
    snprintf(edit.rest, sizeof edit.rest, "%s", from ? line + from : "");
    apply(&edit);
  }
  free(copy);
  H5Pclose(edit.links);
  H5Eclear2(H5E_DEFAULT);
}
