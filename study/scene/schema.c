/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/schema.h"

#include <gsl/gsl_deriv.h>
#include <math.h>
#include <string.h>

#include "solver/proof.h"

#define AT(member) offsetof(struct br_scene, member)

const char *const br_friction_law_names[BR_FRICTION_LAWS] = {
    [BR_TRESCA] = "tresca",
    [BR_COULOMB] = "coulomb",
};

const struct br_scene_key br_scene_keys[] = {
    {"", "title", BR_KEY_TEXT, BR_REQUIRED, 0, "", AT(title), "one line for a person", "My scene"},
    {"", "remark", BR_KEY_TEXT, BR_OPTIONAL, 0, "", AT(remark),
     "a sentence to stand beside the results", "A sentence about it"},
    {"", "length", BR_KEY_POSITIVE, BR_REQUIRED, 0, "m", AT(length), "the beam's length L", "1 m"},
    {"", "duration", BR_KEY_POSITIVE, BR_REQUIRED, 0, "s", AT(duration), "the time interval T",
     "1 s"},
    {"", "density", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "kg/m", AT(density),
     "mass per length rho", "0.1 kg/m"},
    {"", "mass_density", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "kg/m^3", 0,
     "mass per volume; with area, instead of density", "7850 kg/m^3"},
    {"", "young", BR_KEY_POSITIVE, BR_MAKES, 0, "Pa", 0,
     "Young's modulus; with area and inertia, instead of the stiffnesses", "210 GPa"},
    {"", "area", BR_KEY_POSITIVE, BR_MAKES, 0, "m^2", 0, "area of the cross-section", "100 mm^2"},
    {"", "inertia", BR_KEY_POSITIVE, BR_MAKES, 0, "m^4", 0,
     "second moment of area of the cross-section", "208.3 mm^4"},
    {"", "section", BR_KEY_SHAPE, BR_MAKES, 0, "", 0,
     "rectangle WIDTH x HEIGHT, circle DIAMETER or tube DIAMETER x WALL, instead of area and "
     "inertia",
     "rectangle 20 mm x 5 mm"},
    {"", "axial", BR_KEY_SECTION, BR_OPTIONAL, 0, "", AT(axial.modelled), "the rod, u", ""},
    {"", "bending", BR_KEY_SECTION, BR_OPTIONAL, 0, "", AT(bending.modelled), "the beam, w", ""},
    {"", "contact", BR_KEY_SECTION, BR_OPTIONAL, 0, "", AT(contact.modelled),
     "normal compliance (10)", ""},
    {"", "friction", BR_KEY_SECTION, BR_OPTIONAL, 0, "", 0, "friction at the tip (12)", ""},
    {"", "verify", BR_KEY_VERIFY, BR_OPTIONAL, 0, "", 0, "what 'beamrate check' expects", ""},

    {"axial", "stiffness", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N", AT(axial.stiffness), "a1",
     "1000 N"},
    {"axial", "viscosity", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N s", AT(axial.viscosity), "c1",
     "10 N s"},
    {"axial", "relaxation_time", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "s", 0,
     "viscosity/stiffness, instead of viscosity", "10 ms"},
    {"axial", "damping_ratio", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "1", 0,
     "of the lowest mode, instead of viscosity", "2 %"},
    {"axial", "load", BR_KEY_LOAD, BR_OPTIONAL, 0, "N/m", AT(axial.load), "f_H(x, t)",
     "100*(exp(t) - 1) [N/m]"},
    {"axial", "tip_force", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N", AT(axial.tip_force),
     "a force on the tip along the beam", "5*sin(t) [N]"},
    {"axial", "solution", BR_KEY_SOLUTION, BR_OPTIONAL, 0, "m", AT(axial.solution),
     "u(x, t), from which load, tip force and initial data are derived", "0.1*sin(8*x)*t^2 [m]"},
    {"axial", "displacement", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m", AT(axial.displacement), "u_0(x)",
     "0.01*sin(pi*x/2) [m]"},
    {"axial", "velocity", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m/s", AT(axial.velocity), "v_0(x)",
     "2*sin(pi*x/2) [m/s]"},

    {"bending", "stiffness", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N m^2", AT(bending.stiffness),
     "a2", "1000 N m^2"},
    {"bending", "viscosity", BR_KEY_NOT_NEGATIVE, BR_OR_DERIVED, 0, "N m^2 s",
     AT(bending.viscosity), "c2", "10 N m^2 s"},
    {"bending", "relaxation_time", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "s", 0,
     "viscosity/stiffness, instead of viscosity", "10 ms"},
    {"bending", "damping_ratio", BR_KEY_NOT_NEGATIVE, BR_MAKES, 0, "1", 0,
     "of the lowest mode, instead of viscosity", "2 %"},
    {"bending", "load", BR_KEY_LOAD, BR_OPTIONAL, 0, "N/m", AT(bending.load), "f_V(x, t)",
     "-1000*x*sin(3*t) [N/m]"},
    {"bending", "tip_force", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N", AT(bending.tip_force),
     "a force on the tip across the beam", "2*sin(3*t) [N]"},
    {"bending", "tip_moment", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N m", AT(bending.tip_moment),
     "a moment on the tip", "2*sin(2*t) [N m]"},
    {"bending", "solution", BR_KEY_SOLUTION, BR_OPTIONAL, 0, "m", AT(bending.solution),
     "w(x, t), from which load, tip forces and initial data are derived",
     "0.1*(1 - cos(12*x))*exp(-t) [m]"},
    {"bending", "stick_force", BR_KEY_HISTORY, BR_OPTIONAL, 0, "N", AT(bending.stick_force),
     "the friction force of a solution while its tip rests", "3*cos(2*t) [N]"},
    {"bending", "displacement", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m", AT(bending.displacement),
     "w_0(x)", "0.02*x^2 [m]"},
    {"bending", "displacement_slope", BR_KEY_INITIAL, BR_OPTIONAL, 0, "1",
     AT(bending.displacement_slope), "the derivative of w_0", "0.04*x [1]"},
    {"bending", "velocity", BR_KEY_INITIAL, BR_OPTIONAL, 0, "m/s", AT(bending.velocity),
     "the initial bending velocity", "0.2*x^2 [m/s]"},
    {"bending", "velocity_slope", BR_KEY_INITIAL, BR_OPTIONAL, 0, "1/s", AT(bending.velocity_slope),
     "the derivative of the initial bending velocity", "0.4*x [1/s]"},

    {"contact", "gap", BR_KEY_NOT_NEGATIVE, BR_REQUIRED, 0, "m", AT(contact.gap), "g", "0.01 m"},
    {"contact", "stiffness", BR_KEY_NOT_NEGATIVE, BR_REQUIRED, 0, "N/m", AT(contact.stiffness),
     "c_H", "1000 N/m"},

    {"friction", "law", BR_KEY_LAW, BR_REQUIRED, 0, "", 0, "tresca or coulomb", "coulomb"},
    {"friction", "bound", BR_KEY_NOT_NEGATIVE, BR_REQUIRED, BR_TRESCA, "N",
     AT(friction.coefficient), "c_V of Tresca's law", "100 N"},
    {"friction", "coefficient", BR_KEY_NOT_NEGATIVE, BR_OR_RATIO, BR_COULOMB, "N/m",
     AT(friction.coefficient), "c_V of Coulomb's law, or without unit c_V/c_H", "1e4 N/m"},
    {"friction", "regularisation", BR_KEY_NOT_NEGATIVE, BR_OPTIONAL, 0, "m/s",
     AT(friction.regularisation), "mu of (29)", "1e-8 m/s"},
    {0},
};
_Static_assert(sizeof br_scene_keys / sizeof *br_scene_keys <= BR_MOST_SCENE_KEYS,
               "struct br_scene_given has no room");

size_t br_scene_row(const char *path)
{
    const char *dot = strchr(path, '.');
    const size_t length = dot ? (size_t)(dot - path) : 0;
    size_t row = 0;
    while (strlen(br_scene_keys[row].section) != length ||
           strncmp(br_scene_keys[row].section, path, length) != 0 ||
           strcmp(br_scene_keys[row].name, dot ? dot + 1 : path) != 0)
        row++;
    return row;
}

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

static enum br_status refuse_jumps(const struct initial *d, const struct br_function *f,
                                   const char *name, struct br_error *err)
{
    const struct br_box box = {{0, d->length}, {0, 0}};
    const double scale = largest(f, d->length);
    struct br_breaks breaks = {0};
    struct br_error failure;
    enum br_status status = br_breaks_add(f, BR_X, box, &breaks, &failure);
    status = status == BR_NO_MEMORY ? br_no_memory(err, "initial data") : BR_OK;
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

enum br_status br_scene_check_initial(const struct br_scene *s, size_t *culprit,
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
        *culprit =
            br_function_is_zero(&s->axial.velocity) ? AT(bending.velocity) : AT(axial.velocity);
        return br_fail(err, BR_BAD_INPUT,
                       "an initial velocity has no effect without density, expected none");
    }
    if (!br_function_is_zero(&b->stick_force) &&
        (!b->solution || s->friction.law == BR_FRICTIONLESS)) {
        *culprit = AT(bending.stick_force);
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
    struct br_breaks breaks = {0};
    struct br_error failure;
    enum br_status status = br_breaks_add(f, along, box, &breaks, &failure);
    if (status == BR_NO_MEMORY)
        br_fail(err, status, "%s", failure.message);
    else
        status = BR_OK; /* too many breaks: each user of the function reports it */
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
    if (!status && f->uses_x != f->uses_t && br_function_guard(f, 0))
        status = refuse_single_values(f, f->uses_x ? BR_X : BR_T, box, &inner);
    if (!status)
        return BR_OK;
    return br_fail(err, status, "%.500s, expected a finite number everywhere in %s", inner.message,
                   !f->uses_t   ? "[0, L]"
                   : !f->uses_x ? "[0, T]"
                                : "[0, L] and [0, T]");
}

enum br_status br_scene_scan(const struct br_scene *scene, const struct br_scene_key *key,
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
