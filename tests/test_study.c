/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies: the norms' arithmetic by hand, errors in all norms against two marches that are compared
 * by textbook shape functions and Gauss points, bits against the number of threads and of norms,
 * refusals, what becomes of a cell that fails, and differences of successive grids. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "exact_points.h"
#include "solver/scene.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "support.h"

enum { NORMS = BR_TEST_NORMS, MOST_N = 40 };

static struct br_study study_of(const struct br_scene *scene, struct br_resolution reference,
                                size_t n_count, const size_t *n, size_t k_count,
                                const size_t *steps)
{
    struct br_study s = br_test_study(scene, &br_reference_fine, n_count, n, k_count, steps);
    s.reference = reference;
    return s;
}

/* ---- by hand ---- */

TEST(test_arithmetic)
{
    OWNED(br_scene) scene = br_test_bare();
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
}

static bool is_missing(double value)
{
    return isnan(value);
}

/* The norm of (25) of an error that is the same at all times, of a beam of 2 m and for 3 s: the sum
 * over time steps of k/T is 1, so T has no part in it. */
TEST(test_constant)
{
    const struct br_scene scene = {
        .length = 2, .duration = 3, .axial.modelled = true, .bending.modelled = true};
    double size[2][BR_MEASURES] = {{0}};
    size[BR_AXIAL][BR_VELOCITY] = 0.5;
    size[BR_AXIAL][BR_STRAIN_RATE] = 0.25;
    size[BR_BENDING][BR_VELOCITY] = 0.75;
    size[BR_BENDING][BR_STRAIN_RATE] = 0.125;
    const double axial = 0.5 * 0.5 + 4 * 0.25 * 0.25, bending = 0.75 * 0.75 + 16 * 0.125 * 0.125;
    const struct br_norm *norm = &br_norm_energy;
    CLOSE(br_norm_of_constant(norm, &scene, size, BR_PART_AXIAL), sqrt(axial), 1e-15);
    CLOSE(br_norm_of_constant(norm, &scene, size, BR_PART_BENDING), sqrt(bending), 1e-15);
    CLOSE(br_norm_of_constant(norm, &scene, size, BR_PART_TOTAL), sqrt(axial + bending), 1e-15);
}

/* What is not a number is not lost, and what a norm does not need does not matter. */
TEST(test_nan)
{
    OWNED(br_scene) scene = br_test_bare();
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

/* A march, or the exact solution, at one time. */
struct side {
    struct br_march *march;
    struct br_exact *exact;
    struct br_exact_state *state;
};

/* What is compared: a field or its velocity, or a derivative of it. */
struct what {
    enum br_field_kind kind;
    bool velocity, derived;
};

static void values(const struct side *s, const struct what *what, size_t count, const double *x,
                   double *value)
{
    const int order = what->kind == BR_AXIAL ? 1 : 2;
    const struct br_exact_quantity part = {what->kind, what->velocity,
                                           (unsigned)(what->derived ? order : 0)};
    if (s->exact) {
        assert_int_equal(exact_points(s->exact, s->state, &part, count, x, value, NULL), BR_OK);
        return;
    }
    double nodal[2 * (MOST_N + 1)];
    br_march_get(s->march, what->kind, what->velocity ? NULL : nodal,
                 what->velocity ? nodal : NULL);
    for (size_t i = 0; i < count; i++)
        value[i] = value_at(br_march_field(s->march, what->kind), nodal, what->derived, x[i]);
}

/* L2 distance over `pieces` equal parts of the beam, of four Gauss points each. */
static double distance(const struct side *a, const struct side *b, const struct what *what,
                       double length, size_t pieces)
{
    static const double at[] = {0.069431844202973712388, 0.33000947820757186760,
                                0.66999052179242813240, 0.93056815579702628761};
    static const double weight[] = {0.17392742256872692869, 0.32607257743127307131,
                                    0.32607257743127307131, 0.17392742256872692869};
    double x[4 * MOST_N] = {0}, one[4 * MOST_N], other[4 * MOST_N], sum = 0;
    for (size_t i = 0; i < 4 * pieces; i++)
        x[i] = length / (double)pieces * ((double)(i / 4) + at[i % 4]);
    values(a, what, 4 * pieces, x, one);
    values(b, what, 4 * pieces, x, other);
    for (size_t i = 0; i < 4 * pieces; i++)
        sum += length / (double)pieces * weight[i % 4] * (one[i] - other[i]) * (one[i] - other[i]);
    return sqrt(sum);
}

/* Of every norm and part; the largest, and when it was. */
struct errors {
    double error[NORMS][BR_PARTS], time[NORMS][BR_PARTS], rates[BR_PARTS];
    double tip[2]; /* of the cell, at the end */
};

static void add_level(const struct side *cell, const struct side *other, size_t pieces,
                      const struct br_scene *scene, double k, struct errors *e)
{
    const double end = scene->length;
    double level[NORMS][BR_PARTS] = {{0}};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct what place = {kind, false, false}, velocity = {place.kind, true, false},
                          rate = {place.kind, true, true};
        const double weight = k * pow(end, kind == BR_AXIAL ? 2 : 4) / scene->duration;
        const double rates = weight * pow(distance(cell, other, &rate, end, pieces), 2);
        double tip[2];
        values(cell, &place, 1, &end, &tip[0]);
        values(other, &place, 1, &end, &tip[1]);
        level[0][1 + kind] = distance(cell, other, &place, end, pieces);
        level[1][1 + kind] = pow(distance(cell, other, &velocity, end, pieces), 2);
        level[2][1 + kind] = fabs(tip[0] - tip[1]);
        for (int m = 0; m < NORMS; m++)
            level[m][BR_PART_TOTAL] += level[m][1 + kind];
        if (br_march_steps_done(cell->march) > 0) {
            e->rates[1 + kind] += rates;
            e->rates[BR_PART_TOTAL] += rates;
        }
        e->tip[kind] = tip[0];
    }
    for (int i = 0; i < NORMS * BR_PARTS; i++)
        if (level[i / BR_PARTS][i % BR_PARTS] > e->error[i / BR_PARTS][i % BR_PARTS]) {
            e->error[i / BR_PARTS][i % BR_PARTS] = level[i / BR_PARTS][i % BR_PARTS];
            e->time[i / BR_PARTS][i % BR_PARTS] = br_march_time(cell->march);
        }
}

/* Both side by side, compared at every time level of the cell. */
static struct errors direct(const struct br_study *s, struct br_resolution at)
{
    struct side cell = {.march = br_test_march(s->scene, at.n, at.steps, &s->method)}, other = {0};
    if (s->reference_kind->nests) {
        other.march =
            br_test_march(s->scene, s->reference.n, s->reference.steps, &s->reference_method);
    } else {
        assert_int_equal(br_exact_create(&other.exact, s->scene, NULL, NULL), BR_OK);
        assert_int_equal(br_exact_state_create(&other.state, other.exact, NULL), BR_OK);
    }
    struct errors errors = {0};
    const double k = br_time_step(s->scene, at.steps);
    for (size_t i = 0; i <= at.steps; i++) {
        br_test_advance(cell.march, i);
        if (other.march)
            br_test_advance(other.march, i * (s->reference.steps / at.steps));
        else
            br_exact_at(other.exact, (double)i * k, other.state);
        add_level(&cell, &other, other.march ? s->reference.n : 4 * at.n, s->scene, k, &errors);
    }
    for (enum br_part part = 0; part < BR_PARTS; part++)
        errors.error[1][part] = sqrt(errors.error[1][part] + errors.rates[part]);
    br_march_free(cell.march);
    br_march_free(other.march);
    br_exact_state_free(other.state);
    br_exact_free(other.exact);
    return errors;
}

static void check_cell(const struct br_study s[NORMS], size_t c)
{
    const struct errors e = direct(s, s->cell[c].at);
    for (int m = 0; m < NORMS; m++) {
        const struct br_cell *cell = &s[m].cell[c];
        assert_true(cell->at.n == s->n[c / s->k_count]);
        assert_true(cell->at.steps == s->steps[c % s->k_count]);
        assert_int_equal(cell->failure.status, BR_OK);
        for (enum br_part part = 0; part < BR_PARTS; part++) {
            const double error = e.error[m][part];
            CLOSE(cell->error[part], error,
                  (error > 0 ? 1e-15 : 1e-16) + (s->reference_kind->nests ? 1e-10 : 1e-9) * error);
            if (m == 0 && error > 1e-9)
                CLOSE(cell->worst_time[part], e.time[m][part], 1e-12);
        }
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            CLOSE(cell->tip[kind], e.tip[kind], 1e-16);
            CLOSE(s[m].reference_tip[kind], e.tip[kind], e.error[2][1 + kind] + 1e-16);
        }
    }
}

TEST(test_errors)
{
    static const struct {
        const char *scene;
        struct br_resolution reference; /* n = 0: the exact solution */
        size_t n_count, n[4], k_count, steps[4];
    } rows[] = {
        {"example2", {40, 400}, 3, {5, 10, 20}, 3, {10, 40, 200}},
        /* unordered, not a chain, time levels that hardly coincide, the reference itself */
        {"example4", {30, 90}, 4, {15, 10, 30, 1}, 4, {90, 9, 10, 2}},
        {"example3", {16, 160}, 1, {8}, 2, {32, 20}},
        /* more levels than a batch holds, and more batches than buffers */
        {"example1", {8, 1200}, 2, {2, 4}, 2, {1200, 300}},
        {"example2", {0, 0}, 2, {4, 10}, 2, {8, 20}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_scene) scene = br_test_bundled(rows[i].scene);
        struct br_study s[NORMS] = {study_of(&scene, rows[i].reference, rows[i].n_count, rows[i].n,
                                             rows[i].k_count, rows[i].steps)};
        s[0].reference_kind = rows[i].reference.n ? &br_reference_fine : &br_reference_exact;
        br_test_all_norms(s);
        MUST(br_study_run(s, 1, 2, NULL, &err));
        for (size_t c = 0; c < br_study_cells(s); c++)
            check_cell(s, c);
        for (size_t m = 0; m < NORMS; m++)
            br_study_clear(&s[m]);
    }
}

/* ---- the same bits on any number of threads, and in company or alone ---- */

enum { KEPT = 1 + 9 * BR_PARTS };

/* The errors of two studies on so many threads, all norms at once, or (0) one by one. */
static void errors_on(int threads, double out[2][NORMS][KEPT])
{
    static const size_t n[] = {4, 8, 16}, steps[] = {20, 25, 100};
    struct br_scene scene[2] = {br_test_bundled("example1"), br_test_bundled("example4")};
    struct br_study s[2 * NORMS];
    const size_t stride = threads ? 2 : 1;
    for (size_t i = 0; i < 2 * NORMS; i++) {
        s[i] = study_of(&scene[i % 2], (struct br_resolution){32, 1000}, 3, n, 3, steps);
        s[i].norm = br_norms[i / 2];
        s[i].next_norm = threads && i < 2 * NORMS - 2 ? &s[i + 2] : NULL;
    }
    for (size_t i = 0; i < 2 * NORMS && (i < 2 || !threads); i += stride)
        MUST(br_study_run(&s[i], stride, threads ? threads : 1, NULL, &err));
    for (size_t i = 0; i < 2 * NORMS; i++) {
        double *to = out[i % 2][i / 2];
        to[KEPT - 1] = s[i].reference_scale;
        for (size_t c = 0; c < 9; c++)
            memcpy(to + c * BR_PARTS, s[i].cell[c].error, BR_PARTS * sizeof *to);
        br_study_clear(&s[i]);
    }
    br_scene_clear(&scene[0]);
    br_scene_clear(&scene[1]);
}

TEST(test_same_bits)
{
    static double one[2][NORMS][KEPT], other[2][NORMS][KEPT];
    errors_on(1, one);
    for (int i = 0; i < 2 * NORMS * KEPT; i++)
        assert_true((&one[0][0][0])[i] > 0);
    for (int repeat = 0; repeat < 5; repeat++)
        for (int threads = 0; threads <= 4; threads++) {
            errors_on(threads, other);
            assert_memory_equal(one, other, sizeof one);
        }
}

/* ---- refusals ---- */

TEST(test_steps_of)
{
    struct br_scene scene = br_test_bare();
    size_t steps;
    static const double good[] = {1, 0.5, 0.01, 0.001, 1e-5, 1.0 / 3, 1e-12};
    static const size_t counts[] = {1, 2, 100, 1000, 100000, 3, 1000000000000};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        MUST(br_steps_of(&scene, good[i], &steps, &err));
        assert_true(steps == counts[i]);
    }
    REFUSED(br_steps_of(&scene, 0.03, &steps, &err), BR_BAD_INPUT,
            "the nearest that do are T/33 and T/34");
    REFUSED(br_steps_of(&scene, 2, &steps, &err), BR_BAD_INPUT, "longer than the duration");
    REFUSED(br_steps_of(&scene, 1e-13, &steps, &err), BR_BAD_INPUT, "at most 1e12");
    static const double bad[] = {0, -1, NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        REFUSED(br_steps_of(&scene, bad[i], &steps, &err), BR_BAD_INPUT, "k is");
    scene.duration = 3;
    MUST(br_steps_of(&scene, 0.01, &steps, &err));
    assert_true(steps == 300);
    CLOSE(br_time_step(&scene, 300), 0.01, 1e-17);
    scene.length = 2;
    CLOSE(br_mesh_size(&scene, 8), 0.25, 0);
}

TEST(test_nesting)
{
    static const struct {
        size_t n_count, n, k_count, steps;
        const char *text;
        size_t reference; /* steps */
    } rows[] = {
        {1, 7, 1, 10,
         "n = 7 does not nest in the reference's 60 elements; the nearest that do are 6 and 10",
         60},
        {1, 61, 1, 10, "the nearest that do are 60 and 60", 60},
        {1, 0, 1, 10, "n is 0", 60},
        {1, 6, 1, 7, "the time levels of k = 0.142857", 60}, /* 6 and 10 steps in 60 */
        {1, 6, 1, 7, "the nearest k that would do are 0.1 and 0.1666666667 s", 60},
        {1, 6, 1, 120, "the nearest k that would do are 0.01666666667 and 0.01666666667 s", 60},
        {1, 6, 1, 0, "the nearest k that would do are", 60},
        {0, 1, 1, 1, "the list of n is empty", 60},
        {1, 1, 0, 1, "the list of k is empty", 60},
        {1, 1, 1, 1, "the reference needs", 0},
    };
    OWNED(br_scene) scene = br_test_bundled("example2");
    const size_t good = 4;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        /* one bad study of two fails the call, and nothing is left of the other, before or after */
        struct br_study s[2];
        s[i % 2] = study_of(&scene, (struct br_resolution){8, 8}, 1, &good, 1, &good);
        s[1 - i % 2] = study_of(&scene, (struct br_resolution){60, rows[i].reference},
                                rows[i].n_count, &rows[i].n, rows[i].k_count, &rows[i].steps);
        REFUSED(br_study_run(s, 2, 1, NULL, &err), BR_BAD_INPUT, rows[i].text);
        assert_true(s[0].cell == NULL && s[1].cell == NULL);
    }
}

/* ---- cells that fail, or are unstable ---- */

/* sign: '.', well; '!', failed; 'u', unstable. */
static void check_sign(const struct br_cell *cell, char sign, const char *message)
{
    assert_int_equal(cell->failure.status, sign == '!' ? BR_NOT_FINITE : BR_OK);
    assert_true(sign == '!' || cell->unstable == (sign == 'u'));
    if (sign == '!' && !strstr(cell->failure.message, message))
        fail_msg("'%s' without '%s'", cell->failure.message, message);
    for (int p = 0; p < BR_PARTS; p++) {
        assert_true(isfinite(cell->error[p]) == (sign != '!'));
        assert_int_equal(cell->flag[p], sign == '!' ? BR_FLAG_FAILED : BR_FLAG_NONE);
        assert_string_equal(br_flag_name(cell->flag[p]), sign == '!' ? "failed" : "");
    }
}

/* A rod without viscosity that is pressed to an obstacle. */
static struct br_scene pressed_rod(void)
{
    struct br_scene scene = br_test_bare();
    scene.duration = 1000;
    scene.bending.modelled = false;
    scene.axial.viscosity = 0;
    scene.axial.load = br_test_load("1");
    scene.contact = (struct br_contact){.modelled = true, .gap = 0.1, .stiffness = 1000};
    return scene;
}

TEST(test_cells_that_fail)
{
    /* no number near x = 1/8: a Gauss point of n = 4, and of no finer mesh here */
    static const char always[] = "sqrt(abs(x - 0.125) - 1e-6)",
                      late[] = "t > 0.35 ? sqrt(abs(x - 0.125) - 1e-6) : 1";
    static const struct {
        const char *scene, *load; /* NULL: the pressed rod; bare with this load */
        double stiffness;         /* of the contact; 0: as it is */
        const char *contact, *reference_contact;
        struct br_resolution reference;
        size_t n_count, n[3], k_count, steps[3];
        const char *sign; /* of the cells; "": the reference fails, and with it the call */
    } rows[] = {
        {NULL, always, 0, NULL, NULL, {16, 40}, 3, {2, 4, 8}, 2, {10, 20}, "..!!.."},
        {NULL, late, 0, NULL, NULL, {16, 40}, 3, {2, 4, 8}, 2, {10, 20}, "..!!.."},
        {NULL, late, 0, NULL, NULL, {4, 20}, 1, {2}, 1, {10}, ""},
        /* the coarse steps blow up, or reach values whose squares are no numbers */
        {NULL, NULL, 0, NULL, "implicit", {4, 100000}, 1, {4}, 3, {800, 20000, 100000}, "!!."},
        /* beyond the limit of the lagged contact, k <= 5e-4 or none, the tip chatters, bounded */
        {"example2", NULL, 5e3, "lagged", NULL, {4, 4000}, 1, {4}, 3, {10, 100, 4000}, "uu."},
        {"example2", NULL, 1e3, "lagged", NULL, {4, 4000}, 1, {4}, 3, {10, 100, 4000}, "..."},
        {"example2", NULL, 5e3, "implicit", NULL, {4, 4000}, 1, {4}, 3, {10, 100, 4000}, "..."},
        /* stable below k = c / (c_H L - a) * 2 = 4.4 ms: the reference says of itself whether */
        {"chatter", NULL, 0, NULL, NULL, {4, 20}, 1, {4}, 1, {20}, "u"},
        {"chatter", NULL, 0, NULL, NULL, {4, 2000}, 1, {4}, 1, {2000}, "."},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_scene)
        scene = rows[i].scene  ? br_test_bundled(rows[i].scene)
                : rows[i].load ? br_test_bare()
                               : pressed_rod();
        if (rows[i].load)
            scene.bending.load = br_test_load(rows[i].load);
        if (rows[i].stiffness > 0)
            scene.contact.stiffness = rows[i].stiffness;
        OWNED(br_study)
        s = study_of(&scene, rows[i].reference, rows[i].n_count, rows[i].n, rows[i].k_count,
                     rows[i].steps);
        s.method = br_test_method(NULL, rows[i].contact, NULL);
        s.reference_method = br_test_method(NULL, rows[i].reference_contact, NULL);
        if (*rows[i].sign) {
            MUST(br_study_run(&s, 1, 2, NULL, &err));
            for (size_t c = 0; c < br_study_cells(&s); c++)
                check_sign(&s.cell[c], rows[i].sign[c], rows[i].load ? "x = 0.125" : "");
            assert_int_equal(s.reference_report.unstable, strcmp(rows[i].sign, "u") == 0);
        } else {
            REFUSED(br_study_run(&s, 1, 2, NULL, &err), BR_NOT_FINITE, "x = 0.125");
            assert_null(s.cell);
        }
    }
}

/* A fine run's own error, by the exact solution, is that of the same cell against it. */
TEST(test_reference_check)
{
    static const char *const names[] = {"example1", "example2", "example3", "example4"};
    const size_t n = 20, steps = 50;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        OWNED(br_scene) scene = br_test_bundled(names[i]);
        OWNED(br_study) fine = study_of(&scene, (struct br_resolution){20, 50}, 1, &n, 1, &steps);
        fine.reference_check = &br_reference_exact;
        fine.norm = br_norms[i % 3];
        MUST(br_study_run(&fine, 1, 1, NULL, &err));
        assert_non_null(fine.reference_check); /* it did not give up */
        OWNED(br_study) exact = study_of(&scene, (struct br_resolution){0}, 1, &n, 1, &steps);
        exact.reference_kind = &br_reference_exact;
        exact.norm = fine.norm;
        MUST(br_study_run(&exact, 1, 1, NULL, &err));
        for (enum br_part part = 0; part < BR_PARTS; part++)
            CLOSE(fine.reference_error[part], exact.cell[0].error[part],
                  1e-9 * exact.cell[0].error[BR_PART_TOTAL]);
        CLOSE(fine.reference_scale, exact.reference_scale,
              (1 + 1e-9) * exact.cell[0].error[BR_PART_TOTAL]);
    }
}

/* ---- the observer ---- */

struct watcher {
    atomic_int calls, stops, stop_after;
    _Atomic double last;
};

static void progress(void *self, double fraction)
{
    struct watcher *w = self;
    atomic_fetch_add(&w->calls, 1);
    if (fraction > atomic_load(&w->last))
        atomic_store(&w->last, fraction);
}

static bool stops(void *self)
{
    struct watcher *w = self;
    return atomic_fetch_add(&w->stops, 1) >= atomic_load(&w->stop_after);
}

TEST(test_observer)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    const size_t n = 4, steps = 500;
    const struct br_observer silent = {0};
    for (int threads = 1; threads <= 3; threads++)
        for (int after = 0; after < 456; after += 57) {
            const bool ends = after >= 399;
            struct watcher w = {.stop_after = ends ? 1000000 : after};
            const struct br_observer observer = {.progress = progress, .stop = stops, .self = &w};
            struct br_study s = study_of(&scene, (struct br_resolution){8, 500}, 1, &n, 1, &steps);
            const enum br_status status = br_study_run(&s, 1, threads, &observer, &err);
            if (!ends) {
                REFUSED(status, BR_INTERRUPTED, "interrupted");
                assert_null(s.cell);
                continue;
            }
            assert_true(status == BR_OK && w.last == 1 && w.calls > 3);
            br_study_clear(&s);
            MUST(br_study_run(&s, 1, threads, &silent, &err));
            br_study_clear(&s);
        }
}

/* ---- differences of successive grids, against studies of single cells ---- */

static const size_t meshes[] = {3, 6, 24}, steps[] = {10, 20, 60, 120};
enum { ROWS = sizeof meshes / sizeof *meshes, COLUMNS = sizeof steps / sizeof *steps };

static void make_grid(const struct br_scene *scene, struct br_study grid[NORMS])
{
    grid[0] = br_test_study(scene, NULL, ROWS, meshes, COLUMNS, steps);
    br_test_all_norms(grid);
}

/* One cell against a finer one, in one norm. */
static void check_difference(const struct br_study *differences, size_t i, size_t j,
                             struct br_resolution finer)
{
    const struct br_cell *cell = br_study_cell(differences, i, j);
    assert_true(cell->at.n == meshes[i] && cell->at.steps == steps[j]);
    assert_true(cell->against.n == finer.n && cell->against.steps == finer.steps);
    OWNED(br_study) s = *differences;
    s.reference_kind = &br_reference_fine;
    s.reference_method = s.method;
    s.reference = finer;
    s.n = &meshes[i], s.steps = &steps[j];
    s.n_count = s.k_count = 1;
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    for (enum br_part part = 0; part < BR_PARTS; part++)
        assert_true(s.cell[0].error[part] == cell->error[part]);
}

TEST(test_differences)
{
    OWNED(br_scene) scene = br_test_bundled("example4");
    struct br_study grid[NORMS];
    make_grid(&scene, grid);
    struct br_study over[BR_AXES][NORMS];
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        MUST(br_differences_run(grid, axis, over[axis], 2, NULL, &err));
    for (size_t m = 0; m < NORMS; m++) {
        struct br_study *h = &over[BR_AXIS_SPACE][m], *k = &over[BR_AXIS_TIME][m];
        assert_true(h->norm == br_norms[m] && k->norm == br_norms[m]);
        assert_true(h->n_count == ROWS - 1 && h->k_count == COLUMNS);
        assert_true(k->n_count == ROWS && k->k_count == COLUMNS - 1);
        for (size_t i = 0; i < ROWS; i++)
            for (size_t j = 0; j < COLUMNS; j++) {
                if (i + 1 < ROWS)
                    check_difference(h, i, j, (struct br_resolution){meshes[i + 1], steps[j]});
                if (j + 1 < COLUMNS)
                    check_difference(k, i, j, (struct br_resolution){meshes[i], steps[j + 1]});
            }
        br_study_clear(h);
        br_study_clear(k);
    }
}

TEST(test_refused_differences)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    static const size_t odd[] = {10, 15};
    static const struct {
        enum br_axis axis;
        size_t n_count, k_count;
        const size_t *n, *steps;
        const char *message;
    } bad[] = {
        {BR_AXIS_SPACE, 1, 3, meshes, steps, "found 1 meshes and 3 time steps, expected at least"},
        {BR_AXIS_TIME, 3, 1, meshes, steps, "found 3 meshes and 1 time steps, expected at least"},
        {BR_AXIS_SPACE, 2, 0, meshes, steps, "found 2 meshes and 0 time steps, expected at least"},
        {BR_AXIS_SPACE, 2, 2, odd, steps, "n = 10 does not nest in the reference's 15 elements"},
        {BR_AXIS_TIME, 2, 2, meshes, odd, "the time levels of k = 0.1 s are not all among"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct br_study grid[NORMS];
        make_grid(&scene, grid);
        grid[0].n_count = bad[i].n_count, grid[0].n = bad[i].n;
        grid[0].k_count = bad[i].k_count, grid[0].steps = bad[i].steps;
        struct br_study out[NORMS];
        REFUSED(br_differences_run(grid, bad[i].axis, out, 1, NULL, &err), BR_BAD_INPUT,
                bad[i].message);
    }
}
