/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/data.h"

#include <math.h>

#include "study/scene/quote.h"

size_t br_next(const size_t *list, size_t count, size_t after)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if (list[i] > after && (best == count || list[i] < list[best]))
            best = i;
    return best;
}

size_t br_distinct(const size_t *list, size_t count)
{
    size_t distinct = 0;
    for (size_t i = br_next(list, count, 0); i < count; i = br_next(list, count, list[i]))
        distinct++;
    return distinct;
}

size_t br_largest(const size_t *list, size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
        if (list[i] > list[best])
            best = i;
    return best;
}

const size_t *br_axis_list(const struct br_report *report, enum br_axis axis, size_t *count)
{
    const struct br_study *study = br_report_fitted(report);
    *count = axis == BR_OVER_H ? study->n_count : study->k_count;
    return axis == BR_OVER_H ? study->n : study->steps;
}

double br_axis_value(const struct br_report *report, enum br_axis axis, size_t entry)
{
    const struct br_scene *scene = br_report_fitted(report)->scene;
    return axis == BR_OVER_H ? br_mesh_size(scene, entry) : br_time_step(scene, entry);
}

static enum br_axis other(enum br_axis axis)
{
    return axis == BR_OVER_H ? BR_OVER_K : BR_OVER_H;
}

/* The place of a cell in the study's arrays. */
static size_t place(const struct br_report *report, enum br_axis axis, size_t at, size_t fixed)
{
    const size_t i = axis == BR_OVER_H ? at : fixed, j = axis == BR_OVER_H ? fixed : at;
    return i * br_report_fitted(report)->k_count + j;
}

/* A logarithmic axis has room for positive numbers only. */
static bool is_shown(double error)
{
    return error > 0 && isfinite(error);
}

static double shown_error(const struct br_cell *cell, enum br_part part)
{
    const bool failed = cell->flag[part] == BR_FLAG_FAILED;
    return !failed && is_shown(cell->error[part]) ? cell->error[part] : (double)NAN;
}

/* gnuplot leaves out what is spelt like this. */
static void write_number(FILE *out, double value)
{
    if (isnan(value))
        fputs(" NaN", out);
    else
        fprintf(out, " %.17g", value);
}

void br_write_heading(FILE *out, const struct br_report *report, const struct br_plot *plot)
{
    fputs("# ", out);
    br_write_comment(out, report->caption);
    fputs("# ", out);
    br_write_comment(out, plot->title);
    const struct br_study *study = br_report_fitted(report);
    if (study->judge->nests)
        fprintf(out, "# Reference: n = %zu elements, N = %zu steps\n", study->reference.n,
                study->reference.steps);
    else
        fprintf(out, "# Reference: %s\n", study->judge->title);
    fputs("# A flag tells why a cell is left out of the fits; - for none. NaN: failed.\n\n", out);
}

static void write_block_heading(FILE *out, const struct br_report *report, enum br_axis axis,
                                size_t fixed, const struct br_columns *columns)
{
    size_t count;
    const size_t *list = br_axis_list(report, other(axis), &count);
    const char *unit = br_report_fitted(report)->norm->unit;
    if (axis == BR_OVER_H)
        fprintf(out, "# N = %zu, k = %.17g s\n# n h(m)", list[fixed],
                br_axis_value(report, other(axis), list[fixed]));
    else
        fprintf(out, "# n = %zu, h = %.17g m\n# N k(s)", list[fixed],
                br_axis_value(report, other(axis), list[fixed]));
    for (size_t p = 0; p < columns->parts; p++)
        fprintf(out, " %s(%s) flag", br_part_names[columns->part[p]], unit);
    if (columns->printed)
        fprintf(out, " printed(%s)", unit);
    fputc('\n', out);
}

static void write_row(FILE *out, const struct br_report *report, size_t cell,
                      const struct br_columns *columns)
{
    const struct br_cell *shown = &br_report_fitted(report)->cell[cell];
    for (size_t p = 0; p < columns->parts; p++) {
        const enum br_part part = columns->part[p];
        const char *flag = br_flag_name(shown->flag[part]);
        write_number(out, shown_error(shown, part));
        fprintf(out, " %s", *flag ? flag : "-");
    }
    if (columns->printed)
        write_number(out, report->printed[cell]);
    fputc('\n', out);
}

void br_write_block(FILE *out, const struct br_report *report, enum br_axis axis, size_t fixed,
                    const struct br_columns *columns)
{
    size_t count;
    const size_t *list = br_axis_list(report, axis, &count);
    write_block_heading(out, report, axis, fixed, columns);
    for (size_t i = br_next(list, count, 0); i < count; i = br_next(list, count, list[i])) {
        fprintf(out, "%zu %.17g", list[i], br_axis_value(report, axis, list[i]));
        write_row(out, report, place(report, axis, i, fixed), columns);
    }
    fputs("\n\n", out);
}

void br_write_blocks(FILE *out, const struct br_report *report, enum br_axis axis,
                     const struct br_columns *columns)
{
    size_t count;
    const size_t *list = br_axis_list(report, other(axis), &count);
    for (size_t i = br_next(list, count, 0); i < count; i = br_next(list, count, list[i]))
        br_write_block(out, report, axis, i, columns);
}

static void include(struct br_range *range, double value)
{
    if (!is_shown(value))
        return;
    range->low = fmin(range->low, value);
    range->high = fmax(range->high, value);
}

void br_include_block(struct br_range *range, const struct br_report *report, enum br_axis axis,
                      size_t fixed, const struct br_columns *columns)
{
    size_t count;
    br_axis_list(report, axis, &count);
    for (size_t i = 0; i < count; i++) {
        const size_t cell = place(report, axis, i, fixed);
        for (size_t p = 0; p < columns->parts; p++)
            include(range, shown_error(&br_report_fitted(report)->cell[cell], columns->part[p]));
        if (columns->printed)
            include(range, report->printed[cell]);
    }
}

void br_include_blocks(struct br_range *range, const struct br_report *report, enum br_axis axis,
                       const struct br_columns *columns)
{
    size_t count;
    br_axis_list(report, other(axis), &count);
    for (size_t i = 0; i < count; i++)
        br_include_block(range, report, axis, i, columns);
}
