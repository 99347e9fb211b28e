/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/ladder.h"

#include <gsl/gsl_integration.h>
#include <math.h>

#define ROW(set) &br_ladder_##set,
const struct br_ladder_kernel *const br_ladder_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

/* A rung; of a root n alone. */
struct rung {
    size_t n;
    size_t parent;    /* what it is projected from: a rung, or `count` + a root */
    size_t ratio;     /* parent's n over n */
    size_t offset;    /* of its modes in a projection, where they are in lanes */
    double *transfer; /* as in ladder.h */
};

struct br_ladder {
    const struct br_ladder_kernel *kernel;
    size_t modes;
    size_t count;      /* rungs */
    size_t size;       /* doubles in a projection: the losses of all rungs, then their modes */
    struct rung *rung; /* rungs, and then the roots */
    size_t *order;     /* of the rungs, parents first */
};

/* P_i on [0, 1], orthonormal. */
static double legendre(size_t i, double x)
{
    const double y = 2 * x - 1;
    switch (i) {
    case 0:
        return 1;
    case 1:
        return sqrt(3) * y;
    case 2:
        return sqrt(5) * (3 * y * y - 1) / 2;
    default:
        return sqrt(7) * y * (5 * y * y - 3) / 2;
    }
}

/* E_j[i][m] = ratio^-1/2 int_0^1 P_i(x) P_m((j + x)/ratio) dx for i <= m: the modes of child j of
 * an element from the element's mode m; exactly the identity where the ratio is 1. */
static double transfer(const gsl_integration_glfixed_table *gauss, const struct rung *rung,
                       size_t j, size_t i, size_t m)
{
    const double ratio = (double)rung->ratio;
    double sum = 0;
    for (size_t q = 0; q < BR_MOST_MODES; q++) {
        double x, weight;
        gsl_integration_glfixed_point(0, 1, q, &x, &weight, gauss);
        sum += weight * legendre(i, x) * legendre(m, ((double)j + x) / ratio) / sqrt(ratio);
    }
    return rung->ratio > 1 ? sum : i == m;
}

static enum br_status fill_transfers(struct rung *rung, size_t modes, struct br_store *store,
                                     struct br_error *err)
{
    const size_t half = (rung->ratio + 1) / 2;
    rung->transfer = br_store_take(store, half * modes * modes, sizeof *rung->transfer);
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(BR_MOST_MODES);
    for (size_t j = 0; rung->transfer && gauss && j < half; j++)
        for (size_t i = 0; i < modes; i++)
            for (size_t m = i; m < modes; m++)
                rung->transfer[(j * modes + i) * modes + m] = transfer(gauss, rung, j, i, m);
    gsl_integration_glfixed_table_free(gauss);
    return rung->transfer && gauss ? BR_OK : br_no_memory(err, "the ladder of meshes");
}

/* The coarsest of `meshes` that rung r divides, a finer rung or a root: its parent. */
static bool find_parent(const struct br_ladder *ladder, size_t meshes, struct rung *r)
{
    const struct rung *mesh = ladder->rung;
    r->parent = meshes;
    for (size_t i = 0; i < meshes; i++) {
        const bool divides = mesh[i].n % r->n == 0 && (i >= ladder->count || mesh[i].n != r->n);
        if (divides && (r->parent == meshes || mesh[i].n < mesh[r->parent].n))
            r->parent = i;
    }
    if (r->parent < meshes)
        r->ratio = mesh[r->parent].n / r->n;
    return r->parent < meshes;
}

static size_t round_up(size_t count, size_t lanes)
{
    return (count + lanes - 1) / lanes * lanes;
}

static enum br_status add_rungs(struct br_ladder *ladder, const struct br_mesh_list *rungs,
                                size_t roots, struct br_store *store, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t r = 0; r < rungs->count; r++) {
        ladder->rung[r] = (struct rung){.n = rungs->n[r], .offset = ladder->size};
        if (rungs->n[r] == 0)
            return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
        ladder->size += round_up(rungs->n[r], BR_MOST_LANES) * ladder->modes;
    }
    for (size_t r = 0; r < rungs->count && !status; r++) {
        struct rung *rung = &ladder->rung[r];
        status = find_parent(ladder, rungs->count + roots, rung)
                     ? fill_transfers(rung, ladder->modes, store, err)
                     : br_fail(err, BR_BAD_INPUT, "n = %zu does not divide the reference's %zu",
                               rung->n, ladder->rung[rungs->count].n);
    }
    return status;
}

/* Finer rungs first: each needs its parent. */
static void sort_rungs(struct br_ladder *ladder)
{
    for (size_t r = 0; r < ladder->count; r++) {
        size_t i = r;
        for (; i > 0 && ladder->rung[ladder->order[i - 1]].n < ladder->rung[r].n; i--)
            ladder->order[i] = ladder->order[i - 1];
        ladder->order[i] = r;
    }
}

enum br_status br_ladder_create(struct br_ladder **out, size_t modes,
                                const struct br_mesh_list *roots, const struct br_mesh_list *rungs,
                                struct br_store *store, struct br_error *err)
{
    struct br_ladder *ladder = *out = br_store_take(store, 1, sizeof *ladder);
    if (!ladder)
        return br_no_memory(err, "the ladder of meshes");
    ladder->kernel = br_ladder_kernels[br_instruction_set_best()];
    ladder->modes = modes;
    ladder->count = rungs->count;
    ladder->size = round_up(rungs->count, BR_MOST_LANES);
    ladder->rung = br_store_take(store, rungs->count + roots->count, sizeof *ladder->rung);
    ladder->order = br_store_take(store, rungs->count, sizeof *ladder->order);
    if (store->failed)
        return br_no_memory(err, "the ladder of meshes");
    for (size_t i = 0; i < roots->count; i++)
        ladder->rung[rungs->count + i].n = roots->n[i];
    const enum br_status status = add_rungs(ladder, rungs, roots->count, store, err);
    if (!status)
        sort_rungs(ladder);
    return status;
}

void br_ladder_use(struct br_ladder *ladder, const struct br_ladder_kernel *kernel)
{
    ladder->kernel = kernel;
}

size_t br_ladder_size(const struct br_ladder *ladder)
{
    return ladder->size;
}

/* The projection's part on a rung. */
static struct br_view view_of(const struct br_ladder *ladder, size_t r, double *projection)
{
    struct br_view view;
    br_view_modes(&view, ladder->modes);
    view.layout = BR_IN_LANES;
    view.rest = projection[r];
    view.values = projection + ladder->rung[r].offset;
    return view;
}

void br_ladder_project(const struct br_ladder *ladder, const struct br_view *root,
                       double *projection)
{
    for (size_t i = 0; i < ladder->count; i++) {
        const size_t r = ladder->order[i];
        const struct rung *rung = &ladder->rung[r];
        const struct br_projecting p = {
            .fine = rung->parent < ladder->count ? view_of(ladder, rung->parent, projection)
                                                 : root[rung->parent - ladder->count],
            .n = rung->n,
            .ratio = rung->ratio,
            .transfer = rung->transfer,
            .coarse = projection + rung->offset,
        };
        projection[r] = p.fine.rest + ladder->kernel->project(&p);
    }
}

double br_ladder_distance(const struct br_ladder *ladder, size_t r, const struct br_view *view,
                          const double *projection)
{
    const struct rung *rung = &ladder->rung[r];
    return sqrt(ladder->kernel->distance(view, rung->n, projection + rung->offset) + view->rest +
                projection[r]);
}

/* By Pythagoras, from the coarsest rung: the shortest sum. */
double br_ladder_norm(const struct br_ladder *ladder, const double *projection)
{
    const size_t r = ladder->order[ladder->count - 1];
    const struct rung *rung = &ladder->rung[r];
    const double *modes = projection + rung->offset;
    double sum = projection[r];
    const size_t count = round_up(rung->n, ladder->kernel->lanes) * ladder->modes;
    for (size_t i = 0; i < count; i++)
        sum += modes[i] * modes[i];
    return sqrt(sum);
}
