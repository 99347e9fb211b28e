/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets allocation 0, 1, 2, ... fail. Each time the call must fail and release everything (the
 * address sanitizer and valgrind show leaks). */
#include <stdio.h>
#include <stdlib.h>

#include "solver/linear/linear_solver.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "study/run/run.h"
#include "study/scene/file.h"
#include "support.h"

static enum br_status read_scene(const void *path, struct br_error *why)
{
    OWNED(br_scene) scene;
    const enum br_status status = br_scene_read(path, &scene, why);
    return status;
}

/* Loads in x and t, initial data, contact and friction: everything that allocates. */
static const char *const full_scene =
    "title: everything\n"
    "length: 1 m\n"
    "duration: 1 s\n"
    "density: 1 kg/m\n"
    "axial:\n"
    "  stiffness: 1000 N\n"
    "  viscosity: 1 N s\n"
    "  load: {shape: 'x [1]', history: 't [N/m]'}\n"
    "  displacement: 0.01*x [m]\n"
    "  velocity: 0.01*x [m/s]\n"
    "bending:\n"
    "  stiffness: 1000 N m^2\n"
    "  viscosity: 1 N m^2 s\n"
    "  load: x*t [N/m]\n"
    "  displacement: 0.01*x^2 [m]\n"
    "  displacement_slope: 0.02*x [1]\n"
    "  velocity: 0.01*x^2 [m/s]\n"
    "  velocity_slope: 0.02*x [1/s]\n"
    "contact: {gap: 0 m, stiffness: 1 N/m}\n"
    "friction: {law: coulomb, coefficient: 1 N/m, regularisation: 1e-3 m/s}\n";

static struct br_scene full(void)
{
    struct br_scene scene;
    MUST(br_scene_read_text("full.yaml", full_scene, &scene, &err));
    return scene;
}

TEST(test_scene)
{
    br_test_without_memory(read_scene, br_test_scene_file(full_scene), 10);
}

static enum br_status read_set(const void *text, struct br_error *why)
{
    OWNED(br_scene) scene;
    FREED char *left = NULL;
    const struct br_scene_asked asked = {
        .set = "length=2 m\naxial.load.shape=x^2 [1]\naxial.tip_force=t [N]\nremark=a",
        .text = &left};
    const enum br_status status = br_scene_parse("full.yaml", text, &asked, &scene, why);
    return status;
}

TEST(test_set)
{
    br_test_without_memory(read_set, full_scene, 10);
}

struct march_data {
    struct br_scene scene;
    struct br_method method;
};

static enum br_status study(const void *data, struct br_error *why)
{
    const struct march_data *d = data;
    static const size_t n[] = {2, 4}, steps[] = {5, 10};
    OWNED(br_study) s = br_test_study(&d->scene, &br_reference_fine, 2, n, 2, steps);
    s.method = d->method;
    s.reference_method = d->method;
    s.reference = (struct br_resolution){8, 10};
    enum br_status status = br_study_run(&s, 1, 1, NULL, why);
    /* A failure during a march fails its cell, not the study. */
    for (size_t i = 0; !status && i < 4; i++)
        if (s.cell[i].failure.status) {
            *why = s.cell[i].failure;
            status = why->status;
        }
    return status;
}

TEST(test_study)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        struct march_data data = {full(), br_method_default()};
        data.method.solver = *s;
        br_test_without_memory(study, &data, 60);
        br_scene_clear(&data.scene);
    }
}

static enum br_status run_scene(const void *data, struct br_error *why)
{
    struct br_run_report report;
    OWNED(br_history_record) record = {0};
    const struct br_history_observer recorder = br_history_recorder(&record, 4);
    static const size_t level[] = {0, 3};
    const struct march_data *d = data;
    const struct br_run_request request = {
        .scene = &d->scene,
        .method = d->method,
        .n = 4,
        .steps = 8,
        .stride = 1,
        .level = level,
        .levels = 2,
        .check = true,
        .output = &recorder,
        .outputs = 1,
    };
    const enum br_status status = br_run(&request, &report, why);
    return status;
}

/* Every solver is checked, each with its certificate. */
TEST(test_run)
{
    for (const struct br_linear_solver *const *solver = br_linear_solvers; *solver; solver++) {
        struct march_data data = {full(), br_method_default()};
        data.method.solver = *solver;
        br_test_without_memory(run_scene, &data, 20);
        br_scene_clear(&data.scene);
    }
}

/* The hook fails the chosen allocation, once. */
TEST(test_hook)
{
    br_allocation_fails_at(1);
    void *first = br_allocate(1, 8), *second = br_allocate(1, 8), *third = br_allocate(0, 8);
    assert_true(first && !second && third);
    free(first);
    free(third);
    br_allocation_fails_at(-1);
    /* err may be NULL. */
    assert_int_equal(br_fail(NULL, BR_IO, "%d", 1), BR_IO);
    assert_int_equal(br_no_memory(NULL, "x"), BR_NO_MEMORY);
}

/* The exit codes that the program promises. */
TEST(test_exit_codes)
{
    assert_int_equal(br_status_exit_code(BR_OK), 0);
    assert_int_equal(br_status_exit_code(BR_VERDICT), 1);
    assert_int_equal(br_status_exit_code(BR_BAD_INPUT), 2);
    for (int s = BR_NO_MEMORY; s <= BR_INTERRUPTED; s++)
        assert_int_equal(br_status_exit_code((enum br_status)s), 3);
    assert_int_equal(br_status_exit_code(BR_UNSUPPORTED), 2);
}
