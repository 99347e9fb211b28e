/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots' files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plots/plots.h"
#include "support.h"

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

static void remove_folder(const char *folder)
{
    for (const struct br_plot *const *p = br_plots; *p; p++) {
        static const char *const endings[] = {"gp", "dat", "svg", "png"};
        for (size_t i = 0; i < 4; i++) {
            char path[256];
            snprintf(path, sizeof path, "%s/sample-%s.%s", folder, (*p)->name, endings[i]);
            remove(path);
        }
    }
    assert_int_equal(rmdir(folder), 0); /* and nothing else was in it */
}

/* Written with data beside it; drawn where gnuplot is; and told where it is not. */
static void test_plots(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct sample s;
    char folder[64];
    sample_init(&s, true);
    make_folder(folder);
    for (const struct br_plot *const *p = br_plots; *p; p++) {
        char script[128], data[128], picture[128];
        bool missing = false;
        assert_true((*p)->applies(&s.report));
        MUST(br_plot_file(*p, &s.report, "gp", script, sizeof script, &err));
        MUST(br_plot_file(*p, &s.report, "dat", data, sizeof data, &err));
        MUST(br_plot_file(*p, &s.report, "png", picture, sizeof picture, &err));
        MUST(br_plot_write(*p, &s.report, folder, &err));
        assert_true(is_there(folder, script) && is_there(folder, data));
        const enum br_status status = br_plot_render(folder, script, &missing, &err);
        if (!missing) {
            MUST(status);
            assert_true(is_there(folder, picture));
        }
    }
    char *path = strdup(getenv("PATH"));
    bool missing = false;
    setenv("PATH", "/dev/null", 1);
    REFUSED(br_plot_render(folder, "sample-h.gp", &missing, &err), BR_IO, "gnuplot");
    setenv("PATH", path, 1);
    free(path);
    assert_true(missing);
    remove_folder(folder);
    s.report.name = "../evil";
    char script[128];
    REFUSED(br_plot_file(br_plots[0], &s.report, "gp", script, sizeof script, &err), BR_BAD_INPUT,
            "evil");
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
    remove_folder(folder);
}

/* The data of "error against h" hold every error that is a number. */
static void test_plot_data(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s, false);
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    br_plot_find("h")->write_data(out, &s.report);
    fclose(out);
    for (size_t i = 0; i < CELLS; i++) {
        char number[32];
        snprintf(number, sizeof number, "%.17g", s.cell[i].error[0]);
        if (isfinite(s.cell[i].error[0]))
            assert_non_null(strstr(text, number));
    }
    assert_non_null(strstr(text, "NaN"));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plots),
        cmocka_unit_test(test_renderer),
        cmocka_unit_test(test_plot_data),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
