/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study engine: its errors against a direct comparison of two marches, its bits
 * against the number of threads, its refusals, and what becomes of a cell that fails. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "support.h"

static struct br_study study_of(const struct br_scene *scene, struct br_resolution reference,
                                size_t n_count, const size_t *n, size_t k_count,
                                const size_t *steps)
{
    struct br_study s = br_test_study(scene, &br_judge_fine, n_count, n, k_count, steps);
    s.reference = reference;
    return s;
}

/* ---- the oracle ---- */

static double distance_now(const struct br_march *cell, const struct br_march *reference,
                           enum br_field_kind kind)
{
    const struct br_field *coarse = br_march_field(cell, kind);
    const struct br_field *fine = br_march_field(reference, kind);
    double *a = calloc(br_field_size(coarse), sizeof *a);
    double *b = calloc(br_field_size(fine), sizeof *b);
    assert_true(a && b);
    br_march_get(cell, kind, a, NULL);
    br_march_get(reference, kind, b, NULL);
    const double d =
        br_test_distance(kind, coarse->h * (double)coarse->n, coarse->n, a, fine->n, b);
    free(a);
    free(b);
    return d;
}

struct errors {
    double error[BR_PARTS], time[BR_PARTS];
};

/* (31): both marches side by side, compared at every time level of the cell. */
static struct errors direct_errors(const struct br_study *s, struct br_resolution at)
{
    struct br_march *cell = br_test_march(s->scene, at.n, at.steps, &s->method);
    struct br_march *reference =
        br_test_march(s->scene, s->reference.n, s->reference.steps, &s->reference_method);
    struct errors worst = {0};
    for (size_t i = 0; i <= at.steps; i++) {
        br_test_advance(cell, i);
        br_test_advance(reference, i * (s->reference.steps / at.steps));
        double now[BR_PARTS];
        now[BR_PART_AXIAL] = distance_now(cell, reference, BR_AXIAL);
        now[BR_PART_BENDING] = distance_now(cell, reference, BR_BENDING);
        now[BR_PART_TOTAL] = now[BR_PART_AXIAL] + now[BR_PART_BENDING];
        for (int p = 0; p < BR_PARTS; p++)
            if (now[p] > worst.error[p]) {
                worst.error[p] = now[p];
                worst.time[p] = br_march_time(cell);
            }
    }
    br_march_free(cell);
    br_march_free(reference);
    return worst;
}

static void check_against_oracle(const char *name, struct br_resolution reference, size_t n_count,
                                 const size_t *n, size_t k_count, const size_t *steps)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    struct br_study s = study_of(&scene, reference, n_count, n, k_count, steps);
    MUST(br_study_run(&s, 1, 2, NULL, &err));
    for (size_t i = 0; i < n_count; i++)
        for (size_t j = 0; j < k_count; j++) {
            const struct br_cell *cell = br_study_cell(&s, i, j);
            assert_true(cell->at.n == n[i] && cell->at.steps == steps[j]);
            assert_int_equal(cell->failure.status, BR_OK);
            const struct errors expected = direct_errors(&s, cell->at);
            for (int p = 0; p < BR_PARTS; p++) {
                CLOSE(cell->error[p], expected.error[p], 1e-15 + 1e-10 * expected.error[p]);
                if (expected.error[p] > 1e-9)
                    CLOSE(cell->worst_time[p], expected.time[p], 1e-12);
            }
        }
    br_study_clear(&s);
    br_scene_clear(&scene);
}

TEST(test_errors)
{
    check_against_oracle("example2", (struct br_resolution){40, 400}, 3,
                         (const size_t[]){5, 10, 20}, 3, (const size_t[]){10, 40, 200});
    /* unordered, not a chain, time levels that hardly coincide, the reference itself */
    check_against_oracle("example4", (struct br_resolution){30, 90}, 4,
                         (const size_t[]){15, 10, 30, 1}, 4, (const size_t[]){90, 9, 10, 2});
    check_against_oracle("example3", (struct br_resolution){16, 160}, 1, (const size_t[]){8}, 2,
                         (const size_t[]){32, 20});
}

/* More levels than a batch holds, and more batches than buffers. */
TEST(test_many_batches)
{
    check_against_oracle("example1", (struct br_resolution){8, 1200}, 2, (const size_t[]){2, 4}, 2,
                         (const size_t[]){1200, 300});
}

/* A cell that is the reference has no error at all. */
TEST(test_reference_cell)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    const size_t n = 12, steps = 30;
    struct br_study s = study_of(&scene, (struct br_resolution){12, 30}, 1, &n, 1, &steps);
    MUST(br_study_run(&s, 1, 1, NULL, &err));
    for (int p = 0; p < BR_PARTS; p++)
        AT_MOST(br_study_cell(&s, 0, 0)->error[p], 1e-16);
    assert_true(s.reference_scale > 0.02 && s.reference_scale < 0.2);
    br_study_clear(&s);
    br_scene_clear(&scene);
}

/* ---- threads ---- */

/* The errors of two studies on so many threads; out: 2 * 9 * BR_PARTS. */
static void errors_on(int threads, double *out)
{
    static const size_t n[] = {4, 8, 16}, steps[] = {20, 25, 100};
    struct br_error err = {0};
    struct br_scene scene[2] = {br_test_bundled("example1"), br_test_bundled("example4")};
    struct br_study s[2];
    for (int i = 0; i < 2; i++)
        s[i] = study_of(&scene[i], (struct br_resolution){32, 1000}, 3, n, 3, steps);
    MUST(br_study_run(s, 2, threads, NULL, &err));
    for (size_t i = 0; i < 2; i++)
        for (size_t c = 0; c < 9; c++)
            memcpy(out + (9 * i + c) * BR_PARTS, s[i].cell[c].error, BR_PARTS * sizeof *out);
    for (int i = 0; i < 2; i++) {
        br_study_clear(&s[i]);
        br_scene_clear(&scene[i]);
    }
}

TEST(test_threads)
{
    double one[2 * 9 * BR_PARTS], other[2 * 9 * BR_PARTS];
    errors_on(1, one);
    for (size_t i = 0; i < sizeof one / sizeof *one; i++)
        assert_true(one[i] > 0);
    for (int repeat = 0; repeat < 5; repeat++)
        for (int threads = 0; threads <= 4; threads++) {
            errors_on(threads, other);
            assert_memory_equal(one, other, sizeof one);
        }
}

/* ---- refusals ---- */

TEST(test_steps_of)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    size_t steps;
    static const double good[] = {1, 0.5, 0.01, 0.001, 1e-5, 1.0 / 3, 1e-12};
    static const size_t counts[] = {1, 2, 100, 1000, 100000, 3, 1000000000000};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        MUST(br_steps_of(&scene, good[i], &steps, &err));
        assert_true(steps == counts[i]);
    }
    REFUSED(br_steps_of(&scene, 0.03, &steps, &err), BR_BAD_INPUT,
            "the nearest that do are 0.0303030303 and 0.02941176471");
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
        size_t n, steps;
        const char *text;
    } rows[] = {
        {7, 10,
         "n = 7 does not nest in the reference's 60 elements; the nearest that do are 6 and 10"},
        {61, 10, "the nearest that do are 60 and 60"},
        {0, 10, "n is 0"},
        {6, 7, "k = 0.142857142857142"}, /* both nearest: 6 and 10 steps in 60 */
        {6, 7, "the nearest k that would do are 0.1 and 0.1666666667 s"},
        {6, 120, "the nearest k that would do are 0.01666666667 and 0.01666666667 s"},
        {6, 0, "the nearest k that would do are"},
    };
    struct br_scene scene = br_test_bundled("example2");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_error err = {0};
        struct br_study s =
            study_of(&scene, (struct br_resolution){60, 60}, 1, &rows[i].n, 1, &rows[i].steps);
        const enum br_status status = br_study_run(&s, 1, 1, NULL, &err);
        if (i == 3) /* the text has as many digits as it needs */
            REFUSED(status, BR_BAD_INPUT, "the time levels of k = 0.142857");
        else
            REFUSED(status, BR_BAD_INPUT, rows[i].text);
        assert_null(s.cell);
    }
    struct br_error err = {0};
    const size_t one = 1;
    struct br_study s = study_of(&scene, (struct br_resolution){60, 60}, 0, &one, 1, &one);
    REFUSED(br_study_run(&s, 1, 1, NULL, &err), BR_BAD_INPUT, "the list of n is empty");
    s = study_of(&scene, (struct br_resolution){60, 60}, 1, &one, 0, &one);
    REFUSED(br_study_run(&s, 1, 1, NULL, &err), BR_BAD_INPUT, "the list of k is empty");
    s = study_of(&scene, (struct br_resolution){60, 0}, 1, &one, 1, &one);
    REFUSED(br_study_run(&s, 1, 1, NULL, &err), BR_BAD_INPUT, "the reference needs");
    br_scene_clear(&scene);
}

/* One bad study of several fails the call, and nothing is left of the others. */
TEST(test_one_of_two_refused)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    const size_t n[] = {4, 5}, steps = 10;
    struct br_study s[2] = {study_of(&scene, (struct br_resolution){8, 10}, 1, &n[0], 1, &steps),
                            study_of(&scene, (struct br_resolution){8, 10}, 1, &n[1], 1, &steps)};
    REFUSED(br_study_run(s, 2, 1, NULL, &err), BR_BAD_INPUT, "n = 5 does not nest");
    assert_true(s[0].cell == NULL && s[1].cell == NULL);
    br_scene_clear(&scene);
}

/* ---- cells that fail ---- */

static void assert_failed(const struct br_cell *cell, enum br_status status)
{
    assert_int_equal(cell->failure.status, status);
    assert_true(strlen(cell->failure.message) > 0);
    for (int p = 0; p < BR_PARTS; p++) {
        assert_true(isnan(cell->error[p]));
        assert_int_equal(cell->flag[p], BR_FLAG_FAILED);
        assert_string_equal(br_flag_name(cell->flag[p]), "failed");
    }
}

static void assert_well(const struct br_cell *cell)
{
    assert_int_equal(cell->failure.status, BR_OK);
    for (int p = 0; p < BR_PARTS; p++) {
        assert_true(isfinite(cell->error[p]));
        assert_int_equal(cell->flag[p], BR_FLAG_NONE);
    }
}

/* A load that is no number near x = 1/8: a Gauss point of n = 4, and of no finer mesh
 * here. Once at all times, once from t = 0.35 s on. */
TEST(test_failing_row)
{
    static const char *const loads[] = {"sqrt(abs(x - 0.125) - 1e-6)",
                                        "t > 0.35 ? sqrt(abs(x - 0.125) - 1e-6) : 1"};
    for (int i = 0; i < 2; i++) {
        struct br_error err = {0};
        struct br_scene scene = br_test_bare();
        scene.bending.load = br_test_load(loads[i]);
        const size_t n[] = {2, 4, 8}, steps[] = {10, 20};
        struct br_study s = study_of(&scene, (struct br_resolution){16, 40}, 3, n, 2, steps);
        MUST(br_study_run(&s, 1, 2, NULL, &err));
        for (size_t j = 0; j < 2; j++) {
            assert_well(br_study_cell(&s, 0, j));
            assert_failed(br_study_cell(&s, 1, j), BR_NOT_FINITE);
            assert_non_null(strstr(br_study_cell(&s, 1, j)->failure.message, "x = 0.125"));
            assert_well(br_study_cell(&s, 2, j));
        }
        br_study_clear(&s);
        br_scene_clear(&scene);
    }
}

/* The lagged contact is only conditionally stable: without viscosity the coarse steps
 * blow up, or reach values whose squares are no numbers; the fine ones do neither. */
TEST(test_unstable_cell)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    scene.duration = 1000;
    scene.bending.modelled = false;
    scene.axial.viscosity = 0;
    scene.axial.load = br_test_load("1");
    scene.contact = (struct br_contact){.modelled = true, .gap = 0.1, .stiffness = 1000};
    const size_t n = 4, steps[] = {800, 20000, 100000};
    struct br_study s = study_of(&scene, (struct br_resolution){4, 100000}, 1, &n, 3, steps);
    s.reference_method.contact = br_contact_rule_find("implicit");
    MUST(br_study_run(&s, 1, 2, NULL, &err));
    assert_failed(br_study_cell(&s, 0, 0), BR_NOT_FINITE);
    assert_failed(br_study_cell(&s, 0, 1), BR_NOT_FINITE);
    assert_well(br_study_cell(&s, 0, 2));
    br_study_clear(&s);
    br_scene_clear(&scene);
}

/* Beyond the limit of the lagged contact the tip chatters, bounded: the cell is told. */
TEST(test_contact_limit)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("example2");
    const size_t n = 4, steps[] = {10, 100, 4000};
    for (int stiff = 0; stiff < 2; stiff++)
        for (int implicit = 0; implicit < 2; implicit++) {
            scene.contact.stiffness = stiff ? 5e3 : 1e3; /* stable for k <= 5e-4, always */
            struct br_study s = study_of(&scene, (struct br_resolution){4, 4000}, 1, &n, 3, steps);
            s.method.contact = br_contact_rule_find(implicit ? "implicit" : "lagged");
            MUST(br_study_run(&s, 1, 1, NULL, &err));
            assert_int_equal(s.cell[0].unstable, stiff && !implicit);
            assert_int_equal(s.cell[1].unstable, stiff && !implicit);
            assert_false(s.cell[2].unstable);
            br_study_clear(&s);
        }
    br_scene_clear(&scene);
}

/* A fine run's own error, by the exact solution, is that of the same cell judged by it. */
TEST(test_audit)
{
    static const char *const names[] = {"example1", "example2", "example3", "example4"};
    const size_t n = 20, steps = 50;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct br_error err = {0};
        struct br_scene scene = br_test_bundled(names[i]);
        struct br_study fine = study_of(&scene, (struct br_resolution){20, 50}, 1, &n, 1, &steps);
        fine.auditor = &br_judge_exact;
        fine.norm = br_norms[i % 3];
        MUST(br_study_run(&fine, 1, 1, NULL, &err));
        assert_non_null(fine.auditor); /* it did not give up */
        struct br_study exact = study_of(&scene, (struct br_resolution){0}, 1, &n, 1, &steps);
        exact.judge = &br_judge_exact;
        exact.norm = fine.norm;
        MUST(br_study_run(&exact, 1, 1, NULL, &err));
        for (int part = 0; part < BR_PARTS; part++)
            CLOSE(fine.reference_error[part], exact.cell[0].error[part],
                  1e-9 * exact.cell[0].error[BR_PART_TOTAL]);
        CLOSE(fine.reference_scale, exact.reference_scale,
              (1 + 1e-9) * exact.cell[0].error[BR_PART_TOTAL]);
        br_study_clear(&fine);
        br_study_clear(&exact);
        br_scene_clear(&scene);
    }
}

/* Lagged contact is stable below k = c / (c_H L - a) * 2 = 4.4 ms here: a fine run says of itself
 * whether it was. */
TEST(test_unstable_reference)
{
    static const size_t steps[] = {20, 2000};
    const size_t n = 4;
    struct br_scene scene = br_test_bundled("chatter");
    for (int stable = 0; stable < 2; stable++) {
        struct br_error err = {0};
        struct br_study s =
            study_of(&scene, (struct br_resolution){n, steps[stable]}, 1, &n, 1, &steps[stable]);
        MUST(br_study_run(&s, 1, 1, NULL, &err));
        assert_int_equal(s.judged_by.unstable, !stable);
        assert_int_equal(s.cell[0].unstable, !stable);
        br_study_clear(&s);
    }
    br_scene_clear(&scene);
}

/* The reference failing fails the call. */
TEST(test_failing_reference)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    scene.bending.load = br_test_load("t > 0.35 ? sqrt(abs(x - 0.125) - 1e-6) : 1");
    const size_t n = 2, steps = 10;
    struct br_study s = study_of(&scene, (struct br_resolution){4, 20}, 1, &n, 1, &steps);
    REFUSED(br_study_run(&s, 1, 2, NULL, &err), BR_NOT_FINITE, "x = 0.125");
    assert_null(s.cell);
    br_scene_clear(&scene);
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

static bool stop(void *self)
{
    struct watcher *w = self;
    return atomic_fetch_add(&w->stops, 1) >= atomic_load(&w->stop_after);
}

TEST(test_observer)
{
    struct br_scene scene = br_test_bundled("example2");
    const size_t n = 4, steps = 500;
    for (int threads = 1; threads <= 3; threads++) {
        struct br_error err = {0};
        struct watcher w = {.stop_after = 1000000};
        const struct br_observer observer = {.progress = progress, .stop = stop, .self = &w};
        struct br_study s = study_of(&scene, (struct br_resolution){8, 500}, 1, &n, 1, &steps);
        MUST(br_study_run(&s, 1, threads, &observer, &err));
        assert_true(w.last == 1 && w.calls > 3);
        br_study_clear(&s);

        for (int after = 0; after < 400; after += 57) {
            w = (struct watcher){.stop_after = after};
            s = study_of(&scene, (struct br_resolution){8, 500}, 1, &n, 1, &steps);
            REFUSED(br_study_run(&s, 1, threads, &observer, &err), BR_INTERRUPTED, "interrupted");
            assert_null(s.cell);
        }
        const struct br_observer silent = {0};
        s = study_of(&scene, (struct br_resolution){8, 500}, 1, &n, 1, &steps);
        MUST(br_study_run(&s, 1, threads, &silent, &err));
        br_study_clear(&s);
    }
    br_scene_clear(&scene);
}
