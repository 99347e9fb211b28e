/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads that do something between the time levels. Over each step the impulse of a
 * function of time is compared with that of the straight line between its values at the levels,
 * which all that a scheme with few stages sees resembles: for smooth functions they differ by
 * O(k^2), for a blow that is shorter than the step by all of it. */
#include <math.h>
#include <stdio.h>

#include "study/warnings.h"

enum { MOST_SAMPLES = 100000, LEAST_SAMPLES = 8192, LEAST_A_STEP = 8 };

static const double somewhere = 0.618; /* of the length: where a function of x, too, is looked at */
static const double large = 0.05;      /* of the impulse of the function's size */

struct missed {
    double impulse, size; /* that the levels do not see, and of |f|; both N s for a force */
    double worst, time;   /* the step that misses most, and its middle, s */
};

/* The midpoint rule on `parts` parts of each step. */
static struct missed compare(const struct br_function *f, const struct br_scene *scene,
                             size_t steps, size_t parts)
{
    struct missed m = {0};
    const double x = somewhere * scene->length, k = scene->duration / (double)steps,
                 weight = k / (double)parts;
    double before, after, value;
    br_function_evaluate(f, 1, &x, 0, &before);
    for (size_t n = 1; n <= steps; n++, before = after) {
        double impulse = 0;
        br_function_evaluate(f, 1, &x, (double)n * k, &after);
        for (size_t i = 0; i < parts; i++) {
            const double t = ((double)(n - 1) + ((double)i + 0.5) / (double)parts) * k;
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
    if (!f->uses_t || o->steps > MOST_SAMPLES / LEAST_A_STEP)
        return BR_OK;
    const enum br_status status = br_function_clone(f, &own, err);
    if (status)
        return status;
    const size_t parts = LEAST_SAMPLES / o->steps + LEAST_A_STEP;
    const struct missed m = compare(&own, o->scene, o->steps, parts);
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

static enum br_status look(const struct br_outlook *o, struct br_warnings *w, struct br_error *err)
{
    const struct br_axial *a = &o->scene->axial;
    const struct br_bending *b = &o->scene->bending;
    const struct {
        const struct br_function *function;
        const char *name;
        bool modelled;
    } rows[] = {
        {&a->load.time, "the axial load", a->modelled},
        {&a->load.space, "the axial load", a->modelled},
        {&a->tip_force, "the axial tip force", a->modelled},
        {&b->load.time, "the bending load", b->modelled},
        {&b->load.space, "the bending load", b->modelled},
        {&b->tip_force, "the bending tip force", b->modelled},
        {&b->tip_moment, "the tip moment", b->modelled},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && !status; i++)
        if (rows[i].modelled)
            status = look_at(rows[i].function, rows[i].name, o, w, err);
    return status;
}

const struct br_warning_source br_warn_load = {
    .title = "loads between the time levels",
    .look = look,
};
