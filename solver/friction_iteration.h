/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rules of friction.h's registry that iterate. */
#ifndef BR_SOLVER_FRICTION_ITERATION_H
#define BR_SOLVER_FRICTION_ITERATION_H

#include "solver/friction.h"

extern const struct br_friction_rule br_penalty_duality, br_uzawa;

#endif
