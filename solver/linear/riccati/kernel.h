/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of the fast solver: BR_LANES equal spans of the beam side by side, one in each lane of
 * the vectors. A span is cut into pieces, each of which fits the first-level cache. All arrays go
 * from the left end to the right one and have BR_LANES values for each entry; tables have one for
 * all lanes. d is the number of unknowns a node: 1 axial, 2 bending; it is a constant of the loops.
 * The mathematics is in pieces.h. */
#ifndef BR_SOLVER_KERNEL_H
#define BR_SOLVER_KERNEL_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/instruction_set.h"

enum { BR_LANES = 16 };

/* The end values of a piece, d * BR_LANES each. */
enum {
    BR_END_Q,      /* what its state adds to its left costate */
    BR_END_Z,      /* and to its right increment */
    BR_END_LOAD_Q, /* what a load of factor 1 adds to these */
    BR_END_LOAD_Z,
    BR_END_H,     /* right costate without C y */
    BR_END_DRIFT, /* z with that of the load */
    BR_ENDS
};

/* The join of a piece, or a span, to what lies to its right, d by d each, by rows. */
enum {
    BR_JOIN_PASS,     /* M Phi */
    BR_JOIN_GAIN,     /* M */
    BR_JOIN_YIELD,    /* M Z */
    BR_JOIN_COSTATE,  /* C */
    BR_JOIN_TRANSFER, /* Phi'C M */
    BR_SPAN_JOINS,
    BR_JOIN_LEAD = BR_SPAN_JOINS, /* what z adds to the span's z */
    BR_JOIN_LAG,                  /* and what h subtracts from it */
    BR_JOIN_REACH,                /* h for a unit costate at the span's right end */
    BR_JOINS
};

struct br_strip {
    size_t pieces, length; /* of a span; elements of a piece */
    double *gain;          /* per element of a piece K, S^-1, A: 3 d^2 */
    double *weight;        /* per element what g adds to z and q: 2 d^2 */
    double *join;          /* BR_JOINS d^2 a piece */
    double *span_join;     /* BR_SPAN_JOINS d^2, each for every lane */
    size_t lanes;          /* number in use, from the first on; the others stay 0 */
    double alpha, k;       /* g = alpha kappa_w + kappa_v; the time step, s */
    double *state;         /* 2 d an element: kappa_w and kappa_v */
    double *load;    /* d an element: F / R at its left node; NULL: none, or the same everywhere */
    double *end;     /* BR_ENDS d a piece */
    double *scratch; /* d an element of one piece */
};

/* The load on a strip in one step. */
struct br_strip_drive {
    double factor;     /* of the load */
    double uniform[2]; /* F / R at every node, for a factor of 1; used where strip->load is NULL */
};

/* The ends of the spans, d * BR_LANES each. */
struct br_strip_ends {
    double *right, *left; /* in: the costates at the right ends, the increments at the left ones */
    double *velocity;     /* out: at the right ends, relative to fixed left ends */
    double *displacement; /* out: the displacement, axial only */
};

struct br_loops {
    /* What state and load of all pieces add to the spans' left costates, q, and right increments,
     * z (out, d each). */
    void (*gather)(const struct br_strip *strip, double factor, double *q, double *z);

    /* The recursion over the spans of a strip. join_left goes to the left: h belongs to the strip's
     * right end (in), then to its left end (out); `right` (out, d each) keeps h for each span.
     * join_right goes to the right: y is the increment at the strip's left end (in), then at its
     * right end (out); `left` and `right` (out) are those of struct br_strip_ends. */
    void (*join_left)(const struct br_strip *strip, const double *q, const double *z, double *h,
                      double *right);
    void (*join_right)(const struct br_strip *strip, const double *z, double *y, double *left,
                       double *right);

    /* One step, after gather. */
    void (*advance)(const struct br_strip *strip, const struct br_strip_drive *drive,
                    const struct br_strip_ends *ends);

    /* What the load adds to the ends of the pieces. */
    void (*charge)(const struct br_strip *strip, const double uniform[2]);

    /* The state becomes the sum over j < count of weight[j] times the states from[j], one of which
     * may be the state itself; with count 0 it does not change. Also computes what the state adds
     * to the ends of the pieces, q and z, as advance does. */
    void (*blend)(const struct br_strip *strip, size_t count, const double *const *from,
                  const double *weight);

    /* Sums (out) of the squares of a state's kappa_w and kappa_v, in the lanes that are in use. */
    void (*square)(const struct br_strip *strip, const double *state, double sum[2]);

    /* The displacement or its rate at the right ends of spans whose left ends are fixed (out, d
     * each). */
    void (*carry)(const struct br_strip *strip, bool rate, double *across);

    /* The displacement or its rate at every node except the left end of the first span, in order
     * (out, d a node); left: its values at the spans' left ends (in, d each). */
    void (*expand)(const struct br_strip *strip, bool rate, const double *left, double *nodal);
};

struct br_kernel {
    const char *name;                /* the instruction set */
    bool (*available)(void);         /* on this machine */
    const struct br_loops *loops[2]; /* by br_field_kind */
};

/* NULL-terminated, the fastest first; the last runs anywhere. */
extern const struct br_kernel *const br_kernels[];

/* The first that is available. */
const struct br_kernel *br_kernel_best(void);

/* The kernel of that name, available or not; NULL: there is none. */
const struct br_kernel *br_kernel_find(const char *name);

#endif
