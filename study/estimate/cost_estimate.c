/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/estimate/cost_estimate.h"

#include <math.h>

#include "study/grid/batches.h"

static const double nanosecond = 1e-9;

static void add_time(struct br_cost_estimate *w, double seconds)
{
    w->seconds += seconds;
    w->longest = fmax(w->longest, seconds);
}

/* least: what it takes at least, s. */
static void add(struct br_cost_estimate *w, const struct br_planned_march *march, double least)
{
    const double bytes = br_march_bytes(march);
    w->marches++;
    w->bytes = w->together ? w->bytes + bytes : fmax(w->bytes, bytes);
    if (march->method->scheme->adaptive)
        w->untimed++;
    else {
        const double steps = br_march_seconds(march), seconds = fmax(least, steps);
        if (seconds > w->longest)
            w->dearest = *march;
        add_time(w, seconds);
        w->steps += steps;
    }
}

void br_cost_estimate_add_march(struct br_cost_estimate *w, const struct br_planned_march *planned)
{
    add(w, planned, 0);
}

void br_cost_estimate_add_study(struct br_cost_estimate *w, const struct br_study *s)
{
    for (size_t c = 0; c < br_study_cells(s); c++) {
        const struct br_resolution at = br_study_resolution(s, c);
        const struct br_planned_march cell = {
            .scene = s->scene, .method = br_study_method(s, c), .n = at.n, .steps = at.steps};
        add(w, &cell, nanosecond * br_cell_cost(s, c));
    }
    const struct br_planned_march fine = {.scene = s->scene,
                                          .method = &s->reference_method,
                                          .n = s->reference.n,
                                          .steps = s->reference.steps};
    const double seconds = nanosecond * br_reference_cost(s);
    if (s->reference_kind->create && s->reference_kind->nests)
        add(w, &fine, seconds);
    else if (s->reference_kind->create)
        add_time(w, seconds);
}

void br_cost_estimate_measure(struct br_cost_estimate *w)
{
    const double before = w->seconds;
    if (!w->dearest.scene)
        return;
    w->seconds += (br_march_pace(&w->dearest) - 1) * w->steps;
    w->longest *= w->seconds / before;
}

double br_cost_estimate_seconds(const struct br_cost_estimate *w, int threads)
{
    return w->alone ? w->seconds : fmax(w->seconds / threads, w->longest);
}

enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err)
{
    struct br_cost_estimate w = {.together = true};
    for (size_t i = 0; i < count; i++)
        br_cost_estimate_add_study(&w, &studies[i]);
    if (w.bytes <= available)
        return BR_OK;
    return br_fail(err, BR_NO_MEMORY,
                   "%zu marches at once take about %.3g GB, %.3g GB are available: expected fewer "
                   "of them, or fewer elements",
                   w.marches, w.bytes / 1e9, available / 1e9);
}
