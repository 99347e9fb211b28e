/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/claims_emitter.h"

#include <math.h>

static void emit(FILE *out, const struct br_claims_page *page)
{
    char value[64], exact[64], summary[64];
    fprintf(out, "What section 3.2 says, with h = 1/%zu m and k = 1/%zu s\n\n", page->n,
            page->per_second);
    for (size_t i = 0; br_claims[i]; i++) {
        const struct br_claim *c = br_claims[i];
        const struct br_finding *f = &page->finding[i];
        fprintf(out, "%-9s %s  %s\n%-16s %s: %s, exact %s\n", br_agreement_name(f->agreement),
                c->section, c->statement, "", c->measured,
                br_claim_value(f->value, f->error, c->unit, value, sizeof value),
                br_claim_value(f->exact, NAN, c->unit, exact, sizeof exact));
    }
    fprintf(out, "\n%s\n", br_claims_summary(page, summary, sizeof summary));
}

const struct br_claims_emitter br_claims_text = {"text", NULL, emit};
