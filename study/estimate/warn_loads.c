/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads and initial data that the time levels, elements or nodes miss. The discrete values
 * are compared with integrals on meshes that are proved to resolve the function, so that no feature
 * between the points is lost. */
#include "solver/scene.h"
#include "study/estimate/warnings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/words.h"
#include "solver/proof.h"
#include "study/grid/study.h"

/* A load or initial data: exactly one of load, force and data is set. */
struct input {
    const char *name;
    bool modelled;
    const struct br_load *load;
    const struct br_function *force, *data;
    const struct br_function *slope; /* of data; NULL: linear between the nodes */
};

/* What the discretisation misses of an input. */
struct loss {
    const struct br_planned_march *planned;
    const struct input *input;
    double missed, size;    /* impulses, forces, or squares of data */
    double worst, position; /* the step that misses most, and its middle, s; or the node's, m */
    double unresolved;      /* of the missed impulses, what no value at a level shows */
    double at_levels, jump; /* of them, what jumps on levels leave; the last large one, s */
    bool unknown;           /* not all of it could be resolved */
};

/* ---- meshes ---- */

/* Gauss's rule on [0, 1], exact for degree 9. */
enum { POINTS = 5 };
#define NEAR 0.26923465505284155 /* from 0.5: half of the zeros of Legendre's polynomial */
#define FAR 0.45308992296933200

static const double load_point[POINTS] = {0.5 - FAR, 0.5 - NEAR, 0.5, 0.5 + NEAR, 0.5 + FAR};
static const double load_weight[POINTS] = {0.11846344252809454, 0.23931433524968324, 64.0 / 225,
                                           0.23931433524968324, 0.11846344252809454};

/* The rule's points in a subinterval along one variable, its weights, and the values of f at the
 * points, where the other variable is at its lower end in a box. */
struct points {
    double at[POINTS], weight[POINTS], value[POINTS];
};

static struct points points_of(const struct br_function *f, enum br_variable along,
                               struct br_box box, struct br_interval subinterval)
{
    struct points p;
    for (int i = 0; i < POINTS; i++) {
        p.at[i] = subinterval.low + (subinterval.high - subinterval.low) * load_point[i];
        p.weight[i] = (subinterval.high - subinterval.low) * load_weight[i];
    }
    if (along == BR_X)
        br_function_evaluate(f, POINTS, p.at, box.t.low, p.value);
    for (int i = 0; i < POINTS && along == BR_T; i++)
        br_function_evaluate(f, 1, &box.x.low, p.at[i], &p.value[i]);
    return p;
}

static double integral_of_size(const struct br_function *f, enum br_variable along,
                               struct br_box box, const struct br_mesh *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->count; i++) {
        const struct points p =
            points_of(f, along, box, (struct br_interval){m->at[i], m->at[i + 1]});
        for (int k = 0; k < POINTS; k++)
            sum += p.weight[k] * fabs(p.value[k]);
    }
    return sum;
}

static struct br_box all_of(const struct br_scene *s)
{
    return (struct br_box){{0, s->length}, {0, s->duration}};
}

/* The largest size of a function in a box, and where; INFINITY: it cannot be bounded. */
static double largest(const struct br_function *f, struct br_box box, struct br_box *peak)
{
    struct br_interval values;
    *peak = box;
    return br_enclose_values(f, box, &values, peak) ? fmax(fabs(values.low), fabs(values.high))
                                                    : INFINITY;
}

/* Resolves f along one variable; the other is one point. *mesh (out) leaves at most 1 % of *size
 * unresolved, and rough cells have at most the share `rough` of *size; *size (out) is the integral
 * of |f|. Fails as br_resolve. */
static enum br_status load_mesh(const struct br_function *f, enum br_variable along,
                                struct br_box box, double rough, struct br_mesh *mesh, double *size,
                                struct br_error *err)
{
    enum { DEGREE = 8, ROUNDS = 6 };
    const struct br_interval all = along == BR_X ? box.x : box.t;
    struct br_box peak;
    enum br_status status = BR_OK;
    const double most = largest(f, box, &peak), width = all.high - all.low;
    *mesh = (struct br_mesh){0};
    if (!isfinite(most))
        return br_fail(err, BR_BAD_INPUT, "it cannot be bounded");
    struct br_mesh_aim aim = {.degree = DEGREE, .tolerance = 1e-3 * most};
    for (int i = 0; i < ROUNDS && !status; i++) {
        br_mesh_free(mesh);
        status = br_resolve(f, along, box, &aim, mesh, err);
        *size = status ? 0 : integral_of_size(f, along, box, mesh);
        if ((aim.tolerance * width <= 0.01 * *size && mesh->missed <= rough * *size) || most == 0)
            return status;
        aim.tolerance =
            fmin(fmax(0.5 * rough * *size / width, 1e-6 * aim.tolerance), aim.tolerance / 8);
    }
    if (!status)
        br_mesh_free(mesh);
    return status ? status : br_fail(err, BR_BAD_INPUT, "it cannot be resolved");
}

static const double usual_rough = 0.01, rough_data = 1e-4;

/* Functions that get the subintervals of a mesh's cells. The length is divided into equal parts,
 * which are steps or elements; each subinterval lies in one part. ends: the part ends with the
 * subinterval. If a cell contains several whole parts, take_several gets them in one call. */
struct walker {
    void (*take)(void *self, size_t part, struct br_interval subinterval, bool ends);
    void (*take_several)(void *self, size_t part, size_t count); /* NULL: none */
    void *self;
};

enum { SEVERAL = 16 };

/* The end of so many parts: as a march computes its levels, so that a jump lies on the same side.
 */
static double end_of(double length, size_t parts, size_t part)
{
    return part < parts ? length * (double)part / (double)parts : length;
}

static void walk(const struct br_mesh *mesh, double length, size_t parts, const struct walker *w)
{
    const double h = length / (double)parts;
    size_t part = 0;
    for (size_t i = 0; i < mesh->count; i++)
        for (double from = mesh->at[i], cell = mesh->at[i + 1]; from < cell;) {
            const double begin = end_of(length, parts, part), left = (cell - begin) / h;
            /* The first and the last part may touch a jump at an end of the cell. */
            if (w->take_several && from <= begin && begin - mesh->at[i] > h / 2 &&
                left >= SEVERAL) {
                const size_t count = (size_t)(left - 0.5);
                w->take_several(w->self, part, count);
                part += count;
                from = end_of(length, parts, part);
                continue;
            }
            const double end = end_of(length, parts, part + 1), to = fmin(end, cell);
            if (to > from)
                w->take(w->self, part, (struct br_interval){from, to}, to >= end);
            part += to >= end && part + 1 < parts;
            from = to;
        }
}

/* Whether f comes from a given solution: such a function has no bounds. */
static bool is_given(const struct br_function *f)
{
    return f->ops && !f->ops->bound;
}

/* ---- loads between the time levels ---- */

/* Over each step the impulse of a function of time is compared with that of the straight line
 * between its values at the levels, which is close to what a scheme with few stages uses. For
 * smooth functions they differ by O(k^2), for a blow shorter than the step by the whole impulse.
 * Where it jumps, a scheme with one stage uses the value at the end alone. A scheme that chooses
 * its steps finds what the levels show: only what lies beyond their two values may escape it, and
 * that is `unresolved`. The exact impulse is integrated on a mesh that is proved to resolve the
 * function; where one of its cells spans several steps, the difference is bounded by the second
 * derivative: |c_2| k^3 / 6 a step. */

/* The state of the comparison for one function of t. */
struct passage {
    const struct br_function *f;
    struct br_box box; /* one position, and all times */
    double k, weight, most;
    double impulse; /* in this step, so far */
    bool jumps;     /* in it, or at its start */
    struct loss *loss;
    const struct br_mesh *mesh; /* of f: it jumps at a node, if at all */
    size_t node;                /* the last one that was looked at */
};

static void miss(struct loss *s, double missed, double position)
{
    s->missed += missed;
    if (missed > s->worst) {
        s->worst = missed;
        s->position = position;
    }
}

/* Whether f jumps within round-off of a time. A front that passes there at that time passes a
 * neighbour at another one. */
static bool jumps_at(struct passage *p, double t)
{
    static const double round_off = 2e-15, aside = 1e-6, small = 0.01;
    const struct br_interval all = p->box.t;
    const struct br_scene *scene = p->loss->planned->scene;
    const double close = round_off * all.high, here = p->box.x.low, away = aside * scene->length;
    const double *at = p->mesh->at;
    while (p->node > 0 && at[p->node - 1] >= t - close)
        p->node--;
    while (p->node < p->mesh->count && at[p->node] < t - close)
        p->node++;
    if (!(at[p->node] <= t + close))
        return false;
    const double x[2] = {here, here + (here > away ? -away : away)};
    double before[2], after[2];
    br_function_evaluate(p->f, 2, x, fmax(t - close, all.low), before);
    br_function_evaluate(p->f, 2, x, fmin(t + close, all.high), after);
    return fmin(fabs(after[0] - before[0]), fabs(after[1] - before[1])) > small * p->most;
}

static double value_at(const struct passage *p, double t)
{
    return br_function_at(p->f, p->box.x.low, t);
}

/* What of an impulse lies beyond those of the values at both ends. NaN stays NaN. */
static double lost_of(double impulse, const double end[2])
{
    const double above = impulse - fmax(end[0], end[1]), below = fmin(end[0], end[1]) - impulse;
    return above <= 0 && below <= 0 ? 0 : above > below ? above : below;
}

static double missed_of(const struct passage *p, const double end[2], bool jumps)
{
    const bool one = br_time_scheme_stages(p->loss->planned->method->scheme) == 1;
    return fabs(p->impulse - (jumps && one ? end[1] : (end[0] + end[1]) / 2));
}

static void pass_subinterval(void *self, size_t step, struct br_interval subinterval, bool ends)
{
    struct passage *p = self;
    struct loss *s = p->loss;
    const struct br_planned_march *o = s->planned;
    const struct points points = points_of(p->f, BR_T, p->box, subinterval);
    for (int i = 0; i < POINTS; i++)
        p->impulse += points.weight[i] * points.value[i];
    p->jumps |= jumps_at(p, subinterval.low);
    if (!ends)
        return;
    const double from = end_of(p->box.t.high, o->steps, step),
                 to = end_of(p->box.t.high, o->steps, step + 1);
    const double end[2] = {p->k * value_at(p, from), p->k * value_at(p, to)};
    const bool on_level[2] = {jumps_at(p, from), jumps_at(p, to)};
    const double unresolved = lost_of(p->impulse, end);
    const double missed =
        o->method->scheme->adaptive ? unresolved : missed_of(p, end, p->jumps || on_level[1]);
    if ((on_level[0] || on_level[1]) && p->weight * missed >= s->worst)
        s->jump = on_level[1] ? to : from;
    s->at_levels += on_level[0] || on_level[1] ? p->weight * missed : 0;
    s->unresolved += p->weight * unresolved;
    miss(s, p->weight * missed, ((double)step + 0.5) * p->k);
    p->impulse = 0;
    p->jumps = false;
}

static void pass_steps(void *self, size_t step, size_t count)
{
    struct passage *p = self;
    const double from = (double)step * p->k, to = (double)(step + count) * p->k;
    const struct br_box box = {p->box.x, {from, to}};
    struct br_interval c[3], value = {0, 0};
    double most = INFINITY; /* a step */
    if (br_function_taylor(p->f, BR_T, box, 2, c))
        most = fmax(fabs(c[2].low), fabs(c[2].high)) * p->k * p->k * p->k / 6;
    if (br_function_bound(p->f, box, &value))
        most = fmin(most, (value.high - value.low) * p->k);
    miss(p->loss, p->weight * most, from + p->k / 2);
    p->loss->missed += p->weight * most * (double)(count - 1);
    p->loss->unresolved += p->weight * most * (double)count;
}

/* Adds the missed impulse of weight times a function of t. */
static enum br_status measure_times(const struct br_function *f, double weight, struct loss *s,
                                    struct br_error *err)
{
    const struct br_planned_march *o = s->planned;
    const double duration = o->scene->duration;
    struct br_mesh mesh = {0};
    struct br_box peak;
    struct br_error failure;
    double size = 0;
    enum br_status status = BR_BAD_INPUT;
    if (is_given(f))
        return BR_OK;
    const double most = largest(f, all_of(o->scene), &peak);
    struct passage p = {.f = f,
                        .box = all_of(o->scene),
                        .k = duration / (double)o->steps,
                        .weight = weight,
                        .most = most,
                        .loss = s,
                        .mesh = &mesh};
    if (isfinite(most)) {
        p.box.x = peak.x;
        status = load_mesh(f, BR_T, p.box, usual_rough, &mesh, &size, &failure);
    }
    walk(&mesh, duration, o->steps, &(struct walker){pass_subinterval, pass_steps, &p});
    if (status == BR_BAD_INPUT) { /* without a mesh: one bound for all steps */
        pass_steps(&p, 0, o->steps);
        size = most * duration / 4;
    }
    s->unknown |= status != BR_OK;
    s->size += weight * size;
    br_mesh_free(&mesh);
    return status == BR_NO_MEMORY ? br_fail(err, status, "%s", failure.message) : BR_OK;
}

/* The terms of a load, each with the largest value of its other factor; one without t has an
 * impulse, too. */
static enum br_status check_times(struct loss *s, struct br_error *err)
{
    const struct input *input = s->input;
    const struct br_scene *scene = s->planned->scene;
    enum br_status status = BR_OK;
    if (input->force && input->force->uses_t)
        status = measure_times(input->force, 1, s, err);
    for (size_t i = 0; input->load && i < BR_LOAD_TERMS && !status; i++) {
        const struct br_product *p = &input->load->term[i];
        const struct br_function *changing = p->space.uses_t ? &p->space : &p->time,
                                 *other = p->space.uses_t ? &p->time : &p->space;
        struct br_box peak;
        const double weight =
            br_product_is_zero(p) ? INFINITY : largest(other, all_of(scene), &peak);
        if (!isfinite(weight))
            continue;
        if (changing->uses_t)
            status = measure_times(changing, weight, s, err);
        else
            s->size += weight * fabs(changing->constant) * scene->duration;
    }
    return status;
}

/* ---- loads inside of the elements ---- */

/* The load vector of hat functions, by the quadrature of the march, is compared with the exact
 * integrals. */

enum { TIMES = 5 }; /* at which a load with t is sampled, beside that of its peak */

/* A load whose exact vector is subtracted from that of the rule. */
struct exact {
    const struct br_function *f;
    struct br_box box;
    double h;
    double *vector; /* n + 1 */
};

/* Subtracts the hats' integrals over one subinterval of an element. */
static void subtract_subinterval(void *self, size_t e, struct br_interval subinterval, bool ends)
{
    const struct exact *exact = self;
    const struct points p = points_of(exact->f, BR_X, exact->box, subinterval);
    (void)ends;
    for (int i = 0; i < POINTS; i++) {
        const double part = p.weight[i] * p.value[i], right = p.at[i] / exact->h - (double)e;
        exact->vector[e] -= (1 - right) * part;
        exact->vector[e + 1] -= right * part;
    }
}

/* Adds what the quadrature misses of weight * f at one time. */
static enum br_status compare(struct loss *s, const struct br_function *f, double weight, double t,
                              struct br_error *err)
{
    const size_t n = s->planned->n;
    const double length = s->planned->scene->length;
    struct br_scene rod = *s->planned->scene;
    rod.axial.stiffness = rod.axial.viscosity = 1;
    const struct br_field hats = br_field_of_scene(&rod, BR_AXIAL, n, rod.duration, 1);
    struct exact exact = {
        f, {{0, length}, {t, t}}, length / (double)n, br_allocate(n + 1, sizeof(double))};
    struct br_mesh mesh = {0};
    double size = 0;
    enum br_status status = exact.vector ? br_assemble_load(&hats, f, t, exact.vector, err)
                                         : br_no_memory(err, "a load vector");
    if (!status)
        status = load_mesh(f, BR_X, exact.box, usual_rough, &mesh, &size, err);
    s->unknown |= status == BR_BAD_INPUT;
    if (!status)
        walk(&mesh, length, n, &(struct walker){subtract_subinterval, NULL, &exact});
    for (size_t i = 0; i <= n && !status; i++)
        miss(s, weight * fabs(exact.vector[i]), length * (double)i / (double)n);
    s->size += weight * size;
    br_mesh_free(&mesh);
    free(exact.vector);
    return status == BR_NO_MEMORY ? status
                                  : BR_OK; /* the march reports a load that is not finite */
}

/* One term, at times inside of [0, T] and that of its peak or, where its shape does not change, at
 * one time. */
static enum br_status measure_shape(struct loss *s, const struct br_product *p,
                                    struct br_error *err)
{
    const struct br_scene *scene = s->planned->scene;
    struct br_box peak;
    if (br_product_is_zero(p) || is_given(&p->space))
        return BR_OK;
    const double most = largest(&p->time, all_of(scene), &peak), weight = isfinite(most) ? most : 0;
    if (!p->space.uses_t)
        return compare(s, &p->space, (TIMES + 1) * weight, 0, err);
    s->unknown |= !isfinite(largest(&p->space, all_of(scene), &peak));
    enum br_status status = compare(s, &p->space, weight, peak.t.low, err);
    for (int i = 0; i < TIMES && !status; i++)
        status = compare(s, &p->space, weight, scene->duration * (i + 0.5) / TIMES, err);
    return status;
}

static enum br_status check_elements(struct loss *s, struct br_error *err)
{
    const struct br_load *load = s->input->load;
    bool uses_x = false;
    for (size_t i = 0; load && i < BR_LOAD_TERMS; i++)
        uses_x |= !br_product_is_zero(&load->term[i]) && load->term[i].space.uses_x;
    enum br_status status = BR_OK;
    for (size_t i = 0; uses_x && i < BR_LOAD_TERMS && !status; i++)
        status = measure_shape(s, &load->term[i], err);
    s->missed = s->unknown ? INFINITY : s->missed;
    return status;
}

/* ---- initial data between the nodes ---- */

/* The interpolation from the nodes is compared with the data in L2. */

static double at(const struct br_function *f, double x)
{
    double value;
    br_function_evaluate(f, 1, &x, 0, &value);
    return value;
}

/* Adds the squares of the difference and of the data over one subinterval of an element. */
static void add_subinterval(void *self, size_t e, struct br_interval subinterval, bool ends)
{
    struct loss *loss = self;
    const struct input *d = loss->input;
    const double length = loss->planned->scene->length, n = (double)loss->planned->n;
    const double h = length / n,
                 end[2] = {(double)e * h, (double)e + 1 < n ? (double)(e + 1) * h : length};
    const struct points p =
        points_of(d->data, BR_X, (struct br_box){{0, length}, {0, 0}}, subinterval);
    double value[2], slope[2];
    (void)ends;
    for (int i = 0; i < 2; i++) {
        value[i] = at(d->data, end[i]);
        slope[i] = d->slope ? h * at(d->slope, end[i]) : 0;
    }
    for (int i = 0; i < POINTS; i++) {
        const double s = p.at[i] / h - (double)e, r = 1 - s;
        const double line = r * value[0] + s * value[1];
        const double cubic = r * r * (1 + 2 * s) * value[0] + s * s * (1 + 2 * r) * value[1] +
                             r * s * (r * slope[0] - s * slope[1]);
        const double off = p.value[i] - (d->slope ? cubic : line);
        loss->missed += p.weight[i] * off * off;
        loss->size += p.weight[i] * p.value[i] * p.value[i];
    }
}

static enum br_status check_nodes(struct loss *s, struct br_error *err)
{
    const struct br_function *f = s->input->data;
    const double length = s->planned->scene->length;
    struct br_mesh mesh = {0};
    double size;
    if (!f || !f->uses_x || is_given(f))
        return BR_OK;
    const enum br_status status =
        load_mesh(f, BR_X, (struct br_box){{0, length}, {0, 0}}, rough_data, &mesh, &size, err);
    walk(&mesh, length, s->planned->n, &(struct walker){add_subinterval, NULL, s});
    br_mesh_free(&mesh);
    s->unknown = status != BR_OK;
    s->missed = status ? INFINITY : sqrt(s->missed);
    s->size = sqrt(s->size);
    return status == BR_NO_MEMORY ? status : BR_OK;
}

/* ---- all of them ---- */

/* The checks, and the words of their warnings. */
static const struct check {
    enum br_warning_kind kind;
    enum br_status (*measure)(struct loss *s, struct br_error *err);
    double large; /* a larger missed share is warned of */
    const char *not_seen, *part, *changes, *not_known, *remedy;
    bool in_time;
} checks[] = {
    {BR_WARN_LOAD_TIME, check_times, 0.05, "changes faster than the time steps resolve",
     "its impulse", "", "of the time steps", "time steps short enough to resolve it", true},
    {BR_WARN_LOAD_SPACE, check_elements, 0.02,
     "changes faster in x than the quadrature of the elements resolves", "it", " in x",
     "of the elements' quadrature", "elements short enough to resolve it", false},
    {BR_WARN_INITIAL, check_nodes, 0.05, "changes faster in x than the elements resolve",
     "its norm", "", "of the elements", "elements short enough to resolve it", false},
};

/* A jump on a level is warned of from this share on: it takes no shorter steps to mend it. */
static const double large_jump = 0.01;

/* The fewest steps, more than now, of which one has a time about in its middle. */
static size_t steps_around(const struct br_planned_march *o, double t)
{
    for (size_t steps = o->steps + 1;; steps++) {
        const double levels = t / o->scene->duration * (double)steps;
        if (fabs(levels - floor(levels) - 0.5) <= 0.25 || steps > 4 * o->steps)
            return steps;
    }
}

/* of: the share of the impulse that is missed, and where. */
static void report_jump(const struct loss *s, const char *of, struct br_warnings *w)
{
    const struct br_planned_march *o = s->planned;
    char remedy[400] = "", at[40];
    snprintf(at, sizeof at, "%.10g", s->jump);
    if (br_time_scheme_stages(o->method->scheme) == 1 && strtod(at, NULL) >= s->jump)
        br_append(
            remedy, sizeof remedy,
            "a load with its value of before at t = %s s: (t > %s) or (t <= %s), not step(t - %s)\n",
            at, at, at, at);
    br_append(remedy, sizeof remedy, "--k T/%zu  # no time level on the jump",
              steps_around(o, s->jump));
    br_warn(
        w, BR_WARN_LOAD_TIME, remedy,
        "%s jumps at t = %s s, on a time level, and its value there (step(0) is 1) counts for a "
        "whole step: with k = %.4g s the error is %s",
        s->input->name, at, br_time_step(o->scene, o->steps), of);
}

static double share_of(const struct loss *s, double missed)
{
    const double share = missed / s->size;
    return missed == 0 ? 0 : isnan(share) ? INFINITY : share;
}

static void report(const struct loss *s, const struct check *check, struct br_warnings *w)
{
    const struct br_planned_march *o = s->planned;
    const double share = share_of(s, s->missed);
    char all[16], with[40], of[100];
    const bool jumps = s->at_levels > large_jump * s->size && 2 * s->at_levels > s->missed;
    w->unresolved[check->kind] =
        fmax(w->unresolved[check->kind], check->in_time ? share_of(s, s->unresolved) : share);
    if (share <= check->large && !jumps)
        return;
    if (share <= 0.995)
        snprintf(all, sizeof all, "%.2g %%", 100 * share);
    else
        snprintf(all, sizeof all, "%s", share > 1.005 ? "more than all" : "all");
    if (check->in_time)
        snprintf(with, sizeof with, "k = %.4g s", br_time_step(o->scene, o->steps));
    else
        snprintf(with, sizeof with, "n = %zu", o->n);
    snprintf(of, sizeof of, "%s of %s", all, check->part);
    if (check->kind != BR_WARN_INITIAL)
        br_append(of, sizeof of, ", most of it near %s = %.4g %s", check->in_time ? "t" : "x",
                  s->position, check->in_time ? "s" : "m");
    if (s->unknown)
        br_warn(w, check->kind, check->remedy,
                "%s changes so often%s that the error %s, with %s, is not known", s->input->name,
                check->changes, check->not_known, with);
    else if (jumps)
        report_jump(s, of, w);
    else
        br_warn(w, check->kind, check->remedy, "%s %s: with %s the error is %s", s->input->name,
                check->not_seen, with, of);
}

enum br_status br_check_loads(const struct br_planned_march *o, struct br_warnings *w,
                              struct br_error *err)
{
    const struct br_scene_field *a = &o->scene->axial;
    const struct br_scene_field *b = &o->scene->bending;
    const bool rod = a->modelled, beam = b->modelled;
    const struct input inputs[] = {
        {"the axial tip force", rod, .force = &a->tip_force},
        {"the bending tip force", beam, .force = &b->tip_force},
        {"the tip moment", beam, .force = &b->tip_moment},
        {"the axial load", rod, .load = &a->load},
        {"the bending load", beam, .load = &b->load},
        {"the initial axial displacement", rod, .data = &a->displacement},
        {"the initial axial velocity", rod, .data = &a->velocity},
        {"the initial deflection", beam, .data = &b->displacement, .slope = &b->displacement_slope},
        {"the initial velocity of bending", beam, .data = &b->velocity,
         .slope = &b->velocity_slope},
    };
    enum br_status status = BR_OK;
    for (const struct check *check = checks; check < checks + sizeof checks / sizeof *checks;
         check++)
        for (size_t i = 0; i < sizeof inputs / sizeof *inputs && !status; i++) {
            struct loss s = {.planned = o, .input = &inputs[i]};
            if (!inputs[i].modelled)
                continue;
            status = check->measure(&s, err);
            if (!status)
                report(&s, check, w);
        }
    return status;
}
