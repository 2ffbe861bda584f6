#include <math.h>
#include <string.h>

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

/* The curves of one picture follow one another: those of the points of one quantity. */
static size_t curves_from(const struct result_history *history, size_t count)
{
  size_t curves = 1;
  while (curves < count && history->family && history[curves].family &&
         strcmp(history->family, history[curves].family) == 0)
    ++curves;
  return curves;
}

static const char *picture_of(const struct result_history *history, char *name, size_t size)
{
  return plot_file_name("history_", history->family ? history->family : history->name, name, size);
}

/* One curve is blue; of several the first is blue and the last red. */
static void write_line(FILE *script, const struct result_history *history, size_t number,
                       size_t curves, double axis, double factor)
{
  char name[256];
  const double part = curves > 1 ? (double)number / (double)(curves - 1) : 0.0;
  const int red = 0x1f + (int)(part * (0xc8 - 0x1f)), green = 0x5f + (int)(part * (0x30 - 0x5f)),
            blue = 0xa8 + (int)(part * (0x30 - 0xa8));
  plot_file_name("history_", history->name, name, sizeof name);
  if (history->deviation)
    fprintf(script,
            "'%s.dat' using ($1*%g):(($2-$3)*%g):(($2+$3)*%g) with filledcurves "
            "linecolor rgb '#c8d9ec' title 'mean +- one standard deviation', ",
            name, axis, factor, factor);
  fprintf(script,
          "'%s.dat' using ($1*%g):($2*%g) with lines linewidth 2 linecolor rgb "
          "'#%02x%02x%02x' ",
          name, axis, factor, red, green, blue);
  if (curves > 1 && (number == 0 || number + 1 == curves || curves <= 12)) {
    fprintf(script, "title ");
    plot_text(script, history->label ? history->label : history->name);
  } else {
    fprintf(script, "notitle");
  }
}

static void write_curves(FILE *script, const struct result_history *history, size_t curves)
{
  char unit[40], label[200];
  double most = 0.0, axis_most = 0.0;
  bool first = true;
  for (size_t i = 0; i < curves; ++i) {
    most = fmax(most, largest(history[i].value, history[i].count));
    axis_most = fmax(axis_most, largest(history[i].time, history[i].count));
  }
  double axis = readable_unit(axis_most, history->axis_unit, unit, sizeof unit);
  fprintf(script, "set xlabel ");
  plot_text(script, plot_label(history->axis, unit, label, sizeof label));
  double factor = readable_unit(most, history->unit, unit, sizeof unit);
  const char *name = history->family ? history->family : history->name;
  fprintf(script, "\nset ylabel ");
  plot_text(script, plot_label(name, unit, label, sizeof label));
  fprintf(script, "\nset key %s\nplot ", curves > 1 ? "outside right" : "inside");
  for (size_t i = 0; i < curves; ++i) {
    if (!drawable(&history[i]))
      continue;
    fprintf(script, "%s", first ? "" : ", ");
    write_line(script, &history[i], i, curves, axis, factor);
    first = false;
  }
  fprintf(script, "\n");
}

static gamut_status write_picture(struct plot *plot, const struct result_history *history,
                                  size_t curves)
{
  gamut_status status = GAMUT_OK;
  char name[256];
  for (size_t i = 0; i < curves; ++i)
    if (drawable(&history[i]))
      TRY(write_data(plot, &history[i],
                     plot_file_name("history_", history[i].name, name, sizeof name)));
  picture_of(history, name, sizeof name);
  FILE *script = plot_file(plot, name, ".gp");
  if (!script)
    return GAMUT_OUTPUT;
  plot_script(script, name, WIDTH, HEIGHT);
  fprintf(script, "set title ");
  plot_text(script, plot->title);
  fputc('\n', script);
  write_curves(script, history, curves);
  fprintf(script, "unset output\n");
  TRY(plot_file_close(plot, script, name));
  status = plot_add(plot, name);
done:
  return status;
}

static bool any_drawable(const struct result_history *history, size_t curves)
{
  for (size_t i = 0; i < curves; ++i)
    if (drawable(&history[i]))
      return true;
  return false;
}

/* All of them, two in a row. */
static gamut_status write_combined(struct plot *plot, const struct result_history *history,
                                   size_t count, size_t drawn)
{
  static const char name[] = "history";
  FILE *script = plot_file(plot, name, ".gp");
  if (!script)
    return GAMUT_OUTPUT;
  size_t rows = (drawn + 1) / 2;
  plot_script(script, name, WIDTH, rows > 2 ? (int)rows * HEIGHT / 2 : HEIGHT);
  fprintf(script, "set multiplot layout %zu,%d title ", rows, drawn > 1 ? 2 : 1);
  plot_text(script, plot->title);
  fputc('\n', script);
  for (size_t i = 0, curves; i < count; i += curves) {
    curves = curves_from(&history[i], count - i);
    if (any_drawable(&history[i], curves))
      write_curves(script, &history[i], curves);
  }
  fprintf(script, "unset multiplot\nunset output\n");
  gamut_status status = plot_file_close(plot, script, name);
  return status == GAMUT_OK ? plot_add(plot, name) : status;
}

gamut_status plot_histories(struct plot *plot, const struct result_history *history, size_t count)
{
  gamut_status status = GAMUT_OK;
  size_t drawn = 0;
  for (size_t i = 0, curves; i < count; i += curves) {
    curves = curves_from(&history[i], count - i);
    if (!any_drawable(&history[i], curves))
      continue;
    ++drawn;
    TRY(write_picture(plot, &history[i], curves));
  }
  if (drawn > 0)
    status = write_combined(plot, history, count, drawn);
done:
  return status;
}
