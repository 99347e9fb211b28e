/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "orders/estimate.h"
#include "study/paper/paper.h"
#include "tables/beam/reports.h"

/* "0.7990 +- 0.0020 s"; where the error is less than what four digits show: "1.009" */
static void show_value(struct br_document *d, double value, double error, const char *unit)
{
    char text[64];
    const char *named = strcmp(unit, "1") == 0 ? "" : unit;
    if (isfinite(value) && error < 5e-5 * fabs(value))
        br_put_shown(d, "%.4g%s%s", value, *named ? " " : "", named);
    else if (isfinite(value))
        br_put_shown(d, "%s%s%s", br_uncertain_text(value, error, text, sizeof text),
                     *named ? " " : "", named);
}

void br_report_claims(const struct br_finding *finding, size_t n, size_t per_second,
                      struct br_document *d)
{
    size_t count[3] = {0};
    br_document_begin(d, "claims", "beamrate figures", 1, "What section 3.2 of the paper says");
    for (size_t i = 0; br_claims[i].name; i++)
        count[finding[i].agreement]++;
    br_put_answer(d, "The paper's claims: %zu agree, %zu differ, %zu undecided.", count[BR_AGREES],
                  count[BR_DIFFERS], count[BR_UNDECIDED]);
    br_put_answer(d,
                  "Our values come from the scheme with h = 1/%zu m and k = 1/%zu s. The error bar "
                  "is the distance to the exact solution or, where there is none, to a second "
                  "resolution.",
                  n, per_second);
    br_put_table(d, "claims", "The claims", BR_MAIN);
    for (size_t i = 0; br_claims[i].name; i++) {
        const struct br_claim *c = &br_claims[i];
        const struct br_finding *f = &finding[i];
        br_put_row(d);
        BR_PUT(d, br_text(br_agreement_names[f->agreement]), .key = "agreement");
        BR_PUT(d, br_text(c->name), .key = "claim", .flags = BR_FOR_PROGRAMS);
        BR_PUT(d, br_text(c->section), .key = "section");
        BR_PUT(d, br_if(c->figure, br_count((size_t)c->figure)), .key = "figure",
               .flags = BR_FOR_PROGRAMS);
        BR_PUT(d, br_text(c->statement), .key = "statement", .heading = "the paper",
               .flags = BR_WRAP);
        BR_PUT(d, br_text(c->measured), .key = "measured", .flags = BR_WRAP | BR_FILES_ONLY);
        BR_PUT(d, br_text(c->unit), .key = "unit", .flags = BR_FOR_PROGRAMS);
        BR_PUT(d, br_number(f->printed), .key = "printed", .heading = "the paper's value",
               .flags = BR_FILES_ONLY);
        show_value(d, f->printed, NAN, c->unit);
        BR_PUT(d, br_number(f->value), .key = "value", .heading = "ours");
        show_value(d, f->value, f->error, c->unit);
        BR_PUT(d, br_number(f->error), .key = "error", .flags = BR_FOR_PROGRAMS);
        BR_PUT(d, br_number(f->exact), .key = "exact");
        show_value(d, f->exact, NAN, c->unit);
        BR_PUT(d, br_text(*f->note ? f->note : NULL), .key = "note", .heading = "why",
               .flags = BR_WRAP | BR_FILES_ONLY);
    }
}
