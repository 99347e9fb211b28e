/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/trade.h"

#include <math.h>
#include <string.h>

#include "plots/page.h"

/* ---- the registry ---- */

/* With the exact law and the default solver: what is left are time schemes and elements. */
static bool is_plain(const struct br_contender *c)
{
    return c->method.friction == br_friction_rules[0] && c->method.solver == br_linear_solvers[0];
}

static bool shows_schemes(const struct br_trade *t, const struct br_contender *c)
{
    (void)t;
    return is_plain(c);
}

/* Others, and what they are to be held against: the same scheme without. */
static bool shows_rules(const struct br_trade *t, const struct br_contender *c)
{
    bool compared = !is_plain(c);
    for (size_t i = 0; i < t->contenders.count; i++) {
        const struct br_contender *other = &t->contenders.list[i];
        compared |= !is_plain(other) && other->method.scheme == c->method.scheme &&
                    other->method.contact == c->method.contact &&
                    other->method.axial_degree == c->method.axial_degree;
    }
    return compared;
}

static double seconds(const struct br_trial *trial)
{
    return br_trial_seconds(trial);
}

static double element_solves(const struct br_trial *trial)
{
    return isfinite(br_trial_seconds(trial))
               ? (double)trial->at.n * (double)trial->cost.counts.stages
               : (double)NAN;
}

static const struct br_trade_picture schemes = {
    "schemes", "Relative error against CPU seconds, by time scheme", shows_schemes,
    "CPU time of one thread, s", seconds};
static const struct br_trade_picture work = {
    "work", "Relative error against element-solves, by time scheme", shows_schemes,
    "elements times linear solves a field", element_solves};
static const struct br_trade_picture rules = {
    "rules", "Relative error against CPU seconds, by friction rule and linear solver", shows_rules,
    "CPU time of one thread, s", seconds};

const struct br_trade_picture *const br_trade_pictures[] = {&schemes, &work, &rules, NULL};

bool br_trade_picture_applies(const struct br_trade_picture *p, const struct br_trade *t)
{
    bool applies = false;
    for (size_t i = 0; i < t->contenders.count; i++)
        applies |= p->shows(t, &t->contenders.list[i]);
    return applies;
}

/* ---- the data ---- */

static bool is_drawn(const struct br_trade_picture *p, const struct br_trial *t)
{
    const double error = br_trial_relative(t, 0, BR_PART_TOTAL);
    return isfinite(error) && error > 0 && p->work(t) > 0;
}

static void write_point(FILE *out, const struct br_trade_picture *p, const struct br_trial *t)
{
    if (is_drawn(p, t))
        fprintf(out, "%.6g %.6g\n", p->work(t), br_trial_relative(t, 0, BR_PART_TOTAL));
}

/* Ends a block; gnuplot wants a point in it. */
static void end_block(FILE *out)
{
    fputs("NaN NaN\n\n\n", out);
}

/* Whether another trial of a set is as good for no more work; of equals the first stays. */
static bool is_beaten(const struct br_trade_picture *p, const struct br_trial *a,
                      const struct br_trial *b)
{
    const double x = p->work(a), y = p->work(b);
    const double e = br_trial_bound(a, 0), f = br_trial_bound(b, 0);
    return f <= e && y <= x && (f < e || y < x || b < a);
}

static bool is_kept(const struct br_trade_picture *p, const struct br_trade *t, size_t i,
                    const struct br_contender *only)
{
    const struct br_trial *a = &t->trial[i];
    if ((only && a->contender != only) || !isfinite(br_trial_bound(a, 0)) || !is_drawn(p, a))
        return false;
    for (size_t j = 0; j < t->count; j++) {
        const struct br_trial *b = &t->trial[j];
        const bool rival = only ? b->contender == only : p->shows(t, b->contender);
        if (j != i && rival && is_drawn(p, b) && is_beaten(p, a, b))
            return false;
    }
    return only || p->shows(t, a->contender);
}

/* The front of a contender, or of all that are shown (NULL), by work. */
static void write_front(FILE *out, const struct br_trade_picture *p, const struct br_trade *t,
                        const struct br_contender *only)
{
    double last = -1;
    for (;;) {
        size_t next = t->count;
        for (size_t i = 0; i < t->count; i++)
            if (is_kept(p, t, i, only) && p->work(&t->trial[i]) > last &&
                (next == t->count || p->work(&t->trial[i]) < p->work(&t->trial[next])))
                next = i;
        if (next == t->count)
            break;
        last = p->work(&t->trial[next]);
        write_point(out, p, &t->trial[next]);
    }
    end_block(out);
}

static bool is_printed(const struct br_trial *t)
{
    return t->printed;
}

static bool is_unstable(const struct br_trial *t)
{
    return t->end == BR_TRIAL_UNSTABLE;
}

static bool is_doubtful(const struct br_trial *t)
{
    return t->end == BR_TRIAL_DOUBTFUL;
}

static bool is_any(const struct br_trial *t)
{
    return t->end != BR_TRIAL_UNSTABLE;
}

/* Points that are marked besides; in the order of their blocks, behind the front of all. */
static const struct mark {
    const char *title, *pen; /* title NULL: of the key's line for dots */
    bool (*has)(const struct br_trial *);
} marks[] = {
    {"other trials", "pt 7 ps 0.45*size lc rgb '#9a9a9a'", is_any},
    {"beyond the limit of lagging", "pt 1 ps 1.1*size lw 2 lc rgb '#707070'", is_unstable},
    {"printed in the paper", "pt 4 ps 2.6*size lw 2 lc rgb '#000000'", is_printed},
    {"near the judge's own error", "pt 3 ps 1.5*size lw 1.5 lc rgb '#707070'", is_doubtful},
};
enum { MARKS = sizeof marks / sizeof *marks };

static bool is_marked(const struct br_trade_picture *p, const struct br_trade *t, size_t i,
                      const struct mark *mark)
{
    return p->shows(t, t->trial[i].contender) && mark->has(&t->trial[i]) &&
           is_drawn(p, &t->trial[i]);
}

static size_t count_marked(const struct br_trade_picture *p, const struct br_trade *t,
                           const struct mark *mark)
{
    size_t count = 0;
    for (size_t i = 0; i < t->count; i++)
        count += is_marked(p, t, i, mark);
    return count;
}

void br_trade_picture_data(FILE *out, const struct br_trade_picture *p,
                           const struct br_trade_view *v)
{
    const struct br_trade *t = v->trade;
    size_t index = 0;
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, v->caption);
    fprintf(out, "# %s\n# columns: %s; relative error\n# index %zu: Pareto front\n", p->title,
            p->label, index++);
    write_front(out, p, t, NULL);
    for (size_t m = 0; m < MARKS; m++) {
        fprintf(out, "# index %zu: %s\n", index++, marks[m].title);
        for (size_t i = 0; i < t->count; i++)
            if (is_marked(p, t, i, &marks[m]))
                write_point(out, p, &t->trial[i]);
        end_block(out);
    }
    for (size_t c = 0; c < t->contenders.count; c++)
        if (p->shows(t, &t->contenders.list[c])) {
            fprintf(out, "# index %zu: %s\n", index++, t->contenders.list[c].name);
            write_front(out, p, t, &t->contenders.list[c]);
        }
}

/* ---- the script ---- */

static struct br_range range_of(const struct br_trade_picture *p, const struct br_trade *t,
                                bool errors)
{
    struct br_range r = {INFINITY, -INFINITY};
    for (size_t i = 0; i < t->count; i++) {
        if (!p->shows(t, t->trial[i].contender) || !is_drawn(p, &t->trial[i]))
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
    br_write_quoted(out, p->label);
    fprintf(out,
            " at screen %.3f,0.035 center font ',%d'\n"
            "set label 2 'relative %s' noenhanced at screen 0.022,0.5 center rotate font ',%d'\n"
            "set key at screen %.3f,0.885 left top Left reverse samplen 2.2 spacing 1.12 "
            "noenhanced font ',%d'\n",
            (0.1 + right) / 2, BR_PAGE_FONT, t->norm[0]->symbol, BR_PAGE_FONT, right + 0.008, 17);
}

static void write_caption(FILE *out, const struct br_trade_view *v)
{
    const size_t lost =
        br_trade_tally(v->trade, BR_TRIAL_FAILED) + br_trade_tally(v->trade, BR_TRIAL_OVER);
    fputs("set label 3 ", out);
    br_write_quoted(out, v->caption);
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
                1 + MARKS + i, pen.colour, pen.dash, pen.mark - (int)(i / 6 % 2));
        br_write_quoted(out, t->contenders.list[c].name);
        i++;
    }
}

static void write_plot(FILE *out, const struct br_trade_picture *p, const struct br_trade *t)
{
    fputs("plot data index 0 using 1:2 with lines lw 12 lc rgb '#d8d8d8' title 'Pareto front'",
          out);
    for (size_t m = 0; m < MARKS; m++)
        if (count_marked(p, t, &marks[m])) {
            fprintf(out, ", \\\n     data index %zu using 1:2 with points %s title ", 1 + m,
                    marks[m].pen);
            br_write_quoted(out, marks[m].title);
        }
    write_curves(out, p, t);
    fputc('\n', out);
}

void br_trade_picture_script(FILE *out, const struct br_trade_picture *p,
                             const struct br_trade_view *v)
{
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, v->caption);
    fprintf(out,
            "# %s\n# Draws %s.svg and %s.png from %s.dat;\n"
            "# edit it, and draw them again, in this folder, with\n#     gnuplot %s.gp\n\n"
            "set encoding utf8\nstem = ",
            p->title, v->stem, v->stem, v->stem, v->stem);
    br_write_quoted(out, v->stem);
    fputs("\ndata = stem.'.dat'\nset datafile missing 'NaN'\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n",
          out);
    br_write_loop(out, BR_PAGE_WIDE);
    write_axes(out, p, v->trade);
    write_caption(out, v);
    write_plot(out, p, v->trade);
    br_write_foot(out);
}
