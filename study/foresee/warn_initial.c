/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of initial data whose jumps and peaks lie between the nodes: what is interpolated there is
 * compared in L2 with the data, on a mesh on which they are proved to be resolved. */
#include <math.h>

#include "study/foresee/load_mesh.h"
#include "study/foresee/warnings.h"

static const double large = 0.05; /* of the data's own norm */

/* Initial data on an element [from, from + h] at the nodes; slope NULL: linear. */
struct data {
    const struct br_function *value, *slope;
    const char *name;
    double length;
    size_t n;
};

static double at(const struct br_function *f, double x)
{
    double value;
    br_function_evaluate(f, 1, &x, 0, &value);
    return value;
}

/* Values and h times slopes at both ends of element e. */
static void ends_of(const struct data *d, size_t e, double value[2], double slope[2])
{
    const double h = d->length / (double)d->n;
    for (size_t i = 0; i < 2; i++) {
        const double x = e + i == d->n ? d->length : (double)(e + i) * h;
        value[i] = at(d->value, x);
        slope[i] = d->slope ? h * at(d->slope, x) : 0;
    }
}

/* At s in [0, 1] of an element. */
static double interpolated(const struct data *d, const double value[2], const double slope[2],
                           double s)
{
    const double r = 1 - s;
    if (!d->slope)
        return r * value[0] + s * value[1];
    return r * r * (1 + 2 * s) * value[0] + s * s * (1 + 2 * r) * value[1] +
           r * s * (r * slope[0] - s * slope[1]);
}

/* Adds the squares over one piece of element e: of what is missed, and of the data. */
static void add_piece(const struct data *d, size_t e, struct br_interval piece, double square[2])
{
    const struct br_box box = {{0, d->length}, {0, 0}};
    const double width = piece.high - piece.low;
    double f[BR_LOAD_PLACES], value[2], slope[2];
    br_load_values(d->value, BR_X, box, piece, f);
    ends_of(d, e, value, slope);
    for (int i = 0; i < BR_LOAD_PLACES; i++) {
        const double x = piece.low + width * br_load_place[i],
                     s = x * (double)d->n / d->length - (double)e,
                     off = f[i] - interpolated(d, value, slope, s);
        square[0] += width * br_load_weight[i] * off * off;
        square[1] += width * br_load_weight[i] * f[i] * f[i];
    }
}

static void add_mesh(const struct data *d, const struct br_mesh *mesh, double square[2])
{
    size_t e = 0;
    for (size_t i = 0; i < mesh->count; i++)
        for (double from = mesh->at[i]; from < mesh->at[i + 1];) {
            const double end =
                e + 1 < d->n ? (double)(e + 1) * d->length / (double)d->n : d->length;
            const double to = fmin(end, mesh->at[i + 1]);
            if (to > from)
                add_piece(d, e, (struct br_interval){from, to}, square);
            e += to >= end && e + 1 < d->n;
            from = to;
        }
}

/* Both squares, on meshes that become finer until what is rough could not add to them. */
static enum br_status measure(const struct data *d, double square[2], struct br_error *err)
{
    enum { DEGREE = 8, ROUNDS = 10 };
    const double rough = 1e-4; /* of the data's square */
    const struct br_box box = {{0, d->length}, {0, 0}};
    struct br_interval values;
    struct br_box peak;
    struct br_mesh mesh = {0};
    if (!br_enclose_values(d->value, box, 0, &values, &peak))
        return br_fail(err, BR_BAD_INPUT, "it cannot be bounded");
    const double most = fmax(fabs(values.low), fabs(values.high));
    struct br_mesh_aim aim = {.degree = DEGREE, .tolerance = 1e-3 * most};
    for (int i = 0; i < ROUNDS && most > 0; i++) {
        const enum br_status status = br_resolve(d->value, BR_X, box, &aim, &mesh, err);
        square[0] = square[1] = 0;
        if (!status)
            add_mesh(d, &mesh, square);
        const double missed = mesh.missed;
        br_mesh_free(&mesh);
        if (status || missed * most <= rough * square[1])
            return status;
        aim.tolerance /= 16;
    }
    return most > 0 ? br_fail(err, BR_BAD_INPUT, "it cannot be resolved") : BR_OK;
}

static enum br_status look_at(const struct data *d, struct br_warnings *w, struct br_error *err)
{
    double square[2] = {0};
    if (!d->value->uses_x || (d->value->ops && !d->value->ops->bound))
        return BR_OK; /* of a solution that was given: nothing is proved of it */
    const enum br_status status = measure(d, square, err);
    if (status == BR_NO_MEMORY)
        return status;
    const double missed = status ? INFINITY : sqrt(square[0]);
    const char *share = br_unseen(w, BR_WARN_INITIAL, missed, sqrt(square[1]), large);
    if (status)
        br_warn(w, BR_WARN_INITIAL, "more elements, as short as what happens there",
                "%s changes so often that it is not known how much of it lies between the nodes, "
                "with n = %zu",
                d->name, d->n);
    else if (share)
        br_warn(w, BR_WARN_INITIAL, "more elements, as short as what happens there",
                "%s does between the nodes what they do not see: with n = %zu %s of its norm",
                d->name, d->n, share);
    return BR_OK;
}

static enum br_status look(const struct br_planned_march *o, struct br_warnings *w,
                           struct br_error *err)
{
    const struct br_axial *a = &o->scene->axial;
    const struct br_bending *b = &o->scene->bending;
    const double length = o->scene->length;
    const struct data rows[] = {
        {&a->displacement, NULL, "the initial axial displacement", length, o->n},
        {&a->velocity, NULL, "the initial axial velocity", length, o->n},
        {&b->displacement, &b->displacement_slope, "the initial deflection", length, o->n},
        {&b->velocity, &b->velocity_slope, "the initial velocity of bending", length, o->n},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && !status; i++)
        if (i < 2 ? a->modelled : b->modelled)
            status = look_at(&rows[i], w, err);
    return status;
}

const struct br_warning_source br_warn_initial = {
    .title = "initial data between the nodes",
    .look = look,
};
