/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "tables/report_study.h"

/* "0.7999 +- 2e-3 s" */
static void show_value(struct br_document *d, double value, double error, const char *unit)
{
    char bar[32] = "";
    const char *named = strcmp(unit, "1") == 0 ? "" : unit;
    if (isfinite(error))
        snprintf(bar, sizeof bar, " +- %.2g", error);
    if (isfinite(value))
        br_put_shown(d, "%.6g%s%s%s", value, bar, *named ? " " : "", named);
}

static void put_claim(struct br_document *d, const struct br_claim *c, const struct br_finding *f)
{
    br_put_row(d);
    br_put(d, "claim", br_text(c->name));
    br_put(d, "section", br_text(c->section));
    br_put(d, "figure", c->figure ? br_count((size_t)c->figure) : br_nothing());
    br_put(d, "statement", br_text(c->statement));
    br_put(d, "measured", br_text(c->measured));
    br_put(d, "unit", br_text(c->unit));
    br_put(d, "printed", br_number(f->printed));
    show_value(d, f->printed, NAN, c->unit);
    br_put(d, "value", br_number(f->value));
    show_value(d, f->value, f->error, c->unit);
    br_put(d, "error", br_number(f->error));
    br_put(d, "exact", br_number(f->exact));
    show_value(d, f->exact, NAN, c->unit);
    br_put(d, "agreement", br_text(br_agreement_name(f->agreement)));
    br_put(d, "note", br_text(*f->note ? f->note : NULL));
}

void br_report_claims(const struct br_finding *finding, size_t n, size_t per_second,
                      struct br_document *d)
{
    static const struct br_column columns[] = {
        {.key = "claim", .flags = BR_FOR_PROGRAMS},
        {.key = "section"},
        {.key = "figure", .flags = BR_FOR_PROGRAMS},
        {.key = "statement", .heading = "the paper", .flags = BR_WRAP},
        {.key = "measured", .flags = BR_WRAP | BR_FILES_ONLY},
        {.key = "unit", .flags = BR_FOR_PROGRAMS},
        {.key = "printed", .heading = "the paper's value", .flags = BR_FILES_ONLY},
        {.key = "value", .heading = "ours"},
        {.key = "error", .flags = BR_FOR_PROGRAMS},
        {.key = "exact"},
        {.key = "agreement"},
        {.key = "note", .heading = "why", .flags = BR_WRAP | BR_FILES_ONLY},
    };
    size_t count[3] = {0};
    br_document_begin(d, "claims", "beamrate figures", 1, "What section 3.2 of the paper says");
    for (size_t i = 0; br_claims[i]; i++)
        count[finding[i].agreement]++;
    br_put_answer(d, "The paper's claims: %zu agree, %zu differ, %zu undecided.", count[BR_AGREES],
                  count[BR_DIFFERS], count[BR_UNDECIDED]);
    br_put_answer(d,
                  "Ours: by the scheme with h = 1/%zu m and k = 1/%zu s; the bar is the distance "
                  "to the exact solution, or, where there is none, to a second resolution.",
                  n, per_second);
    br_put_table(d, "claims", "The claims", BR_MAIN, BR_COLUMNS(columns));
    for (size_t i = 0; br_claims[i]; i++)
        put_claim(d, br_claims[i], &finding[i]);
}
