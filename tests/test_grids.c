/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every number of a report at its own row and column of every table: no two numbers
 * of the report are the same, so that one in another's place is seen. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made_report.h"
#include "tables/emitter.h"

static const struct br_provenance provenance = {.version = "v1",
                                                .commit = "c2",
                                                .compiler = "gcc3",
                                                .flags = "-O4",
                                                .command_line = "run 5",
                                                .machine = "m6",
                                                .date = "d7",
                                                .threads = 8,
                                                .scene_path = "p9",
                                                .scene_text = "t10\n"};

static char *emit(const char *name, const struct br_report *report)
{
    struct br_error err = {0};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    MUST(br_emitter_find(name)->emit(out, report, &provenance, &err));
    assert_int_equal(fclose(out), 0);
    return text;
}

/* ---- tables for people: each expected line comes after the one before ---- */

/* How a format writes. */
struct style {
    const char *name;
    void (*cell)(FILE *out, const char *number, enum br_flag flag);
    const char *row, *slope_row, *empty; /* a row's beginning (with n), that of the slopes */
    const char *before_slope, *end;
    bool separate_ratios; /* a table of their own */
};

static void text_cell(FILE *out, const char *number, enum br_flag flag)
{
    fprintf(out, "%11s%c", number, " RFXU"[flag]);
}

static void markdown_cell(FILE *out, const char *number, enum br_flag flag)
{
    static const char *const words[] = {"", " (reference)", " (round-off)", " (failed)"};
    fprintf(out, " %s%s |", number, words[flag]);
}

/* 1.500e-02 as $1.500\cdot10^{-2}$ */
static void latex_cell(FILE *out, const char *number, enum br_flag flag)
{
    static const char *const marks[] = {"", "$^{\\mathrm{R}}$", "$^{\\mathrm{F}}$",
                                        "$^{\\mathrm{X}}$"};
    if (strcmp(number, "-") == 0)
        fprintf(out, " & --%s", marks[flag]);
    else
        fprintf(out, " & $%.5s\\cdot10^{%d}$%s", number, atoi(strchr(number, 'e') + 1),
                marks[flag]);
}

static const struct style styles[] = {
    {"text", text_cell, "n = %-8zu", "slope in h  ", "-", "   ", "\n", true},
    {"markdown", markdown_cell, "| n = %zu |", "| slope in h |", "-", " ", " |\n", false},
    {"latex", latex_cell, "%zu", "slope in $h$", "--", " & ", " \\\\\n", false},
};

static void cell(FILE *out, const struct style *style, double value, enum br_flag flag)
{
    char number[32];
    snprintf(number, sizeof number, "%.3e", value);
    style->cell(out, isfinite(value) ? number : "-", flag);
}

/* The rows of one table of errors, each a line. */
static void error_lines(FILE *out, const struct style *style, const struct br_study *s,
                        enum br_part part, const struct br_fits *fits)
{
    char buffer[64];
    for (size_t i = 0; i < BR_MADE_N; i++) {
        fprintf(out, style->row, s->n[i]);
        for (size_t j = 0; j < BR_MADE_K; j++) {
            const struct br_cell *c = &s->cell[i * BR_MADE_K + j];
            cell(out, style, c->error[part], c->flag[part]);
        }
        if (fits)
            fprintf(out, "%s%s%s", style->before_slope,
                    br_order_text(&fits->by_n[i].order, buffer, sizeof buffer), style->end);
        else
            fputs(strcmp(style->name, "latex") == 0 ? style->end : "\n", out);
    }
}

static void slope_line(FILE *out, const struct style *style, const struct br_fits *fits)
{
    char buffer[64];
    fputs(style->slope_row, out);
    for (size_t j = 0; j < BR_MADE_K; j++) {
        const struct br_estimate *e = &fits->by_k[j].order;
        br_order_text(e, buffer, sizeof buffer);
        if (strcmp(style->name, "text") == 0 && isfinite(e->value))
            fprintf(out, "%11.2f ", e->value);
        else if (strcmp(style->name, "text") == 0)
            fprintf(out, "%11s ", "-");
        else if (strcmp(style->name, "markdown") == 0)
            fprintf(out, " %s |", isfinite(e->value) ? buffer : "-");
        else
            fprintf(out, " & %s", isfinite(e->value) ? buffer : "-");
    }
    fputc('\n', out);
}

static void printed_lines(FILE *out, const struct style *style, const struct br_made_report *m)
{
    for (size_t i = 0; i < BR_MADE_N; i++) {
        fprintf(out, style->row, m->study.n[i]);
        for (size_t j = 0; j < BR_MADE_K; j++) {
            const double printed = m->report.printed[i * BR_MADE_K + j];
            const double ratio = m->study.cell[i * BR_MADE_K + j].error[0] / printed;
            if (strcmp(style->name, "markdown") != 0)
                cell(out, style, printed, BR_FLAG_NONE);
            else if (!isfinite(printed))
                fputs(" - (-) |", out);
            else if (isfinite(ratio))
                fprintf(out, " %.3e (%.3f) |", printed, ratio);
            else
                fprintf(out, " %.3e (-) |", printed);
        }
        fputs(strcmp(style->name, "latex") == 0 ? style->end : "\n", out);
        for (size_t j = 0; j < BR_MADE_K && strcmp(style->name, "latex") == 0; j++) {
            const double ratio = br_report_ratio(&m->report, i * BR_MADE_K + j);
            fprintf(out, isfinite(ratio) ? " & (%.3f)" : " & --", ratio);
        }
        fputs(strcmp(style->name, "latex") == 0 ? style->end : "", out);
    }
    for (size_t i = 0; i < BR_MADE_N && style->separate_ratios; i++) {
        fprintf(out, style->row, m->study.n[i]);
        for (size_t j = 0; j < BR_MADE_K; j++) {
            const double ratio = br_report_ratio(&m->report, i * BR_MADE_K + j);
            if (isfinite(ratio))
                fprintf(out, "%11.3f ", ratio);
            else
                fprintf(out, "%11s ", "-");
        }
        fputc('\n', out);
    }
}

static char *expected_lines(const struct style *style, const struct br_made_report *m)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    const struct br_study *fitted = m->report.exact ? &m->exact : &m->study;
    for (int part = 0; part < BR_PARTS; part++) {
        error_lines(out, style, fitted, (enum br_part)part, &m->report.fits[part]);
        slope_line(out, style, &m->report.fits[part]);
    }
    if (m->report.exact)
        error_lines(out, style, &m->study, BR_PART_TOTAL, NULL);
    printed_lines(out, style, m);
    assert_int_equal(fclose(out), 0);
    return text;
}

static void check_lines(const struct style *style, const char *text, char *lines)
{
    char *rest;
    for (char *line = strtok_r(lines, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char whole[512];
        snprintf(whole, sizeof whole, "\n%s", line); /* the table may go on behind the slopes */
        const char *found = strstr(text, whole);
        if (!found)
            fail_msg("%s: no line '%s' after the one before it", style->name, line);
        text = found + strlen(whole);
    }
}

static void test_tables(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof styles / sizeof *styles; i++)
        for (int with_exact = 0; with_exact < 2; with_exact++) {
            struct br_made_report m;
            br_made_report(&m, with_exact);
            char *text = emit(styles[i].name, &m.report), *lines = expected_lines(&styles[i], &m);
            check_lines(&styles[i], text, lines);
            free(text);
            free(lines);
            br_made_report_clear(&m);
        }
}

/* ---- tables for programs ---- */

static void check_number(const char *field, double expected)
{
    if (!isfinite(expected))
        assert_string_equal(field, "");
    else
        CLOSE(strtod(field, NULL), expected, 1e-9 * fabs(expected));
}

/* The next field; RFC 4180 without quotes. */
static const char *next_field(char **rest)
{
    const char *field = strsep(rest, ",");
    assert_non_null(field);
    return field;
}

static void check_csv_row(char *line, const struct br_made_report *m, size_t i)
{
    const struct br_cell *c = &m->study.cell[i], *e = &m->exact.cell[i];
    check_number(next_field(&line), (double)c->at.n);
    check_number(next_field(&line), 1 / (double)c->at.steps);
    for (int part = 0; part < BR_PARTS; part++)
        check_number(next_field(&line), c->error[part]);
    check_number(next_field(&line), m->report.printed[i]);
    check_number(next_field(&line), c->error[0] / m->report.printed[i]);
    check_number(next_field(&line), c->seconds);
    for (int part = 0; part < BR_PARTS; part++)
        assert_string_equal(next_field(&line), br_flag_name(c->flag[part]));
    check_number(next_field(&line), c->worst_time[0]);
    for (int part = 0; part < BR_PARTS && m->report.exact; part++)
        check_number(next_field(&line), e->error[part]);
    if (m->report.exact)
        assert_string_equal(next_field(&line), br_flag_name(e->flag[0]));
    assert_null(line);
}

static void test_csv(void **state)
{
    (void)state;
    for (int with_exact = 0; with_exact < 2; with_exact++) {
        struct br_made_report m;
        br_made_report(&m, with_exact);
        char *text = emit("csv", &m.report), *rest = text;
        strsep(&rest, "\n");
        for (size_t i = 0; i < BR_MADE_CELLS; i++)
            check_csv_row(strsep(&rest, "\n"), &m, i);
        assert_string_equal(rest, "");
        free(text);
        br_made_report_clear(&m);
    }
}

static void check_json(const json_t *o, const char *key, double expected)
{
    const json_t *value = json_object_get(o, key);
    assert_non_null(value);
    if (isfinite(expected))
        CLOSE(json_number_value(value), expected, 1e-15 * fabs(expected));
    else
        assert_true(json_is_null(value));
}

static void check_slopes(const json_t *a, const struct br_slope *slope, size_t count)
{
    assert_int_equal(json_array_size(a), count);
    for (size_t i = 0; i < count; i++) {
        const json_t *order = json_object_get(json_array_get(a, i), "order");
        check_json(order, "value", slope[i].order.value);
        check_json(order, "low", slope[i].order.low);
        check_json(order, "high", slope[i].order.high);
        check_json(json_array_get(a, i), "points", (double)slope[i].points);
    }
}

static void check_fits(const json_t *o, const struct br_fits *f)
{
    const json_t *joint = json_object_get(o, "joint");
    const struct {
        const char *key;
        const struct br_estimate *estimate;
    } numbers[] = {{"C_h", &f->joint.c_h},
                   {"p", &f->joint.p},
                   {"C_k", &f->joint.c_k},
                   {"q", &f->joint.q},
                   {"r", &f->joint.r}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        const json_t *e = json_object_get(joint, numbers[i].key);
        check_json(e, "value", numbers[i].estimate->value);
        check_json(e, "low", numbers[i].estimate->low);
        check_json(e, "high", numbers[i].estimate->high);
    }
    check_slopes(json_object_get(o, "order_in_k_by_n"), f->by_n, BR_MADE_N);
    check_slopes(json_object_get(o, "order_in_h_by_k"), f->by_k, BR_MADE_K);
    check_json(o, "reference_error", f->reference_error);
}

static void test_json(void **state)
{
    (void)state;
    struct br_made_report m;
    br_made_report(&m, true);
    char *text = emit("json", &m.report);
    json_t *o = json_loads(text, 0, NULL);
    assert_non_null(o);
    assert_string_equal(json_string_value(json_object_get(o, "caption")), BR_MADE_CAPTION);
    static const char *const told[][2] = {
        {"version", "v1"},         {"commit", "c2"},  {"compiler", "gcc3"}, {"flags", "-O4"},
        {"command_line", "run 5"}, {"machine", "m6"}, {"date", "d7"}};
    const json_t *p = json_object_get(o, "provenance");
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        assert_string_equal(json_string_value(json_object_get(p, told[i][0])), told[i][1]);
    check_json(p, "threads", 8);
    for (size_t i = 0; i < BR_MADE_CELLS; i++) {
        const json_t *c = json_array_get(json_object_get(o, "cells"), i);
        check_json(c, "error", m.study.cell[i].error[0]);
        check_json(c, "axial", m.study.cell[i].error[1]);
        check_json(c, "bending", m.study.cell[i].error[2]);
        check_json(c, "printed", m.report.printed[i]);
        assert_string_equal(json_string_value(json_object_get(c, "axial_flag")),
                            br_flag_name(m.study.cell[i].flag[1]));
        check_json(json_object_get(c, "exact"), "error", m.exact.cell[i].error[0]);
        check_json(json_object_get(c, "exact"), "bending", m.exact.cell[i].error[2]);
    }
    for (int part = 0; part < BR_PARTS; part++)
        check_fits(json_object_get(json_object_get(o, "fits"), br_part_names[part]),
                   &m.report.fits[part]);
    json_decref(o);
    free(text);
    br_made_report_clear(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_csv),
        cmocka_unit_test(test_json),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
