/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L2 distances between functions on nested meshes, exactly.
 *
 * On each element a function is given by its orthonormal Legendre modes, as a view of it
 * has them (solver/modes.h).
 * The reference is projected from its own meshes down a ladder of coarser ones; what each rung
 * loses is kept as a sum of squares. For a function v of rung n,
 *     |v - ref|^2 = |v - P_n ref|^2 + |ref - P_n ref|^2    (Pythagoras),
 * and both terms are sums of squares of small numbers: no sampling, no
 * quadrature, and no cancellation as in |ref|^2 - 2(ref, v) + |v|^2. */
#ifndef BR_STUDY_GRID_LADDER_H
#define BR_STUDY_GRID_LADDER_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/instruction_set.h"
#include "solver/modes.h"
#include "solver/status.h"

struct br_ladder;
struct br_ladder_kernel;

/* Numbers of elements; borrowed. */
struct br_mesh_list {
    size_t count;
    const size_t *n;
};

/* A ladder for functions with 1 to 4 modes an element, from one or more
 * root meshes down to the rungs, every one of which divides a root (it may be one).
 * *ladder: out, owned by the store. Fails with BR_BAD_INPUT (not nested) or BR_NO_MEMORY. */
enum br_status br_ladder_create(struct br_ladder **ladder, size_t modes,
                                const struct br_mesh_list *roots, const struct br_mesh_list *rungs,
                                struct br_store *store, struct br_error *err);

/* Takes this kernel, not the best one; its last digits are its own. */
void br_ladder_use(struct br_ladder *ladder, const struct br_ladder_kernel *kernel);

/* Doubles in a projection of one function onto all rungs, a multiple of 8: fastest at the start
 * of a cache line. */
size_t br_ladder_size(const struct br_ladder *ladder);

/* Projects a function given on every root mesh (in) onto all rungs; `projection`: out,
 * br_ladder_size values. */
void br_ladder_project(const struct br_ladder *ladder, const struct br_view *root,
                       double *projection);

/* L2 distance of a function (in) on the mesh n[rung] from the projected one. */
double br_ladder_distance(const struct br_ladder *ladder, size_t rung, const struct br_view *view,
                          const double *projection);

/* L2 norm of the projected function. */
double br_ladder_norm(const struct br_ladder *ladder, const double *projection);

/* ---- kernels ---- */

/* The element loops, elements of a rung side by side in the lanes of vectors.
 * Every sum is taken in an order that depends on the mesh alone. */

/* One rung from its parent. */
struct br_projecting {
    struct br_view fine;    /* a function on ratio * n elements */
    size_t n, ratio;        /* elements of the rung; of its parent's, those in one of the rung */
    const double *transfer; /* E_j of the first (ratio + 1)/2 children, modes^2 by rows each, zero
                               below the diagonal; the others' are their mirror images */
    double *coarse;         /* out: modes in lanes (BR_IN_LANES) */
};

struct br_ladder_kernel {
    const char *name; /* the instruction set */
    size_t lanes;     /* of its vectors, at most BR_MOST_LANES, and of the modes in lanes */
    bool (*available)(void);

    /* coarse = sum_j E_j' fine_j; returns the sum of the squares of what that loses,
     * fine_j - E_j coarse. */
    double (*project)(const struct br_projecting *p);

    /* The sum of the squares of a - b, n elements; b has the modes in lanes. */
    double (*distance)(const struct br_view *a, size_t n, const double *b);
};

#define BR_LADDER_KERNEL(set) extern const struct br_ladder_kernel br_ladder_##set;
BR_INSTRUCTION_SETS(BR_LADDER_KERNEL)

/* In the order of the instruction sets; NULL behind the last. */
extern const struct br_ladder_kernel *const br_ladder_kernels[];

#endif
