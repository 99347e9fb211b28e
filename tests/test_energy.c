/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy balance of every time scheme: it closes in every step, to round-off, with what the
 * scheme takes in closed form; a coefficient that is a little off is seen in it; and what a scheme
 * adds is told. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/energy.h"
#include "study/scene/file.h"
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
    m.tolerance = 1e-3;
    if (scene->friction.regularisation > 0)
        m.friction = br_friction_rule_find("regularised");
    return m;
}

/* told: the scene that the meter is told; NULL: that of the march. */
static bool start(struct metered *m, size_t n, size_t steps, const struct br_scene *told)
{
    struct br_error err = {0};
    m->worst = 0;
    if (br_method_check_scene(&m->method, &m->scene, &err))
        return false;
    const enum br_status status = br_march_create(&m->march, &m->scene, n, steps, &m->method, &err);
    if (status == BR_BAD_INPUT)
        return false;
    br_test_must(status, &err, "a march", __FILE__, __LINE__);
    m->limit = br_energy_limit(n, br_march_round_off(m->march)) * br_test_slack();
    MUST(br_energy_meter_create(&m->meter, m->march, told ? told : &m->scene, &m->method, &err));
    return true;
}

/* Ends where the march does: true. */
static bool advance(struct metered *m, size_t steps)
{
    struct br_error err = {0};
    for (size_t step = 0; step < steps; step++) {
        if (br_march_step(m->march, &err))
            return true;
        const double over = br_energy_meter_step(m->meter) / m->limit;
        if (isnan(over) || over > m->worst)
            m->worst = over;
    }
    return false;
}

static void finish(struct metered *m)
{
    br_energy_meter_free(m->meter);
    br_march_free(m->march);
    br_scene_clear(&m->scene);
    *m = (struct metered){0};
}

/* Each scheme of the registry that is made of stages. */
static const struct br_time_scheme *staged(size_t i)
{
    size_t seen = 0;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        if (seen++ == i)
            return *s;
    return NULL;
}

/* ---- it closes ---- */

static void close_scene(const char *name, const struct br_time_scheme *scheme, const char *solver,
                        size_t n, size_t steps)
{
    struct metered m = {.scene = br_test_bundled(name)};
    m.method = method_of(scheme, solver, &m.scene);
    if (start(&m, n, steps, NULL))
        advance(&m, steps);
    if (!(m.worst <= 1))
        fail_msg("%s, %s, %s, n = %zu, %zu steps: a balance is off by %.3g of its limit", name,
                 scheme->name, solver, n, steps, m.worst);
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
        for (size_t i = 0; staged(i); i++) {
            close_scene(names[s], staged(i), "riccati", 1, 30);
            close_scene(names[s], staged(i), "riccati", 9, 60);
            close_scene(names[s], staged(i), "plain", 40, 20);
        }
    br_scene_list_free(names, count);
}

static void test_solvers_and_meshes(void **state)
{
    (void)state;
    static const size_t meshes[] = {3, 100, 2000};
    for (size_t i = 0; staged(i) && !staged(i)->adaptive; i++)
        for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
            for (size_t n = 0; n < 3; n++)
                close_scene("heavy_damping", staged(i), (*s)->name, meshes[n], 5);
}

/* Loads, laws, density and damping by chance, over decades; by equal steps, since adaptive ones
 * would be too many. */
static void random_scene(struct br_test_random *random, struct br_scene *s)
{
    *s = br_test_bare();
    s->duration = br_test_log_uniform(random, 0.1, 10);
    s->density = br_test_index(random, 4) ? br_test_log_uniform(random, 1e-6, 1e6) : 0;
    s->axial.viscosity = br_test_log_uniform(random, 1e-6, 1e2);
    s->bending.viscosity = br_test_log_uniform(random, 1e-6, 1e2);
    s->axial.stiffness = br_test_log_uniform(random, 1e-3, 1e3);
    s->bending.stiffness = br_test_log_uniform(random, 1e-3, 1e3);
    s->axial.load = br_test_load("cos(7*t)+x");
    s->bending.load = br_test_load("sin(5*t)-0.2*x*t");
    s->bending.tip_moment = br_test_function("cos(3*t)");
    s->contact = (struct br_contact){true, br_test_index(random, 2) ? 0 : 0.01,
                                     br_test_log_uniform(random, 1e-3, 1e9)};
    s->friction = (struct br_friction){
        .law = br_test_index(random, 2) ? BR_TRESCA : BR_COULOMB,
        .coefficient = br_test_log_uniform(random, 1e-6, 1e6),
    };
}

static void test_random_scenes(void **state)
{
    (void)state;
    struct br_test_random random = {20061};
    for (int trial = 0; trial < 300; trial++) {
        struct metered m = {0};
        random_scene(&random, &m.scene);
        const struct br_time_scheme *scheme = staged(br_test_index(&random, 7));
        m.method = method_of(scheme, NULL, &m.scene);
        if (scheme->may_lag && br_test_index(&random, 2))
            m.method.contact = br_contact_rule_find("lagged");
        m.method.axial_degree = 1 + (int)br_test_index(&random, 2);
        const size_t n = 1 + br_test_index(&random, 40);
        if (start(&m, n, 40, NULL))
            advance(&m, 40);
        if (!(m.worst <= 1))
            fail_msg("trial %d, %s: a balance is off by %.3g of its limit", trial, scheme->name,
                     m.worst);
        finish(&m);
    }
}

/* ---- it sees ---- */

/* The meter is told a value that is off by one part in ten million. */
static void spoil(size_t which, struct br_scene *scene)
{
    double *const values[] = {&scene->density,           &scene->axial.stiffness,
                              &scene->axial.viscosity,   &scene->bending.stiffness,
                              &scene->bending.viscosity, &scene->length};
    *values[which] *= 1 + 1e-7;
}

static void test_spoilt_scenes(void **state)
{
    (void)state;
    for (size_t i = 0; staged(i); i++)
        for (size_t which = 0; which < 6; which++) {
            struct metered m = {.scene = br_test_bundled("chatter")};
            m.method = method_of(staged(i), NULL, &m.scene);
            struct br_scene told = m.scene;
            spoil(which, &told);
            assert_true(start(&m, 10, 200, &told));
            advance(&m, 200);
            if (m.worst <= 1)
                fail_msg("%s: value %zu off by 1e-7 passed", staged(i)->name, which);
            finish(&m);
        }
}

/* Each term of the sums of a whole march is needed; a NaN in one is seen. */
static void test_every_term(void **state)
{
    (void)state;
    static const size_t offsets[] = {
        offsetof(struct br_work, loads[0]),   offsetof(struct br_work, loads[1]),
        offsetof(struct br_work, viscous[0]), offsetof(struct br_work, viscous[1]),
        offsetof(struct br_work, scheme[0]),  offsetof(struct br_work, scheme[1]),
        offsetof(struct br_work, friction),   offsetof(struct br_work, scheme_contact)};
    for (size_t i = 0; staged(i); i++) {
        struct metered m = {.scene = br_test_bundled("chatter")};
        m.method = method_of(staged(i), NULL, &m.scene);
        assert_true(start(&m, 10, 200, NULL));
        advance(&m, 200);
        struct br_energy begin, now;
        struct br_work work;
        br_energy_meter_read(m.meter, &begin, &now, &work);
        AT_MOST(fabs(br_energy_imbalance(&begin, &now, &work)), 1e-13 * br_test_slack());
        for (size_t o = 0; o < sizeof offsets / sizeof *offsets; o++) {
            struct br_work spoilt = work;
            *(double *)((char *)&spoilt + offsets[o]) = 0;
            if (fabs(br_energy_imbalance(&begin, &now, &spoilt)) <= 1e-10)
                fail_msg("%s: term %zu is not needed", staged(i)->name, o);
            *(double *)((char *)&spoilt + offsets[o]) = NAN;
            assert_true(isnan(br_energy_imbalance(&begin, &now, &spoilt)));
        }
        finish(&m);
    }
}

/* The march of one scheme taken for another's. */
static void test_other_scheme(void **state)
{
    (void)state;
    for (size_t i = 0; staged(i); i++)
        for (size_t j = 0; staged(j); j++) {
            if (i == j || staged(i)->adaptive || staged(j)->adaptive)
                continue;
            struct br_error err = {0};
            struct metered m = {.scene = br_test_bundled("chatter")};
            m.method = method_of(staged(j), NULL, &m.scene);
            m.method.contact = br_contact_rule_find("implicit");
            struct br_method is = m.method;
            is.scheme = staged(i);
            m.march = br_test_march(&m.scene, 10, 50, &is);
            m.limit = br_energy_limit(10, br_march_round_off(m.march));
            MUST(br_energy_meter_create(&m.meter, m.march, &m.scene, &m.method, &err));
            advance(&m, 50);
            if (m.worst <= 1)
                fail_msg("a march by %s passed for one by %s", is.scheme->name, staged(j)->name);
            finish(&m);
        }
}

/* ---- what a scheme takes ---- */

/* Undamped, unloaded: what a scheme has taken is what is gone; Euler's by itself, the others of
 * higher order less. bdf3 is refused. */
static void test_free_vibration(void **state)
{
    (void)state;
    double lost[8] = {0};
    for (size_t i = 0; staged(i); i++) {
        struct metered m = {.scene = br_test_bare()};
        struct br_energy begin, now;
        struct br_work work;
        m.scene.axial.viscosity = m.scene.bending.viscosity = 0;
        m.scene.duration = 4; /* one period of the rod */
        m.scene.bending.modelled = false;
        m.scene.axial.displacement = br_test_function("0.1*sin(1.5707963267948966*x)");
        m.method = method_of(staged(i), NULL, &m.scene);
        if (!start(&m, 20, 40, NULL)) {
            assert_true(staged(i)->needs_damping);
            finish(&m);
            continue;
        }
        advance(&m, 40);
        AT_MOST(m.worst, 1);
        br_energy_meter_read(m.meter, &begin, &now, &work);
        lost[i] = work.scheme[BR_AXIAL] / br_energy_total(&begin);
        CLOSE(1 - br_energy_total(&now) / br_energy_total(&begin), lost[i], 1e-13);
        assert_true(lost[i] > 0 && br_energy_added(&work, BR_AXIAL) == 0);
        finish(&m);
    }
    assert_true(lost[0] > 0.5 && lost[1] < 0.2 * lost[0]);
}

/* Contact force of the step before, six times beyond its limit of stability: it adds. */
static void lag(const char *contact, double stiffness, struct br_work *work)
{
    struct metered m = {.scene = br_test_bundled("example2")};
    struct br_energy begin, now;
    m.scene.contact.stiffness = stiffness;
    m.method = br_test_method(NULL, contact, NULL);
    assert_true(start(&m, 20, 1000, NULL));
    advance(&m, 1000);
    AT_MOST(m.worst, 1);
    br_energy_meter_read(m.meter, &begin, &now, work);
    finish(&m);
}

static void test_lagged_contact_adds(void **state)
{
    (void)state;
    struct br_work work;
    lag("lagged", 2e4, &work);
    assert_true(br_energy_added(&work, BR_AXIAL) > 0 && work.gaining[BR_AXIAL] > 100);
    assert_true(work.scheme_contact < 0 && work.scheme[BR_AXIAL] > 0);
    assert_true(br_energy_added(&work, BR_BENDING) == 0);
    CLOSE(br_energy_added(&work, BR_AXIAL), -(work.scheme_contact + work.scheme[BR_AXIAL]), 0);
    lag("implicit", 2e4, &work);
    assert_true(br_energy_added(&work, BR_AXIAL) == 0 && work.gaining[BR_AXIAL] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bundled_scenes), cmocka_unit_test(test_solvers_and_meshes),
        cmocka_unit_test(test_random_scenes),  cmocka_unit_test(test_spoilt_scenes),
        cmocka_unit_test(test_every_term),     cmocka_unit_test(test_other_scheme),
        cmocka_unit_test(test_free_vibration), cmocka_unit_test(test_lagged_contact_adds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
