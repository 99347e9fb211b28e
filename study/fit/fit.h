/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observed orders of convergence, fitted with GSL, with 95 % intervals. */
#ifndef BR_STUDY_FIT_FIT_H
#define BR_STUDY_FIT_FIT_H

#include "study/grid/study.h"

/* A number with its 95 % interval; NaN where it could not be had. */
struct br_estimate {
    double value, low, high;
};

/* Whether an order's interval is narrow enough, 1 wide, and above zero: else it says
 * nothing. */
bool br_order_determined(const struct br_estimate *order);

/* "1.02 [1.00, 1.04]" with the decimals that the interval deserves, 2 to 4; "-" where
 * there is none. buffer: at least 64 characters. */
const char *br_order_text(const struct br_estimate *order, char *buffer, size_t size);

/* Slope of log(error) against log(h) or log(k): what a reader would draw. It means
 * an order only where one of the two errors dominates. */
struct br_slope {
    struct br_estimate order;
    size_t points; /* an interval needs 3 */
};

/* The joint model of a grid. The space and the time error are fields with signs,
 * so their norms do not add; and the reference has a resolution of its own:
 *     e^2 = a^2 + 2 r a b + b^2,   -1 <= r <= 1,
 *     a = C_h (h^p - h_ref^p),     b = C_k (k^q - k_ref^q).
 * Where one of the two errors cannot be seen in the cells, the model without it
 * explains them as well with fewer parameters (by the corrected Akaike
 * criterion), and what belongs to the other is NaN. What the model leaves over is
 * deterministic, not noise: the intervals come from leaving out whole rows and
 * columns of the grid (joint_fit.c). */
enum br_joint_kind { BR_JOINT_BOTH, BR_JOINT_TIME, BR_JOINT_SPACE };

struct br_joint_fit {
    enum br_joint_kind kind;
    struct br_estimate c_h, p, c_k, q, r;
    double misfit;    /* root mean square of log(model/error) */
    double worst;     /* its largest magnitude */
    double r_squared; /* of the logarithms */
    size_t points, freedom;
    bool converged; /* false: the rest is NaN */
};

struct br_fits {
    struct br_slope *by_n; /* n_count: over k at fixed n */
    struct br_slope *by_k; /* k_count: over h at fixed k */
    struct br_joint_fit joint;
    double reference_error; /* the reference's own, by the joint model, m^(3/2); NaN where
                               the model does not describe the errors */
};

/* Whether the joint model describes the errors: a misfit of at most 2 %. */
bool br_joint_describes(const struct br_joint_fit *fit);

/* Fits one part of a study's errors, leaving out flagged cells, and sets the flags
 * of that part: cells whose error is less than `margin` times what limits them.
 * The reference's own error is itself fitted, so this is repeated until the flags
 * stand. Fails with BR_NO_MEMORY; a fit that cannot be done is NaN. */
enum br_status br_fit(struct br_study *study, enum br_part part, struct br_fits *fits,
                      struct br_error *err);
/* Sets the flags of a study that is shown but not fitted. Without an auditor its
 * reference's own error is not known and flags nothing. */
void br_flag_beside(struct br_study *study);

void br_fits_clear(struct br_fits *fits);

/* The margin: a cell is flagged when its error is below this many times the
 * reference's own error or the predicted round-off. */
extern const double br_flag_margin;

/* The model's error at h and k, m^(3/2). */
double br_joint_model(const struct br_joint_fit *fit, double h, double k, double h_ref,
                      double k_ref);

#endif
