/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the exact reference knows of loads that are short in x or t, that jump, or whose fronts
 * move, before it solves. Solutions under such loads: test_blows. */
#include <math.h>

#include "reference/exact/inside.h"
#include "tests/exact_scenes.h"
#include "tests/support.h"

static struct br_scene rod(double density, double viscosity)
{
    return (struct br_scene){
        .length = 2.5,
        .duration = 3,
        .density = density,
        .axial = {.modelled = true, .stiffness = 7, .viscosity = viscosity},
    };
}

/* ---- solutions ---- */

/* A load of -3 N/m on all x < 2 t of a rod without inertia: c u' + a u = -3 (2 t)^2 / 2 at the tip
 * until the front leaves. What the solution says of itself must be small; its velocities are less
 * certain than `solve` wants them. */
TEST(test_front)
{
    OWNED(br_scene) scene = rod(0, 0.7);
    struct solved s;
    scene.axial.load = br_test_load("-3*step(2*t-x)");
    MUST(br_exact_create(&s.exact, &scene, &(struct br_exact_options){.acceptable = 1e-5}, &err));
    MUST(br_exact_state_create(&s.state, s.exact, &err));
    const struct br_exact_report r = br_exact_report(s.exact, BR_AXIAL);
    AT_MOST(r.error.displacement / r.largest.displacement, 1e-6);
    for (int n = 0; n <= 20; n++) {
        br_exact_at(s.exact, scene.duration * n / 20, s.state);
        const double rate = 10, t = fmin(s.state->time, 1.25), later = s.state->time - t;
        const double ramp = 2 * (t * t + 2 / rate * (-expm1(-rate * t) / rate - t));
        const double tip = 3.125 + (ramp - 3.125) * exp(-rate * later);
        assert_near(s.state->tip[BR_AXIAL].displacement, -3.0 / 7 * tip,
                    r.error.displacement + 1e-13 * r.largest.displacement);
    }
    release(&s);
}

/* A switching function that changes nothing cuts the beam and the time: the solution stays. */
TEST(test_needless_ends)
{
    static const char *const loads[] = {"-8*(sin(5*x)+x)*exp(-t)",
                                        "-8*(sin(5*x)+x)*exp(-t)*(step(x-0.1)+step(0.1-x))"
                                        "+step(t-0.7)-step(t-0.7)*1"};
    struct br_scene scene[2];
    struct solved s[2];
    for (int i = 0; i < 2; i++) {
        scene[i] = (struct br_scene){.length = 0.4, .duration = 2, .density = 1.3};
        scene[i].bending =
            (struct br_scene_field){.modelled = true, .stiffness = 5, .viscosity = 0.02};
        scene[i].bending.load = br_test_load(loads[i]);
        s[i] = solve(&scene[i], 1e-10);
    }
    const struct br_exact_quantity part = {BR_BENDING, false, 0};
    const double largest = br_exact_report(s[0].exact, BR_BENDING).largest.displacement;
    for (int n = 0; n <= 40; n++) {
        for (int i = 0; i < 2; i++)
            br_exact_at(s[i].exact, 2.0 * n / 40, s[i].state);
        for (double x = 0; x <= 0.4; x += 0.08)
            assert_near(value_of(&s[1], part, x), value_of(&s[0], part, x), 1e-11 * largest);
    }
    for (int i = 0; i < 2; i++) {
        release(&s[i]);
        br_scene_clear(&scene[i]);
    }
}

/* ---- what is known before ---- */

/* Interpolation misses e^{2 x}, or e^{2 t}, by 2 (w/2)^(d+1) / (d+1)! at most, but for a factor
 * e^{2 w}. */
TEST(test_mesh_of_errors)
{
    const char *text[] = {"exp(2*x)", "exp(2*t)"};
    for (enum br_variable v = BR_X; v <= BR_T; v++) {
        OWNED(br_function) f = br_test_function(text[v]);
        for (size_t degree = 1; degree <= 15; degree++)
            for (double w = 0.5; w > 0.01; w /= 2) {
                struct br_box box = {{0, 0}, {0, 0}};
                (v == BR_X ? &box.x : &box.t)->high = w;
                const double order = (double)degree + 1;
                const double least = 2 * pow(w / 2, order) / tgamma(order + 1);
                const double error = br_function_mesh_error(&f, v, box, degree);
                AT_MOST(least, error * (1 + 1e-9));
                AT_MOST(error, least * exp(2 * w) * (1 + 1e-9));
            }
    }
}

/* Of x t it is half of both sides' product, of which at least half is told. */
TEST(test_mesh_of_means)
{
    OWNED(br_function) f = br_test_function("x*t");
    for (double length = 1e-3; length < 1e4; length *= 100) {
        const double mean = length / 2 * 3 / 2;
        const double found = br_function_mesh_mean(&f, (struct br_box){{0, length}, {0, 3}});
        AT_MOST(found, mean * (1 + 1e-9));
        AT_MOST(mean / 2, found);
    }
}

/* A root is never smooth at 0: its last cell holds what it holds, unresolved. */
TEST(test_mesh_of_a_root)
{
    OWNED(br_function) f = br_test_function("sqrt(t)");
    struct br_list end[2] = {{0}};
    const struct br_list *ends = &end[BR_T];
    OWNED(br_store) store = {0};
    struct br_function_mesh function_mesh = {.f = &f, .box = {{0, 0}, {0, 2}}, .mean = 1};
    MUST(br_function_mesh_add(&function_mesh, function_mesh.box, end, &store, &err));
    br_list_sort(&end[BR_T]);
    assert_true(ends->count > 10);
    /* its width times its values' range, of the integral 2 */
    AT_MOST(pow(ends->at[0], 1.5) / 2 * (1 - 1e-9), function_mesh.missed);
    AT_MOST(function_mesh.missed, (double)ends->count * 1e-13);
    for (size_t i = 1; i < ends->count; i++)
        AT_MOST(ends->at[i], 2.1 * ends->at[i - 1]);
}

/* A peak on a front, where nothing finds it: all of it in one box may be missed, or twice that. */
TEST(test_mesh_of_a_front)
{
    OWNED(br_function) f = br_test_function("step(x-t)*(1+exp(-((x-0.5003)/1e-5)^2))");
    struct br_list ends[2] = {{0}};
    OWNED(br_store) store = {0};
    struct br_function_mesh function_mesh = {.f = &f, .box = {{0, 1}, {0, 1}}, .mean = 1};
    MUST(br_function_mesh_add(&function_mesh, function_mesh.box, ends, &store, &err));
    const double box = pow(0.5, 20);
    AT_MOST(0.9 * box, function_mesh.missed);
    AT_MOST(function_mesh.missed, 2.1 * box);
}

static struct br_data_mesh data_mesh_of(const struct br_scene *scene, enum br_field_kind kind)
{
    struct br_data_mesh o;
    MUST(br_data_mesh_init(&o, scene, kind, &err));
    return o;
}

static bool has(const struct br_list *list, double value)
{
    for (size_t i = 0; i < list->count; i++)
        if (fabs(list->at[i] - value) <= 1e-12 * value)
            return true;
    return false;
}

/* A blow is seen where it is, whichever factor it is of, between jumps or not; a step begins in the
 * later cell. */
TEST(test_data_mesh_of_a_blow)
{
    static const char *const loads[] = {"(1+x)*exp(-((t-1.2)/1e-3)^2)",
                                        "(1+x)*exp(-((t-1.2)/1e-3)^2)*(step(t-1)-step(t-2))"};
    for (size_t row = 0; row < sizeof loads / sizeof *loads; row++) {
        OWNED(br_scene) s = rod(1, 0.7);
        s.axial.load = br_test_load(loads[row]);
        OWNED(br_data_mesh) o = data_mesh_of(&s, BR_AXIAL);
        assert_true(br_data_mesh_is_sharp(&o, 1.2, 0.01));
        assert_false(br_data_mesh_is_sharp(&o, 0.3, 0.01));
        AT_MOST(br_data_mesh_cell(&o, 1.2), 2e-3);
        AT_MOST(0.1, br_data_mesh_cell(&o, 0.3));
        const struct br_list *cell = &o.end[BR_T];
        for (size_t i = 0; i + 1 < cell->count; i++) {
            CLOSE(br_data_mesh_cell(&o, cell->at[i]), cell->at[i + 1] - cell->at[i], 0);
            AT_MOST(br_data_mesh_reach(&o, cell->at[i]), s.duration - cell->at[i]);
            AT_MOST(cell->at[i] + br_data_mesh_reach(&o, cell->at[i]), 1.2);
            if (cell->at[i + 1] > 1.19)
                break;
        }
    }
}

/* Nobody looks along x for what a force at the tip does: of a blow whose tails are next to nothing,
 * the mean was once so small that an error of 1e202 times the solution was stated. */
TEST(test_data_mesh_of_a_blow_at_the_tip)
{
    OWNED(br_scene) s = rod(1, 0.7);
    s.length = 0.022135580911717349;
    s.duration = 62.72405076094217;
    s.axial.tip_force = br_test_function("12*exp(-((t-38.5286)/0.00806621)^2)");
    OWNED(br_data_mesh) o = data_mesh_of(&s, BR_AXIAL);
    AT_MOST(br_data_mesh_cell(&o, 38.5286), 0.02);
    AT_MOST((double)o.end[BR_T].count, 200); /* not some 1,800 */
    AT_MOST(o.proved, 1e-10);
    AT_MOST(o.missed, 1e-10);
}

/* When a front leaves, and that it moves; where initial data bend; what a jump in a force at the
 * tip leaves there; and what is proved, and what is not, of data that no polynomial is. */
TEST(test_data_mesh_of_places)
{
    struct br_scene s = rod(1, 0.7);
    s.axial.load = br_test_load("-3*step(2*t-x)");
    struct br_data_mesh o = data_mesh_of(&s, BR_AXIAL);
    assert_true(o.fronts);
    CLOSE(o.proved, BR_MESH_TOLERANCE, 0);
    bool found = false;
    for (size_t i = 0; i < o.jump.count; i++)
        found = found || fabs(o.jump.at[i].low - 1.25) < 1e-12;
    assert_true(found);
    br_data_mesh_clear(&o);
    br_scene_clear(&s);

    s = rod(1, 0.7);
    s.axial.displacement = br_test_function("abs(x-1.1)-1.1+sqrt(x)");
    s.axial.tip_force = br_test_function("exp(t)*step(t-1)");
    o = data_mesh_of(&s, BR_AXIAL);
    assert_true(!o.fronts && has(&o.end[BR_X], 1.1));
    const double layer = sqrt(0.7 * 1e-6 * s.duration);
    const double last = s.length - o.end[BR_X].at[o.end[BR_X].count - 2];
    AT_MOST(last, 1.01 * layer);
    AT_MOST(1e-18, o.missed);
    AT_MOST(o.missed, 1e-10);
    AT_MOST(1e-18, o.proved);
    AT_MOST(o.proved, 1e-10);
    br_data_mesh_clear(&o);
    br_scene_clear(&s);
}
