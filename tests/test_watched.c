/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches that are watched step by step, by certificates and by energy balances. Sound marches pass
 * with every scheme, solver, rule and degree, so that the tables of the literature are those of the
 * solver, whose orders test_schemes measures; a scheme taken for another, a law or a coefficient
 * that is a little off are seen; and what a scheme adds or takes is told. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/certificate/certificate.h"
#include "reference/energy/energy.h"
#include "reference/textbook.h"
#include "solver/linear/linear_solver.h"
#include "solver/march_state.h"
#include "study/scene/file.h"
#include "support.h"

/* ---- marches and what checks them ---- */

struct watched {
    struct br_scene scene;
    struct br_method method;
    struct br_march *march;
    struct br_step_checker *checker;
    struct br_energy_meter *meter;
    struct br_certificate limits;
    double energy_limit;
    double worst;              /* energy balance of a step so far, over its limit */
    struct br_error certified; /* of the first step whose certificate is refused */
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

/* What the references are told, where that is not the truth. */
struct told {
    const struct br_scene *certificate, *energy;
    const struct br_method *method;
};

/* False: the method does not go with the scene. */
static bool start(struct watched *w, size_t n, size_t steps, const struct told *told)
{
    struct told t = told ? *told : (struct told){0};
    const struct br_method *method = t.method ? t.method : &w->method;
    if (br_method_check(&w->method, &w->scene, &err))
        return false;
    const enum br_status status = br_march_create(&w->march, &w->scene, n, steps, &w->method, &err);
    if (status == BR_BAD_INPUT)
        return false;
    br_test_must(status, &err, "a march", __FILE__, __LINE__);
    const double round_off = br_march_round_off(w->march);
    w->limits = br_certificate_limits(method->scheme, n, br_test_slack() * round_off);
    w->energy_limit = br_energy_limit(n, round_off) * br_test_slack();
    MUST(br_step_checker_create(&w->checker, w->march, t.certificate ? t.certificate : &w->scene,
                                method, &err));
    MUST(
        br_energy_meter_create(&w->meter, w->march, t.energy ? t.energy : &w->scene, method, &err));
    return true;
}

/* Up to the end, or where the march ends by itself. */
static void advance(struct watched *w, size_t steps)
{
    for (size_t step = 0; step < steps && !br_march_step(w->march, &err); step++) {
        const struct br_certificate c = br_step_checker_step(w->checker);
        const double over = br_energy_meter_step(w->meter) / w->energy_limit;
        if (isnan(over) || over > w->worst)
            w->worst = over;
        if (!w->certified.status)
            br_certificate_check(&c, &w->limits, &w->certified);
    }
}

static void finish(struct watched *w)
{
    br_energy_meter_free(w->meter);
    br_step_checker_free(w->checker);
    br_march_free(w->march);
    br_scene_clear(&w->scene);
    *w = (struct watched){0};
}

/* Both checks pass all steps; clears it. */
static void passes(struct watched *w, const char *name, size_t n, size_t steps)
{
    const struct br_method *m = &w->method;
    if (start(w, n, steps, NULL))
        advance(w, steps);
    if (w->certified.status || !(w->worst <= 1))
        fail_msg("%s, %s, %s, %s, %s, degree %d, n = %zu, %zu steps: %s; a balance is off by %.3g "
                 "of its limit",
                 name, m->scheme->name, m->solver->name, m->contact->name, m->friction->name,
                 m->axial_degree, n, steps, w->certified.message, w->worst);
    finish(w);
}

/* ---- sound marches ---- */

static void pass_scene(const char *name, const char *solver, int degree, size_t n, size_t steps)
{
    for (size_t i = 0; br_time_schemes[i]; i++) {
        struct watched w = {.scene = br_test_bundled(name)};
        w.method = method_of(br_time_schemes[i], solver, &w.scene);
        w.method.tolerance = 1e-3;
        w.method.axial_degree = degree;
        passes(&w, name, n, steps);
    }
}

TEST(test_bundled_scenes)
{
    char **names;
    size_t count;
    MUST(br_scene_list(&names, &count, &err));
    for (size_t s = 0; s < count; s++) {
        pass_scene(names[s], "riccati", 2, 9, 60);
        if (s % 2 == 0 || br_test_long())
            pass_scene(names[s], "riccati", 1, 1, 30);
        if (s % 3 == 0 || br_test_long())
            pass_scene(names[s], "plain", 1, 7, 60);
        if (s % 3 == 1 || br_test_long())
            pass_scene(names[s], "plain", 2, 40, 20);
    }
    br_scene_list_free(names, count);
}

/* A meter that gives no number for one field: that is the worst of the step, whichever field the
 * other number is of. */
TEST(test_no_number)
{
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct watched w = {.scene = br_test_bundled("example2")};
        w.method = method_of(br_time_schemes[0], NULL, &w.scene);
        struct br_scene other = w.scene;
        other.field[kind].stiffness = NAN;
        assert_true(start(&w, 8, 10, &(struct told){.energy = &other}));
        advance(&w, 10);
        assert_true(isnan(w.worst));
        finish(&w);
    }
}

/* A switch on a time level, as at 0.8 s of Example 3: no step is left that is so short that its
 * force is noise. A load that jumps just behind a switch: the search for that jump does not begin
 * with such a step, either. */
TEST(test_switches)
{
    for (size_t n = 10; n <= 100; n += br_test_long() ? 6 : 18) {
        pass_scene("example3", NULL, 1, n, 100);
        pass_scene("mms_reversal", NULL, 1, n, 100);
    }
}

/* Every rule, from one element to very fine meshes. */
TEST(test_rules_and_meshes)
{
    static const char *const scenes[] = {"example1", "example2", "example3", "example4"};
    static const size_t meshes[] = {1, 2, 7, 100, 400, 3200, 12800};
    for (size_t i = 0; i < 4 * 7 * 2; i++)
        for (size_t rule = 0; br_friction_rules[rule]; rule++) {
            const size_t n = meshes[i / 2 % 7];
            if ((n > 100 && (br_test_quick() || br_friction_rules[rule]->iterates)) ||
                (n > 400 && !br_test_long()))
                continue;
            struct watched w = {.scene = br_test_bundled(scenes[i / 14]),
                                .method = br_method_default()};
            w.method.contact = br_contact_rules[i % 2];
            w.method.friction = br_friction_rules[rule];
            passes(&w, scenes[i / 14], n, 40);
        }
}

TEST(test_solvers_and_meshes)
{
    static const size_t meshes[] = {3, 100, 2000};
    for (size_t i = 0; br_time_schemes[i] && !br_time_schemes[i]->adaptive; i++)
        for (size_t s = 0; br_linear_solvers[s]; s++)
            for (size_t n = 0; n < 3; n++) {
                struct watched w = {.scene = br_test_bundled("heavy_damping")};
                w.method = method_of(br_time_schemes[i], br_linear_solvers[s]->name, &w.scene);
                passes(&w, "heavy_damping", meshes[n], 5);
            }
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

TEST(test_random_scenes)
{
    struct br_test_random random = {20061};
    for (int trial = 0; trial < 300; trial++) {
        struct watched w = {0};
        random_scene(&random, &w.scene);
        const struct br_time_scheme *scheme = br_time_schemes[br_test_index(&random, 7)];
        w.method = method_of(scheme, NULL, &w.scene);
        if (scheme->may_lag && br_test_index(&random, 2))
            w.method.contact = br_contact_rule_find("lagged");
        w.method.axial_degree = 1 + (int)br_test_index(&random, 2);
        passes(&w, "a random scene", 1 + br_test_index(&random, 40), 40);
    }
}

/* A massless rod, with damping or without, goes to where no load holds it, and rests on the gap:
 * what is left of its displacement is round-off of either sign, and so is Coulomb's bound. */
static struct br_scene rod_onto_gap(double viscosity, const char *displacement, double contact)
{
    struct br_scene s = br_test_bare();
    s.density = 0;
    s.duration = 1;
    s.axial.stiffness = 1e4;
    s.axial.viscosity = viscosity;
    s.axial.displacement = br_test_function(displacement);
    s.bending.stiffness = 0;
    s.bending.viscosity = 50;
    s.contact = (struct br_contact){true, 0, contact};
    s.friction = (struct br_friction){.law = BR_COULOMB, .coefficient = 0.02};
    return s;
}

static void pass_onto_gap(struct br_scene scene, double tolerance, size_t n)
{
    struct watched w = {.scene = scene};
    w.method = method_of(br_time_scheme_find("adaptive"), NULL, &w.scene);
    w.method.tolerance = tolerance;
    passes(&w, "a rod that comes to rest on the gap", n, 1);
}

TEST(test_rest_on_gap)
{
    pass_onto_gap(rod_onto_gap(0, "-0.30000000000000004*x", 90), 4.6965672746957507e-08, 1);
    struct br_scene decayed = rod_onto_gap(1, "1e-8*x", 1);
    decayed.bending.stiffness = 100;
    pass_onto_gap(decayed, 1.3525421717258806e-05, 5);
    struct br_scene bent = rod_onto_gap(1, "-0.3*x", 1);
    bent.friction.coefficient = 10;
    bent.bending.tip_force = br_test_function("3*cos(t)");
    pass_onto_gap(bent, 0.0006082310438690992, 5);
}

/* A beam that starts bent, and so heavy that only its tip moves. */
static struct br_scene heavy_scene(double length)
{
    struct br_scene s = br_test_bare();
    char bent[64], slope[64];
    snprintf(bent, sizeof bent, "-2*(x/%g)^2", length);
    snprintf(slope, sizeof slope, "-4*x/%g^2", length);
    s.length = length;
    s.duration = 1;
    s.density = 5e4;
    s.axial.modelled = false;
    s.bending.stiffness = 100;
    s.bending.viscosity = 0;
    s.bending.displacement = br_test_function(bent);
    s.bending.displacement_slope = br_test_function(slope);
    return s;
}

TEST(test_heavy_beams)
{
    static const size_t meshes[] = {1, 20, 21, 40, 59, 100, 150, 200, 400};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++)
        for (double length = 1e3; length < 1e6; length *= 10)
            for (size_t steps = 1; steps <= 100; steps *= 10) {
                struct watched w = {.scene = heavy_scene(length), .method = br_method_default()};
                passes(&w, "a heavy beam", meshes[i], steps);
            }
}

/* To be watched changes nothing. */
TEST(test_watched_is_unwatched)
{
    enum { N = 21, SIZE = 2 * (N + 1) };
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (int solver = 0; solver < 2; solver++) {
            struct watched w = {.scene = br_test_bundled("chatter")};
            double a[2][SIZE], b[2][SIZE];
            w.method = method_of(br_time_schemes[i], solver ? "plain" : "riccati", &w.scene);
            assert_true(start(&w, N, 100, NULL));
            advance(&w, 100);
            OWNED(br_march) *alone = br_test_march(&w.scene, N, 100, &w.method);
            br_test_advance(alone, 100);
            br_march_get(w.march, BR_BENDING, a[0], a[1]);
            br_march_get(alone, BR_BENDING, b[0], b[1]);
            assert_memory_equal(a, b, sizeof a);
            finish(&w);
        }
}

/* ---- what is off is seen ---- */

/* The place of a value of a scene, and by how much it is off where the certificate has to see it:
 * the laws have the tip's last bits, and what an adaptive step may miss at a switch; 0: it need
 * not. The balance has to see one part in ten millions. */
static const struct {
    size_t offset;
    double certificate;
    bool energy;
} values[] = {
    {offsetof(struct br_scene, axial.stiffness), 1e-9, true},
    {offsetof(struct br_scene, axial.viscosity), 1e-9, true},
    {offsetof(struct br_scene, bending.stiffness), 1e-8, true},
    {offsetof(struct br_scene, bending.viscosity), 1e-7, true},
    {offsetof(struct br_scene, contact.stiffness), 1e-10, false},
    {offsetof(struct br_scene, contact.gap), 1e-10, false},
    {offsetof(struct br_scene, friction.coefficient), 1e-10, false},
    {offsetof(struct br_scene, density), 0, true},
    {offsetof(struct br_scene, length), 0, true},
};

static struct br_scene spoilt(const struct br_scene *scene, size_t offset, double by)
{
    struct br_scene out = *scene;
    *(double *)((char *)&out + offset) *= 1 + by;
    return out;
}

/* A contact that the march keeps open while the rod is in the obstacle: all stages are on one
 * branch, and only the law at the end of a step is broken. */
TEST(test_active_branch)
{
    for (size_t i = 0; br_time_schemes[i]; i++) {
        struct watched w = {.scene = br_test_bundled("example2")};
        w.scene.bending.modelled = false;
        w.scene.friction.law = BR_FRICTIONLESS;
        w.scene.contact.gap = 1;
        struct br_scene nearer = w.scene;
        nearer.contact.gap = 0.01;
        w.method = method_of(br_time_schemes[i], NULL, &w.scene);
        assert_true(start(&w, 4, 20, &(struct told){&nearer, NULL, NULL}));
        advance(&w, 20);
        if (!w.certified.status || !strstr(w.certified.message, "(10)"))
            fail_msg("%s: a contact that is kept open passed: %s", w.method.scheme->name,
                     w.certified.message);
        finish(&w);
    }
}

TEST(test_spoilt_scenes)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
            struct watched w = {.scene = br_test_bundled("chatter")};
            const struct br_scene certificate =
                                      spoilt(&w.scene, values[v].offset, values[v].certificate),
                                  energy = spoilt(&w.scene, values[v].offset, 1e-7);
            w.method = method_of(br_time_schemes[i], NULL, &w.scene);
            assert_true(start(&w, 10, 200, &(struct told){&certificate, &energy, NULL}));
            advance(&w, 200);
            if ((values[v].certificate > 0 && !w.certified.status) ||
                (values[v].energy && w.worst <= 1))
                fail_msg("%s: value %zu that is off passed", br_time_schemes[i]->name, v);
            finish(&w);
        }
}

/* Where only the tip moves, round-off hides more, but not much more. */
TEST(test_spoilt_heavy_beams)
{
    static const struct {
        size_t n;
        double by;
    } meshes[] = {{20, 1e-9}, {40, 1e-6}, {59, 4e-6}, {200, 5e-4}};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        struct watched w = {.scene = heavy_scene(1e5), .method = br_method_default()};
        const struct br_scene off =
            spoilt(&w.scene, offsetof(struct br_scene, bending.stiffness), meshes[i].by);
        assert_true(start(&w, meshes[i].n, 2, &(struct told){&off, NULL, NULL}));
        advance(&w, 2);
        if (!w.certified.status)
            fail_msg("n = %zu: a stiffness that is off passed", meshes[i].n);
        finish(&w);
    }
}

static bool same_tables(const struct br_time_scheme *a, const struct br_time_scheme *b)
{
    for (size_t since = 0; since < 3; since++)
        if (br_textbook_step(a->name, since) != br_textbook_step(b->name, since))
            return false;
    return true;
}

/* The march of one scheme taken for another's; the balances of adaptive ones end at switches. */
static void check_other_scheme(const char *scene, const struct br_time_scheme *is,
                               const struct br_time_scheme *other)
{
    struct watched w = {.scene = br_test_bundled(scene)};
    w.method = method_of(is, NULL, &w.scene);
    w.method.contact = br_contact_rule_find("implicit");
    struct br_method method = w.method;
    method.scheme = other;
    assert_true(start(&w, 10, 50, &(struct told){.method = &method}));
    advance(&w, 50);
    if (!w.certified.status || (!is->adaptive && !other->adaptive && w.worst <= 1))
        fail_msg("a march by %s passed for one by %s", is->name, other->name);
    finish(&w);
}

TEST(test_other_scheme)
{
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t j = 0; br_time_schemes[j]; j++)
            if (!same_tables(br_time_schemes[i], br_time_schemes[j])) {
                check_other_scheme("chatter", br_time_schemes[i], br_time_schemes[j]);
            }
}

/* ---- stages that the checker is shown, a little off ---- */

/* Stands between a march and its checker. */
struct spoiler {
    struct br_march *march;
    struct br_march_watcher checker;
    void (*spoil)(struct spoiler *s, struct br_march_stage *stage);
};

static void later(struct spoiler *s, struct br_march_stage *stage)
{
    (void)s;
    stage->time += 1e-8 * stage->k;
}

static void begun_later(struct spoiler *s, struct br_march_stage *stage)
{
    (void)s;
    stage->from += 1e-8 * stage->k;
    stage->time += 1e-8 * stage->k;
}

static void longer(struct spoiler *s, struct br_march_stage *stage)
{
    (void)s;
    stage->tau *= 1 + 1e-8;
}

/* Only a stage within the step. */
static void pushes_more(struct spoiler *s, struct br_march_stage *stage)
{
    if (stage->index == 1 && stage->count > 2)
        s->march->tip.contact_force *= 1 + 1e-6;
}

/* The first stage is on another branch than those that follow, which obey the law. */
static void lets_go(struct spoiler *s, struct br_march_stage *stage)
{
    if (stage->index == 0)
        s->march->tip.contact_force = 0;
}

static void pushes_and_rubs_more(struct spoiler *s, struct br_march_stage *stage)
{
    (void)stage;
    s->march->tip.contact_force *= 1 + 1e-3;
    s->march->tip.friction_force *= 1 + 1e-3;
}

static void show(void *self, const struct br_march_stage *stage)
{
    struct spoiler *s = self;
    struct br_march_stage shown = *stage;
    const struct br_tip tip = s->march->tip;
    s->spoil(s, &shown);
    s->checker.stage(s->checker.self, &shown);
    s->march->tip = tip;
}

static void accept(void *self, enum br_field_kind kind, bool switched)
{
    const struct spoiler *s = self;
    s->checker.step(s->checker.self, kind, switched);
}

/* The largest entries of the certificates of a march whose checker is shown something else. */
static struct br_certificate worst_of(const struct br_method *method,
                                      void (*spoil)(struct spoiler *s,
                                                    struct br_march_stage *stage))
{
    struct watched w = {.scene = br_test_bundled("chatter"), .method = *method};
    struct br_certificate worst = {0};
    assert_true(start(&w, 10, 200, NULL));
    struct spoiler s = {w.march, w.march->watcher[0], spoil};
    w.march->watcher[0] = (struct br_march_watcher){&s, show, accept};
    for (int step = 0; step < 200; step++) {
        MUST(br_march_step(w.march, &err));
        const struct br_certificate c = br_step_checker_step(w.checker);
        br_certificate_merge(&worst, &c);
        assert_true(isnan(br_step_checker_step(w.checker).update)); /* no step since */
    }
    finish(&w);
    return worst;
}

/* Where the scheme keeps a branch, all its stages are on the same one. */
TEST(test_one_branch)
{
    struct br_method m = br_test_method(NULL, "implicit", NULL);
    m.tolerance = 1e-3;
    m.scheme = br_time_scheme_find("adaptive");
    const double worst = worst_of(&m, lets_go).contact;
    if (!(worst > 1e-3))
        fail_msg("a contact that lets go within steps is off by %g", worst);
}

/* Forces that are a thousandth off are said to be so, whatever the solver leaves by itself. */
TEST(test_size_of_an_error)
{
    for (size_t i = 0; br_linear_solvers[i]; i++) {
        struct br_method m = br_test_method(br_linear_solvers[i]->name, "implicit", NULL);
        struct br_certificate c = worst_of(&m, pushes_and_rubs_more);
        const double *entry = br_certificate_entries(&c);
        const double least[] = {1e-4, 1e-4, 0, 1e-5,
                                1e-5}; /* a share of the terms, or of the scale */
        for (size_t e = 0; e < BR_CERTIFICATE_ENTRIES; e++)
            if (!(entry[e] >= least[e] && entry[e] <= 1e-3))
                fail_msg("%s: entry %zu is %g", m.solver->name, e, entry[e]);
    }
}

TEST(test_spoilt_stages)
{
    static const struct {
        void (*spoil)(struct spoiler *s, struct br_march_stage *stage);
        int stages; /* that the scheme needs */
    } cases[] = {{later, 1}, {begun_later, 1}, {longer, 1}, {pushes_more, 3}};
    for (size_t i = 0; br_time_schemes[i]; i++)
        for (size_t j = 0; j < sizeof cases / sizeof *cases; j++) {
            struct watched w = {.scene = br_test_bundled("chatter")};
            w.method = method_of(br_time_schemes[i], NULL, &w.scene);
            assert_true(start(&w, 10, 200, NULL));
            struct spoiler s = {w.march, w.march->watcher[0], cases[j].spoil};
            assert_ptr_equal(s.checker.self, w.checker);
            w.march->watcher[0] = (struct br_march_watcher){&s, show, accept};
            advance(&w, 200);
            const bool can = br_time_schemes[i]->adaptive ||
                             br_time_scheme_stages(br_time_schemes[i]) >= cases[j].stages;
            if (!w.certified.status == can)
                fail_msg("%s: case %zu: '%s'", br_time_schemes[i]->name, j, w.certified.message);
            finish(&w);
        }
}

TEST(test_refusals)
{
    struct br_step_checker *checker;
    struct watched w = {.scene = br_test_bundled("release"), .method = br_method_default()};
    const struct br_time_scheme unknown = {.name = "unknown"};
    assert_true(start(&w, 4, 10, NULL));
    struct br_method method = w.method;
    method.scheme = &unknown;
    REFUSED(br_step_checker_create(&checker, w.march, &w.scene, &method, &err), BR_BAD_INPUT,
            "scheme unknown has no certificate");
    assert_null(checker);
    assert_null(br_textbook_step("unknown", 0));
    const struct br_certificate none = br_step_checker_step(w.checker);
    assert_true(isnan(none.update) && isnan(none.bending_residual));
    finish(&w);
}

/* ---- the sums of a whole march ---- */

/* Each term of the sums of a whole march is needed; a NaN in one is seen. */
TEST(test_every_term)
{
    static const size_t offsets[] = {
        offsetof(struct br_work, loads[0]),   offsetof(struct br_work, loads[1]),
        offsetof(struct br_work, viscous[0]), offsetof(struct br_work, viscous[1]),
        offsetof(struct br_work, scheme[0]),  offsetof(struct br_work, scheme[1]),
        offsetof(struct br_work, friction),   offsetof(struct br_work, scheme_contact)};
    for (size_t i = 0; br_time_schemes[i]; i++) {
        struct watched m = {.scene = br_test_bundled("chatter")};
        m.method = method_of(br_time_schemes[i], NULL, &m.scene);
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
                fail_msg("%s: term %zu is not needed", br_time_schemes[i]->name, o);
            *(double *)((char *)&spoilt + offsets[o]) = NAN;
            assert_true(isnan(br_energy_imbalance(&begin, &now, &spoilt)));
        }
        finish(&m);
    }
}

/* Contact force of the step before, six times beyond its limit of stability: it adds. */
static void lag(const char *contact, double stiffness, struct br_work *work)
{
    struct watched m = {.scene = br_test_bundled("example2")};
    struct br_energy begin, now;
    m.scene.contact.stiffness = stiffness;
    m.method = br_test_method(NULL, contact, NULL);
    assert_true(start(&m, 20, 1000, NULL));
    advance(&m, 1000);
    AT_MOST(m.worst, 1);
    br_energy_meter_read(m.meter, &begin, &now, work);
    finish(&m);
}

TEST(test_lagged_contact_adds)
{
    struct br_work work;
    lag("lagged", 2e4, &work);
    assert_true(br_energy_added(&work, BR_AXIAL) > 0 && work.gaining[BR_AXIAL] > 100);
    assert_true(work.scheme_contact < 0 && work.scheme[BR_AXIAL] > 0);
    assert_true(br_energy_added(&work, BR_BENDING) == 0);
    CLOSE(br_energy_added(&work, BR_AXIAL), -(work.scheme_contact + work.scheme[BR_AXIAL]), 0);
    lag("implicit", 2e4, &work);
    assert_true(br_energy_added(&work, BR_AXIAL) == 0 && work.gaining[BR_AXIAL] == 0);
    work.scheme_contact = NAN;
    assert_true(isnan(br_energy_added(&work, BR_AXIAL)));
}
