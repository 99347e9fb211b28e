/* SPDX-License-Identifier: GPL-3.0-or-later */
/* References that share little: the exact solution (nothing of the solver) and a fine run (all of
 * it). On every bundled scene they must agree about the tip within their error bars. */
#include <math.h>

#include "exact_scenes.h"
#include "solver/scene.h"
#include "study/grid/sweep.h"
#include "support.h"

/* A scene and the steps of its fine run over 8: small enough that the run sees what happens in the
 * scene at all (Example 1 slips for 40 microseconds), large enough that the fine run's error
 * in time, which is its bar, covers that of its mesh (near_elastic). */
struct meeting {
    const char *scene;
    size_t steps;
};

static const struct meeting meetings[] = {
    {"example1", 400000},   {"example2", 200},       {"example3", 4000},    {"example4", 12000},
    {"impact", 8000},       {"reversal", 4000},      {"chatter", 8000},     {"vibration", 8000},
    {"release", 4000},      {"landing", 2000},       {"bouncing", 16000},   {"moving_load", 2000},
    {"near_elastic", 1000}, {"heavy_damping", 2000}, {"heavy_beam", 32000}, {"close_bound", 16000},
    {"initial_data", 4000},
};

/* What a reference says, and how far it may be off. */
struct verdict {
    double value, bar;
};

static void check_agreement(const struct meeting *m, const char *field, const char *references,
                            struct verdict a, struct verdict b)
{
    if (!(fabs(a.value - b.value) <= a.bar + b.bar))
        fail_msg("%s, %s: %s say %.15g +- %.1e and %.15g +- %.1e m", m->scene, field, references,
                 a.value, a.bar, b.value, b.bar);
}

/* A first-order run is about as far from the truth as from one with steps twice as large;
 * twice that is its bar. */
static void run_fine(const struct meeting *m, const struct br_scene *scene,
                     struct verdict verdict[2])
{
    const struct br_method method = br_method_default();
    double tip[2][2];
    for (size_t half = 0; half < 2; half++) {
        const size_t steps = m->steps << (3 + half);
        OWNED(br_march) *march = br_test_march(scene, 64, steps, &method);
        br_test_advance(march, steps);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            tip[half][kind] = br_march_tip_displacement(march, kind);
    }
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        verdict[kind] = (struct verdict){tip[1][kind], 2 * fabs(tip[1][kind] - tip[0][kind])};
}

static void solve_exactly(const struct br_scene *scene, struct verdict verdict[2])
{
    struct solved s = solve(scene, 1e-10);
    br_exact_at(s.exact, scene->duration, s.state);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        verdict[kind] = (struct verdict){s.state->tip[kind].displacement,
                                         br_exact_report(s.exact, kind).error.displacement};
    release(&s);
}

TEST(test_agreement)
{
    static const char *const names[] = {"axial", "bending"};
    for (size_t i = 0; i < sizeof meetings / sizeof *meetings; i++) {
        const struct meeting *m = &meetings[i];
        if (m->steps > 16000 && !br_test_long())
            continue; /* these two have four fifths of all steps */
        OWNED(br_scene) scene = br_test_bundled(m->scene);
        const bool modelled[2] = {scene.axial.modelled, scene.bending.modelled};
        struct verdict fine[2], exact[2];
        run_fine(m, &scene, fine);
        solve_exactly(&scene, exact);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
            if (!modelled[kind])
                continue;
            print_message("# %s %s: exact %.12g +- %.0e, fine +- %.0e\n", m->scene, names[kind],
                          exact[kind].value, exact[kind].bar, fine[kind].bar);
            check_agreement(m, names[kind], "exact and fine", exact[kind], fine[kind]);
            AT_MOST(fine[kind].bar, 0.01); /* bars that say nothing agree with everything */
        }
    }
}

/* ---- the third: a solution that was there first ---- */

enum { NORMS = BR_TEST_NORMS };

static void run_by(const struct br_reference *reference_kind, const struct br_scene *scene,
                   struct br_study s[NORMS])
{
    static const size_t n[] = {7, 12}, steps[] = {40, 100};
    s[0] = br_test_study(scene, reference_kind, 2, n, 2, steps);
    br_test_all_norms(s);
    MUST(br_study_run(s, 1, 2, NULL, &err));
}

/* The exact reference finds a manufactured solution again, from loads and tip forces alone:
 * by both, a cell has the same error in every norm. By default not of a contact that closes, which
 * takes the reference most of the time. */
TEST(test_manufactured)
{
    static const char *const scenes[] = {"mms_smooth", "mms_pressed", "mms_slip", "mms_closing"};
    const size_t all = sizeof scenes / sizeof *scenes;
    for (size_t i = 0; i < (br_test_long() ? all : all - 1); i++) {
        OWNED(br_scene) scene = br_test_bundled(scenes[i]);
        struct br_study by_exact[NORMS], by_mms[NORMS];
        run_by(&br_reference_exact, &scene, by_exact);
        run_by(&br_reference_mms, &scene, by_mms);
        for (size_t m = 0; m < NORMS; m++)
            for (size_t c = 0; c < 4; c++)
                for (enum br_part part = 0; part < BR_PARTS; part++) {
                    const double bar = br_norm_of_constant(
                        br_norms[m], &scene, by_exact[m].reference_report.own_error, part);
                    CLOSE(by_exact[m].cell[c].error[part], by_mms[m].cell[c].error[part],
                          bar + 1e-12);
                    AT_MOST(bar, 1e-7);
                }
        for (size_t m = 0; m < NORMS; m++) {
            br_study_clear(&by_exact[m]);
            br_study_clear(&by_mms[m]);
        }
    }
}
