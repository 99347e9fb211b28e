/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ladder.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MODES = 4 };

/* Four doubles in the vector extension of GCC and Clang; never passed by value. */
typedef double quad __attribute__((vector_size(32), aligned(16)));

/* E_j: the modes of child j of an element, prolong[i][m] from the element's mode m.
 * By rows (what child mode i adds to the element's modes, times E_j') and by columns. */
struct transfer {
    quad row[MODES], column[MODES];
};

struct rung {
    size_t n, modes;        /* elements, modes an element */
    size_t parent;          /* what it is projected from: a rung, or `count` + a root */
    size_t ratio;           /* parent's n over n */
    size_t offset;          /* of its modes in a projection; its loss stands before them */
    struct transfer *child; /* ratio of them */
};

struct br_ladder {
    size_t count; /* rungs */
    size_t roots;
    size_t *root; /* elements of each */
    size_t size;  /* doubles in a projection */
    size_t modes;
    struct rung *rung;
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

/* E_j[i][m] = ratio^-1/2 int_0^1 P_i(x) P_m((j + x)/ratio) dx, zero for i > m. */
static enum br_status fill_transfers(struct rung *rung, struct br_error *err)
{
    rung->child = br_allocate(rung->ratio, sizeof *rung->child);
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(MODES);
    if (!rung->child || !gauss) {
        gsl_integration_glfixed_table_free(gauss);
        return br_no_memory(err, "the ladder of meshes");
    }
    const double ratio = (double)rung->ratio;
    for (size_t j = 0; j < rung->ratio; j++)
        for (size_t q = 0; q < MODES; q++) {
            double x, weight;
            gsl_integration_glfixed_point(0, 1, q, &x, &weight, gauss);
            for (size_t i = 0; i < rung->modes; i++)
                for (size_t m = i; m < rung->modes; m++)
                    rung->child[j].row[i][m] += weight * legendre(i, x) *
                                                legendre(m, ((double)j + x) / ratio) / sqrt(ratio);
        }
    for (size_t j = 0; j < rung->ratio; j++)
        for (size_t i = 0; i < MODES; i++)
            for (size_t m = 0; m < MODES; m++)
                rung->child[j].column[m][i] = rung->child[j].row[i][m];
    gsl_integration_glfixed_table_free(gauss);
    return BR_OK;
}

/* Elements of the mesh that a rung is projected from. */
static size_t parent_n(const struct br_ladder *ladder, size_t parent)
{
    return parent < ladder->count ? ladder->rung[parent].n : ladder->root[parent - ladder->count];
}

/* The coarsest mesh that rung r divides, a finer rung or a root; *parent: which. */
static bool find_parent(const struct br_ladder *ladder, size_t r, size_t *parent)
{
    const size_t n = ladder->rung[r].n;
    bool found = false;
    for (size_t i = 0; i < ladder->count + ladder->roots; i++) {
        const size_t other = parent_n(ladder, i);
        if (other % n != 0 || (i < ladder->count && other == n))
            continue;
        if (!found || other < parent_n(ladder, *parent))
            *parent = i;
        found = true;
    }
    return found;
}

static enum br_status add_rungs(struct br_ladder *ladder, const struct br_mesh_list *rungs,
                                struct br_error *err)
{
    ladder->rung = br_allocate(rungs->count, sizeof *ladder->rung);
    if (!ladder->rung)
        return br_no_memory(err, "the ladder of meshes");
    ladder->count = rungs->count;
    for (size_t r = 0; r < rungs->count; r++) {
        const struct rung rung = {
            .n = rungs->n[r], .modes = ladder->modes, .offset = ladder->size + 1};
        if (rung.n == 0)
            return br_fail(err, BR_BAD_INPUT, "n is 0, expected at least one element");
        ladder->rung[r] = rung;
        ladder->size += 1 + rung.n * rung.modes;
    }
    for (size_t r = 0; r < rungs->count; r++) {
        struct rung *rung = &ladder->rung[r];
        if (!find_parent(ladder, r, &rung->parent))
            return br_fail(err, BR_BAD_INPUT, "n = %zu does not divide the reference's %zu",
                           rung->n, ladder->root[0]);
        rung->ratio = parent_n(ladder, rung->parent) / rung->n;
        const enum br_status status = fill_transfers(rung, err);
        if (status)
            return status;
    }
    return BR_OK;
}

enum br_status br_ladder_create(struct br_ladder **out, size_t modes,
                                const struct br_mesh_list *roots, const struct br_mesh_list *rungs,
                                struct br_error *err)
{
    struct br_ladder *ladder = br_allocate(1, sizeof *ladder);
    *out = ladder;
    if (!ladder)
        return br_no_memory(err, "the ladder of meshes");
    ladder->modes = modes;
    ladder->root = br_allocate(roots->count, sizeof *ladder->root);
    if (!ladder->root)
        return br_no_memory(err, "the ladder of meshes");
    ladder->roots = roots->count;
    memcpy(ladder->root, roots->n, roots->count * sizeof *ladder->root);
    return add_rungs(ladder, rungs, err);
}

void br_ladder_free(struct br_ladder *ladder)
{
    if (!ladder)
        return;
    for (size_t r = 0; ladder->rung && r < ladder->count; r++)
        free(ladder->rung[r].child);
    free(ladder->rung);
    free(ladder->root);
    free(ladder);
}

size_t br_ladder_size(const struct br_ladder *ladder)
{
    return ladder->size;
}

/* One element of four modes: coarse = sum_j E_j' fine_j; returns the squared loss,
 * sum_j |fine_j - E_j coarse|^2. */
static double project_cubic(const struct rung *rung, const double *fine, double *coarse)
{
    quad sum = {0};
    for (size_t j = 0; j < rung->ratio; j++)
        for (size_t i = 0; i < MODES; i++)
            sum += rung->child[j].row[i] * fine[j * MODES + i];
    quad loss = {0};
    for (size_t j = 0; j < rung->ratio; j++) {
        quad rest;
        memcpy(&rest, fine + j * MODES, sizeof rest);
        for (size_t m = 0; m < MODES; m++)
            rest -= rung->child[j].column[m] * sum[m];
        loss += rest * rest;
    }
    memcpy(coarse, &sum, sizeof sum);
    return (loss[0] + loss[1]) + (loss[2] + loss[3]);
}

/* The same for two modes. */
static double project_linear(const struct rung *rung, const double *fine, double *coarse)
{
    double sum[2] = {0, 0}, loss = 0;
    for (size_t j = 0; j < rung->ratio; j++) {
        const quad *row = rung->child[j].row;
        sum[0] += row[0][0] * fine[2 * j];
        sum[1] += row[0][1] * fine[2 * j] + row[1][1] * fine[2 * j + 1];
    }
    for (size_t j = 0; j < rung->ratio; j++) {
        const quad *row = rung->child[j].row;
        const double rest0 = fine[2 * j] - row[0][0] * sum[0] - row[0][1] * sum[1];
        const double rest1 = fine[2 * j + 1] - row[1][1] * sum[1];
        loss += rest0 * rest0 + rest1 * rest1;
    }
    memcpy(coarse, sum, sizeof sum);
    return loss;
}

/* The same for piecewise constants: coarse = sum_j E_j fine_j. */
static double project_constant(const struct rung *rung, const double *fine, double *coarse)
{
    double sum = 0, loss = 0;
    for (size_t j = 0; j < rung->ratio; j++)
        sum += rung->child[j].row[0][0] * fine[j];
    for (size_t j = 0; j < rung->ratio; j++) {
        const double rest = fine[j] - rung->child[j].row[0][0] * sum;
        loss += rest * rest;
    }
    *coarse = sum;
    return loss;
}

/* Four modes have vectors, the others are few. */
static double project_element(const struct rung *rung, const double *fine, double *coarse)
{
    switch (rung->modes) {
    case 1:
        return project_constant(rung, fine, coarse);
    case 2:
        return project_linear(rung, fine, coarse);
    default:
        return project_cubic(rung, fine, coarse);
    }
}

static void project_rung(const struct br_ladder *ladder, size_t r, const struct br_root_value *root,
                         double *projection)
{
    const struct rung *rung = &ladder->rung[r];
    const double *fine;
    double loss;
    if (rung->parent < ladder->count) {
        fine = projection + ladder->rung[rung->parent].offset;
        loss = fine[-1];
    } else {
        fine = root[rung->parent - ladder->count].modes;
        loss = root[rung->parent - ladder->count].rest;
    }
    double *coarse = projection + rung->offset;
    for (size_t e = 0; e < rung->n; e++)
        loss +=
            project_element(rung, fine + e * rung->ratio * rung->modes, coarse + e * rung->modes);
    coarse[-1] = loss;
}

void br_ladder_project(const struct br_ladder *ladder, const struct br_root_value *root,
                       double *projection)
{
    /* Finer rungs first: each needs its parent. */
    for (size_t below = SIZE_MAX;;) {
        size_t n = 0;
        for (size_t r = 0; r < ladder->count; r++)
            if (ladder->rung[r].n < below && ladder->rung[r].n > n)
                n = ladder->rung[r].n;
        if (n == 0)
            return;
        for (size_t r = 0; r < ladder->count; r++)
            if (ladder->rung[r].n == n)
                project_rung(ladder, r, root, projection);
        below = n;
    }
}

double br_ladder_distance(const struct br_ladder *ladder, size_t r, const double *modes,
                          const double *projection)
{
    const struct rung *rung = &ladder->rung[r];
    const double *reference = projection + rung->offset;
    const size_t count = rung->n * rung->modes;
    double even = 0, odd = 0; /* two chains */
    for (size_t i = 0; i + 1 < count; i += 2) {
        const double a = modes[i] - reference[i], b = modes[i + 1] - reference[i + 1];
        even += a * a;
        odd += b * b;
    }
    if (count % 2)
        even +=
            (modes[count - 1] - reference[count - 1]) * (modes[count - 1] - reference[count - 1]);
    return sqrt(even + odd + projection[rung->offset - 1]);
}
