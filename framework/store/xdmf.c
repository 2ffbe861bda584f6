#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "store/file.h"
#include "store/store_private.h"

void text_add(struct text *text, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  int need = vsnprintf(NULL, 0, format, list);
  va_end(list);
  if (need < 0 || text->failed) {
    text->failed = true;
    return;
  }
  if (text->size + (size_t)need + 1 > text->room) {
    size_t room = 2 * (text->size + (size_t)need) + 1024;
    char *data = realloc(text->data, room);
    if (!data) {
      text->failed = true;
      return;
    }
    text->data = data;
    text->room = room;
  }
  va_start(list, format);
  vsnprintf(text->data + text->size, text->room - text->size, format, list);
  va_end(list);
  text->size += (size_t)need;
}

static void add_escaped(struct text *text, const char *words)
{
  for (; *words; ++words) {
    switch (*words) {
    case '&':
      text_add(text, "&amp;");
      break;
    case '<':
      text_add(text, "&lt;");
      break;
    case '>':
      text_add(text, "&gt;");
      break;
    case '"':
      text_add(text, "&quot;");
      break;
    default:
      text_add(text, "%c", *words);
    }
  }
}

void vertices_name(size_t count, char *name, size_t size)
{
  snprintf(name, size, "vertices/%08zu", count);
}

/* Up to the path of the dataset. ParaView's newer reader takes whole datasets only: no hyperslabs.
 */
static void open_item(struct text *text, const char *type, size_t rows, size_t columns)
{
  text_add(text,
           "            <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"8\" "
           "Dimensions=\"%zu",
           type, rows);
  if (columns > 1)
    text_add(text, " %zu", columns);
  text_add(text, "\">" RESULT_HDF5 ":/");
}

static void add_item(struct text *text, const char *type, size_t rows, size_t columns, size_t frame,
                     const char *body, const char *name)
{
  open_item(text, type, rows, columns);
  text_add(text, "frames/%08zu/", frame);
  add_escaped(text, body);
  text_add(text, "/");
  add_escaped(text, name);
  text_add(text, "</DataItem>\n");
}

static const char *attribute_type(unsigned components)
{
  switch (components) {
  case 1:
    return "Scalar";
  case 3:
    return "Vector";
  case 9:
    return "Tensor";
  default:
    return "Matrix";
  }
}

static void add_attribute(struct text *text, const char *name, const char *number,
                          unsigned components, size_t count, size_t frame, const char *body)
{
  text_add(text, "          <Attribute Name=\"");
  add_escaped(text, name);
  text_add(text, "\" AttributeType=\"%s\" Center=\"Node\">\n", attribute_type(components));
  add_item(text, number, count, components, frame, body, name);
  text_add(text, "          </Attribute>\n");
}

static void add_body(struct text *text, const struct frame_set *set,
                     const struct frame_field *field, size_t fields, size_t frame)
{
  char vertices[48];
  text_add(text, "        <Grid Name=\"");
  add_escaped(text, set->body);
  vertices_name(set->count, vertices, sizeof vertices);
  text_add(text,
           "\" GridType=\"Uniform\">\n"
           "          <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%zu\" "
           "NodesPerElement=\"1\">\n",
           set->count);
  open_item(text, "Int", set->count, 1); /* without it the newer reader shows no cells */
  text_add(text, "%s</DataItem>\n          </Topology>\n", vertices);
  text_add(text, "          <Geometry GeometryType=\"XYZ\">\n");
  add_item(text, "Float", set->count, 3, frame, set->body, "position");
  text_add(text, "          </Geometry>\n");
  add_attribute(text, "id", "Int", 1, set->count, frame, set->body);
  for (size_t i = 0; i < fields; ++i) {
    if (!is_position(&field[i]))
      add_attribute(text, field[i].name, "Float", stored_components(&field[i]), set->count, frame,
                    set->body);
  }
  text_add(text, "        </Grid>\n");
}

void xdmf_frame(struct store *store, double time, const struct frame_set *set, size_t sets,
                const struct frame_field *field, size_t fields)
{
  struct text *text = &store->xdmf;
  text_add(text,
           "      <Grid Name=\"frame %zu\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
           "        <Time Value=\"%.17g\"/>\n",
           store->frames, time);
  for (size_t i = 0; i < sets; ++i) {
    if (set[i].count > 0)
      add_body(text, &set[i], field, fields, store->frames);
  }
  text_add(text, "      </Grid>\n");
}

gamut_status xdmf_write(struct store *store, struct trace *trace)
{
  struct text whole = {0};
  gamut_status status;
  text_add(&whole, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                   "<Xdmf Version=\"2.0\">\n"
                   "  <Domain>\n"
                   "    <Grid Name=\"frames\" GridType=\"Collection\" "
                   "CollectionType=\"Temporal\">\n");
  text_add(&whole, "%s", store->xdmf.size ? store->xdmf.data : "");
  text_add(&whole, "    </Grid>\n  </Domain>\n</Xdmf>\n");
  if (whole.failed || store->xdmf.failed)
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
  else
    status = file_replace(store->folder, RESULT_XDMF, whole.data, whole.size, trace);
  free(whole.data);
  return status;
}
