/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks scenes against what is expected of them (verify.h): marches, measures, judges. */
#ifndef BR_STUDY_VERIFY_CHECK_H
#define BR_STUDY_VERIFY_CHECK_H

#include "study/grid/observer.h"
#include "study/verify/verdict.h"

struct br_check {
    /* in; borrowed */
    const char *path; /* of the scene, for messages */
    const struct br_scene *scene;
    const struct br_verify *verify;
    /* out */
    struct br_error failure; /* BR_BAD_INPUT: the scene cannot be verified (its reference or a
                                method refuses it), with file and line; there are no cases then */
    struct br_case *cases;   /* by study, in the order of the expectations; owned */
    size_t count;
    double seconds;       /* of all marches of the solver, one thread */
    double element_steps; /* of these, elements times steps, a field */
};

/* Checks scenes, all at once, on `threads` threads (0: all cores); the verdicts do not depend on
 * their number. A march that fails is a verdict; a scene that cannot be verified has a `failure`,
 * and the others go on. Fails as br_study_run_each does. */
enum br_status br_check_run(struct br_check *checks, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err);
void br_check_clear(struct br_check *check);

/* What a check will cost: element-steps of all its marches, a field. */
double br_check_work(const struct br_check *check);

/* How many checks have a failure, and which is the first; NULL: none. */
size_t br_check_failures(const struct br_check *checks, size_t count,
                         const struct br_check **first);

/* How many cases of all checks have a verdict. */
size_t br_check_tally(const struct br_check *checks, size_t count, enum br_verdict verdict);

#endif
