/* The solver's private state as bytes; see GAMUT_SOLVER_OPS. */
#ifndef MATERIAL_POINT_METHOD_RESTART_H
#define MATERIAL_POINT_METHOD_RESTART_H

#include <gamut/host.h>

size_t model_save(const void *self, void *bytes);
gamut_status model_restore(void *self, const void *bytes, size_t size);

#endif
