/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference under loads that are short in x or t, that jump, or whose fronts move,
 * without inertia, against closed forms; and its elements against one. With inertia: test_blows. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "reference/exact/field.h"
#include "reference/exact/pieces.h"
#include "tests/exact_scenes.h"
#include "tests/support.h"

/* Room for a text that is made from numbers. */
struct text {
    char s[400];
};

#define TEXT(...)                                 \
    ({                                            \
        struct text t_;                           \
        snprintf(t_.s, sizeof t_.s, __VA_ARGS__); \
        t_;                                       \
    })

static struct br_scene rod(double density, double viscosity)
{
    return (struct br_scene){
        .length = 2.5,
        .duration = 3,
        .density = density,
        .axial = {.modelled = true, .stiffness = 7, .viscosity = viscosity},
    };
}

static struct br_scene beam(double density, double viscosity)
{
    return (struct br_scene){
        .length = 0.4,
        .duration = 2,
        .density = density,
        .bending = {.modelled = true, .stiffness = 5, .viscosity = viscosity},
    };
}

/* Solves a scene whose velocities may be less certain than `solve` wants them. */
static struct br_exact *solve_sharp(const struct br_scene *scene)
{
    struct br_exact *exact = NULL;
    struct br_error err = {0};
    const struct br_exact_options options = {.acceptable = 1e-5};
    MUST(br_exact_create(&exact, scene, &options, &err));
    return exact;
}

/* How far the tip may be off: what the solution says of itself, which must be small. */
static double allowed(const struct br_exact *exact, enum br_exact_field field, double relative)
{
    const struct br_exact_report report = br_exact_report(exact, field);
    AT_MOST(report.error.displacement / report.largest.displacement, relative);
    return report.error.displacement + 1e-13 * report.largest.displacement;
}

static struct br_load load_of(struct text text)
{
    return br_test_load(text.s);
}

/* ---- patches, without inertia: a shape times 1 - e^{-a t / c} ---- */

/* Displacement of a rod at x under 1 N/m on [p, q], times the stiffness. */
static double rod_shape(double p, double q, double x)
{
    if (x <= p)
        return (q - p) * x;
    const double in = fmin(x, q) - p; /* the force falls over the patch */
    return (q - p) * p + (q - p) * in - in * in / 2;
}

/* Deflection of a cantilever's tip, times the stiffness. */
static double beam_tip(double length, double p, double q)
{
    const long double a = p, b = q, h = b - a;
    const long double cubes = h * (a * a + a * b + b * b);
    const long double fourths = h * (a + b) * (a * a + b * b);
    return (double)((length * cubes - fourths / 4) / 6);
}

static void check_rod_patch(double place, double width)
{
    struct br_scene s = rod(0, 0.7);
    const double p = place * s.length, q = p + width * s.length, amplitude = -3 / (q - p);
    s.axial.load = load_of(TEXT("%.17g*step(x-%.17g)*step(%.17g-x)", amplitude, p, q));
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    const struct br_exact_part part = {BR_EXACT_AXIAL, false, 0};
    for (int n = 1; n <= 10; n++) {
        br_exact_at(exact, s.duration * n / 10, state);
        const double rise = -expm1(-10 * state->time) * amplitude / 7;
        const double tip = rise * rod_shape(p, q, s.length);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement, tip, 1e-10 * fabs(tip));
        for (int i = 0; i <= 8; i++) {
            const double x = s.length * i / 8;
            assert_near(value_of(exact, state, part, x), rise * rod_shape(p, q, x),
                        1e-10 * fabs(tip));
        }
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

static void check_beam_patch(double place, double width)
{
    struct br_scene s = beam(0, 0.25);
    const double p = place * s.length, q = p + width * s.length, amplitude = 20 / (q - p);
    s.bending.load = load_of(TEXT("%.17g*step(x-%.17g)*step(%.17g-x)", amplitude, p, q));
    struct br_exact *exact = solve(&s, 1e-10);
    struct br_exact_state *state = new_state(exact);
    for (int n = 1; n <= 10; n++) {
        br_exact_at(exact, s.duration * n / 10, state);
        const double tip = -expm1(-20 * state->time) * amplitude / 5 * beam_tip(s.length, p, q);
        assert_near(state->tip[BR_EXACT_BENDING].displacement, tip, 1e-10 * fabs(tip));
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

TEST(test_patches)
{
    static const double place[] = {0.1234567, 0.9}, width[] = {0.1, 1e-4, 1e-8};
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; j < 3; j++) {
            check_rod_patch(place[i], width[j]);
            check_beam_patch(place[i], width[j]);
        }
}

/* A peak of unit area: of its integral nothing may be lost, wherever it is. */
TEST(test_peaks)
{
    for (double width = 0.01; width > 0.9e-8; width /= 100) {
        struct br_scene s = rod(0, 0.7);
        const double x = 0.71 * s.length, w = width * s.length;
        s.axial.load = load_of(TEXT("-3/sqrt(pi)/%.17g*exp(-((x-%.17g)/%.17g)^2)", w, x, w));
        struct br_exact *exact = solve(&s, 1e-10);
        struct br_exact_state *state = new_state(exact);
        br_exact_at(exact, 1.5, state);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement / (3 * expm1(-15) * x / 7), 1, 1e-9);
        br_exact_state_free(state);
        br_exact_free(exact);
        br_scene_clear(&s);
    }
}

/* ---- a front ---- */

/* A load of -3 N/m on all x < 2 t of a rod without inertia: c u' + a u = -3 (2 t)^2 / 2 at the tip
 * until the front leaves. */
TEST(test_front)
{
    struct br_scene s = rod(0, 0.7);
    s.axial.load = load_of(TEXT("-3*step(2*t-x)"));
    struct br_exact *exact = solve_sharp(&s);
    struct br_exact_state *state = new_state(exact);
    for (int n = 0; n <= 20; n++) {
        br_exact_at(exact, s.duration * n / 20, state);
        const double r = 10, t = fmin(state->time, 1.25), later = state->time - t;
        const double ramp = 2 * (t * t - 2 * t / r + 2 / (r * r) - 2 / (r * r) * exp(-r * t));
        const double tip = -3.0 / 7 * (later > 0 ? 3.125 + (ramp - 3.125) * exp(-r * later) : ramp);
        assert_near(state->tip[BR_EXACT_AXIAL].displacement, tip,
                    allowed(exact, BR_EXACT_AXIAL, 1e-6));
    }
    br_exact_state_free(state);
    br_exact_free(exact);
    br_scene_clear(&s);
}

/* ---- the elements themselves ---- */

enum { PIECES = 4 };
static const double piece_end[] = {0, 0.75, 0.75 + 2.5e-8, 1.9, 2.5};
static const size_t piece_terms[] = {12, 4, 12, 12};

static struct br_pieces new_pieces(struct br_store *store)
{
    struct br_pieces pieces;
    br_pieces_init(&pieces, 2.5, PIECES, piece_end, piece_terms, store);
    assert_false(store->failed);
    return pieces;
}

/* A narrow element costs no digits: textbook frequencies and tips, as on one element. */
TEST(test_modes_on_pieces)
{
    struct br_error err = {0};
    const double beta[] = {1.875104068711961166445, 4.694091132974174576436,
                           7.854757438237612564861};
    struct br_store store = {0};
    struct br_modes rod = {.pieces = new_pieces(&store)}, cantilever = {.pieces = rod.pieces};
    MUST(br_modes_init(&rod, 1, &store, &err));
    MUST(br_modes_init(&cantilever, 2, &store, &err));
    for (size_t i = 0; i < 3; i++) {
        assert_near(rod.size[i], 1 / (((double)i + 0.5) * acos(-1)), 1e-15);
        assert_near(fabs(rod.tip[i]), sqrt(2) * rod.size[i], 1e-14);
        assert_near(cantilever.size[i], 1 / (beta[i] * beta[i]), 1e-15);
        assert_near(fabs(cantilever.tip[i]), 2 * cantilever.size[i], 1e-14);
    }
    br_store_clear(&store);
}

/* The integral from 0 in x / L of -1 on the pieces before `kink` and 1 on the others. */
static void fill_kink(const struct br_pieces *pieces, size_t kink, double *series)
{
    memset(series, 0, 40 * sizeof *series);
    for (size_t e = 0; e < PIECES; e++)
        series[br_pieces_at(pieces, e, 0)] = (e < kink ? -1 : 1) * sqrt(br_pieces_width(pieces, e));
    br_pieces_integrate(pieces, 0, series);
}

/* |x - a| - a, in x / L, over meshes whose elements the pieces' ends cut: its mean over each
 * element, and its square over all. */
TEST(test_projection_of_pieces)
{
    struct br_error err = {0};
    static const size_t elements[] = {1, 3, 10, 97};
    struct br_store store = {0};
    const struct br_pieces pieces = new_pieces(&store);
    double series[40];
    fill_kink(&pieces, 3, series);
    const double a = piece_end[3] / 2.5, b = 1 - a;
    const double square = 2.5 * (a * a * a / 3 + (b * b * b - 3 * a * b * b + 3 * a * a * b) / 3);
    for (size_t i = 0; i < 4; i++) {
        const struct br_exact_mesh mesh = {elements[i], 2};
        const double n = (double)mesh.elements;
        struct br_piecewise *piecewise = NULL;
        double c[3 * 97], rest = NAN, sum = 0;
        MUST(br_piecewise_create(&piecewise, &pieces, 1, &mesh, &store, &err));
        br_piecewise_apply(piecewise, series, c, &rest);
        for (size_t j = 0; j < mesh.elements; j++) {
            const double left = (double)j / n - a, right = ((double)j + 1) / n - a;
            const double integral = (right * fabs(right) - left * fabs(left)) / 2 - a / n;
            assert_near(c[3 * j], integral * sqrt(2.5 * n), 1e-14);
        }
        for (size_t k = 0; k < 3 * mesh.elements; k++)
            sum += c[k] * c[k];
        assert_near(sum + rest, square, 1e-14);
        assert_true(rest > 1e-9); /* no parabola has a kink */
    }
    br_store_clear(&store);
}

/* A guard that changes nothing cuts the beam and the time: the solution stays. */
TEST(test_needless_ends)
{
    struct br_scene whole = beam(1.3, 0.02), cut = whole;
    const char *load = "-8*(sin(5*x)+x)*exp(-t)";
    whole.bending.load = br_test_load(load);
    cut.bending.load =
        load_of(TEXT("%s*step(x-0.1)+%s*step(0.1-x)+step(t-0.7)-step(t-0.7)*1", load, load));
    struct br_exact *exact[2] = {solve(&whole, 1e-10), solve(&cut, 1e-10)};
    struct br_exact_state *state[2] = {new_state(exact[0]), new_state(exact[1])};
    const struct br_exact_part part = {BR_EXACT_BENDING, false, 0};
    const double largest = br_exact_report(exact[0], BR_EXACT_BENDING).largest.displacement;
    for (int n = 0; n <= 40; n++)
        for (int i = 0; i <= 5; i++) {
            const double x = whole.length * i / 5;
            br_exact_at(exact[0], whole.duration * n / 40, state[0]);
            br_exact_at(exact[1], whole.duration * n / 40, state[1]);
            assert_near(value_of(exact[1], state[1], part, x),
                        value_of(exact[0], state[0], part, x), 1e-11 * largest);
        }
    for (int i = 0; i < 2; i++) {
        br_exact_state_free(state[i]);
        br_exact_free(exact[i]);
    }
    br_scene_clear(&whole);
    br_scene_clear(&cut);
}

/* ---- what is known before ---- */

/* Interpolation misses e^{2 x}, or e^{2 t}, by 2 (w/2)^(d+1) / (d+1)! at most, but for a factor
 * e^{2 w}. */
TEST(test_sight_of_errors)
{
    const char *text[] = {"exp(2*x)", "exp(2*t)"};
    for (enum br_variable v = BR_X; v <= BR_T; v++) {
        struct br_function f = br_test_function(text[v]);
        for (size_t degree = 1; degree <= 15; degree++)
            for (double w = 0.5; w > 0.01; w /= 2) {
                struct br_box box = {{0, 0}, {0, 0}};
                (v == BR_X ? &box.x : &box.t)->high = w;
                const double order = (double)degree + 1;
                const double least = 2 * pow(w / 2, order) / tgamma(order + 1);
                const double error = br_sight_error(&f, v, box, degree);
                AT_MOST(least, error * (1 + 1e-9));
                AT_MOST(error, least * exp(2 * w) * (1 + 1e-9));
            }
        br_function_free(&f);
    }
}

/* Of x t it is half of both sides' product, of which at least half is told. */
TEST(test_sight_of_means)
{
    struct br_function f = br_test_function("x*t");
    for (double length = 1e-3; length < 1e4; length *= 100) {
        const double mean = length / 2 * 3 / 2;
        const double seen = br_sight_mean(&f, (struct br_box){{0, length}, {0, 3}});
        AT_MOST(seen, mean * (1 + 1e-9));
        AT_MOST(mean / 2, seen);
    }
    br_function_free(&f);
}

/* A root is never smooth at 0: its last cell holds what it holds, unseen. */
TEST(test_sight_of_a_root)
{
    struct br_error err;
    struct br_function f = br_test_function("sqrt(t)");
    struct br_list end[2] = {{0}};
    const struct br_list *ends = &end[BR_T];
    struct br_store store = {0};
    struct br_sight sight = {.f = &f, .box = {{0, 0}, {0, 2}}, .mean = 1};
    MUST(br_sight_mesh(&sight, sight.box, end, &store, &err));
    br_list_sort(&end[BR_T]);
    assert_true(ends->count > 10);
    /* its width times its values' range, of the integral 2 */
    AT_MOST(pow(ends->at[0], 1.5) / 2 * (1 - 1e-9), sight.missed);
    AT_MOST(sight.missed, (double)ends->count * 1e-13);
    for (size_t i = 1; i < ends->count; i++)
        AT_MOST(ends->at[i], 2.1 * ends->at[i - 1]);
    br_store_clear(&store);
    br_function_free(&f);
}

/* A peak on a front, where nothing finds it: all of it in one box may be missed, or twice that. */
TEST(test_sight_of_a_front)
{
    struct br_error err;
    struct br_function f = br_test_function("step(x-t)*(1+exp(-((x-0.5003)/1e-5)^2))");
    struct br_list ends[2] = {{0}};
    struct br_store store = {0};
    struct br_sight sight = {.f = &f, .box = {{0, 1}, {0, 1}}, .mean = 1};
    MUST(br_sight_mesh(&sight, sight.box, ends, &store, &err));
    const double box = pow(0.5, 20);
    AT_MOST(0.9 * box, sight.missed);
    AT_MOST(sight.missed, 2.1 * box);
    br_store_clear(&store);
    br_function_free(&f);
}

static struct br_outline outline_of(const struct br_scene *scene, size_t degree)
{
    struct br_error err;
    struct br_outline o;
    MUST(br_outline_init(&o, scene, degree, &err));
    return o;
}

static bool has(const struct br_list *list, double value)
{
    for (size_t i = 0; i < list->count; i++)
        if (fabs(list->at[i] - value) <= 1e-12 * value)
            return true;
    return false;
}

/* A blow is seen where it is, whichever factor it is of; a step begins in the later cell. */
TEST(test_outline_of_a_blow)
{
    struct br_scene s = rod(1, 0.7);
    s.axial.load = br_test_load("(1+x)*exp(-((t-1.2)/1e-3)^2)");
    struct br_outline o = outline_of(&s, 1);
    assert_true(br_outline_is_sharp(&o, 1.2, 0.01));
    assert_false(br_outline_is_sharp(&o, 0.3, 0.01));
    AT_MOST(br_outline_cell(&o, 1.2), 2e-3);
    AT_MOST(0.1, br_outline_cell(&o, 0.3));
    const struct br_list *cell = &o.end[BR_T];
    for (size_t i = 0; i + 1 < cell->count; i++) {
        CLOSE(br_outline_cell(&o, cell->at[i]), cell->at[i + 1] - cell->at[i], 0);
        AT_MOST(br_outline_reach(&o, cell->at[i]), s.duration - cell->at[i]);
        AT_MOST(cell->at[i] + br_outline_reach(&o, cell->at[i]), 1.2);
        if (cell->at[i + 1] > 1.19)
            break;
    }
    br_outline_clear(&o);
    br_scene_clear(&s);
}

/* When a front leaves, and that it moves; where initial data bend; what a jump in a force at the
 * tip leaves there; and what is proved, and what is not, of data that no polynomial is. */
TEST(test_outline_of_places)
{
    struct br_scene s = rod(1, 0.7);
    s.axial.load = br_test_load("-3*step(2*t-x)");
    struct br_outline o = outline_of(&s, 1);
    assert_true(o.fronts);
    bool found = false;
    for (size_t i = 0; i < o.jump.count; i++)
        found = found || fabs(o.jump.at[i].low - 1.25) < 1e-12;
    assert_true(found);
    br_outline_clear(&o);
    br_scene_clear(&s);

    s = rod(1, 0.7);
    s.axial.displacement = br_test_function("abs(x-1.1)-1.1+sqrt(x)");
    s.axial.tip_force = br_test_function("exp(t)*step(t-1)");
    o = outline_of(&s, 1);
    assert_true(!o.fronts && has(&o.end[BR_X], 1.1));
    const double layer = sqrt(0.7 * 1e-6 * s.duration);
    const double last = s.length - o.end[BR_X].at[o.end[BR_X].count - 2];
    AT_MOST(last, 1.01 * layer);
    AT_MOST(1e-18, o.missed);
    AT_MOST(o.missed, 1e-10);
    AT_MOST(1e-18, o.proved);
    AT_MOST(o.proved, 1e-10);
    br_outline_clear(&o);
    br_scene_clear(&s);
}
