/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What follows from the errors of a study: the joint fits, contradictions in the printed table; and
 * all its facts, for programs. */

#include "solver/scene.h"
#include "study/fit/report.h"
#include "tables/beam/report_parts.h"

/* ---- fits ---- */

/* People do not see the numbers of a fit that does not describe the errors, nor an order of it that
 * is not the answer: no page has two answers to one question. */
void br_put_study_fits(struct br_document *d, const struct br_report *r)
{
    static const char *const kinds[] = {"space and time", "time", "space"};
    static const char *const orders[] = {"p", "q"}, *const headings[] = {"p [95 %]", "q [95 %]"},
                             *const constants[] = {"C_h", "C_k"};
    bool shown = false;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        shown |=
            br_part_is_shown(r, part) && br_joint_describes(&r->fits[part].joint) && !r->printed;
    br_put_table(d, "fits", "Joint fit of the signed errors C_h h^p and C_k k^q",
                 shown ? 0 : BR_FILES_ONLY);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        const struct br_joint_fit *j = &r->fits[part].joint;
        const bool claims = br_joint_describes(j);
        char text[128];
        if (!br_part_is_shown(r, part))
            continue;
        br_put_row(d);
        BR_PUT(d, br_text(br_part_names[part]), .key = "part");
        BR_PUT(d, br_text(kinds[j->kind]), .key = "model", .heading = "error in",
               .flags = BR_FILES_ONLY);
        if (!j->converged)
            br_put_shown(d, "none");
        for (int a = 0; a < BR_AXES; a++) {
            const bool sure = r->observed[part][a].joint; /* else another order is the answer */
            BR_PUT_ESTIMATE(d, &j->order[a],
                            sure     ? br_order_text(&j->order[a], text, sizeof text)
                            : claims ? "not used"
                                     : "-",
                            .key = orders[a], .heading = headings[a]);
            BR_PUT_ESTIMATE(d, &j->c[a], claims ? NULL : "-", .key = constants[a],
                            .format = "%.3g");
        }
        BR_PUT_ESTIMATE(d, &j->r, claims ? br_interval_text(&j->r, text, sizeof text) : "-",
                        .key = "r", .heading = "r [95 %]");
        BR_PUT(d, br_number(j->misfit), .key = "misfit", .format = "%.2g");
        BR_PUT(d, br_number(j->worst), .key = "worst", .format = "%.2g", .flags = BR_FILES_ONLY);
        BR_PUT(d, br_number(j->r_squared), .key = "r_squared", .heading = "R^2", .format = "%.6f",
               .flags = BR_FILES_ONLY);
        BR_PUT(d, br_count(j->points), .key = "points", .heading = "cells");
        br_hide(d, "degrees_of_freedom", NULL, br_count(j->freedom));
        BR_PUT(d, br_truth(j->converged), .key = "converged", .flags = BR_FILES_ONLY);
        BR_PUT(d, br_truth(claims), .key = "describes_the_errors", .heading = "usable",
               .flags = BR_FILES_ONLY);
        br_hide(d, "reference_error", r->study->norm->unit,
                br_number(r->fits[part].reference_error));
    }
}

/* ---- contradictions ---- */

void br_put_triangles(struct br_document *d, const struct br_report *r)
{
    static const struct br_column columns[] = {
        {.key = "a_n", .heading = "n"},
        {.key = "a_k", .heading = "k", .unit = "s"},
        {.key = "b_n", .heading = "and n"},
        {.key = "b_k", .heading = "k", .unit = "s"},
        {.key = "printed_a", .heading = "printed", .format = "%.3e"},
        {.key = "printed_b", .heading = "and", .format = "%.3e"},
        {.key = "least", .heading = "need at least", .format = "%.2e"},
        {.key = "most", .heading = "at most", .format = "%.2e"},
        {.key = "distance", .heading = "are apart", .format = "%.2e"},
        {.key = "contradiction"},
    };
    if (!r->printed)
        return;
    BR_TABLE(d, "triangles", "Pairs of printed cells (triangle inequality), m^(3/2)", BR_FILES_ONLY,
             columns);
    for (size_t i = 0; i < r->triangles; i++) {
        const struct br_triangle *t = &r->triangle[i];
        BR_PUT_ROW(d, br_count(t->a.n), br_number(br_time_step(r->study->scene, t->a.steps)),
                   br_count(t->b.n), br_number(br_time_step(r->study->scene, t->b.steps)),
                   br_number(t->printed_a), br_number(t->printed_b), br_number(t->least),
                   br_number(t->most), br_number(t->distance), br_truth(t->contradiction));
    }
    br_put_note(d, "For every reference, the distance of two solutions is at least the difference "
                   "of their errors, and at most the sum. The last column but one is the distance "
                   "of the scheme's own solutions.");
}

/* ---- facts ---- */

static void put_reference(struct br_document *d, const char *key, const struct br_study *s)
{
    static const char *const own[] = {"own_error", "own_axial_error", "own_bending_error"};
    const char *unit = s->norm->unit;
    char method[64];
    br_hide_fact(d, br_text(s->reference_kind->name), NULL, "%s.kind", key);
    br_hide_fact(d, br_text(s->reference_kind->title), NULL, "%s.title", key);
    if (s->reference_kind->nests) {
        br_hide_fact(d, br_count(s->reference.n), NULL, "%s.at.n", key);
        br_hide_fact(d, br_number(br_reference_mesh(s)), "m", "%s.at.h", key);
        br_hide_fact(d, br_count(s->reference.steps), NULL, "%s.at.steps", key);
        br_hide_fact(d, br_number(br_reference_step(s)), "s", "%s.at.k", key);
        snprintf(method, sizeof method, "%s.method", key);
        br_put_method_facts(d, method, &s->reference_method,
                            &(struct br_meshes){s->scene, &s->reference.n, 1});
    }
    for (enum br_part part = 0; part < BR_PARTS; part++)
        br_hide_fact(
            d,
            br_number(br_norm_of_constant(s->norm, s->scene, s->reference_report.own_error, part)),
            unit, "%s.%s", key, own[part]);
    br_hide_fact(d, br_number(s->reference_error[BR_PART_TOTAL]), unit, "%s.measured_error", key);
    br_hide_fact(d, br_number(s->reference_scale), unit, "%s.scale", key);
    br_hide_fact(d, br_number(s->reference_report.round_off), NULL, "%s.round_off", key);
    br_hide_fact(d, br_number(s->reference_report.seconds), "s", "%s.seconds", key);
}

void br_put_study_facts(struct br_document *d, const struct br_report *r)
{
    const struct br_study *s = r->study, *fitted = r->fitted;
    const struct br_cell *finest = br_finest_of(fitted);
    br_hide_fact(d, br_text(s->scene->name), NULL, "scene.name");
    br_hide_fact(d, br_text(s->norm->name), NULL, "norm.name");
    br_hide_fact(d, br_text(s->norm->unit), NULL, "norm.unit");
    br_hide_fact(d, br_text(s->norm->title), NULL, "norm.title");
    br_put_method_facts(d, "method", &s->method, &(struct br_meshes){s->scene, s->n, s->n_count});
    put_reference(d, "reference", s);
    if (r->exact)
        put_reference(d, "exact_reference", r->exact);
    for (enum br_part part = 0; part < BR_PARTS; part++)
        for (int i = 0; i < BR_AXES; i++) {
            const struct br_observed_order *o = &r->observed[part][i];
            const struct {
                const char *key;
                struct br_value value;
            } facts[] = {{"order", br_number(o->order.value)},
                         {"low", br_number(o->order.low)},
                         {"high", br_number(o->order.high)},
                         {"theory", br_number(o->theory.order)},
                         {"theory_highest", br_number(o->theory.highest)},
                         {"theory_reason", br_text(o->theory.reason)},
                         {"by", br_text(o->by)},
                         {"remark", br_text(o->remark)}};
            for (size_t f = 0; f < sizeof facts / sizeof *facts && o->asked; f++)
                br_hide_fact(d, facts[f].value, NULL, "orders.%s.%s.%s", br_part_names[part],
                             br_axis_letters[i], facts[f].key);
        }
    br_hide_fact(d, br_count(finest->at.n), NULL, "finest.n");
    br_hide_fact(d, br_number(br_step_of(fitted, finest)), "s", "finest.k");
    br_hide_fact(d, br_number(finest->error[BR_PART_TOTAL]), fitted->norm->unit, "finest.error");
    br_hide_fact(d, br_number(br_relative_of(fitted, finest, BR_PART_TOTAL)), NULL,
                 "finest.relative");
    br_hide_fact(d, br_text(fitted->reference_kind->name), NULL, "fitted");
    br_hide_fact(d, br_number(r->wall_seconds), "s", "wall_seconds");
}
