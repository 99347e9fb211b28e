/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_trial.h"

#include <math.h>
#include <stdarg.h>

void br_row_add(struct br_row *row, const struct br_cell_of_column *cells, size_t count)
{
    for (size_t i = 0; i < count && row->cells < BR_MOST_COLUMNS; i++)
        row->cell[row->cells++] = cells[i];
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
        row->cell[i].value = br_nothing();
        *row->shown[i] = '\0';
    }
}

void br_put_whole_row(struct br_document *d, const struct br_row *row)
{
    const struct br_block *last = d->blocks ? &d->block[d->blocks - 1] : NULL;
    if (last && last->table && last->table->rows == 0)
        for (size_t i = 0; i < row->cells; i++)
            br_put_column(d, &row->cell[i].column);
    br_put_row(d);
    for (size_t i = 0; i < row->cells; i++) {
        br_put(d, row->cell[i].column.key, row->cell[i].value);
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
    const struct br_cell_of_column cells[] = {
        {{.key = "method"}, br_text(t->contender->name)},
        {{.key = "n"}, br_count(t->at.n)},
        {{.key = "steps_or_levels", .flags = BR_FOR_PROGRAMS}, br_count(t->at.steps)},
        {{.key = "tolerance", .flags = BR_FOR_PROGRAMS}, br_number(adaptive ? t->tolerance : NAN)},
        {{.key = "k", .unit = "s"}, br_number(step_of(scene, t))},
    };
    br_row_add(row, BR_CELLS(cells));
    if (adaptive)
        br_row_shown(row, "tol %.4g", t->tolerance);
}

void br_row_add_method(struct br_row *row, const struct br_method *m)
{
    const struct br_kernel *kernel = br_linear_solver_kernel(m->solver, &m->linear);
    const bool iterates = m->friction->iterates;
    const struct br_cell_of_column cells[] = {
        {{.key = "scheme"}, br_text(m->scheme->name)},
        {{.key = "contact"}, br_text(m->contact->name)},
        {{.key = "friction"}, br_text(m->friction->name)},
        {{.key = "axial_degree"}, br_count((size_t)m->axial_degree)},
        {{.key = "solver"}, br_text(m->solver->name)},
        {{.key = "kernel"}, br_text(kernel ? kernel->name : NULL)},
        {{.key = "scaling"}, br_text(m->linear.scaling)},
        {{.key = "refinement"}, br_count((size_t)m->linear.refinement)},
        {{.key = "iteration_parameter"}, br_number(iterates ? m->iteration.parameter : NAN)},
        {{.key = "iteration_tolerance"}, br_number(iterates ? m->iteration.tolerance : NAN)},
        {{.key = "iteration_most"}, iterates ? br_count(m->iteration.most) : br_nothing()},
    };
    const size_t first = row->cells;
    br_row_add(row, BR_CELLS(cells));
    for (size_t i = first; i < row->cells; i++)
        row->cell[i].column.flags = BR_FOR_PROGRAMS;
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

void br_put_program_facts(struct br_document *d, const struct br_cell_of_column *facts,
                          size_t count)
{
    for (size_t i = 0; i < count; i++)
        br_put_fact(d, &(struct br_column){.key = facts[i].column.key, .flags = BR_FOR_PROGRAMS},
                    facts[i].value);
}
