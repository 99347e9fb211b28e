/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A verdict on one expectation: from the order's 95 % interval, not from a slope. */
#ifndef BR_STUDY_VERIFY_VERDICT_H
#define BR_STUDY_VERIFY_VERDICT_H

#include "study/fit/fit.h"
#include "study/verify/verify.h"

enum br_verdict {
    BR_PASS,         /* the interval lies within the band */
    BR_FAIL,         /* it lies outside; or the constant is out of its range; or an error is not
                        a number, or missing */
    BR_INCONCLUSIVE, /* it straddles, or too few points are left: counts as failing */
};
extern const char *const br_verdict_names[]; /* "PASS", "FAIL", "INCONCLUSIVE" */

/* One error of a study. */
struct br_point {
    struct br_resolution at, against; /* against: zeros for the continuous problem */
    double z, z_against;              /* h/L or k/T, what the order is in; and that of `against` */
    double error;                     /* in the norm's unit */
    double constant;                  /* C of e = C (z^order - z_against^order) */
    enum br_flag flag;                /* why it is left out */
    bool used;                        /* for the verdict: among the finest that are not left out */
    char failure[256];                /* of the march; "": it went well */
};

/* An expectation with what was seen. */
struct br_case {
    enum br_verify_kind kind;
    struct br_expectation expected;
    struct br_point *point; /* points, from coarse to fine; owned */
    size_t points, used;
    struct br_estimate order;
    double constant; /* the largest of the used points'; NaN: none */
    double margin;   /* from the interval to the nearer end of the band; < 0: outside */
    enum br_verdict verdict;
    char reason[768]; /* why it does not pass, and what would make it conclusive; or "" */
    char note[512];   /* what was left out; or "" */
};

/* Judges a case whose kind, expected and points (at, against, z, z_against, error, flag, failure)
 * are set: sets the rest. Fails with BR_NO_MEMORY. */
enum br_status br_verdict_reach(struct br_case *c, struct br_error *err);

#endif
