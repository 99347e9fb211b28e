/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observed orders with their intervals, beside what is expected. */
#include <math.h>

#include "base/quote.h"
#include "orders/expectation/check.h"
#include "plots/pictures.h"

enum { ROWS = 30, MOST = 100 }; /* with more orders a row is a check; no more rows are drawn */

/* Adds the band that is expected, with a row's label or "", and the interval, with a gap behind it.
 */
static void add_order(struct br_figure *f, const struct br_case *c, double row, const char *label,
                      struct br_series *marks, struct br_series *line)
{
    const struct br_expectation *e = &c->expected;
    struct br_series *band = br_series_add(f, BR_PEN_BAND, "expected");
    br_quoted(band->end, sizeof band->end, &br_for_markup, label);
    const double low = br_expectation_low(e), high = br_expectation_high(e);
    br_point_add(band, low, row, NULL);
    br_point_add(band, isfinite(high) ? high : fmax(low, c->order.high), row, NULL);
    br_point_add(marks, c->order.value, row, NULL);
    br_point_add(line, c->order.low, row, NULL);
    br_point_add(line, c->order.high, row, NULL);
    br_point_add(line, c->order.high, NAN, NULL);
}

struct br_figure br_check_draw(const struct br_check *check, size_t count)
{
    struct br_figure f = {.stem = "check", .title = "Orders, observed and expected"};
    struct br_series *marks[BR_INCONCLUSIVE + 1] = {0}, *line[BR_INCONCLUSIVE + 1] = {0};
    size_t orders = 0, rows = 0, left = 0;
    for (size_t i = 0; i < count; i++)
        orders += check[i].count;
    if (orders)
        br_panel_add(&f, false, "order, with its 95 % interval", "%s", "")->rows = true;
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        if (br_check_tally(check, count, (enum br_verdict)v)) {
            marks[v] = br_series_add(&f, BR_PEN_MARKS, "%s", br_verdict_names[v]);
            line[v] = br_series_add(&f, BR_PEN_LINE, "%s", br_verdict_names[v]);
            line[v]->style = marks[v]->style = (size_t)v + 1;
        }
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < check[i].count; j++) {
            const struct br_case *c = &check[i].cases[j];
            char label[120] = "", name[BR_SHORT_NAME], measure[BR_SHORT_NAME];
            rows += orders <= ROWS || j == 0;
            left += rows > MOST;
            if (orders <= ROWS)
                BR_SAY(label, "%s %s %s %.20s", br_short_name(check[i].name, name),
                       br_verify_names[c->kind], br_short_name(c->measure, measure), c->part);
            else if (j == 0)
                BR_SAY(label, "%s", br_short_name(check[i].name, name));
            if (rows <= MOST)
                add_order(&f, c, -(double)rows, label, marks[c->verdict], line[c->verdict]);
        }
    if (left)
        BR_SAY(f.note[0], "not drawn: %zu orders of the last checks", left);
    return f;
}
