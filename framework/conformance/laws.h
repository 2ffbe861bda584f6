/* The callees of an elasticity kernel under test. */
#ifndef GAMUT_LAWS_H
#define GAMUT_LAWS_H

#include "conformance/conformance_private.h"

struct laws {
  struct specimen eos, strength; /* kernel null: none */
};

/* Makes the laws that the descriptor asks for. `which` names them ({eos: {model: NAME, ...}});
 * where it is null or says nothing of a law, eos/linear and strength/von_mises with values of a
 * metal. */
gamut_status laws_new(struct laws *, struct proof *, const struct tree *which, size_t count,
                      double density, struct trace *);
void laws_free(struct laws *);

#endif
