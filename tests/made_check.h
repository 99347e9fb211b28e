/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small scene of its own with the default expectations, and its check. */
#ifndef BR_TESTS_MADE_CHECK_H
#define BR_TESTS_MADE_CHECK_H

#include "study/verify/check.h"
#include "support.h"

struct made_check {
    struct br_scene scene;
    struct br_verify verify;
    struct br_check check;
};

/* A rod that is pulled; to be cleared. It may be changed before it is checked. */
void made_create(struct made_check *m);
void made_clear(struct made_check *m);

/* Runs the check, again if need be. */
void made_run(struct made_check *m, int threads);

#endif
