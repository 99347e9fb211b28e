/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit of the lagged contact (solver/laws.h) against eigenvalues of marched steps. */
#include <gsl/gsl_errno.h>
#include <math.h>

#include "tests/support.h"
#include "tests/lab/step_matrix.h"

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
    static const double k[] = {1e-5, 1e-3, 1e-1}, shares[] = {1e-3, 0.9, 1 - 1e-9, 1 + 1e-9, 2, 1e6};
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
