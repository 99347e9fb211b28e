/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The warning of loads that the elements' quadrature does not see. */
#include <stdio.h>
#include <string.h>

#include "study/foresee/warnings.h"
#include "study/scene/file.h"
#include "support.h"

/* NULL: it is not warned of. */
static const struct br_warning *warning_of(const struct br_scene *scene, size_t n)
{
    const struct br_method method = br_method_default();
    const struct br_planned_march o = {.scene = scene, .method = &method, .n = n, .steps = 10};
    static struct br_warnings w;
    struct br_error err;
    w = (struct br_warnings){0};
    MUST(br_look_at_loads(&o, &w, &err));
    return br_warnings_find(&w, BR_WARN_LOAD_SPACE);
}

static const struct {
    const char *load;
    size_t n;
    bool warned;
} rows[] = {
    {"7", 1, false},
    {"t", 1, false},
    {"x^9", 1, false},
    {"exp(x)*t", 2, false},
    {"exp(-((x - 0.53)/0.004)^2)", 10, true}, /* narrow */
    {"exp(-((x - 0.53)/0.004)^2)", 400, false},
    {"100*(x > 0.5 && x < 0.501)", 20, true},
    {"100*(x > 0.5 && x < 0.501)", 20000, false},
    {"x < 0.37 ? 1 : 0", 1, true}, /* jumps */
    {"x < 0.37 ? 1 : 0", 100, false},
    {"x < 0.4 ? 1 : 0", 10, false},
    {"sin(400*x)", 10, true}, /* waves */
    {"sin(400*x)", 200, false},
    {"exp(-((x - t)/0.003)^2)", 8, true}, /* it travels */
    {"exp(-((x - t)/0.003)^2)", 600, false},
    {"exp(-((x - 0.53)/1e-6)^2) + 1", 100000, false},
    {"exp(-((x - 0.531)/1e-9)^2)", 100, true}, /* narrower than any sample would see */
    {"exp(-((x - 0.531)/1e-9)^2)", 100000, true},
    {"(x > 0.531 && x < 0.5310001)*t", 1000, true},
    {"exp(-((x - 0.2)/1e-3)^2 - ((t - 0.456)/1e-6)^2)", 100, true},
    {"exp(-((x - 0.2)/1e-3)^2 - ((t - 0.456)/1e-6)^2)", 4000, false},
    {"sin(1e7*x)", 100, true}, /* not known */
};

TEST(test_rows)
{
    struct br_scene s = br_test_bare();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int bending = 0; bending < 2; bending++) {
            struct br_load load = br_test_load(rows[i].load);
            *(bending ? &s.bending.load : &s.axial.load) = load;
            const struct br_warning *one = warning_of(&s, rows[i].n);
            if (rows[i].warned != (one != NULL))
                fail_msg("%s, n = %zu: %s", rows[i].load, rows[i].n, one ? one->text : "none");
            br_load_clear(&load);
            s.bending.load = s.axial.load = (struct br_load){0};
        }
}

/* The share is that of the force, and the place the nearest node. */
TEST(test_share)
{
    struct br_scene s = br_test_bare();
    s.axial.load = br_test_load("1 + 500*(x > 0.7009 && x < 0.7029)"); /* half of the force */
    const struct br_warning *one = warning_of(&s, 10);
    assert_non_null(one);
    assert_non_null(strstr(one->text, "the axial load does inside of elements"));
    assert_non_null(strstr(one->text, "with n = 10 50 % of it, most of it near x = 0.7 m"));
    br_load_clear(&s.axial.load);
}

TEST(test_bundled)
{
    char **name;
    size_t count;
    struct br_error err;
    MUST(br_scene_list(&name, &count, &err));
    for (size_t i = 0; i < count; i++) {
        struct br_scene scene = br_test_bundled(name[i]);
        for (size_t n = 10; n <= 1000; n *= 10) {
            const struct br_warning *one = warning_of(&scene, n);
            if (one)
                fail_msg("%s: %s", name[i], one->text);
        }
        br_scene_clear(&scene);
    }
    br_scene_list_free(name, count);
}
