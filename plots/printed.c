/* SPDX-License-Identifier: GPL-3.0-or-later */
/* This program's errors and the paper's printed ones in one picture. */
#include "plots/page.h"

#include <math.h>

static const struct br_columns columns = {.parts = 1, .part = {BR_PART_TOTAL}, .printed = true};

static bool applies(const struct br_report *report)
{
    return report->printed && br_report_fitted(report)->n_count > 0 &&
           br_report_fitted(report)->k_count > 0;
}

static void write_data(FILE *out, const struct br_report *report)
{
    br_write_heading(out, report, &br_plot_printed);
    br_write_blocks(out, report, BR_OVER_K, &columns);
    br_write_blocks(out, report, BR_OVER_H, &columns);
}

/* Colour and dashes tell whose error it is, the marks which curve. */
static void write_styles(FILE *out)
{
    fputs("set style line 1 lw 2.5 lc rgb '#0d0887' dt solid pi -1 # this program\n"
          "set style line 2 lw 2.5 lc rgb '#e8704f' dt (10,5) pi -1 # printed\n"
          "set style line 3 lc rgb '#444444' # marks in the keys\n",
          out);
}

static void write_legend(FILE *out)
{
    fprintf(out,
            "set arrow from screen 0.02,0.905 to screen 0.07,0.905 nohead ls 1\n"
            "set label 'computed by this program' at screen 0.08,0.905 left font ',%d'\n"
            "set arrow from screen 0.36,0.905 to screen 0.41,0.905 nohead ls 2\n"
            "set label 'printed in the paper' at screen 0.42,0.905 left font ',%d'\n",
            BR_PAGE_SMALL, BR_PAGE_SMALL);
}

static void write_key(FILE *out, const struct br_frame *frame, size_t curves)
{
    fprintf(out,
            "set key at screen %.3f,0.13 center top horizontal Left reverse samplen 0.5 width %d "
            "maxcols %d spacing 1.1 font ',%d'\n",
            (frame->left + frame->right) / 2, frame->axis == BR_OVER_H ? -2 : 0, curves > 9 ? 5 : 3,
            curves > 9 ? 14 : BR_PAGE_SMALL);
}

/* Both errors along the frame's axis, one pair of curves for each entry of the other's
 * list, from block `first` on. */
static void write_curves(FILE *out, const struct br_report *report, enum br_axis axis, size_t first)
{
    const enum br_axis other = axis == BR_OVER_H ? BR_OVER_K : BR_OVER_H;
    size_t count, curve = 0;
    const size_t *list = br_axis_list(report, other, &count);
    const size_t curves = br_distinct(list, count);
    for (size_t i = br_next(list, count, 0); i < count; i = br_next(list, count, list[i])) {
        const struct br_pen pen = br_pen_of(curve, curves);
        fprintf(out,
                "%sdata index %zu using 2:5 with linespoints ls 2 pt %d ps %.2f*size notitle, \\\n"
                "     '' index %zu using 2:3:(mark(%d, strcol(4))) with linespoints ls 1 "
                "pt variable ps %.2f*size notitle, \\\n"
                "     keyentry with points ls 3 pt %d ps 1.8*size title '",
                curve ? ", \\\n     " : "plot ", first + curve, pen.mark, pen.size, first + curve,
                pen.mark, pen.size, pen.mark);
        if (axis == BR_OVER_H)
            fprintf(out, "k = %.3g s'", br_axis_value(report, other, list[i]));
        else
            fprintf(out, "n = %zu'", list[i]);
        curve++;
    }
    fputc('\n', out);
}

static void write_panel(FILE *out, const struct br_report *report, const struct br_frame *frame,
                        size_t curves, size_t first)
{
    br_write_frame(out, report, frame);
    write_key(out, frame, curves);
    write_curves(out, report, frame->axis, first);
}

static void write_script(FILE *out, const struct br_report *report, const char *stem)
{
    const struct br_study *study = br_report_fitted(report);
    const size_t over_k = br_distinct(study->n, study->n_count);
    const size_t over_h = br_distinct(study->steps, study->k_count);
    struct br_frame frame = {.axis = BR_OVER_K,
                             .left = 0.085,
                             .right = 0.515,
                             .bottom = 0.265,
                             .top = 0.775,
                             .y = {INFINITY, 0},
                             .numbered = true,
                             .page = BR_PAGE_WIDE};
    br_include_blocks(&frame.y, report, BR_OVER_K, &columns);
    br_write_head(out, report, &br_plot_printed, stem);
    br_write_loop(out, BR_PAGE_WIDE, BR_PAGE_HEIGHT);
    write_styles(out);
    fputs("set multiplot\n", out);
    br_write_caption(out, report, BR_PAGE_WIDE);
    write_legend(out);
    br_write_hollow(out, report, &columns, 0.98, 0.905);
    write_panel(out, report, &frame, over_k, 0);
    fputs("unset label\nunset arrow\n", out);
    frame.axis = BR_OVER_H;
    frame.left = 0.55, frame.right = 0.98;
    frame.numbered = false;
    write_panel(out, report, &frame, over_h, over_k);
    fputs("unset multiplot\n", out);
    br_write_foot(out);
}

const struct br_plot br_plot_printed = {
    .name = "printed",
    .title = "The computed and the printed errors against the time step k and the mesh size h.",
    .applies = applies,
    .write_data = write_data,
    .write_script = write_script,
};
