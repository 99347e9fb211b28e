/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate figures: Figures 2 to 10 of the paper, and what its section 3.2 says. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/documents.h"
#include "cli/picture_files.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/warn.h"
#include "plots/pictures.h"
#include "study/paper/claims.h"
#include "study/ranks/ranks.h"
#include "tables/reports.h"

struct run {
    const struct br_options *options;
    struct br_paper paper;
    struct br_finding finding[BR_MOST_CLAIMS];
    struct br_output output;
    struct br_document claims;
    struct br_picture_files pictures;
};

/* The paper's words on a figure, and what happens at the tip of the exact solution. */
static void put_caption(struct br_document *d, const struct br_paper_figure *f,
                        const struct br_example *e)
{
    char text[600] = "The exact solution:";
    for (size_t i = 0; i < e->events; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s at t = %.6g s %s%s",
                 i ? "," : "", e->event[i].time,
                 e->event[i].field == BR_EXACT_BENDING ? "the tip " : "",
                 br_phase_text(e->event[i].phase));
    br_put_note(d, "Figure %d. The paper: %s", f->number, f->says);
    br_put_note(d, "%s.", text);
    if (f->beside)
        br_put_note(d, "%s", f->beside);
}

static enum br_status write_figure(struct run *r, const struct br_paper_figure *f,
                                   struct br_error *err)
{
    struct br_figure figure;
    enum br_status status = br_paper_figure_draw(f, &r->paper, &figure, err);
    if (!status)
        status = br_picture_files_draw(&r->pictures, &figure, err);
    br_put_picture(&r->claims, figure.stem, figure.title);
    put_caption(&r->claims, f, &r->paper.example[f->example - 1]);
    br_figure_clear(&figure);
    return status;
}

/* The figures first: they are rendered while the tables are written. */
static enum br_status write_all(struct run *r, struct br_error *err)
{
    enum br_status status = BR_OK;
    r->pictures.output = &r->output;
    for (const struct br_paper_figure *f = br_paper_figures; f->number && !status; f++)
        status = write_figure(r, f, err);
    if (!status)
        status = br_documents_write(&r->pictures, r->options, &r->claims, 1, err);
    const enum br_status drawn = br_picture_files_finish(&r->pictures, status ? NULL : err);
    if (!status)
        status = drawn;
    if (!status)
        status = br_output_commit(&r->output, err);
    if (!status && !br_option_given(r->options, BR_OPT_QUIET)) {
        status = br_documents_show(&r->claims, 1, err);
        br_output_announce(&r->output);
    }
    return status;
}

static void report(struct run *r)
{
    struct br_provenance provenance;
    br_provenance_fill(&provenance, (int)br_option_number(r->options, BR_OPT_THREADS, 0));
    br_report_claims(r->finding, r->paper.request.n, r->paper.request.per_second, &r->claims);
    br_put_provenance(&r->claims, &provenance);
}

static enum br_status compute(struct run *r, struct br_error *err)
{
    struct br_paper_request request = br_paper_request_default();
    request.threads = (int)br_option_number(r->options, BR_OPT_THREADS, 0);
    const bool quiet = br_option_given(r->options, BR_OPT_QUIET) || !br_ranks_first();
    const struct br_observer *observer = br_progress_start("marching", quiet);
    const enum br_status status = br_paper_run(&r->paper, &request, observer, err);
    br_progress_end();
    for (size_t i = 0; br_claims[i].name && !status; i++)
        r->finding[i] = br_claim_measure(&br_claims[i], &r->paper);
    if (!status)
        report(r);
    return status;
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    struct run r = {.options = options};
    const bool writes = br_ranks_first();
    enum br_status status = BR_OK;
    if (writes)
        status = br_output_open(&r.output, br_option_text(options, BR_OPT_OUT), err);
    if (writes && !status)
        status = br_warn_of_paper(err);
    if (!status)
        status = compute(&r, err); /* on every rank: it takes a second */
    if (writes && !status)
        status = write_all(&r, err);
    br_document_clear(&r.claims);
    br_paper_clear(&r.paper);
    br_output_discard(&r.output);
    return status;
}

const struct br_command br_command_figures = {
    .bit = BR_FOR_FIGURES,
    .name = "figures",
    .arguments = "",
    .title = "the paper's Figures 2 to 10, and what its section 3.2 says beside what we find",
    .about =
        "Figures 2 to 10 of the paper from Examples 1 to 4 at h = k = 1e-3, each as a gnuplot "
        "script, data, SVG and PNG; and every statement of section 3.2 with our value, its error "
        "bar, and whether they agree (claims.txt, .csv, .md, .tex, .json). All of these but .csv and "
        ".json show the figures with their captions, as report.html does.",
    .example = {"beamrate figures --out figures"},
    .run = run,
};
