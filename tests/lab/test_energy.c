/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What schemes take from a free vibration, and each step's balance of energy. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "solver/scene.h"
#include "tests/lab/energy.h"
#include "tests/support.h"

/* e^z to the scheme's order; Euler's is 1/(1 - z). */
TEST(test_amplification)
{
    const double complex z = 0.02 + 0.03 * I, large = -0.5 + 2 * I;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++) {
        const struct br_textbook *t = br_textbook_step((*s)->name, 2);
        if (!t)
            continue;
        AT_MOST(cabs(br_amplification(t, z) - cexp(z)), pow(cabs(z), (*s)->order + 1));
        AT_MOST(cabs(br_amplification(t, conj(large)) - conj(br_amplification(t, large))), 1e-15);
    }
    const struct br_textbook *euler = br_textbook_step("euler", 2);
    AT_MOST(cabs(br_amplification(euler, large) - 1 / (1 - large)), 1e-15);
    const double complex r = br_amplification(br_textbook_step("bdf2", 2), large);
    AT_MOST(cabs((1 - 2 * large / 3) * r * r - 4 * r / 3 + 1.0 / 3), 1e-15);
}

/* omega^2 = 6 a/(rho h^2) (1 - cos t)/(2 + cos t), t = pi h/2, of linear elements; 1.875^4 of a
 * cantilever, from above. */
TEST(test_modes)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    struct br_beam_mode mode;
    const double h = 1.0 / BR_MODE_ELEMENTS, t = M_PI * h / 2;
    MUST(br_beam_mode_find(&mode, &scene, BR_AXIAL, &err));
    CLOSE(mode.omega, sqrt(6 * (1 - cos(t)) / (2 + cos(t))) / h, 1e-13);
    for (size_t i = 0; i < BR_MODE_ELEMENTS; i++)
        CLOSE(mode.phi[i], sin(t * (double)(i + 1)), 1e-12);
    MUST(br_beam_mode_find(&mode, &scene, BR_BENDING, &err));
    const double exact = 1.8751040687119611664 * 1.8751040687119611664;
    assert_true(mode.omega > exact && mode.omega < exact * (1 + 1e-5));
    double nodal[2 * (BR_MODE_ELEMENTS + 1)] = {0};
    memcpy(nodal + 2, mode.phi, sizeof mode.phi);
    CLOSE(br_beam_mode_component(&mode, nodal), 1, 1e-13);
}

/* One period of one scheme: by the formula, and what is refused. */
TEST(test_one)
{
    struct br_error err = {0};
    struct br_vibration v = {
        .scheme = br_time_schemes[0], .kind = BR_BENDING, .density = 1, .per_period = 24};
    MUST(br_vibration_run(&v, &err));
    const double y = 2 * M_PI / 24;
    CLOSE(v.predicted, 1 - pow(1 + y * y, -24), 1e-14);
    CLOSE(v.measured, v.predicted, 1e-10);
    assert_true(br_vibration_is_right(&v));
    struct br_vibration wrong = v;
    wrong.measured *= 1 + 1e-6;
    assert_false(br_vibration_is_right(&wrong));
    wrong.measured = NAN;
    assert_false(br_vibration_is_right(&wrong));
    wrong = v;
    wrong.worst = NAN;
    assert_false(br_vibration_is_right(&wrong));
    v.scheme = br_time_scheme_find("bdf3");
    MUST(br_vibration_run(&v, &err));
    assert_int_equal(v.end, BR_VIBRATION_REFUSED);
    v.damping = 0.01; /* of the mode that would grow, too */
    MUST(br_vibration_run(&v, &err));
    assert_true(v.end == BR_VIBRATION_REFUSED && strstr(v.failure.message, "so little damping"));
    v.scheme = br_time_scheme_find("sdirk2");
    v.per_period = 96;
    MUST(br_vibration_run(&v, &err));
    assert_true(v.end == BR_VIBRATION_DONE && v.measured < 0 && br_vibration_is_right(&v));
}

/* Verdicts by hand, of the measurement at each place of a row whose others are right; and of the
 * same imbalance in a scene. Nobody predicts what steps by a tolerance take. */
TEST(test_verdicts_by_hand)
{
    static const struct {
        const char *scheme;
        enum br_vibration_end end;
        double measured, predicted, round_off, worst, limit;
        bool right, closes; /* the vibration; the scene */
    } rows[] = {
        {"euler", BR_VIBRATION_DONE, 0.25, 0.25, 0, 1e-12, 1e-11, true, true},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.5, 0.25, 0, 0, true, true},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.5, 0.2499, 0, 0, false, true},
        {"euler", BR_VIBRATION_DONE, 0.5, 0.25, 0.2499, 0, 0, false, true},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.25, 1, 1e-11, 1e-11, true, true},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.25, 1, 1.001e-11, 1e-11, false, false},
        {"euler", BR_VIBRATION_DONE, NAN, 0.25, 1, 0, 1, false, true},
        {"euler", BR_VIBRATION_DONE, INFINITY, 0.25, INFINITY, 0, 1, false, true},
        {"euler", BR_VIBRATION_DONE, 0.25, NAN, 1, 0, 1, false, true},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.25, NAN, 0, 1, false, true},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.25, 1, NAN, 1, false, false},
        {"euler", BR_VIBRATION_DONE, 0.25, 0.25, 1, 0, NAN, false, false},
        {"euler", BR_VIBRATION_REFUSED, NAN, NAN, NAN, NAN, NAN, true, true},
        {"euler", BR_VIBRATION_FAILED, 0.25, 0.25, 1, 0, 1, false, true},
        {"euler", BR_VIBRATION_FAILED, 0.25, 0.25, 1, 2, 1, false, false},
        {"adaptive", BR_VIBRATION_DONE, 0.25, NAN, 0, 0, 1, true, true},
        {"adaptive", BR_VIBRATION_DONE, NAN, NAN, 0, 0, 1, false, true},
        {"adaptive", BR_VIBRATION_DONE, 0.25, NAN, 0, 2, 1, false, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct br_vibration made = {.scheme = br_time_scheme_find(rows[i].scheme),
                                          .end = rows[i].end,
                                          .measured = rows[i].measured,
                                          .predicted = rows[i].predicted,
                                          .round_off = rows[i].round_off,
                                          .worst = rows[i].worst,
                                          .limit = rows[i].limit};
        const struct br_balance_row scene = {
            .end = made.end, .worst = made.worst, .limit = made.limit};
        const struct br_vibration sound = {.scheme = made.scheme};
        for (size_t place = 0; place < BR_VIBRATION_RATES * BR_VIBRATION_DENSITIES; place++) {
            struct br_vibration_row row;
            for (size_t j = 0; j < BR_VIBRATION_RATES * BR_VIBRATION_DENSITIES; j++)
                row.at[j / BR_VIBRATION_DENSITIES][j % BR_VIBRATION_DENSITIES] =
                    j == place ? made : sound;
            if (br_vibration_row_is_right(&row) != rows[i].right)
                fail_msg("row %zu, place %zu", i, place);
        }
        if (br_balance_row_is_right(&scene) != rows[i].closes)
            fail_msg("row %zu, as the balance of a scene", i);
    }
}

/* By every scheme, in every scene. The theory says how much each takes. */
TEST(test_all)
{
    struct br_error err = {0};
    struct br_energy_behaviour b;
    size_t done = 0;
    MUST(br_energy_behaviour_run(&b, &err));
    for (size_t i = 0; i < b.vibrations; i++) {
        done += b.vibration[i].at[0][0].end == BR_VIBRATION_DONE;
        if (!br_vibration_row_is_right(&b.vibration[i]))
            fail_msg("scheme %s does not take from a free vibration what its stability function "
                     "tells, or a step's balance does not close",
                     b.vibration[i].scheme->name);
    }
    for (size_t i = 0; i < b.balances; i++) {
        done += b.balance[i].end == BR_VIBRATION_DONE;
        if (!br_balance_row_is_right(&b.balance[i]))
            fail_msg("%s by scheme %s: what is missing in the energy balance of a step is %.3g of "
                     "the terms' sum, expected at most %.3g",
                     b.balance[i].scene->name, b.balance[i].scheme->name, b.balance[i].worst,
                     b.balance[i].limit);
    }
    assert_true(done > 100);
    br_energy_behaviour_clear(&b);
}
