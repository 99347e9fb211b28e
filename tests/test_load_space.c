/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The warnings of loads that time levels, or the elements' quadrature, do not see. */
#include <stdio.h>
#include <string.h>

#include "study/estimate/warnings.h"
#include "study/scene/file.h"
#include "support.h"

static struct br_warnings warnings_of(const struct br_scene *scene, size_t n, size_t steps)
{
    const struct br_method method = br_method_default();
    const struct br_planned_march o = {.scene = scene, .method = &method, .n = n, .steps = steps};
    struct br_warnings w = {0};
    MUST(br_check_loads(&o, &w, &err));
    return w;
}

/* Whether it is warned of with these words; NULL: not at all. */
static bool is_said(const struct br_warnings *w, enum br_warning_kind kind, const char *said)
{
    const struct br_warning *one = br_test_warning(w, kind);
    return said ? one && strstr(one->text, said) : !one;
}

/* However short it is, wherever it is, and however many steps or elements there are; its share of
 * all. */
static const struct {
    const char *load;
    size_t n, steps;
    const char *in_time, *in_space; /* what is said; NULL: nothing */
} rows[] = {
    {"exp(-((t - 0.4567)/0.001)^2)", 20, 100, "load changes faster than the time steps", NULL},
    {"exp(-((t - 0.4567)/0.001)^2)", 20, 100, "near t = 0.455 s", NULL},
    {"exp(-((t - 0.4567)/0.001)^2)", 20, 10000, NULL, NULL},
    {"exp(-((t - 0.4567)/1e-5)^2)", 3, 40000, "", NULL},           /* 2 samples a step */
    {"sin(2*3.14159265358979*130000.3*t)^2", 1, 130000, "", NULL}, /* a sample of the steps */
    {"sin(2*3.14159265358979*130000.3*t)^2", 1, 20000000, NULL, NULL},
    {"sin(3*t) + exp(t)", 20, 10, NULL, NULL},
    {"exp(-((t - 0.31234567)/1e-9)^2)", 4000, 10, " all of its impulse, most of it near t = 0.35",
     NULL},
    {"exp(-((t - 0.3)/1e-7)^2)", 4000, 10, /* at a level: they see k of it */
     " more than all of its impulse, most of it near t = 0.", NULL},
    {"exp(-((t - 0.31234567)/1e-9)^2)", 4000, 1000000, " all of its impulse", NULL},
    {"exp(-((t - 0.31234567)/1e-9)^2)", 4000, 300000000, " 88 % of its impulse", NULL},
    {"exp(-((t - 0.31234567)/1e-9)^2)", 4000, 4000000000, NULL, NULL},
    {"1 + 1e8/3.1415926^0.5*exp(-((t - 0.31234567)/1e-8)^2)", 4000, 60000, " 50 % of its impulse",
     NULL},
    {"1 + 1e6*exp(-((t - 0.31234567)/1e-8)^2)", 4000, 60000, NULL, NULL}, /* 2 % of it */
    {"exp(-((x - 0.123)/1e-3)^2 - ((t - 0.456)/1e-6)^2)", 4000, 100, "near t = 0.455 s", NULL},
    {"x*1e3*(t > 0.70001 && t < 0.70002)", 4000, 200, "near t = 0.7025 s", NULL},
    {"t < 0.45 ? 0 : x", 4000, 3, " 21 % of its impulse", NULL},       /* Euler's, by hand: 7/33 */
    {"exp(-7 - x)*(t < 0.45)", 4000, 3, " 26 % of its impulse", NULL}, /* 7/27 */
    {"t < 0.45 ? 0 : x", 4000, 30, NULL, NULL},
    {"1 + 2*(t - 0.4)^2*step(t - 0.4)", 4000, 100, NULL, NULL}, /* a kink at the end of a piece */

    /* Late ones: on a level Euler's step before counts as a whole, k/(T - 0.83), if the value there
     * is that of after the jump; the levels are those of the march, whatever round-off. */
    {"30*step(t - 0.83)", 20, 100, "jumps at t = 0.83 s, on a time level", NULL},
    {"30*step(t - 0.83)", 20, 100, "5.9 % of its impulse, most of it near t = 0.825 s", NULL},
    {"30*(t > 0.83)", 20, 100, NULL, NULL},
    {"30*(t >= 0.83)", 20, 100, "on a time level", NULL},
    {"30*step(t - 0.83)", 20, 1000, NULL, NULL},
    {"30*step(t - 0.825)", 20, 100, NULL, NULL}, /* k/2 of 0.175 s */
    {"30*step(t - 0.9951)", 20, 100, "load changes faster than the time steps", NULL},
    {"x*step(t - 0.29)", 20, 100, " 1.4 % of its impulse, most of it near t = 0.285 s", NULL},
    {"step(t - 0.57) - step(t - 0.67)", 20, 100, " 20 % of its impulse", NULL},
    {"step(t - 0.57) - step(t - 0.58)", 20, 1000, " 20 % of its impulse", NULL},
    {"step(100*t - 95)", 20, 100, " 20 % of its impulse, most of it near t = 0.945 s", NULL},
    {"max(0, t - 0.83)", 20, 100, NULL, NULL},
    {"step(t - 0.28)", 20, 100, "on a time level", NULL},
    {"x < t ? 1 : 0", 200, 100, NULL, NULL}, /* a front is on a level at one point only */

    {"7", 1, 10, NULL, NULL},
    {"t", 1, 10, NULL, NULL},
    {"x^9", 1, 10, NULL, NULL},
    {"exp(x)*t", 2, 10, NULL, NULL},
    {"exp(-((x - 0.53)/0.004)^2)", 10, 10, NULL, "faster in x than the quadrature"},
    {"exp(-((x - 0.53)/0.004)^2)", 400, 10, NULL, NULL},
    {"100*(x > 0.5 && x < 0.501)", 20, 10, NULL, ""},
    {"100*(x > 0.5 && x < 0.501)", 20000, 10, NULL, NULL},
    {"1 + 500*(x > 0.7009 && x < 0.7029)", 10, 10, NULL, /* half of the force */
     "with n = 10 the error is 50 % of it, most of it near x = 0.7 m"},
    {"x < 0.37 ? 1 : 0", 1, 10, NULL, ""}, /* jumps */
    {"x < 0.37 ? 1 : 0", 100, 10, NULL, NULL},
    {"x < 0.4 ? 1 : 0", 10, 10, NULL, NULL},
    {"sin(400*x)", 10, 10, NULL, ""}, /* waves */
    {"sin(400*x)", 200, 10, NULL, NULL},
    {"exp(-((x - t)/0.003)^2)", 8, 10, "", ""}, /* it travels */
    {"exp(-((x - t)/0.003)^2)", 600, 1000, NULL, NULL},
    {"exp(-((x - 0.53)/1e-6)^2) + 1", 100000, 10, NULL, NULL},
    {"exp(-((x - 0.531)/1e-9)^2)", 100, 10, NULL, ""}, /* narrower than any sample would see */
    {"exp(-((x - 0.531)/1e-9)^2)", 100000, 10, NULL, ""},
    {"(x > 0.531 && x < 0.5310001)*t", 1000, 10, NULL, ""},
    {"exp(-((x - 0.2)/1e-3)^2 - ((t - 0.456)/1e-6)^2)", 100, 10, "", ""},
    {"exp(-((x - 0.2)/1e-3)^2 - ((t - 0.456)/1e-6)^2)", 4000, 10, "", NULL},
    {"sin(1e7*x)", 100, 10, NULL, "so often in x that the error of"},
};

TEST(test_rows)
{
    struct br_scene s = br_test_bare();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        s.bending.load = br_test_load(rows[i].load);
        const struct br_warnings w = warnings_of(&s, rows[i].n, rows[i].steps);
        if (!is_said(&w, BR_WARN_LOAD_TIME, rows[i].in_time) ||
            !is_said(&w, BR_WARN_LOAD_SPACE, rows[i].in_space))
            fail_msg("%s, n = %zu, %zu steps: %s", rows[i].load, rows[i].n, rows[i].steps,
                     w.count ? w.list[0].text : "no warning");
        s.axial.load = s.bending.load; /* as the axial one it is seen as well */
        s.bending.load = (struct br_load){0};
        const struct br_warnings axial = warnings_of(&s, rows[i].n, rows[i].steps);
        assert_int_equal(axial.count, w.count);
        br_load_clear(&s.axial.load);
    }
}

/* What to do about a jump on a level depends on the scheme; chosen steps find it. */
TEST(test_jump_on_level)
{
    static const struct {
        const char *scheme, *said, *remedy;
    } by[] = {
        {"euler", " 20 % of its impulse",
         "(t > 0.95) or (t <= 0.95), not step(t - 0.95)\n--k T/105  #"},
        {"bdf2", " 20 % of its impulse", "(t > 0.95)"},
        {"trbdf2", " 10 % of its impulse", "--k T/105  #"},
        {"adaptive", NULL, NULL},
    };
    struct br_scene s = br_test_bare();
    s.bending.load = br_test_load("step(t - 0.95)");
    for (size_t i = 0; i < sizeof by / sizeof *by; i++) {
        struct br_method method = br_method_default();
        method.scheme = br_time_scheme_find(by[i].scheme);
        const struct br_planned_march o = {.scene = &s, .method = &method, .n = 10, .steps = 100};
        struct br_warnings w = {0};
        MUST(br_check_loads(&o, &w, &err));
        const struct br_warning *one = br_test_warning(&w, BR_WARN_LOAD_TIME);
        if (!is_said(&w, BR_WARN_LOAD_TIME, by[i].said) ||
            (one && !strstr(one->remedy, by[i].remedy)))
            fail_msg("%s: %s; %s", by[i].scheme, one ? one->text : "nothing",
                     one ? one->remedy : "");
    }
    br_load_clear(&s.bending.load);
}

/* Nothing is said of the bundled scenes' elements. */
TEST(test_bundled)
{
    char **name;
    size_t count;
    MUST(br_scene_list(&name, &count, &err));
    for (size_t i = 0; i < count; i++) {
        OWNED(br_scene) scene = br_test_bundled(name[i]);
        for (size_t n = 10; n <= 1000; n *= 10) {
            const struct br_warnings w = warnings_of(&scene, n, 10);
            if (!is_said(&w, BR_WARN_LOAD_SPACE, NULL))
                fail_msg("%s: %s", name[i], w.list[0].text);
        }
    }
    br_scene_list_free(name, count);
}
