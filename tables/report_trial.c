/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_trial.h"

#include <math.h>
#include <stdarg.h>

#include "tables/report_method.h"

void br_row_add(struct br_row *row, const struct br_column *column, struct br_value value)
{
    row->full = row->cells == BR_MOST_COLUMNS;
    if (row->full)
        return;
    row->column[row->cells] = *column;
    row->value[row->cells++] = value;
}

void br_row_hide(struct br_row *row, const char *key, const char *unit, struct br_value value)
{
    BR_ADD(row, value, .key = key, .unit = unit, .flags = BR_FOR_PROGRAMS);
}

void br_row_shown(struct br_row *row, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(row->shown[row->cells - 1], sizeof *row->shown, format, arguments);
    va_end(arguments);
}

void br_row_empty(struct br_row *row, size_t first)
{
    for (size_t i = first; i < row->cells; i++) {
        row->value[i] = br_nothing();
        *row->shown[i] = '\0';
    }
}

void br_put_whole_row(struct br_document *d, const struct br_row *row)
{
    const struct br_block *last = d->blocks ? &d->block[d->blocks - 1] : NULL;
    if (last && last->table && last->table->rows == 0)
        for (size_t i = 0; i < row->cells; i++)
            br_put_column(d, &row->column[i]);
    br_put_row(d);
    if (row->full)
        br_put(d, "more columns than a row has", br_nothing());
    for (size_t i = 0; i < row->cells; i++) {
        br_put(d, row->column[i].key, row->value[i]);
        if (*row->shown[i])
            br_put_shown(d, "%s", row->shown[i]);
    }
}

/* k, s; NaN where the steps are chosen. */
static double step_of(const struct br_scene *scene, const struct br_trial *t)
{
    return br_contender_adaptive(t->contender) ? (double)NAN : br_time_step(scene, t->at.steps);
}

void br_row_add_trial(struct br_row *row, const struct br_scene *scene, const struct br_trial *t)
{
    const bool adaptive = br_contender_adaptive(t->contender);
    BR_ADD(row, br_text(t->contender->name), .key = "method");
    BR_ADD(row, br_count(t->at.n), .key = "n");
    br_row_hide(row, "steps_or_levels", NULL, br_count(t->at.steps));
    br_row_hide(row, "tolerance", NULL, br_number(adaptive ? t->tolerance : NAN));
    BR_ADD(row, br_number(step_of(scene, t)), .key = "k", .unit = "s");
    if (adaptive)
        br_row_shown(row, "tol %.4g", t->tolerance);
}

void br_row_add_method(struct br_row *row, const struct br_method *m)
{
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        br_row_hide(row, br_method_field_key(f, row->text[2 * i]), NULL,
                    br_method_value(f, m, row->text[2 * i + 1]));
    }
}

const char *br_trial_text(const struct br_scene *scene, const struct br_trial *t,
                          char text[BR_TRIAL_TEXT])
{
    if (br_contender_adaptive(t->contender))
        snprintf(text, BR_TRIAL_TEXT, "%s, n = %zu, tolerance %.4g", t->contender->name, t->at.n,
                 t->tolerance);
    else
        snprintf(text, BR_TRIAL_TEXT, "%s, n = %zu, k = %.6g s", t->contender->name, t->at.n,
                 step_of(scene, t));
    return text;
}

void br_put_hidden_fact(struct br_document *d, const char *key, struct br_value value)
{
    br_put_fact(d, &(struct br_column){.key = key, .flags = BR_FOR_PROGRAMS}, value);
}
