/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ladder.h"

#include <gsl/gsl_integration.h>
#include <math.h>
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
    size_t n, modes; /* elements, modes an element */
    size_t parent;   /* the rung it is projected from; `count`: the finest mesh */
    size_t ratio;    /* parent's n over n */
    size_t offset;   /* of its modes in a projection; its loss stands before them */
    struct transfer *child; /* ratio of them */
};

struct br_ladder {
    size_t finest; /* elements of the reference's mesh */
    size_t count;  /* rungs */
    size_t size;   /* doubles in a projection */
    size_t modes;
    struct rung *rung;
};

size_t br_mode_count(enum br_field_kind kind)
{
    return kind == BR_AXIAL ? 2 : MODES;
}

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
    return parent == ladder->count ? ladder->finest : ladder->rung[parent].n;
}

/* The coarsest finer mesh that this rung's divides. */
static size_t find_parent(const struct br_ladder *ladder, size_t r)
{
    size_t best = ladder->count;
    for (size_t i = 0; i < ladder->count; i++) {
        const size_t n = ladder->rung[i].n;
        const bool finer = n > ladder->rung[r].n && n % ladder->rung[r].n == 0;
        if (finer && n < parent_n(ladder, best))
            best = i;
    }
    return best;
}

enum br_status br_ladder_create(struct br_ladder **out, enum br_field_kind kind, size_t finest,
                                size_t count, const size_t *n, struct br_error *err)
{
    struct br_ladder *ladder = br_allocate(1, sizeof *ladder);
    *out = ladder;
    if (!ladder)
        return br_no_memory(err, "the ladder of meshes");
    ladder->finest = finest;
    ladder->modes = br_mode_count(kind);
    ladder->rung = br_allocate(count, sizeof *ladder->rung);
    if (!ladder->rung)
        return br_no_memory(err, "the ladder of meshes");
    ladder->count = count;
    for (size_t r = 0; r < count; r++) {
        struct rung *rung = &ladder->rung[r];
        if (n[r] == 0 || finest % n[r] != 0)
            return br_fail(err, BR_BAD_INPUT, "n = %zu does not divide the reference's %zu", n[r],
                           finest);
        *rung = (struct rung){.n = n[r], .modes = ladder->modes, .offset = ladder->size + 1};
        ladder->size += 1 + rung->n * rung->modes;
    }
    for (size_t r = 0; r < count; r++) {
        struct rung *rung = &ladder->rung[r];
        rung->parent = find_parent(ladder, r);
        rung->ratio = parent_n(ladder, rung->parent) / rung->n;
        const enum br_status status = fill_transfers(rung, err);
        if (status)
            return status;
    }
    return BR_OK;
}

void br_ladder_free(struct br_ladder *ladder)
{
    if (!ladder)
        return;
    for (size_t r = 0; ladder->rung && r < ladder->count; r++)
        free(ladder->rung[r].child);
    free(ladder->rung);
    free(ladder);
}

size_t br_ladder_size(const struct br_ladder *ladder)
{
    return ladder->size;
}

/* One element of bending: coarse = sum_j E_j' fine_j; returns the squared loss,
 * sum_j |fine_j - E_j coarse|^2. */
static double project_bending(const struct rung *rung, const double *fine, double *coarse)
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

/* The same for axial, whose E_j are 2 by 2. */
static double project_axial(const struct rung *rung, const double *fine, double *coarse)
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

static void project_rung(const struct br_ladder *ladder, size_t r, const double *modes,
                         double *projection)
{
    const struct rung *rung = &ladder->rung[r];
    const bool from_finest = rung->parent == ladder->count;
    const struct rung *parent = from_finest ? NULL : &ladder->rung[rung->parent];
    const double *fine = from_finest ? modes : projection + parent->offset;
    double *coarse = projection + rung->offset;
    double loss = from_finest ? 0 : projection[parent->offset - 1];
    if (rung->modes == MODES)
        for (size_t e = 0; e < rung->n; e++)
            loss += project_bending(rung, fine + e * rung->ratio * MODES, coarse + e * MODES);
    else
        for (size_t e = 0; e < rung->n; e++)
            loss += project_axial(rung, fine + e * rung->ratio * 2, coarse + e * 2);
    projection[rung->offset - 1] = loss;
}

void br_ladder_project(const struct br_ladder *ladder, const double *modes, double *projection)
{
    /* Finer rungs first: each needs its parent. */
    for (size_t n = ladder->finest; n > 0;) {
        size_t next = 0;
        for (size_t r = 0; r < ladder->count; r++) {
            if (ladder->rung[r].n == n)
                project_rung(ladder, r, modes, projection);
            if (ladder->rung[r].n < n && ladder->rung[r].n > next)
                next = ladder->rung[r].n;
        }
        n = next;
    }
}

double br_ladder_distance(const struct br_ladder *ladder, size_t r, const double *modes,
                          const double *projection)
{
    const struct rung *rung = &ladder->rung[r];
    const double *reference = projection + rung->offset;
    double even = 0, odd = 0; /* two chains; the modes are even in number */
    for (size_t i = 0; i < rung->n * rung->modes; i += 2) {
        const double a = modes[i] - reference[i], b = modes[i + 1] - reference[i + 1];
        even += a * a;
        odd += b * b;
    }
    return sqrt(even + odd + projection[rung->offset - 1]);
}

static void axial_modes(double root, const double *nodal, double modes[2])
{
    modes[0] = root * ((nodal[0] + nodal[1]) / 2);
    modes[1] = root * ((nodal[1] - nodal[0]) * (0.5 / sqrt(3)));
}

/* The two highest from the curvature: P_2'' = 12 sqrt(5), P_3'' = 60 sqrt(7) (2x - 1). */
static void bending_modes(double root, const double *nodal, double modes[4])
{
    double curvature[2];
    br_curvature(nodal, curvature);
    const double w0 = nodal[0], s0 = nodal[1], w1 = nodal[2], s1 = nodal[3];
    modes[0] = root * ((w0 + w1) / 2 + (s0 - s1) * (1.0 / 12));
    modes[1] = root * ((w1 - w0) * (sqrt(3) / 5) - (s0 + s1) * (sqrt(3) / 60));
    modes[2] = root * (curvature[0] * (1 / (12 * sqrt(5))));
    modes[3] = root * (curvature[1] * (1 / (60 * sqrt(7))));
}

void br_modes(const struct br_field *field, const double *nodal, double *modes)
{
    const double root = sqrt(field->h);
    for (size_t e = 0; e < field->n; e++)
        if (field->kind == BR_AXIAL)
            axial_modes(root, nodal + e, modes + 2 * e);
        else
            bending_modes(root, nodal + 2 * e, modes + 4 * e);
}
