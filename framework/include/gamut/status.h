/* Status codes: one list gives the enumeration, the texts and the exit codes of the command. */
#ifndef GAMUT_STATUS_H
#define GAMUT_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

/* X(name, exit code, text). The exit code is what `gamut` returns to the shell. */
#define GAMUT_STATUS_LIST(X)                                                                       \
  X(GAMUT_OK, 0, "done")                                                                           \
  X(GAMUT_INTERNAL, 1, "internal fault")                                                           \
  X(GAMUT_USAGE, 2, "wrong command line")                                                          \
  X(GAMUT_SCENE, 3, "the scene is wrong or cannot be read")                                        \
  X(GAMUT_PLUGIN, 4, "a plugin is wrong or missing")                                               \
  X(GAMUT_NUMERICS, 5, "the numbers failed")                                                       \
  X(GAMUT_TARGET, 6, "a target was not met or a difference was found")                             \
  X(GAMUT_OUTPUT, 7, "reading or writing results failed")                                          \
  X(GAMUT_STOPPED, 75, "stopped early with a checkpoint; --resume goes on")

typedef enum gamut_status {
#define GAMUT_STATUS_ENTRY(name, code, text) name = code,
  GAMUT_STATUS_LIST(GAMUT_STATUS_ENTRY)
#undef GAMUT_STATUS_ENTRY
} gamut_status;

#ifdef __cplusplus
}
#endif
#endif
