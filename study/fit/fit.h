/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The joint fit of the errors of a study, and which of its cells count. */
#ifndef BR_STUDY_FIT_FIT_H
#define BR_STUDY_FIT_FIT_H

#include "base/observer.h"
#include "orders/orders.h"
#include "study/grid/study.h"

struct br_fits {
    struct br_numbers numbers; /* one component of a study's errors with its flags, */
    struct br_orders orders;   /* and their orders, which borrow them */
    struct br_joint_fit joint; /* of these */
    double reference_error;    /* the reference's own error, m^(3/2); NaN: not known */
};

/* Fits one component of a study's errors without the flagged cells, and sets the flags of this
 * component: of cells whose error is less than br_flag_margin times what limits it. The reference's
 * own error comes from the fit, so both are repeated until no flag changes. A fit that cannot be
 * done is NaN. Fails with BR_NO_MEMORY or BR_BAD_INPUT (more than BR_MOST_ROWS cells); clear it
 * even then. */
enum br_status br_fit(struct br_study *study, enum br_part part, struct br_fits *fits,
                      struct br_error *err);
void br_fits_clear(struct br_fits *fits); /* accepts zeros */

/* Sets the flags of a study that is shown but not fitted. A reference's own error that needs the
 * fit is not known, and flags nothing. */
void br_flag_beside(struct br_study *study);

/* The margin: a cell is flagged when its error is below this many times the
 * reference's own error or the predicted round-off. */
extern const double br_flag_margin;

#endif
