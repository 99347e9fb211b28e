/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "study/extremes/case.h"
#include "study/scene/method_fields.h"
#include "study/scene/schema.h"

struct text {
    char *at;
    size_t size;
};

__attribute__((format(printf, 2, 3))) static void add(struct text *t, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    const int length = vsnprintf(t->at, t->size, format, args);
    va_end(args);
    const size_t used = length < 0 ? 0 : (size_t)length;
    const size_t taken = used < t->size ? used : t->size - 1;
    t->at += taken;
    t->size -= taken;
}

/* ---- expressions ---- */

static void add_shape(struct text *t, enum br_extreme_shape shape, double length)
{
    switch (shape) {
    case BR_SHAPE_LINEAR:
        add(t, "*(x/%.17g)", length);
        break;
    case BR_SHAPE_SINE:
        add(t, "*sin(pi*x/%.17g)", length);
        break;
    case BR_SHAPE_WAVES:
        add(t, "*sin(7*pi*x/%.17g)", length);
        break;
    case BR_SHAPE_POWER:
        add(t, "*(1 - (x/%.17g)^3)", length);
        break;
    case BR_SHAPE_FLAT:
    case BR_SHAPES:
        break;
    }
}

static void add_history(struct text *t, const struct br_extreme_force *f, double duration)
{
    switch (f->history) {
    case BR_HISTORY_RAMP:
        add(t, "*(t/%.17g)", duration);
        break;
    case BR_HISTORY_EXP:
        add(t, "*(exp(t/%.17g) - 1)", duration);
        break;
    case BR_HISTORY_SINE:
        add(t, "*sin(2*pi*%.17g*t/%.17g)", f->rate, duration);
        break;
    case BR_HISTORY_POWER:
        add(t, "*((t/%.17g)^3 - 2*(t/%.17g)^2)", duration, duration);
        break;
    case BR_HISTORY_SUDDEN:
    case BR_HISTORIES:
        break;
    }
}

static void add_force(struct text *t, const struct br_extreme_case *c, const char *key,
                      const struct br_extreme_force *f, const char *unit)
{
    if (f->size == 0)
        return;
    add(t, "  %s: %.17g", key, f->size);
    if (strcmp(key, "load") == 0)
        add_shape(t, f->shape, c->length);
    add_history(t, f, c->duration);
    add(t, " [%s]\n", unit);
}

static void add_start(struct text *t, const struct br_extreme_case *c, enum br_field_kind kind,
                      const char *key, const struct br_extreme_start *s)
{
    const bool rate = strcmp(key, "velocity") == 0;
    if (s->size == 0)
        return;
    if (kind == BR_AXIAL) {
        add(t,
            s->waved ? "  %s: %.17g*sin(5*pi*x/(2*%.17g)) [%s]\n" : "  %s: %.17g*(x/%.17g) [%s]\n",
            key, s->size, c->length, rate ? "m/s" : "m");
        return;
    }
    add(t,
        s->waved ? "  %s: %.17g*(1 - cos(5*pi*x/(2*%.17g))) [%s]\n"
                 : "  %s: %.17g*(x/%.17g)^2 [%s]\n",
        key, s->size, c->length, rate ? "m/s" : "m");
    if (s->waved)
        add(t, "  %s_slope: %.17g*5*pi/(2*%.17g)*sin(5*pi*x/(2*%.17g)) [%s]\n", key, s->size,
            c->length, c->length, rate ? "1/s" : "1");
    else
        add(t, "  %s_slope: 2*%.17g*(x/%.17g)/%.17g [%s]\n", key, s->size, c->length, c->length,
            rate ? "1/s" : "1");
}

/* ---- the scene ---- */

static void add_field(struct text *t, const struct br_extreme_case *c, enum br_field_kind kind)
{
    const struct br_extreme_field *p = &c->field[kind];
    const bool axial = kind == BR_AXIAL;
    if (!p->modelled)
        return;
    add(t, "\n%s:\n  stiffness: %.17g %s\n  viscosity: %.17g %s\n", axial ? "axial" : "bending",
        p->stiffness, axial ? "N" : "N m^2", p->viscosity, axial ? "N s" : "N m^2 s");
    add_force(t, c, "load", &p->load, "N/m");
    add_force(t, c, "tip_force", &p->tip_force, "N");
    if (!axial)
        add_force(t, c, "tip_moment", &p->tip_moment, "N m");
    add_start(t, c, kind, "displacement", &p->displacement);
    add_start(t, c, kind, "velocity", &p->velocity);
}

void br_extreme_scene(const struct br_extreme_case *c, char text[BR_EXTREME_TEXT])
{
    struct text t = {text, BR_EXTREME_TEXT};
    char command[BR_EXTREME_COMMAND], name[64];
    snprintf(name, sizeof name, "wrong-%zu.yaml", c->index);
    br_extreme_command(c, name, command);
    add(&t, "# Case %zu of seed %llu. %s\n", c->index, (unsigned long long)c->seed, command);
    add(&t, "title: Extreme case %zu\n\n", c->index);
    add(&t, "length: %.17g m\nduration: %.17g s\ndensity: %.17g kg/m\n", c->length, c->duration,
        c->density);
    add_field(&t, c, BR_AXIAL);
    add_field(&t, c, BR_BENDING);
    if (c->contact)
        add(&t, "\ncontact:\n  gap: %.17g m\n  stiffness: %.17g N/m\n", c->gap,
            c->contact_stiffness);
    if (c->law == BR_FRICTIONLESS)
        return;
    const bool tresca = c->law == BR_TRESCA;
    add(&t, "\nfriction:\n  law: %s\n  %s: %.17g %s\n", br_friction_law_names[c->law],
        tresca ? "bound" : "coefficient", c->friction, tresca ? "N" : "N/m");
    if (c->regularisation > 0)
        add(&t, "  regularisation: %.17g m/s\n", c->regularisation);
}

/* What the program takes: no option that the method does not heed, and every number to its last
 * bit. */
void br_extreme_command(const struct br_extreme_case *c, const char *name,
                        char text[BR_EXTREME_COMMAND])
{
    struct text t = {text, BR_EXTREME_COMMAND};
    char options[BR_METHOD_TEXT];
    const struct br_scene scene = {.axial.modelled = c->field[BR_AXIAL].modelled,
                                   .contact.modelled = c->contact,
                                   .friction.law = c->law};
    add(&t, "beamrate run %s --check --n %zu --steps %zu%s", name, c->n, c->steps,
        br_method_options(&scene, &c->method, options));
    if (c->wanted)
        add(&t, " --fields axial,bending");
}
