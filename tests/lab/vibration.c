/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "solver/field.h"
#include "solver/function.h"
#include "solver/method.h"
#include "solver/scene.h"
#include "study/extremes/extremes.h"
#include "tests/lab/energy.h"
#include "tests/lab/step_matrix.h"

/* ---- the lowest mode ---- */

static void assemble(const struct br_field *f, gsl_matrix *k, gsl_matrix *m)
{
    const struct br_element *element = br_element_of(f->kind, 1);
    const size_t d = element->unknowns;
    const double bend = f->stiffness / (f->kind == BR_AXIAL ? f->h : f->h * f->h * f->h);
    for (size_t e = 0; e < f->n; e++)
        for (size_t i = 0; i < 2 * d; i++)
            for (size_t j = 0; j < 2 * d; j++) {
                const size_t row = e * d + i, column = e * d + j;
                if (row < d || column < d)
                    continue; /* clamped */
                *gsl_matrix_ptr(k, row - d, column - d) +=
                    bend * element->entry[BR_STIFFNESS][i][j];
                *gsl_matrix_ptr(m, row - d, column - d) +=
                    f->density * f->h *
                    ((double)element->entry[BR_MASS][i][j] / element->over[BR_MASS]);
            }
}

static void take_lowest(struct br_beam_mode *mode, const gsl_vector *values,
                        const gsl_matrix *vectors, const gsl_matrix *m)
{
    const size_t size = values->size, tip = mode->kind == BR_AXIAL ? size - 1 : size - 2;
    const size_t lowest = gsl_vector_min_index(values);
    double square = 0;
    mode->omega = sqrt(gsl_vector_get(values, lowest));
    for (size_t i = 0; i < size; i++)
        mode->phi[i] = gsl_matrix_get(vectors, i, lowest) / gsl_matrix_get(vectors, tip, lowest);
    for (size_t i = 0; i < size; i++) {
        mode->weight[i] = 0;
        for (size_t j = 0; j < size; j++)
            mode->weight[i] += gsl_matrix_get(m, i, j) * mode->phi[j];
        square += mode->weight[i] * mode->phi[i];
    }
    for (size_t i = 0; i < size; i++)
        mode->weight[i] /= square;
}

enum br_status br_beam_mode_find(struct br_beam_mode *mode, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err)
{
    const struct br_field f = br_field_of_scene(scene, kind, BR_MODE_ELEMENTS, NAN, 1);
    const size_t size = br_field_unknowns(&f) * f.n;
    *mode = (struct br_beam_mode){.kind = kind};
    double room[4][BR_MODE_UNKNOWNS * BR_MODE_UNKNOWNS] = {{0}}, value[BR_MODE_UNKNOWNS];
    gsl_matrix_view k = gsl_matrix_view_array(room[0], size, size),
                    m = gsl_matrix_view_array(room[1], size, size),
                    mass = gsl_matrix_view_array(room[2], size, size),
                    vectors = gsl_matrix_view_array(room[3], size, size);
    gsl_vector_view values = gsl_vector_view_array(value, size);
    gsl_eigen_gensymmv_workspace *w = gsl_eigen_gensymmv_alloc(size);
    if (!w)
        return br_no_memory(err, "a mode");
    assemble(&f, &k.matrix, &m.matrix);
    gsl_matrix_memcpy(&mass.matrix, &m.matrix);
    const int failed = gsl_eigen_gensymmv(&k.matrix, &m.matrix, &values.vector, &vectors.matrix, w);
    gsl_eigen_gensymmv_free(w);
    if (failed)
        return br_fail(err, BR_SINGULAR, "the modes of %zu elements were not found", f.n);
    take_lowest(mode, &values.vector, &vectors.matrix, &mass.matrix);
    return BR_OK;
}

double br_beam_mode_component(const struct br_beam_mode *mode, const double *nodal)
{
    const size_t d = mode->kind == BR_AXIAL ? 1 : 2;
    double component = 0;
    for (size_t i = 0; i < d * BR_MODE_ELEMENTS; i++)
        component += mode->weight[i] * nodal[d + i];
    return component;
}

/* ---- what a time scheme makes of y' = lambda y in a step, by its textbook ---- */

typedef long double real;

/* R(z), row by row: Y_i (1 - z a_ii) = 1 + z sum of a_ij Y_j. */
static double complex stability_function(const struct br_textbook *t, double complex z)
{
    long double complex y[BR_TEXTBOOK_ROWS];
    for (int i = 0; i < t->rows; i++) {
        long double complex sum = 1;
        for (int j = 0; j < i; j++)
            sum += z * t->a[i][j] * y[j];
        y[i] = sum / (1 - z * t->a[i][i]);
    }
    return (double complex)y[t->rows - 1];
}

/* Newton's method, continued from z = 0, where the root is 1, to z in small steps. */
static double complex principal_root(const struct br_textbook *t, double complex z)
{
    enum { PIECES = 64, ITERATIONS = 8 };
    long double complex r = 1;
    for (int piece = 1; piece <= PIECES; piece++)
        for (int i = 0; i < ITERATIONS; i++) {
            long double complex value = 1 - t->beta * z * (real)piece / PIECES, slope = 0;
            for (int j = 0; j < t->back; j++) {
                slope = slope * r + value;
                value = value * r - t->past[j];
            }
            r -= value / slope;
        }
    return (double complex)r;
}

double complex br_amplification(const struct br_textbook *t, double complex z)
{
    return t->rows > 0 ? stability_function(t, z) : principal_root(t, z);
}

/* ---- a vibration ---- */

/* First steps, in which the effects of the scheme's start die away, and then measured periods. */
enum { FIRST_STEPS = 60, PERIODS = 2 };

struct trial {
    struct br_vibration *v;
    struct br_scene scene;
    struct br_method method;
    struct br_beam_mode mode;
    struct br_field field;
    double nodal[BR_MODE_UNKNOWNS + 2]; /* of the mode */
    struct br_nodal_shape shape[2];     /* values, slopes */
    struct br_march *march;
    struct br_energy_meter *meter;
    double k;
};

/* An adaptive scheme's start is over at once. */
static size_t first_steps(const struct br_vibration *v)
{
    return v->scheme->adaptive ? 2 : FIRST_STEPS;
}

static size_t steps_of(const struct br_vibration *v)
{
    return first_steps(v) + PERIODS * v->per_period;
}

static void set_scene(struct trial *t)
{
    const double viscosity = 2 * t->v->damping / t->mode.omega; /* C = viscosity K */
    const double k = t->k = 2 * M_PI / t->mode.omega / (double)t->v->per_period;
    t->scene.duration = k * (double)steps_of(t->v);
    t->scene.axial.viscosity = t->scene.bending.viscosity = viscosity;
    t->field = br_field_of_scene(&t->scene, t->v->kind, BR_MODE_ELEMENTS, k, 1);
    memcpy(t->nodal + br_field_unknowns(&t->field), t->mode.phi, sizeof t->mode.phi);
    for (int slope = 0; slope < 2; slope++)
        t->shape[slope] = (struct br_nodal_shape){&t->field, t->nodal, slope};
    t->scene.axial.displacement = t->scene.bending.displacement = br_nodal_function(&t->shape[0]);
    t->scene.bending.displacement_slope = br_nodal_function(&t->shape[1]);
}

/* |alpha|^2 of the two eigenvectors of q'' + 2 zeta omega q' + omega^2 q = 0, which neither
 * viscosity nor a scheme couples: without damping the energy. */
static double amplitude(const struct trial *t)
{
    double displacement[2 * (BR_MODE_ELEMENTS + 1)], velocity[2 * (BR_MODE_ELEMENTS + 1)];
    br_march_get(t->march, t->v->kind, displacement, velocity);
    const double q = t->mode.omega * br_beam_mode_component(&t->mode, displacement);
    const double p = br_beam_mode_component(&t->mode, velocity);
    return p * p + 2 * t->v->damping * p * q + q * q;
}

/* A march's failure is a result. */
static enum br_status advance(struct trial *t, size_t steps, struct br_error *err)
{
    struct br_vibration *v = t->v;
    for (size_t i = 0; i < steps; i++) {
        const enum br_status status = br_march_step(t->march, err);
        if (status)
            return status;
        v->worst = br_worst(v->worst, br_energy_meter_step(t->meter));
    }
    return BR_OK;
}

static void predict(struct trial *t)
{
    struct br_vibration *v = t->v;
    const struct br_textbook *book = br_textbook_step(v->scheme->name, 2);
    const double zeta = v->damping, n = (double)v->per_period;
    const double complex lambda = t->mode.omega * (-zeta + I * sqrt(1 - zeta * zeta));
    v->predicted = NAN;
    if (!v->scheme->adaptive)
        v->predicted = -expm1(
            2 * n * (log(cabs(br_amplification(book, t->k * lambda))) - creal(lambda) * t->k));
}

static enum br_status march(struct trial *t, struct br_error *err)
{
    struct br_vibration *v = t->v;
    const double ideal = 2 * v->damping * t->mode.omega * t->k * (double)v->per_period;
    enum br_status status = advance(t, first_steps(v), err);
    const double before = amplitude(t);
    if (!status)
        status = advance(t, PERIODS * v->per_period, err);
    if (status) {
        v->end = BR_VIBRATION_FAILED;
        v->failure = *err;
        return status == BR_NOT_FINITE ? BR_OK : status;
    }
    v->measured = -expm1(log(amplitude(t) / before) / PERIODS + ideal);
    predict(t);
    return BR_OK;
}

static struct br_scene bare(const struct br_vibration *v)
{
    struct br_scene s = {.length = 1, .duration = 1, .density = v->density};
    s.axial.modelled = v->kind == BR_AXIAL;
    s.bending.modelled = v->kind == BR_BENDING;
    s.axial.stiffness = s.bending.stiffness = 1;
    return s;
}

/* The eigenvalues of a dense matrix are right to its norm's last bits, n^2 or n^4 of the lowest. */
static double predicted_round_off(const struct br_vibration *v)
{
    const double n = BR_MODE_ELEMENTS, condition = v->kind == BR_AXIAL ? n * n : n * n * n * n;
    return 64 * DBL_EPSILON * (PERIODS * (double)v->per_period + condition);
}

enum br_status br_vibration_run(struct br_vibration *v, struct br_error *err)
{
    struct trial t = {.v = v, .scene = bare(v), .method = br_method_default()};
    enum br_status status = br_beam_mode_find(&t.mode, &t.scene, v->kind, err);
    if (status)
        return status;
    set_scene(&t);
    t.method.scheme = v->scheme;
    t.method.contact = br_contact_rule_of(v->scheme);
    if (v->scheme->adaptive)
        t.method.tolerance = v->tolerance;
    v->end = BR_VIBRATION_DONE;
    v->worst = 0;
    if (br_method_check(&t.method, &t.scene, &v->failure)) {
        v->end = BR_VIBRATION_REFUSED;
        return BR_OK;
    }
    status = br_march_create(&t.march, &t.scene, BR_MODE_ELEMENTS, steps_of(v), &t.method, err);
    if (!status) {
        v->limit = br_energy_limit(BR_MODE_ELEMENTS, br_march_round_off(t.march));
        v->round_off = predicted_round_off(v);
        status = br_energy_meter_create(&t.meter, t.march, &t.scene, &t.method, err);
    }
    if (!status)
        status = march(&t, err);
    if (status == BR_BAD_INPUT) { /* by the march: a mode of too little damping, say */
        v->end = BR_VIBRATION_REFUSED;
        v->failure = *err;
        status = BR_OK;
    }
    br_energy_meter_free(t.meter);
    br_march_free(t.march);
    return status;
}

bool br_vibration_is_right(const struct br_vibration *v)
{
    if (v->end != BR_VIBRATION_DONE)
        return v->end == BR_VIBRATION_REFUSED;
    return v->worst <= v->limit && isfinite(v->measured) &&
           (v->scheme->adaptive || fabs(v->measured - v->predicted) <= v->round_off);
}
