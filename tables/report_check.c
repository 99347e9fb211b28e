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

enum { NAME = 96, FIRST_FAILURES = 3 }; /* a column of `orders` has a name of 63 bytes at most */

/* "space l2 axial" */
static const char *name_of(const struct br_case *c, char name[NAME])
{
    snprintf(name, NAME, "%s %s%s%s", br_verify_names[c->kind], c->measure, *c->part ? " " : "",
             c->part);
    return name;
}

/* What is checked, for people: scenes, or sources if some numbers are of other programs. */
static const char *source_of(const struct br_check_findings *f)
{
    for (size_t i = 0; i < f->count; i++)
        if (f->checks[i].of_program)
            return "source";
    return "scene";
}

/* Puts the verdict of a case, with its points as details. */
static void put_verdict(struct br_document *d, const struct br_check *check,
                        const struct br_case *c)
{
    static const enum br_outcome outcomes[] = {BR_OUTCOME_PASS, BR_OUTCOME_FAIL,
                                               BR_OUTCOME_INCONCLUSIVE};
    char name[NAME], at[NAME], against[NAME], constant[40];
    br_put_verdict(d, &(struct br_document_verdict){
                          .outcome = outcomes[c->verdict],
                          .group = check->name,
                          .name = name_of(c, name),
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
        snprintf(against, sizeof against, "n = %zu, k = T/%zu", p->against.n, p->against.steps);
        snprintf(at, sizeof at, "n = %zu, k = T/%zu", p->at.n, p->at.steps);
        *constant = '\0';
        if (!isnan(p->constant))
            snprintf(constant, sizeof constant, ", constant %.4e", p->constant);
        br_put_verdict_detail(d, "%s against %s: error %.4e%s%s%s", p->at.n ? at : p->label,
                              p->against.n       ? against
                              : p->z_against > 0 ? "the next finer one"
                                                 : "the solution",
                              p->error, constant, p->flag ? ", left out: " : "",
                              br_flag_name(p->flag));
    }
}

/* The default expectations, as a file would state them. */
static void put_defaults(struct br_document *d, const struct br_check *check, size_t number)
{
    char key[NAME], label[1200];
    snprintf(key, sizeof key, "defaults.%zu", number);
    snprintf(label, sizeof label, "%s has no verify part. To begin, paste these defaults",
             check->path);
    br_put_command(d, key, label, check->defaults);
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
    static const struct br_column columns[] = {
        {.key = "severity"}, {.key = "subject", .heading = "what"},
        {.key = "before"},   {.key = "now"},
        {.key = "remark"},
    };
    BR_TABLE(d, "differences", "Compared with the earlier check", BR_LONG, columns);
    for (const struct br_difference *x = c->difference; x < c->difference + c->count; x++) {
        BR_PUT_ROW(d, br_text(br_severity_names[x->severity]), br_text(x->subject),
                   br_number(x->before), br_number(x->now), br_text(*x->remark ? x->remark : NULL));
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

void br_report_check(const struct br_check_findings *f, struct br_document *d)
{
    br_document_begin(d, "check", "beamrate check", 2, "Orders of convergence");

    if (f->comparison)
        answer_comparison(d, f->comparison, f->provenance->version);
    const struct br_check *first;
    const size_t refused = br_check_failures(f->checks, f->count, &first);
    size_t orders = 0, of[BR_INCONCLUSIVE + 1];
    for (size_t i = 0; i < f->count; i++)
        orders += f->checks[i].count;
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        of[v] = br_check_tally(f->checks, f->count, (enum br_verdict)v);
    br_put_answer(d, "%zu order%s in %zu %s%s: %zu PASS, %zu FAIL, %zu INCONCLUSIVE", orders,
                  orders == 1 ? "" : "s", f->count, source_of(f), f->count == 1 ? "" : "s",
                  of[BR_PASS], of[BR_FAIL], of[BR_INCONCLUSIVE]);
    if (refused)
        br_put_more(d, ", %zu cannot be verified", refused);
    br_put_more(d, "; %.1f s", f->wall_seconds);
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        br_hide_fact(d, br_count(of[v]), NULL, "tally.%s", br_verdict_names[v]);
    br_hide_fact(d, br_number(f->wall_seconds), NULL, "wall_seconds");

    const struct br_column orders_columns[] = {
        {.key = "verdict"},
        {.key = "scene", .heading = source_of(f)},
        {.key = "study"},
        {.key = "norm"},
        {.key = "part"},
        {.key = "expected"},
        {.key = "tolerance", .flags = BR_FOR_PROGRAMS},
        {.key = "highest", .flags = BR_FOR_PROGRAMS},
        {.key = "why", .flags = BR_FOR_PROGRAMS},
        {.key = "law", .flags = BR_FOR_PROGRAMS}, /* that the errors also show */
        {.key = "order", .heading = "observed order"},
        {.key = "low", .flags = BR_FOR_PROGRAMS},
        {.key = "high", .flags = BR_FOR_PROGRAMS},
        {.key = "margin", .format = "%+.3f", .flags = BR_FILES_ONLY},
        {.key = "constant", .format = "%.3e"},
        {.key = "floor", .flags = BR_FOR_PROGRAMS},
        {.key = "ceiling", .heading = "allowed range"},
    };
    char order[NAME], expected[BR_EXPECTATION_TEXT];
    BR_TABLE(d, "orders", "All orders", BR_MAIN | BR_LONG, orders_columns);
    for (size_t i = 0; i < f->count; i++) {
        const struct br_check *check = &f->checks[i];
        if (check->failure.status)
            br_put_verdict(
                d, &(struct br_document_verdict){.outcome = BR_OUTCOME_ERROR,
                                                 .group = check->name,
                                                 .name = "verify",
                                                 .message = check->failure.message,
                                                 .file = check->no_file ? NULL : check->path,
                                                 .seconds = check->seconds});
        for (size_t j = 0; j < check->count; j++) {
            const struct br_case *c = &check->cases[j];
            const struct br_expectation *e = &c->expected;
            BR_PUT_ROW(d, br_text(br_verdict_names[c->verdict]), br_text(check->name),
                       br_text(br_verify_names[c->kind]), br_text(c->measure), br_text(c->part),
                       br_number(e->order));
            br_put_shown(d, "%s", br_expectation_text(e, expected));
            BR_PUT_CELLS(d, br_if(e->tolerance > 0, br_number(e->tolerance)),
                         br_if(e->highest > 0, br_number(e->highest)),
                         br_text(*e->why ? e->why : NULL),
                         br_text(c->law ? br_law_text(c->law) : NULL), br_number(c->order.value));
            br_put_shown(d, "%s", br_order_text(&c->order, order, sizeof order));
            BR_PUT_CELLS(d, br_number(c->order.low), br_number(c->order.high), br_number(c->margin),
                         br_number(c->constant), br_number(e->floor), br_number(e->ceiling));
            if (isfinite(e->floor))
                br_put_shown(d, "%g to %g", e->floor, e->ceiling);
            else if (isfinite(e->ceiling))
                br_put_shown(d, "at most %g", e->ceiling);
            put_verdict(d, check, c);
        }
    }

    if (f->comparison)
        put_comparison(d, f->comparison);

    /* For people, the points are details of the verdicts. */
    static const struct br_column points_columns[] = {
        {.key = "scene"},   {.key = "study"},    {.key = "norm"},      {.key = "part"},
        {.key = "n"},       {.key = "steps"},    {.key = "against_n"}, {.key = "against_steps"},
        {.key = "error"},   {.key = "constant"}, {.key = "used"},      {.key = "flag"},
        {.key = "failure"}, {.key = "at"},
    };
    BR_TABLE(d, "points", "Errors", BR_FOR_PROGRAMS, points_columns);
    for (size_t i = 0; i < f->count; i++)
        for (size_t j = 0; j < f->checks[i].count; j++) {
            const struct br_case *c = &f->checks[i].cases[j];
            for (const struct br_point *p = c->point; p < c->point + c->points; p++)
                BR_PUT_ROW(d, br_text(f->checks[i].name), br_text(br_verify_names[c->kind]),
                           br_text(c->measure), br_text(c->part), br_if(p->at.n, br_count(p->at.n)),
                           br_if(p->at.n, br_count(p->at.steps)), br_count(p->against.n),
                           br_count(p->against.steps), br_number(p->error), br_number(p->constant),
                           br_truth(!p->flag), br_text(br_flag_name(p->flag)), br_text(p->failure),
                           br_text(p->label));
        }

    /* The methods are facts: "methods.0.space" is that of the study over h of the first scene. */
    static const struct br_column scenes_columns[] = {
        {.key = "scene"},         {.key = "path"},    {.key = "by_default"}, {.key = "seconds"},
        {.key = "element_steps"}, {.key = "failure"}, {.key = "problem"},    {.key = "data"},
    };
    char key[NAME];
    BR_TABLE(d, "scenes", "Scenes", BR_FOR_PROGRAMS, scenes_columns);
    for (const struct br_check *c = f->checks; c < f->checks + f->count; c++)
        BR_PUT_ROW(d, br_text(c->name), br_text(c->path), br_truth(c->defaults != NULL),
                   br_number(c->seconds), br_number(c->element_steps), br_failure_text(&c->failure),
                   br_text(*c->problem ? c->problem : NULL), br_text(c->data));
    for (size_t i = 0; i < f->count; i++)
        for (int kind = 0; kind < BR_VERIFY_KINDS && f->checks[i].method; kind++) {
            snprintf(key, sizeof key, "methods.%zu.%s", i, br_verify_names[kind]);
            br_put_settings(d, key, &f->checks[i].method[kind]);
        }
    for (size_t i = 0; i < f->count; i++)
        put_defaults(d, &f->checks[i], i);

    br_put_provenance(d, f->provenance);
}
