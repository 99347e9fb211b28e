/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is proved of a scene's functions (solver/proof.h), as the exact reference needs it: where
 * they jump, and meshes on whose cells polynomials stand for them, in proportion to their size
 * nearby. A function of which nothing is proved is taken for smooth. */
#ifndef BR_SIGHT_H
#define BR_SIGHT_H

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

struct br_sight {
    size_t degree; /* of the polynomials, up to 15 */
    double least;  /* narrower cells are not looked into */
    size_t most;   /* cells */
};

enum br_fit { BR_FITS, BR_TOO_WIDE, BR_NOT_SMOOTH };

/* Whether a polynomial along one variable stands for f in the whole box, to the tolerance times
 * `size`. */
enum br_fit br_sight_fit(const struct br_function *f, enum br_variable along, struct br_box box,
                         size_t degree, double size);

/* Adds the ends of cells along one variable, those of the box included, for a function of that
 * variable alone (at the other's low end). *missed: out, what rough cells may miss, of the integral
 * of |f|. Fails as br_resolve. */
enum br_status br_sight_along(const struct br_function *f, enum br_variable along,
                              struct br_box box, const struct br_sight *sight, struct br_list *ends,
                              double *missed, struct br_error *err);

/* The same along both variables at once, for a function that cannot be split, in whose box guards
 * may move. */
enum br_status br_sight_both(const struct br_function *f, struct br_box box,
                             const struct br_sight sight[2], struct br_list ends[2],
                             double *missed, struct br_error *err);

#endif
