/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/rescale.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "study/extreme_random.h"

/* ---- functions ---- */

/* factor * f(x / metre, t / second). */
struct scaled {
    struct br_function of; /* owned */
    double factor, metre, second;
};

enum { AT_ONCE = 64 };

static void evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct scaled *s = self;
    double old[AT_ONCE];
    for (size_t first = 0; first < count; first += AT_ONCE) {
        const size_t some = count - first < AT_ONCE ? count - first : AT_ONCE;
        for (size_t i = 0; i < some; i++)
            old[i] = x[first + i] / s->metre;
        br_function_evaluate(&s->of, some, old, t / s->second, value + first);
        for (size_t i = 0; i < some; i++)
            value[first + i] *= s->factor;
    }
}

static void release(void *self)
{
    struct scaled *s = self;
    if (s)
        br_function_free(&s->of);
    free(s);
}

static void *clone(const void *self)
{
    const struct scaled *s = self;
    struct scaled *copy = br_allocate(1, sizeof *copy);
    if (!copy)
        return NULL;
    *copy = *s;
    if (br_function_clone(&s->of, &copy->of, NULL)) {
        free(copy);
        return NULL;
    }
    return copy;
}

static const struct br_function_ops scaled_ops = {
    .evaluate = evaluate, .clone = clone, .free = release};

/* The powers of metre, second and kilogram of a unit. */
struct unit {
    int metre, second, kilogram;
};

static const struct unit none = {0, 0, 0}, length = {1, 0, 0}, duration = {0, 1, 0},
                         speed = {1, -1, 0}, rate = {0, -1, 0}, mass = {-1, 0, 1},
                         force = {1, -2, 1}, load = {0, -2, 1}, spring = {0, -2, 1},
                         moment = {2, -2, 1}, viscous = {1, -1, 1}, rigidity = {3, -2, 1},
                         damping = {3, -1, 1};

/* What is done to a scene: other units, or noise. */
struct change {
    struct br_units_change to;
    double noise;
    struct br_random random;
    enum br_status status;
    struct br_error *err;
};

/* 1, or nearly. */
static double noisy(struct change *c)
{
    return 1 + c->noise * br_random_uniform(&c->random, -1, 1);
}

static double factor_of(struct change *c, struct unit u)
{
    return pow(c->to.metre, u.metre) * pow(c->to.second, u.second) *
           pow(c->to.kilogram, u.kilogram) * noisy(c);
}

static void scale(struct change *c, double *value, struct unit u)
{
    const double old = *value;
    *value *= factor_of(c, u);
    if (isfinite(*value) && (old == 0 || fabs(*value) >= DBL_MIN || fabs(old) < DBL_MIN))
        return;
    if (!c->status)
        c->status = br_fail(c->err, BR_BAD_INPUT, "%g is %g in the other units", old, *value);
}

static void scale_function(struct change *c, struct br_function *f, struct unit u)
{
    if (!f->ops) {
        if (f->constant != 0)
            scale(c, &f->constant, u);
        return;
    }
    struct scaled *s = br_allocate(1, sizeof *s);
    if (!s) {
        br_function_free(f);
        c->status = br_no_memory(c->err, "a scene in other units");
        return;
    }
    *s = (struct scaled){*f, factor_of(c, u), c->to.metre * noisy(c), c->to.second * noisy(c)};
    *f = (struct br_function){
        .ops = &scaled_ops, .self = s, .uses_x = s->of.uses_x, .uses_t = s->of.uses_t};
}

/* ---- the scene ---- */

/* Every number and function with its unit. The load's factor goes to its history, and its form in
 * space has none. */
static void change_numbers(struct change *c, struct br_scene *s)
{
    const struct {
        double *value;
        struct unit unit;
    } numbers[] = {
        {&s->density, mass},
        {&s->axial.stiffness, force},
        {&s->axial.viscosity, viscous},
        {&s->bending.stiffness, rigidity},
        {&s->bending.viscosity, damping},
        {&s->contact.gap, length},
        {&s->contact.stiffness, spring},
        {&s->friction.coefficient, s->friction.law == BR_TRESCA ? force : spring},
        {&s->friction.regularisation, speed},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        scale(c, numbers[i].value, numbers[i].unit);
}

static void change_functions(struct change *c, struct br_scene *s)
{
    const struct {
        struct br_function *function;
        struct unit unit;
    } functions[] = {
        {&s->axial.tip_force, force},       {&s->axial.displacement, length},
        {&s->axial.velocity, speed},        {&s->bending.tip_force, force},
        {&s->bending.tip_moment, moment},   {&s->bending.displacement, length},
        {&s->bending.velocity, speed},      {&s->bending.displacement_slope, none},
        {&s->bending.velocity_slope, rate}, {&s->bending.stick_force, force},
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        scale_function(c, functions[i].function, functions[i].unit);
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        scale_function(c, &s->axial.load.term[i].space, none);
        scale_function(c, &s->axial.load.term[i].time, load);
        scale_function(c, &s->bending.load.term[i].space, none);
        scale_function(c, &s->bending.load.term[i].time, load);
    }
}

static char *copy_text(const char *text, struct change *c)
{
    char *copy = text ? br_allocate(strlen(text) + 1, 1) : NULL;
    if (copy)
        strcpy(copy, text);
    else if (text)
        c->status = br_no_memory(c->err, "a scene in other units");
    return copy;
}

static void copy_functions(struct br_scene *s, struct change *c)
{
    struct br_function *f;
    for (size_t i = 0; (f = br_scene_function(s, i)); i++) {
        const struct br_function old = *f;
        if (br_function_clone(&old, f, c->err))
            c->status = BR_NO_MEMORY;
    }
}

static enum br_status apply(const struct br_scene *scene, struct change *c, struct br_scene *out)
{
    *out = *scene;
    out->name = copy_text(scene->name, c);
    out->title = copy_text(scene->title, c);
    out->remark = NULL;
    out->axial.solution = out->bending.solution = NULL;
    out->axial.given = out->bending.given = (struct br_function){0};
    copy_functions(out, c);
    change_numbers(c, out);
    change_functions(c, out);
    const double noise = c->noise;
    c->noise = 0;
    scale(c, &out->length, length);
    scale(c, &out->duration, duration);
    c->noise = noise;
    return c->status;
}

enum br_status br_rescale(const struct br_scene *scene, const struct br_units_change *units,
                          struct br_scene *out, struct br_error *err)
{
    struct change change = {.to = *units, .err = err};
    return apply(scene, &change, out);
}

enum br_status br_perturb(const struct br_scene *scene, double size, unsigned long long seed,
                          struct br_scene *out, struct br_error *err)
{
    struct change change = {
        .to = {1, 1, 1}, .noise = size, .random = br_random_of(seed, 0), .err = err};
    return apply(scene, &change, out);
}
