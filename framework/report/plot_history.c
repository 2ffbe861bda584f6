#include <math.h>

#include "report/plot.h"
#include "report/readable.h"

enum { WIDTH = 1200, HEIGHT = 800 };

static double largest(const double *value, size_t count)
{
  double most = 0;
  for (size_t i = 0; i < count; ++i) {
    if (isfinite(value[i]))
      most = fmax(most, fabs(value[i]));
  }
  return most;
}

/* gnuplot stops at a curve without a point. */
static bool drawable(const struct result_history *history)
{
  size_t finite = 0;
  for (size_t i = 0; i < history->count; ++i)
    finite += isfinite(history->value[i]) && isfinite(history->time[i]);
  return finite > 1;
}

static gamut_status write_data(const struct plot *plot, const struct result_history *history,
                               const char *name)
{
  FILE *data = plot_file(plot, name, ".dat");
  if (!data)
    return GAMUT_OUTPUT;
  fprintf(data, "# %s [%s]  %s [%s]%s\n", history->axis, history->axis_unit, history->name,
          history->unit, history->deviation ? ": mean, standard deviation" : "");
  for (size_t i = 0; i < history->count; ++i) {
    fprintf(data, "%.10g %.10g", history->time[i], history->value[i]);
    if (history->deviation)
      fprintf(data, " %.10g", history->deviation[i]);
    fputc('\n', data);
  }
  return plot_file_close(plot, data, name);
}

static void write_curve(FILE *script, const struct result_history *history, const char *name)
{
  char unit[40], label[200];
  double axis =
      readable_unit(largest(history->time, history->count), history->axis_unit, unit, sizeof unit);
  fprintf(script, "set xlabel ");
  plot_text(script, plot_label(history->axis, unit, label, sizeof label));
  double factor =
      readable_unit(largest(history->value, history->count), history->unit, unit, sizeof unit);
  fprintf(script, "\nset ylabel ");
  plot_text(script, plot_label(history->name, unit, label, sizeof label));
  fprintf(script, "\nplot ");
  if (history->deviation)
    fprintf(script,
            "'%s.dat' using ($1*%g):(($2-$3)*%g):(($2+$3)*%g) with filledcurves "
            "linecolor rgb '#c8d9ec' title 'mean +- one standard deviation', ",
            name, axis, factor, factor);
  fprintf(script,
          "'%s.dat' using ($1*%g):($2*%g) with lines linewidth 2 linecolor rgb '#1f5fa8' "
          "notitle\n",
          name, axis, factor);
}

static gamut_status write_single(struct plot *plot, const struct result_history *history,
                                 const char *name)
{
  gamut_status status = write_data(plot, history, name);
  FILE *script = status == GAMUT_OK ? plot_file(plot, name, ".gp") : NULL;
  if (!script)
    return GAMUT_OUTPUT;
  plot_script(script, name, WIDTH, HEIGHT);
  fprintf(script, "set title ");
  plot_text(script, plot->title);
  fputc('\n', script);
  write_curve(script, history, name);
  fprintf(script, "unset output\n");
  status = plot_file_close(plot, script, name);
  return status == GAMUT_OK ? plot_add(plot, name) : status;
}

/* All of them, two in a row. */
static gamut_status write_combined(struct plot *plot, const struct result_history *history,
                                   size_t count, size_t drawn)
{
  static const char name[] = "history";
  char part[256];
  FILE *script = plot_file(plot, name, ".gp");
  if (!script)
    return GAMUT_OUTPUT;
  size_t rows = (drawn + 1) / 2;
  plot_script(script, name, WIDTH, rows > 2 ? (int)rows * HEIGHT / 2 : HEIGHT);
  fprintf(script, "set multiplot layout %zu,%d title ", rows, drawn > 1 ? 2 : 1);
  plot_text(script, plot->title);
  fputc('\n', script);
  for (size_t i = 0; i < count; ++i) {
    if (drawable(&history[i]))
      write_curve(script, &history[i],
                  plot_file_name("history_", history[i].name, part, sizeof part));
  }
  fprintf(script, "unset multiplot\nunset output\n");
  gamut_status status = plot_file_close(plot, script, name);
  return status == GAMUT_OK ? plot_add(plot, name) : status;
}

gamut_status plot_histories(struct plot *plot, const struct result_history *history, size_t count)
{
  gamut_status status = GAMUT_OK;
  char name[256];
  size_t drawn = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!drawable(&history[i]))
      continue;
    ++drawn;
    TRY(write_single(plot, &history[i],
                     plot_file_name("history_", history[i].name, name, sizeof name)));
  }
  if (drawn > 0)
    status = write_combined(plot, history, count, drawn);
done:
  return status;
}
