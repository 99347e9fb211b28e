/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "solver/linear/linear_solver.h"
#include "study/run/run.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"
#include "study/scene/schema.h"
#include "tests/checks.h"
#include "tests/lab/map.h"

/* ---- forces ---- */

/* Functions of x; the argument is L. */
static const char *const shapes[] = {
    "", "*(x/%.17g)", "*sin(pi*x/%.17g)", "*sin(7*pi*x/%.17g)", "*(1 - (x/%.17g)^3)",
};

/* Functions of t; the arguments are T and the rate. */
static const char *const histories[] = {
    "",
    "*(t/%.17g)",
    "*(exp(t/%.17g) - 1)",
    "*sin(2*pi*%2$.17g*t/%1$.17g)",
    "*((t/%1$.17g)^3 - 2*(t/%1$.17g)^2)",
};
enum { SHAPES = sizeof shapes / sizeof *shapes, HISTORIES = sizeof histories / sizeof *histories };
enum { OSCILLATES = 3 };

static void draw_form(struct br_test_random *r, struct br_extreme_force *f)
{
    f->shape = br_test_once_in(r, 2) ? 0 : br_test_index(r, SHAPES);
    f->history = br_test_index(r, HISTORIES);
    f->rate = round(br_test_decades(r, 0, 1.5)) + 0.25;
}

/* Draws a load with a total of about `total` (N), and sometimes forces at the tip. */
static void draw_forces(struct br_test_random *r, struct br_extreme_case *c,
                        enum br_field_kind kind, double total)
{
    struct br_extreme_field *p = &c->field[kind];
    draw_form(r, &p->load);
    draw_form(r, &p->tip_force);
    draw_form(r, &p->tip_moment);
    const double sign = kind == BR_BENDING && br_test_once_in(r, 2) ? -1 : 1;
    if (!br_test_once_in(r, 6))
        p->load.size = sign * total / c->length * br_test_uniform(r, 0.5, 1);
    if (br_test_once_in(r, 3))
        p->tip_force.size = sign * total * br_test_uniform(r, -0.5, 1);
    if (kind == BR_BENDING && br_test_once_in(r, 4))
        p->tip_moment.size = total * c->length * br_test_uniform(r, -0.5, 0.5);
}

/* Draws displacements of about `way` (m), and velocities of about way/time (time: s). */
static void draw_start(struct br_test_random *r, struct br_extreme_field *p, double way,
                       double time, double density)
{
    const double size = way * br_test_uniform(r, -1, 1);
    if (br_test_once_in(r, 4))
        p->displacement = (struct br_extreme_start){size, br_test_once_in(r, 4)};
    if (br_test_once_in(r, 5) && density > 0)
        p->velocity = (struct br_extreme_start){size / time, br_test_once_in(r, 4)};
}

/* Coulomb's law needs the contact. */
static void draw_law(struct br_test_random *r, struct br_extreme_case *c)
{
    c->law = (enum br_friction_law)br_test_index(r, 3);
    if (c->law == BR_COULOMB && !c->contact)
        c->law = BR_TRESCA;
}

/* ---- numbers that belong together ---- */

/* Draws a field by its relaxation time c/a relative to T and the static displacement of its tip
 * relative to L. */
static void draw_natural_field(struct br_test_random *r, struct br_extreme_case *c,
                               enum br_field_kind kind, double stiffness)
{
    struct br_extreme_field *p = &c->field[kind];
    const double power = kind == BR_AXIAL ? 1 : 3;
    const double way = c->length * br_test_decades(r, -6, 0);
    p->modelled = true;
    p->stiffness = stiffness;
    p->viscosity = stiffness * c->duration * br_test_decades(r, -6, 1);
    if (br_test_once_in(r, 8))
        p->viscosity = 0;
    draw_forces(r, c, kind, way * stiffness / pow(c->length, power));
    draw_start(r, p, way, c->duration, c->density);
}

static void draw_natural_laws(struct br_test_random *r, struct br_extreme_case *c)
{
    const struct br_extreme_field *u = &c->field[BR_AXIAL], *w = &c->field[BR_BENDING];
    const double push = fabs(u->load.size) * c->length / 2 + fabs(u->tip_force.size);
    const double pushed = push * c->length / fmax(u->stiffness, DBL_MIN);
    const double way = pushed > 0 ? pushed : 1e-3 * c->length;
    const double reaction = 0.375 * fabs(w->load.size) * c->length + fabs(w->tip_force.size);
    c->contact = u->modelled && !br_test_once_in(r, 5);
    c->gap = br_test_once_in(r, 3) ? 0 : way * br_test_decades(r, -6, 1);
    c->contact_stiffness = u->stiffness / c->length * br_test_decades(r, -3, 4);
    if (br_test_once_in(r, 5))
        c->contact_stiffness *= br_test_decades(r, 4, 12);
    if (!w->modelled)
        return;
    draw_law(r, c);
    c->friction = reaction * br_test_decades(r, -2, 1);
    if (c->law == BR_COULOMB)
        c->friction /= way * br_test_decades(r, -2, 0);
}

static void draw_natural(struct br_test_random *r, struct br_extreme_case *c)
{
    c->natural = true;
    c->length = br_test_once_in(r, 3) ? br_test_decades(r, -6, 6) : br_test_decades(r, -1, 1);
    c->duration = br_test_once_in(r, 3) ? br_test_decades(r, -6, 6) : br_test_decades(r, -1, 1);
    const double bending = br_test_decades(r, -3, 6);
    const double axial =
        bending / (c->length * c->length) *
        (br_test_once_in(r, 4) ? br_test_decades(r, -12, 12) : br_test_decades(r, -1, 4));
    const double inertia = br_test_once_in(r, 4) ? 0 : br_test_decades(r, -10, 2);
    c->density = inertia * bending * pow(c->duration, 2) / pow(c->length, 4);
    const size_t fields = br_test_index(r, 6);
    if (fields != 0)
        draw_natural_field(r, c, BR_AXIAL, axial);
    if (fields != 1)
        draw_natural_field(r, c, BR_BENDING, bending);
    draw_natural_laws(r, c);
}

/* ---- any numbers ---- */

/* 10^[low, high), or sometimes 0. */
static double wild(struct br_test_random *r, double low, double high)
{
    return br_test_once_in(r, 8) ? 0 : br_test_decades(r, low, high);
}

static void draw_wild(struct br_test_random *r, struct br_extreme_case *c)
{
    c->length = br_test_decades(r, -6, 6);
    c->duration = br_test_decades(r, -6, 6);
    c->density = wild(r, -8, 6);
    const size_t fields = br_test_index(r, 6);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_extreme_field *p = &c->field[kind];
        if (fields == (size_t)kind)
            continue;
        p->modelled = true;
        p->stiffness = wild(r, -6, 6);
        p->viscosity = wild(r, -6, 6);
        draw_forces(r, c, kind, br_test_decades(r, -6, 12));
        draw_start(r, p, br_test_decades(r, -9, 0) * c->length, br_test_decades(r, -6, 6),
                   c->density);
    }
    c->contact = c->field[BR_AXIAL].modelled && !br_test_once_in(r, 5);
    c->gap = wild(r, -15, 6);
    c->contact_stiffness = wild(r, -6, 15);
    if (!c->field[BR_BENDING].modelled)
        return;
    draw_law(r, c);
    c->friction = wild(r, -6, 15);
}

/* ---- method and resolution ---- */

static size_t rows(const void *const *registry)
{
    size_t count = 0;
    while (registry[count])
        count++;
    return count;
}

/* Picks a row of a registry; in half of the draws the first one. */
static const void *pick(struct br_test_random *r, const void *const *registry)
{
    const size_t row = br_test_index(r, rows(registry));
    return registry[br_test_once_in(r, 2) ? 0 : row];
}

static void draw_method(struct br_test_random *r, struct br_extreme_case *c)
{
    /* As many rows as there once were, so that a seed keeps its cases. */
    static const struct br_linear_solver *const solvers[] = {
        &br_auto, &br_riccati, &br_plain, &br_umfpack, &br_umfpack, &br_umfpack, NULL};
    struct br_method *m = &c->method;
    *m = br_method_default();
    const size_t schemes = rows((const void *const *)br_time_schemes);
    if (!br_test_once_in(r, 4))
        m->scheme = br_time_schemes[br_test_index(r, schemes)];
    m->solver = pick(r, (const void *const *)solvers);
    m->friction = pick(r, (const void *const *)br_friction_rules);
    m->contact = pick(r, (const void *const *)br_contact_rules);
    if (!m->scheme->may_lag)
        m->contact = br_contact_rule_of(m->scheme);
    m->tolerance = br_test_decades(r, -9, -3);
    br_test_index(r, 3);
    br_test_index(r, 3);
    m->axial_degree = br_test_once_in(r, 4) ? 2 : 1;
    c->regularisation = wild(r, -15, 0);
    if (c->natural) /* of the tip's mean speed */
        c->regularisation *= c->length / c->duration;
    if (c->law == BR_TRESCA && br_test_once_in(r, 2) && c->field[BR_AXIAL].modelled)
        c->wanted = 3;
}

/* Linear solves per step, about. */
static double solves(const struct br_method *m)
{
    return m->scheme->adaptive ? 60 : br_time_scheme_stages(m->scheme);
}

/* The limit of elements times linear solves of a case. */
static const double most_work = 1e5;

static void draw_resolution(struct br_test_random *r, struct br_extreme_case *c)
{
    const double most = fmax(2, most_work / solves(&c->method));
    const double decades = fmin(6, log10(most));
    const size_t kind = br_test_index(r, 8);
    double n = floor(br_test_decades(r, 0, 2.7));
    if (kind == 0) /* few steps on a very fine mesh */
        n = floor(br_test_decades(r, 2.5, decades));
    n = fmax(1, fmin(n, most));
    double steps = floor(br_test_decades(r, 0, fmax(0.4, log10(most / n))));
    steps = fmax(1, fmin(steps, most / n));
    c->n = (size_t)n;
    c->steps = (size_t)steps;
}

/* ---- special cases ---- */

static void drop_some(struct br_test_random *r, struct br_extreme_case *c)
{
    double *const may_be_zero[] = {
        &c->density,
        &c->field[0].stiffness,
        &c->field[0].viscosity,
        &c->field[1].stiffness,
        &c->field[1].viscosity,
        &c->field[0].load.size,
        &c->field[1].load.size,
        &c->gap,
        &c->contact_stiffness,
        &c->friction,
    };
    for (size_t i = 0; i < sizeof may_be_zero / sizeof *may_be_zero; i++)
        if (br_test_once_in(r, 4))
            *may_be_zero[i] = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && c->density == 0; kind++)
        c->field[kind].velocity.size = 0;
}

enum { FORCES = 6 };

static struct br_extreme_force *force_of(struct br_extreme_case *c, size_t i)
{
    struct br_extreme_field *p = &c->field[i / 3];
    return i % 3 == 0 ? &p->load : i % 3 == 1 ? &p->tip_force : &p->tip_moment;
}

static void scale_forces(struct br_extreme_case *c, double to)
{
    for (size_t i = 0; i < FORCES; i++)
        if (force_of(c, i)->size != 0)
            force_of(c, i)->size = to;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        c->field[kind].displacement.size = c->field[kind].velocity.size = 0;
}

static void oscillate(struct br_test_random *r, struct br_extreme_case *c)
{
    for (size_t i = 0; i < FORCES; i++) {
        force_of(c, i)->history = OSCILLATES;
        force_of(c, i)->rate = (double)c->steps * br_test_uniform(r, 0.3, 2);
    }
}

/* ---- numbers that are measured by a march: its stability limit, its reaction ---- */

/* Marches the first step of a case; NULL if that fails. The caller clears the scene. */
static struct br_march *first_step(const struct br_extreme_case *c, struct br_scene *scene,
                                   struct br_scene *marched)
{
    char text[BR_EXTREME_TEXT];
    struct br_march *march = NULL;
    br_extreme_scene(c, text);
    if (br_scene_read_text("case.yaml", text, scene, NULL) ||
        br_model_select(scene, c->wanted, marched, NULL) ||
        br_march_create(&march, marched, c->n, c->steps, &c->method, NULL))
        return NULL;
    if (!br_march_step(march, NULL))
        return march;
    br_march_free(march);
    return NULL;
}

/* Sets c_H to the stability limit, c_H k z_tip = 1 + c/(c + k a), times 1 + little. */
static void tune_contact(struct br_extreme_case *c, const struct br_march *march, double little)
{
    const struct br_field *f = br_march_field(march, BR_AXIAL);
    const double limit = (1 + f->viscosity / (f->viscosity + f->k * f->stiffness)) /
                         (f->k * br_march_compliance(march, BR_AXIAL)) * (1 + little);
    if (limit > 0 && isfinite(limit))
        c->contact_stiffness = limit;
}

/* Sets the number of a special case that needs a march of one step. If that march fails, nothing is
 * changed. */
static void tune(struct br_extreme_case *c, double little)
{
    struct br_extreme_case trial = *c;
    struct br_scene scene = {0}, marched;
    const bool bound = c->special == BR_SPECIAL_AT_REACTION;
    if (bound ? c->law != BR_TRESCA : !c->contact)
        return;
    if (bound)
        trial.friction = 1e300;
    struct br_march *march = first_step(&trial, &scene, &marched);
    if (march && !bound)
        tune_contact(c, march, little);
    else if (march && isfinite(br_march_tip(march)->friction_force))
        c->friction = fabs(br_march_tip(march)->friction_force);
    br_march_free(march);
    br_scene_clear(&scene);
}

/* ---- a case ---- */

static void play(struct br_test_random *r, struct br_extreme_case *c)
{
    const struct br_extreme_field *u = &c->field[BR_AXIAL];
    static const double littles[] = {0, 1e-15, -1e-15, 1e-6, -1e-6, 0.02, -0.02};
    switch (c->special) {
    case BR_SPECIAL_GRAZING:
        c->gap = (u->load.size * c->length * c->length / 2 + u->tip_force.size * c->length) /
                 fmax(u->stiffness, DBL_MIN) * (1 + littles[br_test_index(r, 5)]);
        c->gap = isfinite(c->gap) ? fabs(c->gap) : 0;
        break;
    case BR_SPECIAL_DENORMAL:
        scale_forces(c, br_test_uniform(r, 0.1, 1) * 1e-309);
        break;
    case BR_SPECIAL_ZEROS:
        drop_some(r, c);
        break;
    case BR_SPECIAL_REVERSAL:
        oscillate(r, c);
        break;
    case BR_SPECIAL_AT_LIMIT:
    case BR_SPECIAL_AT_REACTION:
        tune(c, littles[br_test_index(r, 7)]);
        break;
    case BR_SPECIAL_NONE:
    case BR_SPECIALS:
        break;
    }
}

void br_extreme_draw(uint64_t seed, size_t index, struct br_extreme_case *c)
{
    struct br_test_random r = br_test_random_of(seed, index);
    *c = (struct br_extreme_case){.seed = seed, .index = index};
    if (br_test_once_in(&r, 3))
        draw_wild(&r, c);
    else
        draw_natural(&r, c);
    draw_method(&r, c);
    draw_resolution(&r, c);
    if (br_test_once_in(&r, 3))
        c->special = (enum br_extreme_special)br_test_index(&r, BR_SPECIALS);
    play(&r, c);
}

/* ---- the text of a case: expressions ---- */

/* Functions of size and L, by field: plain and waved; of a beam also the slopes. */
static const char *const starts[2][2] = {
    {"%.17g*(x/%.17g)", "%.17g*sin(5*pi*x/(2*%.17g))"},
    {"%.17g*(x/%.17g)^2", "%.17g*(1 - cos(5*pi*x/(2*%.17g)))"},
};
static const char *const start_slopes[2] = {"2*%1$.17g*(x/%2$.17g)/%2$.17g",
                                            "%1$.17g*5*pi/(2*%2$.17g)*sin(5*pi*x/(2*%2$.17g))"};

static void add_force(char *t, const struct br_extreme_case *c, const char *key,
                      const struct br_extreme_force *f, const char *unit)
{
    if (f->size == 0)
        return;
    br_append(t, BR_EXTREME_TEXT, "  %s: %.17g", key, f->size);
    if (strcmp(key, "load") == 0)
        br_append(t, BR_EXTREME_TEXT, shapes[f->shape], c->length);
    br_append(t, BR_EXTREME_TEXT, histories[f->history], c->duration, f->rate);
    br_append(t, BR_EXTREME_TEXT, " [%s]\n", unit);
}

static void add_start(char *t, const struct br_extreme_case *c, enum br_field_kind kind,
                      const char *key, const struct br_extreme_start *s)
{
    const bool rate = strcmp(key, "velocity") == 0;
    if (s->size == 0)
        return;
    br_append(t, BR_EXTREME_TEXT, "  %s: ", key);
    br_append(t, BR_EXTREME_TEXT, starts[kind][s->waved], s->size, c->length);
    br_append(t, BR_EXTREME_TEXT, rate ? " [m/s]\n" : " [m]\n");
    if (kind == BR_AXIAL)
        return;
    br_append(t, BR_EXTREME_TEXT, "  %s_slope: ", key);
    br_append(t, BR_EXTREME_TEXT, start_slopes[s->waved], s->size, c->length);
    br_append(t, BR_EXTREME_TEXT, rate ? " [1/s]\n" : " [1]\n");
}

/* ---- the scene ---- */

static void add_field(char *t, const struct br_extreme_case *c, enum br_field_kind kind)
{
    const struct br_extreme_field *p = &c->field[kind];
    const bool axial = kind == BR_AXIAL;
    if (!p->modelled)
        return;
    br_append(t, BR_EXTREME_TEXT, "\n%s:\n  stiffness: %.17g %s\n  viscosity: %.17g %s\n",
              axial ? "axial" : "bending", p->stiffness, axial ? "N" : "N m^2", p->viscosity,
              axial ? "N s" : "N m^2 s");
    add_force(t, c, "load", &p->load, "N/m");
    add_force(t, c, "tip_force", &p->tip_force, "N");
    if (!axial)
        add_force(t, c, "tip_moment", &p->tip_moment, "N m");
    add_start(t, c, kind, "displacement", &p->displacement);
    add_start(t, c, kind, "velocity", &p->velocity);
}

void br_extreme_scene(const struct br_extreme_case *c, char text[BR_EXTREME_TEXT])
{
    char command[BR_EXTREME_COMMAND];
    br_extreme_command(c, "case.yaml", command);
    *text = '\0';
    br_append(text, BR_EXTREME_TEXT, "# Case %zu of seed %llu. %s\n", c->index,
              (unsigned long long)c->seed, command);
    br_append(text, BR_EXTREME_TEXT, "title: Extreme case %zu\n\n", c->index);
    br_append(text, BR_EXTREME_TEXT, "length: %.17g m\nduration: %.17g s\ndensity: %.17g kg/m\n",
              c->length, c->duration, c->density);
    add_field(text, c, BR_AXIAL);
    add_field(text, c, BR_BENDING);
    if (c->contact)
        br_append(text, BR_EXTREME_TEXT, "\ncontact:\n  gap: %.17g m\n  stiffness: %.17g N/m\n",
                  c->gap, c->contact_stiffness);
    if (c->law == BR_FRICTIONLESS)
        return;
    const bool tresca = c->law == BR_TRESCA;
    br_append(text, BR_EXTREME_TEXT, "\nfriction:\n  law: %s\n  %s: %.17g %s\n",
              br_friction_models[c->law].name, tresca ? "bound" : "coefficient", c->friction,
              tresca ? "N" : "N/m");
    if (c->regularisation > 0)
        br_append(text, BR_EXTREME_TEXT, "  regularisation: %.17g m/s\n", c->regularisation);
}

/* A command that the program accepts: no option that the method does not use, and every number to
 * its last bit. */
void br_extreme_command(const struct br_extreme_case *c, const char *name,
                        char text[BR_EXTREME_COMMAND])
{
    char options[BR_METHOD_TEXT];
    const bool axial = c->field[BR_AXIAL].modelled && (c->wanted || c->law != BR_TRESCA);
    const struct br_scene scene = {.axial.modelled = axial, /* else `run` leaves it out */
                                   .contact.modelled = c->contact,
                                   .friction.law = c->law};
    snprintf(text, BR_EXTREME_COMMAND, "beamrate run %s --check --n %zu --k T/%zu%s", name, c->n,
             c->steps, br_method_options(&scene, &c->method, options));
    if (c->wanted)
        br_append(text, BR_EXTREME_COMMAND, " --fields axial,bending");
}
