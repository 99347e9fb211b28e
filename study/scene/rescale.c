/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/rescale.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "study/scene/random.h"

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
    memset(out->derived, 0, sizeof out->derived);
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
