/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The march of one field through all phases of its tip. */
#ifndef BR_REFERENCE_EXACT_MARCH_H
#define BR_REFERENCE_EXACT_MARCH_H

#include "reference/exact/effort.h"
#include "reference/exact/field.h"
#include "reference/exact/law.h"
#include "reference/exact/outline.h"

struct br_march_options {
    double duration;                     /* T, s */
    const struct br_outline *outline[2]; /* of this field, and NULL or the one that it depends on:
                                            the steps that they ask for */
    double gap;                          /* of the contact, m; 0 for friction */
    double tolerance;  /* what the last coefficients of a step may be of the largest value */
    double first_step; /* s: length of the first step of a phase, always accepted */
    size_t max_steps;
    struct br_effort *effort;
};

/* *out (owned by the caller): the history of the field under the law, both of
 * which are only read. Fails with BR_NO_MEMORY, BR_SINGULAR, BR_INTERRUPTED, or BR_NOT_FINITE
 * where the solution blows up, asks for too many steps, or has phases that
 * follow each other without end. */
enum br_status br_march(const struct br_field *field, const struct br_law *law,
                        const struct br_march_options *options, struct br_track **out,
                        struct br_error *err);

#endif
