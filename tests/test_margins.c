/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adaptive scheme where its estimate and the ends of its steps do not tell: tips that leave
 * their branch of a law for a part of a step, or rest at its end, loads that jump, and blows. */
#include <math.h>

#include "solver/march_state.h"
#include "support.h"

static struct br_margins of(size_t count, const double margin[])
{
    static const double time[] = {0, 0.5, 0.25, 1};
    struct br_margins m = {0};
    for (size_t i = 0; i < count; i++)
        br_margins_add(&m, time[i], margin[i]);
    return m;
}

TEST(test_dip)
{
    const struct br_margins inside = of(4, (double[]){1, 0.5, 0.7, 0.1});
    const struct br_margins stages = of(4, (double[]){1, -1, -2, 1});
    const struct br_margins end = of(4, (double[]){1, 0.5, 0.7, -0.1});
    const struct br_margins between = of(4, (double[]){0.28025, 0.03025, 0.03025, 0.78025});
    const struct br_margins before = of(4, (double[]){0.03025, 0.28025, 0.03025, 1.53025});
    const struct br_margins start = of(4, (double[]){-1e-9, 0.5, 0.25, 1});
    CLOSE(br_margins_dip(&inside), 0, 0);
    CLOSE(br_margins_dip(&stages), 0.25, 0);
    CLOSE(br_margins_dip(&end), 1, 0);
    CLOSE(br_margins_dip(&start), 0, 0);
    CLOSE(br_margins_dip(&(struct br_margins){0}), 0, 0);
    CLOSE(br_margins_dip(&between), 0.375, 1.0 / 64); /* 2 (t - 3/8)^2 - 0.001 */
    CLOSE(br_margins_dip(&before), 0.125, 1.0 / 64);  /* 2 (t - 1/8)^2 - 0.001 */
}

static struct br_method adaptive(double tolerance)
{
    struct br_method method = br_test_method(NULL, "implicit", NULL);
    method.scheme = br_time_scheme_find("adaptive");
    method.tolerance = tolerance;
    return method;
}

/* The reaction of a propped tip, 3/8 q L = 37.5 sin t N at its largest, is above the bound by 3e-5
 * of itself, for 0.015 of 10 s: far less than a step. The tip must slip by 22 um. The value is that
 * of esdirk3 with 300,000 steps; a tolerance of 1e-11 differs from it by 1e-13 m. With many
 * tolerances it falls on many places of a step, before its first stage, too. */
TEST(test_short_slip)
{
    OWNED(br_scene) scene = br_test_bare();
    scene.duration = 10;
    scene.density = 1e-3;
    scene.axial.modelled = false;
    scene.bending.stiffness = 20;
    scene.bending.viscosity = 0.02;
    scene.bending.load = br_test_load("100*sin(t)");
    scene.friction = (struct br_friction){.law = BR_TRESCA, .coefficient = 37.499};
    for (double tolerance = 1e-4; tolerance > 1e-9; tolerance *= 0.7) {
        const struct br_method method = adaptive(tolerance);
        const struct br_test_end end = br_test_run(&scene, 4, 10, &method);
        CLOSE(end.w_tip, 2.2204315e-5, fmin(1e-6, 20 * tolerance));
    }
}

/* Both laws; the rod's tip rests at the gap of 0 until its load begins. */
static struct br_scene pressed(const char *axial, const char *bending)
{
    struct br_scene scene = br_test_bare();
    scene.density = 0.01;
    scene.axial.stiffness = 100;
    scene.axial.viscosity = 0.5;
    scene.axial.load = br_test_load(axial);
    scene.bending.stiffness = 20;
    scene.bending.viscosity = 0.02;
    scene.bending.load = br_test_load(bending);
    scene.contact = (struct br_contact){.modelled = true, .stiffness = 1000};
    scene.friction = (struct br_friction){.law = BR_COULOMB, .coefficient = 1000};
    return scene;
}

/* A margin of 0 for a while is not the switch, which comes when the load does. */
TEST(test_rest_at_gap)
{
    OWNED(br_scene) scene = pressed("100*(abs(t-0.613)+t-0.613)", "-100*(abs(t-0.613)+t-0.613)");
    for (double tolerance = 1e-3; tolerance > 1e-9; tolerance /= 3) {
        const struct br_method method = adaptive(tolerance);
        OWNED(br_march) *march = br_test_march(&scene, 4, 10, &method);
        br_test_advance(march, 10);
        AT_MOST((double)br_march_counts(march).steps, 1000);
    }
}

/* By a tolerance and by a far smaller one the march comes to the same place. */
static void check_against_finer(struct br_scene *scene, double tolerance, double finer,
                                double off_u, double off_w)
{
    const struct br_method method = adaptive(tolerance), other = adaptive(finer);
    const struct br_test_end end = br_test_run(scene, 4, 10, &method);
    const struct br_test_end best = br_test_run(scene, 4, 10, &other);
    CLOSE(end.u_tip, best.u_tip, off_u);
    CLOSE(end.w_tip, best.w_tip, off_w);
    br_scene_clear(scene);
}

/* A load that jumps within a step pushes first and foremost velocities. The tolerance is one of a
 * step, of which many see the jump. And a blow of 10 us in the middle of a second, where a rough
 * march would take it for one of a sixteenth, and its strain of thousands of the true one for what
 * errors are relative to. */
TEST(test_jump_and_blow)
{
    struct br_scene jump = pressed("100*(tanh(1e8*(t-0.953))+1)", "100*(tanh(1e8*(t-0.971))+1)"),
                    blow = pressed("20*sin(8*t)", "10*sin(10*t)");
    jump.density = 0.1;
    blow.density = 1;
    jump.contact.gap = blow.contact.gap = 0.1;
    jump.friction.coefficient = blow.friction.coefficient = 300;
    blow.axial.tip_force = br_test_function("1e3*exp(-((t-0.5)/1e-5)^2)");
    blow.bending.tip_force = br_test_function("1e3*exp(-((t-0.5)/1e-5)^2)");
    check_against_finer(&jump, 1e-8, 1e-12, 2e-7, 5e-7);
    check_against_finer(&blow, 1e-4, 1e-10, 5e-6, 3e-5);
}

/* bdf3 is not stable on the imaginary axis: within 800 steps such a beam is off by its own size. */
TEST(test_undamped)
{
    struct br_march *march;
    struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method(NULL, "implicit", NULL);
    method.scheme = br_time_scheme_find("bdf3");
    scene.bending.viscosity = 0;
    REFUSED(br_march_create(&march, &scene, 4, 800, &method, &err), BR_BAD_INPUT, "undamped");
    scene.density = 0;
    MUST(br_march_create(&march, &scene, 4, 800, &method, &err));
    br_march_free(march);
    scene.density = 1;
    scene.bending.modelled = false;
    MUST(br_march_create(&march, &scene, 4, 800, &method, &err));
    br_march_free(march);
}
