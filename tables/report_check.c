/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "orders/expectation/comparison.h"
#include "tables/report_cells.h"
#include "tables/reports.h"

const struct br_document_format *const br_check_formats[] = {
    &br_document_text,     &br_document_junit,  &br_document_json,
    &br_document_markdown, &br_document_github, NULL,
};

enum { FIRST_FAILURES = 3 };

/* What is checked, for people: scenes, or sources if some numbers are of other programs. */
static const char *source_of(const struct br_check_findings *f)
{
    for (size_t i = 0; i < f->count; i++)
        if (f->checks[i].of_program)
            return "source";
    return "scene";
}

static const char *at_text(struct br_document *d, const struct br_resolution *at)
{
    return br_format(d, "n = %zu, k = T/%zu", at->n, at->steps);
}

/* Puts the verdict of a case, with its points as details. */
static void put_verdict(struct br_document *d, const struct br_check *check,
                        const struct br_case *c)
{
    static const enum br_outcome outcomes[] = {BR_OUTCOME_PASS, BR_OUTCOME_FAIL,
                                               BR_OUTCOME_INCONCLUSIVE};
    br_put_verdict(d, &(struct br_document_verdict){
                          .outcome = outcomes[c->verdict],
                          .group = check->name,
                          .name = br_format(d, "%s %s%s%s", br_verify_names[c->kind], c->measure,
                                            *c->part ? " " : "", c->part),
                          .message = c->verdict == BR_PASS ? c->note : c->reason,
                          .file = check->no_file ? NULL : check->path,
                          .line = c->expected.line,
                          /* the orders of a study share its marches */
                          .seconds = check->seconds / (double)check->count,
                          .of_row = true,
                      });
    for (size_t i = 0; i < c->points; i++) {
        const struct br_point *p = &c->point[i];
        if (!isfinite(p->error)) {
            br_put_verdict_detail(d, "%s: %s", p->label, *p->failure ? p->failure : "no number");
            continue;
        }
        const char *against = p->against.n        ? at_text(d, &p->against)
                              : p->z_against > 0  ? "the next finer one"
                              : check->of_program ? NULL
                                                  : "the solution";
        br_put_verdict_detail(
            d, "%s%s%s: error %.4e%s%s%s", p->at.n ? at_text(d, &p->at) : p->label,
            against ? " against " : "", against ? against : "", p->error,
            isnan(p->constant) ? "" : br_format(d, ", constant %.4e", p->constant),
            p->flag ? ", left out: " : "", br_flag_name(p->flag));
    }
}

/* Puts the answer of a comparison with an earlier check. now: the version of this program. */
static void answer_comparison(struct br_document *d, const struct br_comparison *c, const char *now)
{
    const size_t serious = c->tally[BR_SERIOUS];
    for (size_t i = 0; i < serious && i < FIRST_FAILURES; i++)
        br_put_answer(d, "FAIL %s: %s", c->difference[i].subject, c->difference[i].remark);
    br_put_answer(d,
                  "Compared with the earlier check: %zu serious, %zu warnings, %zu notes, %zu the "
                  "same",
                  serious, c->tally[BR_WARNING], c->tally[BR_NOTE], c->tally[BR_SAME]);
    if (c->version && strcmp(c->version, now) != 0)
        br_put_more(d, "; the earlier check is by beamrate %s, this one by %s", c->version, now);
}

/* Puts the differences. Each serious one is a verdict, too: it fails. */
static void put_comparison(struct br_document *d, const struct br_comparison *c)
{
    br_put_table(d, "differences", "Compared with the earlier check", BR_LONG);
    for (const struct br_difference *x = c->difference; x < c->difference + c->count; x++) {
        br_put_row(d);
        BR_PUT(d, br_text(br_severity_names[x->severity]), .key = "severity");
        BR_PUT(d, br_text(x->subject), .key = "subject", .heading = "what");
        BR_PUT(d, br_number(x->before), .key = "before");
        BR_PUT(d, br_number(x->now), .key = "now");
        BR_PUT(d, br_text(*x->remark ? x->remark : NULL), .key = "remark");
        br_put_shown(d, "%s", x->remark);
        if (x->severity == BR_SERIOUS)
            br_put_verdict(d, &(struct br_document_verdict){
                                  .outcome = BR_OUTCOME_FAIL,
                                  .group = "baseline",
                                  .name = x->subject,
                                  .message = x->remark,
                                  .file = x->check && !x->check->no_file ? x->check->path : NULL,
                                  .of_row = true,
                              });
    }
}

/* Puts the order of a case, and its verdict. */
static void put_case(struct br_document *d, const char *source, const struct br_check *check,
                     const struct br_case *c)
{
    const struct br_expectation *e = &c->expected;
    br_put_row(d);
    BR_PUT(d, br_text(br_verdict_names[c->verdict]), .key = "verdict");
    BR_PUT(d, br_text(check->name), .key = "scene", .heading = source);
    BR_PUT(d, br_text(br_verify_names[c->kind]), .key = "study");
    BR_PUT(d, br_text(c->measure), .key = "norm");
    BR_PUT(d, br_text(c->part), .key = "part");
    BR_PUT(d, br_number(e->order), .key = "expected");
    br_put_shown(d, "%s", br_expectation_text(e, (char[BR_EXPECTATION_TEXT]){0}));
    br_hide(d, "tolerance", NULL, br_if(e->tolerance > 0, br_number(e->tolerance)));
    br_hide(d, "highest", NULL, br_if(e->highest > 0, br_number(e->highest)));
    br_hide(d, "why", NULL, br_text(*e->why ? e->why : NULL));
    br_hide(d, "law", NULL, br_text(c->law ? br_law_text(c->law) : NULL)); /* errors show it, too */
    BR_PUT_ESTIMATE(d, "", &c->order, br_order_shown(d, &c->order), .key = "order",
                    .heading = "observed order");
    BR_PUT(d, br_number(c->margin), .key = "margin", .format = "%+.3f", .flags = BR_FILES_ONLY);
    BR_PUT(d, br_number(c->constant), .key = "constant", .format = "%.3e");
    br_hide(d, "floor", NULL, br_number(e->floor));
    BR_PUT(d, br_number(e->ceiling), .key = "ceiling", .heading = "allowed range");
    if (isfinite(e->floor))
        br_put_shown(d, "%g to %g", e->floor, e->ceiling);
    else if (isfinite(e->ceiling))
        br_put_shown(d, "at most %g", e->ceiling);
    put_verdict(d, check, c);
}

static void put_point(struct br_document *d, const struct br_check *check, const struct br_case *c,
                      const struct br_point *p)
{
    br_put_row(d);
    BR_PUT(d, br_text(check->name), .key = "scene");
    BR_PUT(d, br_text(br_verify_names[c->kind]), .key = "study");
    BR_PUT(d, br_text(c->measure), .key = "norm");
    BR_PUT(d, br_text(c->part), .key = "part");
    BR_PUT(d, br_if(p->at.n, br_count(p->at.n)), .key = "n");
    BR_PUT(d, br_if(p->at.n, br_count(p->at.steps)), .key = "steps");
    BR_PUT(d, br_count(p->against.n), .key = "against_n");
    BR_PUT(d, br_count(p->against.steps), .key = "against_steps");
    BR_PUT(d, br_number(p->error), .key = "error");
    BR_PUT(d, br_number(p->constant), .key = "constant");
    BR_PUT(d, br_truth(!p->flag), .key = "used");
    BR_PUT(d, br_text(br_flag_name(p->flag)), .key = "flag");
    BR_PUT(d, br_text(p->failure), .key = "failure");
    BR_PUT(d, br_text(p->label), .key = "at");
}

static void put_source(struct br_document *d, const struct br_check *c)
{
    br_put_row(d);
    BR_PUT(d, br_text(c->name), .key = "scene");
    BR_PUT(d, br_text(c->path), .key = "path");
    BR_PUT(d, br_truth(c->defaults != NULL), .key = "by_default");
    BR_PUT(d, br_number(c->seconds), .key = "seconds");
    BR_PUT(d, br_number(c->element_steps), .key = "element_steps");
    BR_PUT(d, br_failure_text(&c->failure), .key = "failure");
    BR_PUT(d, br_text(*c->problem ? c->problem : NULL), .key = "problem");
    BR_PUT(d, br_text(c->data), .key = "data");
}

void br_report_check(const struct br_check_findings *f, struct br_document *d)
{
    br_document_begin(d, "check", "beamrate check", 2, "Orders of convergence");

    if (f->comparison)
        answer_comparison(d, f->comparison, f->provenance->version);
    const struct br_check *first;
    const size_t refused = br_check_failures(f->checks, f->count, &first);
    const struct br_check *end = f->checks + f->count;
    const char *source = source_of(f);
    size_t orders = 0, of[BR_INCONCLUSIVE + 1];
    for (const struct br_check *c = f->checks; c < end; c++)
        orders += c->count;
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        of[v] = br_check_tally(f->checks, f->count, (enum br_verdict)v);
    br_put_answer(d, "%zu order%s in %zu %s%s: %zu PASS, %zu FAIL, %zu INCONCLUSIVE", orders,
                  orders == 1 ? "" : "s", f->count, source, f->count == 1 ? "" : "s", of[BR_PASS],
                  of[BR_FAIL], of[BR_INCONCLUSIVE]);
    if (refused)
        br_put_more(d, ", %zu cannot be verified", refused);
    br_put_more(d, "; %.1f s", f->wall_seconds);
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        br_hide_fact(d, br_count(of[v]), NULL, "tally.%s", br_verdict_names[v]);
    br_hide_fact(d, br_number(f->wall_seconds), NULL, "wall_seconds");

    br_put_table(d, "orders", "All orders", BR_MAIN | BR_LONG);
    for (const struct br_check *c = f->checks; c < end; c++) {
        if (c->failure.status)
            br_put_verdict(d, &(struct br_document_verdict){.outcome = BR_OUTCOME_ERROR,
                                                            .group = c->name,
                                                            .name = "verify",
                                                            .message = c->failure.message,
                                                            .file = c->no_file ? NULL : c->path,
                                                            .seconds = c->seconds});
        for (size_t j = 0; j < c->count; j++)
            put_case(d, source, c, &c->cases[j]);
    }

    if (f->comparison)
        put_comparison(d, f->comparison);

    /* For people, the points are details of the verdicts. */
    br_put_table(d, "points", "Errors", BR_FOR_PROGRAMS);
    for (const struct br_check *c = f->checks; c < end; c++)
        for (size_t j = 0; j < c->count; j++)
            for (size_t i = 0; i < c->cases[j].points; i++)
                put_point(d, c, &c->cases[j], &c->cases[j].point[i]);

    /* The methods are facts: "methods.0.space" is that of the study over h of the first scene. */
    br_put_table(d, "scenes", "Scenes", BR_FOR_PROGRAMS);
    for (const struct br_check *c = f->checks; c < end; c++)
        put_source(d, c);
    for (size_t i = 0; i < f->count; i++)
        for (int kind = 0; kind < BR_VERIFY_KINDS && f->checks[i].method; kind++)
            br_put_settings(d, br_format(d, "methods.%zu.%s", i, br_verify_names[kind]),
                            &f->checks[i].method[kind]);
    for (size_t i = 0; i < f->count; i++) /* as a file would state them */
        br_put_command(d, br_format(d, "defaults.%zu", i),
                       br_format(d, "%s has no verify part. To begin, paste these defaults",
                                 f->checks[i].path),
                       f->checks[i].defaults);

    br_put_provenance(d, f->provenance);
}
