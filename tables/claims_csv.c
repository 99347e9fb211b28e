/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line a claim; a number that is not there is an empty field (RFC 4180). */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/claims_emitter.h"

static void number(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.10g", value);
    fputc(',', out);
}

static void quoted(FILE *out, const char *text, char after)
{
    br_quote(out, &br_for_csv, text);
    fputc(after, out);
}

static void emit(FILE *out, const struct br_claims_page *page)
{
    fputs("claim,section,figure,statement,measured,unit,printed,value,error,exact,agreement,note\n",
          out);
    for (size_t i = 0; br_claims[i]; i++) {
        const struct br_claim *c = br_claims[i];
        const struct br_finding *f = &page->finding[i];
        fprintf(out, "%s,%s,", c->name, c->section);
        if (c->figure)
            fprintf(out, "%d", c->figure);
        fputc(',', out);
        quoted(out, c->statement, ',');
        quoted(out, c->measured, ',');
        fprintf(out, "%s,", c->unit);
        number(out, f->printed);
        number(out, f->value);
        number(out, f->error);
        number(out, f->exact);
        fprintf(out, "%s,", br_agreement_name(f->agreement));
        quoted(out, f->note, '\n');
    }
}

const struct br_claims_emitter br_claims_csv = {"csv", ".csv", emit};
