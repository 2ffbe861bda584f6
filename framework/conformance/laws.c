#include "conformance/laws.h"

#include <string.h>

static gamut_status read_law(struct settings *settings, const struct descriptor *law,
                             const struct tree *node, const struct units *units,
                             struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  for (size_t i = 0; i < node->children; i++)
    if (strcmp(node->child[i]->key, "model") != 0)
      TRY(settings_node(settings, law, node->child[i], "laws", units, trace));
done:
  return status;
}

static gamut_status standard_law(struct settings *settings, const struct descriptor *law,
                                 enum gamut_kind kind, const struct units *units,
                                 struct trace *trace)
{
  if (kind == GAMUT_KIND_EOS)
    return settings_read(settings, law, "bulk_modulus", "140 GPa", "laws", units, trace);
  gamut_status status =
      settings_read(settings, law, "yield_stress", "90 MPa", "laws", units, trace);
  if (status == GAMUT_OK)
    status = settings_read(settings, law, "hardening_modulus", "300 MPa", "laws", units, trace);
  return status;
}

static gamut_status law_new(struct specimen *specimen, struct proof *proof, enum gamut_kind kind,
                            const struct tree *node, size_t count, double density,
                            struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  struct settings settings = {.folder = proof->descriptor->folder};
  const struct tree *model = node ? tree_get(node, "model") : NULL;
  const char *name = model ? model->text : kind == GAMUT_KIND_EOS ? "linear" : "von_mises";
  if (model && strcmp(name, "absent") == 0)
    return GAMUT_OK;
  const struct descriptor *law = registry_expect(proof->registry, kind, name, NULL, "laws", trace);
  if (!law)
    return GAMUT_PLUGIN;
  if (node)
    TRY(read_law(&settings, law, node, proof->units, trace));
  else
    TRY(standard_law(&settings, law, kind, proof->units, trace));
  TRY(specimen_values(specimen, law, &settings, "laws", proof->units, trace));
  TRY(specimen_open(specimen, proof->registry, count, density, trace));
done:
  settings_free(&settings);
  return status;
}

gamut_status laws_new(struct laws *laws, struct proof *proof, const struct tree *which,
                      size_t count, double density, struct trace *trace)
{
  gamut_status status = GAMUT_OK;
  const struct descriptor *d = proof->descriptor;
  *laws = (struct laws){0};
  for (size_t i = 0; i < d->laws && status == GAMUT_OK; i++) {
    bool strength = strcmp(d->law[i].name, "strength") == 0;
    const struct tree *node = which ? tree_get(which, d->law[i].name) : NULL;
    status = law_new(strength ? &laws->strength : &laws->eos, proof,
                     strength ? GAMUT_KIND_STRENGTH : GAMUT_KIND_EOS, node, count, density, trace);
  }
  return status;
}

void laws_free(struct laws *laws)
{
  specimen_close(&laws->eos);
  specimen_close(&laws->strength);
}
