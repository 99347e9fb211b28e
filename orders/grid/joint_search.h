/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search for models of a grid of errors, between its parts: joint_search.c tries them,
 * joint_fit.c makes one answer of them. */
#ifndef BR_ORDERS_GRID_JOINT_SEARCH_H
#define BR_ORDERS_GRID_JOINT_SEARCH_H

#include "orders/grid/joint_model.h"

enum { BR_JOINT_TRIALS = 600, BR_JOINT_WINDOWS = 12, BR_JOINT_SIZES = 64 };

struct br_joint_candidate {
    struct br_joint_trial trial;
    double log_weight;             /* of the mixture, then the weight; -infinite: there is no fit */
    double deviation[BR_UNKNOWNS]; /* of values in m and s */
    double tails[BR_AXES]; /* times as wide as its freedom says is the 99 % interval of an order */
    size_t window, laws;   /* laws: how many bend a power, or are a floor */
    bool widened;
};

/* The cells that count: without those that are far off what the others show, and without so many
 * of the coarsest sizes. */
struct br_joint_window {
    bool far;
    size_t lost[BR_AXES];
    double log_prior;
};

/* A law that a model may have: a family of laws.h, or an order that changes along an axis. */
struct br_joint_option {
    struct br_family family;
    int axes; /* that may have it, as bits; 0: it is a floor */
};

struct br_joint_search {
    struct br_joint_cells all, used; /* all cells; those of a window */
    struct br_joint_cell *rest;      /* room for so many again, for the jackknife */
    bool *far;                       /* of all cells */
    double *residual;                /* room for one of each cell */
    double unit[BR_AXES], log_error; /* of scaled sizes and errors: logarithms in m, s, m^(3/2) */
    bool any_model;
    struct br_joint_window window[BR_JOINT_WINDOWS];
    size_t windows, now;
    struct br_joint_candidate *candidate;
    size_t count;
    double best; /* the largest log_weight */
    struct br_joint_option option[BR_FAMILIES + 4 * BR_JOINT_SIZES];
    size_t smooth, options; /* those from `smooth` on are of orders that change */
};

/* Tries models of these points: all candidates, in any order. s: its memory, all.count and
 * any_model are set. */
void br_joint_search(struct br_joint_search *s, const struct br_point *point);

/* Goes to a window: its cells are used from here on. */
void br_joint_look_at(struct br_joint_search *s, size_t window);

/* Whether cell i is outside a window. */
bool br_joint_is_out(const struct br_joint_search *s, const struct br_joint_window *w, size_t i);

/* The values of a trial in m and s: a constant is that of the power, at a size of one. */
void br_joint_in_units(const struct br_joint_search *s, const struct br_joint_trial *t,
                       double value[BR_UNKNOWNS]);

/* Whether the order changes along an axis. */
bool br_joint_changes_along(const struct br_joint_law *law, int axis);

#endif
