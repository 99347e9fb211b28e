/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is known of a field's data before it is solved: on which elements, and at which steps. It
 * comes from what is proved of a scene's functions (solver/proof.h): where they jump, and meshes on
 * whose cells polynomials stand for them, in proportion to their size nearby. A function of which
 * nothing is proved is taken for smooth. */
#ifndef BR_REFERENCE_EXACT_OUTLINE_H
#define BR_REFERENCE_EXACT_OUTLINE_H

#include "reference/exact/pieces.h"
#include "solver/scene.h"

/* ---- one function (sight.c) ---- */

/* What a polynomial may miss, of the largest value in its cell or of the mean, if that is more. */
#define BR_SIGHT_TOLERANCE 1e-11

/* Of the polynomials on an element, and of those that the rules over a step integrate. */
enum { BR_SIGHT_DEGREE = 15 };

/* Numbers. */
struct br_list {
    double *at; /* count; of a store */
    size_t count, room;
};

/* After a failure, which the store keeps, the value is missing. */
void br_list_add(struct br_list *list, double value, struct br_store *store);

/* Sorts, and keeps one of those that are the same. */
void br_list_sort(struct br_list *list);

static inline struct br_interval *br_side(struct br_box *box, enum br_variable along)
{
    return along == BR_X ? &box->x : &box->t;
}

/* Of how much a polynomial along one variable misses f in the box at most; infinite where f is not
 * smooth. */
double br_sight_error(const struct br_function *f, enum br_variable along, struct br_box box,
                      size_t degree);

/* The mean of |f| over a box of one or two variables, at least half of it where it can be found. */
double br_sight_mean(const struct br_function *f, struct br_box box);

/* A function and where it is needed: of a variable that it does not use, or of whose other values
 * none matters, the box has one. */
struct br_sight {
    const struct br_function *f;
    struct br_box box;
    double mean;   /* br_sight_mean of the box */
    double missed; /* out: share of its integral that cells may hold unseen, in all */
};

/* Adds the ends of cells inside of a part of the box along each of its variables. For a function
 * of both, guards may move in the part. Fails with BR_NOT_FINITE: too many, BR_BAD_INPUT where the
 * function is not finite, or BR_NO_MEMORY. */
enum br_status br_sight_mesh(struct br_sight *sight, struct br_box part, struct br_list ends[2],
                             struct br_store *store, struct br_error *err);

/* ---- a field (outline.c) ---- */

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
    struct br_list end[2]; /* by br_variable: of the elements, m, from 0 to L; of cells in time, s,
                              that no step may overlook, from 0 to T */
    struct br_breaks jump; /* times inside of (0, T) at which the data jump or bend */
    bool fronts;           /* places where the load jumps move */
    double missed;         /* of the load's integral: what proofs could not exclude */
    double proved;         /* likewise, what polynomials were proved to be away from the data */
    struct br_store store;
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

/* The length of the cell that holds t, infinite where it is the only one; where two meet the later
 * one. */
double br_outline_cell(const struct br_outline *outline, double t);

/* How long a step from t may be: not longer than any cell that it touches. */
double br_outline_reach(const struct br_outline *outline, double t);

#endif
