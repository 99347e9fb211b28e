/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time schemes: the order that each row claims, what switches leave of it, that stiffness is
 * damped, and that an adaptive scheme keeps what its tolerance promises. Errors are those of the
 * same mesh, so that they are of time alone. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/textbook.h"
#include "solver/method.h"
#include "solver/scene.h"
#include "study/fit/fit.h"
#include "study/grid/study.h"
#include "study/grid/sweep.h"
#include "support.h"

enum { N = 6, SIZE = 2 * (N + 1) };

struct state {
    double value[2][SIZE]; /* by br_field_kind: displacement at the end, m */
};

static struct br_method method_of(const struct br_time_scheme *scheme, double tolerance)
{
    struct br_method method = br_test_method(NULL, "implicit", "exact");
    method.scheme = scheme;
    method.tolerance = tolerance;
    return method;
}

static void run(const struct br_scene *scene, const struct br_method *method, size_t steps,
                struct state *end)
{
    OWNED(br_march) *march = br_test_march(scene, N, steps, method);
    br_test_advance(march, steps);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        br_march_get(march, kind, end->value[kind], NULL);
}

/* In L2, by the mass of each element. */
static double distance(enum br_field_kind kind, const struct state *a, const struct state *b)
{
    const struct br_element *element = br_element_of(kind, 1);
    long double sum = 0;
    for (size_t e = 0; e < N; e++) {
        double difference[4];
        for (size_t i = 0; i < 2 * element->unknowns; i++)
            difference[i] = a->value[kind][e * element->unknowns + i] -
                            b->value[kind][e * element->unknowns + i];
        sum += br_element_product(element, BR_MASS, difference, difference);
    }
    return sqrt((double)sum / N);
}

static double size_of(enum br_field_kind kind, const struct state *a)
{
    static const struct state zero;
    return distance(kind, a, &zero);
}

/* ---- what a row claims ---- */

/* y' = rate y + sin t by the stages of a scheme, from y = 1 in `steps` steps to `end`. */
static double scalar(const struct br_time_scheme *scheme, double rate, double end, size_t steps)
{
    const double k = end / (double)steps;
    double y[BR_KNOWN] = {[BR_NOW] = 1};
    for (size_t n = 0; n < steps; n++) {
        struct br_stages s;
        br_time_scheme_step(scheme, n, &s);
        double last = 0;
        for (int i = 0; i < s.count; i++) {
            const struct br_stage *stage = &s.stage[i];
            const double tau = stage->gamma * k, t = ((double)n + stage->time) * k;
            y[BR_RATE] = tau * (rate * y[BR_NOW] + sin((double)n * k));
            double z = 0;
            for (int j = 0; j < BR_KNOWN; j++)
                z += stage->weight[j] != 0 ? stage->weight[j] * y[j] : 0;
            y[BR_STAGE + i] = last = (z + tau * sin(t)) / (1 - tau * rate);
        }
        y[BR_BEFORE_THAT] = y[BR_BEFORE];
        y[BR_BEFORE] = y[BR_NOW];
        y[BR_NOW] = last;
    }
    return y[BR_NOW];
}

/* The error of 2^i steps; y' = -y + sin t, y(0) = 1: y = (3 e^-t + sin t - cos t) / 2. */
static double scalar_error(const struct br_time_scheme *scheme, int i)
{
    const double end = 2, y = (3 * exp(-end) + sin(end) - cos(end)) / 2;
    return fabs(scalar(scheme, -1, end, (size_t)1 << i) - y);
}

TEST(scheme_orders)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++) {
        const double order = log2(scalar_error(*s, 6) / scalar_error(*s, 8)) / 2;
        if (!(fabs(order - (*s)->order) <= 0.15))
            fail_msg("%s: order %.2f was measured, its row has .order = %d", (*s)->name, order,
                     (*s)->order);
    }
}

/* The estimate of the error of one step of length k, of the same equation from t = 0, where the
 * states before are exact. */
static double scalar_estimate(const struct br_stages *s, double k)
{
    double y[BR_KNOWN] = {[BR_NOW] = 1}, sum = 0;
    y[BR_BEFORE] = (3 * exp(k) - sin(k) - cos(k)) / 2;
    y[BR_BEFORE_THAT] = (3 * exp(2 * k) - sin(2 * k) - cos(2 * k)) / 2;
    for (int i = 0; i < s->count; i++) {
        const double tau = s->stage[i].gamma * k;
        double z = 0;
        y[BR_RATE] = -tau;
        for (int j = 0; j < BR_KNOWN; j++)
            z += s->stage[i].weight[j] * y[j];
        y[BR_STAGE + i] = (z + tau * sin(s->stage[i].time * k)) / (1 + tau);
    }
    for (int j = 0; j < BR_KNOWN; j++)
        sum += s->error[j] * y[j];
    return fabs(sum);
}

/* Steps are chosen by the estimate's order, in the first step after a start, too. */
TEST(estimate_orders)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        for (size_t since = 0; since < 3; since++) {
            struct br_stages stages;
            br_time_scheme_step(*s, since, &stages);
            const double coarse = scalar_estimate(&stages, 1.0 / 32);
            const double fine = scalar_estimate(&stages, 1.0 / 128);
            const double order = (*s)->adaptive ? log2(coarse / fine) / 2 : 0;
            if (!(fabs(order - (*s)->estimate_order) <= 0.1))
                fail_msg("%s, step %zu: the estimate is of order %.2f, its row has "
                         ".estimate_order = %d",
                         (*s)->name, since + 1, order, (*s)->estimate_order);
        }
}

/* Ten steps, each a million times the relaxation time. The trapezoidal rule leaves all of it. */
TEST(test_stiffness_is_damped)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++) {
        const double left = fabs(scalar(*s, -1e6, 10, 10) - sin(10) * 1e-6);
        if (!(left <= 1e-7))
            fail_msg("%s: a stiff component keeps %g of its size in ten steps, expected 1e-7 at "
                     "most: it must be damped at infinity",
                     (*s)->name, left);
    }
}

/* ---- across switches ---- */

static const struct {
    const char *scene;
    enum br_field_kind kind;
    size_t steps; /* to begin with */
} switching[] = {{"example4", BR_BENDING, 300},
                 {"release", BR_BENDING, 300},
                 {"chatter", BR_AXIAL, 300},
                 {"impact", BR_AXIAL, 2000}};
enum { SWITCHING = sizeof switching / sizeof *switching };

/* A fixed step does not meet a switch: about one order is left, of the errors against switches that
 * are found. Of impacts the first errors say nothing, since waves are not resolved. */
static void check_across(const struct br_time_scheme *scheme, size_t which)
{
    OWNED(br_scene) scene = br_test_bundled(switching[which].scene);
    struct state best, end;
    double error[2];
    struct br_method method = method_of(br_time_scheme_find("adaptive"), 1e-12);
    run(&scene, &method, 10, &best);
    method = method_of(scheme, 0);
    for (int i = 0; i < 2; i++) {
        run(&scene, &method, switching[which].steps << (4 * i), &end);
        error[i] = distance(switching[which].kind, &end, &best);
    }
    const double order = log2(error[0] / error[1]) / 4;
    if (!(order >= 0.8))
        fail_msg("%s, %s: order %.2f, expected at least 0.8", scheme->name, switching[which].scene,
                 order);
}

TEST(test_orders_across_switches)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t s = 0; s < SWITCHING && !br_time_schemes[i]->adaptive; s++)
            check_across(br_time_schemes[i], s);
}

/* The adaptive schemes find the switches: the error follows the tolerance. */
TEST(test_adaptive_errors)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t s = 0; s < SWITCHING && br_time_schemes[i]->adaptive; s++) {
            OWNED(br_scene) scene = br_test_bundled(switching[s].scene);
            struct state best, end;
            struct br_method method = method_of(br_time_schemes[i], 1e-12);
            run(&scene, &method, 10, &best);
            for (double tolerance = 1e-4; tolerance >= 1e-9; tolerance *= 0.1) {
                method.tolerance = tolerance;
                run(&scene, &method, 10, &end);
                const double error =
                    distance(switching[s].kind, &end, &best) / size_of(switching[s].kind, &best);
                AT_MOST(error, 200 * tolerance);
            }
        }
}

/* ---- same bits ---- */

static void advance_field(struct br_march *march, enum br_field_kind kind, size_t count)
{
    for (size_t i = 0; i < count; i++)
        MUST(br_march_step_field(march, kind, &err));
}

/* The axial field ahead by up to four steps, in turns of different length. */
static void march_one_by_one(struct br_march *march, size_t steps)
{
    MUST(br_march_allow_lead(march, 4, &err));
    size_t axial = 0, bending = 0;
    for (size_t turn = 1; bending < steps; turn = turn % 4 + 1) {
        const size_t ahead = bending + turn < steps ? bending + turn : steps;
        advance_field(march, BR_AXIAL, ahead > axial ? ahead - axial : 0);
        axial = ahead > axial ? ahead : axial;
        const size_t follow = (axial - bending + 1) / 2;
        advance_field(march, BR_BENDING, follow);
        bending += follow;
    }
}

TEST(test_fields_one_by_one)
{
    enum { STEPS = 150 };
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (int solver = 0; solver < 2 && !br_time_schemes[i]->adaptive; solver++) {
            OWNED(br_scene) scene = br_test_bundled("chatter");
            struct br_method method = br_test_method(solver ? "plain" : NULL, "implicit", "exact");
            method.scheme = br_time_schemes[i];
            OWNED(br_march) *together = br_test_march(&scene, N, STEPS, &method);
            OWNED(br_march) *single = br_test_march(&scene, N, STEPS, &method);
            br_test_advance(together, STEPS);
            march_one_by_one(single, STEPS);
            for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
                double a[2][SIZE] = {{0}}, b[2][SIZE] = {{0}};
                br_march_get(together, kind, a[0], a[1]);
                br_march_get(single, kind, b[0], b[1]);
                assert_memory_equal(a, b, sizeof a);
            }
        }
}

/* A study's errors by any number of threads. */
static void study_by(const struct br_scene *scene, const struct br_method *method, int threads,
                     double error[4])
{
    static const size_t meshes[] = {4, 8}, steps[] = {50, 100};
    OWNED(br_study) s = br_test_study(scene, &br_reference_fine, 2, meshes, 2, steps);
    s.method = *method;
    s.reference = (struct br_resolution){16, 200};
    s.reference_method = *method;
    MUST(br_study_run(&s, 1, threads, NULL, &err));
    for (int i = 0; i < 4; i++)
        error[i] = s.cell[i].error[BR_PART_TOTAL];
}

TEST(test_threads)
{
    for (size_t i = 0; br_time_schemes[i]; i++) {
        OWNED(br_scene) scene = br_test_bundled("chatter");
        const struct br_method method = method_of(br_time_schemes[i], 1e-5);
        double one[4], some[4];
        study_by(&scene, &method, 1, one);
        for (int threads = 2; threads <= 4; threads++) {
            study_by(&scene, &method, threads, some);
            assert_memory_equal(one, some, sizeof one);
        }
        assert_true(one[0] > 0 && isfinite(one[3]));
    }
}
