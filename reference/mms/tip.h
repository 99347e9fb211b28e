/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tip forces that make a given solution fulfil the laws (8), (10), (11), (12). */
#ifndef BR_REFERENCE_MMS_TIP_H
#define BR_REFERENCE_MMS_TIP_H

#include "solver/scene.h"

/* What a tip force is made of: functions of t. */
struct br_tip_parts {
    struct br_function stress;   /* N: a1 u_x + c1 u_xt, or -(a2 w_xxx + c2 w_xxxt) */
    struct br_function u;        /* u(L, t), m */
    struct br_function velocity; /* w_t(L, t), m/s; bending only */
    struct br_function stick;    /* lambda while that is zero, N; bending only */
    struct br_contact contact;
    struct br_friction friction;
    struct br_function above_gap; /* u - g, m; made from u, owns nothing */
};

void br_tip_parts_clear(struct br_tip_parts *parts);

/* stress + c_H (u - g)_+, N, from (8) and (10). The parts are taken over, even where it
 * fails (BR_NO_MEMORY). */
enum br_status br_tip_axial(struct br_tip_parts *parts, struct br_function *f,
                            struct br_error *err);

/* lambda + stress, N, from (11) and (12): lambda is b sign(w_t), or the stick force where
 * w_t is zero. The parts are taken over, even where it fails (BR_NO_MEMORY). */
enum br_status br_tip_bending(struct br_tip_parts *parts, struct br_function *f,
                              struct br_error *err);

/* The friction bound b(t), N, of a solution whose tip is at u, m. */
double br_tip_bound(const struct br_contact *contact, const struct br_friction *friction, double u);

#endif
