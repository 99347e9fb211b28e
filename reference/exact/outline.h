/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is known of a field's data before it is solved: on which elements, and at which steps. */
#ifndef BR_REFERENCE_EXACT_OUTLINE_H
#define BR_REFERENCE_EXACT_OUTLINE_H

#include "reference/exact/sight.h"
#include "solver/scene.h"

/* What axial and bending have in common. */
struct br_exact_data {
    double stiffness, viscosity;
    const struct br_load *load;
    const struct br_function *tip_force, *tip_moment; /* the moment NULL for axial */
    const struct br_function *displacement, *velocity;
    const struct br_function *slope; /* of the displacement, derived degree - 1 times */
};

/* Degree 1 is the axial, 2 the bending field. */
struct br_exact_data br_exact_data_of(const struct br_scene *scene, size_t degree);

struct br_outline {
    size_t degree;         /* of the field: 1 axial, 2 bending */
    struct br_list end;    /* of the elements, m: from 0 to L */
    struct br_breaks jump; /* times inside of (0, T) at which the data jump or bend */
    struct br_list *cell;  /* cells: in each, ends of cells in time, s, that no step may overlook */
    size_t cells;
    bool fronts;   /* places where the load jumps move */
    double missed; /* of the load's integral: what proofs could not exclude */
    double proved; /* likewise, what polynomials were proved to be away from the data */
};

/* Clear it even after a failure: BR_NOT_FINITE, the data have details that are too fine,
 * BR_BAD_INPUT where they are not finite, or BR_NO_MEMORY. */
enum br_status br_outline_init(struct br_outline *outline, const struct br_scene *scene,
                               size_t degree, struct br_error *err);
void br_outline_clear(struct br_outline *outline);

/* The number of polynomials on element e in a solution where `modes` would do on one. */
size_t br_outline_terms(const struct br_outline *outline, size_t e, size_t modes);

/* Whether the data change so fast within `width` of t that a cell is shorter than that. */
bool br_outline_is_sharp(const struct br_outline *outline, double t, double width);

/* The shortest cell that holds t, infinite for none. */
double br_outline_cell(const struct br_outline *outline, double t);

/* How long a step from t may be: not longer than any cell that it touches. */
double br_outline_reach(const struct br_outline *outline, double t);

#endif
