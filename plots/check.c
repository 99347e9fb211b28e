/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observed orders with their intervals, beside what is expected. */
#include <math.h>

#include "plots/pictures.h"
#include "study/scene/quote.h"
#include "study/verify/check.h"

enum { ROWS = 30, MOST = 100 }; /* with more orders a row is a check; no more rows are drawn */

/* A row's label stands left of the axis, where what is expected begins. */
static void add_expected(struct br_figure *f, const struct br_case *c, double row,
                         const char *label)
{
    const struct br_expectation *e = &c->expected;
    struct br_series *s = br_series_add(f, BR_PEN_BAND, "expected");
    const double highest = e->highest > 0 ? e->highest : e->order;
    if (*label)
        br_quoted(s->end, sizeof s->end, &br_for_markup, label);
    br_point_add(s, e->order - e->tolerance, row, NULL);
    br_point_add(s, highest + e->tolerance, row, NULL);
}

/* The interval, and a gap before the next one. */
static void add_observed(const struct br_case *c, double row, struct br_series *line,
                         struct br_series *marks)
{
    br_point_add(marks, c->order.value, row, NULL);
    br_point_add(line, c->order.low, row, NULL);
    br_point_add(line, c->order.high, row, NULL);
    br_point_add(line, c->order.high, NAN, NULL);
}

struct br_figure br_check_draw(const struct br_check *check, size_t count)
{
    struct br_figure figure = {.stem = "check", .title = "Orders, observed and expected"};
    struct br_figure *f = &figure;
    size_t orders = 0, rows = 0, left = 0;
    for (size_t i = 0; i < count; i++)
        orders += check[i].count;
    if (!orders)
        return figure;
    br_panel_add(f, "order, with its 95 % interval", "")->rows = true;
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++) {
        if (!br_check_tally(check, count, (enum br_verdict)v))
            continue;
        struct br_series *marks = br_series_add(f, BR_PEN_MARKS, "%s", br_verdict_names[v]);
        struct br_series *line = br_series_add(f, BR_PEN_LINE, "%s", br_verdict_names[v]);
        line->style = marks->style = (size_t)v + 1;
        rows = left = 0;
        for (size_t i = 0; i < count; i++) {
            for (size_t j = 0; j < check[i].count; j++) {
                const struct br_case *c = &check[i].cases[j];
                const bool apart = orders <= ROWS || j == 0;
                char label[120] = "";
                rows += apart;
                left += rows > MOST;
                if (c->verdict != (enum br_verdict)v || rows > MOST)
                    continue;
                if (orders <= ROWS)
                    BR_SAY(label, "%.40s %s %.30s %.20s", check[i].name, br_verify_names[c->kind],
                           c->measure, c->part);
                else if (apart)
                    BR_SAY(label, "%.60s", check[i].name);
                add_expected(f, c, -(double)rows, label);
                add_observed(c, -(double)rows, line, marks);
            }
        }
    }
    if (left)
        BR_SAY(f->note[0], "not drawn: %zu orders of the last checks", left);
    return figure;
}
