/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case that is wrong made small: see br_extreme_shrink. */
#include "study/extremes/map.h"

#include <math.h>
#include <string.h>

/* ---- what is in a case ---- */

enum { MOST_NUMBERS = 32 };

/* Its numbers, those of parts that are not there left out; returns how many. */
static size_t numbers_of(struct br_extreme_case *c, double *number[MOST_NUMBERS])
{
    size_t count = 0;
    number[count++] = &c->length;
    number[count++] = &c->duration;
    number[count++] = &c->density;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_extreme_field *p = &c->field[kind];
        double *const own[] = {&p->stiffness,      &p->viscosity,       &p->load.size,
                               &p->tip_force.size, &p->tip_moment.size, &p->displacement.size,
                               &p->velocity.size,  &p->load.rate,       &p->tip_force.rate,
                               &p->tip_moment.rate};
        for (size_t i = 0; i < sizeof own / sizeof *own && p->modelled; i++)
            number[count++] = own[i];
    }
    number[count++] = &c->gap;
    number[count++] = &c->contact_stiffness;
    number[count++] = &c->friction;
    number[count++] = &c->regularisation;
    return count;
}

static double one_digit(double x)
{
    if (x == 0 || !isfinite(x))
        return x;
    const double power = pow(10, floor(log10(fabs(x))));
    const double rounded = round(x / power) * power;
    return isfinite(rounded) && rounded != 0 ? rounded : x;
}

/* 0 for 0, 1 for one digit, 2 for more. */
static size_t digits(double x)
{
    if (x == 0)
        return 0;
    return fabs(x - one_digit(x)) <= 1e-12 * fabs(x) ? 1 : 2;
}

static size_t of_method(const struct br_method *m)
{
    return (size_t)(m->scheme != br_time_schemes[0]) + (m->solver != br_linear_solvers[0]) +
           (m->friction != br_friction_rules[0]) + (m->contact != br_contact_rules[0]) +
           (m->axial_degree != 1) + (m->linear.refinement != 0) +
           (m->linear.scaling != br_linear_defaults.scaling);
}

static size_t of_force(const struct br_extreme_force *f)
{
    return f->size == 0 ? 0
                        : (size_t)(f->shape != BR_SHAPE_FLAT) + (f->history != BR_HISTORY_SUDDEN);
}

/* How much there is of a case, a number that shrinking makes less. */
static size_t size_of(const struct br_extreme_case *one)
{
    struct br_extreme_case c = *one;
    double *number[MOST_NUMBERS];
    const size_t count = numbers_of(&c, number);
    size_t size = of_method(&c.method) + (size_t)c.contact + (c.law != BR_FRICTIONLESS) +
                  (c.wanted != 0) + (size_t)log2((double)c.n) + (size_t)log2((double)c.steps);
    for (size_t i = 0; i < count; i++)
        size += digits(*number[i]);
    size += (size_t)(c.length != 1) + (c.duration != 1);
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_extreme_field *p = &c.field[kind];
        if (p->modelled)
            size += 4 + of_force(&p->load) + of_force(&p->tip_force) + of_force(&p->tip_moment) +
                    (size_t)p->displacement.waved + p->velocity.waved;
    }
    return size;
}

/* ---- what may be made of it ---- */

static void drop_axial(struct br_extreme_case *c)
{
    c->field[BR_AXIAL] = (struct br_extreme_field){0};
    c->contact = false;
    c->wanted = 0;
    if (c->law == BR_COULOMB)
        c->law = BR_FRICTIONLESS;
}

static void drop_bending(struct br_extreme_case *c)
{
    c->field[BR_BENDING] = (struct br_extreme_field){0};
    c->law = BR_FRICTIONLESS;
    c->wanted = 0;
}

static void drop_contact(struct br_extreme_case *c)
{
    c->contact = false;
    c->gap = c->contact_stiffness = 0;
    if (c->law == BR_COULOMB)
        c->law = BR_FRICTIONLESS;
}

static void drop_friction(struct br_extreme_case *c)
{
    c->law = BR_FRICTIONLESS;
    c->friction = c->regularisation = 0;
    c->wanted = 0;
}

static void default_scheme(struct br_extreme_case *c)
{
    c->method.scheme = br_time_schemes[0];
}

static void default_solver(struct br_extreme_case *c)
{
    c->method.solver = br_linear_solvers[0];
}

static void default_laws(struct br_extreme_case *c)
{
    c->method.friction = br_friction_rules[0];
    c->method.contact = br_contact_rule_of(c->method.scheme);
}

static void default_rest(struct br_extreme_case *c)
{
    c->method.axial_degree = 1;
    c->method.linear = br_linear_defaults;
}

static void plain_forces(struct br_extreme_case *c)
{
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_extreme_field *p = &c->field[kind];
        p->load.shape = BR_SHAPE_FLAT;
        p->load.history = p->tip_force.history = p->tip_moment.history = BR_HISTORY_SUDDEN;
        p->displacement.waved = p->velocity.waved = false;
    }
}

static void half_elements(struct br_extreme_case *c)
{
    c->n = c->n > 1 ? c->n / 2 : 1;
}

/* With the step kept, and with the duration kept. */
static void half_duration(struct br_extreme_case *c)
{
    if (c->steps > 1) {
        c->duration *= (double)(c->steps / 2) / (double)c->steps;
        c->steps /= 2;
    }
}

static void half_steps(struct br_extreme_case *c)
{
    c->steps = c->steps > 1 ? c->steps / 2 : 1;
}

static void unit_length(struct br_extreme_case *c)
{
    c->length = 1;
}

static void unit_duration(struct br_extreme_case *c)
{
    c->duration = 1;
}

static void (*const changes[])(struct br_extreme_case *) = {
    drop_axial,     drop_bending, drop_contact, drop_friction, default_scheme,
    default_solver, default_laws, default_rest, plain_forces,  half_elements,
    half_duration,  half_steps,   unit_length,  unit_duration,
};
enum { CHANGES = sizeof changes / sizeof *changes };

/* ---- shrinking ---- */

enum { MOST_QUESTIONS = 300 };

struct shrinking {
    const struct br_extreme_request *request;
    struct br_extreme_case *best;
    size_t asked;
    bool gained;
    struct br_error *err;
};

static enum br_status attempt(struct shrinking *s, const struct br_extreme_case *smaller)
{
    struct br_extreme_verdict verdict;
    if (size_of(smaller) >= size_of(s->best) || s->asked >= MOST_QUESTIONS)
        return BR_OK;
    s->asked++;
    if (br_extreme_stopped(s->request))
        return br_fail(s->err, BR_INTERRUPTED, "interrupted");
    const enum br_status status = br_extreme_ask(s->request, smaller, &verdict, s->err);
    if (!status && verdict.which == BR_EXTREME_WRONG) {
        *s->best = *smaller;
        s->gained = true;
    }
    return status;
}

static enum br_status try_changes(struct shrinking *s)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < CHANGES && !status; i++) {
        struct br_extreme_case smaller = *s->best;
        changes[i](&smaller);
        status = attempt(s, &smaller);
    }
    return status;
}

/* Number i becomes 0, or has one digit left. */
static enum br_status try_numbers(struct shrinking *s)
{
    double *number[MOST_NUMBERS];
    struct br_extreme_case smaller = *s->best;
    const size_t count = numbers_of(&smaller, number);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < 2 * count && !status; i++) {
        smaller = *s->best;
        *number[i / 2] = i % 2 ? one_digit(*number[i / 2]) : 0;
        status = attempt(s, &smaller);
    }
    return status;
}

enum br_status br_extreme_shrink(const struct br_extreme_request *request,
                                 struct br_extreme_case *one, struct br_error *err)
{
    struct shrinking s = {.request = request, .best = one, .err = err};
    enum br_status status = BR_OK;
    do {
        s.gained = false;
        status = try_changes(&s);
        if (!status)
            status = try_numbers(&s);
    } while (s.gained && !status && s.asked < MOST_QUESTIONS);
    return status;
}
