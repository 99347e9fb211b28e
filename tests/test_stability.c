/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part `stability` of extremes: the matrix of a step, what marches say of the limit, and a
 * verdict that sees what is wrong. Its report and figure are in golden/. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/extremes/extremes.h"
#include "study/grid/observer.h"
#include "support.h"

static struct br_stability found;

static int run_small(void **state)
{
    (void)state;
    static const double k[] = {1e-1, 1e-5, 1e-3}; /* in any order */
    static const size_t n = 3;
    const struct br_extremes_job job = {.n = &n, .n_count = 1, .k = k, .k_count = 3};
    struct br_error err = {0};
    return br_stability_run(&found, &job, &err) ? -1 : 0;
}

static int clear(void **state)
{
    (void)state;
    br_stability_clear(&found);
    return 0;
}

/* One element without inertia: u_n = (c/k - c_H L)/(a + c/k) u_{n-1}, whatever the velocity was. */
TEST(test_matrix)
{
    struct br_error err = {0};
    const struct br_field rod = {
        .kind = BR_AXIAL, .n = 1, .h = 2, .stiffness = 3, .viscosity = 0.5, .k = 0.25, .degree = 1};
    double matrix[4], radius;
    assert_int_equal(br_step_states(&rod), 2);
    MUST(br_step_matrix(&rod, 7, matrix, &err));
    const double z = (0.5 / 0.25 - 7 * 2) / (3 + 0.5 / 0.25);
    CLOSE(matrix[0], z, 1e-15);
    CLOSE(matrix[1], 0, 1e-15);
    CLOSE(matrix[2], z - 1, 1e-15); /* k v_n = u_n - u_{n-1} */
    CLOSE(matrix[3], 0, 1e-15);
    MUST(br_step_radius(&rod, 7, &radius, &err));
    CLOSE(radius, -z, 1e-14);
}

TEST(test_found)
{
    struct br_error err = {0};
    MUST(br_stability_verdict(&found, &err));
    assert_int_equal(found.rows, 3);
    assert_int_equal(found.cells, BR_STABILITY_RODS * 3 * BR_STABILITY_COLUMNS);
    assert_true(found.growing > found.cells / 4 && found.growing < found.cells * 3 / 4);
    AT_MOST(found.limit_error, 2e-11);
    AT_MOST(found.growth_error, 1e-12);
    AT_MOST(found.excess, 1e-12);
    for (size_t i = 0; i < BR_STABILITY_RODS; i++)
        for (size_t row = 0; row < 3; row++) {
            const struct br_stability_row *r = &found.row[i * 3 + row];
            CLOSE(r->measured / r->limit, 1, 2e-11);
            assert_true(row == 0 || r->k > r[-1].k);
        }
    for (size_t i = 0; i < found.schemes; i++)
        assert_int_equal(found.scheme[i].marches, 18);
    assert_true(found.schemes >= 8);
}

/* ---- a verdict that sees what is wrong, NaN too ---- */

#define WRONG(place, value, text)                                      \
    do {                                                               \
        struct br_stability wrong = found;                             \
        struct br_error err = {0};                                     \
        wrong.place = (value);                                         \
        REFUSED(br_stability_verdict(&wrong, &err), BR_VERDICT, text); \
    } while (0)

TEST(test_verdict)
{
    WRONG(limit_error, 1e-8, "limit");
    WRONG(limit_error, NAN, "limit");
    WRONG(growth_error, 1e-8, "growth");
    WRONG(growth_error, NAN, "growth");
    WRONG(excess, 1e-8, "unit circle");
    WRONG(excess, NAN, "unit circle");
    WRONG(scheme[1].failed, 1, "scheme bdf2");
    WRONG(scheme[2].uncertain, 1, "scheme bdf3");
    WRONG(scheme[0].force, 1e-6, "scheme euler");
    WRONG(scheme[0].depth, NAN, "scheme euler");
    WRONG(tip[0].swing, 1e-6, "does not rest");
    WRONG(tip[0].opened, 1, "does not rest");
    WRONG(tip[8].opened, 0, "does not chatter");
    WRONG(tip[8].farthest, INFINITY, "nowhere");
    WRONG(tip[3].swing, NAN, "nowhere");
    WRONG(bounce[0].energy, 1.001, "its energy");
    WRONG(bounce[3].energy, NAN, "its energy");
}

/* Between the two limits a bouncing rod does gain energy: the narrower promise is not idle. */
TEST(test_bounce)
{
    double most = 0;
    for (size_t i = 0; i < BR_STABILITY_BOUNCES; i++) {
        const struct br_stability_tip *b = &found.bounce[i];
        assert_true(b->impacts >= 2);
        most = fmax(most, b->energy);
    }
    assert_true(most > 1.5);
}

static bool stop_now(void *self)
{
    (void)self;
    return true;
}

TEST(test_refusals)
{
    static const double wrong[] = {0, -1, NAN, 1e4, 1e-12};
    static const size_t n[] = {1, 21};
    struct br_error err = {0};
    struct br_stability s;
    struct br_extremes_job job = {.n = &n[1], .n_count = 1};
    REFUSED(br_stability_run(&s, &job, &err), BR_BAD_INPUT, "at most 20");
    job = (struct br_extremes_job){.n = n, .n_count = 1, .k_count = 1};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        job.k = &wrong[i];
        REFUSED(br_stability_run(&s, &job, &err), BR_BAD_INPUT, "expected 1e-9 s to 1000 s");
    }
    job = (struct br_extremes_job){
        .n = n, .n_count = 1, .observer = &(struct br_observer){.stop = stop_now}};
    REFUSED(br_stability_run(&s, &job, &err), BR_INTERRUPTED, "interrupted");
    br_stability_clear(&s);
}

AROUND_TESTS(run_small, clear)
