/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/scene/vary.h"
#include "tables/report_parts.h"

/* Puts "1e-3 m (at 100 N/m)". */
static void put_end(struct br_document *d, const struct br_variation *s, size_t i, size_t column)
{
    const char *unit = s->column[column].unit;
    br_put_more(d, "%.4g%s%s (at %g%s%s)", br_variation_value(s, i, column), unit ? " " : "",
                unit ? unit : "", s->varied->value[i], *s->varied->unit ? " " : "",
                s->varied->unit);
}

/* Puts "error over length: from 1e-3 m (at 1 m) to 2e-2 m (at 2 m)." Returns whether it has put
 * anything: a column with a unit and without a value is not modelled. */
static bool answer_range(struct br_document *d, const struct br_variation *s, size_t column)
{
    const struct br_variation_column *what = &s->column[column];
    const struct br_varied *v = s->varied;
    size_t least = 0, most = 0, known = 0;
    for (size_t i = 0; i < v->count; i++) {
        const double x = br_variation_value(s, i, column);
        if (s->unstable[i] || !isfinite(x))
            continue;
        least = !known || x < br_variation_value(s, least, column) ? i : least;
        most = !known || x > br_variation_value(s, most, column) ? i : most;
        known++;
    }
    if (!known && what->unit)
        return false;
    br_put_answer(d, "%s over %s: ", what->heading, v->name);
    if (!known) {
        br_put_more(d, "not known at any value.");
        return true;
    }
    br_put_more(d, known > 1 ? "from " : "known at one value only, ");
    put_end(d, s, least, column);
    if (known > 1) {
        br_put_more(d, " to ");
        put_end(d, s, most, column);
    }
    br_put_more(d, ".");
    return true;
}

void br_report_variation(const struct br_variation *s, struct br_document *d)
{
    const struct br_varied *v = s->varied;
    size_t first = 0, answers = 0, unstable = 0;
    const size_t failures = br_variation_failures(s, &first);
    br_document_begin(d, s->name, s->format, 1, s->caption);
    for (size_t c = 0; c < s->columns && answers < 3; c++)
        answers += s->column[c].axis && answer_range(d, s, c) ? 1 : 0;
    for (size_t i = 0; i < v->count; i++)
        unstable += s->unstable[i];
    if (unstable)
        br_put_answer(d,
                      "%zu of %zu values are beyond the lagged contact's stability limit: they are "
                      "only in the table. --contact implicit has no limit.",
                      unstable, v->count);
    if (failures)
        br_put_answer(d, "%zu of %zu values FAILED; the first, %g %s: %s", failures, v->count,
                      v->value[first], v->unit, s->failure[first].message);
    br_put_table(d, "values", "What was found at each value", BR_MAIN | BR_LONG);
    for (size_t i = 0; i < v->count; i++) {
        br_put_row(d);
        BR_PUT(d, br_number(v->value[i]), .key = "value", .heading = v->name, .unit = v->unit);
        for (const struct br_variation_column *c = s->column; c < s->column + s->columns; c++)
            BR_PUT(d, br_number(br_variation_value(s, i, (size_t)(c - s->column))), .key = c->key,
                   .heading = c->heading, .unit = c->unit, .format = c->format,
                   .flags = c->for_programs ? BR_FOR_PROGRAMS : 0);
        BR_PUT(d, br_text(s->remark[i]), .key = "remark", .flags = BR_WRAP);
        BR_PUT(d, br_failure_text(&s->failure[i]), .key = "failure", .flags = BR_WRAP);
    }
    br_put_fact_as(d, br_text(v->name), "varied", NULL, "varied.key");
    br_hide_fact(d, br_text(v->unit), NULL, "varied.unit");
    br_hide_fact(d, br_truth(v->logarithmic), NULL, "varied.logarithmic");
    br_put_fact_as(d, br_text(v->key->help), "meaning", NULL, "varied.help");
}
