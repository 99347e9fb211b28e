/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an energy meter finds of each step reaches the report, also where it is no number: this one
 * says what the test tells it to. */
#include "reference/energy/energy.h"

#include <math.h>

#include "study/run/run.h"
#include "support.h"

enum { STEPS = 6 };
static double imbalance[STEPS]; /* of each step */
static size_t step;

double __wrap_br_energy_meter_step(struct br_energy_meter *meter);
double __wrap_br_energy_meter_step(__attribute__((unused)) struct br_energy_meter *meter)
{
    return imbalance[step++];
}

TEST(test_worst)
{
    static const struct {
        double third, fourth;
        size_t bad;
    } rows[] = {{1e-15, 2e-15, 0}, {0.5, 0.25, 2}, {0.25, 0.5, 2}, {NAN, 1e-15, 1},
                {1e-15, NAN, 1},   {NAN, 0.5, 2},  {0.5, NAN, 2}};
    OWNED(br_scene) scene = br_test_bundled("example2");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_run_report report;
        const struct br_run_request request = {.scene = &scene,
                                               .method = br_test_method(NULL, NULL, NULL),
                                               .n = 4,
                                               .steps = STEPS,
                                               .check = true};
        step = 0;
        imbalance[2] = rows[i].third;
        imbalance[3] = rows[i].fourth;
        MUST(br_run(&request, &report, &err));
        assert_int_equal(step, STEPS);
        assert_int_equal(report.bad_steps, rows[i].bad);
        if (isnan(rows[i].third) || isnan(rows[i].fourth))
            assert_true(isnan(report.energy_worst));
        else
            CLOSE(report.energy_worst, fmax(rows[i].third, rows[i].fourth), 0);
    }
}
