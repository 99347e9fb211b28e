/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/linear_solver.h"

#include <string.h>

const struct br_linear_options br_linear_defaults = {.scaling = "none", .refinement = 0};

const struct br_linear_solver *const br_linear_solvers[] = {
    &br_riccati,
    &br_plain,
    &br_umfpack,
    NULL,
};

const struct br_linear_solver *br_linear_solver_find(const char *name)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        if (strcmp((*s)->name, name) == 0)
            return *s;
    return NULL;
}
