/* The bar's private state as bytes; see GAMUT_SOLVER_OPS. */
#ifndef GAMUT_BAR_RESTART_H
#define GAMUT_BAR_RESTART_H

#include <gamut/host.h>

size_t bar_save(const void *self, void *bytes);
gamut_status bar_restore(void *self, const void *bytes, size_t size);

#endif
