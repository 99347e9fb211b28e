/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "study/extremes/random.h"
#include "study/extremes/trial.h"
#include "study/scene/rescale.h"

static const double noise = 1e-12; /* of data, more than other units do to them */
static const double magnified = 8; /* between two such noises */

static enum br_status march_changed(struct br_extreme_trial *t, const struct br_scene *changed,
                                    double unit, double *distance, struct br_error *err)
{
    struct br_track_request request = br_extreme_request(t);
    request.scene = changed;
    const enum br_status status = br_track_march(&request, t->other, err);
    *distance = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        const double d = br_track_distance(t->other, t->own, (enum br_field_kind)kind, unit);
        *distance = isnan(d) || d > *distance ? d : *distance;
    }
    return status;
}

/* *exist: out, whether the scene's numbers are numbers in those units. */
static enum br_status march_in_other_units(struct br_extreme_trial *t, bool *exist,
                                           struct br_error *err)
{
    struct br_random r = br_random_of(t->one->seed ^ 0x5ca1e, t->one->index);
    const struct br_units_change units = {
        br_random_decades(&r, -3, 3), br_random_decades(&r, -3, 3), br_random_decades(&r, -3, 3)};
    struct br_scene changed = {0};
    enum br_status status = br_rescale(&t->scene, &units, &changed, err);
    *exist = !status;
    if (!status)
        status = march_changed(t, &changed, units.metre, &t->verdict->units, err);
    br_scene_clear(&changed);
    return status == BR_BAD_INPUT ? BR_OK : status; /* there are no such units for it */
}

/* The most that little noise does to the answer. Where a last bit decides between stick and slip,
 * half of the tries decide otherwise. */
static enum br_status march_with_noise(struct br_extreme_trial *t, double *most,
                                       struct br_error *err)
{
    *most = 0;
    for (unsigned try = 0; try < 8; try++) {
        struct br_scene changed = {0};
        double distance = 0;
        enum br_status status =
            br_perturb(&t->scene, noise, t->one->seed + t->one->index + try, &changed, err);
        if (!status)
            status = march_changed(t, &changed, 1, &distance, err);
        br_scene_clear(&changed);
        if (status == BR_BAD_INPUT)
            continue;
        if (status)
            return status;
        *most = isnan(distance) ? INFINITY : fmax(*most, distance);
    }
    return BR_OK;
}

/* Where a scheme takes a step or not by comparisons that a last bit decides, marches agree as well
 * as each is right: as is stated, and within so many times the tolerance. */
static const double of_tolerance = 100;

static double control(const struct br_extreme_trial *t)
{
    if (!t->method.scheme->adaptive)
        return 0;
    double stated = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        stated = fmax(stated, br_predicted_most(&t->prediction, (enum br_field_kind)kind));
    return fmin(stated, of_tolerance * t->method.tolerance);
}

/* What rounding may do to the displacements, relative to the largest: what is predicted, in either
 * units, since assembled matrices are rounded otherwise in others; what an iteration leaves; the
 * velocities' own, since displacements are sums of them, and those that the tip would have without
 * the laws' forces, since its own are differences from these; and what steps that are chosen
 * differ by. */
static double allowed(const struct br_extreme_trial *t)
{
    const double k = t->marched.duration / (double)t->one->steps;
    double ways = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (t->own->largest[kind] > 0)
            ways =
                fmax(ways, (k * t->own->speed[kind] + t->own->held[kind]) / t->own->largest[kind]);
    const double iteration = t->method.friction->iterates ? t->method.iteration.tolerance : 0;
    const double predicted = fmax(t->verdict->round_off, t->other->report.round_off);
    return 16 * (predicted + DBL_EPSILON * ways) + 4 * iteration + control(t);
}

enum br_status br_extreme_judge_units(struct br_extreme_trial *t, struct br_error *err)
{
    double by_noise;
    bool exist;
    enum br_status status = march_in_other_units(t, &exist, err);
    if (status || !exist)
        return status;
    const double units = t->verdict->units, limit = allowed(t);
    if (units <= limit || (isnan(units) && !t->other->begun))
        return status;
    char why[120];
    snprintf(why, sizeof why, "%.110s", t->other->failure.message);
    status = march_with_noise(t, &by_noise, err);
    if (!status && !(units <= magnified * by_noise))
        br_extreme_decide(
            t, BR_EXTREME_WRONG,
            "in other units it differs by %.2g; round-off explains %.2g, noise %.2g %s", units,
            limit, by_noise, why);
    return status;
}
