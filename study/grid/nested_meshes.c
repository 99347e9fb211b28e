/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/nested_meshes.h"

#include <gsl/gsl_integration.h>
#include <math.h>

#define ROW(set) &br_nested_meshes_##set,
const struct br_nested_meshes_kernel *const br_nested_meshes_kernels[] = {BR_INSTRUCTION_SETS(ROW)
                                                                              NULL};

/* A level; of a root level only n is set. */
struct level {
    size_t n;
    size_t parent;    /* the level that it is projected from: its index, or `count` + that of a root
                         level */
    size_t ratio;     /* parent's n over n */
    size_t offset;    /* of its modes in a projection, laid out as BR_IN_LANES */
    double *transfer; /* as in nested_meshes.h */
};

struct br_nested_meshes {
    const struct br_nested_meshes_kernel *kernel;
    size_t modes;
    size_t count;        /* levels */
    size_t size;         /* doubles in a projection: the losses of all levels, then their modes */
    struct level *level; /* the levels, then the root levels */
    size_t *order;       /* of the levels, parents first */
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
static double transfer(const gsl_integration_glfixed_table *gauss, const struct level *level,
                       size_t j, size_t i, size_t m)
{
    const double ratio = (double)level->ratio;
    double sum = 0;
    for (size_t q = 0; q < BR_MOST_MODES; q++) {
        double x, weight;
        gsl_integration_glfixed_point(0, 1, q, &x, &weight, gauss);
        sum += weight * legendre(i, x) * legendre(m, ((double)j + x) / ratio) / sqrt(ratio);
    }
    return level->ratio > 1 ? sum : i == m;
}

static enum br_status fill_transfers(struct level *level, size_t modes, struct br_store *store,
                                     struct br_error *err)
{
    const size_t half = (level->ratio + 1) / 2;
    level->transfer = br_store_take(store, half * modes * modes, sizeof *level->transfer);
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(BR_MOST_MODES);
    for (size_t j = 0; level->transfer && gauss && j < half; j++)
        for (size_t i = 0; i < modes; i++)
            for (size_t m = i; m < modes; m++)
                level->transfer[(j * modes + i) * modes + m] = transfer(gauss, level, j, i, m);
    gsl_integration_glfixed_table_free(gauss);
    return level->transfer && gauss ? BR_OK : br_no_memory(err, "the nested meshes");
}

/* Finds the parent of r: the coarsest finer level, or root level, that r divides. */
static bool find_parent(const struct br_nested_meshes *nested, size_t meshes, struct level *r)
{
    const struct level *mesh = nested->level;
    r->parent = meshes;
    for (size_t i = 0; i < meshes; i++) {
        const bool divides = mesh[i].n % r->n == 0 && (i >= nested->count || mesh[i].n != r->n);
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

static enum br_status add_levels(struct br_nested_meshes *nested, const struct br_mesh_list *levels,
                                 size_t roots, struct br_store *store, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t r = 0; r < levels->count; r++) {
        nested->level[r] = (struct level){.n = levels->n[r], .offset = nested->size};
        if (levels->n[r] == 0)
            return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
        nested->size += round_up(levels->n[r], BR_MOST_LANES) * nested->modes;
    }
    for (size_t r = 0; r < levels->count && !status; r++) {
        struct level *level = &nested->level[r];
        status = find_parent(nested, levels->count + roots, level)
                     ? fill_transfers(level, nested->modes, store, err)
                     : br_fail(err, BR_BAD_INPUT, "n = %zu does not divide the reference's %zu",
                               level->n, nested->level[levels->count].n);
    }
    return status;
}

/* Finer levels first: each needs its parent. */
static void sort_levels(struct br_nested_meshes *nested)
{
    for (size_t r = 0; r < nested->count; r++) {
        size_t i = r;
        for (; i > 0 && nested->level[nested->order[i - 1]].n < nested->level[r].n; i--)
            nested->order[i] = nested->order[i - 1];
        nested->order[i] = r;
    }
}

enum br_status br_nested_meshes_create(struct br_nested_meshes **out, size_t modes,
                                       const struct br_mesh_list *roots,
                                       const struct br_mesh_list *levels, struct br_store *store,
                                       struct br_error *err)
{
    struct br_nested_meshes *nested = *out = br_store_take(store, 1, sizeof *nested);
    if (!nested)
        return br_no_memory(err, "the nested meshes");
    nested->kernel = br_nested_meshes_kernels[br_instruction_set_best()];
    nested->modes = modes;
    nested->count = levels->count;
    nested->size = round_up(levels->count, BR_MOST_LANES);
    nested->level = br_store_take(store, levels->count + roots->count, sizeof *nested->level);
    nested->order = br_store_take(store, levels->count, sizeof *nested->order);
    if (store->failed)
        return br_no_memory(err, "the nested meshes");
    for (size_t i = 0; i < roots->count; i++)
        nested->level[levels->count + i].n = roots->n[i];
    const enum br_status status = add_levels(nested, levels, roots->count, store, err);
    if (!status)
        sort_levels(nested);
    return status;
}

void br_nested_meshes_use(struct br_nested_meshes *nested,
                          const struct br_nested_meshes_kernel *kernel)
{
    nested->kernel = kernel;
}

size_t br_nested_meshes_size(const struct br_nested_meshes *nested)
{
    return nested->size;
}

/* The modes of a projection on level r. */
static struct br_view view_of(const struct br_nested_meshes *nested, size_t r, double *projection)
{
    struct br_view view;
    br_view_modes(&view, nested->modes);
    view.layout = BR_IN_LANES;
    view.rest = projection[r];
    view.values = projection + nested->level[r].offset;
    return view;
}

void br_nested_meshes_project(const struct br_nested_meshes *nested, const struct br_view *root,
                              double *projection)
{
    for (size_t i = 0; i < nested->count; i++) {
        const size_t r = nested->order[i];
        const struct level *level = &nested->level[r];
        const struct br_projecting p = {
            .fine = level->parent < nested->count ? view_of(nested, level->parent, projection)
                                                  : root[level->parent - nested->count],
            .n = level->n,
            .ratio = level->ratio,
            .transfer = level->transfer,
            .coarse = projection + level->offset,
        };
        projection[r] = p.fine.rest + nested->kernel->project(&p);
    }
}

double br_nested_meshes_distance(const struct br_nested_meshes *nested, size_t r,
                                 const struct br_view *view, const double *projection)
{
    const struct level *level = &nested->level[r];
    return sqrt(nested->kernel->distance(view, level->n, projection + level->offset) + view->rest +
                projection[r]);
}

/* By Pythagoras from the coarsest level, where the sum is shortest. */
double br_nested_meshes_norm(const struct br_nested_meshes *nested, const double *projection)
{
    const size_t r = nested->order[nested->count - 1];
    const struct level *level = &nested->level[r];
    const double *modes = projection + level->offset;
    double sum = projection[r];
    const size_t count = round_up(level->n, nested->kernel->lanes) * nested->modes;
    for (size_t i = 0; i < count; i++)
        sum += modes[i] * modes[i];
    return sqrt(sum);
}
