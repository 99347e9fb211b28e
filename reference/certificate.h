/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A certificate for a step: is it a step of (27), (28), (10) and (12)? Computed from
 * the nodal values before and after it, with element matrices of its own (the
 * textbook's 12, 6, 4, 2) in long double, and nothing of a solver's numerics.
 *
 * The norm of a residual. The residual of (28) is a set of nodal forces r. Its size as
 * a vector means nothing on a fine mesh: nodal values are rounded to one part in 1e16,
 * and K w magnifies that by h^-4. What it does to the beam is told by the bending
 * moment m that balances it, r'z = int m z_xx dx for every z of the space, and
 *     |m|_L2 = sup { r'z : |z_xx|_L2 = 1 },
 * found from the free end by summing forces and levers: no system is solved. For (27)
 * it is the normal force. A residual is given relative to the sum of the same norms of
 * the terms of the equation. Rounded nodal values then cost about 2^-53 n^2 in bending
 * and 2^-53 n in axial, and no solver can do better in these numbers. */
#ifndef BR_CERTIFICATE_H
#define BR_CERTIFICATE_H

#include "solver/march.h"

/* How far a step is from each law; pure numbers, 0 for a perfect step, NaN where the
 * step has a value that is not finite or a law that is not known here. */
struct br_certificate {
    double axial_residual;   /* of (27) */
    double bending_residual; /* of (28) */
    double update;           /* u_n - u_{n-1} - k v_n of both fields, and the tip's values told */
    double friction;         /* distance of (v, lambda) from the graph of (12) or (29), lambda
                                relative to the bound, k v to the largest nodal value */
    double contact;          /* force - c_H (u - g)_+ at u_{n-1} or u_n */
};

/* Nodal values of one field around a step, laid out as in solver/field.h. */
struct br_step_field {
    const double *displacement_before, *displacement; /* m */
    const double *velocity_before, *velocity;         /* m/s */
    const double *load;                               /* F_n, N */
};

/* All that is known of one step. */
struct br_step {
    const struct br_scene *scene;
    const struct br_method *method; /* which laws were to be used */
    size_t n;                       /* elements */
    double k;                       /* s */
    double compliance; /* z_tip of bending, m/s per N; for friction rules that iterate */
    struct br_step_field field[2]; /* by br_field_kind; of modelled fields */
    struct br_tip tip;
};

struct br_certificate br_certify(const struct br_step *step);

/* BR_OK where no number of the certificate is above the one in `limits`; a NaN is.
 * Fails with BR_VERDICT, naming the first that is. */
enum br_status br_certificate_check(const struct br_certificate *certificate,
                                    const struct br_certificate *limits, struct br_error *err);

/* What a sound step on n elements stays below, given the predicted relative round-off
 * of the solver's displacements (br_march_round_off). */
struct br_certificate br_certificate_limits(size_t n, double round_off);

/* Becomes the worse of the two, entry by entry; NaN is the worst. */
void br_certificate_merge(struct br_certificate *worst, const struct br_certificate *other);

/* Watches a march: keeps the state before a step. */
struct br_witness;

/* Looks at the march as it is now. The march, its scene and the method must outlive
 * the witness. Fails with BR_NO_MEMORY; *witness is then NULL. */
enum br_status br_witness_create(struct br_witness **witness, const struct br_march *march,
                                 const struct br_scene *scene, const struct br_method *method,
                                 struct br_error *err);
void br_witness_free(struct br_witness *witness); /* accepts NULL */

/* To be called after every step: the certificate of the step from the state last
 * looked at, which it then replaces. */
struct br_certificate br_witness_step(struct br_witness *witness);

#endif
