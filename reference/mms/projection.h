/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A derivative of a given solution in the orthonormal Legendre modes of solver/modes.h. */
#ifndef BR_REFERENCE_MMS_PROJECTION_H
#define BR_REFERENCE_MMS_PROJECTION_H

#include "solver/function.h"

enum { BR_PROJECTION_MOST_KEPT = 8 };

/* What is projected: d^x/dx^x of the displacement, or of the velocity, and how many modes
 * of an element are kept, at most BR_PROJECTION_MOST_KEPT. */
struct br_projected {
    struct br_partial order; /* t: 0 displacement, 1 velocity */
    size_t kept;
};

/* The squares of L2 norms, m^3 for a displacement. */
struct br_projection_rest {
    double rest; /* of what the kept modes leave out, up to degree 10 */
    double tail; /* of the last two degrees of it: how well that is known */
};

/* n equal elements of [0, length], m. */
struct br_projection_mesh {
    double length;
    size_t n;
};

struct br_projection;

/* Of a solution. Fails with BR_BAD_INPUT (not kept <= BR_PROJECTION_MOST_KEPT, or as
 * br_function_derive) or BR_NO_MEMORY; *projection is then NULL. */
enum br_status br_projection_create(struct br_projection **projection,
                                    const struct br_function *solution,
                                    const struct br_projected *what,
                                    const struct br_projection_mesh *mesh, struct br_error *err);
void br_projection_free(struct br_projection *projection); /* accepts NULL */

/* At t, s: modes out, n * kept values. */
struct br_projection_rest br_projection_apply(struct br_projection *projection, double t,
                                              double *modes);

#endif
