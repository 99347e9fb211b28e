/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/foresee/foreseen.h"

#include <math.h>
#include <stdlib.h>

#include "study/ranks/batches.h"

static const double nanosecond = 1e-9;

void br_foreseen_clear(struct br_foreseen *w)
{
    free(w->row);
    *w = (struct br_foreseen){0};
}

static void add(struct br_foreseen *w, const struct br_foreseen_march *row)
{
    if (w->rows == w->room) {
        const size_t room = 2 * w->room + 16;
        struct br_foreseen_march *more = realloc(w->row, room * sizeof *more);
        if (!more) {
            w->lost = true;
            return;
        }
        w->row = more;
        w->room = room;
    }
    w->row[w->rows++] = *row;
}

static struct br_foreseen_march row_of(const char *what, const struct br_planned_march *o)
{
    return (struct br_foreseen_march){
        .scene = o->scene->name,
        .what = what,
        .at = {o->n, o->steps},
        .of = o->scene,
        .method = *o->method,
        .seconds = o->method->scheme->adaptive ? (double)NAN : br_march_seconds(o),
        .bytes = br_march_bytes(o),
    };
}

void br_foreseen_add_march(struct br_foreseen *w, const struct br_planned_march *planned)
{
    const struct br_foreseen_march row = row_of("march", planned);
    add(w, &row);
}

/* A warm-up, the repeats that the request allows, and a march for the error. */
void br_foreseen_add_trial(struct br_foreseen *w, const struct br_trial *t,
                           const struct br_trial_request *request)
{
    const struct br_method method = br_trial_method(t);
    const struct br_planned_march planned = {
        .scene = request->scene, .method = &method, .n = t->at.n, .steps = t->at.steps};
    struct br_foreseen_march row = row_of("trial", &planned);
    const double repeats = ceil(request->repeat_seconds / row.seconds);
    row.seconds *= 2 + fmin(repeats, (double)request->repeats);
    add(w, &row);
}

void br_foreseen_add_study(struct br_foreseen *w, const struct br_study *s)
{
    for (size_t c = 0; c < br_study_cells(s); c++) {
        const struct br_resolution at = br_study_resolution(s, c);
        const struct br_planned_march planned = {
            .scene = s->scene, .method = br_study_method(s, c), .n = at.n, .steps = at.steps};
        struct br_foreseen_march row = row_of("cell", &planned);
        if (!isnan(row.seconds))
            row.seconds = fmax(row.seconds, nanosecond * br_cell_cost(s, c));
        add(w, &row);
    }
    if (!s->judge->create)
        return;
    const struct br_planned_march fine = {.scene = s->scene,
                                          .method = &s->reference_method,
                                          .n = s->reference.n,
                                          .steps = s->reference.steps};
    struct br_foreseen_march row = {.scene = s->scene->name,
                                    .what = s->judge->name,
                                    .of = s->scene,
                                    .bytes = NAN,
                                    .seconds = nanosecond * br_reference_cost(s)};
    if (s->judge->nests) {
        const double seconds = row.seconds;
        row = row_of("reference", &fine);
        row.seconds = fmax(row.seconds, seconds);
    }
    add(w, &row);
}

double br_foreseen_seconds(const struct br_foreseen *w, int threads)
{
    double all = 0, longest = 0;
    for (size_t i = 0; i < w->rows; i++) {
        const double seconds = isfinite(w->row[i].seconds) ? w->row[i].seconds : 0;
        all += seconds;
        longest = fmax(longest, seconds);
    }
    return w->alone ? all : fmax(all / threads, longest);
}

double br_foreseen_bytes(const struct br_foreseen *w)
{
    double all = 0, most = 0;
    for (size_t i = 0; i < w->rows; i++) {
        const double bytes = isfinite(w->row[i].bytes) ? w->row[i].bytes : 0;
        all += bytes;
        most = fmax(most, bytes);
    }
    return w->together ? all : most;
}

enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err)
{
    struct br_foreseen w = {.together = true};
    size_t marches = 0;
    for (size_t i = 0; i < count; i++)
        br_foreseen_add_study(&w, &studies[i]);
    for (size_t i = 0; i < w.rows; i++)
        marches += isnan(w.row[i].bytes) ? 0 : 1;
    const double bytes = br_foreseen_bytes(&w);
    const bool lost = w.lost;
    br_foreseen_clear(&w);
    if (lost)
        return br_no_memory(err, "what is foreseen");
    if (bytes <= available)
        return BR_OK;
    return br_fail(err, BR_NO_MEMORY,
                   "%zu marches at once take about %.3g GB, %.3g GB are available: expected fewer "
                   "of them, or fewer elements",
                   marches, bytes / 1e9, available / 1e9);
}
