/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Command lines that repeat what a plan proposes. */
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "study/scene/quote.h"
#include "tables/plan_emitter.h"

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

void br_plan_run_line(const struct br_plan_page *page, char line[BR_PLAN_LINE])
{
    const struct br_plan *p = page->plan;
    line[0] = '\0';
    if (p->chosen == p->count)
        return;
    const struct br_trial *t = &p->trial[p->chosen];
    const struct br_method method = br_trial_method(t);
    char options[BR_METHOD_TEXT];
    append(line, "beamrate run");
    append_word(line, page->scene_word);
    append(line, " --n %zu --k T/%zu%s", t->at.n, t->at.steps,
           br_method_options(p->request.scene, &method, options));
}

void br_plan_trade_line(const struct br_plan_page *page, char line[BR_PLAN_LINE])
{
    const struct br_plan *p = page->plan;
    line[0] = '\0';
    if (p->chosen == p->count)
        return;
    const struct br_trial *t = &p->trial[p->chosen];
    append(line, "beamrate trade");
    append_word(line, page->scene_word);
    append(line, " --methods %s --n %zu", t->contender->name, t->at.n);
    if (br_contender_adaptive(t->contender))
        append(line, " --tolerances %.15g", t->tolerance);
    else
        append(line, " --k T/%zu", t->at.steps);
    if (p->norm[0] != br_norms[0])
        append(line, " --norm %s", p->norm[0]->name);
}
