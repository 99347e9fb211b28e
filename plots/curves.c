/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The total error against h, one curve per k, and against k, one curve per n. */
#include "plots/page.h"

#include <math.h>

static const struct br_columns columns = {.parts = 1, .part = {BR_PART_TOTAL}};

enum { MOST_ENTRIES = 8, MOST_SPACED_ENTRIES = 6 };

static bool always(const struct br_report *report)
{
    return br_report_fitted(report)->n_count > 0 && br_report_fitted(report)->k_count > 0;
}

/* The other axis' list: a curve for each entry. */
static const size_t *curve_list(const struct br_report *report, enum br_axis axis, size_t *count)
{
    return br_axis_list(report, axis == BR_OVER_H ? BR_OVER_K : BR_OVER_H, count);
}

static void write_curves(FILE *out, const struct br_report *report, enum br_axis axis)
{
    size_t count;
    const size_t *list = curve_list(report, axis, &count);
    const size_t curves = br_distinct(list, count);
    for (size_t curve = 0; curve < curves; curve++)
        fprintf(out,
                "%sdata index %zu using 2:3:(mark(%d, strcol(4))) with linespoints ls %zu "
                "pt variable notitle, \\\n",
                curve ? "     " : "plot ", curve, br_pen_of(curve, curves).mark, curve + 1);
}

/* Ends the plot command. Beside the frame is room for MOST_ENTRIES; the pens change
 * steadily, so that of more curves every second or third will do. */
static void write_key_entries(FILE *out, const struct br_report *report, enum br_axis axis)
{
    size_t count, curve = 0;
    const size_t *list = curve_list(report, axis, &count);
    const size_t every = (br_distinct(list, count) + MOST_ENTRIES - 1) / MOST_ENTRIES;
    for (size_t i = br_next(list, count, 0); i < count; i = br_next(list, count, list[i])) {
        if (curve++ % every != 0)
            continue;
        fprintf(out, "%s     keyentry with linespoints ls %zu title '", curve > 1 ? ", \\\n" : "",
                curve);
        if (axis == BR_OVER_H)
            fprintf(out, "k = %.3g s'", br_axis_value(report, BR_OVER_K, list[i]));
        else
            fprintf(out, "n = %zu'", list[i]);
    }
    fputc('\n', out);
}

static void write_page(FILE *out, const struct br_report *report, const struct br_plot *plot,
                       const char *stem, struct br_frame *frame)
{
    size_t count;
    const size_t *list = curve_list(report, frame->axis, &count);
    const size_t curves = br_distinct(list, count);
    frame->left = 0.11;
    frame->right = 0.77;
    frame->bottom = 0.125;
    frame->top = 0.775;
    frame->y = (struct br_range){INFINITY, 0};
    frame->numbered = true;
    frame->page = BR_PAGE_NARROW;
    br_include_blocks(&frame->y, report, frame->axis, &columns);
    br_write_head(out, report, plot, stem);
    br_write_loop(out, BR_PAGE_NARROW, BR_PAGE_HEIGHT);
    br_write_pens(out, curves);
    br_write_caption(out, report, BR_PAGE_NARROW);
    br_write_orders(out, report, BR_PART_TOTAL, 0.905);
    br_write_frame(out, report, frame);
    br_write_hollow(out, report, &columns, 0.98, 0.905);
    fprintf(out,
            "set key at screen 0.785,%.3f left top Left reverse samplen 4 spacing %s "
            "font ',%d'\n",
            frame->top, curves > MOST_SPACED_ENTRIES ? "1" : "1.25", BR_PAGE_SMALL);
    write_curves(out, report, frame->axis);
    write_key_entries(out, report, frame->axis);
    br_write_foot(out);
}

static void write_data_h(FILE *out, const struct br_report *report)
{
    br_write_heading(out, report, &br_plot_h);
    br_write_blocks(out, report, BR_OVER_H, &columns);
}

static void write_data_k(FILE *out, const struct br_report *report)
{
    br_write_heading(out, report, &br_plot_k);
    br_write_blocks(out, report, BR_OVER_K, &columns);
}

/* The bounds of the theory, and what the elements can do on smooth solutions, in the norm: one
 * order less for each derivative. */
static void write_script_h(FILE *out, const struct br_report *report, const char *stem)
{
    const struct br_study *study = br_report_fitted(report);
    struct br_order order[4] = {{0.5, "1/2  bound (26)"}, {1, "1  Remark 2.5"}};
    size_t orders = 2;
    if (study->scene->axial.modelled && !study->norm->energy)
        order[orders++] = (struct br_order){2, "2  axial, P1"};
    if (study->scene->bending.modelled)
        order[orders++] = study->norm->energy ? (struct br_order){2, "2  bending, Hermite"}
                                              : (struct br_order){4, "4  bending, Hermite"};
    write_page(out, report, &br_plot_h, stem,
               &(struct br_frame){.axis = BR_OVER_H, .order = order, .orders = orders});
}

static void write_script_k(FILE *out, const struct br_report *report, const char *stem)
{
    static const struct br_order order = {1, "1  (26), Euler"};
    write_page(out, report, &br_plot_k, stem,
               &(struct br_frame){.axis = BR_OVER_K, .order = &order, .orders = 1});
}

const struct br_plot br_plot_h = {
    .name = "h",
    .title = "The error against the mesh size h, one curve per time step k.",
    .applies = always,
    .write_data = write_data_h,
    .write_script = write_script_h,
};

const struct br_plot br_plot_k = {
    .name = "k",
    .title = "The error against the time step k, one curve per number of elements n.",
    .applies = always,
    .write_data = write_data_k,
    .write_script = write_script_k,
};
