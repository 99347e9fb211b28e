/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/rescale.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "study/scene/random.h"
#include "study/scene/schema.h"
#include "study/scene/units.h"

/* ---- functions ---- */

/* factor * f(x / metre, t / second). */
struct scaled {
    struct br_function of; /* owned; of a guard borrowed */
    double factor, metre, second;
    struct scaled *inner;      /* of's guards in these units, guards; owned */
    struct br_function *guard; /* the same as functions; owned */
    size_t guards;
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
    if (s) {
        br_function_free(&s->of);
        free(s->inner);
        free(s->guard);
    }
    free(s);
}

static const struct br_function_ops scaled_ops;

static bool add_guards(struct scaled *s)
{
    s->guards = 0;
    while (br_function_guard(&s->of, s->guards))
        s->guards++;
    s->inner = br_allocate(s->guards + 1, sizeof *s->inner);
    s->guard = br_allocate(s->guards + 1, sizeof *s->guard);
    for (size_t i = 0; i < s->guards && s->inner && s->guard; i++) {
        const struct br_function *of = br_function_guard(&s->of, i);
        s->inner[i] = (struct scaled){*of, 1, s->metre, s->second, NULL, NULL, 0};
        s->guard[i] = (struct br_function){
            .ops = &scaled_ops, .self = &s->inner[i], .uses_x = of->uses_x, .uses_t = of->uses_t};
    }
    return s->inner && s->guard;
}

/* Takes f over, even where it fails. */
static struct scaled *create(struct br_function *f, double factor, double metre, double second)
{
    struct scaled *s = br_allocate(1, sizeof *s);
    if (s)
        *s = (struct scaled){.of = *f, .factor = factor, .metre = metre, .second = second};
    else
        br_function_free(f);
    if (s && add_guards(s))
        return s;
    release(s);
    return NULL;
}

static void *clone(const void *self)
{
    const struct scaled *s = self;
    struct br_function of;
    if (br_function_clone(&s->of, &of, NULL))
        return NULL;
    return create(&of, s->factor, s->metre, s->second);
}

static const struct br_function *guard(const void *self, size_t i)
{
    const struct scaled *s = self;
    return i < s->guards ? &s->guard[i] : NULL;
}

/* a times b, outward by the rounding of both ends. */
static struct br_interval times(struct br_interval a, double b)
{
    const double one = a.low * b, other = a.high * b;
    return (struct br_interval){nextafter(fmin(one, other), -INFINITY),
                                nextafter(fmax(one, other), INFINITY)};
}

/* The box in the old units: as evaluate divides, whose rounding is monotonic. */
static struct br_box old_box(const struct scaled *s, struct br_box box)
{
    return (struct br_box){{box.x.low / s->metre, box.x.high / s->metre},
                           {box.t.low / s->second, box.t.high / s->second}};
}

static bool bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct scaled *s = self;
    if (!br_function_bound(&s->of, old_box(s, box), value))
        return false;
    *value = times(*value, s->factor);
    return isfinite(value->low) && isfinite(value->high);
}

static bool taylor(const void *self, enum br_variable along, struct br_box box, size_t order,
                   struct br_interval *coefficient)
{
    const struct scaled *s = self;
    const double unit = along == BR_X ? s->metre : s->second;
    if (!br_function_taylor(&s->of, along, old_box(s, box), order, coefficient))
        return false;
    for (size_t i = 0; i <= order; i++) {
        coefficient[i] = times(coefficient[i], s->factor);
        for (size_t j = 0; j < i; j++)
            coefficient[i] = times(coefficient[i], 1 / unit);
    }
    return true;
}

static const struct br_function_ops scaled_ops = {.evaluate = evaluate,
                                                  .clone = clone,
                                                  .free = release,
                                                  .bound = bound,
                                                  .taylor = taylor,
                                                  .guard = guard};

/* ---- the scene ---- */

/* That of a member of the scene, by the key that gives it. */
static struct br_dimension dimension_of(const struct br_scene *s, const void *member)
{
    const size_t offset = (size_t)((const char *)member - (const char *)s);
    const struct br_scene_key *k = br_scene_keys;
    struct br_unit unit;
    while (k->offset != offset || (k->law == BR_TRESCA && s->friction.law != BR_TRESCA))
        k++;
    br_unit_read(k->unit, &unit);
    return unit.of;
}

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

static double factor_of(struct change *c, struct br_dimension u)
{
    return pow(c->to.metre, u.metre) * pow(c->to.second, u.second) *
           pow(c->to.kilogram, u.kilogram) * noisy(c);
}

static void scale(struct change *c, double *value, struct br_dimension u)
{
    const double old = *value;
    *value *= factor_of(c, u);
    if (isfinite(*value) && (old == 0 || fabs(*value) >= DBL_MIN || fabs(old) < DBL_MIN))
        return;
    if (!c->status)
        c->status = br_fail(c->err, BR_BAD_INPUT, "%g is %g in the other units", old, *value);
}

static void scale_function(struct change *c, struct br_function *f, struct br_dimension u)
{
    if (!f->ops) {
        if (f->constant != 0)
            scale(c, &f->constant, u);
        return;
    }
    const double factor = factor_of(c, u), metre = c->to.metre * noisy(c);
    struct scaled *s = create(f, factor, metre, c->to.second * noisy(c));
    if (!s) {
        c->status = br_no_memory(c->err, "a scene in other units");
        *f = (struct br_function){0};
        return;
    }
    *f = (struct br_function){
        .ops = &scaled_ops, .self = s, .uses_x = s->of.uses_x, .uses_t = s->of.uses_t};
}

/* Every number and function with its unit. The load's factor goes to its history, and its form in
 * space has none. */
static void change_all(struct change *c, struct br_scene *s)
{
    double *const numbers[] = {
        &s->density,           &s->axial.stiffness,      &s->axial.viscosity,
        &s->bending.stiffness, &s->bending.viscosity,    &s->contact.gap,
        &s->contact.stiffness, &s->friction.coefficient, &s->friction.regularisation,
    };
    struct br_function *const functions[] = {
        &s->axial.tip_force,     &s->axial.displacement,         &s->axial.velocity,
        &s->bending.tip_force,   &s->bending.tip_moment,         &s->bending.displacement,
        &s->bending.velocity,    &s->bending.displacement_slope, &s->bending.velocity_slope,
        &s->bending.stick_force,
    };
    struct br_load *const loads[] = {&s->axial.load, &s->bending.load};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        scale(c, numbers[i], dimension_of(s, numbers[i]));
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        scale_function(c, functions[i], dimension_of(s, functions[i]));
    for (size_t i = 0; i < 2 * BR_LOAD_TERMS; i++) {
        struct br_product *term = &loads[i % 2]->term[i / 2];
        scale_function(c, &term->space, (struct br_dimension){0, 0, 0});
        scale_function(c, &term->time, dimension_of(s, loads[i % 2]));
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
    memset(out->derived, 0, sizeof out->derived);
    copy_functions(out, c);
    change_all(c, out);
    const double noise = c->noise;
    c->noise = 0;
    scale(c, &out->length, dimension_of(out, &out->length));
    scale(c, &out->duration, dimension_of(out, &out->duration));
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
