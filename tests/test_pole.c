/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Poles between the places where a function is looked at, and steep functions that have none. */
#include "study/pole.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "study/scene_file.h"
#include "support.h"

enum { PARTS = 1024 };

static const struct {
    const char *text;
    double at;
} poles[] = {
    {"1/(x - 0.3333)", 0.3333},
    {"-1/(x - 0.3333)^2", 0.3333},
    {"1e-9/(x - 0.3333)", 0.3333},
    {"10 + 1/abs(x - 0.777)", 0.777},
    {"1/sqrt(abs(x - 0.123456))", 0.123456},
    {"(x > 0.3333)/(x - 0.3333)", 0.3333},
    {"tan(pi*x)", 0.5},
    {"tan(pi*x)^2", 0.5},
    {"1/sin(2*pi*(x - 0.1))", 0.1},
    {"x + 1/sin(pi*x - 1)", 0.31830988618379067},
    {"cos(7*x)/sin(3*x - 1)", 1.0 / 3},
    {"1/(exp(x) - 2)", 0.6931471805599453},
    {"1/log(x + 0.6)^2", 0.4},
    {"4e6*(x - 0.3333) + 1/(x - 0.3333)", 0.3333}, /* no peak where it is looked at */
    {"1/(x - 1e-5)", 1e-5},                        /* near the ends */
    {"1/(x - 0.99999)", 0.99999},
    {"1/(x - 1e-5)^2", 1e-5},
    {"1/(x - 0.99999)^2", 0.99999},
};

static void test_poles(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof poles / sizeof *poles; i++) {
        struct br_function f = br_test_function(poles[i].text);
        const struct br_line line = {&f, true, 0, 1};
        double at = NAN, value = 0;
        if (!br_find_pole(&line, PARTS, &at, &value))
            fail_msg("%s: no pole was found", poles[i].text);
        CLOSE(at, poles[i].at, 1e-12);
        assert_true(!(fabs(value) < 1e3));
        br_function_free(&f);
    }
}

static void test_steep(void **state)
{
    (void)state;
    static const char *const steep[] = {
        "0",
        "exp(100*x)",
        "tanh(1e4*(x - 0.3333))",
        "tanh(1e12*(x - 0.3333))",
        "1/(1e-6 + (x - 0.3333)^2)",
        "1/(1e-18 + (x - 0.3333)^2)",
        "(x - 0.3333)/(1e-12 + (x - 0.3333)^2)",
        "(x > 0.3333 ? 1 : -1)/(1e-6 + abs(x - 0.3333))",
        "x < 0.3333 ? -1 : 1",
        "(x > 0.33 && x < 0.3301)*1e12",
        "1e9*(x == 0.5)",
        "sin(1000*x)",
        "sin(1/(x + 1e-3))",
        "sin(1e6*x)^9",
        "sqrt(abs(x - 0.3333))",
        "abs(x - 0.3333)",
        "1/(1.0001 - x)",
        "exp(-1e8*(x - 0.3333)^2)",
        "1e300*(x - 0.3333)",
        "cos(40*x)*exp(50*x)",
    };
    for (size_t i = 0; i < sizeof steep / sizeof *steep; i++) {
        struct br_function f = br_test_function(steep[i]);
        const struct br_line line = {&f, true, 0, 1};
        double at, value;
        if (br_find_pole(&line, PARTS, &at, &value))
            fail_msg("%s: found %g at %.17g", steep[i], value, at);
        br_function_free(&f);
    }
}

/* Along t at a place, and along x at a time. */
static void test_lines(void **state)
{
    (void)state;
    struct br_function f = br_test_function("1/(x - 2*t + 0.1001)");
    const struct br_line in_x = {&f, true, 0.25, 1}, in_t = {&f, false, 0.5, 3};
    double at, value;
    assert_true(br_find_pole(&in_x, PARTS, &at, &value));
    CLOSE(at, 0.3999, 1e-12);
    assert_true(br_find_pole(&in_t, PARTS, &at, &value));
    CLOSE(at, 0.30005, 1e-12);
    br_function_free(&f);
}

/* A scene with one is refused, with the place. */
static void test_scene(void **state)
{
    (void)state;
    static const struct {
        const char *load, *message;
    } rows[] = {
        {"tan(pi*t) [N/m]", "it has a pole: found "},
        {"1/(t - 0.3333) [N/m]", "at t = 0.3333 s, expected a finite number everywhere in [0, T]"},
        {"1/(x - 0.3333) [N/m]", "at x = 0.3333 m, expected a finite number everywhere in [0, L]"},
        {"1/(x - t + 0.1001) [N/m]", " m, t = "},
        {"{shape: \"1/(x - 0.3333)^2 [1]\", history: \"t [N/m]\"}", "at x = 0.3333 m"},
    };
    char path[] = "/tmp/br_test_pole_XXXXXX.yaml";
    const int descriptor = mkstemps(path, 5);
    assert_true(descriptor >= 0 && close(descriptor) == 0);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_scene scene = {0};
        struct br_error err = {0};
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fprintf(file,
                "title: t\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n"
                "  stiffness: 1 N\n  viscosity: 1 N s\n  load: %s\n",
                rows[i].load);
        assert_int_equal(fclose(file), 0);
        REFUSED(br_scene_read(path, &scene, &err), BR_BAD_INPUT, rows[i].message);
        br_scene_clear(&scene);
    }
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_poles),
        cmocka_unit_test(test_steep),
        cmocka_unit_test(test_lines),
        cmocka_unit_test(test_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
