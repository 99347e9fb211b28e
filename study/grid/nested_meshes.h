/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L2 distances between functions on nested meshes, exactly.
 *
 * On each element a function is given by its orthonormal Legendre modes, as a view of it
 * has them (solver/modes.h).
 * The reference is projected from its own meshes, the root levels, onto nested coarser meshes,
 * the levels. What each level loses is kept as a sum of squares. For a function v on n elements,
 *     |v - ref|^2 = |v - P_n ref|^2 + |ref - P_n ref|^2    (Pythagoras),
 * and both terms are sums of squares of small numbers: no sampling, no
 * quadrature, and no cancellation as in |ref|^2 - 2(ref, v) + |v|^2. */
#ifndef BR_STUDY_GRID_NESTED_MESHES_H
#define BR_STUDY_GRID_NESTED_MESHES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "solver/instruction_set.h"
#include "solver/modes.h"

struct br_nested_meshes;
struct br_nested_meshes_kernel;

/* Numbers of elements; borrowed. */
struct br_mesh_list {
    size_t count;
    const size_t *n;
};

/* Creates nested meshes for functions with 1 to 4 modes per element, from one or more root levels
 * down to the levels. Each level divides a root level, or is equal to it. *nested: out, owned by
 * the store. Fails with BR_BAD_INPUT (not nested) or BR_NO_MEMORY. */
enum br_status br_nested_meshes_create(struct br_nested_meshes **nested, size_t modes,
                                       const struct br_mesh_list *roots,
                                       const struct br_mesh_list *levels, struct br_store *store,
                                       struct br_error *err);

/* Uses this kernel instead of the best one. The last digits of results depend on the kernel. */
void br_nested_meshes_use(struct br_nested_meshes *nested,
                          const struct br_nested_meshes_kernel *kernel);

/* Doubles in a projection of one function onto all levels, a multiple of 8. It is fastest at the
 * start of a cache line. */
size_t br_nested_meshes_size(const struct br_nested_meshes *nested);

/* Projects a function that is given on every root level (in) onto all levels; `projection`: out,
 * br_nested_meshes_size values. */
void br_nested_meshes_project(const struct br_nested_meshes *nested, const struct br_view *root,
                              double *projection);

/* L2 distance of a function (in) on the mesh n[level] from the projected one. */
double br_nested_meshes_distance(const struct br_nested_meshes *nested, size_t level,
                                 const struct br_view *view, const double *projection);

/* L2 norm of the projected function. */
double br_nested_meshes_norm(const struct br_nested_meshes *nested, const double *projection);

/* ---- kernels ---- */

/* The element loops, elements of a level side by side in the lanes of vectors. Every sum is taken
 * in an order that depends on the mesh alone. */

/* The projection of one level from its parent. */
struct br_projecting {
    struct br_view fine;    /* a function on ratio * n elements */
    size_t n, ratio;        /* elements of the level; elements of its parent in one of the level */
    const double *transfer; /* E_j of the first (ratio + 1)/2 children, modes^2 by rows each, zero
                               below the diagonal; the others' are their mirror images */
    double *coarse;         /* out: modes in lanes (BR_IN_LANES) */
};

struct br_nested_meshes_kernel {
    const char *name; /* the instruction set */
    size_t lanes;     /* of its vectors, at most BR_MOST_LANES, and of the modes in lanes */
    bool (*available)(void);

    /* coarse = sum_j E_j' fine_j; returns the sum of the squares of what that loses,
     * fine_j - E_j coarse. */
    double (*project)(const struct br_projecting *p);

    /* The sum of the squares of a - b, n elements; b has the modes in lanes. */
    double (*distance)(const struct br_view *a, size_t n, const double *b);
};

#define BR_NESTED_MESHES_KERNEL(set) \
    extern const struct br_nested_meshes_kernel br_nested_meshes_##set;
BR_INSTRUCTION_SETS(BR_NESTED_MESHES_KERNEL)

/* In the order of the instruction sets; NULL behind the last. */
extern const struct br_nested_meshes_kernel *const br_nested_meshes_kernels[];

#endif
