/* What libyaml did not understand, in plain words. */
#ifndef GAMUT_TREE_PROBLEM_H
#define GAMUT_TREE_PROBLEM_H

#include <yaml.h>

#include "tree/tree_private.h"

/* Records the parser's error at its place and returns `blame`. */
gamut_status problem_report(const yaml_parser_t *, const struct origin *, gamut_status blame,
                            struct trace *);

#endif
