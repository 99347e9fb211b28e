/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A solution that is given, and from which a scene is manufactured (study/scene/manufactured.c):
 * what is checked of it, and the judge. */
#ifndef BR_REFERENCE_MMS_MMS_H
#define BR_REFERENCE_MMS_MMS_H

#include "solver/field.h"

/* ---- the given solution ---- */

/* One field's solution on [0, length] x [0, duration]. */
struct br_given {
    const struct br_function *function; /* u(x, t) or w(x, t), m; borrowed */
    enum br_field_kind kind;
    double length, duration; /* m, s */
};

/* Refuses (BR_BAD_INPUT), naming the derivative, x, t, what was found and expected:
 * - a solution or derivative of which it is not proved that it is finite everywhere;
 * - u(0, t), w(0, t) or w_x(0, t) that is not zero;
 * - a jump in what is derived, since the derivative would leave out its delta. The guards of
 *   function.h give the places; lines that cross every stretch between them are checked.
 * Fails with BR_NO_MEMORY, too. */
enum br_status br_given_check(const struct br_given *solution, struct br_error *err);

/* Refuses (BR_BAD_INPUT) a stick force beyond the friction bound at a time at which the tip
 * rests. u, velocity: u(L, t), m, and w_t(L, t), m/s. */
enum br_status br_stick_check(const struct br_scene *scene, const struct br_function *u,
                              const struct br_function *velocity, struct br_error *err);

/* ---- its derivatives in the orthonormal Legendre modes of solver/modes.h ---- */

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

struct br_projection;

/* Of a solution, on n equal elements of [0, length], m. Fails with BR_BAD_INPUT (not kept <=
 * BR_PROJECTION_MOST_KEPT, or as br_function_derive) or BR_NO_MEMORY; free *projection even then.
 */
enum br_status br_projection_create(struct br_projection **projection,
                                    const struct br_function *solution,
                                    const struct br_projected *what, double length, size_t n,
                                    struct br_error *err);
void br_projection_free(struct br_projection *projection); /* accepts NULL */

/* At t, s: modes out, n * kept values. */
struct br_projection_rest br_projection_apply(struct br_projection *projection, double t,
                                              double *modes);

#endif
