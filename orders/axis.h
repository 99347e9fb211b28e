/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is refined, and why a number does not count. */
#ifndef BR_ORDERS_AXIS_H
#define BR_ORDERS_AXIS_H

#include <stdbool.h>
#include <stddef.h>

enum br_axis { BR_AXIS_SPACE, BR_AXIS_TIME, BR_AXES };
extern const char *const br_axis_letters[BR_AXES]; /* "h", "k" */

/* A discretisation: n equal elements, and equal time steps; zeros: not known. */
struct br_resolution {
    size_t n, steps;
};

/* Why a number is left out of the fits. */
enum br_flag {
    BR_FLAG_NONE,
    BR_FLAG_REFERENCE, /* the reference's own error is not small beside it */
    BR_FLAG_ROUND_OFF, /* it is at the round-off of a solver */
    BR_FLAG_FAILED,    /* the march failed, or its error is not a number */
    BR_FLAG_UNSTABLE,  /* lagged contact beyond its stability limit: bounded chatter */
    BR_FLAG_STALLED,   /* finer grids have no smaller error */
    BR_FLAG_COARSE,    /* the grid is too coarse for the order of the finer ones */
    BR_FLAG_OUTLIER,   /* the error is far from those of its neighbours */
    BR_FLAG_BY_HAND,   /* it is outside of the window that was asked for */
    BR_FLAG_ABSENT,    /* its study has no such row */
    BR_CELL_FLAGS
};
/* "", "reference", "round-off", "failed", "unstable", "stagnation", "not asymptotic", "outlier",
 * "by hand", "" */
const char *br_flag_name(enum br_flag flag);

/* Whether a number has a part in the study, left out or not. */
static inline bool br_has_part(enum br_flag flag)
{
    return flag != BR_FLAG_BY_HAND && flag != BR_FLAG_ABSENT;
}

#endif
