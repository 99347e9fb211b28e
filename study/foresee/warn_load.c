/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads that do something between the time levels.
 * Over each step the impulse of a function of time is compared with that of the straight line
 * between its values at the levels, which all that a scheme with few stages sees resembles: for
 * smooth functions they differ by O(k^2), for a blow that is shorter than the step by all of it.
 * The impulse is that on a mesh on which the function is proved to be resolved (load_mesh.h); where
 * one of its cells spans several steps, the difference is bounded by the second derivative instead:
 * |c_2| k^3 / 6 a step. */
#include <math.h>
#include <stdio.h>

#include "study/foresee/load_mesh.h"
#include "study/foresee/warnings.h"

static const double large = 0.05; /* of the impulse of the function's size */
enum { SEVERAL = 4 };             /* steps in one cell */

struct missed {
    double impulse, size; /* that the levels do not see, and of |f|; both N s for a force */
    double worst, time;   /* the step that misses most, and its middle, s */
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
        double value[BR_LOAD_PLACES];
        br_load_values(p->f, BR_T, p->box, piece, value);
        for (int i = 0; i < BR_LOAD_PLACES; i++)
            p->impulse += (piece.high - from) * br_load_weight[i] * value[i];
        if (piece.high >= next)
            end_step(p);
        from = piece.high;
    }
}

/* Of a function with t; *known: out, whether it could be resolved. */
static enum br_status measure(const struct br_function *f, double weight,
                              const struct br_planned_march *o, struct missed *m, bool *known,
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
        status = br_load_mesh(f, BR_T, box, &mesh, &size, &failure);
    }
    struct passage p = {f, box, duration / (double)o->steps, 0, 0, weight, m};
    for (size_t i = 0; i < mesh.count; i++)
        pass_cell(&p, mesh.at[i], mesh.at[i + 1]);
    if (status == BR_BAD_INPUT) { /* without a mesh: one bound for all steps */
        pass_steps(&p, o->steps);
        size = fmax(fabs(values.low), fabs(values.high)) * duration / 4;
    }
    *known = *known && !status;
    m->size += weight * size;
    br_mesh_free(&mesh);
    return status == BR_NO_MEMORY ? br_fail(err, status, "%s", failure.message) : BR_OK;
}

static void tell(const char *name, const struct missed *m, bool known,
                 const struct br_planned_march *o, struct br_warnings *w)
{
    const double k = o->scene->duration / (double)o->steps;
    const char *share = br_unseen(w, BR_WARN_LOAD_TIME, m->impulse, m->size, large);
    if (!share)
        return;
    if (known)
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

static enum br_status look_at(const struct br_function *f, const char *name,
                              const struct br_planned_march *o, struct br_warnings *w,
                              struct br_error *err)
{
    struct missed m = {0};
    bool known = true;
    const enum br_status status = f->uses_t ? measure(f, 1, o, &m, &known, err) : BR_OK;
    if (!status)
        tell(name, &m, known, o, w);
    return status;
}

/* The terms of a load, each with the largest value of its other factor; one without t has an
 * impulse, too. */
static enum br_status look_at_load(const struct br_load *load, const char *name,
                                   const struct br_planned_march *o, struct br_warnings *w,
                                   struct br_error *err)
{
    const struct br_box box = {{0, o->scene->length}, {0, o->scene->duration}};
    struct missed m = {0};
    bool known = true;
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
            status = measure(changing, weight, o, &m, &known, err);
        else
            m.size += weight * fabs(changing->constant) * o->scene->duration;
    }
    if (!status)
        tell(name, &m, known, o, w);
    return status;
}

static enum br_status look(const struct br_planned_march *o, struct br_warnings *w,
                           struct br_error *err)
{
    const struct br_axial *a = &o->scene->axial;
    const struct br_bending *b = &o->scene->bending;
    const struct {
        const struct br_function *function;
        const char *name;
        bool modelled;
    } rows[] = {
        {&a->tip_force, "the axial tip force", a->modelled},
        {&b->tip_force, "the bending tip force", b->modelled},
        {&b->tip_moment, "the tip moment", b->modelled},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && !status; i++)
        if (rows[i].modelled)
            status = look_at(rows[i].function, rows[i].name, o, w, err);
    if (a->modelled && !status)
        status = look_at_load(&a->load, "the axial load", o, w, err);
    if (b->modelled && !status)
        status = look_at_load(&b->load, "the bending load", o, w, err);
    return status;
}

const struct br_warning_source br_warn_load = {
    .title = "loads between the time levels",
    .look = look,
};
