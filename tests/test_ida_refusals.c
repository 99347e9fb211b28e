/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the scheme ida refuses, and how it tells that it failed; where it is not built in, nothing
 * is asked. */
#include <math.h>

#include "support.h"

static bool is_there(void)
{
    if (br_time_scheme_find("ida"))
        return true;
    print_message("# scheme ida is not built in\n");
    return false;
}

static struct br_method method(const char *scheme, double tolerance, const char *friction)
{
    struct br_method m = br_test_method(NULL, "implicit", friction);
    m.scheme = br_time_scheme_find(scheme);
    m.tolerance = tolerance;
    assert_non_null(m.scheme);
    return m;
}

static void refused(const struct br_scene *scene, const struct br_method *m, const char *text)
{
    struct br_error err = {0};
    struct br_march *march;
    REFUSED(br_march_create(&march, scene, 10, 10, m, &err), BR_BAD_INPUT, text);
    assert_null(march);
}

static void test_refusals(void **state)
{
    (void)state;
    if (!is_there())
        return;
    struct br_scene scene = br_test_bundled("example2");
    struct br_method m = method("ida", 1e-6, NULL);
    m.axial_degree = 2;
    refused(&scene, &m, "scheme ida has no quadratic axial elements");
    m = method("ida", 1e-6, NULL);
    m.solver = br_linear_solver_find("plain");
    refused(&scene, &m, "linear solver plain with scheme ida");
    m = method("ida", 1e-6, "uzawa");
    refused(&scene, &m, "friction rule 'uzawa' with scheme ida");
    m = method("ida", 0, NULL);
    refused(&scene, &m, "the tolerance of time scheme 'ida' is 0");
    m = method("ida", 1e-6, NULL);
    m.contact = br_contact_rule_find("lagged");
    refused(&scene, &m, "contact rule 'lagged' does not go with time scheme 'ida'");
    m = method("ida", 1e-6, NULL);
    m.linear.kernel = br_linear_solver_kernel(m.solver, &m.linear);
    refused(&scene, &m, "with scheme ida, expected none to be given");
    m = method("ida", 1e-6, NULL);
    scene.density = 0;
    refused(&scene, &m, "density 0 with scheme ida");
    br_scene_clear(&scene);
}

/* A soft rod under a load, which fails with a message. */
static void fails(const char *load, double tolerance, const char *text)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    struct br_march *march;
    const struct br_method m = method("ida", tolerance, NULL);
    scene.axial.stiffness = scene.axial.viscosity = 1e-6;
    scene.axial.load = br_test_load(load);
    enum br_status status = br_march_create(&march, &scene, 10, 1, &m, &err);
    if (!status)
        status = br_march_step(march, &err);
    REFUSED(status, BR_NOT_FINITE, text);
    br_march_free(march);
    br_load_clear(&scene.axial.load);
}

static void test_failures(void **state)
{
    (void)state;
    if (!is_there())
        return;
    fails("sqrt(0.47 - t)", 1e-6, "axial load: ");
    fails("1/(t - 0.471)^2", 1e-6, "axial load: ");
}

/* Free fall of such a rod, thrown at t = 0.47 s: statics would mislead the scale of the tolerance.
 */
static void test_thrown(void **state)
{
    (void)state;
    if (!is_there())
        return;
    struct br_scene scene = br_test_bare();
    const struct br_method m = method("ida", 1e-6, NULL);
    scene.axial.stiffness = scene.axial.viscosity = 1e-9;
    scene.axial.load = br_test_load("t > 0.47 ? 1000 : 0");
    const struct br_test_end end = br_test_run(&scene, 100, 1, &m);
    CLOSE(end.u_tip, 500 * 0.53 * 0.53 * pow(scene.duration, 2) / scene.density, 0.05);
    br_load_clear(&scene.axial.load);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_thrown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
