/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference under loads that nobody sees by sampling: short blows, narrow patches, jumps,
 * moving fronts and pulses, at random places, in random lengths, durations, masses and stiffnesses.
 * An oracle that knows where its loads are judges the tip. An answer is right within what it
 * states, or it is refused. */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "reference/exact/exact.h"
#include "study/scene/file.h"
#include "support.h"
#include "tests/hard_loads.h"

static const long double pi = 3.14159265358979323846264338327950288L;

/* ---- the truth ---- */

struct truth {
    struct oracle_tip tip[HARD_TIMES];
    /* What the scene's own numbers leave open: that a narrow load moves by 4 units in the last
     * place of the length or of the duration; and round-off of the largest value. */
    long double round_off[2]; /* of displacement, m, and velocity, m/s */
};

static long double largest(const struct oracle_tip *tip, bool velocity)
{
    long double most = 0;
    for (size_t k = 0; k < HARD_TIMES; k++)
        most = fmaxl(most, fabsl(velocity ? tip[k].velocity : tip[k].displacement));
    return most;
}

static void find_truth(const struct hard_load *c, bool finer, struct truth *truth)
{
    struct oracle_problem problem = c->problem;
    problem.finer = finer;
    *truth = (struct truth){0};
    oracle_initial(&problem, HARD_TIMES, c->t, truth->tip);
    for (size_t i = 0; i < c->terms; i++) {
        struct oracle_tip tip[HARD_TIMES] = {0};
        oracle_term(&problem, &c->term[i], HARD_TIMES, c->t, tip);
        for (size_t k = 0; k < HARD_TIMES; k++) {
            truth->tip[k].displacement += tip[k].displacement;
            truth->tip[k].velocity += tip[k].velocity;
            truth->tip[k].displacement_error += tip[k].displacement_error;
            truth->tip[k].velocity_error += tip[k].velocity_error;
        }
        for (int v = 0; v < 2; v++)
            truth->round_off[v] +=
                largest(tip, v) * (1e-13L + 4 * 2.2e-16L / (long double)c->sharp[i]);
    }
    for (int v = 0; v < 2; v++)
        truth->round_off[v] += 1e-13L * largest(truth->tip, v);
}

/* ---- the oracle against closed forms ---- */

static void near(const char *what, long double value, long double truth, double allowed)
{
    if (!(fabsl(value - truth) <= allowed * fabsl(truth)))
        fail_msg("%s: %.18Lg, expected %.18Lg", what, value, truth);
}

static struct oracle_problem some_problem(struct br_test_random *random, bool bending)
{
    return (struct oracle_problem){.bending = bending,
                                   .length = br_test_log_uniform(random, 0.1, 10),
                                   .density = br_test_log_uniform(random, 0.1, 10),
                                   .stiffness = br_test_log_uniform(random, 0.1, 10),
                                   .viscosity = br_test_log_uniform(random, 0.1, 10)};
}

/* Long after the load was put on, the tip is where statics has it. */
static void test_oracle_statics(void **state)
{
    (void)state;
    struct br_test_random random = {1};
    for (int i = 0; i < 20; i++) {
        const bool bending = i % 2;
        const struct oracle_problem p = some_problem(&random, bending);
        const long double a = p.stiffness, l = p.length;
        const double slowest =
            p.viscosity / p.stiffness + p.density * pow(p.length, bending ? 4 : 2) / p.viscosity;
        const double t[] = {300 * slowest};
        const double from = br_test_uniform(&random, 0, 0.5) * p.length,
                     to = br_test_uniform(&random, 0.6, 1) * p.length;
        const struct oracle_step patch[] = {{from, 2}, {to, -2}};
        const struct oracle_factor one = oracle_one(), steps = {.step = patch, .steps = 2};
        struct oracle_term term[] = {
            {.place = ORACLE_SPREAD, .amplitude = 3, .space = one, .time = one},
            {.place = ORACLE_FORCE, .amplitude = 3, .time = one},
            {.place = ORACLE_MOMENT, .amplitude = 3, .time = one},
            {.place = ORACLE_SPREAD, .amplitude = 3, .space = steps, .time = one}};
        const long double high = to, low = from;
        const long double expected[2][4] = {
            {l * l / 2, l, 0, high * high - low * low},
            {l * l * l * l / 8, l * l * l / 3, l * l / 2,
             (l * (powl(high, 3) - powl(low, 3)) - (powl(high, 4) - powl(low, 4)) / 4) / 3}};
        for (int k = 0; k < 4; k++) {
            struct oracle_tip tip = {0};
            if (expected[bending][k] == 0)
                continue;
            oracle_term(&p, &term[k], 1, t, &tip);
            near("static tip", tip.displacement, 3 * expected[bending][k] / a, 1e-14);
            assert_true(fabsl(tip.velocity) <= 1e-14L * fabsl(tip.displacement) / t[0]);
        }
    }
}

/* One mode under a step, a wave and a short blow: a scalar oscillator. */
static void test_oracle_oscillator(void **state)
{
    (void)state;
    struct br_test_random random = {1};
    for (int i = 0; i < 30; i++) {
        struct oracle_problem p = some_problem(&random, false);
        const double l = p.length;
        const long double k = pi / 2 / l, lambda = k * k, rho = p.density;
        p.viscosity = p.stiffness * br_test_log_uniform(&random, 0.03, 0.9) /
                      sqrt(p.stiffness / p.density * (double)lambda);
        const double t[] = {br_test_uniform(&random, 0.1, 20) *
                            sqrt(p.density / p.stiffness / (double)lambda)};
        const long double half = p.viscosity * lambda / rho / 2, s = p.stiffness * lambda;
        const long double w = sqrtl(s / rho - half * half), decay = expl(-half * t[0]);
        const long double cosine = decay * cosl(w * t[0]), sine = decay * sinl(w * t[0]) / w;
        struct oracle_term term = {.place = ORACLE_SPREAD, .amplitude = 1, .time = oracle_one()};
        term.space = (struct oracle_factor){.kind = ORACLE_WAVE, .p = {(double)k}};
        struct oracle_tip tip;
        oracle_term(&p, &term, 1, t, &tip);
        near("a step", tip.displacement, (1 - cosine - half * sine) / s, 1e-13);
        near("its rate", tip.velocity, sine / rho, 1e-12);

        const double rate = br_test_uniform(&random, 0.2, 3) * (double)w;
        const long double complex forced =
            1 / (s - rho * rate * (long double)rate + 2 * half * rho * rate * 1.0iL);
        const long double at_0 = cimagl(forced), slope_0 = rate * creall(forced);
        term.time = (struct oracle_factor){.kind = ORACLE_WAVE, .p = {rate}};
        oracle_term(&p, &term, 1, t, &tip);
        const long double wave = cimagl(forced * cexpl(1.0iL * rate * t[0])) - at_0 * cosine -
                                 (slope_0 + half * at_0) * sine;
        assert_true(fabsl(tip.displacement - wave) <= 1e-13L * cabsl(forced));

        const double width = 1e-9 * t[0];
        term.time = (struct oracle_factor){.kind = ORACLE_GAUSS, .p = {t[0] / 1e6, width}};
        oracle_term(&p, &term, 1, t, &tip);
        const long double since = t[0] - t[0] / 1e6L;
        assert_true(fabsl(tip.displacement -
                          width * sqrtl(pi) * expl(-half * since) * sinl(w * since) / w / rho) <=
                    1e-10L * width / w / rho);
    }
}

/* A front on a rod without mass: one equation of first order. */
static void test_oracle_front(void **state)
{
    (void)state;
    struct br_test_random random = {1};
    const struct oracle_step front[] = {{-INFINITY, 1}, {0, -1}};
    for (int i = 0; i < 5; i++) {
        struct oracle_problem p = some_problem(&random, false);
        p.density *= 1e-14;
        const double speed = br_test_uniform(&random, 0.5, 2);
        const long double a = p.stiffness, v = p.viscosity, l = p.length, end = l / speed;
        const double t[] = {0.7 * (double)end, 1.4 * (double)end};
        const struct oracle_term term = {.place = ORACLE_SPREAD,
                                         .amplitude = 1,
                                         .space = {.step = front, .steps = 2},
                                         .time = oracle_one(),
                                         .moving = true,
                                         .speed = speed};
        struct oracle_tip tip[2];
        oracle_term(&p, &term, 2, t, tip);
        long double inside[2];
        for (int k = 0; k < 2; k++) {
            const long double s = k == 0 ? t[0] : end;
            inside[k] =
                speed * (long double)speed / 2 *
                (s * s / a - 2 * v * s / (a * a) - 2 * v * v / (a * a * a) * expm1l(-a * s / v));
        }
        const long double left = expl(-a * (t[1] - end) / v);
        near("inside", tip[0].displacement, inside[0], 1e-10);
        near("it has left", tip[1].displacement, inside[1] * left + l * l / 2 / a * (1 - left),
             1e-10);
    }
}

/* The trials' own truth, at two resolutions: what the coarse one states is what they differ by. */
static void test_oracle_resolutions(void **state)
{
    (void)state;
    static struct hard_load c;
    static struct truth coarse, fine;
    for (size_t i = 0; i < (br_test_long() ? 200 : 9); i++) {
        hard_load_draw(&c, i);
        find_truth(&c, false, &coarse);
        find_truth(&c, true, &fine);
        for (size_t k = 0; k < HARD_TIMES; k++) {
            const struct oracle_tip *tip = &coarse.tip[k];
            const long double most[] = {largest(fine.tip, false), largest(fine.tip, true)};
            const long double off[] = {fabsl(tip->displacement - fine.tip[k].displacement),
                                       fabsl(tip->velocity - fine.tip[k].velocity)};
            if (!(off[0] <=
                      tip->displacement_error + 1e-14L * most[0] + 0.1L * coarse.round_off[0] &&
                  off[1] <= tip->velocity_error + 1e-12L * most[1] + 0.1L * coarse.round_off[1] &&
                  tip->displacement_error <= 1e-11L * most[0]))
                fail_msg("case %zu, t = %g T: %Lg +- %Lg, finer %Lg of the largest", c.number,
                         c.t[k] / c.duration, tip->displacement / most[0],
                         tip->displacement_error / most[0], off[0] / most[0]);
        }
    }
}

/* ---- the judge ---- */

enum outcome { RIGHT, REFUSED, WRONG, OUTCOMES };

/* An estimate is the distance of two solutions; a good one may be that much too small. */
static const double estimate_factor = 3;

/* Processor time, s. What takes longer counts as wrong; of the kinds that may be refused, of which
 * the usual test takes only what is quick, as refused. */
struct patience {
    clock_t start;
    double seconds;
};
static const double usual_patience = 60, short_patience = 1;

static bool may_be_refused(const struct hard_load *c)
{
    return hard_kinds[c->kind].refused_at_most >= 1;
}

static bool out_of_patience(void *self)
{
    const struct patience *p = self;
    return (double)(clock() - p->start) > p->seconds * (double)CLOCKS_PER_SEC;
}

/* Whether the estimate of the velocity leaves this time out: within a blow of less than 1e-6 T,
 * or 1e-6 T after a jump. */
static bool is_layer(const struct hard_load *c, double t)
{
    const double close = 1e-6 * c->duration;
    for (size_t i = 0; i < c->terms; i++) {
        const struct oracle_factor *f = &c->term[i].time;
        for (size_t j = 0; j < f->steps; j++)
            if (t - (double)f->step[j].at >= 0 && t - (double)f->step[j].at <= close)
                return true;
        if ((f->kind == ORACLE_GAUSS || f->kind == ORACLE_HAT) && f->p[1] < close &&
            fabs(t - f->p[0]) <= 8 * close)
            return true;
    }
    return false;
}

static void tell(const struct hard_load *c, const char *what)
{
    print_message("# case %zu, %s: %s\n", c->number, hard_kinds[c->kind].text, what);
}

/* One value against the truth: NaN is wrong. */
static bool is_right(const struct hard_load *c, double t, const char *what, const double value[3],
                     const long double truth[2])
{
    const long double allowed = estimate_factor * value[1] + value[2] + truth[1];
    const long double off = fabsl(value[0] - truth[0]);
    if (off <= allowed)
        return true;
    char text[300];
    snprintf(text, sizeof text,
             "WRONG: %s at t = %.9g T is %.12g, truth %.12Lg: off by %.2Lg of it; stated %.2g, "
             "round-off %.2g, oracle %.2Lg of it",
             what, t / c->duration, value[0], truth[0], off / fabsl(truth[0]),
             value[1] / (double)fabsl(truth[0]), value[2] / (double)fabsl(truth[0]),
             truth[1] / fabsl(truth[0]));
    tell(c, text);
    return false;
}

static enum outcome compare(const struct hard_load *c, const struct br_exact *exact,
                            const struct truth *truth)
{
    struct br_error err = {0};
    struct br_exact_state *state;
    const enum br_exact_field field = c->problem.bending ? BR_EXACT_BENDING : BR_EXACT_AXIAL;
    const struct br_exact_size error = br_exact_report(exact, field).error;
    bool right = true;
    MUST(br_exact_state_create(&state, exact, &err));
    for (size_t k = 0; k < HARD_TIMES && right; k++) {
        const struct oracle_tip *tip = &truth->tip[k];
        br_exact_at(exact, c->t[k], state);
        right = is_right(c, c->t[k], "displacement",
                         (double[]){state->tip[field].displacement, error.displacement,
                                    (double)truth->round_off[0]},
                         (long double[]){tip->displacement, tip->displacement_error});
        if (right && !is_layer(c, c->t[k]))
            right = is_right(
                c, c->t[k], "velocity",
                (double[]){state->tip[field].velocity, error.velocity, (double)truth->round_off[1]},
                (long double[]){tip->velocity, tip->velocity_error});
    }
    br_exact_state_free(state);
    return right ? RIGHT : WRONG;
}

static enum outcome refused(const struct hard_load *c, const struct br_error *err)
{
    const bool late = err->status == BR_INTERRUPTED && may_be_refused(c) && !br_test_long();
    const bool reason =
        late || ((err->status == BR_BAD_INPUT || err->status == BR_NOT_FINITE) && *err->message);
    char text[400];
    snprintf(text, sizeof text, "%s: %.300s", reason ? "refused" : "WRONG", err->message);
    tell(c, text);
    return reason ? REFUSED : WRONG;
}

static enum outcome try(const struct hard_load *c)
{
    struct br_error err = {0};
    struct br_scene scene = {0};
    struct br_exact *exact = NULL;
    struct patience patience = {clock(), may_be_refused(c) && !br_test_long() ? short_patience
                                                                              : usual_patience};
    const struct br_exact_options options = {/* as study does */
                                             .acceptable = 1e-5,
                                             .stop = out_of_patience,
                                             .stop_self = &patience};
    enum br_status status = br_scene_read_text("blows", c->text, &scene, &err);
    if (!status)
        status = br_exact_create(&exact, &scene, &options, &err);
    enum outcome outcome = status ? refused(c, &err) : RIGHT;
    if (!status) {
        struct truth truth;
        find_truth(c, false, &truth);
        outcome = compare(c, exact, &truth);
    }
    if (outcome == WRONG && getenv("BR_TEST_SHOW"))
        print_message("%s\n", c->text);
    br_exact_free(exact);
    br_scene_clear(&scene);
    return outcome;
}

static void test_hard_loads(void **state)
{
    (void)state;
    static struct hard_load c;
    size_t count[HARD_KINDS][OUTCOMES] = {0}, wrong = 0, refusals = 0;
    const size_t cases = br_test_long() ? 2000 : 60;
    for (size_t i = 0; i < cases; i++) {
        hard_load_draw(&c, i);
        count[c.kind][try(&c)]++;
    }
    for (size_t k = 0; k < HARD_KINDS; k++) {
        const size_t all = count[k][RIGHT] + count[k][REFUSED] + count[k][WRONG];
        print_message("# %-20s %4zu right %4zu refused %4zu silently wrong\n", hard_kinds[k].text,
                      count[k][RIGHT], count[k][REFUSED], count[k][WRONG]);
        wrong += count[k][WRONG];
        refusals += (double)count[k][REFUSED] > ceil(hard_kinds[k].refused_at_most * (double)all);
    }
    assert_int_equal(wrong, 0);
    assert_int_equal(refusals, 0); /* kinds of which too many are refused */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_oracle_statics), cmocka_unit_test(test_oracle_oscillator),
        cmocka_unit_test(test_oracle_front),   cmocka_unit_test(test_oracle_resolutions),
        cmocka_unit_test(test_hard_loads),
    };
    return br_test_quick() ? 0 : cmocka_run_group_tests(tests, NULL, NULL);
}
