/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loads f(x, t) as sums of few products, against the direct way. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/load.h"
#include "tests/support.h"

static const double duration = 2;

static struct br_field field_of(enum br_field_kind kind, size_t n, int degree)
{
    struct br_scene scene = br_test_bare();
    scene.length = 3;
    return br_field_of_scene(&scene, kind, n, 1e-6, degree);
}

static double largest(const double *value, size_t size)
{
    double most = 0;
    for (size_t i = 0; i < size; i++)
        most = fmax(most, fabs(value[i]));
    return most;
}

/* At times of no step; how often the fit is taken. */
static size_t compare(const struct br_field *field, struct br_function *f, struct br_load_fit *fit)
{
    enum { TIMES = 101 };
    const size_t size = br_field_size(field);
    double *fitted = malloc(2 * size * sizeof *fitted), *direct = fitted + size;
    size_t taken = 0;
    assert_non_null(fitted);
    for (int i = 0; i <= TIMES; i++) {
        const double t = duration * i / TIMES;
        memset(fitted, -1, size * sizeof *fitted); /* NaN */
        if (!br_load_fit_assemble(fit, f, t, fitted))
            continue;
        taken++;
        MUST(br_assemble_load(field, f, t, direct, &err));
        const double most = largest(direct, size);
        for (size_t j = 0; j < size; j++)
            CLOSE(fitted[j], direct[j], 2e-14 * most);
    }
    free(fitted);
    return taken;
}

static const struct {
    enum br_field_kind kind;
    int degree;
} kinds[] = {{BR_AXIAL, 1}, {BR_AXIAL, 2}, {BR_BENDING, 1}};

/* Smooth loads have a fit, on meshes that cells divide and on others. */
TEST(test_smooth)
{
    static const char *const smooth[] = {
        "sin(x*t)",       "100*tanh(x + t)",        "exp(-((x - t)/0.5)^2)", "1/(1 + x*t)",
        "sin(7*x - 5*t)", "1e-200*sqrt(4 + x + t)", "-1e200*cos(3*x*t)",
    };
    static const size_t n[] = {1000, 1023, 3777};
    for (size_t i = 0; i < sizeof smooth / sizeof *smooth; i++)
        for (size_t j = 0; j < 9; j++) {
            const struct br_field field =
                field_of(kinds[j % 3].kind, n[j / 3], kinds[j % 3].degree);
            OWNED(br_function) f = br_test_function(smooth[i]);
            struct br_load_fit *fit;
            MUST(br_load_fit_create(&field, &f, duration, &fit, &err));
            if (!fit)
                fail_msg("%s, n = %zu: no fit", smooth[i], field.n);
            assert_true(compare(&field, &f, fit) > 95);
            br_load_fit_free(fit);
        }
}

/* What no few polynomials are has none: jumps, kinks, poles beside the beam, peaks that no sample
 * meets, functions without proofs; nor has a mesh or a march so short that a fit would not pay. */
TEST(test_refused)
{
    static const char *const rough[] = {
        "step(x - t)",
        "abs(x - t)",
        "max(x, t)",
        "sqrt(x*t)",
        "1/(3.0001 - x + 0*t + 0.0001*t)",
        "1 + exp(-((x - t - 1/7)/1e-4)^2)",
        "sin(1e5*x*t)",
    };
    const struct br_field field = field_of(BR_AXIAL, 1000, 1);
    struct br_load_fit *fit;
    for (size_t i = 0; i < sizeof rough / sizeof *rough; i++) {
        OWNED(br_function) f = br_test_function(rough[i]);
        MUST(br_load_fit_create(&field, &f, duration, &fit, &err));
        if (fit)
            fail_msg("%s has a fit", rough[i]);
    }
    OWNED(br_function) f = br_test_function("sin(x*t)");
    struct br_field small = field_of(BR_AXIAL, 10, 1), brief = field;
    brief.k = duration;
    MUST(br_load_fit_create(&small, &f, duration, &fit, &err));
    assert_null(fit);
    MUST(br_load_fit_create(&brief, &f, duration, &fit, &err));
    assert_null(fit);
}

/* Where f is far smaller than elsewhere, or nothing is proved, the direct way is taken. */
TEST(test_direct)
{
    const struct br_field field = field_of(BR_BENDING, 1000, 1);
    OWNED(br_function) f = br_test_function("sin(x*t)*exp(20*t)");
    struct br_load_fit *fit;
    FREED double *vector = malloc(br_field_size(&field) * sizeof *vector);
    assert_non_null(vector);
    MUST(br_load_fit_create(&field, &f, duration, &fit, &err));
    assert_non_null(fit);
    assert_true(br_load_fit_assemble(fit, &f, duration, vector));
    assert_false(br_load_fit_assemble(fit, &f, 1, vector));
    assert_false(br_load_fit_assemble(fit, &f, 0, vector));
    assert_false(br_load_fit_assemble(fit, &f, -1e-9, vector));
    assert_false(br_load_fit_assemble(fit, &f, 1.0001 * duration, vector));
    assert_false(br_load_fit_assemble(fit, &f, NAN, vector));
    br_load_fit_free(fit);
}

static enum br_status attempt(const void *data, struct br_error *why)
{
    const struct br_field field = field_of(BR_BENDING, 500, 1);
    struct br_load_fit *fit;
    const enum br_status status = br_load_fit_create(&field, data, duration, &fit, why);
    br_load_fit_free(fit);
    return status;
}

TEST(test_memory)
{
    OWNED(br_function) f = br_test_function("sin(x*t)");
    br_test_without_memory(attempt, &f, 4);
}
