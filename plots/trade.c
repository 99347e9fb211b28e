/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/trade.h"

#include <math.h>
#include <string.h>

#include "plots/page.h"
#include "plots/trade_marks.h"
#include "study/scene/quote.h"

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

bool br_trade_is_drawn(const struct br_trade_picture *p, const struct br_trial *t)
{
    const double error = br_trial_relative(t, 0, BR_PART_TOTAL);
    return isfinite(error) && error > 0 && p->work(t) > 0;
}

static void write_point(FILE *out, const struct br_trade_picture *p, const struct br_trial *t)
{
    if (br_trade_is_drawn(p, t))
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
    if ((only && a->contender != only) || !isfinite(br_trial_bound(a, 0)) ||
        !br_trade_is_drawn(p, a))
        return false;
    for (size_t j = 0; j < t->count; j++) {
        const struct br_trial *b = &t->trial[j];
        const bool rival = only ? b->contender == only : p->shows(t, b->contender);
        if (j != i && rival && br_trade_is_drawn(p, b) && is_beaten(p, a, b))
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

/* In the order of their blocks, behind the front of all. */
const struct br_trade_mark br_trade_marks[BR_TRADE_MARKS] = {
    {"other trials", "pt 7 ps 0.45*size lc rgb '#9a9a9a'", is_any},
    {"beyond the limit of lagging", "pt 1 ps 1.1*size lw 2 lc rgb '#707070'", is_unstable},
    {"printed in the paper", "pt 4 ps 2.6*size lw 2 lc rgb '#000000'", is_printed},
    {"near the judge's own error", "pt 3 ps 1.5*size lw 1.5 lc rgb '#707070'", is_doubtful},
};

static bool is_marked(const struct br_trade_picture *p, const struct br_trade *t, size_t i,
                      const struct br_trade_mark *mark)
{
    return p->shows(t, t->trial[i].contender) && mark->has(&t->trial[i]) &&
           br_trade_is_drawn(p, &t->trial[i]);
}

size_t br_trade_count_marked(const struct br_trade_picture *p, const struct br_trade *t,
                             const struct br_trade_mark *mark)
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
    for (size_t m = 0; m < BR_TRADE_MARKS; m++) {
        fprintf(out, "# index %zu: %s\n", index++, br_trade_marks[m].title);
        for (size_t i = 0; i < t->count; i++)
            if (is_marked(p, t, i, &br_trade_marks[m]))
                write_point(out, p, &t->trial[i]);
        end_block(out);
    }
    for (size_t c = 0; c < t->contenders.count; c++)
        if (p->shows(t, &t->contenders.list[c])) {
            fprintf(out, "# index %zu: %s\n", index++, t->contenders.list[c].name);
            write_front(out, p, t, &t->contenders.list[c]);
        }
}
