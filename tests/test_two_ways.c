/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference agrees with itself: contact and Coulomb scenes that are written in two ways
 * have the same tip, within the errors that are stated for both. The ways differ in what the
 * reference does: a load as a product or as a function of x and t, a place where nothing breaks, a
 * load in pieces, a gap that is closed by a load or by the initial data.
 *
 * A scene's file in engineers' numbers is, to the last bit of each number, the file in a1, c1, a2,
 * c2, rho and c_V, m, s and kg. */
#include <math.h>
#include <stdio.h>

#include "reference/exact/exact.h"
#include "study/scene/file.h"
#include "support.h"

enum { TEXT = 200, TIMES = 23 };

/* ---- scenes ---- */

/* A load amplitude (1 + rise x) sin(rate t + phase) on each field, N/m. */
struct drawn {
    double amplitude[2], rise[2], rate[2], phase[2];
    double tip; /* s: the tip is displaced by s L at first, where the second way says so */
};

static struct br_scene bare(struct br_test_random *random, struct drawn *d)
{
    struct br_scene s = br_test_bare();
    s.length = br_test_log_uniform(random, 0.2, 5);
    s.duration = br_test_log_uniform(random, 0.5, 2);
    s.density = br_test_log_uniform(random, 0.1, 3);
    s.axial.stiffness = br_test_log_uniform(random, 1, 20);
    s.axial.viscosity = br_test_log_uniform(random, 0.2, 2);
    s.bending.stiffness = br_test_log_uniform(random, 1, 20) * s.length * s.length;
    s.bending.viscosity = br_test_log_uniform(random, 0.1, 1) * s.length * s.length;
    s.contact = (struct br_contact){.modelled = true,
                                    .gap = br_test_uniform(random, 0.02, 0.08) * s.length,
                                    .stiffness = br_test_log_uniform(random, 5, 200) / s.length};
    s.friction.law = br_test_index(random, 2) ? BR_COULOMB : BR_FRICTIONLESS;
    if (s.friction.law)
        s.friction.coefficient = br_test_log_uniform(random, 0.5, 20) / s.length;
    for (int kind = 0; kind < 2; kind++) {
        d->amplitude[kind] =
            (kind ? br_test_uniform(random, -3, 3) : 4) *
            (kind ? s.bending.stiffness / s.length / s.length : s.axial.stiffness) / s.length;
        d->rise[kind] = br_test_uniform(random, 0, 1) / s.length;
        d->rate[kind] = br_test_uniform(random, 2, 12) / s.duration;
        d->phase[kind] = br_test_uniform(random, 0, 1);
    }
    d->tip = br_test_uniform(random, -0.1, 0.05);
    return s;
}

static struct br_load *load_of(struct br_scene *s, int kind)
{
    return kind ? &s->bending.load : &s->axial.load;
}

/* The load is space(x) time(t). */
static void print_factors(const struct drawn *d, int kind, char space[TEXT], char time[TEXT])
{
    snprintf(space, TEXT, "%.17g*(1 + %.17g*x)", d->amplitude[kind], d->rise[kind]);
    snprintf(time, TEXT, "sin(%.17g*t + %.17g)", d->rate[kind], d->phase[kind]);
}

/* As products: parts of space, of the time before and after a place of it. */
static void put_products(struct br_scene *s, const struct drawn *d, int kind, bool in_pieces)
{
    static const char *const shape[] = {"0.375*%s", "0.625*%s", "0.625*%s"};
    static const char *const history[] = {"%s", "(t < %2$.17g ? %1$s : 0)",
                                          "(t < %2$.17g ? 0 : %1$s)"};
    char space[TEXT], time[TEXT], text[2][2 * TEXT];
    print_factors(d, kind, space, time);
    for (int i = 0; i < (in_pieces ? 3 : 1); i++) {
        snprintf(text[0], sizeof text[0], in_pieces ? shape[i] : "%s", space);
        snprintf(text[1], sizeof text[1], history[i], time, 0.61 * s->duration);
        load_of(s, kind)->term[i] = (struct br_product){.space = br_test_function(text[0]),
                                                        .time = br_test_function(text[1])};
    }
}

/* ---- the ways ---- */

static const struct way {
    const char *title;
    const char *load; /* as one function: of space, time, a time and a place; NULL: as products */
    bool in_pieces;   /* three eighths and five, the second of them in two pieces of time */
    bool displaced;   /* a strain s that a tip force holds, and a gap that is wider by s L */
} ways[] = {
    {"a function of x and t", "%1$s*%2$s", false, false},
    {"the same before and after a time", "(t < %3$.17g ? %1$s*%2$s : %1$s*%2$s)", false, false},
    /* each number must be written, so that the next one has its place */
    {"nothing at a place", "%1$s*%2$s + 0*%3$.17g*abs(x - %4$.17g)", false, false},
    {"three pieces", NULL, true, false},
    {"displaced at first", NULL, false, true},
};
enum { WAYS = sizeof ways / sizeof *ways };

static void put_load(struct br_scene *s, const struct drawn *d, int kind, const struct way *w)
{
    char space[TEXT], time[TEXT], all[6 * TEXT];
    if (!w->load) {
        put_products(s, d, kind, w->in_pieces);
        return;
    }
    print_factors(d, kind, space, time);
    snprintf(all, sizeof all, w->load, space, time, 0.377 * s->duration, 0.31 * s->length);
    *load_of(s, kind) = br_test_load(all);
}

static void displace(struct br_scene *s, const struct drawn *d)
{
    char text[TEXT];
    snprintf(text, sizeof text, "%.17g*x", d->tip);
    s->axial.displacement = br_test_function(text);
    s->axial.tip_force = (struct br_function){.constant = d->tip * s->axial.stiffness};
    s->contact.gap += d->tip * s->length;
}

/* ---- the comparison ---- */

struct answer {
    struct br_exact *exact;
    struct br_exact_state *state;
};

static bool solve(const struct br_scene *s, struct answer *a)
{
    *a = (struct answer){NULL, NULL};
    const struct br_exact_options options = {.tolerance = 1e-7, .acceptable = 1e-5};
    if (br_exact_create(&a->exact, s, &options, &err))
        return false; /* refused */
    MUST(br_exact_state_create(&a->state, a->exact, &err));
    return true;
}

static void compare(const char *title, const struct answer *a, const struct answer *b,
                    const struct br_scene *s, double moved)
{
    for (int i = 0; i <= TIMES; i++) {
        const double t = s->duration * i / TIMES;
        br_exact_at(a->exact, t, a->state);
        br_exact_at(b->exact, t, b->state);
        for (int f = 0; f < 2; f++) {
            const struct br_exact_report x = br_exact_report(a->exact, (enum br_field_kind)f),
                                         y = br_exact_report(b->exact, (enum br_field_kind)f);
            const double off =
                a->state->tip[f].displacement + (f ? 0 : moved) - b->state->tip[f].displacement;
            const double allowed = x.error.displacement + y.error.displacement +
                                   1e-15 * (x.largest.displacement + fabs(moved));
            if (!(fabs(off) <= allowed))
                fail_msg("%s, field %d, t = %g s: %g m apart, expected at most %g m", title, f, t,
                         off, allowed);
        }
    }
}

static struct br_scene second_way(const struct br_scene *plain, const struct drawn *d,
                                  const struct way *w)
{
    struct br_scene s = *plain;
    s.axial.load = s.bending.load = (struct br_load){0};
    for (int kind = 0; kind < 2; kind++)
        put_load(&s, d, kind, w);
    if (w->displaced)
        displace(&s, d);
    return s;
}

TEST(test_pairs)
{
    const size_t pairs = br_test_long() ? 300 : 3 * WAYS;
    size_t refused = 0, closed = 0;
    for (size_t i = 0; i < pairs; i++) {
        struct br_test_random random = {1000 + i};
        const struct way *w = &ways[i % WAYS];
        struct drawn d;
        OWNED(br_scene) s = bare(&random, &d);
        if (w->displaced && s.contact.gap + d.tip * s.length < 0)
            d.tip = -d.tip;
        for (int kind = 0; kind < 2; kind++)
            put_products(&s, &d, kind, false);
        OWNED(br_scene) other = second_way(&s, &d, w);
        struct answer a, b;
        const bool one = solve(&s, &a), two = solve(&other, &b), both = one && two;
        refused += !both;
        size_t events = 0;
        if (both) {
            compare(w->title, &a, &b, &s, w->displaced ? d.tip * s.length : 0);
            br_exact_events(a.exact, &events);
        }
        closed += events > 2;
        br_exact_state_free(a.state);
        br_exact_state_free(b.state);
        br_exact_free(a.exact);
        br_exact_free(b.exact);
    }
    print_message("# %zu pairs, %zu refused, %zu with switches\n", pairs, refused, closed);
    assert_true(20 * refused <= pairs);
    assert_true(2 * closed >= pairs);
}

/* ---- files ---- */

/* Numbers of 20 digits are from 40 digits of mpmath. */
#define TOP "title: T\nduration: 1 s\n"
#define TIP "contact: {gap: 0.0001 m, stiffness: 123.7e3 N/m}\n"
#define LAW "friction: {law: coulomb, coefficient: "
#define BAR TOP "length: 0.3 m\ndensity: 0.785 kg/m\naxial: {stiffness: 21e6 N, viscosity: "
#define BEAM TOP "length: 0.3 m\ndensity: 0.785 kg/m\nbending: {stiffness: 43.75 N m^2, viscosity: "
#define STEEL "young: 210 GPa\nmass_density: 7.85 g/cm^3\n"
#define PARTS "axial: {viscosity: 1 N s}\nbending: {viscosity: 1 N m^2 s}\n"
static const struct {
    const char *title, *one, *other;
} files[] = {
    {"lengths and times",
     TOP "length: 12 in\ndensity: 1 kg/m\naxial: {stiffness: 1 N, viscosity: 1 N s}\n",
     "title: T\nduration: 1000 ms\nlength: 304.8 mm\ndensity: 10 g/cm\n"
     "axial: {stiffness: 1e-6 MN, viscosity: 1000 N ms}\n"},
    {"loads and initial data",
     BAR
     "31 N s, load: '(0.7 + x)*sin(t) [kN/m]', displacement: '0.1*x [mm]', tip_force: '2*t [lbf]'}\n",
     BAR "31 N s, load: '(700 + 1e3*x)*sin(t) [N/m]', displacement: '1e-4*x [m]', "
         "tip_force: '8.896443230521*t [N]'}\n"},
    {"shape and history", BAR "31 N s, load: {shape: 'x [%]', history: 't [MN/mm]'}}\n",
     BAR "31 N s, load: {shape: '0.01*x [1]', history: '1e9*t [N/m]'}}\n"},
    {"a rectangle", TOP "length: 0.3 m\n" STEEL "section: rectangle 20 mm x 5 mm\n" PARTS,
     TOP "length: 0.3 m\ndensity: 0.785 kg/m\naxial: {stiffness: 21e6 N, viscosity: 1 N s}\n"
         "bending: {stiffness: 43.75 N m^2, viscosity: 1 N m^2 s}\n"},
    {"a circle", TOP "length: 0.3 m\n" STEEL "section: circle 10 mm\n" PARTS,
     TOP "length: 0.3 m\n" STEEL "area: 0.78539816339744830962 cm^2\n"
         "inertia: 490.87385212340519351 mm^4\n" PARTS},
    {"a tube", TOP "length: 0.3 m\n" STEEL "section: tube 2 cm x 2 mm\n" PARTS,
     PARTS TOP "length: 0.3 m\n" STEEL "area: 113.09733552923255659 mm^2\n"
               "inertia: 0.46369907566985348200 cm^4\n"},
    {"a tube with hardly a hole, and a bar",
     TOP "length: 0.3 m\n" STEEL "section: tube 20 mm x 9.99999999 mm\n" PARTS,
     TOP "length: 0.3 m\n" STEEL "section: circle 20 mm\n" PARTS},
    {"a relaxation time", BAR "31.5 N s}\n",
     TOP "length: 0.3 m\ndensity: 0.785 kg/m\n"
         "axial: {stiffness: 21 MN, relaxation_time: 1.5 us}\n"},
    {"a damping ratio of the rod", BAR "31.017432426139149751 N s}\n",
     TOP "length: 0.3 m\ndensity: 0.785 kg/m\naxial: {stiffness: 21e6 N, damping_ratio: 2 %}\n"},
    {"a damping ratio of the beam", BEAM "0.0060003364873086782014 N m^2 s}\n",
     TOP "length: 0.3 m\ndensity: 0.785 kg/m\n"
         "bending: {stiffness: 43.75 N m^2, damping_ratio: 0.02}\n"},
    {"a coefficient without unit",
     TOP "length: 0.3 m\n" STEEL "section: circle 1 cm\n" PARTS TIP LAW "0.3}\n",
     LAW "37.11 N/mm}\n" TOP "length: 0.3 m\n" STEEL "section: circle 1 cm\n" PARTS TIP},
};

/* One last bit: the numbers are the same, or neighbours. */
static bool are_neighbours(double a, double b)
{
    return a == b || nextafter(a, b) == b;
}

static void compare_numbers(const char *title, const struct br_scene *a, const struct br_scene *b)
{
    const double numbers[][2] = {
        {a->length, b->length},
        {a->duration, b->duration},
        {a->density, b->density},
        {a->axial.stiffness, b->axial.stiffness},
        {a->axial.viscosity, b->axial.viscosity},
        {a->bending.stiffness, b->bending.stiffness},
        {a->bending.viscosity, b->bending.viscosity},
        {a->contact.gap, b->contact.gap},
        {a->contact.stiffness, b->contact.stiffness},
        {a->friction.coefficient, b->friction.coefficient},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (!are_neighbours(numbers[i][0], numbers[i][1]))
            fail_msg("%s: number %zu is %.17g and %.17g", title, i, numbers[i][0], numbers[i][1]);
}

/* Each rounds in its own order. */
static void compare_functions(const char *title, struct br_scene *a, struct br_scene *b)
{
    const struct br_function *f, *g;
    for (size_t i = 0; (f = br_scene_function(a, i)) && (g = br_scene_function(b, i)); i++)
        for (int point = 0; point < 5; point++) {
            const double x = 0.07 * point, t = 0.21 * point;
            double one, other;
            br_function_evaluate(f, 1, &x, t, &one);
            br_function_evaluate(g, 1, &x, t, &other);
            if (!(fabs(one - other) <= 5e-16 * fabs(one)))
                fail_msg("%s: function %zu is %.17g and %.17g", title, i, one, other);
        }
}

TEST(test_files)
{
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct br_scene a, b;
        MUST(br_scene_read_text("one.yaml", files[i].one, &a, &err));
        MUST(br_scene_read_text("other.yaml", files[i].other, &b, &err));
        compare_numbers(files[i].title, &a, &b);
        compare_functions(files[i].title, &a, &b);
        br_scene_clear(&a);
        br_scene_clear(&b);
    }
}
