/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The n-th allocation of a call of the library fails, also in GSL, SuiteSparse and the C library:
 * the call returns "out of memory", or the same numbers, and never ends the process. */
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "faults.h"
#include "study/library/beamrate.h"
#include "support.h"

static struct beamrate_error failure;
static struct beamrate_scene *scene; /* that a call uses */
static struct beamrate_march *march;
static struct beamrate_study *study;
static struct beamrate_orders *orders;
static struct beamrate_check *check;

static const size_t meshes[] = {2, 4, 8}, times[] = {4, 8, 16};

/* ---- calls: each makes one handle, and `number` of its results ---- */

struct call {
    const char *name, *scene;
    enum beamrate_status (*make)(const void *with, double *number);
    const void *with;
    long every; /* a tenth of the stride by default; with everything tested 1 */
};

static enum beamrate_status open_scene(const void *name, double *number)
{
    struct beamrate_scene *made;
    struct beamrate_scene_info info;
    const enum beamrate_status status = beamrate_scene_open(&made, name, &failure);
    assert_int_equal(!made, status != BEAMRATE_OK);
    if (!status)
        beamrate_scene_info(made, &info);
    *number = status ? 0 : info.length;
    beamrate_scene_free(made);
    return status;
}

static enum beamrate_status foresee(const void *method, double *number)
{
    struct beamrate_forecast f;
    const enum beamrate_status status = beamrate_foresee(scene, 8, 16, method, &f, &failure);
    *number = f.error[BEAMRATE_BENDING].high;
    for (size_t i = 0; i < f.warnings; i++) /* a failure must not shorten what is said */
        *number += (double)(strlen(f.warning[i].text) + 1000 * strlen(f.warning[i].remedy));
    return status;
}

static enum beamrate_status march_all(const void *method, double *number)
{
    struct beamrate_tip tip = {.time = 0};
    enum beamrate_status status = beamrate_march_create(&march, scene, 6, 8, method, &failure);
    assert_int_equal(!march, status != BEAMRATE_OK);
    if (!status)
        status = beamrate_march_step(march, 8, &failure);
    if (!status)
        beamrate_march_tip(march, &tip);
    *number = tip.displacement[BEAMRATE_BENDING];
    beamrate_march_free(march);
    return status;
}

static enum beamrate_status run_study(const void *with, double *number)
{
    struct beamrate_study_request request = *(const struct beamrate_study_request *)with;
    struct beamrate_fit fit = {.points = 0};
    struct beamrate_reference reference = {.size = 0};
    request.n = meshes;
    request.steps = times;
    request.n_count = request.steps_count = 3;
    const enum beamrate_status status = beamrate_study_run(&study, scene, &request, &failure);
    assert_int_equal(!study, status != BEAMRATE_OK);
    if (!status) {
        beamrate_study_fit(study, BEAMRATE_TOTAL, &fit);
        beamrate_study_reference(study, &reference);
    }
    *number = status ? 0 : fit.q.high + reference.own_error[BEAMRATE_TOTAL];
    beamrate_study_free(study);
    return status;
}

static enum beamrate_status check_scene(const void *with, double *number)
{
    struct beamrate_case c = {.points = 0};
    const enum beamrate_status status =
        beamrate_check_run(&check, scene, *(const int *)with, NULL, &failure);
    assert_int_equal(!check, status != BEAMRATE_OK);
    if (!status)
        beamrate_check_case(check, 0, &c);
    *number = c.margin;
    beamrate_check_free(check);
    return status;
}

static enum beamrate_status find_orders(const void *values, double *number)
{
    static const double h[] = {8, 8, 8, 4, 4, 4, 2, 2, 2, 1, 1, 1}, line[] = {8, 4, 2, 1},
                        k[] = {4, 2, 1, 4, 2, 1, 4, 2, 1, 4, 2, 1}, value[] = {71, 23, 11, 8};
    static const double error[] = {68, 66, 65, 20, 18, 17, 8, 6, 5, 5, 3.01, 2};
    static const struct beamrate_expectation expected = {BEAMRATE_SPACE, 2, 0.5, 0};
    const bool are_values = *(const int *)values;
    const struct beamrate_numbers numbers = {.h = are_values ? line : h,
                                             .k = are_values ? NULL : k,
                                             .number = are_values ? value : error,
                                             .count = are_values ? 4 : 12,
                                             .values = are_values};
    struct beamrate_order order = {.points = 0};
    struct beamrate_case c = {.points = 0};
    enum beamrate_status status = beamrate_orders_find(&orders, &numbers, &failure);
    assert_int_equal(!orders, status != BEAMRATE_OK);
    if (!status) {
        beamrate_orders_line(orders, BEAMRATE_SPACE, &order);
        status = beamrate_orders_check(&check, orders, &expected, 1, &failure);
        assert_int_equal(!check, status != BEAMRATE_OK);
        if (!status)
            beamrate_check_case(check, 0, &c);
        beamrate_check_free(check);
    }
    *number = order.order.high + (are_values ? order.limit.high : 0) + c.margin;
    beamrate_orders_free(orders);
    return status;
}

static enum beamrate_status read_orders(const void *text, double *number)
{
    const struct beamrate_table table = {.text = text};
    const char *json = NULL;
    enum beamrate_status status = beamrate_orders_read(&orders, &table, &failure);
    assert_int_equal(!orders, status != BEAMRATE_OK);
    *number = 0;
    if (!status)
        status = beamrate_orders_report(orders, &json, &failure);
    assert_int_equal(!json, status != BEAMRATE_OK);
    for (const char *c = json; c && *c; c++) /* each letter counts, and its place */
        *number = fmod(*number * 31 + *c, 1e12);
    beamrate_orders_free(orders);
    return status;
}

/* ---- all of them ---- */

static const char verified[] =
    "title: a rod\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n"
    "axial:\n  stiffness: 10 N\n  viscosity: 1 N s\n  load: 10*t [N/m]\n"
    "verify:\n  time:\n    n: 8\n    k: 0.01, 0.005, 0.0025, 0.00125, 0.000625 s\n    l2: 1 +- 0.1\n";

#define METHOD(...) ((const char *const[]){__VA_ARGS__, NULL})
static const int one = 1, two = 2, none = 0;
static const struct beamrate_study_request exact = {.threads = 1}, shared = {.threads = 3},
                                           fine = {.reference = "fine",
                                                   .reference_n = 16,
                                                   .reference_steps = 32,
                                                   .norm = "energy",
                                                   .threads = 1};
static const struct call calls[] = {
    {"scene_open", NULL, open_scene, "example2", 7},
    {"scene_open of expressions", NULL, open_scene, "mms_slip", 11},
    {"foresee", "example2", foresee, NULL, 17},
    {"foresee, adaptive", "release", foresee, METHOD("scheme", "adaptive"), 97},
    {"march", "example2", march_all, NULL, 3},
    {"march, umfpack", "example2", march_all, METHOD("solver", "umfpack"), 5},
    {"march, plain", "example2", march_all, METHOD("solver", "plain", "axial_degree", "2"), 3},
    {"march, adaptive", "release", march_all, METHOD("scheme", "adaptive", "tolerance", "1e-4"), 5},
    {"study", "example2", run_study, &exact, 37},
    {"study in threads", "example2", run_study, &shared, 41},
    {"study, fine", "example4", run_study, &fine, 23},
    {"study, mms", "mms_slip", run_study, &exact, 29},
    {"check", verified, check_scene, &one, 11},
    {"check in threads", verified, check_scene, &two, 13},
    {"orders of errors", NULL, find_orders, &none, 5},
    {"orders of values", NULL, find_orders, &one, 2},
    {"orders of a table", NULL, read_orders, "h,e,f\n8,68,9\n4,20,\n2,8,3\n1,5,1.5\n", 5},
};

/* In a child process: 0: as without a failure; 3: out of memory, named; else wrong. */
static int outcome(const struct call *c, long n, double expected)
{
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGSEGV, SIG_DFL); /* cmocka has handlers */
        signal(SIGABRT, SIG_DFL);
        double number;
        br_memory_fails_at(n);
        const enum beamrate_status status = c->make(c->with, &number);
        br_memory_fails_at(-1);
        if (status == BEAMRATE_NO_MEMORY)
            _exit(strstr(failure.message, "memory") ? 3 : 98);
        if (status)
            fprintf(stderr, "# status %d: %s\n", (int)status, failure.message);
        _exit(status ? 97 : memcmp(&number, &expected, sizeof number) ? 96 : 0);
    }
    int ended = 0;
    waitpid(child, &ended, 0);
    return WIFSIGNALED(ended) ? -WTERMSIG(ended) : WEXITSTATUS(ended);
}

TEST(any_allocation_may_fail)
{
    for (const struct call *c = calls; c < calls + sizeof calls / sizeof *calls; c++) {
        const char *only = getenv("BR_TEST_ONLY");
        if (only && strcmp(only, c->name) != 0)
            continue;
        double expected;
        scene = NULL;
        if (c->scene == verified)
            assert_int_equal(beamrate_scene_parse(&scene, "rod", verified, &failure), 0);
        else if (c->scene)
            assert_int_equal(beamrate_scene_open(&scene, c->scene, &failure), 0);
        if (c->make(c->with, &expected)) /* what is kept for the process */
            fail_msg("%s: %s", c->name, failure.message);
        br_memory_fails_at(LONG_MAX);
        const enum beamrate_status status = c->make(c->with, &expected);
        const long all = br_memory_fails_at(-1);
        assert_int_equal(status, BEAMRATE_OK);
        const long usual = 10 * c->every < all / 4 ? 10 * c->every : all / 4 + 1;
        const long every = br_test_long() ? 1 : usual, first = every / 2 + 1;
        long failures = 0, wrong = 0;
        for (long n = first; n <= all; n = n < all && n + every > all ? all : n + every) {
            const int ended = outcome(c, n, expected);
            failures += ended == 3;
            if (ended && ended != 3 && ++wrong < 10)
                print_error("%s: allocation %ld of %ld: %d\n", c->name, n, all, ended);
        }
        print_message("# %s: %ld allocations, %ld failures from %ld on\n", c->name, all, failures,
                      first);
        if (wrong || !failures)
            fail_msg("%s: %ld of %ld allocations are not survived", c->name, wrong, all);
        beamrate_scene_free(scene);
    }
}
