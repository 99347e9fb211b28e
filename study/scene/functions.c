/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of a scene: those that follow from a solution, and the checks of all of them. */
#include <gsl/gsl_deriv.h>
#include <math.h>

#include "solver/proof.h"
#include "study/known/expression.h"
#include "study/scene/value.h"

/* Derives loads, tip forces and initial data from a solution (manufactured.c). */
enum br_status br_scene_apply_solutions(const struct br_scene_reader *r)
{
    struct br_error inner = {0};
    enum br_field_kind culprit = BR_AXIAL;
    enum br_status status = br_manufactured_apply(r->scene, &culprit, &inner);
    const size_t row = br_scene_row(culprit == BR_AXIAL ? "axial.solution" : "bending.solution");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_scene_field *field = &r->scene->field[kind];
        struct br_function whole = field->load.term[0].space;
        if (field->solution)
            status = br_products(&whole, &field->load, &inner);
    }
    return br_scene_pass_on(r, r->given->row[row].line, "solution", &inner);
}

/* ---- initial data ---- */

/* An initial function and how to check it. */
struct initial {
    const char *name;
    const struct br_function *value;
    const char *slope_name; /* NULL: no slope is needed */
    const struct br_function *slope;
    double length;
    bool continuous; /* it and its slope must be continuous: strains are squared */
};

/* The value of a function of x alone or of t alone. */
static double value_of(const struct br_function *f, double at)
{
    double value;
    br_function_evaluate(f, 1, &at, at, &value);
    return value;
}

static double value_at(double at, void *f)
{
    return value_of(f, at);
}

enum { SAMPLES = 65 };

/* Largest |f| over equidistant points of [0, length]; NaN where f is not finite. */
static double largest(const struct br_function *f, double length)
{
    double most = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double v = fabs(value_of(f, length * i / (SAMPLES - 1)));
        if (!isfinite(v))
            return NAN;
        most = fmax(most, v);
    }
    return most;
}

static enum br_status check_slope(const struct initial *d, double scale, struct br_error *err)
{
    gsl_function f = {.function = value_at, .params = (void *)d->value};
    const double slope_scale = fmax(largest(d->slope, d->length), scale / d->length);
    for (int i = 1; i < SAMPLES - 1; i++) {
        const double x = d->length * i / (SAMPLES - 1);
        double derivative, uncertainty;
        gsl_deriv_central(&f, x, 1e-4 * d->length, &derivative, &uncertainty);
        const double given = value_of(d->slope, x);
        const double allowed = 1e-6 * slope_scale + 10 * uncertainty;
        if (!(fabs(given - derivative) <= allowed))
            return br_fail(err, BR_BAD_INPUT,
                           "bending %s is %g at x = %g m, expected the derivative of %s there, %g",
                           d->slope_name, given, x, d->name, derivative);
    }
    return BR_OK;
}

/* The largest change of a function without a jump over an interval of this small width. */
static double usual_change(double scale, double width, double length)
{
    return (1e-9 + 100 * width / length) * scale;
}

/* Where there are too many breaks, each user of the function reports it. Fails with BR_NO_MEMORY.
 */
static enum br_status find_breaks(const struct br_function *f, enum br_variable along,
                                  struct br_box box, struct br_breaks *breaks, struct br_error *err)
{
    struct br_error failure;
    *breaks = (struct br_breaks){0};
    return br_breaks_add(f, along, box, breaks, &failure) == BR_NO_MEMORY
               ? br_no_memory(err, "the breaks of a function")
               : BR_OK;
}

static enum br_status refuse_jumps(const struct initial *d, const struct br_function *f,
                                   const char *name, struct br_error *err)
{
    const struct br_box box = {{0, d->length}, {0, 0}};
    const double scale = largest(f, d->length);
    struct br_breaks breaks;
    enum br_status status = find_breaks(f, BR_X, box, &breaks, err);
    for (size_t i = 0; i < breaks.count && !status; i++) {
        const struct br_interval at = breaks.at[i];
        const struct br_box around = {{nextafter(at.low, -INFINITY), nextafter(at.high, INFINITY)},
                                      {0, 0}};
        struct br_interval v;
        const bool bounded = br_function_bound(f, around, &v);
        if (!bounded || !(v.high - v.low <= usual_change(scale, at.high - at.low, d->length)))
            status = br_fail(err, BR_BAD_INPUT,
                             "initial %s jumps by %g at x = %.10g m, expected a continuous one",
                             name, v.high - v.low, at.low);
    }
    br_breaks_free(&breaks);
    return status;
}

/* *fault (out): the wrong function. */
static enum br_status check_initial(const struct initial *d, const struct br_function **fault,
                                    struct br_error *err)
{
    *fault = d->value;
    const double scale = largest(d->value, d->length);
    if (!isfinite(scale))
        return br_fail(err, BR_BAD_INPUT, "initial %s is not finite everywhere in [0, L]", d->name);
    const double clamp = value_of(d->value, 0);
    if (!(fabs(clamp) <= 1e-12 * scale))
        return br_fail(err, BR_BAD_INPUT,
                       "initial %s is %g at x = 0, expected 0 where the beam is clamped", d->name,
                       clamp);
    enum br_status status = d->continuous ? refuse_jumps(d, d->value, d->name, err) : BR_OK;
    if (status || !d->slope || scale == 0)
        return status;
    if (br_function_is_zero(d->slope))
        return br_fail(err, BR_BAD_INPUT, "initial %s needs %s, its derivative", d->name,
                       d->slope_name);
    *fault = d->slope;
    const double slope = value_of(d->slope, 0);
    if (!(fabs(slope) <= 1e-12 * scale / d->length))
        return br_fail(err, BR_BAD_INPUT,
                       "initial %s is %g at x = 0, expected 0 where the beam is clamped",
                       d->slope_name, slope);
    status = d->continuous ? refuse_jumps(d, d->slope, d->slope_name, err) : BR_OK;
    return status ? status : check_slope(d, scale, err);
}

static enum br_status check_initial_data(const struct br_scene *s, size_t *culprit,
                                         struct br_error *err)
{
    const struct br_scene_field *b = &s->bending;
    const struct initial data[] = {
        {"axial displacement", &s->axial.displacement, NULL, NULL, s->length, true},
        {"axial velocity", &s->axial.velocity, NULL, NULL, s->length, false},
        {"bending displacement", &b->displacement, "displacement_slope", &b->displacement_slope,
         s->length, true},
        {"bending velocity", &b->velocity, "velocity_slope", &b->velocity_slope, s->length, false},
    };
    if (s->density == 0 &&
        !(br_function_is_zero(&s->axial.velocity) && br_function_is_zero(&b->velocity))) {
        *culprit = br_function_is_zero(&s->axial.velocity)
                       ? offsetof(struct br_scene, bending.velocity)
                       : offsetof(struct br_scene, axial.velocity);
        return br_fail(err, BR_BAD_INPUT,
                       "an initial velocity has no effect without density, expected none");
    }
    if (!br_function_is_zero(&b->stick_force) &&
        (!b->solution || s->friction.law == BR_FRICTIONLESS)) {
        *culprit = offsetof(struct br_scene, bending.stick_force);
        return br_fail(err, BR_BAD_INPUT,
                       "bending stick_force belongs to friction and a solution, expected both");
    }
    for (size_t i = 0; i < sizeof data / sizeof *data; i++) {
        const struct br_function *fault;
        const enum br_status status = check_initial(&data[i], &fault, err);
        if (status) {
            *culprit = (size_t)((const char *)fault - (const char *)s);
            return status;
        }
    }
    return BR_OK;
}

/* ---- functions that are finite everywhere ---- */

/* By how much a value at a break may differ from the values at the next doubles beside it: by a
 * jump and, where the function bends or is zero, by round-off of its values nearby. */
static double usual_difference(const struct br_function *f, const struct br_interval *at,
                               struct br_interval all)
{
    const double near = 1e-9 * (all.high - all.low);
    const double before = value_of(f, nextafter(at->low, -INFINITY));
    const double after = value_of(f, nextafter(at->high, INFINITY));
    const double size = fabs(value_of(f, fmax(all.low, at->low - near))) +
                        fabs(value_of(f, fmin(all.high, at->high + near)));
    return 1e-6 * (fabs(before) + fabs(after) + size) + 4 * fabs(after - before);
}

/* Refuses a value that a function of x or of t has at one point alone, as t == 0.5 ? 1 : 0 has: no
 * integral depends on it, but a time level or a node may be there. */
static enum br_status refuse_single_values(const struct br_function *f, enum br_variable along,
                                           struct br_box box, struct br_error *err)
{
    struct br_breaks breaks;
    enum br_status status = find_breaks(f, along, box, &breaks, err);
    for (size_t i = 0; i < breaks.count && !status; i++) {
        const double ends[] = {breaks.at[i].low, breaks.at[i].high};
        const double before = value_of(f, nextafter(ends[0], -INFINITY));
        const double usual = usual_difference(f, &breaks.at[i], along == BR_X ? box.x : box.t);
        for (size_t k = 0; k < 2 && !status; k++)
            if (!(fabs(value_of(f, ends[k]) - before) <= usual))
                status =
                    br_fail(err, BR_BAD_INPUT, "found %g at %s = %.17g %s alone, and %g beside it",
                            value_of(f, ends[k]), along == BR_X ? "x" : "t", ends[k],
                            along == BR_X ? "m" : "s", before);
    }
    br_breaks_free(&breaks);
    return status;
}

static enum br_status scan(const struct br_scene *s, const struct br_function *f,
                           struct br_error *err)
{
    const struct br_box box = {{0, s->length}, {0, s->duration}};
    struct br_error inner;
    enum br_status status = br_must_be_finite(f, box, &inner);
    if (!status && f->uses_x != f->uses_t && br_function_switching(f, 0))
        status = refuse_single_values(f, f->uses_x ? BR_X : BR_T, box, &inner);
    if (!status)
        return BR_OK;
    return br_fail(err, status, "%.500s, expected a finite number everywhere in %s", inner.message,
                   !f->uses_t   ? "[0, L]"
                   : !f->uses_x ? "[0, T]"
                                : "[0, L] and [0, T]");
}

static enum br_status scan_key(const struct br_scene *scene, const struct br_scene_key *key,
                               struct br_error *err)
{
    const void *at = (const char *)scene + key->offset;
    if (key->kind == BR_KEY_INITIAL || key->kind == BR_KEY_HISTORY)
        return scan(scene, at, err);
    if (key->kind != BR_KEY_LOAD)
        return BR_OK;
    const struct br_load *load = at;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        status = scan(scene, &load->term[i].space, err);
        if (!status)
            status = scan(scene, &load->term[i].time, err);
    }
    return status;
}

/* ---- all of a scene ---- */

/* Checks that every given function is finite and that initial data respect the clamp. */
enum br_status br_scene_check_functions(const struct br_scene_reader *r, size_t line)
{
    struct br_error inner = {0};
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if (br_scene_line(r, k) && scan_key(r->scene, k, &inner))
            return br_scene_pass_on(r, br_scene_line(r, k), k->name, &inner);
    size_t culprit = 0;
    check_initial_data(r->scene, &culprit, &inner);
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++)
        if ((k->kind == BR_KEY_INITIAL || k->kind == BR_KEY_HISTORY) && k->offset == culprit &&
            br_scene_line(r, k))
            return br_scene_pass_on(r, br_scene_line(r, k), k->name, &inner);
    return br_scene_pass_on(r, line, "scene", &inner); /* derived from a solution */
}
