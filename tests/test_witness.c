/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Certificates of every time scheme: the tables of the literature are of the order that the
 * registry claims, sound marches pass stage by stage, and a scheme taken for another, a law or a
 * coefficient that is a little off are seen. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/certificate.h"
#include "reference/textbook.h"
#include "study/scene/file.h"
#include "support.h"

/* ---- the tables ---- */

/* sum_i b_i c_i^power, b being the last row. */
static double moment(const struct br_textbook *t, int row, int power)
{
    double sum = 0;
    for (int j = 0; j < t->rows; j++)
        sum += (double)t->a[row][j] * (power == 0 ? 1 : pow((double)t->c[j], power));
    return sum;
}

/* Quadrature and, for order 3 and 4, sum b a c = 1/6, sum b a c^2 = 1/12, sum b c a c = 1/8,
 * sum b a a c = 1/24 (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.2).
 */
static void check_order(const struct br_textbook *t, int order)
{
    const int last = t->rows - 1;
    double bac = 0, bacc = 0, bcac = 0, baac = 0;
    for (int i = 0; i < t->rows; i++) {
        CLOSE(moment(t, i, 0), (double)t->c[i], 4e-15);
        bac += (double)t->a[last][i] * moment(t, i, 1);
        bacc += (double)t->a[last][i] * moment(t, i, 2);
        bcac += (double)(t->a[last][i] * t->c[i]) * moment(t, i, 1);
        for (int j = 0; j < t->rows; j++)
            baac += (double)(t->a[last][i] * t->a[i][j]) * moment(t, j, 1);
    }
    assert_true(t->c[last] == 1);
    for (int power = 0; power < order; power++)
        CLOSE(moment(t, last, power), 1.0 / (power + 1), 4e-15);
    if (order >= 3)
        CLOSE(bac, 1.0 / 6, 4e-15);
    if (order >= 4) {
        CLOSE(bacc, 1.0 / 12, 4e-15);
        CLOSE(bcac, 1.0 / 8, 4e-15);
        CLOSE(baac, 1.0 / 24, 4e-15);
    }
}

/* Y_n = sum past_j Y_{n-1-j} + beta k Y'_n is exact for t^p at t = 0, -1, -2, ... */
static void check_differences(const struct br_textbook *t, int order)
{
    for (int p = 0; p <= order; p++) {
        double sum = p == 1 ? (double)t->beta : 0;
        for (int j = 0; j < t->back; j++)
            sum += (double)t->past[j] * pow(-(j + 1), p);
        CLOSE(sum, p == 0 ? 1 : 0, 4e-15);
    }
}

/* A start of one order less costs no order: it is a single step. */
static void test_tables(void **state)
{
    (void)state;
    for (size_t i = 0; br_time_schemes[i]; i++) {
        const struct br_time_scheme *scheme = br_time_schemes[i];
        for (size_t since = 0; since < 4; since++) {
            const struct br_textbook *t = br_textbook_step(scheme->name, since);
            assert_non_null(t);
            const int order =
                scheme->order - (t->rows > 0 && t->c[0] != 0 && scheme->order == 3 && t->rows == 2);
            if (t->rows > 0)
                check_order(t, order);
            else
                check_differences(t, t->back);
            assert_true(since < 2 || t->rows > 0 || t->back == scheme->order);
        }
    }
    assert_null(br_textbook_step("no such scheme", 0));
}

/* ---- marches ---- */

struct watched_march {
    struct br_scene scene;
    struct br_method method;
    struct br_march *march;
    struct br_witness *witness;
    struct br_certificate limits;
};

/* As the witness is told: another method, another scene, perhaps. */
static void start(struct watched_march *w, const char *scene, const char *solver,
                  const struct br_time_scheme *scheme, size_t n, size_t steps)
{
    w->scene = br_test_bundled(scene);
    w->method = br_test_method(solver, "implicit", "exact");
    w->method.scheme = scheme;
    if (scheme->needs_damping) { /* as much as lets no mode grow */
        const double k = w->scene.duration / (double)steps;
        w->scene.axial.viscosity = fmax(w->scene.axial.viscosity, k * w->scene.axial.stiffness);
        w->scene.bending.viscosity =
            fmax(w->scene.bending.viscosity, k * w->scene.bending.stiffness);
    }
    w->march = br_test_march(&w->scene, n, steps, &w->method);
    w->limits = br_certificate_limits(scheme, n, br_test_slack() * br_march_round_off(w->march));
}

static void finish(struct watched_march *w)
{
    br_witness_free(w->witness);
    br_march_free(w->march);
    br_scene_clear(&w->scene);
}

static void watch(struct watched_march *w, const struct br_scene *scene,
                  const struct br_method *method)
{
    struct br_error err = {0};
    MUST(br_witness_create(&w->witness, w->march, scene, method, &err));
}

/* The first step that the certificate refuses, with its message in err; 0: none. */
static size_t first_refused(struct watched_march *w, size_t steps, struct br_error *err)
{
    struct br_error own = {0};
    for (size_t step = 1; step <= steps; step++) {
        br_test_must(br_march_step(w->march, &own), &own, "a step", __FILE__, __LINE__);
        const struct br_certificate c = br_witness_step(w->witness);
        if (br_certificate_check(&c, &w->limits, err))
            return step;
    }
    return 0;
}

static void test_sound_marches(void **state)
{
    (void)state;
    static const char *const scenes[] = {"example1", "example4",    "impact",  "release",
                                         "reversal", "moving_load", "chatter", "vibration"};
    static const size_t meshes[] = {1, 7, 60};
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t s = 0; s < 8 * 3 * 2; s++) {
            struct br_error err = {0};
            struct watched_march w = {0};
            const char *solver = s % 2 ? "plain" : "riccati";
            start(&w, scenes[s / 6], solver, br_time_schemes[i], meshes[s / 2 % 3], 60);
            watch(&w, &w.scene, &w.method);
            const size_t step = first_refused(&w, 60, &err);
            if (step)
                fail_msg("%s, %s, %s, n = %zu: step %zu: %s", br_time_schemes[i]->name,
                         scenes[s / 6], solver, meshes[s / 2 % 3], step, err.message);
            finish(&w);
        }
}

/* Marches of one scene on many meshes with every scheme, each step certified. */
static void certify(const char *scene)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t n = 10; n <= 100; n += 6) {
            struct br_error err = {0};
            struct watched_march w = {0};
            start(&w, scene, NULL, br_time_schemes[i], n, 100);
            watch(&w, &w.scene, &w.method);
            const size_t step = first_refused(&w, 100, &err);
            if (step)
                fail_msg("%s, %s, n = %zu: step %zu: %s", scene, br_time_schemes[i]->name, n, step,
                         err.message);
            finish(&w);
        }
}

/* A switch on a time level, as at 0.8 s: no step is left that is so short that its force is noise.
 */
static void test_switch_on_a_level(void **state)
{
    (void)state;
    certify("example3");
}

/* A load that jumps just behind a switch: the search for that jump does not begin with such a step,
 * either. */
static void test_jump_behind_a_switch(void **state)
{
    (void)state;
    certify("mms_reversal");
}

static bool same_tables(const struct br_time_scheme *a, const struct br_time_scheme *b)
{
    for (size_t since = 0; since < 3; since++)
        if (br_textbook_step(a->name, since) != br_textbook_step(b->name, since))
            return false;
    return true;
}

/* Each scheme's march as another scheme's. */
static void test_other_scheme(void **state)
{
    (void)state;
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t j = 0; br_time_schemes[j]; j++) {
            const struct br_time_scheme *is = br_time_schemes[i], *told = br_time_schemes[j];
            if (same_tables(is, told))
                continue;
            struct br_error err = {0};
            struct watched_march w = {0};
            start(&w, "release", NULL, is, 10, 50);
            struct br_method method = w.method;
            method.scheme = told;
            watch(&w, &w.scene, &method);
            if (first_refused(&w, 50, &err) == 0)
                fail_msg("a march by %s passed for one by %s", is->name, told->name);
            finish(&w);
        }
}

/* The witness is told a coefficient that is off by one part in a million. */
static void spoil(size_t which, struct br_scene *scene)
{
    double *const values[] = {&scene->axial.stiffness,     &scene->axial.viscosity,
                              &scene->bending.stiffness,   &scene->bending.viscosity,
                              &scene->contact.stiffness,   &scene->contact.gap,
                              &scene->friction.coefficient};
    *values[which] *= 1 + 1e-6;
}

static void test_spoilt_scenes(void **state)
{
    (void)state;
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t which = 0; which < 7; which++) {
            struct br_error err = {0};
            struct watched_march w = {0};
            start(&w, "chatter", NULL, br_time_schemes[i], 10, 200);
            struct br_scene told = w.scene;
            spoil(which, &told);
            watch(&w, &told, &w.method);
            if (first_refused(&w, 200, &err) == 0)
                fail_msg("%s: value %zu off by 1e-6 passed", br_time_schemes[i]->name, which);
            finish(&w);
        }
}

/* To be watched changes nothing. */
static void test_watched_is_unwatched(void **state)
{
    (void)state;
    enum { N = 21, SIZE = 2 * (N + 1) };
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (int solver = 0; solver < 2; solver++) {
            struct br_error err = {0};
            struct watched_march w = {0};
            start(&w, "chatter", solver ? "plain" : "riccati", br_time_schemes[i], N, 100);
            watch(&w, &w.scene, &w.method);
            struct br_march *alone = br_test_march(&w.scene, N, 100, &w.method);
            assert_int_equal(first_refused(&w, 100, &err), 0);
            br_test_advance(alone, 100);
            double a[2][SIZE], b[2][SIZE];
            br_march_get(w.march, BR_BENDING, a[0], a[1]);
            br_march_get(alone, BR_BENDING, b[0], b[1]);
            assert_memory_equal(a, b, sizeof a);
            br_march_free(alone);
            finish(&w);
        }
}

static void test_refusals(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct watched_march w = {0};
    start(&w, "release", NULL, br_time_schemes[0], 4, 10);
    const struct br_time_scheme unknown = {.name = "unknown"};
    struct br_method method = w.method;
    method.scheme = &unknown;
    REFUSED(br_witness_create(&w.witness, w.march, &w.scene, &method, &err), BR_BAD_INPUT,
            "scheme unknown has no certificate");
    assert_null(w.witness);
    watch(&w, &w.scene, &w.method);
    const struct br_certificate none = br_witness_step(w.witness);
    assert_true(isnan(none.update) && isnan(none.bending_residual));
    finish(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_sound_marches),
        cmocka_unit_test(test_switch_on_a_level),
        cmocka_unit_test(test_jump_behind_a_switch),
        cmocka_unit_test(test_other_scheme),
        cmocka_unit_test(test_spoilt_scenes),
        cmocka_unit_test(test_watched_is_unwatched),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
