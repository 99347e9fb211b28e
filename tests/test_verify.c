/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verify part of a scene: what is read, what is refused and where. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "orders/request.h"
#include "solver/linear/linear_solver.h"
#include "study/scene/file.h"
#include "study/verify/verify.h"
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
                                struct br_error *why)
{
    return br_verify_read("scene.yaml", with(part), NULL, scene, verify, why);
}

TEST(test_whole)
{
    OWNED(br_scene) scene;
    OWNED(br_verify) v;
    MUST(read_part("verify:\n"
                   "  joint:\n"
                   "    n: 10, 20,40, 80\n"
                   "    k: 0.1, 0.05, 0.025, 0.0125 s\n"
                   "    tolerance: 1e-7\n"
                   "    scheme: adaptive\n"
                   "    axial_degree: 2\n"
                   "    energy bending: 1 +- 0.5\n"
                   "  time:\n"
                   "    n: 7\n"
                   "    k: 0.25, 0.5, 0.03125, 0.125, 0.0625 s\n"
                   "    solver: umfpack\n"
                   "    contact: implicit\n"
                   "    friction: regularised\n"
                   "    l2: 1 +- 0.05, at most 3e-4 m^(3/2)\n"
                   "    l2 axial: 2 +- 0.05\n" /* the total has the lower order */
                   "    l2 bending: 1 +- 0.05\n"
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
    assert_string_equal(joint->method.scheme->name, "adaptive");
    assert_true(joint->method.contact->at_new_step); /* as the scheme wants it */
    CLOSE(joint->method.tolerance, 1e-7, 0);
    assert_int_equal(joint->method.axial_degree, 2);
    assert_int_equal(time->count, 5);
    assert_int_equal(time->n[4], 7);
    assert_string_equal(time->method.solver->name, "umfpack");
    assert_string_equal(time->method.contact->name, "implicit");
    assert_string_equal(time->method.friction->name, "regularised");
    assert_ptr_equal(time->method.scheme, br_time_schemes[0]);
    assert_int_equal(time->method.axial_degree, 1);
    assert_int_equal(time->expectations, 4);
    const struct br_verify_expectation *l2 = &time->expectation[0], *tip = &time->expectation[3];
    assert_ptr_equal(l2->norm, &br_norm_l2);
    assert_int_equal(l2->part, BR_PART_TOTAL);
    CLOSE(l2->band.order, 1, 0);
    CLOSE(l2->band.tolerance, 0.05, 0);
    CLOSE(l2->band.ceiling, 3e-4, 0);
    assert_true(isnan(l2->band.floor));
    assert_int_equal(l2->band.line, 28);
    assert_ptr_equal(tip->norm, &br_norm_tip);
    assert_int_equal(tip->part, BR_PART_AXIAL);
    CLOSE(tip->band.floor, 1e-5, 0);
    CLOSE(tip->band.ceiling, 2e-5, 0);
    size_t line;
    MUST(br_verify_check(&scene, &v, &line, &err));
}

/* No bundled scene is taken for a study file of another program. */
TEST(test_scenes_are_no_study_files)
{
    char **names, path[1200];
    size_t count = 0;
    MUST(br_scene_list(&names, &count, &err));
    assert_true(count > 5);
    for (size_t i = 0; i < count; i++) {
        char *text;
        MUST(br_scene_find(names[i], path, sizeof path, &err));
        MUST(br_scene_load(path, &text, &err));
        if (br_is_study_file(text))
            fail_msg("%s is taken for a study file", path);
        free(text);
    }
    br_scene_list_free(names, count);
}

/* A part that the scene does not model has no order. */
TEST(test_default)
{
    OWNED(br_scene) scene;
    OWNED(br_verify) v;
    size_t line;
    MUST(read_part("", &scene, &v, &err));
    assert_true(v.by_default);
    MUST(br_verify_check(&scene, &v, &line, &err));
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        assert_true(v.study[kind].expectations > 0);
        assert_true(br_verify_points((enum br_verify_kind)kind, v.study[kind].count) >=
                    BR_VERIFY_LEAST_POINTS);
    }
    scene.axial.modelled = false;
    REFUSED(br_verify_check(&scene, &v, &line, &err), BR_BAD_INPUT, "the scene has no axial part");
}

static void refuse(char *row)
{
    const char *message = br_test_part(row);
    br_test_scene_refused(with(br_test_unescape(row)), true, message);
}

TEST(test_refusals)
{
    br_test_rows("verify parts, behind the scene of test_verify.c", refuse);
}

/* Nobody but the check asks for it: a study is not stopped by what it does not need. */
TEST(test_ignored_by_others)
{
    struct br_scene scene;
    OWNED(br_verify) v;
    assert_int_equal(read_part("verify: 3\n", &scene, &v, &err), BR_BAD_INPUT);
    br_scene_clear(&scene);
    MUST(br_scene_read(br_test_scene_file(with("verify: 3\n")), &scene, &err));
    br_scene_clear(&scene);
}
