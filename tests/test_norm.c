/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The norms: their arithmetic by hand, and a study in all of them at once against two
 * marches that are compared by textbook shape functions and Gauss points. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/exact/exact.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "support.h"

/* ---- by hand ---- */

TEST(test_arithmetic)
{
    struct br_scene scene = br_test_bare();
    scene.length = 2, scene.duration = 5;
    struct br_sample a = {.time = 1, .weight = 0.5}, b = {.time = 2, .weight = 0.25};
    a.size[BR_AXIAL][BR_DISPLACEMENT] = 3, a.size[BR_BENDING][BR_DISPLACEMENT] = 4;
    b.size[BR_AXIAL][BR_DISPLACEMENT] = 1, b.size[BR_BENDING][BR_DISPLACEMENT] = 5;
    struct br_norm_sum sum = {0};
    br_norm_add(&br_norm_l2, &scene, &a, &sum);
    br_norm_add(&br_norm_l2, &scene, &b, &sum);
    CLOSE(br_norm_value(&br_norm_l2, &sum, BR_PART_TOTAL), 7, 0);
    CLOSE(br_norm_value(&br_norm_l2, &sum, BR_PART_AXIAL), 3, 0);
    CLOSE(br_norm_value(&br_norm_l2, &sum, BR_PART_BENDING), 5, 0);
    assert_true(sum.time[BR_PART_TOTAL] == 1 && sum.time[BR_PART_BENDING] == 2);

    a.size[BR_AXIAL][BR_VELOCITY] = 3, a.size[BR_BENDING][BR_VELOCITY] = 4;
    a.size[BR_AXIAL][BR_STRAIN_RATE] = 2, a.size[BR_BENDING][BR_STRAIN_RATE] = 1;
    b.size[BR_AXIAL][BR_STRAIN_RATE] = 1, b.size[BR_BENDING][BR_STRAIN_RATE] = 3;
    sum = (struct br_norm_sum){0};
    br_norm_add(&br_norm_energy, &scene, &a, &sum);
    br_norm_add(&br_norm_energy, &scene, &b, &sum);
    /* 9 + (0.5 * 4 + 0.25 * 1) * 4/5, and 16 + (0.5 * 1 + 0.25 * 9) * 16/5 */
    CLOSE(br_norm_value(&br_norm_energy, &sum, BR_PART_AXIAL), sqrt(9 + 1.8), 1e-15);
    CLOSE(br_norm_value(&br_norm_energy, &sum, BR_PART_BENDING), sqrt(16 + 8.8), 1e-15);
    CLOSE(br_norm_value(&br_norm_energy, &sum, BR_PART_TOTAL), sqrt(25 + 10.6), 1e-15);
    br_scene_clear(&scene);
}

static bool is_missing(double value)
{
    return isnan(value);
}

/* What is not a number is not lost, and what a norm does not need does not matter. */
TEST(test_nan)
{
    struct br_scene scene = br_test_bare();
    for (const struct br_norm *const *norm = br_norms; *norm; norm++)
        for (int measure = 0; measure < BR_MEASURES; measure++) {
            struct br_sample bad = {.time = 1, .weight = 1}, good = {.time = 2, .weight = 1};
            bad.size[BR_BENDING][measure] = nan("");
            struct br_norm_sum sum = {0};
            br_norm_add(*norm, &scene, &bad, &sum);
            br_norm_add(*norm, &scene, &good, &sum);
            const bool needed = br_norm_needs(*norm, (enum br_measure)measure);
            assert_true(is_missing(br_norm_value(*norm, &sum, BR_PART_TOTAL)) == needed);
            assert_false(is_missing(br_norm_value(*norm, &sum, BR_PART_AXIAL)));
            double size[2][BR_MEASURES] = {{0}};
            size[BR_AXIAL][measure] = nan("");
            assert_true(is_missing(br_norm_of_constant(*norm, &scene, size, BR_PART_TOTAL)) ==
                        needed);
            scene.axial.modelled = false;
            assert_false(is_missing(br_norm_of_constant(*norm, &scene, size, BR_PART_TOTAL)));
            scene.axial.modelled = true;
        }
    br_scene_clear(&scene);
}

/* ---- the oracle ---- */

/* A finite element function or its derivative (order 1 axial, 2 bending) at x, from nodal
 * values as in solver/field.h: the textbook's shape functions. */
static double value_at(const struct br_field *f, const double *nodal, bool derived, double x)
{
    const double h = f->h;
    size_t e = (size_t)(x / h);
    e = e < f->n ? e : f->n - 1;
    const double s = x / h - (double)e;
    if (f->kind == BR_AXIAL) {
        const double a = nodal[e], b = nodal[e + 1];
        return derived ? (b - a) / h : a * (1 - s) + b * s;
    }
    const double *v = nodal + 2 * e;
    if (derived)
        return (v[0] * (12 * s - 6) + v[1] * (6 * s - 4) + v[2] * (6 - 12 * s) +
                v[3] * (6 * s - 2)) /
               (h * h);
    return v[0] * (1 - 3 * s * s + 2 * s * s * s) + v[1] * (s - 2 * s * s + s * s * s) +
           v[2] * (3 * s * s - 2 * s * s * s) + v[3] * (s * s * s - s * s);
}

/* Values of what a march is compared with, at one time: count points x. */
struct other {
    void (*values)(void *self, enum br_field_kind kind, bool velocity, bool derived, size_t count,
                   const double *x, double *value);
    void *self;
};

enum { GAUSS = 4 };
static const double gauss_x[GAUSS] = {0.069431844202973712388, 0.33000947820757186760,
                                      0.66999052179242813240, 0.93056815579702628761};
static const double gauss_weight[GAUSS] = {0.17392742256872692869, 0.32607257743127307131,
                                           0.32607257743127307131, 0.17392742256872692869};

/* L2 distance over `pieces` equal parts of the beam. */
static double distance(const struct br_march *march, const struct other *other,
                       enum br_field_kind kind, bool velocity, bool derived, size_t pieces)
{
    const struct br_field *f = br_march_field(march, kind);
    double *nodal = calloc(br_field_size(f), sizeof *nodal);
    assert_non_null(nodal);
    br_march_get(march, kind, velocity ? NULL : nodal, velocity ? nodal : NULL);
    const double width = f->h * (double)f->n / (double)pieces;
    double sum = 0;
    for (size_t i = 0; i < pieces; i++) {
        double x[GAUSS], value[GAUSS];
        for (int q = 0; q < GAUSS; q++)
            x[q] = width * ((double)i + gauss_x[q]);
        other->values(other->self, kind, velocity, derived, GAUSS, x, value);
        for (int q = 0; q < GAUSS; q++) {
            const double d = value_at(f, nodal, derived, x[q]) - value[q];
            sum += width * gauss_weight[q] * d * d;
        }
    }
    free(nodal);
    return sqrt(sum);
}

struct expected {
    double l2, energy, tip; /* totals */
};

struct sums {
    double level, velocity, rates;
    double tip;
};

static void add_level(const struct br_march *march, const struct other *other, size_t pieces,
                      double k, struct sums *s)
{
    const struct br_field *f = br_march_field(march, BR_AXIAL);
    const double length = f->h * (double)f->n, end = length;
    double level = 0, velocity = 0, tip = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const enum br_field_kind field = (enum br_field_kind)kind;
        level += distance(march, other, field, false, false, pieces);
        const double v = distance(march, other, field, true, false, pieces);
        const double rate = distance(march, other, field, true, true, pieces);
        velocity += v * v;
        if (br_march_steps_done(march) > 0)
            s->rates += k * rate * rate;
        double there;
        other->values(other->self, field, false, false, 1, &end, &there);
        tip += fabs(br_march_tip_displacement(march, field) - there);
    }
    s->level = fmax(s->level, level);
    s->velocity = fmax(s->velocity, velocity);
    s->tip = fmax(s->tip, tip);
}

static void march_values(void *self, enum br_field_kind kind, bool velocity, bool derived,
                         size_t count, const double *x, double *value)
{
    const struct br_march *march = self;
    const struct br_field *f = br_march_field(march, kind);
    double *nodal = calloc(br_field_size(f), sizeof *nodal);
    assert_non_null(nodal);
    br_march_get(march, kind, velocity ? NULL : nodal, velocity ? nodal : NULL);
    for (size_t i = 0; i < count; i++)
        value[i] = value_at(f, nodal, derived, x[i]);
    free(nodal);
}

struct exact {
    struct br_exact *exact;
    struct br_exact_state *state;
};

static void exact_values(void *self, enum br_field_kind kind, bool velocity, bool derived,
                         size_t count, const double *x, double *value)
{
    const struct exact *e = self;
    const struct br_exact_part part = {
        .field = kind == BR_AXIAL ? BR_EXACT_AXIAL : BR_EXACT_BENDING,
        .velocity = velocity,
        .order = derived ? (kind == BR_AXIAL ? 1 : 2) : 0,
    };
    assert_int_equal(br_exact_evaluate(e->exact, e->state, &part, count, x, value, NULL), BR_OK);
}

/* All norms of a cell of a scene with L = T = 1, against a finer run or the exact solution. */
static struct expected direct(const struct br_study *s, struct br_resolution at)
{
    struct br_march *cell = br_test_march(s->scene, at.n, at.steps, &s->method);
    struct br_march *fine = NULL;
    struct exact e = {0};
    struct other other = {exact_values, &e};
    if (s->judge->nests) {
        fine = br_test_march(s->scene, s->reference.n, s->reference.steps, &s->reference_method);
        other = (struct other){march_values, fine};
    } else {
        assert_int_equal(br_exact_create(&e.exact, s->scene, NULL, NULL), BR_OK);
        assert_int_equal(br_exact_state_create(&e.state, e.exact, NULL), BR_OK);
    }
    struct sums sums = {0};
    for (size_t i = 0; i <= at.steps; i++) {
        br_test_advance(cell, i);
        if (fine)
            br_test_advance(fine, i * (s->reference.steps / at.steps));
        else
            br_exact_at(e.exact, (double)i / (double)at.steps, e.state);
        add_level(cell, &other, fine ? s->reference.n : 4 * at.n, 1.0 / (double)at.steps, &sums);
    }
    br_march_free(cell);
    br_march_free(fine);
    br_exact_state_free(e.state);
    br_exact_free(e.exact);
    return (struct expected){sums.level, sqrt(sums.velocity + sums.rates), sums.tip};
}

enum { NORMS = BR_TEST_NORMS };

static void check_study(const char *name, const struct br_judge *judge)
{
    static const size_t n[] = {4, 10}, steps[] = {8, 20};
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    struct br_study s[NORMS] = {br_test_study(&scene, judge, 2, n, 2, steps)};
    s[0].reference = (struct br_resolution){20, 40};
    br_test_all_norms(s);
    MUST(br_study_run(s, 1, 2, NULL, &err));
    for (size_t c = 0; c < 4; c++) {
        const struct expected e = direct(&s[0], s[0].cell[c].at);
        CLOSE(s[0].cell[c].error[BR_PART_TOTAL], e.l2, 1e-15 + 1e-9 * e.l2);
        CLOSE(s[1].cell[c].error[BR_PART_TOTAL], e.energy, 1e-9 * e.energy);
        CLOSE(s[2].cell[c].error[BR_PART_TOTAL], e.tip, 1e-15 + 1e-9 * e.tip);
    }
    for (size_t m = 0; m < NORMS; m++)
        br_study_clear(&s[m]);
    br_scene_clear(&scene);
}

TEST(test_against_marches)
{
    check_study("example2", &br_judge_fine);
    check_study("example1", &br_judge_fine);
}

TEST(test_against_exact)
{
    check_study("example2", &br_judge_exact);
}

/* A norm alone and in company has the same bits; the tips are kept in all. */
TEST(test_company)
{
    static const size_t n = 6, steps = 30;
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example4");
    struct br_study s[NORMS] = {br_test_study(&scene, &br_judge_exact, 1, &n, 1, &steps)};
    br_test_all_norms(s);
    MUST(br_study_run(s, 1, 2, NULL, &err));
    struct br_march *march = br_test_march(&scene, n, steps, &s[0].method);
    br_test_advance(march, steps);
    for (size_t m = 0; m < NORMS; m++) {
        struct br_study alone = s[m];
        alone.next_norm = NULL;
        MUST(br_study_run(&alone, 1, 1, NULL, &err));
        for (int p = 0; p < BR_PARTS; p++)
            assert_true(alone.cell->error[p] == s[m].cell->error[p]);
        assert_true(alone.reference_scale == s[m].reference_scale);
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            CLOSE(s[m].cell->tip[kind], br_march_tip_displacement(march, (enum br_field_kind)kind),
                  0);
            CLOSE(s[m].cell->tip[kind], s[m].reference_tip[kind], 0.05);
            assert_true(s[m].reference_tip[kind] == alone.reference_tip[kind]);
        }
        br_study_clear(&alone);
        br_study_clear(&s[m]);
    }
    br_march_free(march);
    br_scene_clear(&scene);
}

/* ---- an auditor that knows nothing at one level ---- */

static size_t audited_level;

static enum br_status odd_create(void **self, const struct br_judge_request *r,
                                 struct br_error *err)
{
    (void)r, (void)err;
    *self = NULL;
    return BR_OK;
}

static void odd_free(void *self)
{
    (void)self;
}

static enum br_status odd_advance(void *self, enum br_field_kind kind, size_t i,
                                  struct br_error *err)
{
    (void)self, (void)kind, (void)err;
    audited_level = i;
    return BR_OK;
}

static void odd_look(void *self, const struct br_sample_at *at, struct br_view *view)
{
    (void)self;
    br_view_modes(view, at->measure == BR_TIP
                            ? 0
                            : br_mode_count((struct br_elements){at->kind, 1}, at->measure));
    view->values[0] = audited_level == 4 ? NAN : 1;
}

TEST(test_nan_audit)
{
    static const size_t n = 1, steps = 8;
    static const struct br_judge odd = {.name = "odd",
                                        .create = odd_create,
                                        .free = odd_free,
                                        .advance = odd_advance,
                                        .sample = odd_look};
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    struct br_study s = br_test_study(&scene, &br_judge_fine, 1, &n, 1, &steps);
    s.reference = (struct br_resolution){1, 8};
    s.auditor = &odd;
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    assert_true(isnan(s.reference_error[BR_PART_TOTAL]));
    br_study_clear(&s);
    br_scene_clear(&scene);
}
