/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much damping bdf3 needs: with that no mode grows, with half of it one does, which is refused.
 * The modes are those of w'' + (c/a) om^2 w' + om^2 w = 0, by the scheme's own polynomial. */
#include <complex.h>
#include <math.h>

#include "solver/method.h"
#include "solver/scene.h"
#include "support.h"

/* Whether bdf3 lets a solution of y' = (z / k) y grow: a root of
 * (11/6 - z) x^3 - 3 x^2 + 3/2 x - 1/3 beyond 1, by Durand and Kerner's iteration. */
static bool grows(double complex z)
{
    const double complex lead = 11.0 / 6 - z, c2 = -3 / lead, c1 = 1.5 / lead, c0 = -1.0 / 3 / lead;
    double complex x[3] = {1, 0.4 + 0.9 * I, (0.4 + 0.9 * I) * (0.4 + 0.9 * I)};
    for (int i = 0; i < 200; i++)
        for (int j = 0; j < 3; j++) {
            const double complex others = (x[j] - x[(j + 1) % 3]) * (x[j] - x[(j + 2) % 3]);
            x[j] -= (((x[j] + c2) * x[j] + c1) * x[j] + c0) / others;
        }
    return cabs(x[0]) > 1 + 1e-9 || cabs(x[1]) > 1 + 1e-9 || cabs(x[2]) > 1 + 1e-9;
}

/* Whether one of the frequencies up to omega k = highest grows with c / (2 a k) = damping. */
static bool some_grow(double damping, double lowest, double highest)
{
    for (int i = 0; i <= 1000; i++) {
        const double om = lowest + (highest - lowest) * i / 1000, xi = damping * om;
        if (xi < 1 && grows(om * (-xi + I * sqrt(1 - xi * xi))))
            return true;
    }
    return false;
}

static struct br_scene vibrating(double viscosity)
{
    struct br_scene s = br_test_bare();
    s.axial.modelled = false;
    s.bending.viscosity = viscosity;
    return s;
}

static struct br_method bdf3(void)
{
    struct br_method method = br_test_method(NULL, "implicit", NULL);
    method.scheme = br_time_scheme_find("bdf3");
    return method;
}

/* For an element, the least viscosity over all steps k: no mode grows with it, and one does with
 * half of it. `highest`: the frequency of a free element, 1/s. */
static void check_bounds(enum br_field_kind kind, int degree, double highest)
{
    for (double k = 1e-6; k < 1e6; k *= 3) {
        struct br_scene s = vibrating(1);
        struct br_field f = br_field_of_scene(&s, kind, 10, k, degree);
        const double lowest = sqrt(br_field_lowest_mode(&f));
        /* The viscosity that just does, by halving. */
        double low = 1e-30, high = 1e30;
        for (int i = 0; i < 200; i++) {
            f.viscosity = sqrt(low * high);
            if (k <= br_damping_largest_step(&f, false))
                high = f.viscosity;
            else
                low = f.viscosity;
        }
        assert_false(some_grow(high / (2 * k), k * lowest, fmin(3, k * highest)));
        if (k * lowest < 0.8 && k * highest > 0.9)
            assert_true(some_grow(high / (4 * k), k * lowest, fmin(3, k * highest)));
        if (k * highest > 0.1 && k * highest < 0.4) /* (om k)^2 / 4 is the lobe's rim, nearly */
            assert_true(some_grow(high / (2.6 * k), k * lowest, k * highest));
    }
}

/* The highest frequencies of a free rod and beam: 12, 60 and 8400 of the textbooks. */
TEST(test_bounds)
{
    check_bounds(BR_AXIAL, 1, sqrt(12) * 10);
    check_bounds(BR_AXIAL, 2, sqrt(60) * 10);
    check_bounds(BR_BENDING, 1, sqrt(8400) * 100);
}

TEST(test_refusals)
{
    const struct br_method method = bdf3();
    struct br_march *march;
    struct br_scene s = vibrating(1e-3);
    REFUSED(br_march_create(&march, &s, 10, 10, &method, &err), BR_BAD_INPUT,
            "it lets vibration of so little damping grow, expected k of at most 0.00704225 s");
    MUST(br_march_create(&march, &s, 10, 143, &method, &err));
    br_march_free(march);
    s.density = 0; /* nothing vibrates */
    MUST(br_march_create(&march, &s, 10, 10, &method, &err));
    br_march_free(march);
    s.density = 1e-9; /* nor so slowly that the scheme would not damp it */
    MUST(br_march_create(&march, &s, 10, 10, &method, &err));
    br_march_free(march);
}

/* The modes beside an undamped spring at the tip have some of their stiffness in the rod. */
TEST(test_spring)
{
    struct br_scene s = br_test_bare();
    const struct br_field f = br_field_of_scene(&s, BR_AXIAL, 10, 1, 1);
    assert_true(br_damping_largest_step(&f, true) < br_damping_largest_step(&f, false));
    for (double spring = 1e-3; spring < 1e3; spring *= 1.1) {
        double q = 2, low = acos(0), high = 2 * acos(0); /* tan q = -q / spring */
        for (int i = 0; i < 100; i++) {
            q = (low + high) / 2;
            if (q * cos(q) + spring * sin(q) > 0)
                low = q;
            else
                high = q;
        }
        const double rod = q * q / 2 + q * sin(2 * q) / 4, of_spring = spring * pow(sin(q), 2);
        assert_true(rod / (rod + of_spring) > 0.6);
    }
}
