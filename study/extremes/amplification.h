/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a time scheme makes of y' = lambda y in a step, by its textbook. */
#ifndef BR_STUDY_EXTREMES_AMPLIFICATION_H
#define BR_STUDY_EXTREMES_AMPLIFICATION_H

#include <complex.h>

#include "reference/textbook.h"

/* The factor of a step with z = k lambda: the stability function R(z) of a Runge-Kutta method (its
 * last stage is the step's end), of backward differences the principal root r of
 * (1 - beta z) r^q = sum past_j r^(q-1-j), the one that is nearest to e^z for small z. */
double complex br_amplification(const struct br_textbook *textbook, double complex z);

#endif
