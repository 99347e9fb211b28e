/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march, seen in one of the measures of modes.h. */
#ifndef BR_LOOK_H
#define BR_LOOK_H

#include "solver/march.h"
#include "solver/modes.h"

/* values (out): br_measure_size of them; work: br_field_size doubles. */
void br_look(const struct br_march *march, enum br_field_kind kind, enum br_measure measure,
             double *work, double *values);

#endif
