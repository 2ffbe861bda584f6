#include "tree/problem.h"
#include "base/array.h"

#include <string.h>

struct wording {
  const char *problem, *context; /* as libyaml says it; null context: any */
  const char *words, *advice;
  bool opened; /* whether the place where the thing began helps */
};

static const struct wording wordings[] = {
    {"did not find expected key", NULL, "this does not fit the lines above it",
     "check the indentation: keys of one level begin in the same column", false},
    {"did not find expected '-' indicator", NULL, "this does not fit the list above it",
     "check the indentation: each item of a list begins with '- ' in the same column", false},
    {"could not find expected ':'", NULL, "a key without ': ' behind it",
     "write 'key: value'; text with ': ' in it needs quotes", true},
    {"mapping values are not allowed in this context", NULL, "a ': ' is not allowed here",
     "check the indentation, or put the text in quotes", false},
    {"block sequence entries are not allowed in this context", NULL, "a '- ' is not allowed here",
     "begin the list on the next line", false},
    {"did not find expected ',' or ']'", NULL, "a ',' is missing or a '[' is not closed",
     "lists are written [a, b, c]", true},
    {"did not find expected ',' or '}'", NULL, "a ',' is missing or a '{' is not closed",
     "mappings are written {a: 1, b: 2}", true},
    {"found unexpected end of stream", "while scanning a quoted scalar", "quotes are not closed",
     "close the quotes", true},
    {"found unexpected document indicator", "while scanning a quoted scalar",
     "quotes are not closed", "close the quotes", true},
    {"found unknown escape character", NULL, "an unknown '\\' in text in double quotes",
     "use single quotes for text with '\\'", false},
    {"found character that cannot start any token", NULL,
     "a value cannot begin with this character",
     "indent with blanks, not tabs; put text that begins with % @ or ` in quotes", false},
    {"found a tab character that violates indentation", NULL, "a tab in the indentation",
     "indent with blanks", false},
    {"found a tab character where an indentation space is expected", NULL,
     "a tab in the indentation", "indent with blanks", false},
    {"did not find expected <document start>", NULL, "text behind the end of the document",
     "check the indentation: the first key sets the column of all keys of the first level", false},
    {"did not find expected node content", NULL, "a value or a closing bracket is missing here",
     "text with , [ ] { } in it needs quotes", false},
    {"did not find expected alphabetic or numeric character", NULL,
     "a name is missing behind '*' or '&'", "text that begins with * or & needs quotes", false},
    {"exceeded max depth", NULL, "nested too deep", NULL, false},
};

static const struct wording *wording_of(const yaml_parser_t *parser)
{
  for (size_t k = 0; k < ARRAY_SIZE(wordings); k++)
    if (strcmp(parser->problem, wordings[k].problem) == 0 &&
        (wordings[k].context == NULL ||
         (parser->context != NULL && strcmp(parser->context, wordings[k].context) == 0)))
      return &wordings[k];
  return NULL;
}

gamut_status problem_report(const yaml_parser_t *parser, const struct origin *origin,
                            gamut_status blame, struct trace *trace)
{
  if (parser->error == YAML_MEMORY_ERROR)
    return trace_fail(trace, GAMUT_INTERNAL, "no memory left to read '%s'", origin->name);
  if (parser->problem == NULL || parser->error == YAML_READER_ERROR) {
    struct place file = origin_place(origin, 0, 0, 1);
    return trace_fail_at(trace, blame, &file, NULL, NULL, "this is no YAML text: %s",
                         parser->problem != NULL ? parser->problem : "unknown reason");
  }
  struct place place =
      origin_place(origin, parser->problem_mark.line + 1, parser->problem_mark.column + 1, 1);
  const struct wording *wording = wording_of(parser);
  if (wording == NULL)
    return trace_fail_at(trace, blame, &place, NULL, NULL, "this YAML cannot be read: %s%s%s",
                         parser->problem, parser->context != NULL ? ", " : "",
                         parser->context != NULL ? parser->context : "");
  if (wording->opened && parser->context != NULL)
    return trace_fail_at(trace, blame, &place, NULL, wording->advice, "%s (it begins at %zu:%zu)",
                         wording->words, parser->context_mark.line + 1,
                         parser->context_mark.column + 1);
  return trace_fail_at(trace, blame, &place, NULL, wording->advice, "%s", wording->words);
}
