/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of convergence that theory states: the one place that `check`, `study`, `tables` and
 * the pictures have it from. theory.c derives each. */
#ifndef BR_STUDY_FIT_THEORY_H
#define BR_STUDY_FIT_THEORY_H

#include "study/fit/fit.h"

/* As h or k -> 0. */
struct br_theory {
    double order;     /* of the leading term of the error; NaN: theory states none */
    double highest;   /* >= order: errors fall with up to this order where the leading term is small
                         beside another one */
    double formal;    /* of the elements, or of the scheme, where nothing lowers it */
    char reason[160]; /* why it is not the formal one, or why there is none; or "" */
};

/* The order of a component of a study's error in h or in k, in its norm, by its method. Of a study
 * the scene, norm, method and coarsest mesh, n[0], are read. */
struct br_theory br_theory_of(const struct br_study *study, enum br_part part, enum br_axis axis);

#endif
