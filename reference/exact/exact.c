/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/exact.h"

#include <gsl/gsl_errno.h>
#include <math.h>

#include "reference/exact/solution.h"

/* How finely a solution is to be made. */
struct fineness {
    size_t modes;
    double tolerance, first_step; /* see br_march_options */
};

enum { FIRST_MODES = 12, LEAST_MODES = 18 };

/* Some 20 seconds of a core, see br_effort. */
static const double most_work = 1.4e7;

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
static struct fineness fineness_of(const struct br_exact_options *o, double duration, size_t round,
                                   size_t modes)
{
    const bool finer = round % 2;
    return (struct fineness){
        .modes = modes,
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

static void scale_size(struct br_exact_size *size, double factor)
{
    size->displacement *= factor;
    size->velocity *= factor;
    size->force *= factor;
    size->strain_rate *= factor;
}

/* size += share * of */
static void add_to_size(struct br_exact_size *size, double share, const struct br_exact_size *of)
{
    size->displacement += share * of->displacement;
    size->velocity += share * of->velocity;
    size->force += share * of->force;
    size->strain_rate += share * of->strain_rate;
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

/* The search for two solutions that agree. */
struct search {
    struct br_exact *exact;
    const struct br_scene *scene;
    const struct br_exact_options *o;
    struct br_outline outline[BR_EXACT_FIELDS];
    struct br_effort effort;
    struct br_exact_solution *before;
    double missed;              /* the largest of the outlines */
    double worst, worst_before; /* of the last two pairs, infinite where that cannot be said */
    struct br_error cause;      /* why not */
};

/* ---- one solution ---- */

static struct br_law axial_law(const struct br_scene *scene)
{
    return (struct br_law){
        .contact = true,
        .obstacle = scene->contact.modelled,
        .stiffness = scene->contact.modelled ? scene->contact.stiffness : 0,
    };
}

static struct br_law bending_law(const struct br_scene *scene, const struct br_history *axial)
{
    return (struct br_law){
        .friction = scene->friction.law,
        .coefficient = scene->friction.coefficient,
        .axial = scene->friction.law == BR_COULOMB ? axial : NULL,
    };
}

static void solution_free(struct br_exact_solution *s)
{
    if (!s)
        return;
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++)
        br_history_free(s->track[i]);
    br_store_clear(&s->store);
    free(s);
}

static size_t count_modes(const struct search *s, size_t which, size_t modes)
{
    size_t count = 0;
    for (size_t e = 0; e + 1 < s->outline[which].end.count; e++)
        count += br_outline_terms(&s->outline[which], e, modes);
    return count;
}

/* One field; a singular value decomposition is most of what its modes cost. */
static enum br_status solve(struct search *s, enum br_exact_field which,
                            const struct fineness *fine, struct br_exact_solution *into)
{
    const bool axial = which == BR_EXACT_AXIAL;
    const struct br_scene *scene = s->scene;
    const struct br_outline *outline = &s->outline[which];
    struct br_law *law = &into->law[which];
    *law = axial ? axial_law(scene) : bending_law(scene, into->track[BR_EXACT_AXIAL]);
    const struct br_march_options options = {
        .duration = scene->duration,
        .gap = axial && scene->contact.modelled ? scene->contact.gap : 0,
        .tolerance = fine->tolerance,
        .first_step = fine->first_step,
        .max_steps = s->o->max_steps,
        .outline = {outline, law->axial ? &s->outline[BR_EXACT_AXIAL] : NULL},
        .effort = &s->effort,
    };
    const double count = (double)count_modes(s, which, fine->modes);
    enum br_status status = br_effort_spend(&s->effort, 2e-3 * count * count * count, &s->cause);
    if (!status)
        status = br_oscillators_create(&into->field[which], scene, outline, fine->modes,
                                       &into->store, &s->cause);
    if (!status)
        status = br_march(into->field[which], law, &options, &into->track[which], &s->cause);
    return status;
}

/* *out (owned by the caller); why it fails is in s->cause. */
static enum br_status solution_create(struct search *s, const struct fineness *fine,
                                      struct br_exact_solution **out)
{
    enum br_status status = BR_OK;
    *out = br_allocate(1, sizeof **out);
    if (!*out)
        return br_no_memory(&s->cause, "the exact solution");
    if (s->scene->axial.modelled)
        status = solve(s, BR_EXACT_AXIAL, fine, *out);
    if (!status && s->scene->bending.modelled)
        status = solve(s, BR_EXACT_BENDING, fine, *out);
    if (status)
        solution_free(*out);
    return status;
}

/* ---- solutions until two agree ---- */

/* The next solution, and how far it is from the last one. Where it fails, more modes may help;
 * where no work is left the last pair stays. */
static enum br_status next_round(struct search *s, const struct fineness *fine)
{
    struct br_exact *exact = s->exact;
    struct br_exact_solution *next = NULL;
    s->cause = (struct br_error){0};
    enum br_status status = solution_create(s, fine, &next);
    if (status == BR_NOT_FINITE)
        return BR_OK;
    if (status)
        return status;
    solution_free(s->before);
    s->before = exact->solution;
    exact->solution = next;
    if (!s->before)
        return BR_OK;
    status = br_exact_compare(exact, s->before, s->outline, &s->effort, &s->cause);
    s->worst_before = s->worst;
    s->worst = badness(exact, s->o);
    return status;
}

/* Whether the work that was allowed is done. */
static bool is_spent(const struct search *s)
{
    return s->effort.done > s->effort.most;
}

/* Modes of a next round, 0 if it may not be: elements multiply what is allowed for one by six. */
static size_t next_modes(const struct search *s, size_t modes)
{
    const size_t most = s->o->max_modes, more = modes * 3 / 2;
    const size_t next = !modes ? FIRST_MODES : more < most ? more : most;
    for (size_t which = 0; which < BR_EXACT_FIELDS; which++)
        if (count_modes(s, which, next) > 6 * most)
            return 0;
    return modes == most || is_spent(s) ? 0 : next;
}

/* Whether the last pair is all but what was wished for, and more modes do not help: the steps' own
 * errors are left. */
static bool is_stuck(const struct search *s)
{
    return s->worst <= fmin(10, s->o->acceptable / s->o->tolerance) &&
           s->worst > 0.5 * s->worst_before && s->worst < 2 * s->worst_before;
}

/* Whether the last pair will do though it is not what was wished for: either it is all but that, or
 * the distances shrink, and what is to come is added to the estimate. */
static bool will_do(struct search *s)
{
    const double near = 100, slow = 0.8, ratio = s->worst / s->worst_before;
    if (!(s->worst <= s->o->acceptable / s->o->tolerance) || (s->cause.status && !is_spent(s)))
        return false;
    if (s->worst <= near)
        return true;
    for (size_t i = 0; i < BR_EXACT_FIELDS && ratio <= slow; i++)
        scale_size(&s->exact->report[i].error, 1 / (1 - ratio));
    return ratio <= slow;
}

/* What no two solutions show, relative: places that nobody can look into, proofs' remainders, and
 * the rounding of the stages' times, independent of each other, where the load changes fast. */
static double unproved(const struct search *s, size_t which)
{
    const struct br_history *track = s->exact->solution->track[which];
    const double rounding = 0.29, change = 0.25; /* rms of a unit; of a load over a cell */
    const double blurred =
        track && track->impulse > 0
            ? rounding * change * sqrt(track->blurred / BR_STAGES) / track->impulse
            : 0;
    return s->missed + s->outline[which].proved + blurred;
}

/* Makes solutions with more and more modes until two agree. */
static enum br_status refine(struct search *s, struct br_error *err)
{
    const double enough = fmax(1, s->missed / s->o->tolerance);
    enum br_status status = BR_OK;
    size_t modes = next_modes(s, 0);
    if (!modes)
        return br_fail(err, BR_NOT_FINITE,
                       "no exact solution: the loads and initial data ask for %zu and %zu elements",
                       s->outline[0].end.count, s->outline[1].end.count);
    for (size_t round = 0; !status && modes && !(s->worst <= enough) && !is_stuck(s); round++) {
        const struct fineness fine = fineness_of(s->o, s->exact->duration, round, modes);
        status = next_round(s, &fine);
        modes = next_modes(s, modes);
    }
    if (status)
        return br_fail(err, status, "%s", s->cause.message);
    if (!(s->worst <= enough) && !will_do(s))
        return refuse(s->exact, s->worst, &s->cause, err);
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++)
        add_to_size(&s->exact->report[i].error, unproved(s, i), &s->exact->report[i].largest);
    return br_exact_list_events(s->exact, s->before, err);
}

static enum br_status outline(struct search *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t which = 0; which < BR_EXACT_FIELDS && !status; which++) {
        const bool axial = which == BR_EXACT_AXIAL;
        if (!(axial ? s->scene->axial.modelled : s->scene->bending.modelled))
            continue;
        status = br_outline_init(&s->outline[which], s->scene, axial ? 1 : 2, err);
        s->missed = fmax(s->missed, s->outline[which].missed);
    }
    if (!status && !(s->missed <= s->o->acceptable))
        status =
            br_fail(err, BR_NOT_FINITE,
                    "no exact solution: %.2g of a load may be in places that are too narrow to "
                    "be looked into",
                    s->missed);
    return status;
}

static enum br_status search(struct br_exact *exact, const struct br_scene *scene,
                             const struct br_exact_options *o, struct br_error *err)
{
    struct search s = {
        .exact = exact,
        .scene = scene,
        .o = o,
        .effort = {.most = most_work, .who = o},
        .worst = INFINITY,
        .worst_before = INFINITY,
    };
    enum br_status status = outline(&s, err);
    if (!status)
        status = refine(&s, err);
    solution_free(s.before);
    for (size_t which = 0; which < BR_EXACT_FIELDS; which++)
        br_outline_clear(&s.outline[which]);
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
    status = search(exact, scene, &o, err);
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
    solution_free(exact->solution);
    free(exact->event);
    free(exact);
}
