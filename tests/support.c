/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "study/known/expression.h"
#include "study/scene/file.h"
#include "study/verify/verify.h"

struct br_scene br_test_bundled(const char *name)
{
    struct br_scene scene;
    char path[1024];
    MUST(br_scene_find(name, path, sizeof path, &err));
    MUST(br_scene_read(path, &scene, &err));
    return scene;
}

struct br_scene br_test_bare(void)
{
    return (struct br_scene){
        .length = 1,
        .duration = 1,
        .density = 1,
        .axial = {.modelled = true, .stiffness = 1, .viscosity = 1},
        .bending = {.modelled = true, .stiffness = 1, .viscosity = 1},
    };
}

struct br_function br_test_function(const char *expression)
{
    struct br_function function;
    MUST(br_expression(expression, &function, &err));
    return function;
}

void br_function_clear(struct br_function *function)
{
    br_function_free(function);
}

void br_march_clear(struct br_march **march)
{
    br_march_free(*march);
}

struct br_load br_test_load(const char *expression)
{
    return (struct br_load){.term[0].space = br_test_function(expression),
                            .term[0].time = {.constant = 1}};
}

struct br_method br_test_method(const char *solver, const char *contact, const char *friction)
{
    struct br_method method = br_method_default();
    if (solver)
        method.solver = br_linear_solver_find(solver);
    if (contact)
        method.contact = br_contact_rule_find(contact);
    if (friction)
        method.friction = br_friction_rule_find(friction);
    assert_non_null(method.solver);
    assert_non_null(method.contact);
    assert_non_null(method.friction);
    return method;
}

struct br_march *br_test_march(const struct br_scene *scene, size_t n, size_t steps,
                               const struct br_method *method)
{
    struct br_march *march;
    MUST(br_march_create(&march, scene, n, steps, method, &err));
    return march;
}

void br_test_advance(struct br_march *march, size_t until)
{
    while (br_march_steps_done(march) < until)
        MUST(br_march_step(march, &err));
}

struct br_test_end br_test_run(const struct br_scene *scene, size_t n, size_t steps,
                               const struct br_method *method)
{
    struct br_march *march = br_test_march(scene, n, steps, method);
    br_test_advance(march, steps);
    struct br_test_end end = {br_march_tip_displacement(march, BR_AXIAL),
                              br_march_tip_displacement(march, BR_BENDING), 0};
    double *w = calloc(2 * (n + 1), sizeof *w);
    assert_non_null(w);
    br_march_get(march, BR_BENDING, w, NULL);
    end.w_middle = w[2 * (n / 2)];
    free(w);
    br_march_free(march);
    return end;
}

struct br_study br_test_study(const struct br_scene *scene,
                              const struct br_reference *reference_kind, size_t n_count,
                              const size_t *n, size_t k_count, const size_t *steps)
{
    return (struct br_study){
        .scene = scene,
        .norm = br_norms[0],
        .method = br_method_default(),
        .reference_kind = reference_kind,
        .reference_method = br_method_default(),
        .n_count = n_count,
        .k_count = k_count,
        .n = n,
        .steps = steps,
    };
}

void br_test_all_norms(struct br_study s[BR_TEST_NORMS])
{
    for (size_t m = 0; m < BR_TEST_NORMS; m++) {
        s[m] = s[0];
        s[m].norm = br_norms[m];
        s[m].next_norm = m + 1 < BR_TEST_NORMS ? &s[m + 1] : NULL;
    }
}

size_t br_test_golden(struct br_test_golden rows[BR_TEST_MOST_GOLDEN])
{
    char path[1024], line[256];
    br_data_path("tests/data/discrete.csv", path, sizeof path);
    FILE *file = fopen(path, "r");
    size_t count = 0;
    while (file && count < BR_TEST_MOST_GOLDEN && fgets(line, sizeof line, file)) {
        struct br_test_golden *row = &rows[count];
        double k;
        if (sscanf(line, "%31[^,],%zu,%lf,%lf,%lf,%lf", row->scene, &row->n, &k, &row->end.u_tip,
                   &row->end.w_tip, &row->end.w_middle) != 6)
            continue; /* a heading */
        row->steps = (size_t)lround(1 / k);
        count++;
    }
    if (file)
        fclose(file);
    if (count == 0)
        fail_msg("%s: unreadable", path);
    return count;
}

double br_test_deviation(const struct br_test_end *end, const struct br_test_end *golden)
{
    const double scale = fmax(fabs(golden->w_tip), fabs(golden->w_middle));
    const double errors[] = {fabs(end->u_tip / golden->u_tip - 1),
                             fabs(end->w_tip - golden->w_tip) / scale,
                             fabs(end->w_middle - golden->w_middle) / scale};
    double most = 0;
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++)
        if (!(errors[i] <= most))
            most = errors[i];
    return most;
}

void br_test_scene_refused(const char *text, bool verify, const char *message)
{
    struct br_scene scene;
    struct br_verify v = {0};
    const char *path = br_test_scene_file(text);
    const enum br_status status = verify ? br_verify_read(path, text, NULL, &scene, &v, &err)
                                         : br_scene_read_text(path, text, &scene, &err);
    br_verify_clear(&v);
    br_scene_clear(&scene);
    if (status != BR_BAD_INPUT || err.status != BR_BAD_INPUT || !strstr(err.message, message) ||
        strncmp(err.message, path, strlen(path)) != 0)
        fail_msg("%s\nsaid '%s', expected '%s'", text, err.message, message);
    err.status = BR_OK;
}

const struct br_warning *br_test_warning(const struct br_warnings *w, enum br_warning_kind kind)
{
    for (size_t i = 0; i < w->count; i++)
        if (w->list[i].kind == kind)
            return &w->list[i];
    return NULL;
}
