/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march, seen in one of the measures of modes.h. */
#ifndef BR_SOLVER_LOOK_H
#define BR_SOLVER_LOOK_H

#include "solver/march.h"
#include "solver/modes.h"

/* view: out, with br_measure_size values where its values point to; the tip has one, in m. */
void br_look(const struct br_march *march, enum br_field_kind kind, enum br_measure measure,
             struct br_view *view);

#endif
