/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Manufactured solutions: symbolic derivatives against those by hand, every refusal, the
 * data that a solution determines against closed forms, and the judge. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "reference/mms/check.h"
#include "reference/mms/product.h"
#include "reference/mms/projection.h"
#include "study/scene_file.h"
#include "study/study.h"
#include "support.h"

/* ---- derivatives ---- */

static const struct {
    const char *text;
    struct br_order order;
    double x, t, expected;
    bool uses_x, uses_t;
} derivatives[] = {
    {"x^3*t^2", {0, 0}, 2, 3, 72, true, true},
    {"x^3*t^2", {2, 1}, 2, 3, 72, true, true},
    {"x^3*t^2", {3, 2}, 2, 3, 12, true, true}, /* which variables drop out is not known */
    {"sin(2*x)*exp(-t)",
     {4, 1},
     0.3,
     0.7,
     -16 * 0.5646424733950354 * 0.4965853037914095,
     true,
     true},
    {"sin(2*x)*exp(-t) + 0",
     {4, 1},
     0.3,
     0.7,
     -16 * 0.5646424733950354 * 0.4965853037914095,
     true,
     true}, /* no product */
    {"cos(x*t)", {1, 1}, 0.5, 2, -0.8414709848078965 - 0.5403023058681398, true, true},
    {"log(1 + x)", {1, 0}, 1, 0, 0.5, true, false},
    {"2^t", {0, 1}, 0, 3, 8 * 0.6931471805599453, false, true},
    {"-x^2*2e-3/4", {1, 0}, 3, 0, -3e-3, true, false},
    {"pi*x", {1, 0}, 5, 5, M_PI, true, false},
    {"3", {1, 0}, 5, 5, 0, false, false},
    /* at kinks: from the right */
    {"abs(t - 0.5)", {0, 1}, 0, 0.5, 1, false, true},
    {"abs(t - 0.5)", {0, 1}, 0, 0.25, -1, false, true},
    {"x*abs(t - 0.5)^3", {0, 2}, 2, 0.5, 0, true, true},
    {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.5, 2, false, true},
    {"(t - 0.5)^2*step(t - 0.5)", {0, 2}, 0, 0.4999, 0, false, true},
    {"(x - 0.5)^2*step(x - 0.5) + t", {2, 0}, 0.5, 0.5, 2, true, true},
    {"(x + t - 1)^2*step(x + t - 1)", {1, 1}, 0.5, 0.5, 2, true, true},
};

static void check_value(size_t i, const struct br_derivative *d)
{
    const double expected = derivatives[i].expected;
    CLOSE(br_derivative_at(d, derivatives[i].x, derivatives[i].t), expected,
          1e-9 + 1e-14 * fabs(expected));
    /* a variable that is said not to occur does not matter */
    if (!br_derivative_uses_x(d))
        CLOSE(br_derivative_at(d, 0.9, derivatives[i].t), expected, 1e-14);
    if (!br_derivative_uses_t(d))
        CLOSE(br_derivative_at(d, derivatives[i].x, 0.9), expected, 1e-14);
    assert_true(derivatives[i].uses_x || !br_derivative_uses_x(d));
    assert_true(derivatives[i].uses_t || !br_derivative_uses_t(d));
}

static void test_derivatives(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof derivatives / sizeof *derivatives; i++) {
        struct br_error err = {0};
        struct br_derivative *d, *copy;
        MUST(br_derivative_create(&d, derivatives[i].text, derivatives[i].order, &err));
        check_value(i, d);
        MUST(br_derivative_clone(d, &copy, &err));
        br_derivative_free(d);
        check_value(i, copy);
        br_derivative_free(copy);
    }
    br_derivative_free(NULL);
}

/* Many points at once, twice the same and then others: as one by one. */
static void test_values(void **state)
{
    (void)state;
    static const char *const texts[] = {"sin(3*x)*exp(t)*2", "sin(3*x + t)"};
    static const double x[][3] = {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.3, 0.2, 0.1}};
    for (size_t i = 0; i < 2; i++) {
        struct br_error err = {0};
        struct br_derivative *d;
        MUST(br_derivative_create(&d, texts[i], (struct br_order){1, 1}, &err));
        for (size_t call = 0; call < 3; call++) {
            double value[3];
            br_derivative_values(d, 3, x[call], 0.1 * (double)call, value);
            for (size_t p = 0; p < 3; p++)
                CLOSE(value[p], br_derivative_at(d, x[call][p], 0.1 * (double)call), 1e-14);
        }
        br_derivative_free(d);
    }
}

static void test_products(void **state)
{
    (void)state;
    static const struct {
        const char *text, *in_x, *in_t; /* NULL: no product */
    } products[] = {
        {"sin(x)*cos(t)", "(sin(x))", "(cos(t))"},
        {"2*x*t*3", "(2)*(x)*(3)", "(t)"},
        {"-x^2/4*(1 + t)", "(-x^2/4)", "((1 + t))"},
        {"1e-3*exp(2*x)", "(1e-3)*(exp(2*x))", "1"},
        {"t*1.E+2", "(1.E+2)", "(t)"},
        {"t*-x", "(-x)", "(t)"},
        {"exp(t)", "1", "(exp(t))"},
        {"x*t - 1", NULL, NULL},
        {"exp - 1*x", NULL, NULL},
        {"x/t", NULL, NULL},
        {"sin(x + t)", NULL, NULL},
        {"x^t*2", NULL, NULL},
        {"(x + 1)*(t + 1)", "((x + 1))", "((t + 1))"},
        {"", NULL, NULL},
    };
    for (size_t i = 0; i < sizeof products / sizeof *products; i++) {
        char in_x[128], in_t[128];
        assert_true(br_product_size(strlen(products[i].text)) <= sizeof in_x);
        const bool split = br_product_split(products[i].text, in_x, in_t);
        assert_int_equal(split, products[i].in_x != NULL);
        if (split) {
            assert_string_equal(in_x, products[i].in_x);
            assert_string_equal(in_t, products[i].in_t);
        }
    }
}

static void test_language(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } refusals[] = {
        {"x > t", "found '>' in 'x > t', expected only letters"},
        {"x ? 1 : 2", "found '?'"},
        {"min(x,t)", "found ','"},
        {"ln(1 + x)", "found 'ln' in 'ln(1 + x)', expected only what can be derived"},
        {"sign(x)", "found 'sign'"},
        {"expm1(x)", "found 'expm1'"},
    };
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        struct br_error err = {0};
        struct br_function same = br_test_function(refusals[i].text);
        REFUSED(br_derivative_check_text(refusals[i].text, &same, 1, 1, &err), BR_BAD_INPUT,
                refusals[i].message);
        br_function_free(&same);
    }
    struct br_error err = {0};
    struct br_derivative *d;
    REFUSED(br_derivative_create(&d, "x + y", (struct br_order){0, 0}, &err), BR_BAD_INPUT,
            "found 'y' in 'x + y', expected only what");
    assert_null(d);
    REFUSED(br_derivative_create(&d, "ln2*x", (struct br_order){0, 0}, &err), BR_BAD_INPUT,
            "found 'ln2' in"); /* a constant of libmatheval's */
    assert_null(d);
    struct br_function same = br_test_function("x^2^3");
    REFUSED(br_derivative_check_text("x^2^3", &same, 2, 1, &err), BR_BAD_INPUT,
            "'x^2^3' is 64 at x = 2 m, t = 0 s where it is derived symbolically, expected 256");
    br_function_free(&same);
}

/* Everything that derivative.h calls common is. */
static void test_common_language(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "x + 2 - .5*t/1e-3^2",
        "-x^2",
        "2^-x",
        "sin(x)*cos(t)",
        "tan(x)",
        "asin(x/2) + acos(x/2)",
        "atan(x + t)",
        "sinh(x)",
        "cosh(x)",
        "tanh(x)",
        "acosh(x + 1.5)",
        "atanh(x/2)",
        "exp(x)",
        "log(1 + x)",
        "sqrt(x + t)",
        "abs(x - t)",
        "step(x - t)",
        "pi + e*x",
        "(1 + x)^2.5*t",
        "x - -t",
        "1.5E+2*x",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct br_error err = {0};
        struct br_function same = br_test_function(texts[i]);
        MUST(br_derivative_check_text(texts[i], &same, 1, 1, &err));
        br_function_free(&same);
    }
    struct br_function step = br_test_function("step(x)");
    const double x[] = {-1e-300, 0, 1};
    double value[3];
    br_function_evaluate(&step, 3, x, 0, value);
    assert_true(value[0] == 0 && value[1] == 1 && value[2] == 1);
    br_function_free(&step);
}

/* ---- the check ---- */

static const struct {
    enum br_field_kind kind;
    const char *text, *message; /* NULL: accepted */
} solutions[] = {
    {BR_AXIAL, "sin(x)*exp(t)", NULL},
    {BR_AXIAL, "x*abs(t - 0.3)*(t - 0.3)", NULL},        /* u_tt jumps */
    {BR_BENDING, "x^2*(t - 0.4)^2*step(t - 0.4)", NULL}, /* at no sample point */
    {BR_AXIAL, "x*(0.5 + (x + t - 1)^2*step(x + t - 1))", "u_xxt integrates"}, /* u_xx jumps */
    {BR_AXIAL, "1 + x", "u is 1 at x = 0, t = 0 s, expected 0 where the beam is clamped"},
    {BR_AXIAL, "x + (t - 0.5)^2*step(t - 0.5)", "u is "},
    {BR_BENDING, "1 + x^2", "w is 1 at x = 0, t = 0 s"},
    {BR_BENDING, "sin(x)", "w_x is 1 at x = 0, t = 0 s, expected 0"},
    {BR_AXIAL, "x/(t - 0.5)", "u is "},
    {BR_AXIAL, "x*log(t)", "u is "},
    {BR_AXIAL, "x*sqrt(t)", "u_t is "},
    {BR_AXIAL, "x*abs(t - 0.3)^1.5", "u_tt reaches "},
    {BR_AXIAL, "x*abs(t - 0.5)^1.5", "u_tt is "},
    {BR_AXIAL, "x*t^1.5", "u_tt is "},
    {BR_AXIAL, "x^1.5", "u_xx is "},
    {BR_AXIAL, "x*(1 + exp(-100*t))", NULL},
    {BR_AXIAL, "x/(t - 0.3)", "u_t "},
    /* jumps, whose deltas the derivatives leave out */
    {BR_AXIAL, "x*step(t - 0.3)",
     "u_t integrates to 0 from t = 0.25 to 0.375 s at x = 0.125 m, "
     "expected 0.125, the change of u there: it jumps"},
    {BR_AXIAL, "x*abs(t - 0.3)", "u_tt integrates to 0 from t = 0.25 to 0.375 s"},
    {BR_AXIAL, "x*step(x - 0.3)", "u_x integrates"},
    {BR_AXIAL, "x*abs(x - 0.3)", "u_xx integrates"},
    {BR_BENDING, "x^2*step(t - 0.3)", "w_t integrates"},
    {BR_BENDING, "x^2*abs(t - 0.3)", "w_tt integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)", "w_xx integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)*(x - 0.3)", "w_xxx integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3", "w_xxxx integrates"},
    {BR_BENDING, "x^2*abs(x - 0.3)^3*(x - 0.3)", NULL},
    /* libmatheval 1.1.11 takes the derivative of asinh for that of asin */
    {BR_AXIAL, "asinh(x/2)*t", "u_x integrates"},
    {BR_AXIAL, "x*asinh(t/2)", "u_t integrates"},
};

static void test_check(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof solutions / sizeof *solutions; i++) {
        struct br_error err = {0};
        const struct br_solution s = {solutions[i].text, solutions[i].kind, 1, 1};
        if (solutions[i].message)
            REFUSED(br_solution_check(&s, &err), BR_BAD_INPUT, solutions[i].message);
        else
            MUST(br_solution_check(&s, &err));
    }
}

/* ---- scenes ---- */

static char path[] = "/tmp/br_test_mms_XXXXXX.yaml";

static int make_file(void **state)
{
    (void)state;
    const int descriptor = mkstemps(path, 5);
    return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_file(void **state)
{
    (void)state;
    return remove(path);
}

static enum br_status read_text(const char *text, struct br_scene *scene, struct br_error *err)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    return br_scene_read(path, scene, err);
}

#define TOP "title: t\nlength: 2 m\nduration: 1 s\ndensity: 3 kg/m\n"
#define AXIAL "axial:\n  stiffness: 5 N\n  viscosity: 7 N s\n"
#define BENDING "bending:\n  stiffness: 11 N m^2\n  viscosity: 13 N m^2 s\n"
#define CONTACT "contact: {gap: 0.1 m, stiffness: 17 N/m}\n"
#define TRESCA "friction: {law: tresca, bound: 19 N}\n"
#define COULOMB "friction: {law: coulomb, coefficient: 19 N/m}\n"
#define U "  solution: x^2*t^2 [m]\n"
#define W "  solution: x^4*t^2 [m]\n"
#define REST "  solution: x^4 [m]\n"

static void test_refusals(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } refusals[] = {
        {TOP AXIAL U BENDING, ":8: solution: found none in bending, expected one in every part"},
        {TOP AXIAL BENDING W, ":11: solution: found none in axial, expected one in every part"},
        {TOP AXIAL U "  load: 1 [N/m]\n", ":8: solution: found 'load' beside it, expected none"},
        {TOP AXIAL U "  load: x [N/m]\n", "found 'load' beside it"},
        {TOP AXIAL U "  tip_force: t [N]\n", "found 'tip_force' beside it"},
        {TOP AXIAL U "  displacement: x [m]\n", "found 'displacement' beside it"},
        {TOP AXIAL U "  velocity: x [m/s]\n", "found 'velocity' beside it"},
        {TOP BENDING W "  load: t [N/m]\n", ":8: solution: found 'load' beside it"},
        {TOP BENDING W "  tip_force: t [N]\n", "found 'tip_force' beside it"},
        {TOP BENDING W "  tip_moment: t [N m]\n", "found 'tip_moment' beside it"},
        {TOP BENDING W "  displacement: x^2 [m]\n", "found 'displacement' beside it"},
        {TOP BENDING W "  displacement_slope: x [1]\n", "found 'displacement_slope' beside it"},
        {TOP BENDING W "  velocity: x^2 [m/s]\n", "found 'velocity' beside it"},
        {TOP BENDING W "  velocity_slope: x [1/s]\n", "found 'velocity_slope' beside it"},
        {TOP AXIAL "  solution: x + [m]\n", ":8: solution: 'x +' is no expression in x and t"},
        {TOP AXIAL "  solution: x [N]\n", ":8: solution: found 'x [N]', expected an expression "},
        {TOP AXIAL "  solution: \"x > 1 ? x : t [m]\"\n", ":8: solution: found '>' in"},
        {TOP AXIAL "  solution: x + y [m]\n", ":8: solution: 'x + y' is no expression"},
        {TOP AXIAL "  solution: x*step(t - 0.3) [m]\n", ":8: solution: u_t integrates to 0 from"},
        {TOP AXIAL U BENDING "  solution: x [m]\n", ":12: solution: w_x is 1 at x = 0"},
        {TOP AXIAL U "  stick_force: 1 [N]\n", ":9: stick_force: unknown key in axial"},
        {TOP BENDING W "  stick_force: 1 [N]\n", "stick_force belongs to friction and a solution"},
        {TOP BENDING "  stick_force: 1 [N]\n" TRESCA, "belongs to friction and a solution"},
        {TOP BENDING W "  stick_force: x [N]\n", "expected an expression without x"},
        {TOP BENDING REST "  stick_force: -19.1 [N]\n" TRESCA,
         ":8: solution: stick_force is -19.1 N at t = 0 s, where the tip rests, expected at most "
         "the friction bound, 19 N"},
        {TOP BENDING REST "  stick_force: 20*t [N]\n" TRESCA, "stick_force is 19.0"},
        {TOP BENDING REST "  stick_force: 1/(t - 0.5)^2 [N]\n" TRESCA, "stick_force is "},
        {TOP AXIAL "  solution: x*(1 - t) [m]\n" BENDING REST
                   "  stick_force: 1 [N]\n" CONTACT COULOMB,
         ":12: solution: stick_force is 1 N at t = 0.923828 s, where the tip rests"},
    };
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        struct br_error err = {0};
        struct br_scene scene;
        const enum br_status status = read_text(refusals[i].text, &scene, &err);
        br_scene_clear(&scene);
        REFUSED(status, BR_BAD_INPUT, refusals[i].message);
        REFUSED(status, BR_BAD_INPUT, path);
    }
}

static double at(const struct br_function *f, double x, double t)
{
    double value;
    br_function_evaluate(f, 1, &x, t, &value);
    return value;
}

static struct br_scene scene_of(const char *text)
{
    struct br_error err = {0};
    struct br_scene scene;
    MUST(read_text(text, &scene, &err));
    return scene;
}

/* u = x^2 (t^2 + t), w = x^4 (t^2 + t), with L = 2 and the constants above. */
static void test_data(void **state)
{
    (void)state;
    struct br_scene s = scene_of(TOP AXIAL "  solution: x^2*(t^2 + t)  [m]\n" BENDING
                                           "  solution: x^4*(t^2 + t) [m]\n" CONTACT COULOMB);
    const double x = 0.7, t = 0.6, g = t * t + t, g_t = 2 * t + 1, tip = 2;
    assert_string_equal(s.axial.solution, "x^2*(t^2 + t)");
    assert_true(s.axial.load.space.uses_x && s.axial.load.space.uses_t);
    CLOSE(at(&s.axial.load.space, x, t), 3 * x * x * 2 - 2 * (5 * g + 7 * g_t), 1e-12);
    const double many[] = {x, 0.1, 1.9};
    double loads[3];
    br_function_evaluate(&s.axial.load.space, 3, many, t, loads);
    for (size_t i = 0; i < 3; i++)
        CLOSE(loads[i], 6 * many[i] * many[i] - 2 * (5 * g + 7 * g_t), 1e-12);
    CLOSE(at(&s.axial.load.time, x, t), 1, 0);
    CLOSE(at(&s.bending.load.space, x, t), 3 * pow(x, 4) * 2 + 24 * (11 * g + 13 * g_t), 1e-11);
    const double press = 4 * g - 0.1;
    CLOSE(at(&s.axial.tip_force, 0, t), 2 * tip * (5 * g + 7 * g_t) + 17 * press, 1e-11);
    CLOSE(at(&s.bending.tip_force, 0, t), 19 * press - 24 * tip * (11 * g + 13 * g_t), 1e-11);
    CLOSE(at(&s.bending.tip_moment, 0, t), 12 * tip * tip * (11 * g + 13 * g_t), 1e-11);
    CLOSE(at(&s.axial.velocity, x, 9), x * x, 1e-15);
    CLOSE(at(&s.bending.velocity, x, 9), pow(x, 4), 1e-15);
    CLOSE(at(&s.bending.velocity_slope, x, 9), 4 * pow(x, 3), 1e-14);
    assert_true(!s.axial.tip_force.uses_x && !s.axial.velocity.uses_t && s.axial.velocity.uses_x);
    CLOSE(at(&s.axial.displacement, x, 9), 0, 0);
    br_scene_clear(&s);
}

/* At rest, then slipping back: lambda = stick force, then -b; an open contact gives none. */
static void test_friction_data(void **state)
{
    (void)state;
    struct br_scene s = scene_of(TOP BENDING "  solution: x^4*(1 - (t - 0.5)^2*step(t - 0.5)) [m]\n"
                                             "  stick_force: 10*t [N]\n" TRESCA);
    CLOSE(at(&s.bending.tip_force, 0, 0.25), 2.5 - 24 * 2 * 11, 1e-11);
    CLOSE(at(&s.bending.tip_force, 0, 0.75), -19 - 24 * 2 * (11 * (1 - 0.0625) - 13 * 0.5), 1e-11);
    CLOSE(at(&s.bending.displacement_slope, 0.5, 0), 0.5, 1e-15);
    br_scene_clear(&s);
    s = scene_of(TOP AXIAL "  solution: -x [m]\n" BENDING W CONTACT COULOMB);
    CLOSE(at(&s.axial.tip_force, 0, 0.5), -5, 1e-15);
    CLOSE(at(&s.bending.tip_force, 0, 0.5), -24 * 2 * (11 * 0.25 + 13), 1e-11);
    struct br_function copy;
    struct br_error err = {0};
    MUST(br_function_clone(&s.bending.tip_force, &copy, &err));
    const double expected = at(&s.bending.tip_force, 0, 0.3);
    br_scene_clear(&s);
    CLOSE(at(&copy, 0, 0.3), expected, 0);
    br_function_free(&copy);
    /* without density an initial velocity means nothing */
    s = scene_of("title: t\nlength: 1 m\nduration: 1 s\ndensity: 0 kg/m\n" AXIAL
                 "  solution: x*(1 + t) [m]\n");
    assert_true(br_function_is_zero(&s.axial.velocity));
    CLOSE(at(&s.axial.displacement, 0.5, 0), 0.5, 0);
    br_scene_clear(&s);
}

/* ---- the judge ---- */

static void test_projection(void **state)
{
    (void)state;
    static const struct {
        struct br_projected what;
        double square; /* of the L2 norm over [0, 2] at t = 3 of that of exp(x) t^2 */
    } cases[] = {
        {{{0, 0}, 2}, 81}, {{{0, 0}, 4}, 81}, {{{2, 1}, 3}, 36},
        {{{1, 0}, 1}, 81}, {{{0, 1}, 8}, 36},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct br_error err = {0};
        struct br_projection *p;
        const struct br_projection_mesh mesh = {2, 3};
        const size_t kept = cases[i].what.kept;
        MUST(br_projection_create(&p, "exp(x)*t^2", &cases[i].what, &mesh, &err));
        double modes[24], sum = 0;
        const struct br_projection_rest rest = br_projection_apply(p, 3, modes);
        for (size_t m = 0; m < 3 * kept; m++)
            sum += modes[m] * modes[m];
        const double norm = cases[i].square * expm1(4) / 2;
        CLOSE(sum + rest.rest, norm, 1e-12 * norm);
        assert_true(rest.rest > 0 && rest.tail < 1e-20 * norm);
        /* the mean of the first element */
        CLOSE(modes[0], sqrt(cases[i].square / (2.0 / 3)) * expm1(2.0 / 3), 1e-12);
        br_projection_free(p);
    }
    struct br_error err = {0};
    struct br_projection *p;
    const struct br_projected many = {{0, 0}, 9};
    REFUSED(br_projection_create(&p, "x", &many, &(struct br_projection_mesh){1, 1}, &err),
            BR_BAD_INPUT, "9 modes are to be kept, expected at most 8");
    br_projection_free(NULL);
}

static struct br_study study_of(const struct br_scene *scene, const size_t *n, const size_t *steps)
{
    return (struct br_study){
        .scene = scene,
        .norm = br_norms[0],
        .method = br_test_method(NULL, "implicit", NULL),
        .judge = &br_judge_mms,
        .n_count = 2,
        .k_count = 2,
        .n = n,
        .steps = steps,
    };
}

/* What both the elements and the Euler steps hold exactly has no error at all: with contact,
 * friction, a tip force and a moment, on any mesh. */
static void test_exact(void **state)
{
    (void)state;
    struct br_scene scene =
        scene_of(TOP AXIAL "  solution: x*(1 + t) [m]\n" BENDING
                           "  solution: x^2*(3 - x)*(1 - 2*t) [m]\n" CONTACT COULOMB);
    static const size_t n[] = {3, 7}, steps[] = {5, 40};
    struct br_error err = {0};
    struct br_study s = study_of(&scene, n, steps);
    MUST(br_study_run(&s, 1, 2, NULL, &err));
    for (size_t c = 0; c < 4; c++)
        for (int p = 0; p < BR_PARTS; p++)
            AT_MOST(s.cell[c].error[p], 2e-13);
    assert_true(s.reference_scale > 1);
    AT_MOST(s.judged_by.own_error[BR_BENDING][BR_DISPLACEMENT], 1e-13);
    assert_string_equal(s.events,
                        "Manufactured solution: u = x*(1 + t), w = x^2*(3 - x)*(1 - 2*t).\n");
    br_study_clear(&s);
    br_scene_clear(&scene);
}

static void test_judge(void **state)
{
    (void)state;
    assert_ptr_equal(br_judge_find("mms"), &br_judge_mms);
    static const char *const names[] = {"example2", "example3"}; /* both parts; bending alone */
    static const size_t n[] = {2, 3}, steps[] = {5, 7};
    for (size_t i = 0; i < 2; i++) {
        struct br_error err = {0};
        struct br_scene scene = br_test_bundled(names[i]);
        struct br_study s = study_of(&scene, n, steps);
        REFUSED(br_study_run(&s, 1, 1, NULL, &err), BR_BAD_INPUT,
                "--reference mms needs a scene with a manufactured solution: keys 'solution' in "
                "axial and bending");
        br_scene_clear(&scene);
    }
    br_judge_mms.free(NULL);
}

/* Evaluators are made and used on several threads at once: the same bits. */
static void test_threads(void **state)
{
    (void)state;
    static const size_t n[] = {4, 6}, steps[] = {20, 30};
    struct br_error err = {0};
    struct br_scene scene = br_test_bundled("mms_opening");
    double one[4] = {0};
    for (int threads = 1; threads <= 4; threads++) {
        struct br_study s = study_of(&scene, n, steps);
        MUST(br_study_run(&s, 1, threads, NULL, &err));
        for (size_t c = 0; c < 4; c++) {
            one[c] = threads == 1 ? s.cell[c].error[0] : one[c];
            assert_true(s.cell[c].error[0] == one[c] && one[c] > 0);
        }
        br_study_clear(&s);
    }
    br_scene_clear(&scene);
}

/* libmatheval's parser has global state. */
static void *derive_many(void *wrong)
{
    for (int i = 0; i < 300; i++) {
        struct br_derivative *d;
        char text[64];
        snprintf(text, sizeof text, "%d*sin(x)*exp(t) + t", i);
        const bool good = !br_derivative_create(&d, text, (struct br_order){1, 1}, NULL) &&
                          fabs(br_derivative_at(d, 0, 0) - i) <= 1e-12;
        br_derivative_free(d);
        if (!good)
            atomic_fetch_add((atomic_int *)wrong, 1);
    }
    return NULL;
}

static void test_concurrent_parsers(void **state)
{
    (void)state;
    pthread_t thread[4];
    atomic_int wrong = 0;
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, derive_many, &wrong), 0);
    for (int i = 0; i < 4; i++)
        pthread_join(thread[i], NULL);
    assert_int_equal(wrong, 0);
}

/* ---- out of memory ---- */

static enum br_status attempt(struct br_error *err)
{
    static const size_t n[] = {2, 3}, steps[] = {2, 3};
    struct br_scene scene;
    enum br_status status = br_scene_read(path, &scene, err);
    if (!status) {
        struct br_study s = study_of(&scene, n, steps);
        status = br_study_run(&s, 1, 1, NULL, err);
        br_study_clear(&s);
    }
    br_scene_clear(&scene);
    return status;
}

static void test_allocation(void **state)
{
    (void)state;
    struct br_scene scene = scene_of(TOP AXIAL "  solution: x*(1 + t) [m]\n" BENDING
                                               "  solution: x^4*t [m]\n" CONTACT COULOMB);
    br_scene_clear(&scene);
    long failed = 0;
    for (long i = 0, good = 0; good < 40; i++) { /* a few allocations can be done without */
        struct br_error err = {0};
        br_allocation_fails_at(i);
        const enum br_status status = attempt(&err);
        br_allocation_fails_at(-1);
        if (status)
            REFUSED(status, BR_NO_MEMORY, "out of memory");
        failed += status != BR_OK;
        good = status ? 0 : good + 1;
        assert_true(i < 2000);
    }
    assert_true(failed > 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivatives),     cmocka_unit_test(test_values),
        cmocka_unit_test(test_products),        cmocka_unit_test(test_language),
        cmocka_unit_test(test_common_language), cmocka_unit_test(test_check),
        cmocka_unit_test(test_refusals),        cmocka_unit_test(test_data),
        cmocka_unit_test(test_friction_data),   cmocka_unit_test(test_projection),
        cmocka_unit_test(test_exact),           cmocka_unit_test(test_judge),
        cmocka_unit_test(test_threads),         cmocka_unit_test(test_concurrent_parsers),
        cmocka_unit_test(test_allocation),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}
