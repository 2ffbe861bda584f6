#include "report/plot.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "report/report.h"
#include "store/file.h"
#include "tree/tree.h"

gamut_status plot_add(struct plot *plot, const char *name)
{
  if (plot->count == plot->room) {
    size_t room = 2 * plot->room + 8;
    char **names = realloc(plot->name, room * sizeof *names);
    if (!names)
      return trace_fail(plot->trace, GAMUT_INTERNAL, "out of memory");
    plot->name = names;
    plot->room = room;
  }
  plot->name[plot->count] = strdup(name);
  if (!plot->name[plot->count])
    return trace_fail(plot->trace, GAMUT_INTERNAL, "out of memory");
  ++plot->count;
  return GAMUT_OK;
}

FILE *plot_file(const struct plot *plot, const char *name, const char *end)
{
  char file[300];
  snprintf(file, sizeof file, "%s%s", name, end);
  char *path = file_path(plot->folder, file);
  int made = path ? file_create(path) : -1;
  FILE *opened = made >= 0 ? fdopen(made, "w") : NULL;
  if (!opened)
    trace_fail(plot->trace, GAMUT_OUTPUT, "cannot write '%s/%s': %s", plot->folder, file,
               strerror(errno));
  if (!opened && made >= 0)
    close(made);
  free(path);
  return opened;
}

gamut_status plot_file_close(const struct plot *plot, FILE *file, const char *name)
{
  errno = 0;
  bool failed = ferror(file) != 0;
  failed = fclose(file) != 0 || failed;
  if (!failed)
    return GAMUT_OK;
  return trace_fail(plot->trace, GAMUT_OUTPUT, "cannot write '%s/%s': %s", plot->folder, name,
                    errno ? strerror(errno) : "write error");
}

void plot_script(FILE *script, const char *name, int width, int height)
{
  fprintf(script,
          "reset\n"
          "set encoding utf8\n"
          "set terminal pngcairo noenhanced size %d,%d font 'Sans,13'\n"
          "set output '%s.png'\n"
          "set grid linetype 1 linewidth 0.7 linecolor rgb '#dddddd'\n"
          "set border linecolor rgb '#404040'\n"
          "set tics nomirror\n"
          "set datafile missing NaN\n",
          width, height, name);
}

void plot_text(FILE *script, const char *text)
{
  fputc('\'', script);
  for (; *text; ++text) {
    if (*text == '\'')
      fputc('\'', script);
    fputc((unsigned char)*text < ' ' ? ' ' : *text, script);
  }
  fputc('\'', script);
}

char *plot_label(const char *name, const char *unit, char *label, size_t size)
{
  if (*unit)
    snprintf(label, size, "%s [%s]", name, unit);
  else
    snprintf(label, size, "%s", name);
  return label;
}

char *plot_file_name(const char *start, const char *name, char *made, size_t size)
{
  snprintf(made, size, "%s%s", start, name);
  for (char *c = made; *c; ++c) {
    if (!isalnum((unsigned char)*c) && *c != '-' && *c != '_')
      *c = '_';
  }
  return made;
}

/* Title and symmetry are the scene's. Pictures can do without, so a scene that cannot be read is no
 * fault here. */
static void read_scene(struct plot *plot, const char *result)
{
  struct trace *unheard = trace_new();
  char *path = file_path(result, "scene.yaml");
  struct tree *scene = NULL;
  if (unheard && path && file_exists(path) &&
      tree_read(path, GAMUT_OUTPUT, unheard, &scene) == GAMUT_OK) {
    const struct tree *title = tree_get(scene, "title");
    const struct tree *geometry = tree_at(scene, "solver.geometry");
    plot->title = title && title->kind == TREE_SCALAR ? strdup(title->text) : NULL;
    plot->axisymmetric = geometry && strcmp(geometry->text, "axisymmetric") == 0;
  }
  if (!plot->title)
    plot->title = strdup(result);
  tree_free(scene);
  free(path);
  trace_free(unheard);
}

static gamut_status draw_body(struct plot *plot, const struct result *result,
                              const struct plot_options *options)
{
  struct result_frame *frame = NULL;
  size_t frames = result_frames(result);
  if (frames == 0) {
    if (options->field || options->frame >= 0)
      return trace_fail(plot->trace, GAMUT_USAGE, "the result has no frames");
    return GAMUT_OK;
  }
  if (options->frame >= (long)frames)
    return trace_fail(plot->trace, GAMUT_USAGE, "there is no frame %ld: the result has 0 to %zu",
                      options->frame, frames - 1);
  size_t number = options->frame < 0 ? frames - 1 : (size_t)options->frame;
  gamut_status status = result_frame_read(result, number, options->field, plot->trace, &frame);
  if (status == GAMUT_OK)
    status = plot_body(plot, frame, number);
  result_frame_free(frame);
  return status;
}

gamut_status report_plot(const char *folder, const struct plot_options *options,
                         struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct plot plot = {.trace = trace, .folder = options->folder};
  struct result *result = NULL;
  struct result_history *history = NULL;
  size_t histories = 0;
  char *inside = file_path(folder, "pictures");
  TRY(result_open(folder, trace, &result));
  TRY(result_histories(result, trace, &history, &histories));
  read_scene(&plot, folder);
  if (!plot.folder)
    plot.folder = inside;
  if (!inside || !plot.title) {
    status = trace_fail(trace, GAMUT_INTERNAL, "out of memory");
    goto done;
  }
  /* the name of the folder inside is ours: no link that waits there is followed */
  TRY(plot.folder == inside ? folder_make_inside(inside, trace) : folder_make(plot.folder, trace));
  TRY(draw_body(&plot, result, options));
  TRY(plot_histories(&plot, history, histories));
  if (plot.count == 0)
    status = trace_fail(trace, GAMUT_OUTPUT, "'%s' holds neither frames nor histories", folder);
  else
    status = plot_run(&plot);
  for (size_t i = 0; i < plot.count && status == GAMUT_OK; ++i)
    printf("%s/%s.png\n", plot.folder, plot.name[i]);
done:
  for (size_t i = 0; i < plot.count; ++i)
    free(plot.name[i]);
  free(plot.name);
  free(plot.title);
  free(inside);
  result_histories_free(history, histories);
  result_close(result);
  return status;
}
