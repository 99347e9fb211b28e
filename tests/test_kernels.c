/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every kernel of the fast solver against the recursions written out in long double, lane by lane.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/sweep_kernel.h"
#include "support.h"

enum { MOST_LENGTH = 24, MOST_D = 2, MOST = MOST_LENGTH * 4 * MOST_D * MOST_D * BR_LANES };

struct arrays {
    _Alignas(64) double gain[MOST], weight[MOST], load[MOST], state[MOST], scratch[MOST];
    _Alignas(64) double right[MOST], left[MOST], q[MOST], z[MOST], velocity[MOST],
        displacement[MOST];
};

static struct br_sweep sweep_of(struct arrays *a, int d, size_t length)
{
    return (struct br_sweep){
        .d = d,
        .length = length,
        .table = {a->gain, a->weight},
        .factor = 0.7,
        .r = {1.3, 0.4},
        .alpha = 0.6,
        .k = 0.25,
        .state = a->state,
        .scratch = a->scratch,
        .right = a->right,
        .left = a->left,
        .q = a->q,
        .z = a->z,
        .velocity = a->velocity,
        .displacement = a->displacement,
    };
}

static void fill(struct br_test_random *random, double *x)
{
    for (size_t i = 0; i < MOST; i++)
        x[i] = br_test_uniform(random, -0.5, 0.5);
}

/* A, K'R, S^-1 and K do not have to belong together for this. */
static void fill_all(struct br_test_random *random, struct arrays *a)
{
    memset(a, 0, sizeof *a);
    fill(random, a->gain);
    fill(random, a->weight);
    fill(random, a->load);
    fill(random, a->state);
    fill(random, a->right);
    fill(random, a->left);
}

typedef long double real;

static real at(const double *x, size_t index, size_t lane)
{
    return x[index * BR_LANES + lane];
}

/* T y + G kappa */
static void carry(int d, real *y, const real *kappa)
{
    const real y0 = y[0], y1 = d == 2 ? y[1] : 0;
    y[0] = d == 1 ? y0 + kappa[0] : y0 + y1 + kappa[0] / 2 - kappa[1] / 6;
    if (d == 2)
        y[1] = y1 + kappa[0];
}

static void product(int d, const double *matrix, bool transposed, const real *x, real *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += (real)matrix[transposed ? j * d + i : i * d + j] * x[j];
}

/* One lane of one step, in place; the closed loop A is taken from the table, as it is. */
static void expected_lane(const struct br_sweep *s, size_t lane, struct arrays *a)
{
    const int d = s->d;
    const size_t dd = (size_t)d;
    real drive[MOST_LENGTH][MOST_D], p[MOST_D], y[MOST_D], q[MOST_D] = {0}, z[MOST_D] = {0},
                                                           v[MOST_D] = {0}, u = 0;
    for (size_t i = 0; i < dd; i++) {
        p[i] = at(s->right, i, lane);
        y[i] = at(s->left, i, lane);
    }
    for (size_t e = 0; e < s->length; e++) {
        const double *gain = s->table.gain + e * 4 * dd * dd;
        real g[MOST_D], next[MOST_D] = {0};
        for (size_t i = 0; i < dd; i++) {
            g[i] = at(s->state, e * 2 * dd + i, lane);
            const real control = d == 1 ? p[0] : i == 0 ? p[0] / 2 + p[1] : -p[0] / 6;
            const size_t index = e * dd + i;
            const real sigma = !s->load      ? 0
                               : s->lanewise ? at(s->load, index, lane)
                                             : (real)s->load[index];
            drive[e][i] = s->r[i] * g[i] + control + s->factor * sigma;
        }
        product(d, gain, false, p, next);
        product(d, gain + dd * dd, false, g, next);
        memcpy(p, next, sizeof p);
    }
    for (size_t e = s->length; e-- > 0;) {
        const double *gain = s->table.gain + e * 4 * dd * dd;
        const double *weight = s->table.weight + e * 2 * dd * dd;
        real m[MOST_D] = {0}, kappa[MOST_D], next[MOST_D] = {0}, g[MOST_D], rate[MOST_D];
        product(d, gain + 2 * dd * dd, false, drive[e], m);
        memcpy(kappa, m, sizeof kappa);
        product(d, gain + 3 * dd * dd, false, y, kappa);
        carry(d, next, m); /* T 0 + G m */
        product(d, gain, true, y, next);
        memcpy(y, next, sizeof y);
        for (size_t i = 0; i < dd; i++) {
            const size_t ig = (e * 2 * dd + i) * BR_LANES + lane;
            const size_t iw = (e * 2 * dd + dd + i) * BR_LANES + lane;
            rate[i] = a->state[ig] - s->alpha * a->state[iw] + kappa[i];
            const real w = a->state[iw] + s->k * rate[i];
            g[i] = s->alpha * w + rate[i];
            a->state[iw] = (double)w;
            a->state[ig] = (double)g[i];
            u += w;
        }
        carry(d, v, rate);
        product(d, weight, false, g, z);
        product(d, weight + dd * dd, false, g, q);
    }
    for (size_t i = 0; i < dd; i++) {
        a->q[i * BR_LANES + lane] = (double)q[i];
        a->z[i * BR_LANES + lane] = (double)z[i];
        a->velocity[i * BR_LANES + lane] = (double)v[i];
    }
    if (d == 1)
        a->displacement[lane] = (double)u;
}

static void same(const double *x, const double *y, size_t count, const char *kernel,
                 const char *what)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(x[i] - y[i]) <= 1e-12 * fmax(1, fabs(y[i]))))
            fail_msg("%s: %s %zu is %.17g, expected %.17g", kernel, what, i, x[i], y[i]);
}

static void check(const struct br_kernel *kernel, struct arrays *a, struct arrays *b,
                  const struct br_sweep *shape)
{
    *b = *a;
    struct br_sweep by_kernel = sweep_of(a, shape->d, shape->length);
    struct br_sweep by_hand = sweep_of(b, shape->d, shape->length);
    by_kernel.load = shape->load ? a->load : NULL;
    by_hand.load = shape->load ? b->load : NULL;
    by_kernel.lanewise = by_hand.lanewise = shape->lanewise;
    kernel->step(&by_kernel);
    for (size_t lane = 0; lane < BR_LANES; lane++)
        expected_lane(&by_hand, lane, b);
    same(a->state, b->state, MOST, kernel->name, "state");
    same(a->q, b->q, MOST, kernel->name, "q");
    same(a->z, b->z, MOST, kernel->name, "z");
    same(a->velocity, b->velocity, MOST, kernel->name, "velocity");
    same(a->displacement, b->displacement, MOST, kernel->name, "displacement");

    double *across = a->displacement;
    kernel->carry(&by_kernel, across);
    for (size_t lane = 0; lane < BR_LANES; lane++) {
        real y[MOST_D] = {0}, w[MOST_D];
        for (size_t e = shape->length; e-- > 0;) {
            for (size_t i = 0; i < (size_t)shape->d; i++)
                w[i] = at(a->state, (e * 2 + 1) * (size_t)shape->d + i, lane);
            carry(shape->d, y, w);
        }
        for (size_t i = 0; i < (size_t)shape->d; i++)
            CLOSE(across[i * BR_LANES + lane], (double)y[i], 1e-12 * fmax(1, fabs((double)y[i])));
    }
}

static void test_all_kernels(void **state)
{
    (void)state;
    struct br_test_random random = {5};
    struct arrays *a = aligned_alloc(64, sizeof *a), *b = aligned_alloc(64, sizeof *b);
    assert_non_null(a);
    assert_non_null(b);
    size_t kernels = 0;
    for (const struct br_kernel *const *k = br_kernels; *k; k++) {
        if (!(*k)->available())
            continue;
        kernels++;
        for (int d = 1; d <= 2; d++)
            for (size_t length = 1; length <= MOST_LENGTH; length++)
                for (int load = 0; load < 3; load++) {
                    fill_all(&random, a);
                    const struct br_sweep shape = {.d = d,
                                                   .length = length,
                                                   .load = load ? a->load : NULL,
                                                   .lanewise = load == 2};
                    check(*k, a, b, &shape);
                }
    }
    assert_true(kernels >= 1);
    assert_true(br_kernel_best()->available());
    free(a);
    free(b);
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
    struct br_method method = br_test_method("lanes", NULL, NULL);
    method.linear.kernel = &none;
    REFUSED(br_march_create(&march, &scene, 9, 4, &method, &err), BR_BAD_INPUT,
            "kernel none is not available on this machine");
}

static size_t steps_counted;

static bool always(void)
{
    return true;
}

static void count_step(const struct br_sweep *sweep)
{
    steps_counted++;
    br_kernel_find("portable")->step(sweep);
}

/* The one that is asked for does the work. */
static void test_heeded(void **state)
{
    (void)state;
    const struct br_kernel counting = {"counting", always, count_step,
                                       br_kernel_find("portable")->carry};
    const struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method("lanes", NULL, NULL);
    method.linear.kernel = &counting;
    struct br_march *march = br_test_march(&scene, 7, 4, &method);
    br_test_advance(march, 4);
    br_march_free(march);
    assert_true(steps_counted >= 4);
    assert_ptr_equal(br_linear_solver_kernel(&br_lanes, &method.linear), &counting);
    assert_ptr_equal(br_linear_solver_kernel(&br_lanes, &br_linear_defaults), br_kernel_best());
    assert_null(br_linear_solver_kernel(&br_riccati, &method.linear));
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
