/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All that a study asks is in its text, by which ranks know that they have read the same. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/statement.h"
#include "solver/linear/linear_solver.h"
#include "study/grid/study.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"
#include "support.h"

static const size_t grid_n[] = {10, 20, 30, 40, 60}, grid_steps[] = {20, 50, 100, 200};

/* All members of each struct, in their order: whether they are in the text (SAID) or not (NONE:
 * what is found, or how); a value; another one. The compiler refuses a member that has no row. */
#pragma GCC diagnostic error "-Wmissing-field-initializers"
#define FIRST(in, member, a, b) a,
/* clang-format off */
#define ITERATION(X) \
    X(SAID, parameter, 0.5, 0.25) X(SAID, tolerance, 1e-8, 2e-8) X(SAID, most, 10, 11)
#define METHOD(X)                                                 \
    X(SAID, scheme, br_time_schemes[0], br_time_schemes[1])       \
    X(SAID, tolerance, 1e-6, 2e-6)                                \
    X(SAID, solver, br_linear_solvers[0], br_linear_solvers[1])   \
    X(SAID, kernel, br_kernels[0], br_kernels[1])                 \
    X(SAID, contact, br_contact_rules[0], br_contact_rules[1])    \
    X(SAID, friction, br_friction_rules[0], br_friction_rules[1]) \
    X(NONE, iteration, iteration, iteration)                      \
    /* ITERATION */ X(SAID, axial_degree, 1, 2) X(SAID, most_steps, 7, 8)
#define FIELD(X)                                                                                 \
    X(SAID, modelled, true, false)                                                               \
    X(SAID, stiffness, 1, 2)                                                                     \
    X(SAID, viscosity, 1, 2)                                                                     \
    X(SAID, load, none, load)                                                                    \
    X(SAID, tip_force, zero, one)                                                                \
    X(SAID, tip_moment, zero, one) X(SAID, displacement, zero, one) X(SAID, velocity, zero, one) \
        X(SAID, displacement_slope, zero, one) X(SAID, velocity_slope, zero, one)                \
            X(SAID, solution, NULL, "x [m]") X(SAID, given, zero, one)                           \
                X(SAID, stick_force, zero, one)
#define FIELDS             \
    {                      \
        {                  \
            axial, bending \
        }                  \
    }
#define CONTACT(X) \
    X(SAID, modelled, true, false) X(SAID, gap, 0, 0x1p-1074) X(SAID, stiffness, 1, 2)
#define FRICTION(X)                     \
    X(SAID, law, BR_TRESCA, BR_COULOMB) \
    X(SAID, coefficient, 1, 1 + 0x1p-52) X(SAID, regularisation, 0, 1)
#define SCENE(X)                                                                                   \
    X(NONE, name, "a", "b")                                                                        \
    X(SAID, title, "a", "b")                                                                       \
    X(SAID, remark, "a", "b")                                                                      \
    X(SAID, length, 1, 2)                                                                          \
    X(SAID, duration, 1, 2)                                                                        \
    X(SAID, density, 1, 2) X(NONE, field, FIELDS, )                              /* FIELD */       \
        X(NONE, contact, contact, contact) X(NONE, friction, friction, friction) /* those lists */ \
        X(NONE, derived, {{0}}, )
#define STUDY(X) \
    X(NONE, scene, &scene, &scene) /* SCENE */ \
    X(SAID, norm, &br_norm_l2, &br_norm_energy) \
    X(NONE, method, method, method) /* METHOD */ \
    X(SAID, cell_method, NULL, distinct) \
    X(SAID, reference_kind, &br_reference_fine, &br_reference_mms) \
    X(SAID, reference_method, method, distinct[0]) \
    X(SAID, reference, finer, finest) \
    X(SAID, reference_check, NULL, &br_reference_exact) \
    X(SAID, n_count, 2, 1) X(SAID, k_count, 2, 1) X(SAID, path, false, true) \
    X(SAID, n, grid_n, grid_n + 1) X(SAID, steps, grid_steps, grid_steps + 1) \
    X(NONE, next_norm, NULL, NULL) X(NONE, here, false, true) X(NONE, cell, NULL, NULL) \
    X(NONE, reference_report, unchecked, ) X(NONE, events, NULL, NULL) \
    X(NONE, reference_scale, 0, 0) X(NONE, reference_size, {0}, ) \
    X(NONE, reference_error, {0}, ) X(NONE, reference_tip, {0}, ) X(NONE, failure, {0}, )
/* clang-format on */

static char *text_of(const struct br_study *s)
{
    struct br_statement text;
    br_statement_begin(&text);
    br_state_study(&text, s);
    return br_statement_end(&text);
}

static void expect_other(const char *what, const struct br_study *a, const struct br_study *b)
{
    char *x = text_of(a), *y = text_of(b);
    assert_non_null(x);
    assert_non_null(y);
    if (strcmp(x, y) == 0)
        fail_msg("%s is not in the text", what);
    free(x);
    free(y);
}

static void reset(const struct br_study *asked, struct br_study *other,
                  const struct br_scene *scene, struct br_scene *of)
{
    *other = *asked;
    *of = *scene;
    other->scene = of;
}

TEST(test_all_members_are_stated)
{
    struct br_function zero = {0}, one = {.constant = 1};
    struct br_load none = {0}, load = {{{one, one}}};
    struct br_scene_field axial = {FIELD(FIRST)}, bending = axial;
    struct br_contact contact = {CONTACT(FIRST)};
    struct br_friction friction = {FRICTION(FIRST)};
    struct br_scene scene = {SCENE(FIRST)};
    struct br_iteration iteration = {ITERATION(FIRST)};
    struct br_method method = {METHOD(FIRST)}, distinct[4] = {method, method, method, method};
    struct br_reference_report unchecked = {.unstable = false};
    struct br_resolution finer = {80, 200}, finest = {80, 400};
    for (int i = 0; i < 4; i++)
        distinct[i].tolerance = 1e-3;
    const struct br_study asked = {STUDY(FIRST)};
    struct br_study other = asked;
    struct br_scene of = scene;
#define SAID(member, b, at)                        \
    (at).member = b;                               \
    expect_other(#at "." #member, &asked, &other); \
    reset(&asked, &other, &scene, &of);
#define NONE(member, b, at)
#define IN_STUDY(in, member, a, b) in(member, b, other)
#define IN_METHOD(in, member, a, b) in(member, b, other.method)
#define IN_ITERATION(in, member, a, b) in(member, b, other.method.iteration)
#define IN_SCENE(in, member, a, b) in(member, b, of)
#define IN_AXIAL(in, member, a, b) in(member, b, of.axial)
#define IN_BENDING(in, member, a, b) in(member, b, of.bending)
#define IN_CONTACT(in, member, a, b) in(member, b, of.contact)
#define IN_FRICTION(in, member, a, b) in(member, b, of.friction)
    reset(&asked, &other, &scene, &of);
    STUDY(IN_STUDY)
    METHOD(IN_METHOD)
    ITERATION(IN_ITERATION)
    SCENE(IN_SCENE)
    FIELD(IN_AXIAL)
    FIELD(IN_BENDING)
    CONTACT(IN_CONTACT) FRICTION(IN_FRICTION) other.reference_method.most_steps = 9;
    expect_other("the reference's method", &asked, &other);
    /* The registries: a field of a method that is got, and a number of a scene, is stated. */
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++) {
        reset(&asked, &other, &scene, &of);
        f->set(&other.method, f->words ? f->get(&method) == 0 : 0.125);
        expect_other(f->name, &asked, &other);
    }
    for (const struct br_scene_key *key = br_scene_keys; key->name; key++) {
        reset(&asked, &other, &scene, &of);
        if (key->need == BR_MAKES || key->offset == 0 || key->kind == BR_KEY_TEXT)
            continue;
        ((char *)&of)[key->offset] ^= key->kind == BR_KEY_SOLUTION ? 0 : 1;
        if (key->kind == BR_KEY_POSITIVE || key->kind == BR_KEY_NOT_NEGATIVE)
            expect_other(key->name, &asked, &other);
    }
}

/* Expressions of the same nodes in another order, or of an operation with the same word. */
TEST(test_functions_are_stated)
{
    static const char *const same[][2] = {{"x*t", "t*t"},
                                          {"sin(x)", "cos(x)"},
                                          {"x-t", "t-x"},
                                          {"-x", "x-x"},
                                          {"x+1", "x+1.0000000000000002"},
                                          {"x>t ? x : t", "x>t ? t : x"},
                                          {"x*t+x", "x*t+t"}};
    struct br_scene scene = br_test_bare(), of = scene;
    const struct br_method method = br_method_default();
    const struct br_study a = {.scene = &scene,
                               .norm = br_norms[0],
                               .method = method,
                               .reference_kind = &br_reference_mms,
                               .n_count = 1,
                               .k_count = 1,
                               .n = grid_n,
                               .steps = grid_steps};
    struct br_study b = a;
    b.reference_kind = &br_reference_exact;
    expect_other("a reference without a resolution", &a, &b);
    b = a;
    b.scene = &of;
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        scene.axial.displacement = br_test_function(same[i][0]);
        of.axial.displacement = br_test_function(same[i][1]);
        expect_other(same[i][0], &a, &b);
        br_function_free(&scene.axial.displacement);
        br_function_free(&of.axial.displacement);
    }
    static const struct br_function_ops unknown = {0};
    of.axial.displacement = (struct br_function){.ops = &unknown};
    assert_null(text_of(&b)); /* no text is better than a wrong one */
}
