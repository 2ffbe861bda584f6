/* The record of a scene's files for summaries. */
#ifndef GAMUT_INPUT_FILES_H
#define GAMUT_INPUT_FILES_H

#include <jansson.h>

#include "scene/scene.h"

/* [{"key": "materials.metal.eos.curve.file", "file": "curve.csv", "digest": "..."}] */
json_t *input_files_json(const struct scene *);

#endif
