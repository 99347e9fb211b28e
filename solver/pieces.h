/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_PIECES_H
#define BR_PIECES_H

#include "solver/linear_solver.h"

/* For both fields. */
extern const struct br_field_solver br_pieces;

#endif
