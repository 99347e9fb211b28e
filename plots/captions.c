/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "plots/figures.h"

/* "last time at rest 0.8 +- 0.001 s, exact 0.8 s, the paper 0.68 s" */
static void write_value(FILE *out, const struct br_claim *claim, const struct br_finding *f)
{
    const char *unit = claim->unit[0] == '1' ? "" : claim->unit, *blank = *unit ? " " : "";
    fprintf(out, "%s %.6g", claim->measured, f->value);
    if (isfinite(f->error))
        fprintf(out, " +- %.2g", f->error);
    fprintf(out, "%s%s", blank, unit);
    if (isfinite(f->exact))
        fprintf(out, ", exact %.6g%s%s", f->exact, blank, unit);
    if (isfinite(f->printed))
        fprintf(out, ", the paper %.6g%s%s", f->printed, blank, unit);
}

/* As the claims' table says it, in a sentence. */
static const char *verdict(enum br_agreement agreement)
{
    return agreement == BR_AGREES    ? "We agree"
           : agreement == BR_DIFFERS ? "We differ"
                                     : "This is undecided";
}

static void write_findings(FILE *out, int figure, const struct br_finding *findings,
                           const char *bullet)
{
    for (size_t i = 0; br_claims[i]; i++) {
        if (br_claims[i]->figure != figure)
            continue;
        fprintf(out, "%s\"%s\" %s: ", bullet, br_claims[i]->statement,
                verdict(findings[i].agreement));
        write_value(out, br_claims[i], &findings[i]);
        fprintf(out, "%s%s.\n", *findings[i].note ? "; " : "", findings[i].note);
    }
}

/* What happens at the tip of the exact solution. */
static void write_events(FILE *out, const struct br_example *e, const char *bullet)
{
    fprintf(out, "%sThe exact solution:", bullet);
    for (size_t i = 0; i < e->events; i++)
        fprintf(out, "%s at t = %.6g s %s%s", i ? "," : "", e->event[i].time,
                e->event[i].field == BR_EXACT_BENDING ? "the tip " : "",
                br_phase_text(e->event[i].phase));
    fputs(".\n", out);
}

static void write_caption(FILE *out, const struct br_figure *figure, const struct br_paper *paper,
                          const struct br_finding *findings, const char *bullet)
{
    fprintf(out, "%sThe paper: %s\n", bullet, figure->says);
    write_findings(out, figure->number, findings, bullet);
    write_events(out, &paper->example[figure->example - 1], bullet);
    if (figure->beside)
        fprintf(out, "%s%s\n", bullet, figure->beside);
}

void br_figure_caption(FILE *out, const struct br_figure *figure, const struct br_paper *paper,
                       const struct br_finding *findings)
{
    fprintf(out, "Figure %d. %s (h = 1/%zu m, k = 1/%zu s)\n\n", figure->number, figure->title,
            paper->request.n, paper->request.per_second);
    write_caption(out, figure, paper, findings, "");
}

void br_figures_readme(FILE *out, const struct br_paper *paper, const struct br_finding *findings)
{
    fprintf(
        out,
        "# Figures 2 to 10 of the paper, marched again\n\n"
        "Examples 1 to 4 with h = 1/%zu m and k = 1/%zu s; every figure as a gnuplot script beside "
        "its data,\nand, where gnuplot is installed, as SVG and PNG. What all of section 3.2 says "
        "is in [claims.md](claims.md).\n",
        paper->request.n, paper->request.per_second);
    for (size_t i = 0; br_figures[i]; i++) {
        const struct br_figure *f = br_figures[i];
        fprintf(out, "\n## Figure %d. %s\n\n![Figure %d](figure%d.svg)\n\n", f->number, f->title,
                f->number, f->number);
        write_caption(out, f, paper, findings, "- ");
    }
}
