/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The warning of a lagged contact that will be unstable (solver/laws.h). */
#ifndef BR_STUDY_FORESEE_WARN_CONTACT_H
#define BR_STUDY_FORESEE_WARN_CONTACT_H

#include "study/foresee/warnings.h"

extern const struct br_warning_source br_warn_contact;

/* The least round number of steps, 1, 2, 4, 5, 8, 10, 16, 20, 25, ... of `least` or more, so that a
 * duration with few digits has time steps with few digits; INFINITY above 8e12. */
double br_round_steps(double least);

#endif
