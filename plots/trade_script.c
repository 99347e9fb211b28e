/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "plots/page.h"
#include "plots/trade_marks.h"
#include "study/scene/quote.h"

static struct br_range range_of(const struct br_trade_picture *p, const struct br_trade *t,
                                bool errors)
{
    struct br_range r = {INFINITY, -INFINITY};
    for (size_t i = 0; i < t->count; i++) {
        if (!p->shows(t, t->trial[i].contender) || !br_trade_is_drawn(p, &t->trial[i]))
            continue;
        const double value =
            errors ? br_trial_relative(&t->trial[i], 0, BR_PART_TOTAL) : p->work(&t->trial[i]);
        r.low = fmin(r.low, value);
        r.high = fmax(r.high, value);
    }
    if (!(r.low <= r.high))
        return errors ? (struct br_range){1e-10, 1} : (struct br_range){1e-4, 1};
    return r;
}

/* Wide enough for a decade; errors beyond 10 tell nothing. */
static void write_range(FILE *out, const char *axis, struct br_range r, bool errors)
{
    r.high = errors ? fmin(r.high, 10) : r.high;
    r.low = fmin(r.low, r.high / 10);
    fprintf(out, "set %srange [%.6g:%.6g]\n", axis, r.low / 1.6, r.high * 1.6);
}

static size_t longest_name(const struct br_trade_picture *p, const struct br_trade *t)
{
    size_t longest = strlen("beyond the limit of lagging");
    for (size_t i = 0; i < t->contenders.count; i++)
        if (p->shows(t, &t->contenders.list[i])) {
            const size_t length = strlen(t->contenders.list[i].name);
            longest = length > longest ? length : longest;
        }
    return longest;
}

/* The key stands right of the axes, so that it never hides a point. */
static void write_axes(FILE *out, const struct br_trade_picture *p, const struct br_trade *t)
{
    const double right = 1 - (0.055 + 0.0085 * (double)longest_name(p, t));
    fprintf(out,
            "set lmargin at screen 0.1; set rmargin at screen %.3f\n"
            "set bmargin at screen 0.13; set tmargin at screen 0.885\n"
            "set logscale xy\nset format '10^{%%L}'\nset grid xtics ytics ls 102\n"
            "set xtics nomirror font ',%d'; set ytics nomirror font ',%d'\n",
            right, BR_PAGE_SMALL, BR_PAGE_SMALL);
    write_range(out, "x", range_of(p, t, false), false);
    write_range(out, "y", range_of(p, t, true), true);
    fputs("set label 1 ", out);
    br_quote(out, &br_for_gnuplot, p->label);
    fprintf(out,
            " at screen %.3f,0.035 center font ',%d'\n"
            "set label 2 'relative %s' noenhanced at screen 0.022,0.5 center rotate font ',%d'\n"
            "set key at screen %.3f,0.885 left top Left reverse samplen 2.2 spacing 1.12 "
            "noenhanced font ',%d'\n",
            (0.1 + right) / 2, BR_PAGE_FONT, t->norm[0]->symbol, BR_PAGE_FONT, right + 0.008, 19);
}

static void write_caption(FILE *out, const struct br_trade_view *v)
{
    const size_t lost =
        br_trade_tally(v->trade, BR_TRIAL_FAILED) + br_trade_tally(v->trade, BR_TRIAL_OVER);
    fputs("set label 3 ", out);
    br_quote(out, &br_for_gnuplot, v->caption);
    fprintf(out, " noenhanced at screen 0.02,0.96 left font ',%d'\n", BR_PAGE_FONT);
    if (lost)
        fprintf(out,
                "set label 4 'not drawn: %zu failed, %zu over the time limit' at screen 0.99,0.035 "
                "right font ',%d'\n",
                br_trade_tally(v->trade, BR_TRIAL_FAILED), br_trade_tally(v->trade, BR_TRIAL_OVER),
                17);
}

/* Filled marks first, then hollow ones: two curves never share all of mark, colour and dash. */
static void write_curves(FILE *out, const struct br_trade_picture *p, const struct br_trade *t)
{
    size_t shown = 0, i = 0;
    for (size_t c = 0; c < t->contenders.count; c++)
        shown += p->shows(t, &t->contenders.list[c]);
    for (size_t c = 0; c < t->contenders.count; c++) {
        if (!p->shows(t, &t->contenders.list[c]))
            continue;
        const struct br_pen pen = br_pen_of(i, shown);
        fprintf(out,
                ", \\\n     data index %zu using 1:2 with linespoints lw 2 lc rgb '%s' dt %s pt %d "
                "ps 1.5*size title ",
                1 + BR_TRADE_MARKS + i, pen.colour, pen.dash, pen.mark - (int)(i / 6 % 2));
        br_quote(out, &br_for_gnuplot, t->contenders.list[c].name);
        i++;
    }
}

static void write_plot(FILE *out, const struct br_trade_picture *p, const struct br_trade *t)
{
    fputs("plot data index 0 using 1:2 with lines lw 12 lc rgb '#d8d8d8' title 'Pareto front'",
          out);
    for (size_t m = 0; m < BR_TRADE_MARKS; m++)
        if (br_trade_count_marked(p, t, &br_trade_marks[m])) {
            fprintf(out, ", \\\n     data index %zu using 1:2 with points %s title ", 1 + m,
                    br_trade_marks[m].pen);
            br_quote(out, &br_for_gnuplot, br_trade_marks[m].title);
        }
    write_curves(out, p, t);
    fputc('\n', out);
}

void br_trade_picture_script(FILE *out, const struct br_trade_picture *p,
                             const struct br_trade_view *v)
{
    br_write_script_head(out, v->caption, p->title, v->stem);
    fputs("set datafile missing 'NaN'\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n",
          out);
    br_write_loop(out, BR_PAGE_WIDE, BR_PAGE_HEIGHT);
    write_axes(out, p, v->trade);
    write_caption(out, v);
    write_plot(out, p, v->trade);
    br_write_foot(out);
}
