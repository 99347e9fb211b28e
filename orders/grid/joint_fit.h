/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The joint fit of a grid of errors over h and k. */
#ifndef BR_ORDERS_GRID_JOINT_FIT_H
#define BR_ORDERS_GRID_JOINT_FIT_H

#include "base/observer.h"
#include "base/status.h"
#include "orders/axis.h"
#include "orders/estimate.h"
#include "orders/line/line_order.h"

/* The joint model of a grid. The errors of space and of time are fields with
 * signs, so their norms do not add. The reference has a resolution, too:
 *     e^2 = a^2 + 2 r a b + b^2,   -1 <= r <= 1,
 *     a = C_h (h^p - h_ref^p),     b = C_k (k^q - k_ref^q).
 * Where the cells do not show one of the two errors, the model without it is chosen (by the
 * corrected Akaike criterion); the numbers of that error are NaN. The residuals of the model are
 * deterministic, not noise: so the intervals come from leaving out whole rows and columns of the
 * grid (joint_fit.c). The numbers of a stranger may also have a constant floor, next terms, and an
 * order that changes along an axis, where the cells show them; an interval then reaches over those
 * of all models that the cells do not rule out, and from one order to the other. */
enum br_joint_kind { BR_JOINT_BOTH, BR_JOINT_TIME, BR_JOINT_SPACE };
bool br_joint_has(enum br_joint_kind kind, int axis); /* whether it has an error of this axis */

struct br_joint_fit {
    enum br_joint_kind kind;
    struct br_estimate c[BR_AXES], order[BR_AXES], r; /* C_h, C_k; p, q; r */
    double low99[BR_AXES], high99[BR_AXES];           /* the 99 % interval of an order */
    double share[BR_AXES]; /* the largest share that the error of this axis has of both in a cell */
    const char *law[BR_AXES]; /* what bends the power of an axis; NULL: nothing */
    double floor;             /* m^(3/2); NaN: none */
    bool scatters;    /* residuals of at most 30 %, and neighbours do not have the same sign */
    double misfit;    /* root mean square of log(model/error) */
    double worst;     /* its largest magnitude */
    double r_squared; /* of the logarithms */
    size_t points, left_out, freedom;
    bool converged; /* false: the rest is NaN */
};

/* Whether the joint model describes the errors: a misfit of at most 2 %, or scatter without waves.
 */
bool br_joint_describes(const struct br_joint_fit *fit);

/* The model's error at h and k, m^(3/2); x and ref as in a point. */
double br_joint_model(const struct br_joint_fit *fit, const double x[BR_AXES],
                      const double ref[BR_AXES]);

/* The same, with its band over the interval of the order in an axis: by models with the same error
 * of that axis at size `middle`. */
struct br_estimate br_joint_band(const struct br_joint_fit *fit, enum br_axis axis, double middle,
                                 const double x[BR_AXES], const double ref[BR_AXES]);

/* ---- the joint model, fitted to the logarithms of the errors ---- */

/* Fits the model that the points determine, of which are read x, ref, error > 0 and rounding;
 * without a fit, converged is false. flag (out): why the fit does not rest on a point;
 * BR_FLAG_NONE: it does. Where all have h = h_ref, the model has no error of space; where all have
 * k = k_ref, it has none of time. any_model: also with floors and next terms, and of errors that
 * scatter, else powers alone. observer: may be NULL. Fails with BR_NO_MEMORY or BR_INTERRUPTED. */
enum br_status br_joint_fit_solve(struct br_point *point, size_t count, bool any_model,
                                  const struct br_observer *observer, struct br_joint_fit *fit,
                                  struct br_error *err);

#endif
