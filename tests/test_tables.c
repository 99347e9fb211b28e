/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every emitter of the registry, read back; and scripts that are rendered side by side. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plots/render.h"
#include "support.h"
#include "tables/emitter.h"

enum { ROWS = 2, COLUMNS = 3, CELLS = ROWS * COLUMNS };

static const size_t meshes[ROWS] = {10, 20}, steps[COLUMNS] = {10, 20, 40};

/* A report that holds one cell of every kind. */
struct sample {
    struct br_scene scene;
    struct br_study study, exact;
    struct br_cell cell[CELLS], exact_cell[CELLS];
    double printed[CELLS];
    struct br_slope by_n[BR_PARTS][ROWS], by_k[BR_PARTS][COLUMNS];
    struct br_report report;
};

static void fill_cells(struct br_cell *cell, double factor)
{
    for (size_t i = 0; i < CELLS; i++) {
        cell[i] =
            (struct br_cell){.at = {meshes[i / COLUMNS], steps[i % COLUMNS]}, .seconds = 0.25};
        for (int part = 0; part < BR_PARTS; part++) {
            cell[i].error[part] = factor * (1 + (double)i) * pow(10, -3 - part) / 3;
            cell[i].worst_time[part] = 0.5;
        }
    }
    cell[1].flag[BR_PART_TOTAL] = BR_FLAG_REFERENCE;
    cell[2].flag[BR_PART_TOTAL] = BR_FLAG_ROUND_OFF;
    for (int part = 0; part < BR_PARTS; part++) {
        cell[5].error[part] = NAN;
        cell[5].flag[part] = BR_FLAG_FAILED;
    }
    br_fail(&cell[5].failure, BR_NOT_FINITE, "the march blew up at t = 0.1 s");
}

static void sample_init(struct sample *s, bool with_exact)
{
    *s = (struct sample){.scene = br_test_bare()};
    static char name[] = "scene_name";
    s->scene.name = name;
    fill_cells(s->cell, 1);
    fill_cells(s->exact_cell, 1.5);
    s->study = (struct br_study){
        .scene = &s->scene,
        .norm = br_norms[0],
        .method = br_method_default(),
        .judge = &br_judge_fine,
        .reference_method = br_method_default(),
        .reference = {80, 80},
        .n_count = ROWS,
        .k_count = COLUMNS,
        .n = meshes,
        .steps = steps,
        .cell = s->cell,
        .judged_by = {.own_error = {{NAN}, {NAN}}, .round_off = 1e-12},
        .reference_scale = 1,
        .reference_error = {NAN, NAN, NAN},
    };
    s->exact = s->study;
    s->exact.judge = &br_judge_exact;
    s->exact.cell = s->exact_cell;
    s->report = (struct br_report){.name = "sample",
                                   .caption = "A 100 % test_case & more {#1} $x$ ~ ^ \\ |",
                                   .study = &s->study,
                                   .exact = with_exact ? &s->exact : NULL,
                                   .printed = s->printed};
    for (size_t i = 0; i < CELLS; i++)
        s->printed[i] = i == 4 ? NAN : 1e-3 * (double)(i + 1);
    for (int part = 0; part < BR_PARTS; part++) {
        for (size_t i = 0; i < ROWS; i++)
            s->by_n[part][i] = (struct br_slope){{1.25, 1.0, 1.5}, 3};
        for (size_t j = 0; j < COLUMNS; j++)
            s->by_k[part][j] = (struct br_slope){{2.125, NAN, NAN}, 2};
        s->report.fits[part].by_n = s->by_n[part];
        s->report.fits[part].by_k = s->by_k[part];
        s->report.fits[part].joint.misfit = NAN;
    }
}

static const struct br_provenance provenance = {
    .version = "1.2.3",
    .commit = "abcdef",
    .compiler = "cc 1",
    .flags = "-O2",
    .command_line = "beamrate study \"x\"",
    .machine = "a machine",
    .date = "2026-01-01T00:00:00Z",
    .threads = 3,
    .scene_path = "scene.yaml",
    .scene_text = "title: \"x\"\n",
};

/* The emitter's text; to be freed. */
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

/* Field `index` of a line of CSV into `field`. */
static void csv_field(const char *line, int index, char field[64])
{
    for (; index > 0; index--) {
        line = strchr(line, ',');
        assert_non_null(line);
        line++;
    }
    snprintf(field, 64, "%.*s", (int)strcspn(line, ",\n"), line);
}

/* Errors are written with all their digits. */
static void check_csv_number(const char *line, int index, double expected)
{
    const bool whole = (index >= 2 && index <= 4) || index == 12;
    char field[64];
    csv_field(line, index, field);
    if (isnan(expected))
        assert_string_equal(field, "");
    else
        CLOSE(strtod(field, NULL), expected, whole ? 0 : 1e-9 * fabs(expected));
}

static void check_csv(bool with_exact)
{
    struct sample s;
    char field[64];
    sample_init(&s, with_exact);
    char *text = emit("csv", &s.report);
    assert_int_equal(strncmp(text, "n,k,error,axial,bending,printed,ratio,seconds,flag,", 51), 0);
    const char *line = text;
    for (size_t i = 0; i < CELLS; i++) {
        line = strchr(line, '\n') + 1;
        const struct br_cell *c = &s.cell[i];
        check_csv_number(line, 0, (double)c->at.n);
        check_csv_number(line, 1, 1.0 / (double)c->at.steps);
        for (int part = 0; part < BR_PARTS; part++)
            check_csv_number(line, 2 + part, c->error[part]);
        check_csv_number(line, 5, s.printed[i]);
        check_csv_number(line, 6, c->error[0] / s.printed[i]);
        check_csv_number(line, 7, 0.25);
        csv_field(line, 8, field);
        assert_string_equal(field, br_flag_name(c->flag[0]));
        if (with_exact)
            check_csv_number(line, 12, s.exact_cell[i].error[0]);
    }
    assert_string_equal(strchr(line, '\n'), "\n"); /* no line more */
    free(text);
}

static void test_csv(void **state)
{
    (void)state;
    check_csv(false);
    check_csv(true);
}

static void check_json_number(const json_t *object, const char *key, double expected)
{
    const json_t *value = json_object_get(object, key);
    assert_non_null(value);
    if (isnan(expected))
        assert_true(json_is_null(value));
    else
        CLOSE(json_number_value(value), expected, 0);
}

static void test_json(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s, true);
    char *text = emit("json", &s.report);
    json_error_t error;
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    assert_non_null(root);
    const json_t *cells = json_object_get(root, "cells");
    assert_int_equal(json_array_size(cells), CELLS);
    for (size_t i = 0; i < CELLS; i++) {
        const json_t *c = json_array_get(cells, i);
        check_json_number(c, "n", (double)s.cell[i].at.n);
        check_json_number(c, "k", 1.0 / (double)s.cell[i].at.steps);
        check_json_number(c, "error", s.cell[i].error[BR_PART_TOTAL]);
        check_json_number(c, "axial", s.cell[i].error[BR_PART_AXIAL]);
        check_json_number(c, "bending", s.cell[i].error[BR_PART_BENDING]);
        check_json_number(c, "printed", s.printed[i]);
        check_json_number(json_object_get(c, "exact"), "error", s.exact_cell[i].error[0]);
        assert_string_equal(json_string_value(json_object_get(c, "flag")),
                            br_flag_name(s.cell[i].flag[0]));
    }
    const json_t *p = json_object_get(root, "provenance");
    static const char *const keys[] = {"version",      "commit",  "compiler", "flags",
                                       "command_line", "machine", "date"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        assert_true(json_string_length(json_object_get(p, keys[i])) > 0);
    assert_string_equal(json_string_value(json_object_get(p, "command_line")),
                        provenance.command_line);
    assert_string_equal(json_string_value(json_object_get(json_object_get(root, "scene"), "text")),
                        provenance.scene_text);
    json_decref(root);
    free(text);
}

/* "7.794e-04" as Markdown and the terminal show it, found behind the row's heading. */
static void check_rows(const char *text, const char *first_row, const struct br_cell *cell)
{
    const char *at = strstr(text, first_row);
    assert_non_null(at);
    for (size_t i = 0; i < CELLS; i++) {
        char number[32];
        if (!isfinite(cell[i].error[0]))
            continue;
        snprintf(number, sizeof number, "%.3e", cell[i].error[0]);
        at = strstr(at, number);
        assert_non_null(at); /* in the order of the cells */
    }
}

/* Every row of a table has as many fields as its heading. */
static void check_markdown_tables(const char *text)
{
    size_t fields = 0;
    for (const char *line = text; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
        const size_t length = strcspn(line, "\n");
        size_t bars = 0;
        for (size_t i = 0; i < length && line[0] == '|'; i++)
            bars += line[i] == '|';
        if (bars && fields)
            assert_int_equal(bars, fields);
        assert_true(bars == 0 || line[length - 1] == '|');
        fields = bars;
    }
}

static void test_text_and_markdown(void **state)
{
    (void)state;
    for (int with_exact = 0; with_exact < 2; with_exact++) {
        struct sample s;
        sample_init(&s, with_exact);
        const struct br_cell *fitted = with_exact ? s.exact_cell : s.cell;
        char *text = emit("text", &s.report);
        check_rows(text, "\ntotal ", fitted);
        if (with_exact)
            check_rows(text, "\nfine ", s.cell);
        assert_non_null(strstr(text, "1.25 [1.00, 1.50]"));
        assert_non_null(strstr(text, "Failed: n = 20, k = 0.025 s: the march blew up"));
        free(text);
        text = emit("markdown", &s.report);
        check_rows(text, "| total |", fitted);
        check_markdown_tables(text);
        assert_non_null(strstr(text, "(reference)"));
        assert_non_null(strstr(text, "(round-off)"));
        assert_non_null(strstr(text, "- (failed)"));
        free(text);
    }
}

static size_t occurrences(const char *text, const char *what)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, what)); at += strlen(what))
        count++;
    return count;
}

static void test_latex(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s, true);
    char *text = emit("latex", &s.report);
    static const char *const environments[] = {"table", "tabular"};
    for (size_t i = 0; i < 2; i++) {
        char begin[32], end[32];
        snprintf(begin, sizeof begin, "\\begin{%s}", environments[i]);
        snprintf(end, sizeof end, "\\end{%s}", environments[i]);
        assert_int_equal(occurrences(text, begin), occurrences(text, end));
        assert_int_equal(occurrences(text, begin), 5); /* three parts, fine, printed */
    }
    assert_int_equal(occurrences(text, "\\toprule"), 5);
    assert_non_null(strstr(text, "A 100 \\% test\\_case \\& more \\{\\#1\\} \\$x\\$ "
                                 "\\textasciitilde{} \\^{} \\textbackslash{} $|$"));
    assert_non_null(strstr(text, "20 & $2.000\\cdot10^{-3}$ & $2.500\\cdot10^{-3}$ & --"));
    long depth = 0;
    for (const char *c = text; *c; c++) {
        const bool escaped = c > text && c[-1] == '\\';
        depth += (*c == '{' && !escaped) - (*c == '}' && !escaped);
        assert_true(depth >= 0);
    }
    assert_int_equal(depth, 0);
    free(text);
}

/* A scene of one field is shown once. */
static void test_one_field(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s, false);
    s.scene.axial.modelled = false;
    char *text = emit("text", &s.report);
    assert_non_null(strstr(text, "\ntotal "));
    assert_null(strstr(text, "\nbending "));
    free(text);
}

static void make_folder(char folder[64])
{
    strcpy(folder, "/tmp/beamrate plots XXXXXX");
    assert_non_null(mkdtemp(folder));
}

static bool is_there(const char *folder, const char *name)
{
    char path[256];
    struct stat info;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &info) == 0 && info.st_size > 0;
}

static void write_script(const char *folder, const char *name, const char *text)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void check_missing(const char *folder)
{
    struct br_error err = {0};
    bool missing = false;
    char *path = strdup(getenv("PATH"));
    setenv("PATH", "/dev/null", 1);
    REFUSED(br_plot_render(folder, "s0.gp", &missing, &err), BR_IO, "gnuplot");
    setenv("PATH", path, 1);
    free(path);
    assert_true(missing);
}

/* More scripts than are rendered at once; one fails, the others are done all the same, and the
 * first failure is told. */
static void test_renderer(void **state)
{
    (void)state;
    enum { SCRIPTS = 2 * BR_MOST_RENDERINGS + 1, BAD = BR_MOST_RENDERINGS + 3 };
    struct br_error err = {0};
    struct br_renderer renderer = {0};
    char folder[64], script[64], file[64], path[256];
    bool absent = false;
    make_folder(folder);
    for (int i = 0; i < SCRIPTS; i++) {
        bool missing = false;
        snprintf(script, sizeof script, "s%d.gp", i);
        write_script(folder, script,
                     i == BAD || i == SCRIPTS - 1
                         ? "plot nonsense\n"
                         : "stem = ARG0[1:strlen(ARG0)-3]\n"
                           "set terminal svg\nset output stem.'.svg'\nplot x\n"
                           "set terminal pngcairo\nset output stem.'.png'\nplot x\n"
                           "unset output\n");
        const enum br_status status = br_renderer_add(&renderer, folder, script, &missing, &err);
        if (!missing)
            MUST(status);
        absent |= missing;
    }
    snprintf(script, sizeof script, "\"s%d.gp\"", BAD);
    if (!absent)
        REFUSED(br_renderer_finish(&renderer, &err), BR_IO, script);
    assert_int_equal(renderer.count, 0);
    check_missing(folder);
    for (int i = 0; i < SCRIPTS; i++) {
        static const char *const endings[] = {"png", "svg", "gp"};
        const bool drawn = !absent && i != BAD && i != SCRIPTS - 1;
        for (size_t j = 0; j < 3; j++) {
            snprintf(file, sizeof file, "s%d.%s", i, endings[j]);
            assert_int_equal(is_there(folder, file), drawn || j == 2);
            snprintf(path, sizeof path, "%s/%s", folder, file);
            remove(path);
        }
    }
    assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_csv),       cmocka_unit_test(test_json),
        cmocka_unit_test(test_latex),     cmocka_unit_test(test_text_and_markdown),
        cmocka_unit_test(test_one_field), cmocka_unit_test(test_renderer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
