/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work-precision diagrams of a trade: relative error over what it costs. */
#include <math.h>

#include "plots/pictures.h"
#include "study/trade/trade.h"

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
    "CPU time of one thread (s)", seconds};
static const struct br_trade_picture work = {
    "work", "Relative error against element-solves, by time scheme", shows_schemes,
    "elements times linear solves a field", element_solves};
static const struct br_trade_picture rules = {
    "rules", "Relative error against CPU seconds, by friction rule and linear solver", shows_rules,
    "CPU time of one thread (s)", seconds};

const struct br_trade_picture *const br_trade_pictures[] = {&schemes, &work, &rules, NULL};

bool br_trade_picture_applies(const struct br_trade_picture *p, const struct br_trade *t)
{
    bool applies = false;
    for (size_t i = 0; i < t->contenders.count; i++)
        applies |= p->shows(t, &t->contenders.list[i]);
    return applies;
}

/* ---- which trials ---- */

static bool has_place(const struct br_trade_picture *p, const struct br_trial *t)
{
    const double error = br_trial_relative(t, 0, BR_PART_TOTAL);
    return isfinite(error) && error > 0 && p->work(t) > 0;
}

/* Whether another trial is as good for no more work; of equals the first stays. */
static bool is_beaten(const struct br_trade_picture *p, const struct br_trial *a,
                      const struct br_trial *b)
{
    const double x = p->work(a), y = p->work(b);
    const double e = br_trial_bound(a, 0), f = br_trial_bound(b, 0);
    return f <= e && y <= x && (f < e || y < x || b < a);
}

/* Whether trial i is on the front of a method, or of all that are shown (NULL). */
static bool is_kept(const struct br_trade_picture *p, const struct br_trade *t, size_t i,
                    const struct br_contender *only)
{
    const struct br_trial *a = &t->trial[i];
    if ((only && a->contender != only) || !isfinite(br_trial_bound(a, 0)) || !has_place(p, a))
        return false;
    for (size_t j = 0; j < t->count; j++) {
        const struct br_trial *b = &t->trial[j];
        const bool rival = only ? b->contender == only : p->shows(t, b->contender);
        if (j != i && rival && has_place(p, b) && is_beaten(p, a, b))
            return false;
    }
    return only || p->shows(t, a->contender);
}

static void add_trial(const struct br_trade_picture *p, const struct br_trial *t,
                      struct br_series *s)
{
    br_point_add(s, p->work(t), br_trial_relative(t, 0, BR_PART_TOTAL), NULL);
}

/* The front of a method, or of all that are shown (NULL), by work. */
static void add_front(const struct br_trade_picture *p, const struct br_trade *t,
                      const struct br_contender *only, struct br_series *s)
{
    double last = -1;
    for (;;) {
        size_t next = t->count;
        for (size_t i = 0; i < t->count; i++)
            if (is_kept(p, t, i, only) && p->work(&t->trial[i]) > last &&
                (next == t->count || p->work(&t->trial[i]) < p->work(&t->trial[next])))
                next = i;
        if (next == t->count)
            return;
        last = p->work(&t->trial[next]);
        add_trial(p, &t->trial[next], s);
    }
}

/* ---- what is marked besides ---- */

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

static const struct {
    const char *title;
    enum br_pen pen;
    bool (*has)(const struct br_trial *trial);
} clouds[] = {
    {"other trials", BR_PEN_DOTS, is_any},
    {"beyond the limit of lagging", BR_PEN_PLUSES, is_unstable},
    {"printed in the paper", BR_PEN_SQUARES, is_printed},
    {"near the judge's own error", BR_PEN_STARS, is_doubtful},
};

static void add_cloud(const struct br_trade_picture *p, const struct br_trade *t, size_t cloud,
                      struct br_panel *panel)
{
    struct br_series *s = NULL;
    for (size_t i = 0; i < t->count; i++) {
        const struct br_trial *trial = &t->trial[i];
        if (!p->shows(t, trial->contender) || !clouds[cloud].has(trial) || !has_place(p, trial))
            continue;
        if (!s)
            s = br_series_add(panel, clouds[cloud].pen, "%s", clouds[cloud].title);
        add_trial(p, trial, s);
    }
}

/* ---- the picture ---- */

/* Who gets a hue first: the paper's own method, then those with most trials on the front of all. */
static size_t merit(const struct br_trade_picture *p, const struct br_trade *t,
                    const struct br_contender *c)
{
    size_t kept = 0;
    for (size_t i = 0; i < t->count; i++)
        kept += t->trial[i].contender == c && is_kept(p, t, i, NULL);
    return br_trade_is_printed_method(c) ? t->count : kept;
}

/* The methods that are shown, by merit, into `list` (out); how many. */
static size_t rank(const struct br_trade_picture *p, const struct br_trade *t,
                   const struct br_contender *list[BR_MOST_CONTENDERS])
{
    size_t merits[BR_MOST_CONTENDERS], count = 0;
    for (size_t i = 0; i < t->contenders.count; i++) {
        const struct br_contender *c = &t->contenders.list[i];
        if (!p->shows(t, c))
            continue;
        const size_t own = merit(p, t, c);
        size_t at = count++;
        for (; at > 0 && merits[at - 1] < own; at--) {
            list[at] = list[at - 1];
            merits[at] = merits[at - 1];
        }
        list[at] = c;
        merits[at] = own;
    }
    return count;
}

/* Errors beyond 10 say nothing, and widen no axis. */
static double most_error(const struct br_trade_picture *p, const struct br_trade *t)
{
    double most = 0;
    for (size_t i = 0; i < t->count; i++)
        if (p->shows(t, t->trial[i].contender) && has_place(p, &t->trial[i]))
            most = fmax(most, br_trial_relative(&t->trial[i], 0, BR_PART_TOTAL));
    return most > 10 ? 16 : 0;
}

static void fill(const struct br_trade_picture *p, const struct br_trade *t, struct br_panel *panel)
{
    panel->log_x = panel->log_y = true;
    panel->y.high = most_error(p, t);
    BR_SAY(panel->x_label, "%s", p->label);
    BR_SAY(panel->y_label, "relative %s", t->norm[0]->symbol);
    add_front(p, t, NULL, br_series_add(panel, BR_PEN_BAND, "Pareto front"));
    for (size_t i = 0; i < sizeof clouds / sizeof *clouds; i++)
        add_cloud(p, t, i, panel);
    const struct br_contender *list[BR_MOST_CONTENDERS];
    const size_t count = rank(p, t, list);
    for (size_t i = 0; i < count; i++)
        add_front(p, t, list[i], br_series_add(panel, BR_PEN_CURVE, "%s", list[i]->name));
}

enum br_status br_trade_draw(const struct br_trade_picture *picture, const struct br_trade *trade,
                             const char *name, const char *caption, struct br_figure *f,
                             struct br_error *err)
{
    const size_t failed = br_trade_tally(trade, BR_TRIAL_FAILED);
    const size_t over = br_trade_tally(trade, BR_TRIAL_OVER);
    *f = (struct br_figure){0};
    BR_SAY(f->stem, "%.400s-%s", name, picture->name);
    BR_SAY(f->title, "%s", caption);
    BR_SAY(f->about, "%s", picture->title);
    if (failed + over)
        BR_SAY(f->note[0], "not drawn: %zu failed, %zu over the time limit", failed, over);
    fill(picture, trade, br_panel_add(f));
    return br_figure_check(f, err);
}
