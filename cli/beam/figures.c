/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate figures: Figures 2 to 10 of the paper, and what its section 3.2 says. */
#include <stdio.h>

#include "base/words.h"
#include "cli/beam/session.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "plots/beam/pictures.h"
#include "study/paper/paper.h"
#include "tables/beam/reports.h"

struct figures_run {
    struct br_session *session; /* borrowed */
    struct br_paper paper;
};

/* Writes what the paper says of a figure, and the events at the tip of the exact solution. */
static void put_caption(struct br_document *d, const struct br_paper_figure *f,
                        const struct br_example *e)
{
    char text[600] = "The exact solution:";
    for (size_t i = 0; i < e->events; i++)
        br_append(text, sizeof text, "%s at t = %.6g s %s%s", i ? "," : "", e->event[i].time,
                  e->event[i].field == BR_BENDING ? "the tip " : "",
                  br_phase_text(e->event[i].phase));
    br_put_note(d, "Figure %d. The paper: %s", f->number, f->says);
    br_put_note(d, "%s.", text);
    if (f->beside)
        br_put_note(d, "%s", f->beside);
}

static enum br_status write_all(struct figures_run *r, struct br_error *err)
{
    struct br_provenance provenance;
    br_provenance_fill(&provenance, r->session->threads);
    struct br_finding finding[BR_MOST_CLAIMS];
    if (br_session_report(r->session, 1, err))
        return err->status;
    struct br_document *d = r->session->document;
    for (size_t i = 0; br_claims[i].name; i++)
        finding[i] = br_claim_measure(&br_claims[i], &r->paper);
    br_report_claims(finding, r->paper.request.n, r->paper.request.per_second, d);
    for (const struct br_paper_figure *f = br_paper_figures; f->number; f++) {
        br_session_draw(r->session, d, br_paper_figure_draw(f, &r->paper), NULL);
        put_caption(d, f, &r->paper.example[f->example - 1]);
    }
    br_put_provenance(d, &provenance);
    return br_session_finish(r->session, err);
}

static enum br_status run(const struct br_options *options, struct br_session *session,
                          struct br_error *err)
{
    (void)options;
    struct figures_run r = {.session = session};
    struct br_paper_request request = br_paper_request_default();
    const bool writes = r.session->writes;
    request.threads = r.session->threads;
    bool failed = br_session_open(r.session, err) || (writes && br_warn_of_paper(err));
    if (!failed) { /* on every rank: it takes a second */
        const struct br_observer *observer = br_progress_start("marching", r.session->quiet);
        failed = br_paper_run(&r.paper, &request, observer, err);
        br_progress_end();
    }
    failed = failed || (writes && write_all(&r, err));
    br_paper_clear(&r.paper);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_figures = {
    .bit = BR_FOR_FIGURES,
    .name = "figures",
    .arguments = "",
    .title = "the paper's Figures 2 to 10, and the statements of its section 3.2 beside our values",
    .about =
        "Figures 2 to 10 of the paper from Examples 1 to 4 at h = k = 1e-3, each as a gnuplot "
        "script, data, SVG and PNG; and every statement of section 3.2 with our value, its error "
        "bar, and whether they agree (claims.txt, .csv, .md, .tex, .json). All formats but .csv "
        "and .json show the figures with their captions; report.html does, too.",
    .example = {"figures --out figures"},
    .run = run,
};
