/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observed orders of convergence, fitted with GSL, with 95 % intervals. */
#ifndef BR_STUDY_FIT_FIT_H
#define BR_STUDY_FIT_FIT_H

#include "study/base/observer.h"
#include "study/grid/study.h"

/* A number with its 95 % interval; NaN: not known. */
struct br_estimate {
    double value, low, high;
};

/* Whether an order's interval is at most 1 wide and above zero. Any other interval says nothing. */
bool br_order_determined(const struct br_estimate *order);

/* "1.02 [1.00, 1.04]" with 2 to 4 decimals, by the width of the interval, which is never zero; "-":
 * there is no order.
 * buffer: at least 64 characters. */
const char *br_order_text(const struct br_estimate *order, char *buffer, size_t size);

/* "-0.2216 +- 0.0014": a value with the digits that half the width of its interval allows, at most
 * ten, "0" where it allows none; six digits where the width is not known. br_digits_text: a value
 * with this number of digits. buffer: at least 64 characters. */
const char *br_uncertain_text(double value, double half, char *buffer, size_t size);
const char *br_digits_text(double value, int digits, char *buffer, size_t size);
/* "24.936 [24.922, 24.940]": two digits of half the width; nine of a value without a width. */
const char *br_interval_text(const struct br_estimate *e, char *buffer, size_t size);

/* The joint model of a grid. The errors of space and of time are fields with
 * signs, so their norms do not add. The reference has a resolution, too:
 *     e^2 = a^2 + 2 r a b + b^2,   -1 <= r <= 1,
 *     a = C_h (h^p - h_ref^p),     b = C_k (k^q - k_ref^q).
 * Where the cells do not show one of the two errors, the model without it is chosen (by the
 * corrected Akaike criterion); the numbers of that error are NaN. The residuals of the model are
 * deterministic, not noise: so the intervals come from leaving out whole rows and columns of the
 * grid (joint_fit.c). The numbers of a stranger may also have a constant floor or next terms where
 * the cells show them; an interval then reaches over those of all models that the cells do not rule
 * out. */
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

struct br_fits {
    struct br_joint_fit joint;
    double reference_error; /* the reference's own error, m^(3/2); NaN: not known */
};

/* Whether the joint model describes the errors: a misfit of at most 2 %, or scatter without waves.
 */
bool br_joint_describes(const struct br_joint_fit *fit);

/* Fits one component of a study's errors without the flagged cells, and sets the flags of this
 * component: of cells whose error is less than br_flag_margin times what limits it. The reference's
 * own error comes from the fit, so both are repeated until no flag changes. A fit that cannot be
 * done is NaN. Fails with BR_NO_MEMORY. */
enum br_status br_fit(struct br_study *study, enum br_part part, struct br_fits *fits,
                      struct br_error *err);
/* Sets the flags of a study that is shown but not fitted. A reference's own error that needs the
 * fit is not known, and flags nothing. */
void br_flag_beside(struct br_study *study);

/* The margin: a cell is flagged when its error is below this many times the
 * reference's own error or the predicted round-off. */
extern const double br_flag_margin;

/* The model's error at h and k, m^(3/2); x and ref as in an observation. */
double br_joint_model(const struct br_joint_fit *fit, const double x[BR_AXES],
                      const double ref[BR_AXES]);

/* ---- the joint model, fitted to the logarithms of the errors ---- */

/* One cell, as the fit needs it. */
struct br_observation {
    double x[BR_AXES];   /* h and k, m and s */
    double ref[BR_AXES]; /* of the reference; 0: the continuous problem */
    double error;        /* > 0 */
    double rounding;     /* half a unit of its last digit; 0: it was not printed */
    enum br_flag flag;   /* out: why the fit does not rest on it; BR_FLAG_NONE: it does */
};

/* Fits the model that the observations determine; without a fit, converged is false. Where all
 * observations have h = h_ref, the model has no error of space; where all have k = k_ref, it has
 * none of time. any_model: also with floors and next terms, and of errors that scatter, else powers
 * alone. observer: may be NULL. Fails with BR_NO_MEMORY or BR_INTERRUPTED. */
enum br_status br_joint_fit_solve(struct br_observation *observation, size_t count, bool any_model,
                                  const struct br_observer *observer, struct br_joint_fit *fit,
                                  struct br_error *err);

/* value -+ half width of the 95 % interval: t quantile times the deviation. */
struct br_estimate br_estimate_of(double value, double deviation, size_t freedom);

/* Akaike's criterion, with Hurvich and Tsai's correction for few points, of `count` residuals; sum:
 * of their squares. Infinite where there are too few. */
double br_akaike(double sum, size_t count, size_t unknowns);

#endif
