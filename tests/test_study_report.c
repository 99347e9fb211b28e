/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of a study, and of the claims: every number at its own row and column. No two numbers
 * of the made-up report are the same, so that one in another's place is seen. What the formats make
 * of a document is tested in test_document.c. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document_reader.h"
#include "made_report.h"
#include "study/paper/claims.h"
#include "tables/reports.h"

static void make(struct br_made_report *m, bool with_exact)
{
    br_made_report(m, with_exact);
    struct br_study *const studies[] = {&m->study, &m->exact};
    for (int s = 0; s < 2; s++) {
        studies[s]->reference_size[BR_AXIAL] = 0.3 + s;
        studies[s]->reference_size[BR_BENDING] = 0.2 + s;
        studies[s]->reference_tip[BR_AXIAL] = 0.171 + 0.001 * s;
        studies[s]->reference_tip[BR_BENDING] = -0.07;
        for (size_t i = 0; i < BR_MADE_CELLS; i++) {
            m->cell[s][i].tip[BR_AXIAL] = 0.17 + 0.01 * (double)i + s;
            m->cell[s][i].tip[BR_BENDING] = -0.07 - 0.01 * (double)i - s;
        }
    }
    m->report.tip[BR_AXIAL] = (struct br_estimate){0.1715, 0.1705, 0.1725};
    m->report.tip[BR_BENDING] = (struct br_estimate){-0.0725, -0.0735, -0.0715};
}

/* The report as a program reads it; to be released. */
static json_t *report_back(const struct br_report *report)
{
    struct br_document d = {0};
    br_report_study(report, &d);
    for (size_t f = 0; br_document_formats[f]; f++) /* all formats can be written */
        if (!br_document_formats[f]->by_table)
            free(printed(&d, br_document_formats[f]));
    return read_back(&d);
}

static const json_t *table_of(const json_t *root, const char *key)
{
    return at_path(at_path(root, "tables"), key);
}

static void check(const json_t *o, const char *key, double expected)
{
    const json_t *value = at_path(o, key);
    if (isfinite(expected) && json_number_value(value) != expected)
        fail_msg("%s: found %.17g, expected %.17g", key, json_number_value(value), expected);
    assert_true(json_is_null(value) == !isfinite(expected));
}

static void check_text(const json_t *o, const char *key, const char *expected)
{
    const json_t *value = at_path(o, key);
    if (*expected)
        assert_string_equal(json_string_value(value), expected);
    else
        assert_true(json_is_null(value));
}

static void check_estimate(const json_t *row, const char *key, const struct br_estimate *e)
{
    char name[32];
    check(row, key, e->value);
    snprintf(name, sizeof name, "%s_low", key);
    check(row, name, e->low);
    snprintf(name, sizeof name, "%s_high", key);
    check(row, name, e->high);
}

/* ---- tables for programs ---- */

/* Between a cell and its coarser neighbour, `back` before it; NaN: there is none. */
static double rate(const struct br_cell *c, int part, size_t back, double ratio)
{
    return back ? log(c[-(ptrdiff_t)back].error[part] / c->error[part]) / log(ratio) : (double)NAN;
}

static void check_cell(const json_t *row, const struct br_made_report *m, const struct br_study *s,
                       int part, size_t i)
{
    const struct br_cell *c = &s->cell[i];
    const bool printed = s == &m->study && part == BR_PART_TOTAL, failed = i == 11;
    const double size = part == BR_PART_TOTAL ? s->reference_scale : s->reference_size[part - 1];
    check_text(row, "reference", s->judge->name);
    check_text(row, "part", br_part_names[part]);
    check(row, "n", (double)c->at.n);
    check(row, "h", m->scene.length / (double)c->at.n);
    check(row, "steps", (double)c->at.steps);
    check(row, "k", m->scene.duration / (double)c->at.steps);
    check(row, "error", c->error[part]);
    check(row, "relative", c->error[part] / size);
    check_text(row, "flag", br_flag_name(c->flag[part]));
    check(row, "rate_h", rate(c, part, i < BR_MADE_K ? 0 : BR_MADE_K, 2));
    check(row, "rate_k", rate(c, part, i % BR_MADE_K != 0, 2));
    check(row, "printed", printed ? m->report.printed[i] : (double)NAN);
    check(row, "ratio", printed ? c->error[part] / m->report.printed[i] : (double)NAN);
    check(row, "worst_time", c->worst_time[part]);
    check(row, "tip_axial", failed ? (double)NAN : c->tip[BR_AXIAL]);
    check(row, "tip_bending", failed ? (double)NAN : c->tip[BR_BENDING]);
    check(row, "seconds", c->seconds);
    check_text(row, "failure", failed ? c->failure.message : "");
}

static void check_cells(const json_t *root, const struct br_made_report *m)
{
    const json_t *rows = table_of(root, "cells");
    const struct br_study *const studies[] = {&m->study, m->report.exact};
    size_t row = 0;
    for (int s = 0; s < 2 && studies[s]; s++)
        for (int part = 0; part < BR_PARTS; part++)
            for (size_t i = 0; i < BR_MADE_CELLS; i++)
                check_cell(json_array_get(rows, row++), m, studies[s], part, i);
    assert_int_equal(json_array_size(rows), row);
}

static void check_slopes(const json_t *root, const struct br_made_report *m)
{
    const json_t *rows = table_of(root, "slopes");
    assert_int_equal(json_array_size(rows), BR_PARTS * (BR_MADE_N + BR_MADE_K));
    for (size_t i = 0; i < json_array_size(rows); i++) {
        const json_t *row = json_array_get(rows, i);
        const size_t part = i / (BR_MADE_N + BR_MADE_K), at = i % (BR_MADE_N + BR_MADE_K);
        const struct br_fits *f = &m->report.fits[part];
        const bool over_k = at < BR_MADE_N;
        const struct br_slope *slope = over_k ? &f->by_n[at] : &f->by_k[at - BR_MADE_N];
        check_text(row, "part", br_part_names[part]);
        check_text(row, "over", over_k ? "k" : "h");
        check(row, "n", over_k ? (double)m->study.n[at] : (double)NAN);
        check(row, "k",
              over_k ? (double)NAN : br_time_step(&m->scene, m->study.steps[at - BR_MADE_N]));
        check_estimate(row, "order", &slope->order);
        check(row, "points", (double)slope->points);
    }
}

static void check_fits(const json_t *root, const struct br_made_report *m)
{
    static const char *const kinds[] = {"space and time", "time", "space"};
    for (int part = 0; part < BR_PARTS; part++) {
        const json_t *row = json_array_get(table_of(root, "fits"), (size_t)part);
        const struct br_joint_fit *j = &m->report.fits[part].joint;
        check_text(row, "part", br_part_names[part]);
        check_text(row, "model", kinds[part]);
        check_estimate(row, "C_h", &j->c_h);
        check_estimate(row, "p", &j->p);
        check_estimate(row, "C_k", &j->c_k);
        check_estimate(row, "q", &j->q);
        check_estimate(row, "r", &j->r);
        check(row, "misfit", j->misfit);
        check(row, "worst", j->worst);
        check(row, "r_squared", j->r_squared);
        check(row, "points", 9);
        check(row, "degrees_of_freedom", 4);
        assert_true(json_is_true(at_path(row, "converged")));
        assert_true(json_is_true(at_path(row, "describes_the_errors")));
        check(row, "reference_error", m->report.fits[part].reference_error);
    }
}

static void check_tips(const json_t *root, const struct br_made_report *m)
{
    const struct br_study *s = m->report.exact ? &m->exact : &m->study;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const json_t *row = json_array_get(table_of(root, "tips"), (size_t)kind);
        check_text(row, "field", kind ? "bending" : "axial");
        check_estimate(row, "extrapolated", &m->report.tip[kind]);
        check(row, "reference", s->reference_tip[kind]);
        check_text(row, "reference_is", kind ? "OUTSIDE" : "within");
    }
}

static void check_triangles(const json_t *root, const struct br_made_report *m)
{
    const json_t *rows = table_of(root, "triangles");
    assert_int_equal(json_array_size(rows), 2);
    for (size_t i = 0; i < 2; i++) {
        const json_t *row = json_array_get(rows, i);
        const struct br_triangle *t = &m->report.triangle[i];
        check(row, "a_n", (double)t->a.n);
        check(row, "a_k", br_time_step(&m->scene, t->a.steps));
        check(row, "b_n", (double)t->b.n);
        check(row, "b_k", br_time_step(&m->scene, t->b.steps));
        check(row, "printed_a", t->printed_a);
        check(row, "printed_b", t->printed_b);
        check(row, "least", t->least);
        check(row, "most", t->most);
        check(row, "distance", t->distance);
        assert_true(json_is_true(at_path(row, "contradiction")) == t->contradiction);
    }
}

/* ---- facts ---- */

static void check_reference(const json_t *o, const struct br_study *s)
{
    check_text(o, "kind", s->judge->name);
    check_text(o, "title", s->judge->title);
    assert_true((json_object_get(o, "at") != NULL) == s->judge->nests);
    if (s->judge->nests) {
        const json_t *at = at_path(o, "at"), *method = at_path(o, "method");
        check(at, "n", 640);
        check(at, "h", s->scene->length / 640);
        check(at, "steps", 3200);
        check(at, "k", s->scene->duration / 3200);
        check_text(method, "scheme", "euler");
    }
    const bool exact = s->judge == &br_judge_exact;
    check(o, "own_axial_error", exact ? 1e-14 : (double)NAN);
    check(o, "own_bending_error", exact ? 2e-14 : (double)NAN);
    check(o, "own_error", exact ? 1e-14 + 2e-14 : (double)NAN);
    check(o, "audited_error", 1.5e-3);
    check(o, "scale", 0.5);
    check(o, "round_off", 1e-13);
    check(o, "seconds", 2.5);
}

static void check_facts(const json_t *root, const struct br_made_report *m)
{
    check_text(root, "name", "made");
    check_text(root, "caption", BR_MADE_CAPTION);
    check_text(root, "fitted", "exact");
    check(root, "wall_seconds", 12.5);
    check_text(at_path(root, "scene"), "name", m->scene.name);
    check_text(at_path(root, "norm"), "name", "l2");
    check_text(at_path(root, "norm"), "unit", "m^(3/2)");
    check_text(at_path(root, "norm"), "title", br_norms[0]->title);
    check_reference(at_path(root, "reference"), &m->study);
    assert_true((json_object_get(root, "exact_reference") != NULL) == (m->report.exact != NULL));
    if (m->report.exact)
        check_reference(at_path(root, "exact_reference"), &m->exact);
}

static void test_programs(void **state)
{
    (void)state;
    for (int with_exact = 0; with_exact < 2; with_exact++) {
        struct br_made_report m;
        make(&m, with_exact);
        json_t *root = report_back(&m.report);
        check_cells(root, &m);
        check_slopes(root, &m);
        check_fits(root, &m);
        check_tips(root, &m);
        check_triangles(root, &m);
        check_facts(root, &m);
        json_decref(root);
        br_made_report_clear(&m);
    }
}

/* What a method does not heed is null. */
static void test_method(void **state)
{
    (void)state;
    struct br_made_report m;
    make(&m, true);
    json_t *root = report_back(&m.report);
    check(at_path(root, "method"), "tolerance", NAN);
    assert_true(json_is_null(at_path(at_path(root, "method"), "iteration")));
    json_decref(root);
    m.study.method = br_test_method("umfpack", "implicit", "uzawa");
    m.study.method.axial_degree = 2;
    m.study.method.linear = (struct br_linear_options){.scaling = "sum", .refinement = 3};
    m.study.method.iteration = (struct br_iteration){0.5, 1e-9, 77};
    root = report_back(&m.report);
    const json_t *method = at_path(root, "method"), *iteration = at_path(method, "iteration");
    check_text(method, "solver", "umfpack");
    check_text(method, "kernel", "");
    check_text(method, "scaling", "sum");
    check(method, "refinement", 3);
    check(method, "axial_degree", 2);
    check_text(method, "contact", "implicit");
    check_text(method, "friction", "uzawa");
    check(iteration, "parameter", 0.5);
    check(iteration, "tolerance", 1e-9);
    check(iteration, "most", 77);
    json_decref(root);
    br_made_report_clear(&m);
}

/* ---- grids for people ---- */

static const struct br_document_table *grid_of(const struct br_document *d, const char *key)
{
    for (size_t i = 0; i < d->blocks; i++)
        if (d->block[i].kind == BR_BLOCK_TABLE && strcmp(d->block[i].table->key, key) == 0)
            return d->block[i].table;
    return NULL;
}

/* A cell as people see it, with its mark. */
static const char *seen(const struct br_document_table *t, size_t row, size_t column)
{
    static char text[BR_SHOWN + 32];
    char buffer[BR_SHOWN];
    const struct br_document_cell *c = br_document_cell_at(t, row, column);
    snprintf(text, sizeof text, "%s%s", br_document_shown(&t->column[column], c, buffer),
             c->mark ? c->mark : "");
    return text;
}

static void check_seen(const struct br_document_table *t, size_t row, size_t column, double value,
                       const char *format, const char *mark)
{
    char number[64], expected[80];
    snprintf(number, sizeof number, format, value);
    snprintf(expected, sizeof expected, "%s%s", isfinite(value) ? number : "-", mark);
    assert_string_equal(seen(t, row, column), expected);
}

static void check_grid(const struct br_document *d, const char *key, const struct br_study *s,
                       int part, const struct br_fits *fits)
{
    static const char *const marks[] = {"", "R", "F", "X", "U"};
    const struct br_document_table *t = grid_of(d, key);
    char buffer[64];
    assert_non_null(t);
    assert_int_equal(t->rows, BR_MADE_N + (fits ? 1 : 0));
    assert_int_equal(t->columns, 1 + BR_MADE_K + (fits ? 1 : 0));
    for (size_t i = 0; i < BR_MADE_CELLS; i++) {
        const struct br_cell *c = &s->cell[i];
        check_seen(t, i / BR_MADE_K, 1 + i % BR_MADE_K, c->error[part], "%.3e",
                   marks[c->flag[part]]);
    }
    for (size_t i = 0; i < BR_MADE_N; i++) {
        check_seen(t, i, 0, (double)s->n[i], "%.0f", "");
        if (fits)
            assert_string_equal(seen(t, i, 1 + BR_MADE_K),
                                br_order_text(&fits->by_n[i].order, buffer, sizeof buffer));
    }
    for (size_t j = 0; j < BR_MADE_K; j++) {
        snprintf(buffer, sizeof buffer, "k = %g", br_time_step(s->scene, s->steps[j]));
        assert_string_equal(t->column[1 + j].heading, buffer);
        if (fits)
            check_seen(t, BR_MADE_N, 1 + j, fits->by_k[j].order.value, "%.2f", "");
    }
}

static void check_printed(const struct br_document *d, const struct br_made_report *m)
{
    const struct br_document_table *printed = grid_of(d, "printed"), *ratio = grid_of(d, "ratio");
    for (size_t i = 0; i < BR_MADE_CELLS; i++) {
        const size_t row = i / BR_MADE_K, column = 1 + i % BR_MADE_K;
        check_seen(printed, row, column, m->report.printed[i], "%.3e", "");
        check_seen(ratio, row, column, m->cell[0][i].error[0] / m->report.printed[i], "%.3f", "");
    }
}

static void test_people(void **state)
{
    (void)state;
    for (int with_exact = 0; with_exact < 2; with_exact++) {
        struct br_made_report m;
        struct br_document d = {0};
        make(&m, with_exact);
        m.cell[with_exact][7].flag[BR_PART_BENDING] = BR_FLAG_UNSTABLE;
        br_report_study(&m.report, &d);
        const struct br_study *fitted = with_exact ? &m.exact : &m.study;
        for (int part = 0; part < BR_PARTS; part++)
            check_grid(&d, br_part_names[part], fitted, part, &m.report.fits[part]);
        assert_true((grid_of(&d, "fine") != NULL) == with_exact);
        if (with_exact)
            check_grid(&d, "fine", &m.study, BR_PART_TOTAL, NULL);
        check_printed(&d, &m);
        br_document_clear(&d);
        br_made_report_clear(&m);
    }
}

/* ---- the answer ---- */

/* Whether an answer or a note has that text. */
static bool says(const struct br_report *report, const char *text)
{
    struct br_error err = {0};
    struct br_document d = {0};
    br_report_study(report, &d);
    MUST(br_document_status(&d, &err));
    assert_true(d.answers > 0 && d.answers <= 10);
    bool found = false;
    for (size_t i = 0; i < d.answers; i++)
        found |= strstr(d.answer[i], text) != NULL;
    for (size_t i = 0; i < d.blocks; i++)
        found |= d.block[i].kind == BR_BLOCK_NOTE && strstr(d.block[i].text, text);
    br_document_clear(&d);
    return found;
}

static void test_answer(void **state)
{
    (void)state;
    struct br_made_report m;
    make(&m, true);
    static const char *const expected[] = {
        "Order in h: 2.03 [2.01, 2.05], in k: 1.013 [1.009, 1.017]; 95 % intervals, misfit 0.2 % "
        "in 9 cells.",
        "Theory: (26) bounds the error by c (h^(1/2) + k)",
        "Judged by: exact. Its own error is about 3.3e-07, by its own estimate; its round-off is "
        "about 5e-14. 4 of 12 cells are left out of fits: 2 R, too near the reference's own error; "
        "1 F, too near the predicted round-off; 1 X, failed.",
        "The cells alone (Richardson) give w(L, T) = -0.0725 +- 1.0e-03 m, and the exact "
        "reference's -0.07 is OUTSIDE that",
        "Ours (against fine) DIFFER from the printed errors by more than 5 % in 9 of 9 cells, ours "
        "over printed is 2.1 to 6.8; the farthest (n = 40, k = 0.01 s) is 2.735e-02, printed "
        "4.001e-03.",
        "at least 1 pairs of printed errors break the triangle inequality",
        "Error of the finest cell (n = 40, k = 0.005 s): none, the march failed.",
        "Its own error is about 1.5e-03, measured against the exact solution; its round-off is "
        "about 5e-14. 2 of 12 cells are left out of fits: 1 R, too near the reference's own error; "
        "1 X, failed.",
        "Failed: n = 40, k = 0.005 s: it blew up at 50% & {more}.",
        "Beside it, fine: a run of the same scheme with N elements and steps of K seconds: "
        "N = 640, K = 0.0003125 s; scheme euler",
        "Cells: scheme euler, solver ",
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        if (!says(&m.report, expected[i]))
            fail_msg("the report does not say: %s", expected[i]);
    assert_false(says(&m.report, "u(L, T)"));
    br_made_report_clear(&m);
}

/* What is said where it is otherwise. */
static void test_other_answers(void **state)
{
    (void)state;
    struct br_made_report m;
    make(&m, true);
    struct br_joint_fit *fit = &m.report.fits[BR_PART_TOTAL].joint;
    m.cell[1][11] = m.cell[1][10];
    m.cell[1][11].at.steps = 200;
    assert_true(says(&m.report,
                     "Error of the finest cell (n = 40, k = 0.005 s): 5.485e-02 m^(3/2), "
                     "relative 1.10e-01."));
    fit->kind = BR_JOINT_TIME;
    assert_true(says(&m.report, "Order in h: no error is seen, in k: 1.013 [1.009, 1.017];"));
    fit->kind = BR_JOINT_SPACE;
    assert_true(says(&m.report, "Order in h: 2.03 [2.01, 2.05], in k: no error is seen;"));
    fit->p.high = 4;
    assert_true(says(&m.report, "Order in h: not determined (2.03 [2.01, 4.00])"));
    fit->misfit = 0.12;
    assert_true(
        says(&m.report, "does not describe these errors (misfit 12 %, 9 cells): no orders"));
    fit->converged = false;
    assert_true(says(&m.report, "No joint fit: 9 usable cells tell no order."));
    m.report.fits[BR_PART_TOTAL].reference_error = NAN;
    assert_true(says(&m.report, "Its own error is not known"));
    m.exact.judged_by.unstable = true;
    assert_true(says(&m.report, "The exact reference itself is beyond the stability limit"));
    for (size_t i = 0; i < BR_MADE_CELLS; i++)
        m.report.printed[i] = 1.04 * m.cell[0][i].error[0];
    assert_true(says(&m.report, "agree within 5 % in all 11 cells"));
    assert_false(says(&m.report, "triangle inequality."));
    br_made_report_clear(&m);
}

/* Only the total of a scene with one field; differences where there is no reference. */
static void test_other_studies(void **state)
{
    (void)state;
    struct br_made_report m;
    make(&m, false);
    m.scene.axial.modelled = false;
    m.study.judge = &br_judge_none;
    free(m.report.printed);
    m.report.printed = NULL;
    m.study.events = (char[]){"first event\nsecond event"};
    json_t *root = report_back(&m.report);
    assert_int_equal(json_array_size(table_of(root, "cells")), BR_MADE_CELLS);
    assert_int_equal(json_array_size(table_of(root, "fits")), 1);
    assert_int_equal(json_array_size(table_of(root, "tips")), 1);
    check(json_array_get(table_of(root, "cells"), 0), "tip_axial", NAN);
    check(json_array_get(table_of(root, "tips"), 0), "reference", NAN);
    assert_null(json_object_get(at_path(root, "tables"), "triangles"));
    json_decref(root);
    assert_true(says(&m.report, "Judged by: the next finer cell. 4 of 12"));
    assert_true(says(&m.report, "Difference of the finest cell"));
    assert_true(says(&m.report, "second event"));
    assert_false(says(&m.report, "printed"));
    assert_false(says(&m.report, "Its own error"));
    m.study.events = NULL;
    br_made_report_clear(&m);
}

/* ---- claims ---- */

static void test_claims(void **state)
{
    (void)state;
    struct br_finding finding[BR_MOST_CLAIMS] = {{.value = 0}};
    struct br_error err = {0};
    struct br_document d = {0};
    size_t count = 0;
    for (; br_claims[count].name; count++) {
        const double x = (double)count;
        finding[count] = (struct br_finding){
            x + 0.1, x + 0.2, x + 0.3, x + 0.4, (enum br_agreement)(count % 3), "why"};
    }
    finding[1].printed = NAN;
    finding[2].agreement = BR_AGREES;
    br_report_claims(finding, 50, 200, &d);
    MUST(br_document_status(&d, &err));
    char expected[120];
    snprintf(expected, sizeof expected, "The paper's claims: %zu agree, %zu differ, %zu undecided.",
             (count + 2) / 3 + 1, (count + 1) / 3, count / 3 - 1);
    assert_string_equal(d.answer[0], expected);
    assert_non_null(strstr(d.answer[1], "h = 1/50 m and k = 1/200 s"));
    const struct br_document_table *t = grid_of(&d, "claims");
    assert_int_equal(t->rows, count);
    for (size_t i = 0; i < count; i++) {
        const struct br_claim *c = &br_claims[i];
        const struct br_finding *f = &finding[i];
        const char *unit = strcmp(c->unit, "1") == 0 ? "" : c->unit, *space = *unit ? " " : "";
        assert_string_equal(seen(t, i, 0), c->name);
        assert_string_equal(seen(t, i, 1), c->section);
        check_seen(t, i, 2, c->figure ? c->figure : (double)NAN, "%.0f", "");
        assert_string_equal(seen(t, i, 3), c->statement);
        assert_string_equal(seen(t, i, 4), c->measured);
        assert_string_equal(seen(t, i, 5), c->unit);
        snprintf(expected, sizeof expected, "%.6g%s%s", f->printed, space, unit);
        assert_string_equal(seen(t, i, 6), isfinite(f->printed) ? expected : "-");
        snprintf(expected, sizeof expected, "%.6g +- %.2g%s%s", f->value, f->error, space, unit);
        assert_string_equal(seen(t, i, 7), expected);
        assert_true(br_document_cell_at(t, i, 7)->value.number == f->value);
        assert_true(br_document_cell_at(t, i, 8)->value.number == f->error);
        assert_true(br_document_cell_at(t, i, 9)->value.number == f->exact);
        assert_string_equal(seen(t, i, 10), br_agreement_name(f->agreement));
        assert_string_equal(seen(t, i, 11), "why");
    }
    br_document_clear(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_programs),      cmocka_unit_test(test_method),
        cmocka_unit_test(test_people),        cmocka_unit_test(test_answer),
        cmocka_unit_test(test_other_answers), cmocka_unit_test(test_other_studies),
        cmocka_unit_test(test_claims),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
