/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_parts.h"

#include <math.h>
#include <stdlib.h>

#include "study/fit/fit.h"

/* text: a buffer for a value that is a text. */
static struct br_value value_of(const struct br_method_field *f, const struct br_method *m,
                                char text[BR_METHOD_VALUE])
{
    const bool whole = f == &br_method_fields[BR_METHOD_DEGREE] || (!f->words && f->range.whole);
    if (!br_method_field_reported(f, m))
        return br_nothing();
    if (whole)
        return br_count((size_t)atoll(br_method_field_text(f, m, text)));
    return f->words ? br_text(br_method_field_text(f, m, text)) : br_number(f->get(m));
}

/* Fields of a group are members of one object, which is null where the method does not use them. */
void br_put_method_facts(struct br_document *d, const char *key, const struct br_method *m,
                         const struct br_meshes *on)
{
    const char *group = NULL;
    char taken[BR_METHOD_TEXT];
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        char text[BR_METHOD_VALUE];
        const struct br_value value = value_of(f, m, text);
        if (!f->group)
            br_hide_fact(d, value, NULL, "%s.%s", key, br_method_field_key(f));
        else if (br_method_field_used(f, m))
            br_hide_fact(d, value, NULL, "%s.%s.%s", key, f->group, f->member);
        else if (f->group != group)
            br_hide_fact(d, br_nothing(), NULL, "%s.%s", key, f->group);
        group = f->group;
    }
    br_hide_fact(d, br_text(br_method_taken(on, m, taken)), NULL, "%s.solver_taken", key);
}

void br_put_method_cells(struct br_document *d, const struct br_method *m)
{
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        char text[BR_METHOD_VALUE];
        br_hide(d, br_method_field_key(&br_method_fields[i]), NULL,
                value_of(&br_method_fields[i], m, text));
    }
}

/* k, s; NaN where the scheme chooses its steps. */
static double step_of(const struct br_scene *scene, const struct br_trial *t)
{
    return t->named->method.scheme->adaptive ? (double)NAN : br_time_step(scene, t->at.steps);
}

void br_put_trial(struct br_document *d, const struct br_scene *scene, const struct br_trial *t)
{
    const bool adaptive = t->named->method.scheme->adaptive;
    BR_PUT(d, br_text(t->named->name), .key = "method");
    BR_PUT(d, br_count(t->at.n), .key = "n");
    char taken[BR_METHOD_TEXT];
    br_hide(d, "solver_taken", NULL,
            br_text(br_method_taken(&(struct br_meshes){scene, &t->at.n, 1}, &t->named->method,
                                    taken)));
    br_hide(d, "steps_or_levels", NULL, br_count(t->at.steps));
    br_hide(d, "tolerance", NULL, br_if(adaptive, br_number(t->tolerance)));
    BR_PUT(d, br_number(step_of(scene, t)), .key = "k", .unit = "s");
    if (adaptive)
        br_put_shown(d, "tol %.4g", t->tolerance);
}

const char *br_trial_text(const struct br_scene *scene, const struct br_trial *t,
                          char text[BR_TRIAL_TEXT])
{
    if (t->named->method.scheme->adaptive)
        snprintf(text, BR_TRIAL_TEXT, "%s, n = %zu, tolerance %.4g", t->named->name, t->at.n,
                 t->tolerance);
    else
        snprintf(text, BR_TRIAL_TEXT, "%s, n = %zu, k = %.6g s", t->named->name, t->at.n,
                 step_of(scene, t));
    return text;
}

void br_put_estimate(struct br_document *d, const struct br_column *column,
                     const struct br_estimate *e, const char *shown)
{
    char low[32], high[32];
    snprintf(low, sizeof low, "%s_low", column->key);
    snprintf(high, sizeof high, "%s_high", column->key);
    br_put_cell(d, column, br_number(e->value));
    if (shown && isfinite(e->value))
        br_put_shown(d, "%s", shown);
    br_hide(d, low, column->unit, br_number(e->low));
    br_hide(d, high, column->unit, br_number(e->high));
}
