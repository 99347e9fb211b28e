/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verify part of a scene: what is read, what is refused and where. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/scene/file.h"
#include "support.h"

/* A scene of 1 s; its verify part begins on line 14. */
static const char scene_text[] = "title: A scene\n"
                                 "length: 2 m\n"
                                 "duration: 1 s\n"
                                 "density: 1 kg/m\n"
                                 "axial:\n"
                                 "  stiffness: 1 N\n"
                                 "  viscosity: 1 N s\n"
                                 "  load: 1 [N/m]\n"
                                 "bending:\n"
                                 "  stiffness: 1 N m^2\n"
                                 "  viscosity: 1 N m^2 s\n"
                                 "  load: 1 [N/m]\n"
                                 "# the part that is checked:\n";

/* The scene's text with a verify part (out). */
static const char *with(const char *part)
{
    static char text[4096];
    snprintf(text, sizeof text, "%s%s", scene_text, part);
    return text;
}

static enum br_status read_part(const char *part, struct br_scene *scene, struct br_verify *verify,
                                struct br_error *err)
{
    return br_scene_read_verify(br_test_scene_file(with(part)), scene, verify, err);
}

TEST(test_whole)
{
    struct br_scene scene;
    struct br_verify v;
    struct br_error err = {0};
    MUST(read_part("verify:\n"
                   "  joint:\n"
                   "    n: 10, 20,40, 80\n"
                   "    k: 0.1, 0.05, 0.025, 0.0125 s\n"
                   "    energy bending: 1 +- 0.5\n"
                   "  time:\n"
                   "    n: 7\n"
                   "    k: 0.25, 0.5, 0.03125, 0.125, 0.0625 s\n"
                   "    solver: umfpack\n"
                   "    contact: implicit\n"
                   "    friction: regularised\n"
                   "    l2: 1 +- 0.05, at most 3e-4 m^(3/2)\n"
                   "    tip axial: 1.5+-0.25, constant 1e-5 to 2e-5 m\n",
                   &scene, &v, &err));
    assert_false(v.by_default);
    assert_int_equal(v.study[BR_VERIFY_SPACE].count, 0);
    const struct br_verify_study *joint = &v.study[BR_VERIFY_JOINT],
                                 *time = &v.study[BR_VERIFY_TIME];
    assert_int_equal(joint->count, 4);
    assert_int_equal(joint->n[0], 10);
    assert_int_equal(joint->n[3], 80);
    assert_int_equal(joint->steps[0], 10);
    assert_int_equal(joint->steps[3], 80);
    assert_int_equal(joint->line, 16);
    assert_ptr_equal(joint->method.solver, br_linear_solvers[0]);
    assert_int_equal(time->count, 5);
    assert_int_equal(time->n[4], 7);
    assert_string_equal(time->method.solver->name, "umfpack");
    assert_string_equal(time->method.contact->name, "implicit");
    assert_string_equal(time->method.friction->name, "regularised");
    assert_ptr_equal(time->method.scheme, br_time_schemes[0]);
    assert_int_equal(time->method.axial_degree, 1);
    assert_int_equal(time->expectations, 2);
    const struct br_expectation *l2 = &time->expectation[0], *tip = &time->expectation[1];
    assert_ptr_equal(l2->norm, &br_norm_l2);
    assert_int_equal(l2->part, BR_PART_TOTAL);
    CLOSE(l2->order, 1, 0);
    CLOSE(l2->tolerance, 0.05, 0);
    CLOSE(l2->ceiling, 3e-4, 0);
    assert_true(isnan(l2->floor));
    assert_int_equal(l2->line, 25);
    assert_ptr_equal(tip->norm, &br_norm_tip);
    assert_int_equal(tip->part, BR_PART_AXIAL);
    CLOSE(tip->floor, 1e-5, 0);
    CLOSE(tip->ceiling, 2e-5, 0);
    br_verify_clear(&v);
    br_scene_clear(&scene);
}

TEST(test_method)
{
    struct br_scene scene;
    struct br_verify v;
    struct br_error err = {0};
    MUST(read_part("verify:\n"
                   "  time:\n"
                   "    n: 7\n"
                   "    k: 0.25, 0.5, 0.03125, 0.125, 0.0625 s\n"
                   "    tolerance: 1e-7\n"
                   "    scheme: adaptive\n"
                   "    axial_degree: 2\n"
                   "    l2: 1 +- 0.05\n",
                   &scene, &v, &err));
    const struct br_method *m = &v.study[BR_VERIFY_TIME].method;
    assert_string_equal(m->scheme->name, "adaptive");
    assert_true(m->contact->at_new_step); /* as the scheme wants it */
    CLOSE(m->tolerance, 1e-7, 0);
    assert_int_equal(m->axial_degree, 2);
    br_verify_clear(&v);
    br_scene_clear(&scene);
}

TEST(test_default)
{
    struct br_scene scene;
    struct br_verify v;
    struct br_error err = {0};
    size_t line;
    MUST(read_part("", &scene, &v, &err));
    assert_true(v.by_default);
    MUST(br_verify_check(&scene, &v, &line, &err));
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        assert_true(v.study[kind].expectations > 0);
        assert_true(br_verify_points((enum br_verify_kind)kind, v.study[kind].count) >=
                    BR_VERIFY_LEAST_POINTS);
    }
    br_verify_clear(&v);
    br_scene_clear(&scene);
}

#define GRID "    n: 10, 20, 40, 80, 160\n    k: 0.1 s\n"
#define TIMES "    n: 10\n    k: 0.5, 0.25, 0.125, 0.0625, 0.03125 s\n"

TEST(test_refusals)
{
    static const struct {
        const char *part, *message;
    } rows[] = {
        {"verify: 3\n", ":14: verify: expected a mapping with space, time or joint"},
        {"verify: {}\n", ":14: verify: it is empty"},
        {"verify: []\n", ":14: verify: expected a mapping"},
        {"verify:\n  spaces:\n" GRID, ":15: spaces: unknown key in verify"},
        {"verify:\n  space: 3\n", ":15: space: expected a mapping with n, k"},
        {"verify:\n  space:\n    k: 0.1 s\n    l2: 2 +- 1\n", ":16: n: missing"},
        {"verify:\n  space:\n    n: 10\n    l2: 2 +- 1\n", ":16: k: missing"},
        {"verify:\n  space:\n" GRID, ":16: verify: nothing is expected"},
        {"verify:\n  space:\n" GRID "  space:\n" GRID, ":19: space: given twice"},
        {"verify:\n  space:\n" GRID "    n: 3\n", ":18: n: given twice"},
        {"verify:\n  space:\n    n: 10, 20, 40, 80\n    k: 0.1 s\n    l2: 2 +- 1\n",
         ":16: verify: found 4 cells, which give 3 errors, expected at least 4 errors"},
        {"verify:\n  space:\n    n: 10, 20, 40, 80, 100\n    k: 0.1 s\n    l2: 2 +- 1\n",
         "n = 80 does not divide n = 100"},
        {"verify:\n  space:\n    n: 10, 20, 40, 80, 160\n    k: 0.3 s\n    l2: 2 +- 1\n",
         ":17: k: k = 0.3 s does not divide the duration"},
        {"verify:\n  space:\n    n: 10, 20, 40\n    k: 0.1, 0.05 s\n    l2: 2 +- 1\n",
         ":16: space: found 3 n and 2 k, expected meshes and one time step"},
        {"verify:\n  time:\n    n: 10, 20\n    k: 0.1 s\n    l2: 2 +- 1\n",
         "expected one mesh and time steps"},
        {"verify:\n  joint:\n    n: 10, 20, 40\n    k: 0.1, 0.05 s\n    l2: 2 +- 1\n",
         "expected as many meshes as time steps, or one mesh for all"},
        {"verify:\n  joint:\n    n: 10, 20, 40, 80\n    k: 0.0125, 0.025, 0.05, 0.1 s\n    l2: 1 +- .1\n",
         ":16: joint: n = 20 and k = 0.025 s follow n = 10 and k = 0.0125 s"},
        {"verify:\n  joint:\n    n: 10, 20, 40, 80\n    k: 0.1 s\n    l2: 2 +- 1\n",
         ":16: joint: found 4 n and 1 k, expected as many"},
        {"verify:\n  time:\n    n: 10\n    k: 0.5, 0.25, 0.25, 0.1, 0.05 s\n    l2: 1 +- .1\n",
         ":17: k: the list: 0.25 is given twice"},
        {"verify:\n  time:\n    n: 10\n    k: 0.5, 0.25, 0.2, 0.1, 0.05 s\n    l2: 1 +- .1\n",
         "the time levels of k = 0.25 s are not all among those of k = 0.2 s"},
        {"verify:\n  time:\n    n: 10\n    k: 0.5, 0.25\n",
         ":17: k: found '0.5, 0.25', expected time "
         "steps and their unit"},
        {"verify:\n  time:\n    n: 10\n    k: a s\n", ":17: k: the list: found 'a'"},
        {"verify:\n  time:\n    n: [10]\n", ":16: time: found a list or a mapping"},
        {"verify:\n  time:\n    n: -3\n", ":16: n: the list: found '-3'"},
        {"verify:\n  time:\n    n: 0\n", ":16: n: the list: found '0'"},
        {"verify:\n  time:\n    n: 2.5\n", ":16: n: the list: found 2.5"},
        {"verify:\n  time:\n" TIMES "    l3: 1 +- .1\n", ":18: l3: unknown key in verify time"},
        {"verify:\n  time:\n" TIMES "    l2 shear: 1 +- .1\n", ":18: l2 shear: unknown key"},
        {"verify:\n  time:\n" TIMES "    l2 axial tip: 1 +- .1\n",
         ":18: l2 axial tip: unknown key"},
        {"verify:\n  time:\n" TIMES "    solver: magic\n", ":18: solver: found 'magic'"},
        {"verify:\n  time:\n" TIMES "    solver: riccati\n    solver: umfpack\n",
         ":19: solver: given twice"},
        {"verify:\n  time:\n" TIMES "    scheme: magic\n", ":18: scheme: found 'magic'"},
        {"verify:\n  time:\n" TIMES "    axial_degree: 3\n",
         ":18: axial_degree: found '3', expected one of: 1, 2"},
        {"verify:\n  time:\n" TIMES "    scaling: rows\n",
         ":18: scaling: found 'rows', expected one of: none, sum, max"},
        {"verify:\n  time:\n" TIMES "    refinement: -1\n",
         ":18: refinement: found '-1', expected a whole number from 0 to 100"},
        {"verify:\n  time:\n" TIMES "    refinement: 2\n    l2: 1 +- .1\n",
         "refinement: solver auto does not heed it, as solver: umfpack does"},
        {"verify:\n  time:\n" TIMES "    solver: banded\n    scaling: sum\n    l2: 1 +- .1\n",
         "scaling: solver banded does not heed it"},
        {"verify:\n  time:\n" TIMES "    scheme: adaptive\n    tolerance: a\n",
         ":19: tolerance: found 'a', expected a number above 1e-14 and below 1"},
        {"verify:\n  time:\n" TIMES "    scheme: adaptive\n    tolerance: 2\n    l2: 1 +- .1\n",
         ":19: tolerance: found '2', expected a number above 1e-14 and below 1"},
        {"verify:\n  time:\n" TIMES "    tolerance: 1e-3\n    l2: 1 +- .1\n",
         ":16: time: tolerance: time scheme euler does not heed it, as scheme: adaptive does"},
        {"verify:\n  time:\n" TIMES "    friction_parameter: 1\n    l2: 1 +- .1\n",
         ":16: time: friction_parameter: friction rule exact does not heed it, as friction: "},
        {"verify:\n  time:\n" TIMES "    friction_parameter: 2\n    friction: uzawa\n",
         ":18: friction_parameter: found '2', expected a number above 0 and below 2"},
        {"verify:\n  time:\n" TIMES "    kernel: portable\n    l2: 1 +- .1\n",
         ":18: kernel: unknown key in verify time"},
        {"verify:\n  time:\n" TIMES "    scheme: bdf2\n    contact: lagged\n    l2: 1 +- .1\n",
         ":16: time: contact rule 'lagged' does not go with time scheme 'bdf2', expected 'implicit'"},
        {"verify:\n  time:\n" TIMES "    l2: \"1 +- .1\\0, at most 1 m\"\n",
         ":18: scene: found '1 +- .1' followed by a zero byte"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1\n---\nverify: 3\n",
         ":19: scene: a second document begins"},
        {"verify:\n  time:\n" TIMES "    l2: 1\n",
         ":18: l2: found '1', expected an order with its"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +-\n", ":18: l2: found '1 +-'"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1 at most 3\n", ":18: l2: found"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1, at most 3\n", ":18: l2: found"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1, at most 3 m\n", "at most 3e-4 m^(3/2)"},
        {"verify:\n  time:\n" TIMES "    l2: nan +- .1\n", ":18: l2: found 'nan +- .1'"},
        {"verify:\n  time:\n" TIMES "    l2: 0 +- .1\n",
         ":18: verify: found 0 +- 0.1, expected an order"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- 0\n", "a tolerance > 0"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- 1\n", "which an error that does not fall at all"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1, at most 0 m^(3/2)\n", "a constant of 0"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1, constant 2 to 1 m^(3/2)\n", "from 2 to 1"},
        {"verify:\n  time:\n" TIMES "    l2: 1 +- .1\n    l2 total: 1 +- .2\n",
         ":19: verify: l2 total is given twice"},
        {"verify:\n  time:\n" TIMES
         "    l2: 2 +- .1\n    l2 axial: 1 +- .1\n    l2 bending: 2 +- .1\n",
         ":18: verify: 2 +- 0.1 contradicts what is expected of the parts"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        br_test_scene_refused(with(rows[i].part), true, rows[i].message);
}

/* A part that the scene does not model has no order. */
TEST(test_missing_part)
{
    struct br_scene scene = br_test_bare();
    struct br_verify v;
    struct br_error err = {0};
    size_t line;
    MUST(br_verify_default(&scene, &v, &err));
    MUST(br_verify_check(&scene, &v, &line, &err));
    scene.axial.modelled = false;
    REFUSED(br_verify_check(&scene, &v, &line, &err), BR_BAD_INPUT, "the scene has no axial part");
    br_verify_clear(&v);
}

/* Nobody but the check asks for it: a study is not stopped by what it does not need. */
TEST(test_ignored_by_others)
{
    struct br_scene scene;
    struct br_verify v;
    struct br_error err = {0};
    assert_int_equal(read_part("verify: 3\n", &scene, &v, &err), BR_BAD_INPUT);
    br_verify_clear(&v);
    br_scene_clear(&scene);
    MUST(br_scene_read(br_test_scene_file(with("verify: 3\n")), &scene, &err));
    br_scene_clear(&scene);
}
