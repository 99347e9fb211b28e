/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/run/run.h"

#include <stdarg.h>
#include <stdio.h>

#include "solver/laws.h"

enum br_status br_model_select(const struct br_scene *scene, unsigned wanted,
                               struct br_scene *marched, struct br_error *err)
{
    *marched = *scene;
    if ((wanted & BR_WANT_AXIAL) && !scene->axial.modelled)
        return br_fail(err, BR_BAD_INPUT, "--fields: found axial, but the scene has no axial part");
    if ((wanted & BR_WANT_BENDING) && !scene->bending.modelled)
        return br_fail(err, BR_BAD_INPUT,
                       "--fields: found bending, but the scene has no bending part");
    const struct br_friction *friction = &scene->friction;
    const bool alone = br_friction_rubs(friction) && !br_friction_follows_contact(friction);
    marched->axial.modelled =
        scene->axial.modelled && (wanted ? (wanted & BR_WANT_AXIAL) != 0 : !alone);
    marched->bending.modelled = scene->bending.modelled && (!wanted || (wanted & BR_WANT_BENDING));
    marched->contact.modelled = scene->contact.modelled && marched->axial.modelled;
    if (!marched->bending.modelled)
        marched->friction.law = BR_FRICTIONLESS;
    if (br_friction_follows_contact(&marched->friction) && !marched->contact.modelled)
        return br_fail(err, BR_BAD_INPUT,
                       "--fields: found bending alone, but %s's friction bound is %s, expected "
                       "axial,bending",
                       br_friction_models[friction->law].title,
                       br_friction_models[friction->law].words);
    return BR_OK;
}

/* ---- rows ---- */

__attribute__((format(printf, 5, 6))) static void add(struct br_run_report *r, const char *key,
                                                      const char *part, bool modelled,
                                                      const char *format, ...)
{
    struct br_model_row *row = &r->model[r->model_rows++];
    *row = (struct br_model_row){.key = key, .part = part, .modelled = modelled};
    va_list args;
    va_start(args, format);
    vsnprintf(row->why, sizeof row->why, format, args);
    va_end(args);
}

static void add_fields(struct br_run_report *r)
{
    const struct br_scene *s = r->scene, *m = &r->marched;
    const bool alone = m->bending.modelled && br_friction_rubs(&s->friction) &&
                       !br_friction_follows_contact(&s->friction);
    if (m->axial.modelled)
        add(r, "axial", "axial field", true, "%zu unknowns, P%d elements",
            r->n * (size_t)r->method.axial_degree, r->method.axial_degree);
    else if (alone && s->axial.modelled)
        add(r, "axial", "axial field", false,
            "not asked for: %s's bound does not depend on it, nor does bending; --fields "
            "axial,bending marches it",
            br_friction_models[s->friction.law].title);
    else
        add(r, "axial", "axial field", false, "%s",
            s->axial.modelled ? "not asked for by --fields" : "the scene has no axial part");
    if (m->bending.modelled)
        add(r, "bending", "bending field", true, "%zu unknowns, cubic Hermite elements", 2 * r->n);
    else
        add(r, "bending", "bending field", false, "%s",
            s->bending.modelled ? "not asked for by --fields" : "the scene has no bending part");
}

static void add_laws(struct br_run_report *r)
{
    const struct br_scene *s = r->scene, *m = &r->marched;
    const char *title = r->method.friction->title;
    const struct br_friction_model *law = &br_friction_models[m->friction.law];
    add(r, "contact", "contact", m->contact.modelled, "%s%s",
        m->contact.modelled   ? "normal compliance (10), "
        : s->contact.modelled ? "it acts on the axial field, which is not marched"
                              : "the scene has no contact part: no lagged force",
        m->contact.modelled ? r->method.contact->title : "");
    if (br_friction_follows_contact(&m->friction))
        add(r, "friction", "friction", true, "%s, the bound is %s; %s", law->title, law->words,
            title);
    else if (br_friction_rubs(&m->friction))
        add(r, "friction", "friction", true, "%s, the bound is %s, %g N; %s", law->title,
            law->words, br_friction_bound(m, 0), title);
    else
        add(r, "friction", "friction", false, "%s",
            br_friction_rubs(&s->friction) ? "it acts on the bending field, which is not marched"
                                           : "the scene has no friction part: no friction algebra");
}

static void add_terms(struct br_run_report *r, const char *key, const char *part,
                      const struct br_load *load)
{
    size_t moving = 0, quadrature = 0, products = 0, histories = 0;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &load->term[i];
        if (br_product_is_zero(p))
            continue;
        moving += p->space.uses_t;
        products += !p->space.uses_t;
        quadrature += p->space.uses_x && !p->space.uses_t;
        histories += p->time.uses_t;
    }
    const char *how = quadrature ? "F(x) G(t): assembled once, by quadrature"
                                 : "without x: assembled once, in closed form";
    const char *history = histories ? "one evaluation of its history in each step"
                                    : "its history is constant: no work in a step";
    if (moving)
        add(r, key, part, true, "f(x, t): quadrature every step, %zu evaluations",
            5 * moving * r->n);
    else if (products > 1)
        add(r, key, part, true,
            "%zu products F(x) G(t): assembled once; in each step their sum, with %zu histories",
            products, histories);
    else
        add(r, key, part, true, "%s; %s", how, history);
}

static void add_load(struct br_run_report *r, enum br_field_kind kind)
{
    static const char *const keys[] = {"axial_load", "bending_load"}, *const parts[] = {
                                                                          "axial load",
                                                                          "bending load"};
    const struct br_scene_field *f = &r->marched.field[kind];
    if (!f->modelled)
        return;
    if (br_load_is_zero(&f->load))
        add(r, keys[kind], parts[kind], false, "the scene has none");
    else
        add_terms(r, keys[kind], parts[kind], &f->load);
}

static void add_tip_loads(struct br_run_report *r)
{
    const struct br_scene *s = &r->marched;
    const struct {
        const char *key, *part;
        bool marched;
        const struct br_function *f;
    } loads[] = {
        {"axial_tip_force", "axial tip force", s->axial.modelled, &s->axial.tip_force},
        {"bending_tip_force", "bending tip force", s->bending.modelled, &s->bending.tip_force},
        {"bending_tip_moment", "bending tip moment", s->bending.modelled, &s->bending.tip_moment},
    };
    for (size_t i = 0; i < sizeof loads / sizeof *loads; i++)
        if (loads[i].marched && !br_function_is_zero(loads[i].f))
            add(r, loads[i].key, loads[i].part, true, "%s",
                loads[i].f->uses_t ? "one evaluation a step" : "constant");
}

static bool has_initial(const struct br_scene_field *f)
{
    return f->modelled &&
           !(br_function_is_zero(&f->displacement) && br_function_is_zero(&f->velocity));
}

static void add_initial(struct br_run_report *r)
{
    const bool axial = has_initial(&r->marched.axial), bending = has_initial(&r->marched.bending);
    if (axial || bending)
        add(r, "initial_data", "initial data", true, "interpolated once, at the nodes%s: %s",
            axial && r->method.axial_degree == 2 ? " and midpoints" : "",
            axial && bending ? "both fields"
            : axial          ? "axial"
                             : "bending");
    else
        add(r, "initial_data", "initial data", false, "zero: not interpolated");
}

void br_run_fill_model(struct br_run_report *r)
{
    add_fields(r);
    add_laws(r);
    add_load(r, BR_AXIAL);
    add_load(r, BR_BENDING);
    add_tip_loads(r);
    add_initial(r);
    if (r->summed)
        add(r, "nodal_fields", "nodal fields", true,
            "rebuilt every step, for the certificate and the energies");
    else
        add(r, "nodal_fields", "nodal fields", true,
            "rebuilt at t = 0, at %zu output time%s and at the end, not in the steps", r->levels,
            r->levels == 1 ? "" : "s");
}
