/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdicts on all that is expected of one source. */
#ifndef BR_ORDERS_EXPECTATION_CHECK_H
#define BR_ORDERS_EXPECTATION_CHECK_H

#include "orders/expectation/case.h"
#include "orders/expectation/setting.h"

struct br_check {
    /* in; borrowed */
    const char *path; /* of the source, for messages */
    bool no_file;     /* the path is a word for --run or standard input */
    const char *name;
    bool of_program;  /* the numbers are a program's or a table's, whose work is not known */
    char problem[40]; /* a hash of what is solved, for comparisons; "": none */
    const char *data; /* what is solved, a line "key: value" each; NULL: not known */
    const char
        *defaults; /* the expectations as a file would state them; NULL: a file states them */
    const struct br_settings *method; /* BR_VERIFY_KINDS of them, by study; NULL: not known */
    /* out */
    struct br_error failure; /* BR_BAD_INPUT: it cannot be verified, with file and line; there are
                                no cases then */
    struct br_case *cases;   /* by study, in the order of the expectations; owned */
    size_t count, room;
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
