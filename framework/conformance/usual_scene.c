/* The scene in which an effect is tried that brings none: a block that hits a wall. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "conformance/scene_run.h"

static const char before[] =
    "gamut: 1\n"
    "solver: {model: material_point_method, geometry: plane_strain, cell: 0.5 mm, end: 2 us}\n"
    "materials:\n"
    "  metal:\n"
    "    density: 8000 kg/m3\n"
    "    eos: {model: linear, bulk_modulus: 140 GPa}\n"
    "    strength: {model: von_mises, yield_stress: 90 MPa, hardening_modulus: 300 MPa}\n"
    "    elasticity: {model: hypoelastic, shear_modulus: 48 GPa}\n";
static const char between[] =
    "bodies:\n"
    "  block:\n"
    "    material: metal\n"
    "    shape: {box: {min: [0 mm, 0 mm], max: [2 mm, 2 mm]}}\n"
    "    velocity: [0 m/s, -200 m/s]\n"
    "effects:\n"
    "  wall: {model: rigid_wall, plane: {point: [0 mm, 0 mm], normal: [0, 1]}}\n"
    "  tried:\n";

/* A vector of "1..3" components is one in space, and this scene has two axes. */
static void write_value(FILE *out, const struct parameter *p, const char *text)
{
  const size_t length = strlen(text);
  const bool one = length > 2 && text[0] == '[' && !strchr(text, ',');
  if (p && p->type == VALUE_VECTOR && p->size_min < 2 && p->size_max >= 2 && one)
    fprintf(out, "%.*s, %.*s]\n", (int)length - 1, text, (int)length - 2, text + 1);
  else
    fprintf(out, "%s\n", text);
}

static void write_settings(FILE *out, const struct proof *proof, bool of_material, int indent)
{
  const struct descriptor *d = proof->descriptor;
  for (size_t i = 0; i < proof->base.count; i++) {
    const struct setting *setting = &proof->base.item[i];
    const bool material =
        parameter_named(d->material_parameter, d->material_parameters, setting->name) != NULL;
    if (material != of_material)
      continue;
    fprintf(out, "%*s%s: ", indent, "", setting->name);
    write_value(out, specimen_parameter(d, setting->name), setting->text);
  }
}

char *usual_scene_new(const struct proof *proof)
{
  const char *folder = getenv("TMPDIR");
  char *file = NULL;
  if (!folder || !folder[0])
    folder = "/tmp";
  const size_t size = strlen(folder) + sizeof "/gamut-scene-XXXXXX";
  if (!(file = malloc(size)))
    return NULL;
  snprintf(file, size, "%s/gamut-scene-XXXXXX", folder);
  const int descriptor = mkstemp(file);
  FILE *out = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
  if (!out) {
    if (descriptor >= 0)
      close(descriptor);
    free(file);
    return NULL;
  }
  fputs(before, out);
  write_settings(out, proof, true, 4);
  fputs(between, out);
  fprintf(out, "    model: %s\n", proof->descriptor->name);
  write_settings(out, proof, false, 4);
  if (fclose(out) == 0)
    return file;
  usual_scene_free(file);
  return NULL;
}

void usual_scene_free(char *file)
{
  if (file)
    unlink(file);
  free(file);
}
