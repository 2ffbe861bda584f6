#include <string.h>

#include <yaml.h>

#include "tree/tree.h"

static int write_bytes(void *stream, unsigned char *bytes, size_t size)
{
  return fwrite(bytes, 1, size, stream) == size;
}

/* The emitter writes plain text plain where YAML allows it, and in quotes elsewhere. */
static bool emit_text(yaml_emitter_t *emitter, const char *text, bool quoted)
{
  yaml_event_t event;
  yaml_scalar_style_t style = quoted ? YAML_DOUBLE_QUOTED_SCALAR_STYLE : YAML_PLAIN_SCALAR_STYLE;
  return yaml_scalar_event_initialize(&event, NULL, NULL, (const yaml_char_t *)text,
                                      (int)strlen(text), 1, 1, style) &&
         yaml_emitter_emit(emitter, &event);
}

static bool emit_node(yaml_emitter_t *emitter, const struct tree *tree)
{
  if (tree->kind == TREE_SCALAR)
    return emit_text(emitter, tree->text, tree->quoted);
  yaml_event_t event;
  bool mapping = tree->kind == TREE_MAPPING;
  bool good =
      mapping
          ? yaml_mapping_start_event_initialize(&event, NULL, NULL, 1, YAML_BLOCK_MAPPING_STYLE)
          : yaml_sequence_start_event_initialize(&event, NULL, NULL, 1, YAML_BLOCK_SEQUENCE_STYLE);
  good = good && yaml_emitter_emit(emitter, &event);
  for (size_t k = 0; good && k < tree->children; k++) {
    if (mapping)
      good = emit_text(emitter, tree->child[k]->key, false);
    good = good && emit_node(emitter, tree->child[k]);
  }
  good = good && (mapping ? yaml_mapping_end_event_initialize(&event)
                          : yaml_sequence_end_event_initialize(&event));
  return good && yaml_emitter_emit(emitter, &event);
}

void tree_write(const struct tree *tree, FILE *stream)
{
  yaml_emitter_t emitter;
  yaml_event_t event;
  if (!yaml_emitter_initialize(&emitter))
    return;
  yaml_emitter_set_output(&emitter, write_bytes, stream);
  yaml_emitter_set_unicode(&emitter, 1);
  yaml_emitter_set_width(&emitter, -1);
  bool good = yaml_stream_start_event_initialize(&event, YAML_UTF8_ENCODING) &&
              yaml_emitter_emit(&emitter, &event) &&
              yaml_document_start_event_initialize(&event, NULL, NULL, NULL, 1) &&
              yaml_emitter_emit(&emitter, &event) && emit_node(&emitter, tree) &&
              yaml_document_end_event_initialize(&event, 1) &&
              yaml_emitter_emit(&emitter, &event) && yaml_stream_end_event_initialize(&event) &&
              yaml_emitter_emit(&emitter, &event);
  (void)good; /* a failure to write shows in ferror(stream), which is the caller's to ask */
  yaml_emitter_delete(&emitter);
}
