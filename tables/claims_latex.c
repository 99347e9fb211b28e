/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A LaTeX table to \input; it needs the booktabs and longtable packages. */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/claims_emitter.h"

static void cell(FILE *out, const char *text)
{
    br_quote(out, &br_for_latex, text);
    fputs(" & ", out);
}

static void emit(FILE *out, const struct br_claims_page *page)
{
    char buffer[64];
    fprintf(out,
            "%% beamrate %s (%s), %s; needs \\usepackage{booktabs,longtable}\n"
            "\\begin{longtable}{lp{0.3\\textwidth}p{0.22\\textwidth}p{0.13\\textwidth}"
            "p{0.13\\textwidth}l}\n"
            "\\caption{What section 3.2 says: %s; $h = 1/%zu$ m, $k = 1/%zu$ s}\\\\\n\\toprule\n"
            "section & the paper & measured & ours & exact & \\\\\n\\midrule\n\\endhead\n",
            page->provenance->version, page->provenance->commit, page->provenance->date,
            br_claims_summary(page, buffer, sizeof buffer), page->n, page->per_second);
    for (size_t i = 0; br_claims[i]; i++) {
        const struct br_claim *c = br_claims[i];
        const struct br_finding *f = &page->finding[i];
        cell(out, c->section);
        cell(out, c->statement);
        cell(out, c->measured);
        cell(out, br_claim_value(f->value, f->error, c->unit, buffer, sizeof buffer));
        cell(out, br_claim_value(f->exact, NAN, c->unit, buffer, sizeof buffer));
        fprintf(out, "%s \\\\\n", br_agreement_name(f->agreement));
    }
    fputs("\\bottomrule\n\\end{longtable}\n", out);
}

const struct br_claims_emitter br_claims_latex = {"latex", ".tex", emit};
