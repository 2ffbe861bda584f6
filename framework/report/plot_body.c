#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/body_points.h"
#include "report/plot.h"
#include "report/readable.h"

/* Dark blue over green to yellow: grows steadily in brightness, also in print and to the
 * colour-blind. */
static const char palette[] = "set palette defined (0 '#440154', 1 '#46327e', 2 '#365c8d', "
                              "3 '#277f8e', 4 '#1fa187', 5 '#4ac16d', 6 '#a0da39', 7 '#fde725')\n";
static const char *const axis_name[] = {"x", "y", "z"};

struct drawing {
  struct plot *plot;
  const struct result_frame *frame;
  struct cloud *cloud; /* one a body */
  struct view view;
  double lower[2], upper[2];
  double least, most; /* of the values */
  char name[256];
};

static gamut_status make_clouds(struct drawing *d)
{
  d->cloud = calloc(d->frame->bodies + 1, sizeof *d->cloud);
  for (size_t b = 0; d->cloud && b < d->frame->bodies; ++b) {
    if (!cloud_make(&d->frame->body[b], &d->view, &d->cloud[b]))
      return trace_fail(d->plot->trace, GAMUT_INTERNAL, "out of memory");
    for (int k = 0; k < 2; ++k) {
      d->lower[k] = fmin(d->lower[k], d->cloud[b].lower[k]);
      d->upper[k] = fmax(d->upper[k], d->cloud[b].upper[k]);
    }
    for (size_t i = 0; i < d->cloud[b].count; ++i) {
      double value = d->cloud[b].disc[i].value;
      if (isfinite(value)) {
        d->least = fmin(d->least, value);
        d->most = fmax(d->most, value);
      }
    }
  }
  if (d->plot->axisymmetric)
    d->lower[0] = -d->upper[0];
  return d->cloud ? GAMUT_OK : trace_fail(d->plot->trace, GAMUT_INTERNAL, "out of memory");
}

/* One block of lines a body, so that each can be drawn by `index`. */
static gamut_status write_data(const struct drawing *d)
{
  FILE *data = plot_file(d->plot, d->name, ".dat");
  if (!data)
    return GAMUT_OUTPUT;
  fprintf(data, "# %s [m]  %s [m]  radius [m]  %s [%s]\n", axis_name[d->view.x],
          axis_name[d->view.y], d->frame->field ? d->frame->field : "no field",
          d->frame->unit ? d->frame->unit : "1");
  for (size_t b = 0; b < d->frame->bodies; ++b) {
    fprintf(data, "%s# %s\n", b ? "\n\n" : "", d->frame->body[b].name);
    for (size_t i = 0; i < d->cloud[b].count; ++i) {
      const struct disc *t = &d->cloud[b].disc[i];
      fprintf(data, "%.7g %.7g %.4g %.7g\n", t->x, t->y, t->radius, t->value);
    }
  }
  return plot_file_close(d->plot, data, d->name);
}

static void write_title(const struct drawing *d, FILE *script)
{
  char time[48], title[512];
  snprintf(title, sizeof title, "%s, t = %s", d->plot->title,
           readable(d->frame->time, "s", time, sizeof time));
  fprintf(script, "set title ");
  plot_text(script, title);
  fputc('\n', script);
}

/* "stress, von Mises" */
static void field_name(const struct result_frame *frame, char *name, size_t size)
{
  snprintf(name, size, "%s%s%s", frame->field ? frame->field : "", frame->reduced ? ", " : "",
           frame->reduced ? frame->reduced : "");
}

/* Sets up the colour bar, where there is a value; returns the factor to its unit. */
static double write_colours(const struct drawing *d, FILE *script)
{
  char unit[40], name[160], label[200];
  if (!(d->least <= d->most) || !d->frame->field) {
    fprintf(script, "unset colorbox\n");
    return 1;
  }
  double factor = readable_unit(fmax(fabs(d->least), fabs(d->most)),
                                d->frame->unit ? d->frame->unit : "1", unit, sizeof unit);
  double low = d->least * factor, high = d->most * factor;
  double margin = high - low > 1e-9 * fmax(fabs(low), fabs(high)) ? 0 : fmax(fabs(low), 1) * 0.5;
  fprintf(script,
          "%sset format cb '%%g'\nset cbrange [%.6g:%.6g]\n"
          "set cblabel ",
          palette, low - margin, high + margin);
  field_name(d->frame, name, sizeof name);
  plot_text(script, plot_label(name, unit, label, sizeof label));
  fprintf(script, " offset 2,0\n");
  return factor;
}

static void write_discs(const struct drawing *d, FILE *script, double length, double factor)
{
  const char *lead = "plot";
  for (size_t b = 0; b < d->frame->bodies; ++b) {
    if (d->cloud[b].count == 0)
      continue;
    for (int side = 1; side >= (d->plot->axisymmetric ? -1 : 1); side -= 2) {
      fprintf(script, "%s '%s.dat' index %zu using (%d*$1*%g):($2*%g):($3*%g)", lead, d->name, b,
              side, length, length, length);
      if (d->frame->body[b].value)
        fprintf(script, ":($4*%g) with circles fillstyle solid 1.0 noborder linecolor palette",
                factor);
      else
        fprintf(script, " with circles fillstyle solid 1.0 noborder linecolor rgb '#b0b0b0'");
      fprintf(script, " notitle");
      lead = ", \\\n    ";
    }
  }
  fputc('\n', script);
}

static void write_axes(const struct drawing *d, FILE *script, double length, const char *unit)
{
  char label[64];
  double low[2], high[2], margin = 0;
  for (int k = 0; k < 2; ++k)
    margin = fmax(margin, 0.04 * length * (d->upper[k] - d->lower[k]));
  for (int k = 0; k < 2; ++k) {
    low[k] = length * d->lower[k] - margin;
    high[k] = length * d->upper[k] + margin;
  }
  fprintf(script, "set size ratio -1\nset xrange [%.6g:%.6g]\nset yrange [%.6g:%.6g]\n", low[0],
          high[0], low[1], high[1]);
  fprintf(script, "set xlabel ");
  plot_text(script, plot_label(d->plot->axisymmetric ? "r" : axis_name[d->view.x], unit, label,
                               sizeof label));
  fprintf(script, "\nset ylabel ");
  plot_text(script, plot_label(axis_name[d->view.y], unit, label, sizeof label));
  fprintf(script, "\nset xtics autofreq\n");
}

static gamut_status write_plane(struct drawing *d)
{
  char unit[40];
  double width = d->upper[0] - d->lower[0], height = d->upper[1] - d->lower[1];
  double size =
      fmax(fmax(fabs(d->lower[0]), fabs(d->upper[0])), fmax(fabs(d->lower[1]), fabs(d->upper[1])));
  double length = readable_unit(size, "m", unit, sizeof unit);
  double shape = height > 0 ? fmin(fmax(width / height, 0.3), 4) : 4;
  FILE *script = plot_file(d->plot, d->name, ".gp");
  if (!script)
    return GAMUT_OUTPUT;
  /* the body takes about 850 pixels along its longer side; the rest is for labels and colour bar */
  plot_script(script, d->name, (int)fmax(900, (shape < 1 ? 850 * shape : 850) + 340),
              (int)fmax(500, (shape < 1 ? 850 : 850 / shape) + 150));
  write_title(d, script);
  write_axes(d, script, length, unit);
  double factor = write_colours(d, script);
  write_discs(d, script, length, factor);
  fprintf(script, "unset output\n");
  return plot_file_close(d->plot, script, d->name);
}

/* A body in one dimension: the field over x. */
static gamut_status write_line(struct drawing *d)
{
  char unit[40], field_unit[40], label[200];
  char field[160];
  double length = readable_unit(fmax(fabs(d->lower[0]), fabs(d->upper[0])), "m", unit, sizeof unit);
  double factor =
      readable_unit(fmax(fabs(d->least), fabs(d->most)), d->frame->unit ? d->frame->unit : "1",
                    field_unit, sizeof field_unit);
  const char *lead = "plot";
  FILE *script = plot_file(d->plot, d->name, ".gp");
  field_name(d->frame, field, sizeof field);
  if (!script)
    return GAMUT_OUTPUT;
  plot_script(script, d->name, 1200, 800);
  write_title(d, script);
  fprintf(script, "set xlabel ");
  plot_text(script, plot_label("x", unit, label, sizeof label));
  fprintf(script, "\nset ylabel ");
  plot_text(script, plot_label(field, field_unit, label, sizeof label));
  fprintf(script, "\nset offsets graph 0.02, graph 0.02, graph 0.05, graph 0.05\n");
  for (size_t b = 0; b < d->frame->bodies; ++b) {
    if (!d->frame->body[b].value || d->cloud[b].count == 0)
      continue;
    fprintf(script,
            "%s '%s.dat' index %zu using ($1*%g):($4*%g) with points pointtype 7 "
            "pointsize 0.8 title ",
            lead, d->name, b, length, factor);
    plot_text(script, d->frame->body[b].name);
    lead = ", \\\n    ";
  }
  fprintf(script, "\nunset output\n");
  return plot_file_close(d->plot, script, d->name);
}

gamut_status plot_body(struct plot *plot, const struct result_frame *frame, size_t number)
{
  gamut_status status = GAMUT_OK;
  struct drawing d = {.plot = plot,
                      .frame = frame,
                      .view = view_of(frame),
                      .lower = {INFINITY, INFINITY},
                      .upper = {-INFINITY, -INFINITY},
                      .least = INFINITY,
                      .most = -INFINITY};
  char end[32];
  int axes = 1;
  for (size_t b = 0; b < frame->bodies; ++b)
    axes = frame->body[b].axes > axes ? frame->body[b].axes : axes;
  plot_file_name("body_", frame->field ? frame->field : "points", d.name, sizeof d.name - 16);
  snprintf(end, sizeof end, "_%08zu", number);
  snprintf(d.name + strlen(d.name), sizeof d.name - strlen(d.name), "%s", end);
  TRY(make_clouds(&d));
  if (!(d.lower[0] <= d.upper[0]) || (axes == 1 && !(d.least <= d.most)))
    goto done; /* nothing to see: no point, or no value over a line */
  TRY(write_data(&d));
  TRY(axes == 1 ? write_line(&d) : write_plane(&d));
  status = plot_add(plot, d.name);
done:
  for (size_t b = 0; d.cloud && b < frame->bodies; ++b)
    cloud_free(&d.cloud[b]);
  free(d.cloud);
  return status;
}
