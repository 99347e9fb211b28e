/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads that do something between the time levels. Over each step the impulse of a
 * function of time is compared with that of the straight line between its values at the levels,
 * which all that a scheme with few stages sees resembles: for smooth functions they differ by
 * O(k^2), for a blow that is shorter than the step by all of it. Of more than 50,000 steps 12,500
 * are looked at, all over the duration: there a load that changes within every step is told, a
 * single blow perhaps not. */
#include <math.h>
#include <stdio.h>

#include "study/warnings.h"

enum { MOST_SAMPLES = 100000, LEAST_SAMPLES = 8192, USUAL = 8, LEAST = 2 };

static const double somewhere = 0.618; /* of the length: where a function of x, too, is looked at */
static const double large = 0.05;      /* of the impulse of the function's size */

struct missed {
    double impulse, size; /* that the levels do not see, and of |f|; both N s for a force */
    double worst, time;   /* the step that misses most, and its middle, s */
};

/* Which steps are looked at, and by how many samples each. */
struct sampling {
    size_t steps, looked_at, parts;
};

static struct sampling sampling_of(size_t steps)
{
    if (steps > MOST_SAMPLES / LEAST)
        return (struct sampling){steps, MOST_SAMPLES / USUAL, USUAL};
    const size_t most = MOST_SAMPLES / steps, usual = LEAST_SAMPLES / steps + USUAL;
    return (struct sampling){steps, steps, most < usual ? most : usual};
}

/* The midpoint rule on the parts of each step that is looked at. */
static struct missed compare(const struct br_function *f, const struct br_scene *scene,
                             const struct sampling *s)
{
    struct missed m = {0};
    const double x = somewhere * scene->length, k = scene->duration / (double)s->steps,
                 weight = k / (double)s->parts;
    const double stride = (double)s->steps / (double)s->looked_at;
    double before, after, value;
    for (size_t j = 0; j < s->looked_at; j++) {
        const size_t n = (size_t)((double)j * stride) + 1;
        double impulse = 0;
        br_function_evaluate(f, 1, &x, (double)(n - 1) * k, &before);
        br_function_evaluate(f, 1, &x, (double)n * k, &after);
        for (size_t i = 0; i < s->parts; i++) {
            const double t = ((double)(n - 1) + ((double)i + 0.5) / (double)s->parts) * k;
            br_function_evaluate(f, 1, &x, t, &value);
            impulse += weight * value;
            m.size += weight * fabs(value);
        }
        const double miss = fabs(impulse - k * (before + after) / 2);
        m.impulse += miss;
        if (miss > m.worst) {
            m.worst = miss;
            m.time = ((double)n - 0.5) * k;
        }
    }
    return m;
}

static enum br_status look_at(const struct br_function *f, const char *name,
                              const struct br_outlook *o, struct br_warnings *w,
                              struct br_error *err)
{
    const double duration = o->scene->duration;
    struct br_function own;
    if (!f->uses_t)
        return BR_OK;
    const enum br_status status = br_function_clone(f, &own, err);
    if (status)
        return status;
    const struct sampling sampling = sampling_of(o->steps);
    const struct missed m = compare(&own, o->scene, &sampling);
    br_function_free(&own);
    if (!(m.impulse > large * m.size))
        return BR_OK;
    char remedy[100];
    snprintf(remedy, sizeof remedy, "time steps that are shorter than what happens there");
    br_warn(w, BR_WARN_LOAD_TIME, remedy,
            "%s does between the time levels what they do not see: with k = %.4g s %.2g %% of its "
            "impulse, most of it near t = %.4g s",
            name, duration / (double)o->steps, 100 * m.impulse / m.size, m.time);
    return BR_OK;
}

static enum br_status look_at_load(const struct br_load *load, const char *name,
                                   const struct br_outlook *o, struct br_warnings *w,
                                   struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        const struct br_product *p = &load->term[i];
        if (br_product_is_zero(p))
            continue;
        status = look_at(&p->time, name, o, w, err);
        if (!status)
            status = look_at(&p->space, name, o, w, err);
    }
    return status;
}

static enum br_status look(const struct br_outlook *o, struct br_warnings *w, struct br_error *err)
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
