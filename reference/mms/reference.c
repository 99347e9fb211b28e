/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The given solution of a scene as a reference: its derivatives in Legendre modes, by quadrature.
 */
#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "reference/exact/legendre.h"
#include "reference/reference.h"
#include "solver/modes.h"
#include "solver/scene.h"

/* Twelve Gauss points give the modes up to degree 10 of a polynomial of degree 13 exactly; the last
 * two degrees measure the error. */
enum { POINTS = 12, MODES = 11, TAIL = 2 };

struct mms_reference {
    struct br_function derivative[2][BR_MEASURES]; /* by br_field_kind; the tip's: the solution */
    const struct br_scene *scene;
    size_t *mesh, meshes, levels; /* mesh: elements; owned */
    int axial_degree;
    double xi[POINTS], weight[POINTS][MODES]; /* Gauss weight times mode */
    double *x[2];                             /* by br_field_kind: the points of a mesh, m; */
    double *value[2];                         /* values at these points */
    double time[2];                           /* by br_field_kind, s */
    double tail[2][BR_MEASURES];              /* the largest sum of squares of the last modes */
    double seconds[2];                        /* by br_field_kind */
};

static void mms_free(void *self)
{
    struct mms_reference *j = self;
    if (!j)
        return;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        for (int measure = 0; measure < BR_MEASURES; measure++)
            br_function_free(&j->derivative[kind][measure]);
        free(j->x[kind]);
    }
    free(j->mesh);
    free(j);
}

static enum br_status derive(struct mms_reference *j, enum br_field_kind kind, struct br_error *err)
{
    const struct br_function *given = &j->scene->field[kind].given;
    static const struct br_partial order[] = {
        [BR_DISPLACEMENT] = {0, 0}, [BR_VELOCITY] = {0, 1}, [BR_STRAIN_RATE] = {1, 1}};
    enum br_status status = br_function_clone(given, &j->derivative[kind][BR_TIP], err);
    for (int measure = 0; measure < BR_TIP && !status; measure++)
        status = br_function_derivative(
            given,
            (struct br_partial){order[measure].x * (kind == BR_AXIAL ? 1 : 2), order[measure].t},
            &j->derivative[kind][measure], err);
    return status;
}

/* Allocates the points of the finest mesh, for each field its own: two threads may use the two
 * fields. */
static enum br_status make_points(struct mms_reference *j, struct br_error *err)
{
    size_t most = 0;
    for (size_t i = 0; i < j->meshes; i++)
        most = j->mesh[i] > most ? j->mesh[i] : most;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
    for (size_t q = 0; q < POINTS && table; q++) {
        double weight;
        gsl_integration_glfixed_point(0, 1, q, &j->xi[q], &weight, table);
        br_legendre(MODES, j->xi[q], j->weight[q]);
        for (size_t m = 0; m < MODES; m++)
            j->weight[q][m] *= weight;
    }
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        j->x[kind] = br_allocate(2 * most * POINTS, sizeof(double));
        j->value[kind] = j->x[kind] ? j->x[kind] + most * POINTS : NULL;
    }
    gsl_integration_glfixed_table_free(table);
    return table && j->x[BR_AXIAL] && j->x[BR_BENDING]
               ? BR_OK
               : br_no_memory(err, "the manufactured solution");
}

static enum br_status mms_create(void **self, const struct br_reference_request *r,
                                 struct br_error *err)
{
    const struct br_scene *scene = r->scene;
    *self = NULL;
    if ((scene->axial.modelled && !scene->axial.solution) ||
        (scene->bending.modelled && !scene->bending.solution))
        return br_fail(err, BR_BAD_INPUT,
                       "--reference mms needs a scene with a manufactured solution: keys "
                       "'solution' in axial and bending");
    struct mms_reference *j = *self = br_allocate(1, sizeof *j);
    if (!j || !(j->mesh = br_allocate(r->mesh_count + 1, sizeof *j->mesh)))
        return br_no_memory(err, "the manufactured solution");
    if (r->mesh_count > 0)
        memcpy(j->mesh, r->mesh, r->mesh_count * sizeof *j->mesh);
    j->meshes = r->mesh_count;
    j->levels = r->levels;
    j->axial_degree = r->axial_degree;
    j->scene = scene;
    enum br_status status = make_points(j, err);
    if (!status && scene->axial.solution)
        status = derive(j, BR_AXIAL, err);
    return !status && scene->bending.solution ? derive(j, BR_BENDING, err) : status;
}

static enum br_status mms_advance(void *self, enum br_field_kind kind, size_t i,
                                  struct br_error *err)
{
    struct mms_reference *j = self;
    (void)err;
    j->time[kind] = j->scene->duration * (double)i / (double)j->levels;
    return BR_OK;
}

/* Writes the modes on n elements, and the rest up to degree 10, to the view; returns the sum of
 * squares of the last ones, or of what rounding does to all. */
static double project(struct mms_reference *j, const struct br_sample_at *at, struct br_view *view)
{
    const size_t n = j->mesh[at->mesh], kept = view->modes;
    const double rounding = 1e-13; /* relative */
    const double h = j->scene->length / (double)n;
    double *x = j->x[at->kind], *value = j->value[at->kind], tail = 0, all = 0;
    for (size_t e = 0; e < n; e++)
        for (size_t q = 0; q < POINTS; q++)
            x[e * POINTS + q] = h * ((double)e + j->xi[q]);
    br_function_evaluate(&j->derivative[at->kind][at->measure], n * POINTS, x, j->time[at->kind],
                         value);
    for (size_t e = 0; e < n; e++) {
        double mode[MODES] = {0};
        for (size_t q = 0; q < POINTS; q++)
            for (size_t m = 0; m < MODES; m++)
                mode[m] += sqrt(h) * value[e * POINTS + q] * j->weight[q][m];
        memcpy(view->values + e * kept, mode, kept * sizeof *mode);
        for (size_t m = 0; m < MODES; m++)
            all += mode[m] * mode[m];
        for (size_t m = kept; m < MODES; m++)
            view->rest += mode[m] * mode[m];
        for (size_t m = MODES - TAIL; m < MODES; m++)
            tail += mode[m] * mode[m];
    }
    return fmax(tail, rounding * rounding * all);
}

static void mms_sample(void *self, const struct br_sample_at *at, struct br_view *view)
{
    struct mms_reference *j = self;
    const double start = br_seconds();
    double *tail = &j->tail[at->kind][at->measure];
    if (at->measure == BR_TIP) {
        br_view_modes(view, 0);
        *view->values =
            br_function_at(&j->derivative[at->kind][BR_TIP], j->scene->length, j->time[at->kind]);
    } else {
        br_view_modes(view,
                      br_mode_count((struct br_elements){at->kind, j->axial_degree}, at->measure));
        *tail = fmax(*tail, project(j, at, view));
    }
    j->seconds[at->kind] += br_seconds() - start;
}

/* The modes decay fast: the rest beyond the last ones is no larger than they are. */
static struct br_reference_report mms_report(const void *self)
{
    const struct mms_reference *j = self;
    struct br_reference_report report = {.seconds = j->seconds[BR_AXIAL] + j->seconds[BR_BENDING]};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_MEASURES; measure++)
            report.own_error[kind][measure] = sqrt(j->tail[kind][measure]);
    return report;
}

static void mms_print_notes(const void *self, FILE *out)
{
    const struct mms_reference *j = self;
    const char *u = j->scene->axial.solution, *w = j->scene->bending.solution;
    fprintf(out, "Manufactured solution: %s%s%s%s%s.\n", u ? "u = " : "", u ? u : "",
            u && w ? ", " : "", w ? "w = " : "", w ? w : "");
}

const struct br_reference br_reference_mms = {
    .name = "mms",
    .syntax = "mms",
    .title = "the solution that a scene was manufactured from",
    .citation = "Roache 2002; derivatives by rule",
    .create = mms_create,
    .free = mms_free,
    .advance = mms_advance,
    .sample = mms_sample,
    .report = mms_report,
    .print_notes = mms_print_notes,
};
