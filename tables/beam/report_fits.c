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
    bool shown = false;
    for (enum br_part part = 0; part < BR_PARTS; part++)
        shown |=
            br_part_is_shown(r, part) && br_joint_describes(&r->fits[part].joint) && !r->printed;
    br_put_table(d, "fits", "Joint fit of the signed errors C_h h^p and C_k k^q",
                 shown ? 0 : BR_FILES_ONLY);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        const struct br_joint_fit *j = &r->fits[part].joint;
        const bool claims = br_joint_describes(j);
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
            BR_PUT_ESTIMATE(d, a ? "q_" : "p_", &j->order[a],
                            sure     ? br_order_shown(d, &j->order[a])
                            : claims ? "not used"
                                     : "-",
                            .key = a ? "q" : "p", .heading = a ? "q [95 %]" : "p [95 %]");
            BR_PUT_ESTIMATE(d, a ? "C_k_" : "C_h_", &j->c[a], claims ? NULL : "-",
                            .key = a ? "C_k" : "C_h", .format = "%.3g");
        }
        BR_PUT_ESTIMATE(d, "r_", &j->r, claims ? br_interval_shown(d, &j->r) : "-", .key = "r",
                        .heading = "r [95 %]");
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

static void put_triangle(struct br_document *d, const struct br_scene *scene,
                         const struct br_triangle *t)
{
    br_put_row(d);
    BR_PUT(d, br_count(t->a.n), .key = "a_n", .heading = "n");
    BR_PUT(d, br_number(br_time_step(scene, t->a.steps)), .key = "a_k", .heading = "k",
           .unit = "s");
    BR_PUT(d, br_count(t->b.n), .key = "b_n", .heading = "and n");
    BR_PUT(d, br_number(br_time_step(scene, t->b.steps)), .key = "b_k", .heading = "k",
           .unit = "s");
    BR_PUT(d, br_number(t->printed_a), .key = "printed_a", .heading = "printed", .format = "%.3e");
    BR_PUT(d, br_number(t->printed_b), .key = "printed_b", .heading = "and", .format = "%.3e");
    BR_PUT(d, br_number(t->least), .key = "least", .heading = "need at least", .format = "%.2e");
    BR_PUT(d, br_number(t->most), .key = "most", .heading = "at most", .format = "%.2e");
    BR_PUT(d, br_number(t->distance), .key = "distance", .heading = "are apart", .format = "%.2e");
    BR_PUT(d, br_truth(t->contradiction), .key = "contradiction");
}

void br_put_triangles(struct br_document *d, const struct br_report *r)
{
    if (!r->printed)
        return;
    br_put_table(d, "triangles", "Pairs of printed cells (triangle inequality), m^(3/2)",
                 BR_FILES_ONLY);
    put_triangle(d, r->study->scene, &(struct br_triangle){0});
    br_put_no_row(d);
    for (size_t i = 0; i < r->triangles; i++)
        put_triangle(d, r->study->scene, &r->triangle[i]);
    br_put_note(d, "For every reference, the distance of two solutions is at least the difference "
                   "of their errors, and at most the sum. The last column but one is the distance "
                   "of the scheme's own solutions.");
}

/* ---- facts ---- */

static void put_reference(struct br_document *d, const char *key, const struct br_study *s)
{
    static const char *const own[] = {"own_error", "own_axial_error", "own_bending_error"};
    const char *unit = s->norm->unit;
    br_hide_fact(d, br_text(s->reference_kind->name), NULL, "%s.kind", key);
    br_hide_fact(d, br_text(s->reference_kind->title), NULL, "%s.title", key);
    if (s->reference_kind->nests) {
        br_hide_fact(d, br_count(s->reference.n), NULL, "%s.at.n", key);
        br_hide_fact(d, br_number(br_reference_mesh(s)), "m", "%s.at.h", key);
        br_hide_fact(d, br_count(s->reference.steps), NULL, "%s.at.steps", key);
        br_hide_fact(d, br_number(br_reference_step(s)), "s", "%s.at.k", key);
        br_put_method_facts(d, br_format(d, "%s.method", key), &s->reference_method,
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
