/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "reference/exact/legendre.h"
#include "reference/judge.h"
#include "reference/mms/mms.h"
#include "solver/clock.h"
#include "solver/modes.h"

/* Twelve Gauss points know the modes up to degree 10 of a polynomial of degree 13. */
enum { POINTS = 12, MODES = 11, TAIL = 2 };

struct br_projection {
    struct br_function derivative;
    size_t kept, n;
    double h;                     /* m */
    double weight[POINTS][MODES]; /* Gauss weight times mode */
    double *x;                    /* n * POINTS, m */
    double *value;                /* there */
};

enum br_status br_projection_create(struct br_projection **out, const struct br_function *solution,
                                    const struct br_projected *what, double length, size_t n,
                                    struct br_error *err)
{
    *out = NULL;
    if (what->kept > BR_PROJECTION_MOST_KEPT)
        return br_fail(err, BR_BAD_INPUT, "%zu modes are to be kept, expected at most %d",
                       what->kept, BR_PROJECTION_MOST_KEPT);
    struct br_projection *p = *out = br_allocate(1, sizeof *p);
    if (!p)
        return br_no_memory(err, "a projection");
    p->kept = what->kept;
    p->n = n;
    p->h = length / (double)n;
    p->x = br_allocate(2 * n * POINTS, sizeof *p->x);
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
    for (size_t q = 0; q < POINTS && p->x && table; q++) {
        double xi, weight, legendre[MODES];
        gsl_integration_glfixed_point(0, 1, q, &xi, &weight, table);
        br_legendre(MODES, xi, legendre);
        for (size_t m = 0; m < MODES; m++)
            p->weight[q][m] = weight * legendre[m];
        for (size_t e = 0; e < n; e++)
            p->x[e * POINTS + q] = p->h * ((double)e + xi);
    }
    const bool room = p->x && table;
    gsl_integration_glfixed_table_free(table);
    if (!room)
        return br_no_memory(err, "a projection");
    p->value = p->x + n * POINTS;
    return br_function_derivative(solution, what->order, &p->derivative, err);
}

void br_projection_free(struct br_projection *p)
{
    if (!p)
        return;
    br_function_free(&p->derivative);
    free(p->x);
    free(p);
}

struct br_projection_rest br_projection_apply(struct br_projection *p, double t, double *modes)
{
    struct br_projection_rest sums = {0};
    br_function_evaluate(&p->derivative, p->n * POINTS, p->x, t, p->value);
    for (size_t e = 0; e < p->n; e++) {
        double mode[MODES] = {0};
        for (size_t q = 0; q < POINTS; q++)
            for (size_t m = 0; m < MODES; m++)
                mode[m] += sqrt(p->h) * p->value[e * POINTS + q] * p->weight[q][m];
        memcpy(modes + e * p->kept, mode, p->kept * sizeof *mode);
        for (size_t m = p->kept; m < MODES; m++)
            sums.rest += mode[m] * mode[m];
        for (size_t m = MODES - TAIL; m < MODES; m++)
            sums.tail += mode[m] * mode[m];
    }
    return sums;
}

/* The given solution of a scene as a judge. */

struct mms_judge {
    struct br_projection **projection[2][BR_MEASURES]; /* by br_field_kind, then by mesh */
    struct br_function tip[2];                         /* the solution itself */
    const struct br_scene *scene;
    size_t meshes, levels;
    int axial_degree;
    double time[2];              /* by br_field_kind, s */
    double tail[2][BR_MEASURES]; /* the largest of br_projection_rest, squared */
    double seconds[2];           /* by br_field_kind */
};

static void mms_free(void *self)
{
    struct mms_judge *j = self;
    if (!j)
        return;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        for (int measure = 0; measure < BR_MEASURES; measure++) {
            struct br_projection **projection = j->projection[kind][measure];
            for (size_t i = 0; projection && i < j->meshes; i++)
                br_projection_free(projection[i]);
            free(projection);
        }
        br_function_free(&j->tip[kind]);
    }
    free(j);
}

static enum br_status create_part(struct mms_judge *j, enum br_field_kind kind,
                                  const struct br_judge_request *r, struct br_error *err)
{
    const bool axial = kind == BR_AXIAL;
    const struct br_scene *s = r->scene;
    if (!(axial ? s->axial.solution : s->bending.solution))
        return BR_OK;
    enum br_status status =
        br_function_clone(axial ? &s->axial.given : &s->bending.given, &j->tip[kind], err);
    for (enum br_measure measure = 0; measure < BR_TIP && !status; measure++) {
        const int derived = axial ? 1 : 2;
        const struct br_projected what = {
            .order = {measure == BR_STRAIN_RATE ? derived : 0, measure != BR_DISPLACEMENT},
            .kept = br_mode_count((struct br_elements){kind, r->axial_degree}, measure),
        };
        if (!r->measured[kind][measure])
            continue;
        struct br_projection **projection = br_allocate(r->mesh_count, sizeof *projection);
        j->projection[kind][measure] = projection;
        if (!projection)
            return br_no_memory(err, "the manufactured solution");
        for (size_t i = 0; i < r->mesh_count && !status; i++)
            status = br_projection_create(&projection[i], &j->tip[kind], &what, s->length,
                                          r->mesh[i], err);
    }
    return status;
}

static enum br_status mms_create(void **self, const struct br_judge_request *r,
                                 struct br_error *err)
{
    const struct br_scene *scene = r->scene;
    *self = NULL;
    if ((scene->axial.modelled && !scene->axial.solution) ||
        (scene->bending.modelled && !scene->bending.solution))
        return br_fail(err, BR_BAD_INPUT,
                       "--reference mms needs a scene with a manufactured solution: keys "
                       "'solution' in axial and bending");
    struct mms_judge *j = br_allocate(1, sizeof *j);
    *self = j;
    if (!j)
        return br_no_memory(err, "the manufactured solution");
    j->meshes = r->mesh_count;
    j->levels = r->levels;
    j->axial_degree = r->axial_degree;
    j->scene = scene;
    const enum br_status status = create_part(j, BR_AXIAL, r, err);
    return status ? status : create_part(j, BR_BENDING, r, err);
}

static enum br_status mms_advance(void *self, enum br_field_kind kind, size_t i,
                                  struct br_error *err)
{
    struct mms_judge *j = self;
    (void)err;
    j->time[kind] = j->scene->duration * (double)i / (double)j->levels;
    return BR_OK;
}

static void mms_sample(void *self, const struct br_sample_at *at, struct br_view *view)
{
    struct mms_judge *j = self;
    const double start = br_seconds();
    struct br_projection_rest sums = {0};
    if (at->measure == BR_TIP) {
        br_view_modes(view, 0);
        *view->values = br_function_at(&j->tip[at->kind], j->scene->length, j->time[at->kind]);
    } else {
        br_view_modes(view,
                      br_mode_count((struct br_elements){at->kind, j->axial_degree}, at->measure));
        sums = br_projection_apply(j->projection[at->kind][at->measure][at->mesh],
                                   j->time[at->kind], view->values);
    }
    view->rest = sums.rest;
    double *tail = &j->tail[at->kind][at->measure];
    *tail = fmax(*tail, sums.tail);
    j->seconds[at->kind] += br_seconds() - start;
}

/* The modes fall quickly: what lies beyond the last ones is no larger than they are. */
static struct br_judge_report mms_report(const void *self)
{
    const struct mms_judge *j = self;
    struct br_judge_report report = {.seconds = j->seconds[BR_AXIAL] + j->seconds[BR_BENDING]};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_MEASURES; measure++)
            report.own_error[kind][measure] = sqrt(j->tail[kind][measure]);
    return report;
}

static void mms_tell(const void *self, FILE *out)
{
    const struct mms_judge *j = self;
    const char *u = j->scene->axial.solution, *w = j->scene->bending.solution;
    fprintf(out, "Manufactured solution: %s%s%s%s%s.\n", u ? "u = " : "", u ? u : "",
            u && w ? ", " : "", w ? "w = " : "", w ? w : "");
}

const struct br_judge br_judge_mms = {
    .name = "mms",
    .syntax = "mms",
    .title = "the solution that a scene was manufactured from",
    .citation = "Roache 2002; derivatives by rule",
    .create = mms_create,
    .free = mms_free,
    .advance = mms_advance,
    .sample = mms_sample,
    .report = mms_report,
    .tell = mms_tell,
};
