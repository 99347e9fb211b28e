/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The element loops of the fast solver: BR_LANES pieces of equal length side by side, one in each
 * lane of a vector. All arrays hold BR_LANES values for each entry, element 0 at a piece's right
 * end. */
#ifndef BR_SWEEP_KERNEL_H
#define BR_SWEEP_KERNEL_H

#include <stdbool.h>
#include <stddef.h>

enum { BR_LANES = 8 };

/* What an element needs, shared by all pieces; d = 1 for axial, 2 for bending; by rows. */
struct br_sweep_table {
    const double *gain;   /* per element A', -K'R, -S^-1, -K: 4 d^2 */
    const double *weight; /* per element X and Y, what it adds to z and q: 2 d^2 */
};

struct br_sweep {
    int d;
    size_t length; /* elements of a piece */
    struct br_sweep_table table;
    const double *load; /* sigma, d an element: S's share of s for a load of factor 1; NULL: none */
    bool lanewise;      /* load has BR_LANES values each, not one for all */
    double factor;
    double r[2], alpha, k;
    double *state;        /* in, out: g and kappa_w, 2 d an element */
    double *scratch;      /* d an element */
    const double *right;  /* the costate at the right ends, d */
    const double *left;   /* the increment at the left ends, d */
    double *q, *z;        /* out: what the new state adds to the joins, d each */
    double *velocity;     /* out: at the right ends, relative to fixed left ends, d */
    double *displacement; /* out: the same, axial only */
};

/* One step of a block of pieces. */
typedef void br_sweep_step(const struct br_sweep *sweep);

/* The displacement at the right ends of a block of pieces whose left ends are fixed, d (out). */
typedef void br_sweep_carry(const struct br_sweep *sweep, double *displacement);

struct br_kernel {
    const char *name; /* the instruction set */
    bool (*available)(void);
    br_sweep_step *step;
    br_sweep_carry *carry;
};

/* NULL-terminated, the fastest first; the last runs anywhere. */
extern const struct br_kernel *const br_kernels[];

/* The first that is available. */
const struct br_kernel *br_kernel_best(void);

/* The kernel of that name, available or not; NULL: there is none. */
const struct br_kernel *br_kernel_find(const char *name);

#endif
