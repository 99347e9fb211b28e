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

/* n or N along the top; a number too near to the one before it is left out. */
static void write_entries(FILE *out, const struct br_report *report, enum br_axis axis,
                          double room)
{
    size_t count;
    const size_t *list = br_axis_list(report, axis, &count);
    double last = INFINITY;
    fputs("set x2tics scale 0.6 (", out);
    for (size_t i = br_next(list, count, 0); i < count; i = br_next(list, count, list[i])) {
        const double x = br_axis_value(report, axis, list[i]);
        const bool far = !(fabs(log10(last / x)) < room);
        fputs(isfinite(last) ? ", '" : "'", out);
        if (far)
            fprintf(out, "%zu", list[i]);
        fprintf(out, "' %.9g", x);
        last = far ? x : last;
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
                "set label '%s' at graph 1.015,first fy*fw**%g left font ',21'\n",
                frame->order[i].value, frame->order[i].label, frame->order[i].value);
}

static void write_axes(FILE *out, const struct br_report *report, const struct br_frame *frame,
                       struct br_range x, struct br_range y)
{
    const bool over_h = frame->axis == BR_OVER_H;
    fprintf(out,
            "set lmargin at screen %.3f; set rmargin at screen %.3f\n"
            "set bmargin at screen %.3f; set tmargin at screen %.3f\n"
            "set logscale xyx2\n"
            "set xrange [%.4g:%.4g]; set x2range [%.4g:%.4g]; set yrange [%.4g:%.4g]\n"
            "set xtics nomirror; set format x '10^{%%L}'\n"
            "set xlabel '%s%s'; set x2label '%s' offset 0,-0.4\n",
            frame->left, frame->right, frame->bottom, frame->top, x.low, x.high, x.low, x.high,
            y.low, y.high, over_h ? "mesh size h (m)" : "time step k (s)", frame->note ? frame->note : "",
            over_h ? "elements n" : "steps N");
    if (frame->numbered)
        fputs("set ylabel 'error (31) (m^{3/2})'; set format y '10^{%L}'\n", out);
    else
        fputs("set ylabel; set format y ''\n", out);
    fputs("set grid xtics ytics ls 102\n", out);
    /* room for numbers of five digits */
    write_entries(out, report, frame->axis,
                  decades(x) * 5 * 0.7 * BR_PAGE_FONT / frame->page / (frame->right - frame->left));
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
