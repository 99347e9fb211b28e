/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/page.h"

#include <math.h>

static double decades(struct br_range range)
{
    return log10(range.high / range.low);
}

/* The range with `below` and `above` decades of room, and `least` decades long. */
static struct br_range widen(struct br_range range, double below, double above, double least)
{
    if (!(range.low <= range.high))
        range = (struct br_range){1e-6, 1e-2};
    const double more = fmax(0, least - below - above - decades(range)) / 2;
    return (struct br_range){range.low * pow(10, -below - more),
                             range.high * pow(10, above + more)};
}

static struct br_range range_along(const struct br_report *report, enum br_axis axis)
{
    size_t count;
    const size_t *list = br_axis_list(report, axis, &count);
    struct br_range range = {INFINITY, 0};
    for (size_t i = 0; i < count; i++) {
        range.low = fmin(range.low, br_axis_value(report, axis, list[i]));
        range.high = fmax(range.high, br_axis_value(report, axis, list[i]));
    }
    return range;
}

/* n or N along the top; a number too near to the one before it is left out. pixel: the
 * axis' decades in one. */
static void write_entries(FILE *out, const struct br_report *report, enum br_axis axis,
                          double pixel)
{
    size_t count;
    const size_t *list = br_axis_list(report, axis, &count);
    const size_t first = br_next(list, count, 0);
    double last = INFINITY;
    fputs("set x2tics offset 0,0.1 (", out);
    for (size_t i = first; i < count; i = br_next(list, count, list[i])) {
        const double x = br_axis_value(report, axis, list[i]);
        char number[32] = "";
        const int digits = snprintf(number, sizeof number, "%zu", list[i]);
        if (log10(last / x) < (digits + 0.5) * 0.65 * BR_PAGE_FONT * pixel)
            number[0] = '\0';
        else
            last = x;
        fprintf(out, "%s'%s' %.9g", list[i] == list[first] ? "" : ", ", number, x);
    }
    fputs(")\n", out);
}

/* The slopes are drawn in a band of their own, beside the data and at the scale of the
 * axes; the right angle is at the band's lower right. */
static void write_fan(FILE *out, const struct br_frame *frame, double start, double width,
                      double bottom)
{
    fprintf(out,
            "# Slopes to compare with, from (fx, fy), at the axes' scale.\n"
            "fx = %.4g; fy = %.4g; fw = %.4g\n"
            "set arrow from fx,fy to fx*fw,fy nohead ls 101\n"
            "set arrow from fx*fw,fy to fx*fw,fy*fw**%g nohead ls 101\n",
            start, bottom, pow(10, width), frame->order[frame->orders - 1].value);
    for (size_t i = 0; i < frame->orders; i++)
        fprintf(out,
                "set arrow from fx,fy to fx*fw,fy*fw**%g nohead ls 101\n"
                "set label '%s' at graph 1.015,first fy*fw**%g left font ',%d'\n",
                frame->order[i].value, frame->order[i].label, frame->order[i].value, BR_PAGE_SMALL);
}

/* The axes' names are labels at fixed places, since terminals space their own ones
 * differently. */
static void write_names(FILE *out, const struct br_report *report, const struct br_frame *frame)
{
    const struct br_norm *norm = br_report_fitted(report)->norm;
    const bool over_h = frame->axis == BR_OVER_H;
    const double middle = (frame->left + frame->right) / 2;
    fprintf(out,
            "set label '%s%s' at screen %.4f,%.4f center font ',%d'\n"
            "set label '%s' at screen %.4f,%.4f center font ',%d'\n",
            over_h ? "mesh size h (m)" : "time step k (s)", frame->note ? frame->note : "", middle,
            frame->bottom - 0.095, BR_PAGE_FONT, over_h ? "elements n" : "steps N", middle,
            frame->top + 0.08, BR_PAGE_FONT);
    if (frame->numbered)
        fprintf(out, "set label '%s (%s)' at screen %.4f,%.4f center rotate font ',%d'\n",
                norm->symbol, norm->unit_markup, 30.0 / frame->page,
                (frame->bottom + frame->top) / 2, BR_PAGE_FONT);
}

static void write_axes(FILE *out, const struct br_report *report, const struct br_frame *frame,
                       struct br_range x, struct br_range y)
{
    fprintf(out,
            "set lmargin at screen %.3f; set rmargin at screen %.3f\n"
            "set bmargin at screen %.3f; set tmargin at screen %.3f\n"
            "set logscale xyx2\n"
            "set xrange [%.4g:%.4g]; set x2range [%.4g:%.4g]; set yrange [%.4g:%.4g]\n"
            "set tics scale 1.4,0.7 font ',%d'\n"
            "set xtics nomirror offset 0,-0.5; set ytics offset -0.5,0; set format x '10^{%%L}'; "
            "set format y '%s'\n"
            "set grid xtics ytics ls 102\n",
            frame->left, frame->right, frame->bottom, frame->top, x.low, x.high, x.low, x.high,
            y.low, y.high, BR_PAGE_FONT, frame->numbered ? "10^{%L}" : "");
    write_entries(out, report, frame->axis,
                  decades(x) / (frame->right - frame->left) / frame->page);
    write_names(out, report, frame);
}

void br_write_frame(FILE *out, const struct br_report *report, const struct br_frame *frame)
{
    const double gap = 0.12;
    const struct br_range y = widen(frame->y, 0.2, 0.2, 2);
    const double steepest = frame->orders ? frame->order[frame->orders - 1].value : 1;
    const double width = fmin(0.42 * decades(y) / steepest, 0.4);
    const struct br_range data = widen(range_along(report, frame->axis), gap, gap, 1);
    const struct br_range x = {data.low,
                               data.high * (frame->orders ? pow(10, width + gap / 2) : 1)};
    write_axes(out, report, frame, x, y);
    if (frame->orders)
        write_fan(out, frame, data.high, width, y.low * pow(10, 0.06 * decades(y)));
}
