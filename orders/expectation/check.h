/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdicts on all that is expected of one source. */
#ifndef BR_ORDERS_EXPECTATION_CHECK_H
#define BR_ORDERS_EXPECTATION_CHECK_H

#include "orders/expectation/case.h"

struct br_scene;
struct br_verify;

struct br_check {
    /* in; borrowed */
    const char *path;               /* of the scene, for messages */
    const char *name;               /* of the scene, or of the study of another program */
    const struct br_scene *scene;   /* NULL: of another program, whose cases are given */
    const struct br_verify *verify; /* NULL likewise */
    char problem[40];               /* a hash of what is solved, for comparisons; "": none */
    const char *data;               /* as in struct br_verify; NULL: not known */
    /* out */
    struct br_error failure; /* BR_BAD_INPUT: the scene cannot be verified (its reference or a
                                method refuses it), with file and line; there are no cases then */
    struct br_case *cases;   /* by study, in the order of the expectations; owned */
    size_t count;
    double seconds;       /* of all marches of the solver, one thread */
    double element_steps; /* of these, elements times steps, a field */
};

void br_check_clear(struct br_check *check);

/* How many checks have a failure, and which is the first; NULL: none. */
size_t br_check_failures(const struct br_check *checks, size_t count,
                         const struct br_check **first);

/* How many cases of all checks have a verdict. */
size_t br_check_tally(const struct br_check *checks, size_t count, enum br_verdict verdict);

#endif
