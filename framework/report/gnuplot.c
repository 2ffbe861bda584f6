#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "report/plot.h"
#include "store/file.h"

enum { EXIT_NOT_FOUND = 127, EXIT_NO_FOLDER = 126 };

/* In the folder of the pictures, since the scripts name their files without one. */
static void run_gnuplot(const char *folder, char *const *arguments)
{
  int log;
  if (chdir(folder) != 0 || (log = file_create("gnuplot.log")) < 0)
    _exit(EXIT_NO_FOLDER);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execvp(arguments[0], arguments);
  _exit(EXIT_NOT_FOUND);
}

static void free_arguments(char **arguments)
{
  for (size_t i = 0; arguments && arguments[i]; ++i)
    free(arguments[i]);
  free(arguments);
}

/* "gnuplot A.gp B.gp": arguments in one allocation of pointers, each string its own. */
static char **script_arguments(const struct plot *plot)
{
  char **arguments = calloc(plot->count + 2, sizeof *arguments);
  bool good = arguments && (arguments[0] = strdup("gnuplot"));
  for (size_t i = 0; good && i < plot->count; ++i) {
    size_t size = strlen(plot->name[i]) + sizeof ".gp";
    good = (arguments[i + 1] = malloc(size)) != NULL;
    if (good)
      snprintf(arguments[i + 1], size, "%s.gp", plot->name[i]);
  }
  if (!good)
    free_arguments(arguments);
  return good ? arguments : NULL;
}

static gamut_status judge(const struct plot *plot, int status)
{
  char *log = file_path(plot->folder, "gnuplot.log");
  if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_NOT_FOUND) {
    if (log)
      unlink(log);
    free(log);
    return trace_fail_at(plot->trace, GAMUT_OUTPUT, NULL, NULL,
                         "install gnuplot (Debian: apt-get install gnuplot-nox) and call again",
                         "no pictures: gnuplot was not found; data and scripts are in '%s'",
                         plot->folder);
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    free(log);
    return trace_fail(plot->trace, GAMUT_OUTPUT, "gnuplot failed; see '%s/gnuplot.log'",
                      plot->folder);
  }
  if (log)
    unlink(log);
  free(log);
  return GAMUT_OK;
}

/* gnuplot would write through a link that has a picture's name. */
static gamut_status clear_names(const struct plot *plot)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < plot->count && status == GAMUT_OK; ++i) {
    char file[300];
    snprintf(file, sizeof file, "%s.png", plot->name[i]);
    char *path = file_path(plot->folder, file);
    status = path ? file_remove(path, plot->trace)
                  : trace_fail(plot->trace, GAMUT_INTERNAL, "out of memory");
    free(path);
  }
  return status;
}

gamut_status plot_run(const struct plot *plot)
{
  gamut_status status = clear_names(plot);
  if (status != GAMUT_OK)
    return status;
  char **arguments = script_arguments(plot);
  int result = 0;
  pid_t child = arguments ? fork() : -1;
  if (child == 0)
    run_gnuplot(plot->folder, arguments);
  if (child > 0) {
    while (waitpid(child, &result, 0) < 0 && errno == EINTR)
      continue;
  }
  free_arguments(arguments);
  if (child < 0)
    return trace_fail(plot->trace, GAMUT_INTERNAL, "cannot start gnuplot: %s", strerror(errno));
  return judge(plot, result);
}
