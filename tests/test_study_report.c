/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of a study: what it says of results that the outputs in golden/, which hold every
 * table, do not have. What the formats make of a document is tested in test_document.c. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document_reader.h"
#include "made_report.h"
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
    m->report.seen[BR_PART_TOTAL][BR_OVER_H] = (struct br_seen_order){
        true, {2.03, 2.01, 2.05}, 2, "each mesh against the next", "as in theory"};
    m->report.seen[BR_PART_TOTAL][BR_OVER_K] =
        (struct br_seen_order){true, {NAN, NAN, NAN}, 1, "errors", "not seen: for a reason"};
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

/* What a method does not heed is null; and errors that golden/ takes for round-off. */
static void test_method(void **state)
{
    (void)state;
    struct br_made_report m;
    make(&m, true);
    json_t *root = report_back(&m.report);
    check(at_path(root, "method"), "tolerance", NAN);
    check(at_path(root, "exact_reference"), "own_axial_error", 1e-14);
    check(at_path(root, "exact_reference"), "own_bending_error", 2e-14);
    check(at_path(root, "exact_reference"), "own_error", 1e-14 + 2e-14);
    check(at_path(root, "exact_reference"), "round_off", 1e-13);
    check(at_path(root, "reference"), "own_error", NAN);
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
        "Order in h: 2.03 [2.01, 2.05], theory 2, as in theory: each mesh against the next.",
        "Order in k: not seen: for a reason. Theory: 1.",
        "Theory: (26) bounds the error by c (h^(1/2) + k)",
        "Judged by: exact. Its own error is about 3.3e-07, by its own estimate; its round-off is "
        "about 5e-14. 4 of 12 cells are left out of fits: 2 R, too near the reference's own error; "
        "1 F, too near the predicted round-off; 1 X, failed.",
        "The cells alone (Richardson) give w(L, T) = -0.0725 +- 0.0010 m, and the exact "
        "reference's -0.07 is OUTSIDE that",
        "Ours (against fine) DIFFER from the printed errors by more than 5 % in 9 of 9 cells, ours "
        "over printed is 2.1 to 6.8; the farthest (n = 40, k = 0.01 s) is 2.735e-02, printed "
        "4.001e-03.",
        "at least 1 pair of printed errors breaks the triangle inequality",
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
    m.cell[1][11] = m.cell[1][10];
    m.cell[1][11].at.steps = 200;
    assert_true(says(&m.report,
                     "Error of the finest cell (n = 40, k = 0.005 s): 5.485e-02 m^(3/2), "
                     "relative 1.10e-01."));
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_method),
        cmocka_unit_test(test_answer),
        cmocka_unit_test(test_other_answers),
        cmocka_unit_test(test_other_studies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
