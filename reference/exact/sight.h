/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is proved of a scene's functions (solver/proof.h), as the exact reference needs it: where
 * they jump, and meshes on whose cells polynomials stand for them, in proportion to their size
 * nearby. A function of which nothing is proved is taken for smooth. */
#ifndef BR_REFERENCE_EXACT_SIGHT_H
#define BR_REFERENCE_EXACT_SIGHT_H

#include "solver/proof.h"

/* What a polynomial may miss, of the largest value in its cell or of the mean, if that is more. */
#define BR_SIGHT_TOLERANCE 1e-11

/* Ascending numbers. */
struct br_list {
    double *at; /* count; owned */
    size_t count, room;
};
void br_list_free(struct br_list *list);
enum br_status br_list_add(struct br_list *list, double value, struct br_error *err);

/* Sorts, and keeps one of those that are closer than `least` to each other. */
void br_list_sort(struct br_list *list, double least);

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
    size_t degree[2];   /* by br_variable: of the polynomials, up to 15 */
    double mean;        /* of |f| over all that counts, see br_sight_mean */
    double most_missed; /* integral of |f| that a cell may hold unseen */
    double least;       /* narrower cells are not looked into */
    size_t most;        /* cells */
    double missed;      /* out: integral that cells may hold unseen, in all */
};

/* Adds the ends of cells inside of the box along one variable, for a function of that variable
 * alone (at the other's low end). Fails with BR_NOT_FINITE: too many, BR_BAD_INPUT where the
 * function is not finite, or BR_NO_MEMORY. */
enum br_status br_sight_along(struct br_sight *sight, enum br_variable along, struct br_box box,
                              struct br_list *ends, struct br_error *err);

/* The same along both variables at once, for a function that cannot be split, in whose box guards
 * may move. */
enum br_status br_sight_both(struct br_sight *sight, struct br_box box, struct br_list ends[2],
                             struct br_error *err);

#endif
