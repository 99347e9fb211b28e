/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/run.h"

#include <math.h>
#include <string.h>

#include "study/run/history.h"
#include "study/run/run.h"

/* ---- times ---- */

/* The time level at t, s; the option names where it was found. */
static enum br_status read_level(const char *option, double t, const struct br_scene *scene,
                                 size_t steps, size_t *level, struct br_error *err)
{
    const double T = scene->duration, place = t / T * (double)steps;
    if (!(t >= 0 && t <= T))
        return br_fail(err, BR_BAD_INPUT, "%s: found %g s, expected a time of [0, %g] s", option, t,
                       T);
    const double nearest = round(place);
    *level = (size_t)nearest;
    if (fabs(place - nearest) <= 1e-6)
        return BR_OK;
    const double below = floor(place);
    return br_fail(
        err, BR_BAD_INPUT,
        "%s: found %.10g s, expected a multiple of k = %g s; the nearest are %.15g s and "
        "%.15g s",
        option, t, T / (double)steps, T * below / (double)steps, T * (below + 1) / (double)steps);
}

static enum br_status not_a_time(const char *option, const char *found, const char *example,
                                 struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "%s: found '%s', expected %s", option, found, example);
}

static enum br_status read_at(const char *text, const struct br_scene *scene,
                              struct br_run_plan *plan, struct br_error *err)
{
    for (const char *rest = text; rest; rest = *rest ? rest + 1 : NULL) {
        double t;
        const char *end = br_read_time(rest, scene->duration, &t);
        if (!end)
            return not_a_time("--at", rest, "times separated by commas, like 0.1,0.5", err);
        if (read_level("--at", t, scene, plan->steps, &plan->level[plan->levels++], err))
            return err->status;
        rest = end;
    }
    br_sort_counts(plan->level, plan->levels);
    for (size_t i = 1; i < plan->levels; i++)
        if (plan->level[i] == plan->level[i - 1])
            return br_fail(err, BR_BAD_INPUT, "--at: %g s is given twice",
                           scene->duration * (double)plan->level[i] / (double)plan->steps);
    return BR_OK;
}

static enum br_status read_every(const char *text, const struct br_scene *scene, size_t steps,
                                 size_t *interval, struct br_error *err)
{
    double t;
    const char *end = br_read_time(text, scene->duration, &t);
    if (!end || *end || !(t > 0))
        return not_a_time("--every", text, "a time above 0, like 0.1", err);
    if (read_level("--every", t, scene, steps, interval, err))
        return err->status;
    return *interval
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "--every: found '%s', expected a multiple of k = %g s",
                         text, scene->duration / (double)steps);
}

/* By default ten intervals of about the same length, whatever the number of steps. */
static enum br_status make_levels(const struct br_options *o, const struct br_scene *scene,
                                  struct br_run_plan *plan, struct br_error *err)
{
    enum { PARTS = 10 };
    const char *at = br_option_text(o, BR_OPT_AT), *every = br_option_text(o, BR_OPT_EVERY);
    size_t room = PARTS + 1, interval = 1;
    if (at && every)
        return br_fail(err, BR_BAD_INPUT, "--at and --every are given, expected one of the two");
    if ((at || every) && !br_option_given(o, BR_OPT_OUT))
        return br_fail(err, BR_BAD_INPUT, "%s needs --out, the folder for the fields",
                       at ? "--at" : "--every");
    if (every && read_every(every, scene, plan->steps, &interval, err))
        return err->status;
    if (at || every)
        room = at ? strlen(at) + 1 : plan->steps / interval + 1;
    plan->level = br_allocate(room, sizeof *plan->level);
    if (!plan->level)
        return br_no_memory(err, "the output times");
    if (at)
        return read_at(at, scene, plan, err);
    for (size_t i = 0; i < room && br_option_given(o, BR_OPT_OUT); i++) {
        const size_t level =
            every ? i * interval
                  : (size_t)llround((double)plan->steps * (double)i / PARTS); /* exact below 2^49 */
        if (plan->levels == 0 || level > plan->level[plan->levels - 1])
            plan->level[plan->levels++] = level;
    }
    return BR_OK;
}

/* ---- the plan ---- */

static enum br_status read_fields(const char *text, unsigned *wanted, struct br_error *err)
{
    static const struct {
        const char *name;
        unsigned bits;
    } names[] = {{"axial", BR_WANT_AXIAL},
                 {"bending", BR_WANT_BENDING},
                 {"axial,bending", BR_WANT_AXIAL | BR_WANT_BENDING},
                 {"bending,axial", BR_WANT_AXIAL | BR_WANT_BENDING}};
    *wanted = 0;
    for (size_t i = 0; text && i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            *wanted = names[i].bits;
    if (text && !*wanted)
        return br_fail(err, BR_BAD_INPUT,
                       "--fields: found '%s', expected axial, bending or axial,bending", text);
    return BR_OK;
}

enum br_status br_run_plan_make(const struct br_options *o, const struct br_scene *scene,
                                struct br_run_plan *plan, struct br_error *err)
{
    const char *const *given = &o->given[BR_OPT_METHOD];
    const struct br_method *const methods[] = {&plan->method};
    *plan = (struct br_run_plan){.method = br_method_default()};
    if (br_method_read(given, BR_METHOD_OPTION, &plan->method, err) ||
        br_method_check_heeded(given, BR_METHOD_OPTION, methods, 1, err) ||
        read_fields(br_option_text(o, BR_OPT_FIELDS), &plan->wanted, err))
        return err->status;
    plan->n = (size_t)br_option_number(o, BR_OPT_N, 0);
    plan->steps = (size_t)br_option_number(o, BR_OPT_STEPS, 0);
    if (!plan->steps && br_read_step("--k", br_option_text(o, BR_OPT_K), scene, &plan->steps, err))
        return err->status;
    if (br_option_given(o, BR_OPT_OUT))
        plan->stride = br_history_stride(plan->steps, (size_t)br_option_number(o, BR_OPT_ROWS, 0));
    return make_levels(o, scene, plan, err);
}

void br_run_plan_clear(struct br_run_plan *plan)
{
    free(plan->level);
    *plan = (struct br_run_plan){0};
}
