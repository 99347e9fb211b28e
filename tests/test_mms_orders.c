/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders of the scheme, against solutions that are known exactly: 2 in h for axial, 4
 * for bending, 1 in k, through contacts that open and close, stick, slip and its reversal.
 * Switching lowers none of them: a law that switches is monotone and Lipschitz in what the
 * scheme approximates, or (friction) its error works against the velocity's error. */
#include <math.h>

#include "study/grid/sweep.h"
#include "support.h"

static const char *const scenes[] = {"mms_smooth", "mms_closing",  "mms_opening",
                                     "mms_slip",   "mms_reversal", "mms_stick"};

/* Largest errors of a row or a column of cells; out: count * BR_PARTS. */
static void measure(const char *name, const char *contact, const struct br_judge *judge,
                    size_t n_count, const size_t *n, size_t k_count, const size_t *steps,
                    double *error)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled(name);
    struct br_study s = br_test_study(&scene, judge, n_count, n, k_count, steps);
    s.method = br_test_method(NULL, contact, NULL);
    s.reference_method = br_test_method(NULL, contact, NULL);
    s.reference = (struct br_resolution){768, steps[0]};
    MUST(br_study_run(&s, 1, 2, NULL, &err));
    for (size_t c = 0; c < n_count * k_count; c++)
        for (int p = 0; p < BR_PARTS; p++)
            error[c * BR_PARTS + (size_t)p] = s.cell[c].error[p];
    br_study_clear(&s);
    br_scene_clear(&scene);
}

/* The slope between two cells; a part that is not modelled has none. */
static void check_order(const char *name, const double *error, size_t coarse, size_t fine,
                        enum br_part part, double ratio, double expected)
{
    const double a = error[coarse * BR_PARTS + part], b = error[fine * BR_PARTS + part];
    if (a == 0 && b == 0)
        return;
    const double order = log(a / b) / log(ratio);
    print_message("# %-12s %-7s %.3e to %.3e: order %.3f\n", name, br_part_names[part], a, b,
                  order);
    CLOSE(order, expected, 0.1);
}

/* The time error is 1e-6 to 2e-6 at these steps; bending is looked at before it matters. */
TEST(test_space)
{
    static const size_t n[] = {8, 16, 32}, steps = 16000;
    if (br_test_quick())
        skip();
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        double error[3 * BR_PARTS];
        measure(scenes[i], "implicit", &br_judge_mms, 3, n, 1, &steps, error);
        check_order(scenes[i], error, 1, 2, BR_PART_AXIAL, 2, 2);
        check_order(scenes[i], error, 0, 1, BR_PART_BENDING, 2, 4);
    }
}

/* The meshes are so fine that they do not matter. Over a factor of 8: a maximum over time
 * levels halves but unevenly where a contact opens between two of them. By default every other
 * scene; with the lagged rule `check` has an interval of the order of each. */
TEST(test_time_implicit)
{
    static const size_t n = 3200, steps[] = {250, 2000};
    if (br_test_quick())
        skip();
    for (size_t i = br_test_long() ? 0 : 1; i < sizeof scenes / sizeof *scenes;
         i += br_test_long() ? 1 : 2) {
        double error[2 * BR_PARTS];
        measure(scenes[i], "implicit", &br_judge_mms, 1, &n, 2, steps, error);
        check_order(scenes[i], error, 0, 1, BR_PART_AXIAL, 8, 1);
        check_order(scenes[i], error, 0, 1, BR_PART_BENDING, 8, 1);
    }
}

/* Coulomb's bound takes the axial tip value, which is right to O(h^2) only: on fine meshes
 * the bending's order falls to 2. Seen against a run with the same steps, so that there is
 * no time error at all; with Tresca's bound it stays 4. */
TEST(test_coulomb_limit)
{
    static const size_t n[] = {96, 128}, steps = 1000;
    double error[2 * BR_PARTS];
    if (br_test_quick())
        skip();
    measure("mms_opening", "implicit", &br_judge_fine, 2, n, 1, &steps, error);
    check_order("mms_opening", error, 0, 1, BR_PART_BENDING, 4.0 / 3, 2);
    measure("mms_stick", "implicit", &br_judge_fine, 2, n, 1, &steps, error);
    check_order("mms_stick", error, 0, 1, BR_PART_BENDING, 4.0 / 3, 4);
}
