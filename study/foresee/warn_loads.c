/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads and initial data that time levels, elements or nodes do not see. What they do see
 * is compared with integrals on meshes on which the function is proved to be resolved, so that
 * nothing of it can hide between the places. */
#include "study/foresee/warnings.h"

#include <math.h>
#include <stdio.h>

#include "solver/proof.h"

/* ---- meshes ---- */

/* Gauss's rule on [0, 1], exact for degree 9. */
enum { PLACES = 5 };
#define NEAR 0.26923465505284155 /* of the middle: half of the zeros of Legendre's polynomial */
#define FAR 0.45308992296933200

static const double load_place[PLACES] = {0.5 - FAR, 0.5 - NEAR, 0.5, 0.5 + NEAR, 0.5 + FAR};
static const double load_weight[PLACES] = {0.11846344252809454, 0.23931433524968324, 64.0 / 225,
                                           0.23931433524968324, 0.11846344252809454};

/* Values of f at the places of a piece along one variable, at the other's lower end in `box`. */
static void load_values(const struct br_function *f, enum br_variable along, struct br_box box,
                        struct br_interval piece, double value[PLACES])
{
    double place[PLACES];
    for (int i = 0; i < PLACES; i++)
        place[i] = piece.low + (piece.high - piece.low) * load_place[i];
    if (along == BR_X)
        br_function_evaluate(f, PLACES, place, box.t.low, value);
    for (int i = 0; i < PLACES && along == BR_T; i++)
        br_function_evaluate(f, 1, &box.x.low, place[i], &value[i]);
}

static double integral_of_size(const struct br_function *f, enum br_variable along,
                               struct br_box box, const struct br_mesh *m)
{
    double sum = 0, value[PLACES];
    for (size_t i = 0; i < m->count; i++) {
        load_values(f, along, box, (struct br_interval){m->at[i], m->at[i + 1]}, value);
        for (int k = 0; k < PLACES; k++)
            sum += (m->at[i + 1] - m->at[i]) * load_weight[k] * fabs(value[k]);
    }
    return sum;
}

/* Resolves f along one variable, where the other is one point, until what is not resolved is no
 * more than 1 % of *size: out, the integral of |f|. *mesh: out. Fails as br_resolve. */
static enum br_status load_mesh(const struct br_function *f, enum br_variable along,
                                struct br_box box, struct br_mesh *mesh, double *size,
                                struct br_error *err)
{
    enum { DEGREE = 8, ROUNDS = 6 };
    const struct br_interval all = along == BR_X ? box.x : box.t;
    struct br_interval values;
    struct br_box peak;
    enum br_status status = BR_OK;
    *mesh = (struct br_mesh){0};
    if (!br_enclose_values(f, box, 0, &values, &peak))
        return br_fail(err, BR_BAD_INPUT, "it cannot be bounded");
    const double most = fmax(fabs(values.low), fabs(values.high)), width = all.high - all.low;
    struct br_mesh_aim aim = {.degree = DEGREE, .tolerance = 1e-3 * most};
    for (int i = 0; i < ROUNDS && !status; i++) {
        br_mesh_free(mesh);
        status = br_resolve(f, along, box, &aim, mesh, err);
        *size = status ? 0 : integral_of_size(f, along, box, mesh);
        if ((aim.tolerance * width <= 0.01 * *size && mesh->missed <= 0.01 * *size) || most == 0)
            return status;
        aim.tolerance = fmin(fmax(0.005 * *size / width, 1e-6 * aim.tolerance), aim.tolerance / 8);
    }
    if (!status)
        br_mesh_free(mesh);
    return status ? status : br_fail(err, BR_BAD_INPUT, "it cannot be resolved");
}

/* Hands on the parts of the mesh's cells in x, each within one of n elements. */
static void for_each_piece(const struct br_mesh *mesh, double length, size_t n,
                           void (*take)(void *self, size_t e, struct br_interval piece), void *self)
{
    const double h = length / (double)n;
    size_t e = 0;
    for (size_t i = 0; i < mesh->count; i++)
        for (double from = mesh->at[i]; from < mesh->at[i + 1];) {
            const double end = e + 1 < n ? (double)(e + 1) * h : length,
                         to = fmin(end, mesh->at[i + 1]);
            if (to > from)
                take(self, e, (struct br_interval){from, to});
            e += to >= end && e + 1 < n;
            from = to;
        }
}

/* ---- loads between the time levels ---- */

/* Warns of loads that do something between the time levels.
 * Over each step the impulse of a function of time is compared with that of the straight line
 * between its values at the levels, which all that a scheme with few stages sees resembles: for
 * smooth functions they differ by O(k^2), for a blow that is shorter than the step by all of it.
 * The impulse is that on a mesh on which the function is proved to be resolved; where one of its
 * cells spans several steps, the difference is bounded by the second derivative instead:
 * |c_2| k^3 / 6 a step. */

static const double large_in_time = 0.05; /* of the impulse of the function's size */
enum { SEVERAL = 4 };                     /* steps in one cell */

struct missed {
    double impulse, size; /* that the levels do not see, and of |f|; both N s for a force */
    double worst, time;   /* the step that misses most, and its middle, s */
    bool unknown;         /* not all of it could be resolved */
};

/* A function of t on its way through the steps. */
struct passage {
    const struct br_function *f;
    struct br_box box; /* the place, and all times */
    double k;
    size_t n;       /* the step */
    double impulse; /* in it, so far */
    double weight;
    struct missed *missed;
};

static void miss(struct passage *p, double impulse, double time)
{
    p->missed->impulse += p->weight * impulse;
    if (p->weight * impulse > p->missed->worst) {
        p->missed->worst = p->weight * impulse;
        p->missed->time = time;
    }
}

static void end_step(struct passage *p)
{
    double before, after;
    br_function_evaluate(p->f, 1, &p->box.x.low, (double)p->n * p->k, &before);
    br_function_evaluate(p->f, 1, &p->box.x.low, (double)(p->n + 1) * p->k, &after);
    miss(p, fabs(p->impulse - p->k * (before + after) / 2), ((double)p->n + 0.5) * p->k);
    p->n++;
    p->impulse = 0;
}

/* Whole steps from the level n on in a cell. */
static void pass_steps(struct passage *p, size_t steps)
{
    const double from = (double)p->n * p->k, to = (double)(p->n + steps) * p->k;
    /* Inside of the cell: it ends where the function jumps, at one point, which has no impulse. */
    const struct br_box box = {p->box.x, {nextafter(from, to), nextafter(to, from)}};
    struct br_interval c[3], value = {0, 0};
    double most = INFINITY; /* a step */
    if (br_function_taylor(p->f, BR_T, box, 2, c))
        most = fmax(fabs(c[2].low), fabs(c[2].high)) * p->k * p->k * p->k / 6;
    if (br_function_bound(p->f, box, &value))
        most = fmin(most, (value.high - value.low) * p->k);
    miss(p, most, from + p->k / 2);
    p->missed->impulse += p->weight * most * (double)(steps - 1);
    p->n += steps;
}

static void pass_cell(struct passage *p, double from, double to)
{
    while (from < to) {
        const double level = (double)p->n * p->k, next = (double)(p->n + 1) * p->k;
        if (from <= level && to - level >= SEVERAL * p->k) {
            pass_steps(p, (size_t)((to - level) / p->k));
            from = (double)p->n * p->k;
            continue;
        }
        const struct br_interval piece = {from, fmin(next, to)};
        double value[PLACES];
        load_values(p->f, BR_T, p->box, piece, value);
        for (int i = 0; i < PLACES; i++)
            p->impulse += (piece.high - from) * load_weight[i] * value[i];
        if (piece.high >= next)
            end_step(p);
        from = piece.high;
    }
}

/* Adds what is missed of weight times a function with t. */
static enum br_status measure_times(const struct br_function *f, double weight,
                                    const struct br_planned_march *o, struct missed *m,
                                    struct br_error *err)
{
    const double duration = o->scene->duration;
    struct br_box box = {{0, o->scene->length}, {0, duration}}, peak = box;
    struct br_interval values;
    struct br_mesh mesh = {0};
    struct br_error failure;
    double size = 0;
    enum br_status status = BR_BAD_INPUT;
    if (!f->ops->bound)
        return BR_OK; /* of a solution that was given: nothing is proved of it */
    if (br_enclose_values(f, box, 0, &values, &peak)) {
        box.x = peak.x;
        status = load_mesh(f, BR_T, box, &mesh, &size, &failure);
    }
    struct passage p = {f, box, duration / (double)o->steps, 0, 0, weight, m};
    for (size_t i = 0; i < mesh.count; i++)
        pass_cell(&p, mesh.at[i], mesh.at[i + 1]);
    if (status == BR_BAD_INPUT) { /* without a mesh: one bound for all steps */
        pass_steps(&p, o->steps);
        size = fmax(fabs(values.low), fabs(values.high)) * duration / 4;
    }
    m->unknown |= status != BR_OK;
    m->size += weight * size;
    br_mesh_free(&mesh);
    return status == BR_NO_MEMORY ? br_fail(err, status, "%s", failure.message) : BR_OK;
}

static void report_times(const char *name, const struct missed *m, const struct br_planned_march *o,
                         struct br_warnings *w)
{
    const double k = o->scene->duration / (double)o->steps;
    const char *share = br_unseen(w, BR_WARN_LOAD_TIME, m->impulse, m->size, large_in_time);
    if (!share)
        return;
    if (!m->unknown)
        br_warn(w, BR_WARN_LOAD_TIME, "time steps that are shorter than what happens there",
                "%s does between the time levels what they do not see: with k = %.4g s %s of its "
                "impulse, most of it near t = %.4g s",
                name, k, share, m->time);
    else
        br_warn(w, BR_WARN_LOAD_TIME, "time steps that are shorter than what happens there",
                "%s changes so often that it is not known how much of it happens between the time "
                "levels, with k = %.4g s",
                name, k);
}

/* The terms of a load, each with the largest value of its other factor; one without t has an
 * impulse, too. */
static enum br_status measure_load(const struct br_load *load, const struct br_planned_march *o,
                                   struct missed *m, struct br_error *err)
{
    const struct br_box box = {{0, o->scene->length}, {0, o->scene->duration}};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        const struct br_product *p = &load->term[i];
        const struct br_function *changing = p->space.uses_t ? &p->space : &p->time,
                                 *other = p->space.uses_t ? &p->time : &p->space;
        struct br_interval values;
        struct br_box peak;
        if (br_product_is_zero(p) || !br_enclose_values(other, box, 0, &values, &peak))
            continue;
        const double weight = fmax(fabs(values.low), fabs(values.high));
        if (changing->uses_t)
            status = measure_times(changing, weight, o, m, err);
        else
            m->size += weight * fabs(changing->constant) * o->scene->duration;
    }
    return status;
}

static enum br_status look_at_times(const struct br_planned_march *o, struct br_warnings *w,
                                    struct br_error *err)
{
    const struct br_axial *a = &o->scene->axial;
    const struct br_bending *b = &o->scene->bending;
    const struct {
        const struct br_load *load; /* or */
        const struct br_function *force;
        const char *name;
        bool modelled;
    } rows[] = {
        {NULL, &a->tip_force, "the axial tip force", a->modelled},
        {NULL, &b->tip_force, "the bending tip force", b->modelled},
        {NULL, &b->tip_moment, "the tip moment", b->modelled},
        {&a->load, NULL, "the axial load", a->modelled},
        {&b->load, NULL, "the bending load", b->modelled},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && !status; i++) {
        struct missed m = {0};
        if (!rows[i].modelled)
            continue;
        if (rows[i].load)
            status = measure_load(rows[i].load, o, &m, err);
        else if (rows[i].force->uses_t)
            status = measure_times(rows[i].force, 1, o, &m, err);
        if (!status)
            report_times(rows[i].name, &m, o, w);
    }
    return status;
}

/* ---- loads inside of the elements ---- */

enum { TIMES = 5 }; /* at which a load with t is looked at, beside that of its peak */

static const double large_in_space = 0.02; /* of the load's size */

static struct br_field hats(const struct br_scene *scene, size_t n)
{
    struct br_scene axial = *scene;
    axial.axial.stiffness = axial.axial.viscosity = 1;
    return br_field_of_scene(&axial, BR_AXIAL, n, scene->duration);
}

/* A load whose exact vector is subtracted from that of the rule. */
struct exact {
    const struct br_function *f;
    struct br_box box;
    double h;
    double *vector;
};

/* Subtracts the hats' integrals over one piece of element e. */
static void subtract_piece(void *self, size_t e, struct br_interval piece)
{
    const struct exact *exact = self;
    double value[PLACES];
    load_values(exact->f, BR_X, exact->box, piece, value);
    for (int i = 0; i < PLACES; i++) {
        const double x = piece.low + (piece.high - piece.low) * load_place[i],
                     part = (piece.high - piece.low) * load_weight[i] * value[i],
                     right = x / exact->h - (double)e;
        exact->vector[e] -= (1 - right) * part;
        exact->vector[e + 1] -= right * part;
    }
}

/* A load that is looked at on its elements. */
struct sight {
    const struct br_scene *scene;
    struct br_field field;
    double *vector;      /* n + 1 */
    double missed, size; /* that the rule does not see, and of the load; summed over times, N */
    double worst, place; /* the node that misses most, m */
    bool known;          /* all could be resolved */
};

/* weight * f at one time */
static enum br_status compare(struct sight *s, const struct br_function *f, double weight, double t,
                              struct br_error *err)
{
    const struct br_box box = {{0, s->scene->length}, {t, t}};
    const size_t n = s->field.n;
    struct br_mesh mesh = {0};
    double size = 0;
    enum br_status status = br_assemble_load(&s->field, f, t, s->vector, err);
    if (!status)
        status = load_mesh(f, BR_X, box, &mesh, &size, err);
    s->known &= status != BR_BAD_INPUT;
    if (!status)
        for_each_piece(&mesh, box.x.high, n, subtract_piece,
                       &(struct exact){f, box, box.x.high / (double)n, s->vector});
    for (size_t i = 0; i <= n && !status; i++) {
        const double missed = weight * fabs(s->vector[i]);
        s->missed += missed;
        if (missed > s->worst) {
            s->worst = missed;
            s->place = s->scene->length * (double)i / (double)n;
        }
    }
    s->size += weight * size;
    br_mesh_free(&mesh);
    return status == BR_NO_MEMORY ? status : BR_OK; /* what is not finite, the march tells */
}

/* One term, at times inside of [0, T] and that of its peak or, where its shape does not change, at
 * one time. */
static enum br_status measure_shape(struct sight *s, const struct br_product *p,
                                    struct br_error *err)
{
    const double duration = s->scene->duration;
    const struct br_box box = {{0, s->scene->length}, {0, duration}};
    struct br_interval values;
    struct br_box peak;
    double weight = 0;
    if (p->space.ops && !p->space.ops->bound)
        return BR_OK; /* of a solution that was given: nothing is proved of it */
    if (br_enclose_values(&p->time, box, 0, &values, &peak))
        weight = fmax(fabs(values.low), fabs(values.high));
    if (!p->space.uses_t)
        return compare(s, &p->space, (TIMES + 1) * weight, 0, err);
    s->known &= br_enclose_values(&p->space, box, 0, &values, &peak);
    enum br_status status = compare(s, &p->space, weight, peak.t.low, err);
    for (int i = 0; i < TIMES && !status; i++)
        status = compare(s, &p->space, weight, duration * (i + 0.5) / TIMES, err);
    return status;
}

static void report_elements(const char *name, const struct sight *s, struct br_warnings *w)
{
    const double missed = s->known ? s->missed : INFINITY;
    const char *share = br_unseen(w, BR_WARN_LOAD_SPACE, missed, s->size, large_in_space);
    if (!s->known)
        br_warn(w, BR_WARN_LOAD_SPACE, "more elements, as short as what happens there",
                "%s changes so often in x that it is not known how much of it the elements' "
                "quadrature sees, with n = %zu",
                name, s->field.n);
    else if (share)
        br_warn(w, BR_WARN_LOAD_SPACE, "more elements, as short as what happens there",
                "%s does inside of elements what their quadrature does not see: with n = %zu %s "
                "of it, most of it near x = %.4g m",
                name, s->field.n, share, s->place);
}

static enum br_status look_at_shape(const struct br_load *load, const char *name,
                                    const struct br_planned_march *o, struct br_warnings *w,
                                    struct br_error *err)
{
    struct sight s = {.scene = o->scene, .field = hats(o->scene, o->n), .known = true};
    bool uses_x = false;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        uses_x |= !br_product_is_zero(&load->term[i]) && load->term[i].space.uses_x;
    if (!uses_x)
        return BR_OK;
    s.vector = br_allocate(o->n + 1, sizeof *s.vector);
    enum br_status status = s.vector ? BR_OK : br_no_memory(err, "a load vector");
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++)
        if (!br_product_is_zero(&load->term[i]))
            status = measure_shape(&s, &load->term[i], err);
    free(s.vector);
    if (!status)
        report_elements(name, &s, w);
    return status;
}

enum br_status br_look_at_elements(const struct br_planned_march *o, struct br_warnings *w,
                                   struct br_error *err)
{
    const struct br_scene *s = o->scene;
    enum br_status status = BR_OK;
    if (s->axial.modelled)
        status = look_at_shape(&s->axial.load, "the axial load", o, w, err);
    if (s->bending.modelled && !status)
        status = look_at_shape(&s->bending.load, "the bending load", o, w, err);
    return status;
}

/* ---- initial data between the nodes ---- */

/* Warns of initial data whose jumps and peaks lie between the nodes: what is interpolated there is
 * compared in L2 with the data, on a mesh on which they are proved to be resolved. */

static const double large_initial = 0.05; /* of the data's own norm */

/* Initial data on an element [from, from + h] at the nodes; slope NULL: linear. */
struct data {
    const struct br_function *value, *slope;
    const char *name;
    double length;
    size_t n;
    double square[2]; /* integrals: of what is missed, and of the data */
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

/* Adds the squares over one piece of element e. */
static void add_piece(void *self, size_t e, struct br_interval piece)
{
    struct data *d = self;
    const struct br_box box = {{0, d->length}, {0, 0}};
    const double width = piece.high - piece.low;
    double f[PLACES], value[2], slope[2];
    load_values(d->value, BR_X, box, piece, f);
    ends_of(d, e, value, slope);
    for (int i = 0; i < PLACES; i++) {
        const double x = piece.low + width * load_place[i],
                     s = x * (double)d->n / d->length - (double)e,
                     off = f[i] - interpolated(d, value, slope, s);
        d->square[0] += width * load_weight[i] * off * off;
        d->square[1] += width * load_weight[i] * f[i] * f[i];
    }
}

/* Both squares, on meshes that become finer until what is rough could not add to them. */
static enum br_status measure_data(struct data *d, struct br_error *err)
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
        d->square[0] = d->square[1] = 0;
        if (!status)
            for_each_piece(&mesh, d->length, d->n, add_piece, d);
        const double missed = mesh.missed;
        br_mesh_free(&mesh);
        if (status || missed * most <= rough * d->square[1])
            return status;
        aim.tolerance /= 16;
    }
    return most > 0 ? br_fail(err, BR_BAD_INPUT, "it cannot be resolved") : BR_OK;
}

static enum br_status look_at_data(struct data *d, struct br_warnings *w, struct br_error *err)
{
    if (!d->value->uses_x || (d->value->ops && !d->value->ops->bound))
        return BR_OK; /* of a solution that was given: nothing is proved of it */
    const enum br_status status = measure_data(d, err);
    if (status == BR_NO_MEMORY)
        return status;
    const double missed = status ? INFINITY : sqrt(d->square[0]);
    const char *share = br_unseen(w, BR_WARN_INITIAL, missed, sqrt(d->square[1]), large_initial);
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

static enum br_status look_at_initial(const struct br_planned_march *o, struct br_warnings *w,
                                      struct br_error *err)
{
    const struct br_axial *a = &o->scene->axial;
    const struct br_bending *b = &o->scene->bending;
    const double length = o->scene->length;
    struct data rows[] = {
        {&a->displacement, NULL, "the initial axial displacement", length, o->n, {0}},
        {&a->velocity, NULL, "the initial axial velocity", length, o->n, {0}},
        {&b->displacement, &b->displacement_slope, "the initial deflection", length, o->n, {0}},
        {&b->velocity, &b->velocity_slope, "the initial velocity of bending", length, o->n, {0}},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && !status; i++)
        if (i < 2 ? a->modelled : b->modelled)
            status = look_at_data(&rows[i], w, err);
    return status;
}

enum br_status br_look_at_loads(const struct br_planned_march *o, struct br_warnings *w,
                                struct br_error *err)
{
    const bool refused =
        look_at_times(o, w, err) || br_look_at_elements(o, w, err) || look_at_initial(o, w, err);
    return refused ? err->status : BR_OK;
}
