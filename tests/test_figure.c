/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures: what is filled in stands in the data file, and gnuplot draws the script; and those
 * pictures that golden/ does not hold have the numbers of their results, along axes that name them.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "figure_check.h"
#include "made_report.h"
#include "plots/pictures.h"
#include "plots/render.h"
#include "study/extremes/energy_behaviour.h"
#include "study/extremes/floors.h"
#include "study/extremes/map.h"
#include "study/run/history.h"

/* ---- any figure ---- */

static void expect(const struct br_figure *f, void (*write)(FILE *, const struct br_figure *),
                   const char *part)
{
    char *text = figure_written(f, write);
    if (!strstr(text, part))
        fail_msg("expected:\n%s\nin:\n%.3000s", part, text);
    free(text);
}

/* Every pen, a flag, gaps, an upper axis, slopes, a mark, texts with quotes. */
static void fill_curves(struct br_figure *f)
{
    struct br_panel *p = br_panel_add(f, "time step k (s)", "isn't (m)");
    p->log_x = p->log_y = true;
    BR_SAY(p->title, "it's {/:Italic n}");
    br_series_add(f, BR_PEN_SIGNS, "in the key alone"); /* no block of the data */
    for (int pen = 0; pen < BR_PENS; pen++) {
        struct br_series *s = br_series_add(f, (enum br_pen)pen, "pen %d", pen);
        for (int i = 0; i < 4; i++)
            br_point_add(s, pow(10, i) / 3,
                         i == 1   ? NAN
                         : i == 2 ? -1
                                  : 0.1 + pen + i,
                         i == 3 ? "far" : NULL);
    }
    br_point_add(br_series_add(f, BR_PEN_LINE, "nowhere"), 1, INFINITY, NULL);
    for (int i = 0; i < 3; i++)
        br_point_add(&p->top, pow(10, i), 1000 >> i, NULL);
    BR_SAY(p->top_label, "steps N");
    br_mark_add(f, 10, "at 10");
    br_slopes_add(f, 2, (const double[]){1, 2});
}

/* 3 cells by 2, of unequal size; a line with a gap. */
static void fill_cells(struct br_figure *f)
{
    static const double x[] = {1, 10, 1000, 1e4}, y[] = {1e-4, 1e-2, 1};
    static const double value[] = {1e-3, 2, INFINITY, 0, NAN, 1e5};
    struct br_panel *p = br_panel_add(f, "c_H (N/m)", "k (s)");
    struct br_cells *c = br_cells_make(f, 3, 2);
    assert_non_null(c);
    for (size_t i = 0; i < 6; i++)
        assert_true(isnan(c->value[i]));
    memcpy(c->x, x, sizeof x);
    memcpy(c->y, y, sizeof y);
    memcpy(c->value, value, sizeof value);
    p->log_x = p->log_y = true;
    struct br_series *line = br_series_add(f, BR_PEN_GUIDE, "limit of %s", "it");
    br_point_add(line, 1, 1e-4, NULL);
    br_point_add(line, NAN, 1, NULL);
    br_point_add(line, 1e4, 1, NULL);
}

static struct br_figure made(size_t panels, bool cells, size_t kinds)
{
    struct br_figure f = {.stem = "made",
                          .title = "A \"map\" of 'it'",
                          .hollow = "not fitted",
                          .value = {1e-2, 10},
                          .kinds = kinds};
    for (size_t k = 0; k < kinds; k++)
        BR_SAY(f.kind[k], "kind %zu", k);
    for (size_t i = 0; i < panels; i++)
        cells ? fill_cells(&f) : fill_curves(&f);
    return f;
}

/* Every title once, though there are two panels. */
static void check_key(const struct br_figure *f)
{
    char *script = figure_written(f, br_figure_write_script);
    const char *first = strstr(script, "title 'pen 3'");
    assert_true(first && !strstr(first + 1, "title 'pen 3'"));
    free(script);
}

static void test_data(void **state)
{
    (void)state;
    struct br_figure curves = made(2, false, 0), cells = made(2, true, 0), kinds = made(1, true, 2);
    figure_check(&curves);
    figure_check(&cells);
    figure_check(&kinds);
    expect(&curves, br_figure_write_data, "# A flag tells why a point is not fitted");
    expect(&curves, br_figure_write_script, "title 'in the key alone'");
    expect(&curves, br_figure_write_script, "title 'at 10'");
    expect(&curves, br_figure_write_script, "set label '2' at ");
    check_key(&curves);
    expect(&cells, br_figure_write_script, "set cbrange [0.01:10]");
    expect(&kinds, br_figure_write_data, "# value 1: kind 1\n");
    expect(&kinds, br_figure_write_script, "title 'no case'");
    expect(&kinds, br_figure_write_script, "title 'limit of it'");
    br_figure_clear(&curves);
    br_figure_clear(&cells);
    br_figure_clear(&kinds);
}

/* Infinity has the end's colour; no number and no kind has none. */
static void test_colours(void **state)
{
    (void)state;
    struct br_figure f = {.value = {1e-2, 10}};
    assert_true(br_colour_of(&f, 0) == 1e-2 && br_colour_of(&f, INFINITY) == 10);
    assert_true(br_colour_of(&f, 2) == 2 && br_colour_of(&f, NAN) == -1);
    f.kinds = 2;
    assert_true(br_colour_of(&f, 0) == 0 && br_colour_of(&f, 1) == 1);
    assert_true(br_colour_of(&f, 2) == -1 && br_colour_of(&f, -1) == -1);
    assert_true(br_colour_of(&f, NAN) == -1);
}

/* At most six hues in a figure; the same title looks the same in the next panel. */
static void test_hues(void **state)
{
    (void)state;
    struct br_figure f = {0};
    struct br_panel *p = br_panel_add(&f, "x", "y");
    for (size_t i = 0; i < 8; i++) {
        const struct br_series *s = br_series_add(&f, BR_PEN_CURVE, "%zu", i);
        assert_true(i >= BR_HUES || s->look == i + 1);
        assert_int_equal(s->pen, i < BR_HUES ? BR_PEN_CURVE : BR_PEN_OTHERS);
        br_point_add(p->series[i], 1, 1, NULL);
    }
    br_panel_add(&f, "x", "y");
    assert_int_equal(br_series_add(&f, BR_PEN_CURVE, "3")->look, 4);
    expect(&f, br_figure_write_script, "title 'others'");
    br_figure_clear(&f);
}

/* Powers of ten are counted from a power of ten on: without a start gnuplot 5.4 puts the ticks of
 * 57.5 to 1737800 at 500, 5000, ... and the format names them 10^2, 10^3, ... */
static void test_powers(void **state)
{
    (void)state;
    struct br_figure f = {0};
    struct br_panel *p = br_panel_add(&f, "x", "y");
    p->log_x = p->log_y = true;
    struct br_series *s = br_series_add(&f, BR_PEN_CURVE, "one");
    br_point_add(s, 100, 1e-16, NULL);
    br_point_add(s, 1e6, 10, NULL);
    expect(&f, br_figure_write_script, "set xrange [57.5439937:1737800.83]");
    expect(&f, br_figure_write_script, "set xtics nomirror 1e1,1e1;");
    expect(&f, br_figure_write_script, "set ytics nomirror 1e-18,1e2;");
    br_figure_clear(&f);
}

/* Slopes rise right of the points, and are those that they say. */
static void test_slopes(void **state)
{
    (void)state;
    static const double order[] = {0.5, 2};
    struct br_figure f = {0};
    struct br_panel *p = br_panel_add(&f, "x", "y");
    p->log_x = p->log_y = true;
    struct br_series *s = br_series_add(&f, BR_PEN_CURVE, "one");
    br_point_add(s, 100, 3, NULL);
    br_point_add(s, 1, 7, NULL);
    br_series_sort(s);
    assert_true(s->point[0].x == 1 && s->point[0].y == 7 && s->point[1].x == 100);
    br_slopes_add(&f, 2, order);
    for (size_t i = 0; i < 2; i++) {
        const struct br_figure_point *at = p->series[1 + i]->point;
        assert_true(at[0].x > 100 && at[0].y == 3 && at[1].x > at[0].x);
        CLOSE(log(at[1].y / at[0].y) / log(at[1].x / at[0].x), order[i], 1e-12);
    }
    br_figure_clear(&f);
}

static void write_file(const char *folder, const char *name, const struct br_figure *f,
                       void (*write)(FILE *, const struct br_figure *))
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    write(file, f);
    assert_int_equal(fclose(file), 0);
}

/* gnuplot takes it without a word, and all pictures are whole. */
static void draw(const struct br_figure *f)
{
    static const char *const names[] = {"made.dat", "made.gp", "made.svg", "made.png", "made.pdf"};
    char folder[] = "/tmp/beamrate-figure-XXXXXX", path[128];
    bool missing;
    struct br_gnuplot gnuplot;
    struct br_error err = {0};
    assert_non_null(mkdtemp(folder));
    write_file(folder, names[0], f, br_figure_write_data);
    write_file(folder, names[1], f, br_figure_write_script);
    enum br_status status = br_gnuplot_start(&gnuplot, folder, names[1], NULL, &missing, &err);
    if (!status)
        status = br_gnuplot_end_figure(&gnuplot, &err);
    if (status && !missing)
        fail_msg("%s", err.message);
    for (size_t i = 0; i < 5; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        const bool there = unlink(path) == 0; /* PDF where gnuplot has a terminal for it */
        assert_true(i == 4 || there == (i < 2 || !missing));
    }
    rmdir(folder);
}

static void test_drawn(void **state)
{
    (void)state;
    for (size_t panels = 1; panels <= BR_FIGURE_PANELS; panels++)
        for (size_t how = 0; how < 3; how++) {
            struct br_figure f = made(panels, how > 0, how == 2 ? 2 : 0);
            draw(&f);
            br_figure_clear(&f);
        }
}

static void test_no_memory(void **state)
{
    (void)state;
    struct br_error err = {0};
    bool failed = true;
    for (long i = 0; failed; i++) {
        struct br_figure f = {0};
        br_allocation_fails_at(i);
        struct br_panel *p = br_panel_add(&f, "x", "y");
        br_point_add(br_series_add(&f, BR_PEN_LINE, "one"), 1, 1, NULL);
        br_point_add(&p->top, 1, 1, NULL);
        br_cells_make(&f, 2, 2);
        br_allocation_fails_at(-1);
        failed = br_figure_check(&f, &err) == BR_NO_MEMORY;
        assert_int_equal(failed, i < 7); /* series twice, points, ticks, edges twice, values */
        br_figure_clear(&f);
    }
}

/* ---- a study ---- */

static void test_names(void **state)
{
    (void)state;
    static const char *const bad[] = {"", "a/b", "../a", "<a", "|a", "-a", "a\nb", " a"};
    struct br_made_report m;
    struct br_error err = {0};
    struct br_figure f;
    br_made_report(&m, false);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        m.report.name = bad[i];
        f = br_convergence_draw(br_convergence_pictures[0], &m.report);
        REFUSED(br_figure_check(&f, &err), BR_BAD_INPUT, "expected the beginning of a file name");
        br_figure_clear(&f);
    }
    br_made_report_clear(&m);
}

/* ---- extremes ---- */

static void test_floors(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_figure f;
    size_t n[] = {10, 100};
    double k[] = {0.1, 0.01, 0.001};
    struct br_floor floor[12];
    struct br_floors floors = {
        .scenes = 1, .methods = 2, .n_count = 2, .k_count = 3, .floors = 12, .floor = floor};
    MUST(br_named_method_read("euler+riccati", &floors.method[0], &err));
    MUST(br_named_method_read("euler+umfpack", &floors.method[1], &err));
    for (int i = 0; i < 12; i++)
        floor[i] = (struct br_floor){.n = n[i / 3 % 2],
                                     .steps = 20,
                                     .k = k[i % 3],
                                     .deviation = {1e-15 * (i + 1), 1e-14 * (i + 1)}};
    br_fail(&floor[8].refused, BR_BAD_INPUT, "no");
    f = br_floors_draw(&floors, 2);
    MUST(br_figure_check(&f, &err));
    assert_string_equal(f.stem, "floors-k0.001");
    figure_axes(&f.panel[0], "elements n", "relative deviation");
    for (size_t s = 0; s < 2; s++)
        for (size_t i = 0; i < 2; i++)
            figure_point(f.panel[0].series[s], i, (double)n[i],
                         s == 1 && i == 0 ? (double)NAN : floor[(s * 2 + i) * 3 + 2].deviation[1]);
    figure_point(figure_series(&f.panel[0], "2^{-53} n^{4}"), 1, 100, DBL_EPSILON / 2 * 1e8);
    assert_int_equal(figure_series(&f.panel[0], "2^{-53} n")->pen, BR_PEN_GUIDE);
    figure_check(&f);
    br_figure_clear(&f);
}

static void test_drifts(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_figure f;
    size_t steps[] = {10, 1000, 7};
    struct br_floor drift[12];
    struct br_floors d = {.gathered = true,
                          .scenes = 2,
                          .methods = 2,
                          .solvers = 1,
                          .n_count = 1,
                          .k_count = 3,
                          .floors = 12,
                          .floor = drift};
    MUST(br_named_method_read("euler+lagged+riccati", &d.method[0], &err));
    MUST(br_named_method_read("bdf2+riccati", &d.method[1], &err));
    for (int i = 0; i < 12; i++)
        drift[i] = (struct br_floor){.of = steps[i % 3],
                                     .steps = steps[i % 3],
                                     .deviation = {1e-16 * (i + 1), 1e-17},
                                     .predicted = 1e-13 * (i + 1)};
    drift[11].steps = 0;
    f = br_floors_draw(&d, 0);
    MUST(br_figure_check(&f, &err));
    for (size_t scene = 0; scene < 2; scene++) {
        const struct br_panel *p = &f.panel[scene];
        figure_axes(p, "steps N", "relative deviation");
        for (size_t c = 0; c < 2; c++)
            for (size_t j = 0; j < 3; j++) {
                const size_t i = (scene * 2 + c) * 3 + j;
                figure_point(p->series[c], j, (double)steps[j],
                             i == 11 ? (double)NAN : drift[i].deviation[0]);
            }
        figure_point(figure_series(p, "predicted"), 1, 1000, drift[scene * 6 + 1].predicted);
        assert_int_equal(figure_series(p, "predicted")->pen, BR_PEN_GUIDE);
    }
    figure_check(&f);
    br_figure_clear(&f);
}

static void test_energy(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_figure f;
    static struct br_vibration_row row[4];
    for (int i = 0; i < 4; i++) { /* two schemes, undamped and damped */
        row[i] = (struct br_vibration_row){
            .scheme = br_time_schemes[i % 2], .kind = BR_AXIAL, .damping = i < 2 ? 0 : 0.01};
        for (int r = 0; r < BR_VIBRATION_RATES; r++)
            for (int density = 0; density < BR_VIBRATION_DENSITIES; density++)
                row[i].at[r][density] =
                    (struct br_vibration){.steps = 10 * (r + 1) + i,
                                          .measured = -1e-3 * (r + 1 + 10 * i) * (density + 1),
                                          .predicted = 1e-5 * (r + 1 + 10 * i) * (density + 1)};
    }
    const struct br_energy_behaviour b = {.vibration = row, .vibrations = 4};
    f = br_energy_draw(&b);
    MUST(br_figure_check(&f, &err));
    for (int i = 0; i < 4; i++) {
        const struct br_panel *p = &f.panel[i / 2];
        figure_axes(p, "steps a period", "share lost a period, size");
        assert_string_equal(p->series[i % 2]->title, row[i].scheme->name);
        for (size_t r = 0; r < BR_VIBRATION_RATES; r++) {
            const struct br_vibration *v = &row[i].at[r][BR_VIBRATION_DENSITIES / 2];
            figure_point(p->series[i % 2], r, v->steps, v->predicted);
            figure_point(p->series[2 + i % 2], r, v->steps, -v->measured);
        }
        assert_int_equal(p->series[2 + i % 2]->pen, BR_PEN_RINGS);
    }
    figure_check(&f);
    br_figure_clear(&f);
}

/* The cells are those of the planes that the map counts. */
static void test_map(void **state)
{
    (void)state;
    enum { CASES = 40 };
    struct br_error err = {0};
    struct br_figure f;
    static struct br_extreme_case one[CASES];
    static struct br_extreme_verdict verdict[CASES];
    for (size_t i = 0; i < CASES; i++) {
        br_extreme_draw(1, i, &one[i]);
        verdict[i].which = (enum br_extreme_class)(i % BR_EXTREME_CLASSES);
    }
    const struct br_extreme_map map = {.cases = CASES, .one = one, .verdict = verdict};
    f = br_extreme_map_draw(&map);
    MUST(br_figure_check(&f, &err));
    assert_int_equal(f.kinds, BR_EXTREME_CLASSES);
    for (size_t i = 0; i < f.kinds; i++)
        assert_string_equal(f.kind[i], br_extreme_names[i].title);
    for (size_t i = 0; i < BR_EXTREME_PLANES; i++) {
        const struct br_extreme_plane *plane = &br_extreme_planes[i];
        const struct br_cells *c = &f.panel[i].cells;
        double cell[1024];
        assert_true(c->columns == plane->x.cells && c->rows == plane->y.cells);
        br_extreme_plane_fill(&map, plane, cell);
        assert_memory_equal(c->value, cell, c->rows * c->columns * sizeof *cell);
        figure_axes(&f.panel[i], plane->x.title, plane->y.title);
        CLOSE(log10(c->x[0]), plane->x.low, 1e-12);
        CLOSE(log10(c->x[c->columns]), plane->x.high, 1e-12);
        CLOSE(log10(c->y[c->rows]), plane->y.high, 1e-12);
    }
    figure_check(&f);
    br_figure_clear(&f);
}

/* ---- a run ---- */

enum { LOOKS = 3 };

/* Two elements, P1 and Hermite; as many rows as looks. */
static void make_record(struct br_history_record *r, struct br_history_row row[LOOKS],
                        double field[LOOKS * 18])
{
    for (size_t i = 0; i < LOOKS; i++) {
        const double x = (double)i + 1;
        row[i] = (struct br_history_row){i,      0.5 * x, {3 * x, 5 * x}, {7 * x, 11 * x},
                                         13 * x, 17 * x,  19 * x};
    }
    row[0].friction_force = NAN; /* as at t = 0 */
    for (size_t i = 0; i < LOOKS * 18; i++)
        field[i] = 100 + (double)i;
    *r = (struct br_history_record){.n = 2,
                                    .unknowns = {1, 2},
                                    .row = row,
                                    .rows = LOOKS,
                                    .at = row,
                                    .looks = LOOKS,
                                    .field = field};
}

static void test_letters(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_history_record r;
    struct br_history_row row[LOOKS];
    double field[LOOKS * 18];
    struct br_figure f;
    struct br_scene scene = br_test_bundled("example2");
    make_record(&r, row, field);
    f = br_history_draw(&scene, &r);
    MUST(br_figure_check(&f, &err));
    for (size_t i = 0; i < LOOKS; i++) {
        const double t = row[i].time;
        figure_point(figure_series(&f.panel[0], "u"), i, t, row[i].displacement[BR_AXIAL]);
        figure_point(figure_series(&f.panel[1], "w"), i, t, row[i].displacement[BR_BENDING]);
        figure_point(figure_series(&f.panel[2], "contact"), i, t, row[i].contact_force);
        figure_point(figure_series(&f.panel[3], "friction"), i, t, row[i].friction_force);
        figure_point(figure_series(&f.panel[3], "bound"), i, t, row[i].friction_bound);
    }
    figure_axes(&f.panel[0], "time (s)", "horizontal displacement of the tip, u(L) (m)");
    figure_axes(&f.panel[1], "time (s)", "vertical displacement of the tip, w(L) (m)");
    figure_axes(&f.panel[2], "time (s)", "contact force (N)");
    br_figure_clear(&f);
    br_scene_clear(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_data),      cmocka_unit_test(test_colours),
        cmocka_unit_test(test_hues),      cmocka_unit_test(test_slopes),
        cmocka_unit_test(test_drawn),     cmocka_unit_test(test_names),
        cmocka_unit_test(test_powers),    cmocka_unit_test(test_floors),
        cmocka_unit_test(test_drifts),    cmocka_unit_test(test_energy),
        cmocka_unit_test(test_map),       cmocka_unit_test(test_letters),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
