/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit of the lagged contact (solver/laws.h) against eigenvalues of marched steps. */
#include <gsl/gsl_errno.h>
#include <math.h>

#include "study/run/run.h"
#include "tests/lab/step_matrix.h"
#include "tests/support.h"

/* One element without inertia: u_n = (c/k - c_H L)/(a + c/k) u_{n-1}, whatever the velocity was. */
TEST(test_matrix)
{
    struct br_error err = {0};
    const struct br_field rod = {
        .kind = BR_AXIAL, .n = 1, .h = 2, .stiffness = 3, .viscosity = 0.5, .k = 0.25, .degree = 1};
    double matrix[4], radius;
    assert_int_equal(br_step_states(&rod), 2);
    MUST(br_step_matrix(&rod, 7, matrix, &err));
    const double z = (0.5 / 0.25 - 7 * 2) / (3 + 0.5 / 0.25);
    CLOSE(matrix[0], z, 1e-15);
    CLOSE(matrix[1], 0, 1e-15);
    CLOSE(matrix[2], z - 1, 1e-15); /* k v_n = u_n - u_{n-1} */
    CLOSE(matrix[3], 0, 1e-15);
    MUST(br_step_radius(&rod, 7, &radius, &err));
    CLOSE(radius, -z, 1e-14);
}

/* Much and little inertia and viscosity, both degrees: at the limit the largest eigenvalue leaves
 * the unit circle, and beyond it is the predicted growth. */
TEST(test_limit)
{
    static const struct {
        double density, viscosity;
        int degree;
    } rods[] = {{1e-4, 1, 1}, {0, 1, 1}, {1000, 1, 1}, {1, 1e-6, 1}, {1, 0, 1}, {1, 1e-3, 2}};
    static const double k[] = {1e-5, 1e-3, 1e-1},
                        shares[] = {1e-3, 0.9, 1 - 1e-9, 1 + 1e-9, 2, 1e6};
    struct br_error err = {0};
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    for (size_t i = 0; i < 18; i++) {
        const struct br_field rod = {.kind = BR_AXIAL,
                                     .n = 4,
                                     .h = 0.25,
                                     .density = rods[i / 3].density,
                                     .stiffness = 1000,
                                     .viscosity = rods[i / 3].viscosity,
                                     .k = k[i % 3],
                                     .degree = rods[i / 3].degree};
        for (size_t j = 0; j < 6; j++) {
            const double stiffness = shares[j] * br_contact_limit_stiffness(&rod);
            double radius;
            MUST(br_step_radius(&rod, stiffness, &radius, &err));
            assert_true(shares[j] < 1 ? radius <= 1 + 1e-12 : radius > 1 + 1e-11);
            if (shares[j] > 1)
                CLOSE(radius / br_contact_growth(&rod, stiffness), 1, 1e-11);
        }
    }
    gsl_set_error_handler(handler);
}

/* The rest of a pressed rod by its balance: the free tip is at q L^2 / (2 a), and the contact's
 * share of q L / 2 is c_H L over a + c_H L. */
static void check_rest(const struct br_time_scheme *scheme, double stiffness, size_t steps)
{
    static struct br_run_report report;
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    scene.bending.modelled = false;
    scene.density = 1e-4;
    scene.axial.stiffness = 1000;
    scene.axial.load = (struct br_load){{{{.constant = 1000}, {.constant = 1}}}};
    scene.contact = (struct br_contact){.modelled = true, .stiffness = stiffness};
    struct br_run_request request = {
        .scene = &scene, .method = br_method_default(), .n = 8, .steps = steps, .check = true};
    request.method.scheme = scheme;
    request.method.contact = br_contact_rule_find("implicit");
    MUST(br_run(&request, &report, &err));
    MUST(report.failure.status);
    MUST(report.verdict.status);
    const double rest = 500 / (1000 + stiffness); /* 1e-8 of the way is left by bdf3 in 10 steps */
    CLOSE(report.end.last.contact_force / (stiffness * rest), 1, 1e-7);
    CLOSE(report.end.last.displacement[BR_AXIAL] / 0.5, rest / 0.5, 1e-7);
}

/* Contact at u_n has no limit, and every scheme damps at infinity: ten steps of a hundred
 * relaxation times bring a pressed rod to rest. */
TEST(test_rest)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (double stiffness = 1; stiffness < 2e15; stiffness *= 1e3)
            for (size_t steps = 10; steps <= 1000; steps *= 10)
                check_rest(br_time_schemes[i], stiffness, steps);
}
