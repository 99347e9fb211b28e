/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is proved of a function over a box of x and t by its enclosures (function.h): that it is
 * finite, where it breaks, and a mesh on which polynomials approximate it. No proof rests on
 * samples: what cannot be proved is refused. A function whose ops have no bound is refused. */
#ifndef BR_SOLVER_PROOF_H
#define BR_SOLVER_PROOF_H

#include "solver/function.h"

enum br_finite {
    BR_FINITE,     /* everywhere in the box */
    BR_NOT_NUMBER, /* evaluate gives no finite number at the point `where` */
    BR_POLE,       /* it grows without bounds towards `where`, which is at most as wide as two
                      neighbouring numbers */
    BR_UNBOUNDED,  /* it may have no bound in `where`, or too many boxes were examined */
};

/* Whether f is finite everywhere in the box. value: out if it is finite, encloses all its values,
 * perhaps widely; where: out if it is not. */
enum br_finite br_prove_bounded(const struct br_function *f, struct br_box box,
                                struct br_interval *value, struct br_box *where);

/* Encloses the values of a finite function to about a twentieth of their range, or as tightly as
 * 500 boxes allow. peak: out, a point where |f| is about largest. False: it has no bound. */
bool br_enclose_values(const struct br_function *f, struct br_box box, struct br_interval *value,
                       struct br_box *peak);

/* br_prove_bounded as a status: if f is not finite, BR_BAD_INPUT with a message of what was found
 * and where. */
enum br_status br_must_be_finite(const struct br_function *f, struct br_box box,
                                 struct br_error *err);

/* Breaks along one variable, ascending and disjoint intervals. Each is one number, or as wide as
 * two neighbouring numbers; wider where the break is less exactly known, as at a double zero. */
struct br_breaks {
    struct br_interval *at; /* count; owned */
    size_t count;
    bool moving; /* a switching function of both variables changes sign along a curve; such breaks
                  * are not listed
                  */
};
void br_breaks_free(struct br_breaks *breaks);

/* Adds all values of one variable in the box at which a switching function of f changes sign or
 * touches zero: between them f is smooth, except for functions like sqrt at zero. Where the other
 * variable is one point, or for switching functions without it, none is missed. *breaks: in/out,
 * zeroed at first; the breaks of several functions may be added. The box's ends are no breaks.
 * Fails with BR_BAD_INPUT where there are too many (20,000) or cannot be separated, naming where,
 * or BR_NO_MEMORY. */
enum br_status br_breaks_add(const struct br_function *f, enum br_variable along, struct br_box box,
                             struct br_breaks *breaks, struct br_error *err);

/* Adds the times at which a switching function that depends on x and t, such as x - c t, is zero at
 * an end of the box in x: there a front enters or leaves. Times at which a front turns back or
 * begins inside the box are not among them. Fails as br_breaks_add. */
enum br_status br_front_times(const struct br_function *f, struct br_box box,
                              struct br_breaks *breaks, struct br_error *err);

/* How polynomials have to approximate a function. */
struct br_mesh_aim {
    size_t degree;    /* of the interpolant at a cell's Chebyshev nodes, 1 to 15 */
    double tolerance; /* of |f - interpolant|, absolute, in f's unit */
};

/* Cells between count + 1 ascending points. In a rough cell the function is bounded, but no
 * polynomial is proved to approximate it: width * (range of values) is at most tolerance * (width
 * of the box). Jumps and zeros of sqrt are there. */
struct br_mesh {
    double *at;  /* count + 1; owned */
    bool *rough; /* count; owned */
    size_t count, capacity;
    double missed; /* sum of width * (range of values) over the rough cells */
};
void br_mesh_free(struct br_mesh *mesh);

/* Meshes the box along one variable so that in each cell, for all values of the other variable in
 * the box, the function is proved to lie within the tolerance of its interpolant at the Chebyshev
 * nodes, by |error| <= |f^(d+1) / (d+1)!| 2 (width / 4)^(d+1); or the cell is rough. Breaks are
 * ends of cells. *mesh: out. Fails with BR_BAD_INPUT where the cells are too many, naming where, or
 * BR_NO_MEMORY. */
enum br_status br_resolve(const struct br_function *f, enum br_variable along, struct br_box box,
                          const struct br_mesh_aim *aim, struct br_mesh *mesh,
                          struct br_error *err);

#endif
