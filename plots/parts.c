/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Axial and bending apart, each where the other discretisation is finest. */
#include "plots/page.h"

#include <math.h>

static const struct br_columns columns = {.parts = 3,
                                          .part = {BR_PART_TOTAL, BR_PART_AXIAL, BR_PART_BENDING}};

static bool applies(const struct br_report *report)
{
    const struct br_study *study = br_report_fitted(report);
    return study->n_count > 0 && study->k_count > 0 && study->scene->axial.modelled &&
           study->scene->bending.modelled;
}

static void write_data(FILE *out, const struct br_report *report)
{
    const struct br_study *study = br_report_fitted(report);
    br_write_heading(out, report, &br_plot_parts);
    br_write_block(out, report, BR_OVER_H, br_largest(study->steps, study->k_count), &columns);
    br_write_block(out, report, BR_OVER_K, br_largest(study->n, study->n_count), &columns);
}

static void write_curves(FILE *out, int block, bool with_key)
{
    for (size_t p = 0; p < columns.parts; p++)
        fprintf(out,
                "%sdata index %d using 2:%zu:(mark(%d, strcol(%zu))) with linespoints ls %zu "
                "pt variable notitle",
                p ? ", \\\n     " : "plot ", block, 3 + 2 * p, br_pen_of(p, columns.parts).mark,
                4 + 2 * p, p + 1);
    for (size_t p = 0; p < columns.parts && with_key; p++)
        fprintf(out, ", \\\n     keyentry with linespoints ls %zu title '%s'", p + 1,
                br_part_names[columns.part[p]]);
    fputc('\n', out);
}

static void write_panels(FILE *out, const struct br_report *report, struct br_frame frame)
{
    static const struct br_order over_h[] = {{1, "1"}, {2, "2"}, {4, "4"}}, over_k = {1, "1"};
    const struct br_study *study = br_report_fitted(report);
    const size_t n = study->n[br_largest(study->n, study->n_count)];
    const size_t steps = study->steps[br_largest(study->steps, study->k_count)];
    char note[64];

    frame.axis = BR_OVER_H;
    frame.left = 0.085, frame.right = 0.445;
    frame.order = over_h, frame.orders = 3;
    frame.numbered = true;
    snprintf(note, sizeof note, ", at k = %.4g s", br_time_step(study->scene, steps));
    frame.note = note;
    br_write_frame(out, report, &frame);
    fputs("unset key\n", out);
    write_curves(out, 0, false);

    fputs("unset label\nunset arrow\n", out);
    frame.axis = BR_OVER_K;
    frame.left = 0.5, frame.right = 0.86;
    frame.order = &over_k, frame.orders = 1;
    frame.numbered = false;
    snprintf(note, sizeof note, ", at n = %zu", n);
    br_write_frame(out, report, &frame);
    fprintf(out,
            "set key at screen 0.87,%.3f left top Left reverse samplen 3 spacing 1.25 "
            "font ',%d'\n",
            frame.top, BR_PAGE_SMALL);
    write_curves(out, 1, true);
}

static void write_script(FILE *out, const struct br_report *report, const char *stem)
{
    const struct br_study *study = br_report_fitted(report);
    struct br_frame frame = {
        .bottom = 0.125, .top = 0.73, .y = {INFINITY, 0}, .page = BR_PAGE_WIDE};
    br_include_block(&frame.y, report, BR_OVER_H, br_largest(study->steps, study->k_count),
                     &columns);
    br_include_block(&frame.y, report, BR_OVER_K, br_largest(study->n, study->n_count), &columns);
    br_write_head(out, report, &br_plot_parts, stem);
    br_write_loop(out, BR_PAGE_WIDE, BR_PAGE_HEIGHT);
    br_write_pens(out, columns.parts);
    fputs("set multiplot\n", out);
    br_write_caption(out, report, BR_PAGE_WIDE);
    br_write_orders(out, report, BR_PART_AXIAL, 0.905);
    br_write_orders(out, report, BR_PART_BENDING, 0.865);
    br_write_hollow(out, report, &columns, 0.98, 0.905);
    write_panels(out, report, frame);
    fputs("unset multiplot\n", out);
    br_write_foot(out);
}

const struct br_plot br_plot_parts = {
    .name = "parts",
    .title = "The error's axial and bending parts against h and k, the other one finest.",
    .applies = applies,
    .write_data = write_data,
    .write_script = write_script,
};
