/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/bench/bench.h"

const char *const bench_field_names[BENCH_FIELDS] = {"both", "bending", "axial"};

struct br_scene bench_scene(enum bench_fields fields)
{
    struct br_scene s = br_test_bundled(fields == BENCH_BENDING ? "example3" : "example2");
    if (fields == BENCH_AXIAL) {
        s.bending.modelled = false;
        s.friction.law = BR_FRICTIONLESS;
    }
    return s;
}

struct br_method bench_fast_method(void)
{
    struct br_method method = br_method_default();
    const struct br_linear_solver *const *s = br_linear_solvers;
    while (*s && !((*s)->cost && br_linear_solver_heeds(*s, "--kernel")))
        s++;
    assert_non_null(*s);
    method.solver = *s;
    return method;
}

bool bench_can_march(const struct bench_march *m, struct br_error *err)
{
    struct br_march *march;
    const size_t steps = (size_t)(m->scene->duration / 1e-3 + 0.5);
    if (br_march_create(&march, m->scene, m->n, steps, m->method, err) == BR_OK) {
        br_march_free(march);
        return true;
    }
    if (m->n <= 400)
        fail_msg("%s failed at n = %zu: %s", m->method->solver->name, m->n, err->message);
    return false;
}
