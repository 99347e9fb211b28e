/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of `extremes` that compute nothing: what they were asked for is what they say. */
#include <stdio.h>
#include <unistd.h>

#include "cli/beam/extremes_experiment.h"

struct heard {
    char line[512];
    size_t rows;
};

/* ---- what it says ---- */

static void report(const struct heard *h, const char *name, struct br_document *d)
{
    br_document_begin(d, name, "beamrate extremes made", 1, "A made part");
    br_put_answer(d, "%s", h->line);
    br_put_table(d, "rows", "Rows", BR_MAIN);
    for (size_t i = 0; i < h->rows; i++) {
        br_put_row(d);
        char text[32];
        snprintf(text, sizeof text, "row %zu", i);
        BR_PUT(d, br_text(text), .key = "row");
        BR_PUT(d, br_count(i), .key = "value");
    }
}

static void draw_curve(const char *stem, struct br_figure *f)
{
    BR_SAY(f->stem, "%s", stem);
    br_panel_add(f, false, "x", "y");
    struct br_series *s = br_series_add(f, BR_PEN_LINE, "line");
    br_point_add(s, 0, 0, NULL);
    br_point_add(s, 1, 1, NULL);
}

static void draw(const struct br_extremes_output *to)
{
    struct br_figure chart = {0}, other = {0};
    draw_curve("fast-chart", &chart);
    br_session_draw(to->session, to->report, chart, NULL);
    draw_curve("fast-other", &other);
    br_session_draw(to->session, to->report, other, NULL);
}

/* ---- fast: n = 13 is wrong, 14 refused, 15 a failure ---- */

static enum br_status run_fast(const struct br_extremes_job *j, const struct br_extremes_output *to,
                               struct br_error *err)
{
    const size_t n = j->n_count ? j->n[j->n_count - 1] : 0;
    if (n == 14)
        return br_fail(err, BR_BAD_INPUT, "14 is refused");
    if (n == 15)
        return br_fail(err, BR_NOT_FINITE, "15 failed");
    struct heard heard = {.rows = 3}, *h = &heard;
    snprintf(h->line, sizeof h->line, "threads %d, %zu n up to %zu, %zu k", j->threads, j->n_count,
             n, j->step_count);
    report(h, "fast", to->report);
    if (n == 13)
        br_fail(to->verdict, BR_VERDICT, "13 is silently wrong");
    draw(to);
    return BR_OK;
}

/* ---- slow: n times 10 ms ---- */

static enum br_status run_slow(const struct br_extremes_job *j, const struct br_extremes_output *to,
                               struct br_error *err)
{
    struct heard heard = {.rows = 0}, *h = &heard;
    enum br_status status = BR_OK;
    for (; h->rows < j->n[0] && !status; h->rows++) {
        usleep(10000);
        if (j->observer->stop(j->observer->self))
            status = br_fail(err, BR_INTERRUPTED, "interrupted");
    }
    snprintf(h->line, sizeof h->line, "%zu are done", h->rows);
    report(h, "slow", to->report);
    return status;
}

const struct br_extremes_experiment br_extremes_experiments[] = {
    {
        .name = "fast",
        .title = "says what it was asked for",
        .accepts = BR_ACCEPTS(N) | BR_ACCEPTS(K),
        .scene = {"example2"},
        .run = run_fast,
    },
    {
        .name = "slow",
        .title = "takes long",
        .accepts = BR_ACCEPTS(N),
        .scene = {"example2"},
        .run = run_slow,
    },
    {0},
};
