/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a case that is wrong small while it stays wrong: a reproducer that a person can read. */
#ifndef BR_STUDY_EXTREMES_SHRINK_H
#define BR_STUDY_EXTREMES_SHRINK_H

#include "study/extremes/case.h"

/* Who is asked about a smaller case. */
struct br_shrink_question {
    /* *still (out): it is as wrong as the first one. Fails with BR_NO_MEMORY. */
    enum br_status (*ask)(void *self, const struct br_extreme_case *one, bool *still,
                          struct br_error *err);
    void *self;
    size_t most; /* questions */
};

/* Drops parts, forces and laws, takes the default rows of the registries, plain shapes, fewer
 * elements and steps, unit length and duration, and numbers of one digit, over and over, as long
 * as something is gained. one: in/out, a case that is wrong. Fails as the question does. */
enum br_status br_shrink(struct br_extreme_case *one, const struct br_shrink_question *question,
                         struct br_error *err);

/* How much there is of a case, a number that shrinking makes less. */
size_t br_shrink_size(const struct br_extreme_case *one);

#endif
