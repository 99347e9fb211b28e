/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures that are made up, as they are stored in golden/made: those that have everything, and
 * those pictures that the outputs in golden/ do not hold. And gnuplot draws them. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "made_report.h"
#include "plots/beam/pictures.h"
#include "study/extremes/extremes.h"
#include "study/run/history.h"
#include "study/verify/check.h"

/* ---- any figure ---- */

/* Every pen, a flag, gaps, an upper axis, slopes, a mark, texts with quotes. */
static void fill_curves(struct br_figure *f)
{
    struct br_panel *p = br_panel_add(f, false, "time step k (s)", "isn't (m)");
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
    for (int pen = BR_PEN_CURVE; pen <= BR_PEN_BAND; pen += BR_PEN_BAND) {
        struct br_series *s = br_series_add(f, (enum br_pen)pen, "pen %d", pen);
        s->stairs = true;
        br_point_add(s, 1, 2, NULL);
        br_point_add(s, 3, 1, NULL);
    }
    for (int i = 0; i < 3; i++)
        br_point_add(&p->top, pow(10, i), 1000 >> i, NULL);
    BR_SAY(p->top_label, "steps N");
    br_mark_add(f, 10, "at 10");
    br_slope_add(f, p->series[1], 2);
}

static struct br_figure made(size_t panels)
{
    struct br_figure f = {.stem = "made", .title = "A \"map\" of 'it'", .hollow = "not fitted"};
    for (size_t i = 0; i < panels; i++)
        fill_curves(&f);
    return f;
}

/* What is stored: data, and the script unless golden/ has one of the kind. */
static void print_data(FILE *out, struct br_figure f)
{
    MUST(br_figure_check(&f, &err));
    fprintf(out, "==== %s.dat\n", f.stem);
    br_figure_write_data(out, &f);
    br_figure_clear(&f);
}

static void print(FILE *out, struct br_figure f)
{
    fprintf(out, "==== %s.gp\n", f.stem);
    br_figure_write_script(out, &f);
    print_data(out, f);
}

static void print_made(FILE *out)
{
    print(out, made(2));
}

/* At most six hues in a figure; the same title looks the same in the next panel. */
TEST(test_hues)
{
    OWNED(br_figure) f = {0};
    struct br_panel *p = br_panel_add(&f, false, "x", "y");
    for (size_t i = 0; i < 8; i++) {
        const struct br_series *s = br_series_add(&f, BR_PEN_CURVE, "%zu", i);
        assert_true(i >= BR_HUES || s->style == i + 1);
        assert_int_equal(s->pen, i < BR_HUES ? BR_PEN_CURVE : BR_PEN_OTHERS);
        br_point_add(p->series[i], 1, 1, NULL);
    }
    br_panel_add(&f, false, "x", "y");
    assert_int_equal(br_series_add(&f, BR_PEN_CURVE, "3")->style, 4);
}

/* Powers of ten are counted from a power of ten on: without a start gnuplot 5.4 puts the ticks of
 * 57.5 to 1737800 at 500, 5000, ... and the format names them 10^2, 10^3, ... The triangle is too
 * flat to be drawn; two series have no hue of their own. */
static void print_powers(FILE *out)
{
    struct br_figure f = {.stem = "powers"};
    struct br_panel *p = br_panel_add(&f, false, "x", "y");
    p->log_x = p->log_y = true;
    for (size_t i = 0; i < 8; i++) {
        struct br_series *s = br_series_add(&f, BR_PEN_CURVE, "%zu", i);
        br_point_add(s, 1e6, 10 * ((double)i + 1), NULL);
        br_point_add(s, 100, 1e-16 * ((double)i + 1), NULL);
        br_series_sort(s);
    }
    br_slope_add(&f, p->series[0], 0.5);
    print(out, f);
}

/* The longest side of a triangle rises like its order, beside the line that it belongs to; all of
 * it is on one side of each line. There is one for each order, and none where lines leave no room.
 */
TEST(test_triangles)
{
    static const double order[] = {2, 1, 1, 3}, factor[] = {1, 1, 0.5, 1e-2};
    struct br_figure f = {0};
    struct br_panel *p = br_panel_add(&f, false, "h", "error");
    p->log_x = p->log_y = true;
    for (int line = 0; line < 4; line++) {
        struct br_series *s = br_series_add(&f, BR_PEN_LINE, "%d", line);
        for (int i = 0; i < 5; i++)
            br_point_add(s, pow(0.5, i), factor[line] * pow(0.5, i * order[line]), NULL);
    }
    for (int line = 0; line < 4; line++)
        assert_int_equal(br_slope_add(&f, p->series[line], order[line]), line != 2);
    assert_int_equal(p->count, 7);
    for (size_t t = 4; t < p->count; t++) {
        const struct br_figure_point *at = p->series[t]->point;
        const double rise = log(at[2].y / at[3].y) / log(at[2].x / at[3].x);
        const int own = t == 4 ? 0 : t == 5 ? 1 : 3;
        assert_int_equal(p->series[t]->count, 5);
        assert_true(fabs(rise - order[own]) < 1e-9 && at[0].x == at[4].x && at[0].y == at[4].y);
        for (int line = 0; line < 4; line++) {
            size_t above = 0;
            for (size_t i = 0; i < 5; i++)
                above += at[i].y > factor[line] * pow(at[i].x, order[line]);
            assert_true(above == 0 || above == 5);
        }
        const double beside = at[2].y / (factor[own] * pow(at[2].x, order[own]));
        assert_true(fabs(log(beside)) < 0.1 * log(1e6));
    }
    br_figure_clear(&f);
    f = (struct br_figure){0};
    p = br_panel_add(&f, false, "h", "error");
    p->log_x = p->log_y = true;
    for (int line = 0; line < 40; line++) { /* everywhere */
        struct br_series *s = br_series_add(&f, BR_PEN_LINE, "%d", line);
        for (int i = 0; i < 5; i++)
            br_point_add(s, pow(0.5, i), pow(0.8, line) * pow(0.5, i * 2), NULL);
    }
    assert_false(br_slope_add(&f, p->series[20], 2));
    br_figure_clear(&f);
}

enum { SVG = 100000 };

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

/* gnuplot takes it without a word, and all pictures are whole. Returns whether there is a gnuplot.
 * svg: NULL, or out: the start of that picture. */
static bool draw(const struct br_figure *f, char svg[SVG])
{
    static const char *const names[] = {"made.dat", "made.gp", "made.svg", "made.png", "made.pdf"};
    char folder[] = "/tmp/beamrate-figure-XXXXXX", path[128];
    bool missing;
    struct br_gnuplot gnuplot;
    assert_non_null(mkdtemp(folder));
    write_file(folder, names[0], f, br_figure_write_data);
    write_file(folder, names[1], f, br_figure_write_script);
    enum br_status status = br_gnuplot_start(&gnuplot, folder, names[1], &missing, &err);
    if (!status)
        status = br_gnuplot_end(&gnuplot, &err);
    if (status && !missing)
        fail_msg("%s", err.message);
    for (size_t i = 0; i < 5; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        FILE *file = i == 2 && svg && !missing ? fopen(path, "r") : NULL;
        if (file)
            svg[fread(svg, 1, SVG - 1, file)] = '\0';
        assert_true(!file || fclose(file) == 0);
        const bool there = unlink(path) == 0; /* PDF where gnuplot has a terminal for it */
        assert_true(i == 4 || there == (i < 2 || !missing));
    }
    rmdir(folder);
    return !missing;
}

TEST(test_drawn)
{
    bool drawn = true;
    for (size_t panels = 1; panels <= BR_FIGURE_PANELS; panels++) {
        OWNED(br_figure) f = made(panels);
        drawn = draw(&f, NULL) && drawn;
    }
    if (!drawn)
        SKIP("gnuplot is not installed");
}

/* A point without a number interrupts the line. */
TEST(test_gap)
{
    static char svg[SVG];
    OWNED(br_figure) f = {.stem = "made"};
    br_panel_add(&f, false, "x", "y");
    struct br_series *s = br_series_add(&f, BR_PEN_LINE, "one");
    for (int i = 0; i < 5; i++)
        br_point_add(s, i, i == 2 ? (double)NAN : i, NULL);
    const bool drawn = draw(&f, svg);
    if (!drawn)
        SKIP("gnuplot is not installed");
    const char *line = strstr(svg, "data index 0");
    line = line ? strstr(line, " d='") : NULL;
    assert_non_null(line);
    size_t moves = 0, lines = 0;
    for (line += strlen(" d='"); *line && *line != '\''; line++) {
        moves += *line == 'M';
        lines += *line == 'L';
    }
    assert_int_equal(moves, 2);
    assert_int_equal(lines, 2);
}

TEST(test_no_memory)
{
    bool failed = true;
    for (long i = 0; failed; i++) {
        OWNED(br_figure) f = {0};
        br_allocation_fails_at(i);
        struct br_panel *p = br_panel_add(&f, false, "x", "y");
        br_point_add(br_series_add(&f, BR_PEN_LINE, "one"), 1, 1, NULL);
        br_point_add(&p->top, 1, 1, NULL);
        br_allocation_fails_at(-1);
        failed = br_figure_check(&f, &err) == BR_NO_MEMORY;
        assert_int_equal(failed, i < 4); /* series twice, points, ticks */
    }
}

/* ---- a study ---- */

TEST(test_names)
{
    static const char *const bad[] = {"", "a/b", "../a", "<a", "|a", "-a", "a\nb", " a"};
    OWNED(br_made_report) m;
    struct br_figure f;
    br_made_report(&m, false);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        m.report.name = bad[i];
        f = br_convergence_draw(&br_convergence_pictures[0], &m.report);
        REFUSED(br_figure_check(&f, &err), BR_BAD_INPUT, "expected the beginning of a file name");
        br_figure_clear(&f);
    }
}

/* Of more curves than hues, the first, the last and some evenly between them have one. */
TEST(test_many_curves)
{
    static const size_t steps[] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024};
    OWNED(br_made_report) m;
    br_made_report(&m, false);
    m.study.n_count = 1;
    m.study.k_count = 11;
    m.study.steps = steps;
    OWNED(br_figure) f = br_convergence_draw(&br_convergence_pictures[1], &m.report);
    assert_int_equal(f.panel[0].count, 11);
    for (size_t i = 0; i < 11; i++)
        assert_int_equal(f.panel[0].series[i]->pen, i % 2 ? BR_PEN_OTHERS : BR_PEN_CURVE);
}

/* On a beam of 2 m in 0.5 s: a mesh of n elements stands at 2 m/n, and N steps at 0.5 s/N. */
TEST(test_sizes_on_axes)
{
    OWNED(br_made_report) m;
    size_t panels[BR_AXES] = {0};
    br_made_report(&m, false);
    m.scene.length = 2;
    m.scene.duration = 0.5;
    for (int axis = 0; axis < BR_AXES; axis++) {
        struct br_observed_order *o = &m.report.observed[BR_PART_TOTAL][axis];
        *o = (struct br_observed_order){.asked = true, .points = 4};
        for (int i = 0; i < 4; i++)
            o->point[i] = (struct br_point){.z = (axis ? 0.5 : 2) / (10 << i), .error = 1};
    }
    for (size_t i = 0; i < 3; i++) {
        OWNED(br_figure) f = br_convergence_draw(&br_convergence_pictures[i], &m.report);
        for (const struct br_panel *p = f.panel; p < f.panel + f.panels; p++) {
            const bool time = strncmp(p->x_label, "time step", 9) == 0;
            const double whole = time ? 0.5 : 2;
            panels[time]++;
            assert_true(p->top.count > 0);
            for (size_t j = 0; j < p->top.count; j++)
                CLOSE(p->top.point[j].x * p->top.point[j].y, whole, 1e-12);
            const struct br_series *s = p->series[0];
            for (size_t j = 0; j < s->count; j++)
                CLOSE(whole / s->point[j].x, round(whole / s->point[j].x), 1e-9);
        }
    }
    assert_true(panels[0] > 0 && panels[1] > 0);
}

/* Residuals of a fit to errors against a fine run, whose own mesh and steps the model knows. */
TEST(test_residuals)
{
    OWNED(br_made_report) m;
    br_made_report(&m, false);
    struct br_joint_fit *fit = &m.report.fits[BR_PART_TOTAL].joint;
    m.scene.length = 2;
    m.scene.duration = 0.5;
    m.study.reference_kind = &br_reference_fine;
    m.study.reference = (struct br_resolution){800, 1600};
    fit->kind = BR_JOINT_BOTH;
    fit->r.value = 0;
    for (int axis = 0; axis < BR_AXES; axis++)
        fit->c[axis].value = fit->order[axis].value = 1;
    for (size_t c = 0; c < BR_MADE_CELLS; c++) {
        struct br_cell *cell = &m.study.cell[c];
        const double of_h = 2.0 / (double)cell->at.n - 2.0 / 800,
                     of_k = 0.5 / (double)cell->at.steps - 0.5 / 1600;
        cell->error[BR_PART_TOTAL] = 1.25 * hypot(of_h, of_k);
    }
    OWNED(br_figure) f = br_convergence_draw(&br_convergence_pictures[2], &m.report);
    size_t drawn = 0;
    assert_int_equal(f.panels, 2);
    for (size_t i = 0; i < f.panel[1].count; i++)
        for (size_t j = 0; j < f.panel[1].series[i]->count; j++)
            if (!isnan(f.panel[1].series[i]->point[j].y)) {
                CLOSE(f.panel[1].series[i]->point[j].y, 0.25, 1e-12);
                drawn++;
            }
    assert_int_equal(drawn, BR_MADE_CELLS - 1); /* one failed */
}

/* All pictures of a study in the norm of energy, whose joint fit describes it: slopes, residuals,
 * orders, printed errors. */
static void print_study(FILE *out)
{
    OWNED(br_made_report) m;
    br_made_report(&m, false);
    m.study.norm = &br_norm_energy;
    for (int part = 0; part < BR_PARTS; part++)
        for (int axis = 0; axis < BR_AXES; axis++) {
            struct br_observed_order *o = &m.report.observed[part][axis];
            const double one = 1 + part + 3 * axis;
            *o = (struct br_observed_order){
                .asked = true, .points = 4, .theory.formal = part ? 2 : 1};
            o->order = part == 2 ? (struct br_estimate){NAN, NAN, NAN}
                                 : (struct br_estimate){one, one - 0.1, one + 0.2};
            snprintf(o->by, sizeof o->by, "errors of %d", part == 1 ? 0 : part);
            for (int i = 0; i < 4; i++) {
                o->point[i] = (struct br_point){
                    .z = 0.1 / (1 << i),
                    .error = one / (1 << i),
                    .fit = {1.01 * one / (1 << i), one / (1 << i) - 0.01, one / (1 << i) + 0.02}};
                if (part == 2)
                    o->point[i].fit = o->order;
            }
            o->point[0].flag = BR_FLAG_COARSE;
            o->point[3].flag = part ? BR_FLAG_FAILED : BR_FLAG_OUTLIER;
        }
    for (size_t i = 0; br_convergence_pictures[i].name; i++) {
        const struct br_figure f = br_convergence_draw(&br_convergence_pictures[i], &m.report);
        for (size_t j = 0; j < f.panels; j++) /* residuals may be below zero */
            assert_true(f.panel[j].log_y == !strstr(f.panel[j].y_label, "joint fit"));
        (i == 0 ? print : print_data)(out, f);
    }
}

/* ---- a check ---- */

/* As many checks as wanted, of an order of each verdict each; the second has no interval. */
static struct br_figure draw_checks(size_t count)
{
    static const struct br_expectation expected[] = {{.order = 2, .tolerance = 0.1},
                                                     {.order = NAN},
                                                     {.order = 2, .highest = 4, .tolerance = 0.2}};
    static const struct br_estimate orders[] = {{2, 1.9, 2.05}, {NAN, NAN, NAN}, {3, 1, 4}};
    struct br_case cases[BR_INCONCLUSIVE + 1] = {0};
    struct br_check check[60] = {0};
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        cases[v] = (struct br_case){.kind = BR_VERIFY_TIME,
                                    .expected = expected[v],
                                    .measure = "a_b's",
                                    .part = v ? "axial" : "",
                                    .order = orders[v],
                                    .verdict = (enum br_verdict)v};
    for (size_t i = 0; i < count; i++)
        check[i] = (struct br_check){
            .name = i ? "other" : "first", .cases = cases, .count = BR_INCONCLUSIVE + 1};
    return br_check_draw(check, count);
}

/* A row an order; of many orders, a row a check. */
static void print_checks(FILE *out)
{
    print(out, draw_checks(1));
    print(out, draw_checks(11));
}

TEST(test_checks)
{
    struct br_figure f = draw_checks(0);
    assert_int_equal(f.panels, 0); /* nothing to draw */
    f = draw_checks(10);
    assert_string_equal(f.panel[0].series[0]->title, "PASS");
    assert_true(br_extent(&f.panel[0], true).low == -30);
    br_figure_clear(&f);
    f = draw_checks(11);
    assert_true(br_extent(&f.panel[0], true).low == -11);
    BR_SAY(f.stem, "made");
    draw(&f, NULL);
    br_figure_clear(&f);
}

/* ---- extremes ---- */

static void print_floors(FILE *out)
{
    size_t n[] = {10, 100};
    double k[] = {0.1, 0.01, 0.001};
    struct br_floor floor[12];
    static char name[] = "one";
    const struct br_scene scene = {.name = name};
    struct br_floors floors = {.scene = {&scene},
                               .scenes = 1,
                               .method.count = 2,
                               .n_count = 2,
                               .k_count = 3,
                               .floors = 12,
                               .floor = floor};
    MUST(br_named_method_read("euler+riccati", &floors.method.list[0], &err));
    MUST(br_named_method_read("euler+umfpack", &floors.method.list[1], &err));
    for (int i = 0; i < 12; i++)
        floor[i] = (struct br_floor){.n = n[i / 3 % 2],
                                     .steps = 20,
                                     .k = k[i % 3],
                                     .deviation = {1e-15 * (i + 1), 1e-14 * (i + 1)}};
    br_fail(&floor[8].refused, BR_BAD_INPUT, "no");
    print_data(out, br_floors_draw(&floors, 2));
}

static void print_drifts(FILE *out)
{
    size_t steps[] = {10, 1000, 7};
    struct br_floor drift[12];
    static char name[][4] = {"one", "two"};
    const struct br_scene one = {.name = name[0]}, two = {.name = name[1]};
    struct br_floors d = {.gathered = true,
                          .scene = {&one, &two},
                          .scenes = 2,
                          .method.count = 2,
                          .solvers = 1,
                          .n_count = 1,
                          .k_count = 3,
                          .floors = 12,
                          .floor = drift};
    MUST(br_named_method_read("euler+lagged+riccati", &d.method.list[0], &err));
    MUST(br_named_method_read("bdf2+riccati", &d.method.list[1], &err));
    for (int i = 0; i < 12; i++)
        drift[i] = (struct br_floor){.of = steps[i % 3],
                                     .steps = steps[i % 3],
                                     .deviation = {1e-16 * (i + 1), 1e-17},
                                     .predicted = 1e-13 * (i + 1)};
    drift[11].steps = 0;
    print(out, br_floors_draw(&d, 0));
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
                                    .samples = LOOKS,
                                    .field = field};
}

static void print_history(FILE *out)
{
    struct br_history_record r;
    struct br_history_row row[LOOKS];
    double field[LOOKS * 18];
    OWNED(br_scene) scene = br_test_bundled("example2");
    make_record(&r, row, field);
    print(out, br_history_draw(&scene, &r));
}

static void print_all(FILE *out)
{
    print_made(out);
    print_powers(out);
    print_study(out);
    print_floors(out);
    print_drifts(out);
    print_history(out);
    print_checks(out);
}

TEST(test_stored)
{
    br_test_stored("figures", print_all, 1e-12);
}
