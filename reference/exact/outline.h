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

/* Numbers. */
struct br_list {
    double *at; /* count; of a store */
    size_t count, room;
};
enum br_status br_list_add(struct br_list *list, double value, struct br_store *store,
                           struct br_error *err);

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

struct br_sight {
    const struct br_function *f;
    size_t degree[2];       /* by br_variable: of the polynomials, up to 15 */
    double mean;            /* of |f| over all that counts, see br_sight_mean */
    double most_missed;     /* integral of |f| that a cell may hold unseen */
    double least;           /* narrower cells are not looked into */
    size_t most;            /* cells */
    struct br_store *store; /* of the lists */
    double missed;          /* out: integral that cells may hold unseen, in all */
};

/* Adds the ends of cells inside of the box along one variable, for a function of that variable
 * alone (at the other's low end). Fails with BR_NOT_FINITE: too many, BR_BAD_INPUT where the
 * function is not finite, or BR_NO_MEMORY. */
enum br_status br_sight_along(struct br_sight *sight, enum br_variable along, struct br_box box,
                              struct br_list *ends, struct br_error *err);

/* The same along both variables at once, for a function that cannot be split, in whose box guards
 * may move. */
enum br_status br_sight_both(struct br_sight *sight, struct br_box box, struct br_list *ends[2],
                             struct br_error *err);

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
    struct br_list end;    /* of the elements, m: from 0 to L */
    struct br_breaks jump; /* times inside of (0, T) at which the data jump or bend */
    struct br_list *cell;  /* cells: in each, ends of cells in time, s, that no step may overlook */
    size_t cells;
    bool fronts;   /* places where the load jumps move */
    double missed; /* of the load's integral: what proofs could not exclude */
    double proved; /* likewise, what polynomials were proved to be away from the data */
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

/* The shortest cell that holds t, infinite for none. */
double br_outline_cell(const struct br_outline *outline, double t);

/* How long a step from t may be: not longer than any cell that it touches. */
double br_outline_reach(const struct br_outline *outline, double t);

#endif
