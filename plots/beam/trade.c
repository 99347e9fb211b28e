/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work-precision diagrams of a trade: relative error over what it costs. */
#include <math.h>

#include "plots/beam/pictures.h"
#include "solver/linear/linear_solver.h"
#include "study/trade/trade.h"

/* Whether a method has the exact law and the default solver: such methods differ in scheme, contact
 * and elements. */
static bool is_plain(const struct br_named_method *c)
{
    return c->method.friction == br_friction_rules[0] && c->method.solver == br_linear_solvers[0];
}

/* Whether a method has a curve. Beside other rules and solvers are the plain methods of the same
 * scheme, to compare with. */
static bool shows(const struct br_trade_picture *p, const struct br_trade *t,
                  const struct br_named_method *c)
{
    bool shown = is_plain(c) != p->of_rules;
    for (size_t i = 0; i < t->methods.count && p->of_rules; i++) {
        const struct br_named_method *other = &t->methods.list[i];
        shown |= !is_plain(other) && other->method.scheme == c->method.scheme &&
                 other->method.contact == c->method.contact &&
                 other->method.axial_degree == c->method.axial_degree;
    }
    return shown;
}

static double element_solves(const struct br_trial *trial)
{
    return isfinite(br_trial_seconds(trial))
               ? (double)trial->at.n * (double)trial->cost.counts.stages
               : (double)NAN;
}

const struct br_trade_picture br_trade_pictures[] = {
    {"schemes", "Relative error against CPU seconds, by time scheme", "Time schemes", false,
     "CPU time of one thread (s)", br_trial_seconds},
    {"work", "Relative error against element-solves, by time scheme",
     "Time schemes, element-solves", false, "elements times linear solves a field", element_solves},
    {"rules", "Relative error against CPU seconds, by friction rule and linear solver",
     "Friction rules and solvers", true, "CPU time of one thread (s)", br_trial_seconds},
    {0}};

/* Errors above 10 are left out: they would only widen the axis. */
static bool has_position(const struct br_trade_picture *p, const struct br_trial *t)
{
    const double error = br_trial_relative(t);
    return error > 0 && error <= 10 && p->work(t) > 0;
}

static void add_trial(const struct br_trade_picture *p, const struct br_trial *t,
                      struct br_series *s)
{
    br_point_add(s, p->work(t), br_trial_relative(t), NULL);
}

/* Adds the Pareto front of a method's trials, or of all that are shown (NULL). */
static void add_front(const struct br_trade_picture *p, const struct br_trade *t,
                      const struct br_named_method *only, struct br_series *s)
{
    for (size_t i = 0; i < t->count; i++) {
        const struct br_trial *trial = &t->trial[i];
        if ((only ? trial->named == only : shows(p, t, trial->named)) &&
            isfinite(br_trial_bound(trial)) && has_position(p, trial))
            add_trial(p, trial, s);
    }
    br_series_stairs(s);
}

static const struct {
    const char *title;
    enum br_pen pen;
} clouds[] = {
    {"other trials", BR_PEN_DOTS},
    {"beyond the limit of lagging", BR_PEN_PLUSES},
    {"printed in the paper", BR_PEN_SQUARES},
    {"near the reference's own error", BR_PEN_STARS},
};

/* The order of hues: the paper's method first, then those with most trials on the common front. */
static size_t merit(const struct br_trade_picture *p, const struct br_trade *t,
                    const struct br_named_method *c, const struct br_series *front)
{
    size_t kept = 1;
    for (size_t i = 0; i < t->count; i++)
        for (size_t k = 0; k < front->count && t->trial[i].named == c; k++)
            kept += front->point[k].x == p->work(&t->trial[i]) &&
                    front->point[k].y == br_trial_relative(&t->trial[i]);
    return br_trade_is_printed_method(c) ? t->count + 2 : kept;
}

/* Adds the trial that was chosen, and the line of its goal. */
static void add_goal(const struct br_trade_picture *p, const struct br_trade *t,
                     struct br_figure *f)
{
    const struct br_range x = br_extent(&f->panel[0], false);
    if (t->chosen < t->count)
        add_trial(p, &t->trial[t->chosen], br_series_add(f, BR_PEN_SQUARES, "chosen"));
    if (t->goal.seconds > 0)
        br_mark_add(f, t->goal.seconds, "goal");
    if (!(t->goal.error > 0))
        return;
    struct br_series *goal = br_series_add(f, BR_PEN_GUIDE, "goal");
    br_point_add(goal, x.low, t->goal.error, NULL);
    br_point_add(goal, x.high, t->goal.error, NULL);
}

struct br_figure br_trade_draw(const struct br_trade_picture *picture, const struct br_trade *trade,
                               const char *name, const char *caption)
{
    size_t failed = 0, over = 0, shown = 0;
    for (size_t i = 0; i < trade->methods.count; i++)
        shown += shows(picture, trade, &trade->methods.list[i]);
    for (size_t i = 0; i < trade->count; i++) {
        failed += trade->trial[i].end == BR_TRIAL_FAILED;
        over += trade->trial[i].end == BR_TRIAL_OVER;
    }
    struct br_figure figure = {0}, *f = &figure;
    if (!shown)
        return figure;
    BR_SAY(f->stem, "%.400s-%s", name, picture->name);
    BR_SAY(f->title, "%s. %s", caption, picture->short_title);
    BR_SAY(f->about, "%s", picture->title);
    if (failed + over)
        BR_SAY(f->note[0], "not drawn: %zu failed, %zu over the time limit", failed, over);
    br_panel_add(f, true, picture->label, "relative %s", trade->request.norm->symbol);
    struct br_series *front = br_series_add(f, BR_PEN_BAND, "Pareto front");
    add_front(picture, trade, NULL, front);
    for (size_t i = 0; i < sizeof clouds / sizeof *clouds; i++) {
        struct br_series *s = NULL;
        for (const struct br_trial *t = trade->trial; t < trade->trial + trade->count; t++) {
            const bool in[] = {t->end != BR_TRIAL_UNSTABLE, t->end == BR_TRIAL_UNSTABLE, t->printed,
                               t->end == BR_TRIAL_DOUBTFUL}; /* by clouds */
            if (!shows(picture, trade, t->named) || !in[i] || !has_position(picture, t))
                continue;
            if (!s)
                s = br_series_add(f, clouds[i].pen, "%s", clouds[i].title);
            add_trial(picture, t, s);
        }
    }
    /* The fronts of all methods that are shown, by merit. */
    size_t left[BR_MOST_NAMED_METHODS] = {0}; /* merits; 0: done, or not shown */
    for (size_t i = 0; i < trade->methods.count; i++)
        if (shows(picture, trade, &trade->methods.list[i]))
            left[i] = merit(picture, trade, &trade->methods.list[i], front);
    for (;;) {
        size_t best = 0;
        for (size_t i = 1; i < trade->methods.count; i++)
            best = left[i] > left[best] ? i : best;
        if (!left[best])
            break;
        const struct br_named_method *c = &trade->methods.list[best];
        left[best] = 0;
        add_front(picture, trade, c, br_series_add(f, BR_PEN_CURVE, "%s", c->name));
    }
    add_goal(picture, trade, f);
    return figure;
}
