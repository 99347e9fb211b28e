/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The joint model of fit.h, fitted to the logarithms of the errors. */
#ifndef BR_STUDY_FIT_JOINT_FIT_H
#define BR_STUDY_FIT_JOINT_FIT_H

#include "study/fit/fit.h"

/* One cell as the fit sees it. */
struct br_observation {
    double h, k;         /* m, s */
    double h_ref, k_ref; /* of what it was compared with, m, s; 0: the continuous problem */
    double error;        /* > 0 */
};

/* Fits the model with what the observations can tell; a fit that cannot be done
 * has converged == false. Where all have h = h_ref, or k = k_ref, it has no such part. Fails with
 * BR_NO_MEMORY. */
enum br_status br_joint_fit_solve(const struct br_observation *observation, size_t count,
                                  struct br_joint_fit *fit, struct br_error *err);

/* value -+ half width of the 95 % interval: t quantile times the deviation. */
struct br_estimate br_estimate_of(double value, double deviation, size_t freedom);

/* Akaike's criterion with Hurvich and Tsai's correction for few points, of `count` residuals with
 * that sum of squares; infinite where there are too few. */
double br_akaike(double sum, size_t count, size_t unknowns);

#endif
