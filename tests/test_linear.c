/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear solvers one by one: what schemes of more than an Euler step ask of them, their
 * kernels, what they refuse, and a symmetry to the last bit. That marches by them are right is in
 * test_extreme_marches. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/function.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "support.h"

enum { STEPS = 30, MOST_N = 60, MOST_SIZE = 2 * (MOST_N + 1) };

/* One field, a load that changes in time, and a tip force. */
struct problem {
    struct br_field field;
    double vector[MOST_SIZE], force;
};

static struct problem random_problem(struct br_test_random *r)
{
    const size_t n = 1 + br_test_index(r, MOST_N);
    struct problem p = {
        .field = {.kind = br_test_index(r, 2) ? BR_BENDING : BR_AXIAL,
                  .n = n,
                  .h = br_test_log_uniform(r, 0.3, 3) / (double)n,
                  .density = br_test_log_uniform(r, 1e-3, 10),
                  .stiffness = br_test_log_uniform(r, 0.1, 1000),
                  .viscosity = br_test_log_uniform(r, 1e-3, 100),
                  .k = br_test_log_uniform(r, 1e-4, 0.1)},
        .force = br_test_uniform(r, -1, 1),
    };
    p.field.degree = 1 + (p.field.kind == BR_AXIAL && br_test_index(r, 2));
    /* 1 + x^2, lumped */
    for (size_t i = 1, u = br_field_unknowns(&p.field); i <= p.field.n; i++)
        p.vector[i * u] = p.field.h * (1 + pow((double)i * p.field.h, 2));
    return p;
}

/* NULL: the solver has none for elements of that degree. */
static const struct br_field_solver *functions(const struct br_linear_solver *solver,
                                               const struct problem *p)
{
    return br_linear_solver_for(solver, &p->field);
}

static void *created(const struct br_linear_solver *solver, const struct problem *p)
{
    void *self;
    MUST(functions(solver, p)->create(&p->field, NULL, &self, &err));
    return self;
}

/* Step number `step` >= 1. */
static void take_step(const struct br_field_solver *f, void *self, const struct problem *p,
                      size_t step)
{
    const struct br_drive drive = {
        .vector = p->vector, .factor = cos((double)step), .changed = step == 1};
    double velocity;
    MUST(f->predict(self, &drive, &velocity, &err));
    assert_true(isfinite(f->finish(self, p->force)));
}

static void march(const struct br_field_solver *f, void *self, const struct problem *p,
                  size_t first, size_t last)
{
    for (size_t step = first; step <= last; step++)
        take_step(f, self, p, step);
}

/* ---- lengths of steps, and sizes of states ---- */

/* Walks the registry. */
#define EACH_SOLVER(s) (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)

static void same_bits(const struct br_field_solver *f, const void *a, const void *b,
                      const struct problem *p)
{
    double w[2][MOST_SIZE], v[2][MOST_SIZE];
    const size_t bytes = br_field_size(&p->field) * sizeof(double);
    f->get(a, w[0], v[0]);
    f->get(b, w[1], v[1]);
    assert_memory_equal(w[0], w[1], bytes);
    assert_memory_equal(v[0], v[1], bytes);
}

/* To another k and back, and there: as fresh solvers do. */
static void check_step_lengths(const struct br_linear_solver *solver, const struct problem *p)
{
    const struct br_field_solver *f = functions(solver, p);
    struct problem other = *p;
    other.field.k *= 0.29;
    void *moved = created(solver, p), *fresh = created(solver, p);
    void *there = created(solver, &other);
    const double compliance = f->tip_compliance(moved);
    MUST(f->set_step(moved, other.field.k, &err));
    assert_true(f->tip_compliance(moved) == f->tip_compliance(there));
    march(f, moved, p, 1, STEPS);
    march(f, there, p, 1, STEPS);
    same_bits(f, moved, there, p);

    static const double rest[MOST_SIZE];
    f->set(moved, rest, rest);
    MUST(f->set_step(moved, p->field.k, &err));
    assert_true(f->tip_compliance(moved) == compliance);
    march(f, moved, p, 1, STEPS);
    march(f, fresh, p, 1, STEPS);
    same_bits(f, moved, fresh, p);
    f->free(moved);
    f->free(fresh);
    f->free(there);
}

TEST(test_step_lengths)
{
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct br_test_random r = {seed};
        const struct problem p = random_problem(&r);
        for (size_t i = 0; br_linear_solvers[i]; i++)
            if (functions(br_linear_solvers[i], &p))
                check_step_lengths(br_linear_solvers[i], &p);
    }
}

/* Nodal values (out) of u = x^2 or w = x^3; a bubble of h^2 makes the one on elements exact. */
static void fill_powers(const struct br_field *f, double *nodal)
{
    const size_t d = br_field_unknowns(f);
    for (size_t i = 1; i <= f->n; i++) {
        const double x = (double)i * f->h;
        nodal[d * i] = f->kind == BR_BENDING ? x * x * x : x * x;
        if (d == 2)
            nodal[2 * i + 1] = f->kind == BR_BENDING ? f->h * 3 * x * x : f->h * f->h;
    }
}

/* On L = 3: u_x = 2 x, its mean on each of 12 linear elements; w_xx = 6 x. */
static void check_size(const struct br_linear_solver *solver, enum br_field_kind kind, int degree)
{
    const struct problem p = {.field = {.kind = kind,
                                        .n = 12,
                                        .h = 0.25,
                                        .density = 1,
                                        .stiffness = 2,
                                        .viscosity = 3,
                                        .k = 0.1,
                                        .degree = degree}};
    const double whole = kind == BR_AXIAL ? 36 : 324, lost = 3 * 0.25 * 0.25 / 3;
    const double expected = sqrt(kind == BR_AXIAL && degree == 1 ? whole - lost : whole);
    const struct br_field_solver *f = functions(solver, &p);
    double w[MOST_SIZE] = {0}, v[MOST_SIZE], size[2];
    if (!f || !f->size)
        return;
    fill_powers(&p.field, w);
    for (size_t i = 0; i < br_field_size(&p.field); i++)
        v[i] = -7 * w[i];
    void *self = created(solver, &p);
    f->set(self, w, v);
    f->size(self, 0, size);
    CLOSE(size[0], expected, 1e-12 * expected);
    CLOSE(size[1], 7 * expected, 7e-12 * expected);
    f->free(self);
}

TEST(test_size)
{
    for
        EACH_SOLVER(s)
        {
            check_size(*s, BR_AXIAL, 1);
            check_size(*s, BR_AXIAL, 2);
            check_size(*s, BR_BENDING, 1);
        }
}

/* ---- refusals ---- */

static void refuses(const struct problem *p, const char *text)
{
    void *self;
    const struct br_field_solver *f = functions(&br_umfpack, p);
    REFUSED(f->create(&p->field, NULL, &self, &err), BR_SINGULAR, text);
    assert_ptr_equal(strstr(err.message, "umfpack"), err.message);
    f->free(self);
}

TEST(test_refusals)
{
    for (uint64_t seed = 1; seed <= 40; seed++) {
        struct br_test_random r = {seed};
        struct problem p = random_problem(&r);
        p.field.degree = 1;
        void *self = created(&br_umfpack, &p);
        REFUSED(functions(&br_umfpack, &p)->set_step(self, NAN, &err), BR_SINGULAR,
                "the matrix has an entry");
        functions(&br_umfpack, &p)->free(self);
        p.field.density = 1e-9;
        p.field.viscosity = -1e4; /* heavier than k times any stiffness */
        refuses(&p, "not positive definite");
        p.field.viscosity = NAN;
        refuses(&p, "the matrix has an entry nan, expected numbers");
        p.field.viscosity = 1;
        p.field.density = INFINITY;
        refuses(&p, "the matrix has an entry inf, expected numbers");
    }
}

/* A mesh whose matrix has no digits left. */
TEST(test_too_fine)
{
    const struct problem p = {.field = {.kind = BR_BENDING,
                                        .n = 150000,
                                        .h = 1.0 / 150000,
                                        .density = 1,
                                        .stiffness = 1000,
                                        .viscosity = 1,
                                        .k = 1e-2}};
    refuses(&p, "too ill-conditioned");
}

static void refuses_march(const struct br_scene *scene, const struct br_method *method, size_t n,
                          size_t steps, const char *text)
{
    struct br_march *march;
    REFUSED(br_march_create(&march, scene, n, steps, method, &err), BR_BAD_INPUT, text);
    assert_null(march);
}

/* A new row without costs is the solver that it says, its marches are not free, and no other one
 * takes the elements that it has not. */
TEST(test_new_row)
{
    const struct br_linear_solver row = {
        .name = "mine", .axial = &br_plain_form, .round_off = br_plain.round_off};
    const struct br_field rod = {.kind = BR_AXIAL, .n = 100, .h = 0.01};
    struct br_scene scene = br_test_bare();
    struct br_method method = br_method_default();
    method.solver = &row;
    assert_ptr_equal(br_linear_solver_taken(&row, &rod, 0), &row);
    CLOSE(br_linear_solver_cost(&row, &rod, 1), br_linear_solver_cost(&br_plain, &rod, 1), 0);
    refuses_march(&scene, &method, 4, 4, "'mine' has no bending elements, expected one of riccati");
    method.axial_degree = 2;
    refuses_march(&scene, &method, 4, 4, "'mine' has no quadratic axial elements, expected");
}

TEST(test_marches_refused)
{
    struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method("umfpack", "implicit", NULL);
    method.axial_degree = 2;
    refuses_march(&scene, &method, 4, 4,
                  "'umfpack' has no quadratic axial elements, expected one of riccati, plain");
    method = br_method_default();
    refuses_march(&scene, &method, 0, 4, "n is 0");
    refuses_march(&scene, &method, 4, 0, "no time steps");
    scene.friction.law = BR_TRESCA;
    method.friction = br_friction_rule_find("regularised");
    refuses_march(&scene, &method, 4, 4, "mu > 0");
    scene.bending.stiffness = scene.bending.viscosity = 0;
    scene.friction.law = BR_FRICTIONLESS;
    refuses_march(&scene, &method, 4, 4, "stiffness plus viscosity is 0");
    for (method.axial_degree = 0; method.axial_degree <= 3; method.axial_degree += 3)
        refuses_march(&scene, &method, 4, 4, "expected 1 or 2");
}

/* A load that is no number, and a march that blows up, are told at once. */
TEST(test_not_finite)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++) {
        struct br_method method = br_method_default();
        method.solver = *s;
        struct br_scene scene = br_test_bare();
        scene.bending.load = (struct br_load){.term[0].space = {.constant = 1},
                                              .term[0].time = br_test_function("sqrt(0.55 - t)")};
        struct br_march *march = br_test_march(&scene, 3, 10, &method);
        br_test_advance(march, 5);
        REFUSED(br_march_step(march, &err), BR_NOT_FINITE, "t = 0.59999999999999998 s");
        br_march_free(march);
        br_scene_clear(&scene);

        scene = br_test_bare();
        scene.bending.tip_moment = br_test_function("1/(1-t)");
        march = br_test_march(&scene, 3, 1, &method);
        REFUSED(br_march_step(march, &err), BR_NOT_FINITE, "the tip moment is inf at t = 1 s");
        br_march_free(march);
        br_scene_clear(&scene);
        scene = br_test_bare(); /* unstable: the lagged contact, without viscosity */
        scene.duration = 1000;
        scene.axial.viscosity = 0;
        scene.axial.load = br_test_load("1");
        scene.contact = (struct br_contact){.modelled = true, .gap = 0.1, .stiffness = 1000};
        march = br_test_march(&scene, 4, 800, &method);
        enum br_status status = BR_OK;
        while (!status && br_march_steps_done(march) < 800)
            status = br_march_step(march, &err);
        REFUSED(status, BR_NOT_FINITE, "the march blew up at t = ");
        assert_non_null(strstr(err.message, "of 800, k = 1.25 s): the axial "));
        br_march_free(march);
        br_scene_clear(&scene);
    }
}

/* ---- symmetry ---- */

/* A rigid motion has no curvature, to the last bit where it is a binary number. */
TEST(test_rigid_motion)
{
    double curvature[2];
    br_curvature((const double[]){0.75, 0.5, 1.25, 0.5}, curvature);
    assert_true(curvature[0] == 0 && curvature[1] == 0);
    br_curvature((const double[]){0, 0, 0.5, 1}, curvature); /* xi^2 / 2 */
    assert_true(curvature[0] == 1 && curvature[1] == 0);
    br_curvature((const double[]){0, 0, 1, 3}, curvature); /* xi^3: 6 xi = 3 + 3 (2 xi - 1) */
    assert_true(curvature[0] == 3 && curvature[1] == 3);
}

/* Nodal values of two marches of the same mesh, the second times `factor`, bit for bit. */
static void assert_same_bits(const struct br_march *a, const struct br_march *b,
                             enum br_field_kind kind, double factor)
{
    double w[2][MOST_SIZE], v[2][MOST_SIZE];
    br_march_get(a, kind, w[0], v[0]);
    br_march_get(b, kind, w[1], v[1]);
    for (size_t i = 0; i < br_field_size(br_march_field(a, kind)); i++)
        assert_true(w[0][i] == factor * w[1][i] && v[0][i] == factor * v[1][i]);
}

/* The transverse load turned round: the solution turned round, to the last bit. */
TEST(test_mirrored)
{
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        for (size_t rule = 0; br_friction_rules[rule]; rule++) {
            struct br_method method = br_method_default();
            method.solver = *s;
            method.friction = br_friction_rules[rule];
            struct br_scene scene[2];
            struct br_march *march[2];
            for (int i = 0; i < 2; i++) {
                scene[i] = br_test_bundled("example2");
                br_function_free(&scene[i].bending.load.term[0].time);
                scene[i].bending.load.term[0].time = br_test_function("2000*sin(9*t)");
                scene[i].bending.load.term[0].space.constant = i ? -1 : 1;
                scene[i].friction.regularisation = 1e-3;
                march[i] = br_test_march(&scene[i], 17, 100, &method);
                br_test_advance(march[i], 100);
            }
            assert_same_bits(march[0], march[1], BR_BENDING, -1);
            assert_same_bits(march[0], march[1], BR_AXIAL, 1);
            assert_true(br_march_tip(march[0])->friction_force ==
                        -br_march_tip(march[1])->friction_force);
            assert_true(fabs(br_march_tip(march[0])->friction_force) > 0);
            for (int i = 0; i < 2; i++) {
                br_march_free(march[i]);
                br_scene_clear(&scene[i]);
            }
        }
}

/* ---- kernels that are asked for ---- */

static bool never(void)
{
    return false;
}

/* One that the machine has not is refused, not run. */
TEST(test_unavailable)
{
    const struct br_kernel none = {.name = "none", .available = never};
    const struct br_scene scene = br_test_bare();
    struct br_method method = br_test_method("riccati", NULL, NULL);
    method.kernel = &none;
    refuses_march(&scene, &method, 9, 4, "kernel none is not available on this machine");
}

static size_t steps_counted;

static bool always(void)
{
    return true;
}

static void count_step(const struct br_segments *segments, const struct br_segment_drive *drive,
                       const struct br_segment_ends *ends)
{
    steps_counted++;
    br_kernel_find("portable")->loops[BR_AXIAL]->advance(segments, drive, ends);
}

/* The one that is asked for does the work. */
TEST(test_heeded)
{
    struct br_kernel counting = *br_kernel_find("portable");
    struct br_loops loops = *counting.loops[BR_AXIAL];
    counting.name = "counting";
    counting.available = always;
    counting.loops[BR_AXIAL] = &loops;
    loops.advance = count_step;
    struct br_scene scene = br_test_bare();
    scene.bending.modelled = false;
    struct br_method method = br_test_method("riccati", NULL, NULL);
    method.kernel = &counting;
    OWNED(br_march) *march = br_test_march(&scene, 7, 4, &method);
    br_test_advance(march, 4);
    assert_true(steps_counted >= 4);
}

/* ---- the choice ---- */

/* The linear solver that is taken for n elements. */
static const struct br_linear_solver *taken(enum br_field_kind kind, size_t n, int degree,
                                            const struct br_time_scheme *scheme)
{
    const struct br_scene scene = br_test_bare();
    struct br_method method = br_method_default();
    const struct br_field field = br_field_of_scene(&scene, kind, n, 1e-3, degree);
    method.scheme = scheme;
    assert_ptr_equal(method.solver, &br_auto);
    return br_method_solver(&method, &field);
}

static void check_least(enum br_field_kind kind, size_t n, int degree,
                        const struct br_time_scheme *scheme)
{
    const double sums = br_time_scheme_sums(scheme);
    const struct br_field field = {.kind = kind, .n = n, .h = 1, .degree = degree};
    const struct br_linear_solver *best = taken(kind, n, degree, scheme);
    assert_non_null(br_linear_solver_for(best, &field));
    for
        EACH_SOLVER(s)
        {
            if (!br_linear_solver_chooses(*s) && br_linear_solver_for(*s, &field))
                AT_MOST(br_linear_solver_cost(best, &field, sums),
                        br_linear_solver_cost(*s, &field, sums));
        }
}

/* What costs least is taken: on coarse meshes plain, on those of the paper's tables riccati. */
TEST(test_taken)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        for (size_t n = 1; n < 3000; n += 1 + n / 7) {
            check_least(BR_AXIAL, n, 1, *s);
            check_least(BR_AXIAL, n, 2, *s);
            check_least(BR_BENDING, n, 1, *s);
        }
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        for (size_t n = 1; n <= 32; n++)
            assert_ptr_equal(taken(kind, n, 1, br_time_schemes[0]), &br_plain);
        for (size_t n = 100; n <= 102400; n *= 2)
            assert_ptr_equal(taken(kind, n, 1, br_time_schemes[0]), &br_riccati);
    }
    assert_true(br_time_scheme_sums(br_time_schemes[0]) == 0);
    assert_true(br_time_scheme_sums(br_time_scheme_find("bdf2")) == 1.4);
}

/* It is the solver that is taken, to the last bit. */
TEST(test_same_as_taken)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    const size_t n[] = {8, 100};
    for (int i = 0; i < 2; i++) {
        const struct br_method chosen = br_method_default(),
                               named = br_test_method(i ? "riccati" : "plain", NULL, NULL);
        const struct br_test_end a = br_test_run(&scene, n[i], 20, &chosen),
                                 b = br_test_run(&scene, n[i], 20, &named);
        assert_memory_equal(&a, &b, sizeof a);
        assert_true(a.u_tip != 0 && a.w_tip != 0);
    }
}
