/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/prediction_probes.h"

#include <math.h>

#include "solver/clock.h"

/* A solve costs as much as so many elements more than it has. */
static const double overhead = 700;

/* Elements times solves of all probes together: at least, at most, and as a share of the run's. */
static const double least_work = 3e5, most_work = 1e6, most_share = 0.5;
static const double time_share = 0.5, start_share = 0.2, space_share = 0.3;

static const double longest = 1; /* s; only steps by a tolerance can take so long */

enum { SPACE_N = 128, TIME_N = 32, MOST_REFINED = 32, TOLERANCE_LEVELS = 24 };

/* By a tolerance: that of the probes is at least this, their references' smaller by this. */
static const double loosest = 1e-4, tighter = 20;

static double solves(const struct br_outlook *o)
{
    return o->method->scheme->adaptive ? 1 : br_time_scheme_stages(o->method->scheme);
}

static double budget(const struct br_outlook *o)
{
    const double own = ((double)o->n + overhead) * (double)o->steps * solves(o);
    return fmin(fmax(most_share * own, least_work), most_work);
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static void set_study(struct br_probe *p, const struct br_method *method, struct br_resolution fine,
                      size_t n_count, size_t k_count)
{
    p->held = true;
    p->study = (struct br_study){
        .scene = &p->scene,
        .norm = &br_norm_l2,
        .method = *method,
        .judge = &br_judge_fine,
        .reference_method = *method,
        .reference = fine,
        .n_count = n_count,
        .k_count = k_count,
        .n = p->n,
        .steps = p->steps,
    };
}

/* The run's few steps against many times as many; a second cell between them is there for the
 * levels at which the solution's size is seen. */
static void measure_time(struct br_probe *p, const struct br_outlook *o, double most)
{
    const size_t ratio = (double)o->steps * 40 <= most ? 27 : (double)o->steps * 13 <= most ? 9 : 3;
    p->measured = true;
    p->ratio = (double)ratio;
    p->beyond = 1;
    p->steps[0] = o->steps;
    p->steps[1] = o->steps * ratio / 3;
    set_study(p, o->method, (struct br_resolution){p->n[0], o->steps * ratio}, 1,
              ratio > 3 ? 2 : 1);
}

/* a, 2a against 4a steps, a odd: their levels are not those at which a periodic load is zero. */
static void extrapolate_time(struct br_probe *p, const struct br_outlook *o, double most)
{
    const size_t a = (size_t)(most / 7) | 1;
    p->ratio = 2;
    p->beyond = (double)o->steps / (2 * (double)a);
    p->steps[0] = a;
    p->steps[1] = 2 * a;
    set_study(p, o->method, (struct br_resolution){p->n[0], 4 * a}, 1, 2);
}

static void compare_tolerances(struct br_probe *p, const struct br_outlook *o)
{
    struct br_method method = *o->method;
    method.tolerance = fmax(method.tolerance, loosest);
    p->measured = method.tolerance == o->method->tolerance;
    p->beyond = method.tolerance / o->method->tolerance;
    p->ratio = tighter;
    p->steps[0] = TOLERANCE_LEVELS;
    set_study(p, &method, (struct br_resolution){p->n[0], TOLERANCE_LEVELS}, 1, 1);
    p->study.reference_method.tolerance = method.tolerance / tighter;
}

static void set_time(struct br_probe *p, const struct br_outlook *o)
{
    p->scene = *o->scene;
    p->n[0] = least(o->n, TIME_N);
    const double most = time_share * budget(o) / (((double)p->n[0] + overhead) * solves(o));
    if (o->method->scheme->adaptive)
        compare_tolerances(p, o);
    else if (4 * (double)o->steps <= most)
        measure_time(p, o, most);
    else
        extrapolate_time(p, o, most);
}

static void set_start(struct br_probe *p, const struct br_outlook *o, const struct br_probe *time)
{
    if (o->method->scheme->adaptive || time->measured)
        return;
    p->scene = *o->scene;
    p->n[0] = least(o->n, TIME_N);
    const double most = start_share * budget(o) / (((double)p->n[0] + overhead) * solves(o));
    p->steps[0] = least(o->steps, (size_t)(most / 4) + 1);
    p->scene.duration *= (double)p->steps[0] / (double)o->steps;
    p->measured = true;
    p->ratio = 3;
    set_study(p, o->method, (struct br_resolution){p->n[0], 3 * p->steps[0]}, 1, 1);
}

/* The lag is an error in time: it is left out. */
static struct br_method without_lag(const struct br_outlook *o)
{
    struct br_method method = *o->method;
    if (!method.contact->at_new_step)
        for (const struct br_contact_rule *const *rule = br_contact_rules; *rule; rule++)
            if ((*rule)->at_new_step) {
                method.contact = *rule;
                break;
            }
    return method;
}

static void set_space(struct br_probe *p, const struct br_outlook *o)
{
    const struct br_method method = without_lag(o);
    size_t ratio = 2, cells = 1;
    p->scene = *o->scene;
    p->measured = o->n <= SPACE_N;
    if (p->measured) {
        p->n[0] = o->n;
        while (ratio < MOST_REFINED && o->n * ratio < SPACE_N)
            ratio *= 2;
    } else {
        p->n[0] = SPACE_N / 2;
        p->n[1] = SPACE_N;
        cells = 2;
    }
    const size_t finest = ratio * p->n[cells - 1];
    p->ratio = (double)ratio;
    p->beyond = (double)o->n / (double)p->n[cells - 1];
    const double a_step =
        ((double)(finest + p->n[0] + p->n[1]) + (1 + (double)cells) * overhead) * solves(o);
    p->steps[0] = o->method->scheme->adaptive
                      ? TOLERANCE_LEVELS
                      : least(o->steps, (size_t)(space_share * budget(o) / a_step) + 1);
    set_study(p, &method, (struct br_resolution){finest, p->steps[0]}, cells, 1);
    if (o->method->scheme->adaptive) /* steps that differ would hide what the meshes do */
        p->study.method.scheme = p->study.reference_method.scheme = br_time_schemes[0];
}

static bool takes_too_long(void *begun)
{
    return br_seconds() - *(double *)begun > longest;
}

enum br_status br_probes_hold(struct br_probe_set *set, const struct br_outlook *outlook,
                              struct br_error *err)
{
    double begun = br_seconds();
    const struct br_observer observer = {.stop = takes_too_long, .self = &begun};
    struct br_study study[BR_PROBES];
    size_t count = 0;
    *set = (struct br_probe_set){.outlook = outlook};
    set_time(&set->probe[BR_PROBE_TIME], outlook);
    set_start(&set->probe[BR_PROBE_START], outlook, &set->probe[BR_PROBE_TIME]);
    set_space(&set->probe[BR_PROBE_SPACE], outlook);
    for (int i = 0; i < BR_PROBES; i++)
        if (set->probe[i].held)
            study[count++] = set->probe[i].study;
    const enum br_status status = br_study_run_each(study, count, 1, &observer, err);
    count = 0;
    for (int i = 0; i < BR_PROBES; i++)
        if (set->probe[i].held)
            set->probe[i].study = study[count++];
    return status;
}

void br_probes_clear(struct br_probe_set *set)
{
    for (int i = 0; i < BR_PROBES; i++)
        br_study_clear(&set->probe[i].study);
}
