/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Intervals and boxes, for files that prove something of functions. */
#ifndef BR_SOLVER_BOX_H
#define BR_SOLVER_BOX_H

#include <math.h>

#include "solver/proof.h"

typedef struct br_interval iv;

static inline iv point(double a)
{
    return (iv){a, a};
}

static inline double width(iv a)
{
    return a.high - a.low;
}

static inline double middle(iv a)
{
    return a.low + (a.high - a.low) / 2;
}

/* Whether there is a double between both ends. */
static inline bool is_divisible(iv a)
{
    return a.low < middle(a) && middle(a) < a.high;
}

static inline iv *side(struct br_box *box, enum br_variable v)
{
    return v == BR_X ? &box->x : &box->t;
}

static inline struct br_box with(struct br_box box, enum br_variable v, iv a)
{
    *side(&box, v) = a;
    return box;
}

static inline double magnitude(iv a) /* the largest |a| */
{
    return fmax(fabs(a.low), fabs(a.high));
}

/* Both halves of a box; or, where no double lies between the faces, both faces. */
static inline void split(struct br_box box, enum br_variable v, struct br_box half[2])
{
    const iv a = *side(&box, v);
    const bool divisible = is_divisible(a);
    half[0] = with(box, v, divisible ? (iv){a.low, middle(a)} : point(a.low));
    half[1] = with(box, v, divisible ? (iv){middle(a), a.high} : point(a.high));
}

/* The box, in which a variable that f does not use is one point. */
static inline struct br_box used_box(const struct br_function *f, struct br_box box)
{
    return (struct br_box){f->uses_x ? box.x : point(box.x.low),
                           f->uses_t ? box.t : point(box.t.low)};
}

/* Writes the middle of a box, in the variables that f uses, as "x = 0.3333 m, t = 1 s". */
void br_name_position(const struct br_function *f, struct br_box box, char text[80]);

#endif
