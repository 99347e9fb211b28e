/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Command lines that repeat what a plan proposes. */
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/report_plan.h"

__attribute__((format(printf, 2, 3))) static void append(char line[BR_PLAN_LINE],
                                                         const char *format, ...)
{
    const size_t used = strlen(line);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, BR_PLAN_LINE - used, format, arguments);
    va_end(arguments);
}

static void append_word(char line[BR_PLAN_LINE], const char *word)
{
    const size_t used = strlen(line);
    snprintf(line + used, BR_PLAN_LINE - used, " ");
    br_quoted(line + used + 1, BR_PLAN_LINE - used - 1, &br_for_shell, word);
}

/* The words of a method that are not the defaults of `run`. */
static void append_method(char line[BR_PLAN_LINE], const struct br_method *m,
                          const struct br_scene *scene)
{
    const struct br_method usual = br_method_default();
    if (m->scheme != usual.scheme)
        append(line, " --scheme %s", m->scheme->name);
    if (m->scheme->adaptive)
        append(line, " --tolerance %.15g", m->tolerance);
    if (scene->contact.modelled && m->scheme->may_lag && m->contact != usual.contact)
        append(line, " --contact %s", m->contact->name);
    if (scene->friction.law != BR_FRICTIONLESS && m->friction != usual.friction)
        append(line, " --friction %s", m->friction->name);
    if (scene->axial.modelled && m->axial_degree != usual.axial_degree)
        append(line, " --axial-degree %d", m->axial_degree);
    if (m->solver != usual.solver)
        append(line, " --solver %s", m->solver->name);
    if (strcmp(m->linear.scaling, usual.linear.scaling) != 0)
        append(line, " --scaling %s", m->linear.scaling);
    if (m->linear.refinement != usual.linear.refinement)
        append(line, " --refinement %d", (int)m->linear.refinement);
}

void br_plan_run_line(const struct br_plan *p, const char *scene_word, char line[BR_PLAN_LINE])
{
    line[0] = '\0';
    if (p->chosen == p->count)
        return;
    const struct br_trial *t = &p->trial[p->chosen];
    const struct br_method method = br_trial_method(t);
    append(line, "beamrate run");
    append_word(line, scene_word);
    append(line, " --n %zu --k %.15g", t->at.n, br_time_step(p->request.scene, t->at.steps));
    append_method(line, &method, p->request.scene);
}

void br_plan_trade_line(const struct br_plan *p, const char *scene_word, char line[BR_PLAN_LINE])
{
    line[0] = '\0';
    if (p->chosen == p->count)
        return;
    const struct br_trial *t = &p->trial[p->chosen];
    append(line, "beamrate trade");
    append_word(line, scene_word);
    append(line, " --methods %s --n %zu", t->contender->name, t->at.n);
    if (br_contender_adaptive(t->contender))
        append(line, " --tolerances %.15g", t->tolerance);
    else
        append(line, " --k %.15g", br_time_step(p->request.scene, t->at.steps));
    if (p->norm[0] != br_norms[0])
        append(line, " --norm %s", p->norm[0]->name);
}
