/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>

#include "study/ranks/batches.h"
#include "study/scene/method_fields.h"

/* FNV-1a, 64 bits. */
static void add(unsigned long long *hash, const char *text)
{
    for (; *text; text++)
        *hash = (*hash ^ (unsigned char)*text) * 0x100000001b3ull;
    *hash = (*hash ^ 0xff) * 0x100000001b3ull;
}

/* Nine digits: the last bits may be another processor's. */
static void add_number(unsigned long long *hash, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.9g", value);
    add(hash, text);
}

static void add_counts(unsigned long long *hash, const size_t *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_number(hash, (double)list[i]);
    add(hash, "");
}

static void add_function(unsigned long long *hash, const struct br_function *f,
                         const struct br_scene *s)
{
    static const double place[] = {0, 0.137, 0.5, 0.823, 1};
    enum { PLACES = sizeof place / sizeof *place };
    double x[PLACES], value[PLACES];
    for (size_t i = 0; i < PLACES; i++)
        x[i] = place[i] * s->length;
    for (size_t j = 0; j < PLACES; j++) {
        br_function_evaluate(f, PLACES, x, place[j] * s->duration, value);
        for (size_t i = 0; i < PLACES; i++)
            add_number(hash, value[i]);
    }
}

static void add_scene(unsigned long long *hash, const struct br_scene *s)
{
    const double number[] = {
        s->length,
        s->duration,
        s->density,
        s->axial.modelled,
        s->axial.stiffness,
        s->axial.viscosity,
        s->bending.modelled,
        s->bending.stiffness,
        s->bending.viscosity,
        s->contact.modelled,
        s->contact.gap,
        s->contact.stiffness,
        (double)s->friction.law,
        s->friction.coefficient,
        s->friction.regularisation,
    };
    struct br_scene borrowed = *s;
    const struct br_function *f;
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        add_number(hash, number[i]);
    for (size_t i = 0; (f = br_scene_function(&borrowed, i)); i++)
        add_function(hash, f, s);
}

/* All but what is the machine's own: its instruction set. */
static void add_method(unsigned long long *hash, const struct br_method *m)
{
    char text[BR_METHOD_VALUE];
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        if (!f->unsaid && br_method_field_heeded(f, m))
            add(hash, br_method_field_text(f, m, text));
    }
}

static void add_study(unsigned long long *hash, const struct br_study *s)
{
    add_counts(hash, s->n, s->n_count);
    add_counts(hash, s->steps, s->k_count);
    add_counts(hash, (const size_t[]){s->path, s->reference.n, s->reference.steps}, 3);
    for (size_t cell = 0; cell < (s->cell_method ? br_study_cells(s) : 1); cell++)
        add_method(hash, br_study_method(s, cell));
    add_method(hash, &s->reference_method);
    add(hash, s->judge->name);
    add(hash, s->auditor ? s->auditor->name : "");
    for (; s; s = s->next_norm)
        add(hash, s->norm->name);
}

unsigned long long br_studies_fingerprint(const struct br_study *studies, size_t count)
{
    unsigned long long hash = 0xcbf29ce484222325ull;
    add_counts(&hash, (const size_t[]){count, sizeof(struct br_cell)}, 2);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || studies[i].scene != studies[i - 1].scene)
            add_scene(&hash, studies[i].scene);
        add_study(&hash, &studies[i]);
    }
    return hash;
}
