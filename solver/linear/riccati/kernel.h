/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of the fast solver: BR_LANES equal segments of the beam side by side, one in each lane
 * of the vectors. A segment is cut into panels, each of which fits the first-level cache. All
 * arrays go from the left end to the right one and have BR_LANES values for each entry; tables have
 * one for all lanes. d is the number of unknowns a node: 1 axial, 2 bending; it is a constant of
 * the loops. The mathematics is in panels.h. */
#ifndef BR_SOLVER_KERNEL_H
#define BR_SOLVER_KERNEL_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/instruction_set.h"

enum { BR_LANES = 16 };

/* The end values of a panel, d * BR_LANES each. */
enum {
    BR_END_Q,      /* what its state adds to its left costate */
    BR_END_Z,      /* and to its right increment */
    BR_END_LOAD_Q, /* what a load of factor 1 adds to these */
    BR_END_LOAD_Z,
    BR_END_H,     /* right costate without C y */
    BR_END_DRIFT, /* z with that of the load */
    BR_ENDS
};

/* The join of a panel, or a segment, to what lies to its right, d by d each, by rows. */
enum {
    BR_JOIN_PASS,     /* M Phi */
    BR_JOIN_GAIN,     /* M */
    BR_JOIN_YIELD,    /* M Z */
    BR_JOIN_COSTATE,  /* C */
    BR_JOIN_TRANSFER, /* Phi'C M */
    BR_SEGMENT_JOINS,
    BR_JOIN_LEAD = BR_SEGMENT_JOINS, /* what z adds to the segment's z */
    BR_JOIN_LAG,                     /* and what h subtracts from it */
    BR_JOIN_REACH,                   /* h for a unit costate at the segment's right end */
    BR_JOINS
};

struct br_segments {
    size_t panels, length; /* of a segment; elements of a panel */
    double *gain;          /* per element of a panel K, S^-1, A: 3 d^2 */
    double *weight;        /* per element what g adds to z and q: 2 d^2 */
    double *join;          /* BR_JOINS d^2 a panel */
    double *segment_join;  /* BR_SEGMENT_JOINS d^2, each for every lane */
    size_t lanes;          /* number in use, from the first on; the others stay 0 */
    double alpha, k;       /* g = alpha kappa_w + kappa_v; the time step, s */
    double *state;         /* 2 d an element: kappa_w and kappa_v */
    double *load;    /* d an element: F / R at its left node; NULL: none, or the same everywhere */
    double *end;     /* BR_ENDS d a panel */
    double *scratch; /* d an element of one panel */
};

/* The load on a group of segments in one step. */
struct br_segment_drive {
    double factor;     /* of the load */
    double uniform[2]; /* F / R at every node, for a factor of 1; used where group of segments->load
                          is NULL */
};

/* The ends of the segments, d * BR_LANES each. */
struct br_segment_ends {
    double *right, *left; /* in: the costates at the right ends, the increments at the left ones */
    double *velocity;     /* out: at the right ends, relative to fixed left ends */
    double *displacement; /* out: the displacement, axial only */
};

struct br_loops {
    /* What state and load of all panels add to the segments' left costates, q, and right
     * increments, z (out, d each). */
    void (*gather)(const struct br_segments *segments, double factor, double *q, double *z);

    /* The recursion over the segments of a group of segments. join_left goes to the left: h belongs
     * to the group of segments's right end (in), then to its left end (out); `right` (out, d each)
     * keeps h for each segment. join_right goes to the right: y is the increment at the group of
     * segments's left end (in), then at its right end (out); `left` and `right` (out) are those of
     * struct br_segment_ends. */
    void (*join_left)(const struct br_segments *segments, const double *q, const double *z,
                      double *h, double *right);
    void (*join_right)(const struct br_segments *segments, const double *z, double *y, double *left,
                       double *right);

    /* One step, after gather. */
    void (*advance)(const struct br_segments *segments, const struct br_segment_drive *drive,
                    const struct br_segment_ends *ends);

    /* What the load adds to the ends of the panels. */
    void (*charge)(const struct br_segments *segments, const double uniform[2]);

    /* The state becomes the sum over j < count of weight[j] times the states from[j], one of which
     * may be the state itself; with count 0 it does not change. Also computes what the state adds
     * to the ends of the panels, q and z, as advance does. */
    void (*blend)(const struct br_segments *segments, size_t count, const double *const *from,
                  const double *weight);

    /* Sums (out) of the squares of a state's kappa_w and kappa_v, in the lanes that are in use. */
    void (*square)(const struct br_segments *segments, const double *state, double sum[2]);

    /* The displacement or its rate at the right ends of segments whose left ends are fixed (out, d
     * each). */
    void (*carry)(const struct br_segments *segments, bool rate, double *across);

    /* The displacement or its rate at every node except the left end of the first segment, in order
     * (out, d a node); left: its values at the segments' left ends (in, d each). */
    void (*expand)(const struct br_segments *segments, bool rate, const double *left,
                   double *nodal);
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
