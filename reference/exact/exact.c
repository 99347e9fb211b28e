/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/exact.h"

#include <gsl/gsl_errno.h>
#include <math.h>

#include "reference/exact/solution.h"

enum { FIRST_MODES = 12, LEAST_MODES = 18 };

static struct br_exact_options with_defaults(const struct br_exact_options *options)
{
    struct br_exact_options o = options ? *options : (struct br_exact_options){0};
    o.tolerance = o.tolerance != 0 ? o.tolerance : 1e-10;
    o.acceptable = o.acceptable != 0 ? o.acceptable : o.tolerance;
    o.rate_tolerance = o.rate_tolerance != 0 ? o.rate_tolerance : 10 * o.tolerance;
    o.max_modes = o.max_modes ? o.max_modes : 256;
    o.max_steps = o.max_steps ? o.max_steps : 20000;
    return o;
}

static enum br_status check(const struct br_scene *scene, const struct br_exact_options *o,
                            struct br_error *err)
{
    if (!(o->tolerance >= 2e-11 && o->tolerance <= 1e-3))
        return br_fail(err, BR_BAD_INPUT, "the tolerance is %g, expected 2e-11 to 1e-3",
                       o->tolerance);
    if (!(o->acceptable >= o->tolerance && o->acceptable <= 1e-3))
        return br_fail(err, BR_BAD_INPUT, "the acceptable tolerance is %g, expected %g to 1e-3",
                       o->acceptable, o->tolerance);
    if (!(o->rate_tolerance >= 10 * o->tolerance && o->rate_tolerance <= 1))
        return br_fail(err, BR_BAD_INPUT, "the rate tolerance is %g, expected %g to 1",
                       o->rate_tolerance, 10 * o->tolerance);
    if (o->max_modes < LEAST_MODES || o->max_modes > 1000)
        return br_fail(err, BR_BAD_INPUT, "at most %zu modes are allowed, expected %d to 1000",
                       o->max_modes, LEAST_MODES);
    const enum br_status status = br_scene_check(scene, err);
    if (status)
        return status;
    const bool still = (scene->axial.modelled && !(scene->axial.viscosity > 0)) ||
                       (scene->bending.modelled && !(scene->bending.viscosity > 0));
    if (still && !(scene->density > 0))
        return br_fail(err, BR_BAD_INPUT,
                       "without density and viscosity the velocity is not "
                       "determined, expected at least one of them");
    return BR_OK;
}

/* Every second solution has finer steps, so that any two that follow each other
 * differ in time as well as in space. */
static struct br_fineness fineness(const struct br_exact_options *o, double duration, size_t round,
                                   size_t modes)
{
    const bool finer = round % 2;
    return (struct br_fineness){
        .modes = modes,
        .max_steps = o->max_steps,
        .stop = o->stop,
        .stop_self = o->stop_self,
        .tolerance = o->tolerance * (finer ? 0.1 : 0.4),
        .first_step = duration * (finer ? 2e-13 : 1e-12),
    };
}

/* The largest error over what is allowed; 0 / 0 counts as 0 */
static double badness(const struct br_exact *exact, const struct br_exact_options *o)
{
    double worst = 0;
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++) {
        const struct br_exact_size *e = &exact->report[i].error, *l = &exact->report[i].largest;
        const double error[] = {e->displacement, e->velocity, e->force};
        const double allowed[] = {
            o->tolerance * l->displacement + exact->noise[i] * exact->duration,
            o->rate_tolerance * l->velocity + exact->noise[i], o->rate_tolerance * l->force};
        for (size_t j = 0; j < 3; j++)
            if (error[j] != 0 && !(error[j] / allowed[j] <= worst))
                worst = error[j] / allowed[j];
    }
    return worst;
}

static enum br_status refuse(const struct br_exact *exact, double worst,
                             const struct br_error *cause, struct br_error *err)
{
    if (cause->status)
        return br_fail(err, BR_NOT_FINITE, "no exact solution: %s", cause->message);
    if (isinf(worst))
        return br_fail(err, BR_NOT_FINITE,
                       "no exact solution: the events still change with the number of modes");
    return br_fail(err, BR_NOT_FINITE,
                   "no exact solution: with %zu axial and %zu bending modes the error estimate is "
                   "%.2g times what is allowed",
                   exact->report[0].modes, exact->report[1].modes, worst);
}

/* The next solution, and how far it is from the last one: *worst, infinite where
 * that cannot be said because of `cause`. */
static enum br_status next_round(struct br_exact *exact, struct br_solution **before,
                                 const struct br_scene *scene, const struct br_fineness *fine,
                                 struct br_error *cause)
{
    br_solution_free(*before);
    *before = exact->solution;
    *cause = (struct br_error){0};
    const enum br_status status = br_solution_create(&exact->solution, scene, fine, cause);
    if (!status && *before)
        return br_exact_compare(exact, *before, cause);
    return status == BR_NOT_FINITE ? BR_OK : status; /* more modes may help */
}

/* Makes solutions with more and more modes until two agree. */
static enum br_status refine(struct br_exact *exact, const struct br_scene *scene,
                             const struct br_exact_options *o, struct br_error *err)
{
    struct br_solution *before = NULL;
    struct br_error cause;
    double worst = INFINITY;
    enum br_status status = BR_OK;
    size_t modes = FIRST_MODES;
    for (size_t round = 0; !status && !(worst <= 1); round++) {
        const struct br_fineness fine = fineness(o, exact->duration, round, modes);
        status = next_round(exact, &before, scene, &fine, &cause);
        worst = before && exact->solution ? badness(exact, o) : INFINITY;
        if (status)
            br_fail(err, status, "%s", cause.message);
        else if (modes == o->max_modes && worst <= o->acceptable / o->tolerance)
            break;
        else if (modes == o->max_modes && !(worst <= 1))
            status = refuse(exact, worst, &cause, err);
        modes = modes * 3 / 2 < o->max_modes ? modes * 3 / 2 : o->max_modes;
    }
    if (!status)
        status = br_exact_list_events(exact, before, err);
    br_solution_free(before);
    return status;
}

enum br_status br_exact_create(struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err)
{
    *out = NULL;
    const struct br_exact_options o = with_defaults(options);
    enum br_status status = check(scene, &o, err);
    if (status)
        return status;
    struct br_exact *exact = br_allocate(1, sizeof *exact);
    if (!exact)
        return br_no_memory(err, "the exact solution");
    gsl_set_error_handler_off(); /* it would end the program */
    exact->duration = scene->duration;
    status = refine(exact, scene, &o, err);
    if (status)
        br_exact_free(exact);
    else
        *out = exact;
    return status;
}

void br_exact_free(struct br_exact *exact)
{
    if (!exact)
        return;
    br_solution_free(exact->solution);
    free(exact->event);
    free(exact);
}
