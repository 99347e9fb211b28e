/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ladder.h"

#include <gsl/gsl_integration.h>
#include <math.h>

enum { MODES = 4 };

struct rung {
    size_t n, modes; /* elements, modes an element */
    size_t parent;   /* the rung it is projected from */
    size_t ratio;    /* parent's n over n */
    size_t offset;   /* of its modes in a projection; its loss stands before them */
    double *prolong; /* ratio * MODES * MODES: a parent element's modes of child j */
};

struct br_ladder {
    size_t count; /* rungs, the finest one (the last) included */
    size_t size;
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

/* prolong[j][i][m] = ratio^-1/2 int_0^1 P_i(x) P_m((j + x)/ratio) dx */
static enum br_status fill_prolongation(struct rung *rung, struct br_error *err)
{
    rung->prolong = br_allocate(rung->ratio * MODES * MODES, sizeof *rung->prolong);
    gsl_integration_glfixed_table *gauss = gsl_integration_glfixed_table_alloc(MODES);
    if (!rung->prolong || !gauss) {
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
                    rung->prolong[(j * MODES + i) * MODES + m] +=
                        weight * legendre(i, x) * legendre(m, ((double)j + x) / ratio) /
                        sqrt(ratio);
        }
    gsl_integration_glfixed_table_free(gauss);
    return BR_OK;
}

/* The coarsest other rung whose mesh this one's divides. */
static size_t find_parent(const struct br_ladder *ladder, size_t r)
{
    size_t best = ladder->count - 1;
    for (size_t i = 0; i < ladder->count; i++) {
        const size_t n = ladder->rung[i].n;
        const bool finer = n > ladder->rung[r].n && n % ladder->rung[r].n == 0;
        if (finer && n < ladder->rung[best].n)
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
    ladder->count = count + 1;
    ladder->modes = br_mode_count(kind);
    ladder->rung = br_allocate(ladder->count, sizeof *ladder->rung);
    if (!ladder->rung)
        return br_no_memory(err, "the ladder of meshes");
    for (size_t r = 0; r <= count; r++) {
        struct rung *rung = &ladder->rung[r];
        *rung = (struct rung){.n = r < count ? n[r] : finest, .modes = ladder->modes};
        if (rung->n == 0 || finest % rung->n != 0)
            return br_fail(err, BR_BAD_INPUT, "n = %zu does not divide the reference's %zu",
                           rung->n, finest);
        rung->offset = ladder->size + 1;
        ladder->size += 1 + rung->n * rung->modes;
    }
    for (size_t r = 0; r < count; r++) {
        struct rung *rung = &ladder->rung[r];
        rung->parent = find_parent(ladder, r);
        rung->ratio = ladder->rung[rung->parent].n / rung->n;
        const enum br_status status = fill_prolongation(rung, err);
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
        free(ladder->rung[r].prolong);
    free(ladder->rung);
    free(ladder);
}

size_t br_ladder_size(const struct br_ladder *ladder)
{
    return ladder->size;
}

/* One element: coarse = sum_j E_j' fine_j; returns sum_j |fine_j - E_j coarse|^2.
 * Inlined with `modes` a constant; E_j is upper triangular. */
static inline double project_element(const double *prolong, size_t ratio, const double *fine,
                                     double *coarse, const size_t modes)
{
    double sum[MODES] = {0};
    for (size_t j = 0; j < ratio; j++)
        for (size_t i = 0; i < modes; i++)
            for (size_t m = i; m < modes; m++)
                sum[m] += prolong[(j * MODES + i) * MODES + m] * fine[j * modes + i];
    double loss = 0;
    for (size_t j = 0; j < ratio; j++)
        for (size_t i = 0; i < modes; i++) {
            double rest = fine[j * modes + i];
            for (size_t m = i; m < modes; m++)
                rest -= prolong[(j * MODES + i) * MODES + m] * sum[m];
            loss += rest * rest;
        }
    for (size_t m = 0; m < modes; m++)
        coarse[m] = sum[m];
    return loss;
}

static void project_rung(const struct br_ladder *ladder, size_t r, double *projection)
{
    const struct rung *rung = &ladder->rung[r];
    const struct rung *parent = &ladder->rung[rung->parent];
    const double *fine = projection + parent->offset;
    double *coarse = projection + rung->offset;
    double loss = projection[parent->offset - 1];
    if (ladder->modes == MODES)
        for (size_t e = 0; e < rung->n; e++)
            loss += project_element(rung->prolong, rung->ratio, fine + e * rung->ratio * MODES,
                                    coarse + e * MODES, MODES);
    else
        for (size_t e = 0; e < rung->n; e++)
            loss += project_element(rung->prolong, rung->ratio, fine + e * rung->ratio * 2,
                                    coarse + e * 2, 2);
    projection[rung->offset - 1] = loss;
}

void br_ladder_project(const struct br_ladder *ladder, const double *modes, double *projection)
{
    const struct rung *finest = &ladder->rung[ladder->count - 1];
    projection[finest->offset - 1] = 0;
    for (size_t i = 0; i < finest->n * finest->modes; i++)
        projection[finest->offset + i] = modes[i];
    /* Finer rungs first: each needs its parent. */
    for (size_t n = finest->n; n > 0;) {
        size_t next = 0;
        for (size_t r = 0; r + 1 < ladder->count; r++) {
            if (ladder->rung[r].n == n)
                project_rung(ladder, r, projection);
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
    modes[0] = root * (nodal[0] + nodal[1]) / 2;
    modes[1] = root * (nodal[1] - nodal[0]) / (2 * sqrt(3));
}

/* The two highest from the curvature: P_2'' = 12 sqrt(5), P_3'' = 60 sqrt(7) (2x - 1). */
static void bending_modes(double root, const double *nodal, double modes[4])
{
    double curvature[2];
    br_curvature(nodal, curvature);
    const double w0 = nodal[0], s0 = nodal[1], w1 = nodal[2], s1 = nodal[3];
    modes[0] = root * ((w0 + w1) / 2 + (s0 - s1) / 12);
    modes[1] = root * sqrt(3) * ((w1 - w0) / 5 - (s0 + s1) / 60);
    modes[2] = root * curvature[0] / (12 * sqrt(5));
    modes[3] = root * curvature[1] / (60 * sqrt(7));
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
