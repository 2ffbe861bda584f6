/* What `gamut run` was asked for. */
#ifndef GAMUT_COMMAND_RUN_H
#define GAMUT_COMMAND_RUN_H

#include <signal.h>

#include "command/options.h"
#include "study/study.h"

struct run_arguments {
  const char *file, *folder;
  struct option_texts set;
  int threads;
  bool force, json, resume, retry_failed;
  const volatile sig_atomic_t *stop;
};

/* command_study.c: a scene with an estimator. */
gamut_status run_study(struct command *, const struct run_arguments *, struct scene *);

#endif
