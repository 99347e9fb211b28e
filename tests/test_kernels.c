/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every kernel of the fast solver against the recursion as it is written down, field by field: any
 * number of elements, any data, any load, forces at the tip that no law has chosen. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

enum { STEPS = 40, MOST_N = 1500 };

static const struct br_linear_solver *const solvers[] = {&br_riccati, &br_plain};

struct pair {
    struct br_field field;
    const struct br_field_solver *solver[2];
    void *state[2];
    double *load, *value[2];
    size_t size;
    double scale[2]; /* largest displacement and velocity so far */
};

static struct br_field random_field(struct br_test_random *r)
{
    struct br_field field = {
        .kind = (enum br_field_kind)br_test_index(r, 2),
        .n = 1 + (size_t)br_test_log_uniform(r, 1, MOST_N),
        .density = br_test_index(r, 4) ? br_test_log_uniform(r, 1e-3, 1e3) : 0,
        .stiffness = br_test_log_uniform(r, 1e-2, 1e2),
        .viscosity = br_test_index(r, 4) ? br_test_log_uniform(r, 1e-3, 10) : 0,
        .k = br_test_log_uniform(r, 1e-5, 0.1),
    };
    field.h = br_test_log_uniform(r, 0.1, 10) / (double)field.n;
    return field;
}

static void start(struct pair *p, struct br_test_random *r, const struct br_kernel *kernel)
{
    struct br_error err = {0};
    p->field = random_field(r);
    p->size = br_field_size(&p->field);
    p->load = calloc(p->size, sizeof *p->load);
    assert_non_null(p->load);
    for (int i = 0; i < 2; i++) {
        struct br_linear_options options = br_linear_defaults;
        options.kernel = kernel;
        p->solver[i] = p->field.kind == BR_AXIAL ? solvers[i]->axial : solvers[i]->bending;
        p->value[i] = calloc(2 * p->size, sizeof *p->value[i]);
        assert_non_null(p->value[i]);
        MUST(p->solver[i]->create(&p->field, &options, &p->state[i], &err));
    }
    CLOSE(p->solver[0]->tip_compliance(p->state[0]), p->solver[1]->tip_compliance(p->state[1]),
          1e-11 * p->solver[1]->tip_compliance(p->state[1]));
}

static void finish(struct pair *p)
{
    for (int i = 0; i < 2; i++) {
        p->solver[i]->free(p->state[i]);
        free(p->value[i]);
    }
    free(p->load);
}

/* Smooth nodal values that respect the clamp; bending: with the scaled slope. */
static void fill_smooth(const struct pair *p, double *nodal, double size, double waves)
{
    const size_t d = br_field_unknowns(&p->field);
    for (size_t i = 0; i <= p->field.n; i++) {
        const double x = (double)i / (double)p->field.n;
        nodal[i * d] = size * x * x * cos(waves * x);
        if (d == 2)
            nodal[i * d + 1] = size / (double)p->field.n *
                               (2 * x * cos(waves * x) - waves * x * x * sin(waves * x));
    }
}

static void set(struct pair *p, struct br_test_random *r)
{
    double *nodal = calloc(2 * p->size, sizeof *nodal);
    assert_non_null(nodal);
    fill_smooth(p, nodal, br_test_uniform(r, -1, 1), br_test_uniform(r, 0, 5));
    fill_smooth(p, nodal + p->size, br_test_uniform(r, -1, 1), br_test_uniform(r, 0, 5));
    for (int i = 0; i < 2; i++)
        p->solver[i]->set(p->state[i], nodal, nodal + p->size);
    free(nodal);
}

/* None, one that is the same at every node, or one that is not. */
static struct br_drive random_load(struct pair *p, struct br_test_random *r)
{
    const size_t kind = br_test_index(r, 3), d = br_field_unknowns(&p->field);
    const double even = br_test_uniform(r, -1, 1);
    for (size_t i = 0; i < p->size; i++)
        p->load[i] = p->field.h * (kind == 1 ? (i % d ? 0 : even) : br_test_uniform(r, -1, 1));
    for (size_t i = p->size - d; i < p->size; i++)
        p->load[i] = p->field.h * br_test_uniform(r, -1, 1); /* the last node is like no other */
    return (struct br_drive){.vector = kind ? p->load : NULL, .changed = true};
}

/* Velocities are found from g = alpha kappa_w + kappa_v, and have the round-off of both. */
static double magnitude(const struct pair *p, int which)
{
    const double rate = p->field.viscosity + p->field.k * p->field.stiffness;
    return p->scale[which] + (which ? p->field.stiffness / rate * p->scale[0] : 0);
}

static void compare(struct pair *p, int which, const char *kernel)
{
    for (size_t j = 0; j < p->size; j++)
        p->scale[which] = fmax(p->scale[which], fabs(p->value[1][(size_t)which * p->size + j]));
    const double round_off = br_riccati.round_off(&p->field, &br_linear_defaults) +
                             br_plain.round_off(&p->field, &br_linear_defaults);
    for (size_t j = (size_t)which * p->size; j < (size_t)(which + 1) * p->size; j++)
        if (!(fabs(p->value[0][j] - p->value[1][j]) <= round_off * magnitude(p, which)))
            fail_msg("%s, n = %zu: %s %zu is %.17g, expected %.17g +- %g", kernel, p->field.n,
                     which ? "velocity" : "displacement", j, p->value[0][j], p->value[1][j],
                     round_off * magnitude(p, which));
}

static void step(struct pair *p, struct br_drive *drive, double force, const char *kernel)
{
    struct br_error err = {0};
    double tip[2], free_tip[2];
    for (int i = 0; i < 2; i++) {
        MUST(p->solver[i]->predict(p->state[i], drive, &free_tip[i], &err));
        tip[i] = p->solver[i]->finish(p->state[i], force);
        p->solver[i]->get(p->state[i], p->value[i], p->value[i] + p->size);
    }
    drive->changed = false;
    compare(p, 0, kernel);
    compare(p, 1, kernel);
    const double round_off = 2 * br_riccati.round_off(&p->field, &br_linear_defaults);
    const double pull = magnitude(p, 1) + fabs(force) * p->solver[1]->tip_compliance(p->state[1]);
    CLOSE(tip[0], tip[1], round_off * pull);
    CLOSE(free_tip[0], free_tip[1], round_off * pull);
    CLOSE(p->solver[0]->tip_displacement(p->state[0]), p->solver[1]->tip_displacement(p->state[1]),
          round_off * p->scale[0]);
}

static void check_strain_rate(struct pair *p)
{
    const double scale =
        4 * magnitude(p, 1); /* a strain is a difference of four nodal values or two */
    const size_t count = p->field.n * br_field_unknowns(&p->field);
    for (int i = 0; i < 2; i++)
        p->solver[i]->strain_rate(p->state[i], p->value[i]);
    for (size_t j = 0; j < count; j++)
        CLOSE(p->value[0][j], p->value[1][j],
              br_riccati.round_off(&p->field, &br_linear_defaults) * scale);
}

static void check(const struct br_kernel *kernel, uint64_t seed)
{
    struct br_test_random r = {seed};
    struct pair p = {0};
    start(&p, &r, kernel);
    if (br_test_index(&r, 2))
        set(&p, &r);
    struct br_drive drive = random_load(&p, &r);
    for (int i = 0; i < STEPS; i++) {
        if (br_test_index(&r, 8) == 0)
            drive = random_load(&p, &r);
        drive.factor = br_test_uniform(&r, -1, 1);
        drive.tip[0] = br_test_uniform(&r, -1, 1);
        drive.tip[1] = p.field.kind == BR_BENDING ? p.field.h * br_test_uniform(&r, -1, 1) : 0;
        step(&p, &drive, br_test_uniform(&r, -1, 1), kernel->name);
    }
    check_strain_rate(&p);
    finish(&p);
}

static void test_all_kernels(void **state)
{
    (void)state;
    const uint64_t cases = br_test_quick() ? 8 : 400;
    size_t kernels = 0;
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        if (!(*k)->available())
            continue;
        kernels++;
        for (uint64_t seed = 1; seed <= cases; seed++)
            check(*k, seed);
    }
    assert_true(kernels >= 1);
    assert_true(br_kernel_best()->available());
}

static void test_find(void **state)
{
    (void)state;
    for (const struct br_kernel *const *k = br_kernels; *k; k++)
        assert_ptr_equal(br_kernel_find((*k)->name), *k);
    assert_null(br_kernel_find("sse2"));
    assert_null(br_kernel_find(""));
}

static bool never(void)
{
    return false;
}

/* One that the machine has not is refused, not run. */
static void test_unavailable(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_march *march;
    const struct br_kernel none = {.name = "none", .available = never};
    const struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method("riccati", NULL, NULL);
    method.linear.kernel = &none;
    REFUSED(br_march_create(&march, &scene, 9, 4, &method, &err), BR_BAD_INPUT,
            "kernel none is not available on this machine");
}

static size_t steps_counted;

static bool always(void)
{
    return true;
}

static void count_step(const struct br_strip *strip, const struct br_strip_drive *drive,
                       const struct br_strip_ends *ends)
{
    steps_counted++;
    br_kernel_find("portable")->advance(strip, drive, ends);
}

/* The one that is asked for does the work. */
static void test_heeded(void **state)
{
    (void)state;
    struct br_kernel counting = *br_kernel_find("portable");
    counting.name = "counting";
    counting.available = always;
    counting.advance = count_step;
    const struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method("riccati", NULL, NULL);
    method.linear.kernel = &counting;
    struct br_march *march = br_test_march(&scene, 7, 4, &method);
    br_test_advance(march, 4);
    br_march_free(march);
    assert_true(steps_counted >= 4);
    assert_ptr_equal(br_linear_solver_kernel(&br_riccati, &method.linear), &counting);
    assert_ptr_equal(br_linear_solver_kernel(&br_riccati, &br_linear_defaults), br_kernel_best());
    assert_null(br_linear_solver_kernel(&br_plain, &method.linear));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_kernels),
        cmocka_unit_test(test_find),
        cmocka_unit_test(test_unavailable),
        cmocka_unit_test(test_heeded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
