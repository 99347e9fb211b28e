/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is proved of functions: that they are finite, where they break, how they are meshed. */
#include "solver/proof.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/file.h"
#include "support.h"

static const struct br_box unit = {{0, 1}, {0, 1}};

/* ---- finite ---- */

static const struct {
    const char *text;
    double at;
} poles[] = {
    {"1/(x - 0.3333)", 0.3333},
    {"-1/(x - 0.3333)^2", 0.3333},
    {"1e-9/(x - 0.3333)", 0.3333},
    {"10 + 1/abs(x - 0.777)", 0.777},
    {"1/sqrt(abs(x - 0.123456))", 0.123456},
    {"abs(x - 0.123456)^-0.01", 0.123456},
    {"(x > 0.3333)/(x - 0.3333)", 0.3333},
    {"x > 0.3333 ? 1/(x - 0.3333) : 0", 0.3333},
    {"x > 0.3333 ? (x - 0.3333)^-0.5 : 0", 0.3333},
    {"x == 0.3333 ? 0 : 1/(x - 0.3333)", 0.3333},
    {"tan(pi*x)", 0.5},
    {"tan(pi*x)^2", 0.5},
    {"1/sin(2*pi*(x - 0.1))", 0.1},
    {"x + 1/sin(pi*x - 1)", 0.31830988618379067},
    {"cos(7*x)/sin(3*x - 1)", 1.0 / 3},
    {"1/(exp(x) - 2)", 0.6931471805599453},
    {"1/log(x + 0.6)^2", 0.4},
    {"log(abs(x - 0.25))", 0.25},
    {"4e6*(x - 0.3333) + 1/(x - 0.3333)", 0.3333},
    {"1/(x - 1e-5)", 1e-5},
    {"1/(x - 0.99999)", 0.99999},
    {"1/(x - 1e-5)^2", 1e-5},
    {"1/(x - 0.99999)^2", 0.99999},
    {"1/x", 0},
    {"1/(1 - x)", 1},
    {"1e-200/(x*x - 0.5)", 0.7071067811865476}, /* of no weight, but a pole */
    {"1/(3*x^2 - 1)", 0.5773502691896258},      /* between numbers */
    {"sqrt(x - 0.5)", 0.25},
    {"log(x)", 0},
    {"asin(1.5*x)", 0.83},
    {"acosh(x + 0.5)", 0.25},
    {"atanh(x)", 1},
    {"sin(x)/x", 0}, /* its limit is not filled in */
    {"x*log(x)", 0},
    {"exp(1000*x)", 1},
    {"x < 0.5 ? 1 : 1/0.0", 0.75},
    {"cosh(711*x)", 1},
};

TEST(test_poles)
{
    for (size_t i = 0; i < sizeof poles / sizeof *poles; i++) {
        OWNED(br_function) f = br_test_function(poles[i].text);
        struct br_interval value;
        struct br_box where;
        if (br_prove_bounded(&f, unit, &value, &where) == BR_FINITE)
            fail_msg("%s: within %g .. %g", poles[i].text, value.low, value.high);
        const double tolerance = strpbrk(poles[i].text, "s<") ? 0.26 : 1e-12;
        CLOSE(where.x.low, poles[i].at, tolerance);
        AT_MOST(where.x.high - where.x.low, 1e-15);
    }
}

static const struct {
    const char *text;
    double low, high; /* of its values */
} sound[] = {
    {"0*x", 0, 0},
    {"sqrt(x)", 0, 1},
    {"x^1.5", 0, 1},
    {"log(1 + x)", 0, 0.6931471805599453},
    {"1/(0.001 + x)", 1 / 1.001, 1000},
    {"exp(100*x)", 1, 2.6881171418161356e43},
    {"tanh(1e4*(x - 0.3333))", -1, 1},
    {"tanh(1e12*(x - 0.3333))", -1, 1},
    {"1/(1e-6 + (x - 0.3333)^2)", 2.24977, 1e6},
    {"1/(1e-18 + (x - 0.3333)^2)", 2.24978, 1e18},
    {"(x - 0.3333)/(1e-12 + (x - 0.3333)^2)", -5e5, 5e5},
    {"(x > 0.3333 ? 1 : -1)/(1e-6 + abs(x - 0.3333))", -1e6, 1e6},
    {"x < 0.3333 ? -1 : 1", -1, 1},
    {"(x > 0.33 && x < 0.3301)*1e12", 0, 1e12},
    {"1e9*(x == 0.5)", 0, 1e9},
    {"sin(1000*x)", -1, 1},
    {"sin(1/(x + 1e-3))", -1, 1},
    {"sin(1e6*x)^9", -1, 1},
    {"sqrt(abs(x - 0.3333))", 0, 0.81651},
    {"sqrt(x*(1 - x))", 0, 0.5},
    {"sqrt(1 - x^2)", 0, 1},
    {"1/(1.0001 - x)", 0.99992, 9999},
    {"exp(-1e8*(x - 0.3333)^2)", 0, 1},
    {"1/(1 + exp(-1e4*(x - 0.5)))", 0, 1}, /* through an overflow */
    {"1e300*(x - 0.3333)", -3.333e299, 6.667e299},
    {"cos(40*x)*exp(50*x)", -3.45787e21, 5e20},
    {"x == 0 ? 1 : sin(x)/x", 0.84, 1},
    {"(x == 0 ? 1 : sin(x)/x)*cos(t)", 0.45, 1},
    {"x <= 0.3 ? 2 : (x - 0.3)/tan(x - 0.3)", 0.8, 2},
    {"x == 0 ? 0 : x*log(x)", -0.368, 0},
    {"x < 0.5 ? 1 : 1/x", 1, 2},
    {"sqrt(max(0, x - t))", 0, 1},
    {"1/((x - t)^2 + 1e-4)", 0.99991, 9999},
    {"1/(x^2 - 2*x*t + t^2 + 1e-4)", 0.99991, 9999},
    {"x^t", 0, 1},
    {"exp(-((t - 0.1)/1e-150)^2)", 0, 1},
};

/* ... and bounds of the values hold, and are as tight as is said. */
TEST(test_finite)
{
    for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) {
        OWNED(br_function) f = br_test_function(sound[i].text);
        const double low = sound[i].low, high = sound[i].high, room = 0.06 * (high - low);
        struct br_interval value, tight;
        struct br_box where, peak;
        if (br_prove_bounded(&f, unit, &value, &where) != BR_FINITE)
            fail_msg("%s: at x = %.17g, t = %.17g", sound[i].text, where.x.low, where.t.low);
        const bool loose = strstr(sound[i].text, "== 0 ?") || strstr(sound[i].text, "<= 0.3") ||
                           strstr(sound[i].text, "2*x*t"); /* the boxes do not suffice */
        assert_true(br_enclose_values(&f, unit, &tight, &peak));
        if (!loose && !(tight.low >= low - room && tight.high <= high + room))
            fail_msg("%s: %g .. %g", sound[i].text, tight.low, tight.high);
        if (!(tight.low <= low && tight.high >= high && value.low <= low && value.high >= high))
            fail_msg("%s: %.17g .. %.17g", sound[i].text, tight.low, tight.high);
    }
}

/* What nobody bounds, and what the allowed boxes do not reach. */
TEST(test_unbounded)
{
    struct br_function f = br_test_function("1/(x^2 - 2*x*t + t^2 + 1e-9)");
    struct br_interval value;
    struct br_box where;
    assert_int_equal(br_prove_bounded(&f, unit, &value, &where), BR_UNBOUNDED);
    br_function_free(&f);
    static const struct br_function_ops none = {0};
    const struct br_function unknown = {.ops = &none, .uses_x = true};
    assert_false(br_function_bound(&unknown, unit, &value));
    f = br_test_function("sqrt(t*t - 2*t + 1)");
    assert_int_not_equal(br_prove_bounded(&f, unit, &value, &where), BR_FINITE);
    br_function_free(&f);
    f = br_test_function("tan(pi*t)");
    REFUSED(br_must_be_finite(&f, unit, &err), BR_BAD_INPUT, "a pole at t = 0.5 s");
    br_function_free(&f);
}

/* A rod of 1 m with that load in line 8. */
static enum br_status read_load(const char *load, struct br_scene *scene, struct br_error *why)
{
    char text[1024];
    snprintf(text, sizeof text,
             "title: t\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n"
             "  stiffness: 1 N\n  viscosity: 1 N s\n  load: %s\n",
             load);
    return br_scene_read(br_test_scene_file(text), scene, why);
}

/* A scene with one is refused, with the place. */
TEST(test_scene)
{
    static const struct {
        const char *load, *message;
    } rows[] = {
        {"tan(pi*t) [N/m]", "it has a pole at t = 0.5 s"},
        {"1/(t - 0.3333) [N/m]", "at t = 0.3333 s, expected a finite number everywhere in [0, T]"},
        {"1/(x - 0.3333) [N/m]", "at x = 0.3333 m, expected a finite number everywhere in [0, L]"},
        {"1e-9/(x*x - 0.5) [N/m]", "has a pole at x = 0.7071067812 m, expected a finite number"},
        {"1/(x - t + 0.1001) [N/m]", " m, t = "},
        {"1e-3/(t - 0.3333)^0.1*(t > 0.3333) [N/m]", "load: found "},
        {"\"(t == 0.5 ? 1e6 : 1) [N/m]\"", "found 1e+06 at t = 0.5 s alone, and 1 beside it"},
        {"\"(t >= 0.5 && t <= 0.5 ? 1e6 : 1) [N/m]\"", "found 1e+06 at t = 0.5 s alone"},
        {"step(x - 0.25) + step(0.25 - x) [N/m]", "found 2 at x = 0.25 m alone, and 1 beside"},
        {"{shape: \"1/(x - 0.3333)^2 [1]\", history: \"t [N/m]\"}", "at x = 0.3333 m"},
        {"sin(x)/x [N/m]",
         "found nan at x = 0 m alone; if it has a limit there, write it as in x == 0 ? 1"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_scene) scene;
        REFUSED(read_load(rows[i].load, &scene, &err), BR_BAD_INPUT, rows[i].message);
        assert_non_null(strstr(err.message, ".yaml:8"));
    }
}

/* Where a load bends at zero, its values there are the round-off of its argument, which may double
 * from one number to the next: that is no value alone. */
TEST(test_bend_at_zero)
{
    static const char *const bent[] = {"abs(x/%.9f - 0.25717)", "max(0, %.9f*t - 0.31)",
                                       "min(0, x/%.9f - 0.61)*sin(x)", "1e9*abs(t*%.9f - 0.2)^2"};
    struct br_test_random random = {3};
    for (size_t i = 0; i < 100; i++) {
        OWNED(br_scene) scene = {0};
        char formula[100], load[120];
        /* NOLINTNEXTLINE: the formats are those above */
        snprintf(formula, sizeof formula, bent[i % 4], br_test_uniform(&random, 0.8, 1.6));
        snprintf(load, sizeof load, "%s [N/m]", formula);
        MUST(read_load(load, &scene, &err));
    }
}

/* ---- breaks ---- */

static const struct {
    const char *text;
    size_t count;
    double at[5];
} broken[] = {
    {"exp(t)", 0, {0}},
    {"step(t - 0.3)", 1, {0.3}},
    {"step(t)*step(1 - t)", 0, {0}}, /* at the ends */
    {"abs((t - 0.3)^3)", 1, {0.3}},  /* touched */
    {"abs((t - 0.3)^2)", 1, {0.3}},
    {"min(t, 1 - t)", 1, {0.5}},
    {"max(0, t - 0.5) > 0", 1, {0.5}}, /* zero over a stretch */
    {"t < 0.2 ? 1 : t < 0.4 ? 2 : t > 0.7 ? 3 : 4", 3, {0.2, 0.4, 0.7}},
    {"t*t < 0.25 && t > 0.1", 2, {0.1, 0.5}},
    {"!(t - 0.25) ? 7 : 2", 1, {0.25}},
    {"t == 0.75", 1, {0.75}},
    {"sign(exp(t) - 1.5)", 1, {0.4054651081081644}},
    {"min(t, 0.3, 2*t - 0.1, 1 - t)", 3, {0.1, 0.3, 0.7}},
    {"step(sin(1/(t + 0.05)))", 6, {0.0000, 0}},
    {"step(abs(t - 0.5) - 0.25)", 3, {0.25, 0.5, 0.75}},
    {"(t > 0.5)*x", 1, {0.5}},
    {"step(t^3 - t^2 + t - 0.2)", 1, {0.24546216933726323}}, /* none where only bounds reach 0 */
};

TEST(test_breaks)
{
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        OWNED(br_function) f = br_test_function(broken[i].text);
        struct br_breaks b = {0};
        MUST(br_breaks_add(&f, BR_T, unit, &b, &err));
        if (b.count != broken[i].count)
            fail_msg("%s: %zu breaks", broken[i].text, b.count);
        for (size_t k = 0; k < b.count && broken[i].at[0] > 0; k++) {
            CLOSE(b.at[k].low, broken[i].at[k], 4e-15);
            AT_MOST(b.at[k].high - b.at[k].low, 4e-15);
        }
        br_breaks_free(&b);
    }
}

/* A thousand, each the nearest number or beside it; too many are refused. */
TEST(test_many_breaks)
{
    struct br_function f = br_test_function("step(sin(1000*pi*t))");
    struct br_breaks b = {0};
    MUST(br_breaks_add(&f, BR_T, unit, &b, &err));
    assert_int_equal(b.count, 999);
    for (size_t k = 0; k < b.count; k++) {
        CLOSE(b.at[k].low, (double)(k + 1) / 1000, 4e-16);
        AT_MOST(b.at[k].high - b.at[k].low, 2e-15);
    }
    br_breaks_free(&b);
    br_function_free(&f);
    f = br_test_function("step(sin(1e9*t))");
    REFUSED(br_breaks_add(&f, BR_T, unit, &b, &err), BR_BAD_INPUT, "too often");
    br_breaks_free(&b);
    br_function_free(&f);
}

TEST(test_fronts)
{
    static const struct {
        const char *text;
        size_t count;
        double at[2];
    } rows[] = {
        {"x < 2*t - 0.5", 2, {0.25, 0.75}},
        {"step(x - t^2 + 0.25)", 1, {0.5, 0}},
        {"step((x - 0.5)^2 + (t - 0.5)^2 - 0.04)", 0, {0, 0}}, /* born inside */
        {"x < 2 + t ? 1 : 0", 0, {0, 0}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_function) f = br_test_function(rows[i].text);
        struct br_breaks b = {0};
        MUST(br_breaks_add(&f, BR_T, unit, &b, &err));
        assert_int_equal(b.count, 0);
        assert_int_equal(b.moving, i != 3);
        MUST(br_front_times(&f, unit, &b, &err));
        assert_int_equal(b.count, rows[i].count);
        for (size_t k = 0; k < b.count; k++)
            CLOSE(b.at[k].low, rows[i].at[k], 1e-15);
        br_breaks_free(&b);
    }
}

/* ---- meshes ---- */

enum { DEGREE = 8 };

/* The interpolant at Chebyshev's nodes of a cell, by the barycentric formula. */
static double interpolate(const double *node, const double *value, double t)
{
    double above = 0, below = 0;
    for (int i = 0; i <= DEGREE; i++) {
        const double weight = (i % 2 ? -1 : 1) * sin((2 * i + 1) * M_PI / (2 * DEGREE + 2));
        if (t == node[i])
            return value[i];
        above += weight / (t - node[i]) * value[i];
        below += weight / (t - node[i]);
    }
    return above / below;
}

static double at_time(const struct br_function *f, double t)
{
    const double x = 0.5;
    double value;
    br_function_evaluate(f, 1, &x, t, &value);
    return value;
}

/* The largest |f - interpolant| at many places inside of a cell. */
static double worst_in(const struct br_function *f, double from, double to)
{
    enum { PLACES = 60 };
    double node[DEGREE + 1], value[DEGREE + 1], worst = 0;
    for (int i = 0; i <= DEGREE; i++) {
        node[i] = (from + to) / 2 + (to - from) / 2 * cos((2 * i + 1) * M_PI / (2 * DEGREE + 2));
        value[i] = at_time(f, node[i]);
    }
    for (int i = 1; i < PLACES; i++) {
        const double t = from + (to - from) * i / PLACES;
        worst = fmax(worst, fabs(at_time(f, t) - interpolate(node, value, t)));
    }
    return worst;
}

/* The mesh of a function of t: covers [0, 1], and its smooth cells are within the tolerance. */
static size_t check_mesh(const char *text, double tolerance)
{
    OWNED(br_function) f = br_test_function(text);
    const struct br_mesh_aim aim = {.degree = DEGREE, .tolerance = tolerance};
    struct br_mesh m;
    MUST(br_resolve(&f, BR_T, unit, &aim, &m, &err));
    assert_true(m.at[0] == 0 && m.at[m.count] == 1);
    double missed = 0;
    for (size_t i = 0; i < m.count; i++) {
        assert_true(m.at[i] < m.at[i + 1]);
        const double worst = m.rough[i] ? 0 : worst_in(&f, m.at[i], m.at[i + 1]);
        if (!(worst <= tolerance * 1.01))
            fail_msg("%s: %g in [%.17g, %.17g]", text, worst, m.at[i], m.at[i + 1]);
        missed += m.rough[i] ? m.at[i + 1] - m.at[i] : 0;
    }
    AT_MOST(missed, 1e-2 + tolerance); /* rough ones are few and narrow */
    const size_t count = m.count;
    br_mesh_free(&m);
    return count;
}

TEST(test_meshes)
{
    AT_MOST((double)check_mesh("exp(t) - 1", 1e-9), 2);
    AT_MOST((double)check_mesh("step(t - 0.3)", 1e-9), 2);
    AT_MOST((double)check_mesh("sqrt(t)", 1e-9), 60);
    AT_MOST((double)check_mesh("abs(sin(50*t))", 1e-8), 150);
    AT_MOST((double)check_mesh("tanh((t - 0.3)/1e-6)", 1e-8), 80);
    AT_MOST((double)check_mesh("1/(1 + exp(-1e4*(t - 0.5)))", 1e-8), 120);
    AT_MOST((double)check_mesh("t < 0.4 ? t^2 : cos(9*t) + min(t, 0.7)", 1e-8), 20);
    AT_MOST((double)check_mesh("100*t + 1e4*exp(-((t - 0.1234567)/1e-8)^2)", 1e-5), 90);
}

/* Blows of any width at any place are found. */
TEST(test_blows)
{
    struct br_test_random r = {3};
    const size_t cases = br_test_long() ? 3000 : 150;
    for (size_t i = 0; i < cases; i++) {
        const double at = br_test_uniform(&r, 0.01, 0.99),
                     length = br_test_log_uniform(&r, 1e-12, 1);
        char text[100];
        snprintf(text, sizeof text, "3*t + exp(-((t - %.17g)/%.17g)^2)", at, length);
        const size_t cells = check_mesh(text, 1e-7);
        AT_MOST((double)cells, 80);
        if (!(length > 0.1 || cells > 8))
            fail_msg("%s: %zu cells", text, cells);
    }
}

/* For all x at once; and what cannot be resolved is refused. */
TEST(test_both)
{
    const struct br_mesh_aim aim = {.degree = DEGREE, .tolerance = 1e-8};
    struct br_function f = br_test_function("sin(3*x)*cos(7*t)*exp(-x*t)");
    struct br_mesh m;
    MUST(br_resolve(&f, BR_T, unit, &aim, &m, &err));
    AT_MOST((double)m.count, 32);
    br_mesh_free(&m);
    br_function_free(&f);
    f = br_test_function("x < t");
    REFUSED(br_resolve(&f, BR_T, unit, &aim, &m, &err), BR_BAD_INPUT, "it cannot be resolved");
    br_function_free(&f);
    f = br_test_function("sin(1e7*t)");
    REFUSED(br_resolve(&f, BR_T, unit, &aim, &m, &err), BR_BAD_INPUT, "after 20000 pieces");
    br_function_free(&f);
}
