/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of scenes against what is expected of them (verify.h), with a verdict on each expectation:
 * from the order's 95 % interval, not from a slope. */
#ifndef BR_STUDY_VERIFY_CHECK_H
#define BR_STUDY_VERIFY_CHECK_H

#include "base/observer.h"
#include "orders/orders.h"
#include "study/fit/fit.h"
#include "study/verify/verify.h"

/* A scene, what is expected of it, and its check, which begins as zeros. Begins with these three;
 * begin it before it is compared or reported. */
struct br_scene_check {
    const struct br_scene *scene;   /* borrowed */
    const struct br_verify *verify; /* borrowed */
    struct br_check *check;         /* borrowed */
    /* what the check borrows */
    char *defaults; /* owned */
    struct br_settings method[BR_VERIFY_KINDS];
};

/* Sets all but the results of the check. path: of the scene, borrowed. Fails with BR_NO_MEMORY;
 * clear it even then, after the check's last use. */
enum br_status br_scene_check_begin(struct br_scene_check *check, const char *path,
                                    struct br_error *err);
void br_scene_check_clear(struct br_scene_check *check);

/* Checks scenes against what is expected of them (verify.h), all at once: marches, measures,
 * finds the verdicts, on `threads` threads (0: all cores); the verdicts do not depend on their
 * number. A march that fails is a verdict; a scene that cannot be verified has a `failure`, and the
 * others go on. Fails as br_study_run_each does. */
enum br_status br_check_run(const struct br_scene_check *checks, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err);
/* The study that is marched for pair h of neighbours, or for the joint path (h = 0), but for its
 * norm. */
struct br_study br_check_study(const struct br_scene_check *check, enum br_verify_kind kind,
                               size_t h);

#endif
