/* For programs that embed the library: run scenes and read what came out.
 *
 *   struct gamut_session *session = gamut_session_new(NULL);
 *   char *summary = NULL;
 *   struct gamut_run_request request = {0};
 *   if (gamut_run_scene(session, "inputs/taylor_bar.yaml", &request, &summary))
 *     fputs(gamut_messages(session), stderr);
 *   gamut_free(summary);
 *   gamut_session_free(session);
 *
 * Link with `pkg-config --cflags --libs gamut`. A session is for one thread at a time; several
 * sessions may live and run at once, each in a thread of its own: what they share is locked inside.
 * A null session, scene or `set` is refused with GAMUT_USAGE and a message; a null request is one
 * that is all zero; a null summary is one that nobody wants.
 *
 * Where memory ends a call fails with GAMUT_INTERNAL where it can. Deep in the reading of a scene
 * or in formulas it cannot: there it is abort(), and inside of HDF5, UDUNITS and muParser whatever
 * they do then. A program that must outlive that runs gamut in a process of its own. */
#ifndef GAMUT_GAMUT_H
#define GAMUT_GAMUT_H

#include <stddef.h>

#include <gamut/status.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define GAMUT_API __attribute__((visibility("default")))
#else
#define GAMUT_API
#endif

/* "0.1.0". */
GAMUT_API const char *gamut_version(void);

/* Unit database, registry of plugins, messages. plugin_path: absolute folders to look in first,
 * separated by ':', or null. Null if there is no memory or no unit database. What is wrong with
 * folders of plugins, which are then skipped, gamut_messages lists until the next call. */
struct gamut_session;
GAMUT_API struct gamut_session *gamut_session_new(const char *plugin_path);
GAMUT_API void gamut_session_free(struct gamut_session *); /* accepts null */

/* All zero: the scene as it is, all processors, nothing written. */
struct gamut_run_request {
  const char *const *set; /* "solver.cell=0.2 mm", as --set of the command; borrowed */
  size_t sets;
  int threads;            /* 0: what OpenMP says */
  const char *folder;     /* of the results, or null: nothing is written */
  int force;              /* whether results in that folder may be replaced */
};

/* Runs a scene, or the study that it asks for. *summary becomes the text of summary.json, to be
 * given to gamut_free; it is set also where the numbers failed on the way (GAMUT_NUMERICS), null
 * where nothing was run. Returns the status whose number is the exit code of `gamut run`. */
GAMUT_API gamut_status gamut_run_scene(struct gamut_session *, const char *scene,
                                       const struct gamut_run_request *, char **summary);
/* What is known of a scene before its first step, as `gamut check`; runs nothing. */
GAMUT_API gamut_status gamut_check_scene(struct gamut_session *, const char *scene,
                                         const struct gamut_run_request *);

/* Errors and warnings of the last call, for people. Borrowed until the next call of the session. */
GAMUT_API const char *gamut_messages(const struct gamut_session *);

GAMUT_API void gamut_free(void *);

#ifdef __cplusplus
}
#endif
#endif
