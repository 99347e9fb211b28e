/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/claims_emitter.h"

static void cell(FILE *out, const char *text)
{
    br_quote(out, &br_for_markdown, text);
    fputs(" | ", out);
}

static void emit(FILE *out, const struct br_claims_page *page)
{
    char buffer[64];
    fprintf(out,
            "# What section 3.2 of the paper says\n\n"
            "By the scheme with h = 1/%zu m and k = 1/%zu s; the bar is the distance to the exact "
            "solution, or, where there is none, to a second resolution. %s.\n\n"
            "| section | the paper | measured | the paper's value | ours | exact | | why |\n"
            "|---|---|---|---:|---:|---:|---|---|\n",
            page->n, page->per_second, br_claims_summary(page, buffer, sizeof buffer));
    for (size_t i = 0; br_claims[i]; i++) {
        const struct br_claim *c = br_claims[i];
        const struct br_finding *f = &page->finding[i];
        fputs("| ", out);
        cell(out, c->section);
        cell(out, c->statement);
        cell(out, c->measured);
        cell(out, br_claim_value(f->printed, NAN, c->unit, buffer, sizeof buffer));
        cell(out, br_claim_value(f->value, f->error, c->unit, buffer, sizeof buffer));
        cell(out, br_claim_value(f->exact, NAN, c->unit, buffer, sizeof buffer));
        fprintf(out, "**%s** | ", br_agreement_name(f->agreement));
        br_quote(out, &br_for_markdown, f->note);
        fputs(" |\n", out);
    }
    fprintf(out, "\nbeamrate %s (%s), %s\n", page->provenance->version, page->provenance->commit,
            page->provenance->date);
}

const struct br_claims_emitter br_claims_markdown = {"markdown", ".md", emit};
