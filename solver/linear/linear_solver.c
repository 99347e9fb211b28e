/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/linear/linear_solver.h"

#include <math.h>
#include <string.h>

const struct br_linear_solver *const br_linear_solvers[] = {
    &br_auto, &br_riccati, &br_plain, &br_umfpack, NULL,
};

const struct br_linear_solver br_auto = {
    .name = "auto",
    .title = "the fastest of the others for the mesh, the elements and the time scheme",
    .citation = "costs as measured, see their rows",
    .takes_kernel = true,
};

const struct br_linear_solver *br_linear_solver_find(const char *name)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        if (strcmp((*s)->name, name) == 0)
            return *s;
    return NULL;
}

double br_by_element_of(const struct br_by_element *values, const struct br_field *field)
{
    if (field->kind == BR_BENDING)
        return values->bending;
    return br_field_is_quadratic(field) ? values->quadratic : values->axial;
}

static const struct br_field_solver *own_solver(const struct br_linear_solver *solver,
                                                const struct br_field *field)
{
    if (field->kind == BR_BENDING)
        return solver->bending;
    return br_field_is_quadratic(field) ? solver->axial_quadratic : solver->axial;
}

bool br_linear_solver_chooses(const struct br_linear_solver *row)
{
    return !row->axial && !row->axial_quadratic && !row->bending;
}

static bool has_cost(const struct br_linear_solver *row)
{
    return row->cost || row->step_cost > 0;
}

double br_linear_solver_cost(const struct br_linear_solver *row, const struct br_field *field,
                             double sums)
{
    static const struct br_by_element sum = {0.65, 1.3, 1.3};
    if (!has_cost(row)) /* a cost of 0 would let any march begin */
        row = &br_plain;
    if (row->cost)
        return row->cost(field, sums);
    return row->step_cost + 42 * sums +
           (double)field->n *
               (br_by_element_of(&row->element_cost, field) + sums * br_by_element_of(&sum, field));
}

const struct br_linear_solver *br_linear_solver_taken(const struct br_linear_solver *solver,
                                                      const struct br_field *field, double sums)
{
    if (!br_linear_solver_chooses(solver))
        return solver;
    const struct br_linear_solver *best = NULL;
    double least = INFINITY;
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        const bool known = own_solver(*s, field) && has_cost(*s);
        const double cost = known ? br_linear_solver_cost(*s, field, sums) : INFINITY;
        if (cost < least) {
            least = cost;
            best = *s;
        }
    }
    return best;
}

const struct br_field_solver *br_linear_solver_for(const struct br_linear_solver *solver,
                                                   const struct br_field *field)
{
    const struct br_linear_solver *taken = br_linear_solver_taken(solver, field, 0);
    return taken ? own_solver(taken, field) : NULL;
}
