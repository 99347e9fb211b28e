/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders of a grid: a mixture of models (joint_model.h), as those of a line (line_order.h).
 * Each axis has a law of the one family; models with more laws are tried only where those with
 * fewer are not ruled out (Occam's window: Madigan and Raftery, Journal of the American Statistical
 * Association 89, 1535-1546, 1994). Each is fitted to all cells, and to windows without cells that
 * are far off, or without the coarsest sizes. With S the sum of squares of n residuals that k
 * unknowns leave, H their curvature with that of the priors, the evidence is (Laplace)
 *     prior Gamma(f/2) (pi S)^(-f/2) det(H)^(-1/2),   f = n - k. */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "orders/grid/joint_model.h"

#define LOG_C(axis) (BR_OF_AXIS * (axis) + BR_LOG_C)
#define ORDER(axis) (BR_OF_AXIS * (axis) + BR_ORDER)

bool br_joint_has(enum br_joint_kind kind, int axis)
{
    return kind != (axis == BR_AXIS_SPACE ? BR_JOINT_TIME : BR_JOINT_SPACE);
}

struct br_estimate br_estimate_of(double value, double deviation, size_t freedom)
{
    const double half = freedom > 0 ? gsl_cdf_tdist_Pinv(0.975, (double)freedom) * deviation : NAN;
    return (struct br_estimate){value, value - half, value + half};
}

double br_akaike(double sum, size_t count, size_t unknowns)
{
    const double n = (double)count, u = (double)unknowns + 1; /* the variance is an unknown, too */
    if (!(n > u + 1))
        return INFINITY;
    return n * log(fmax(sum, 1e-300) / n) + 2 * u + 2 * u * (u + 1) / (n - u - 1);
}

/* ---- the cells ---- */

enum { MOST_TRIALS = 600, MOST_WINDOWS = 12, MOST_SIZES = 64 };

struct candidate {
    struct br_joint_trial trial;
    double log_weight;             /* of the mixture, then the weight; -infinite: there is no fit */
    double deviation[BR_UNKNOWNS]; /* of values in m and s */
    size_t window, laws;           /* laws: how many bend a power, or are a floor */
    bool widened;
};

/* The cells that count: without those that are far off what the others show, and without so many
 * of the coarsest sizes. */
struct window {
    bool far;
    size_t lost[BR_AXES];
    double log_prior;
};

/* A law that a model may have: a family of laws.h, or an order that changes along an axis. */
struct option {
    struct br_family family;
    int axes; /* that may have it, as bits; 0: it is a floor */
};

struct search {
    struct br_joint_cells all, used; /* all cells; those of a window */
    struct br_joint_cell *rest;      /* room for so many again, for the jackknife */
    bool *far;                       /* of all cells */
    double *residual;                /* room for one of each cell */
    double unit[BR_AXES], log_error; /* of scaled sizes and errors: logarithms in m, s, m^(3/2) */
    bool any_model;
    struct window window[MOST_WINDOWS];
    size_t windows, now;
    struct candidate *candidate;
    size_t count;
    double best; /* the largest log_weight */
    struct option option[BR_FAMILIES + 4 * MOST_SIZES];
    size_t smooth, options; /* those from `smooth` on are of orders that change */
};

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static size_t size_of(const struct br_joint_cells *c, int axis, double x)
{
    size_t i = c->sizes[axis];
    while (i > 0 && c->size[axis][i - 1].x != x)
        i--;
    return i - 1;
}

/* The different sizes of an axis, ascending, after 0. value: room for two a cell. */
static void take_sizes(struct search *s, const struct br_observation *o, int axis, double *value)
{
    struct br_joint_cells *c = &s->all;
    for (size_t i = 0; i < c->count; i++) {
        value[2 * i] = o[i].x[axis];
        value[2 * i + 1] = o[i].ref[axis];
    }
    qsort(value, 2 * c->count, sizeof *value, by_value);
    const double most = value[2 * c->count - 1];
    s->unit[axis] = log(most);
    c->sizes[axis] = 1;
    for (size_t i = 0; i < 2 * c->count; i++)
        if (value[i] / most > c->size[axis][c->sizes[axis] - 1].x)
            c->size[axis][c->sizes[axis]++] =
                (struct br_joint_size){.x = value[i] / most, .log_x = log(value[i] / most)};
    for (size_t i = 0; i < c->count; i++) {
        struct br_joint_cell *cell = &c->cell[i];
        cell->at[axis] = size_of(c, axis, o[i].x[axis] / most);
        cell->against[axis] = size_of(c, axis, o[i].ref[axis] / most);
        c->log_finest[axis] = fmin(c->log_finest[axis], c->size[axis][cell->at[axis]].log_x);
    }
}

static void take_cells(struct search *s, const struct br_observation *o)
{
    struct br_joint_cells *c = &s->all;
    double *value = s->residual;
    for (size_t i = 0; i < c->count; i++)
        value[i] = log(o[i].error);
    qsort(value, c->count, sizeof *value, by_value);
    s->log_error = value[c->count / 2];
    c->lowest = value[0] - s->log_error;
    for (size_t i = 0; i < c->count; i++) {
        double copies = 0;
        for (size_t j = 0; j < c->count; j++)
            copies += o[j].error == o[i].error;
        c->cell[i].log_error = log(o[i].error) - s->log_error;
        c->cell[i].weight = s->any_model ? 1 / copies : 1;
        c->cell[i].rounded = o[i].rounding / o[i].error / sqrt(3);
    }
    for (int a = 0; a < BR_AXES; a++)
        take_sizes(s, o, a, value);
}

/* The number of sizes of an axis; 0: no cell differs from its reference in it. */
static size_t sizes_of(const struct br_joint_cells *c, int axis)
{
    size_t sizes = 0;
    bool differs = false;
    for (size_t j = 1; j < c->sizes[axis]; j++) {
        bool here = false;
        for (size_t i = 0; i < c->count; i++) {
            here |= c->cell[i].at[axis] == j;
            differs |= c->cell[i].at[axis] != c->cell[i].against[axis];
        }
        sizes += here;
    }
    return differs ? sizes : 0;
}

/* A fit needs more cells than unknowns, and that of an axis more sizes: one that goes through all
 * of them shows nothing. */
static bool enough(const struct search *s, const struct br_joint_law *law)
{
    int unknown[BR_UNKNOWNS];
    const double spare = s->any_model ? 1 : 2, noise = 1e-9;
    double weight = noise;
    for (size_t i = 0; i < s->used.count; i++)
        weight += s->used.cell[i].weight;
    bool good = weight >= (double)br_joint_unknowns(law, unknown) + spare;
    for (int a = 0; a < BR_AXES; a++)
        good = good && (!br_joint_has(law->kind, a) ||
                        sizes_of(&s->used, a) >= (law->of[a] && s->now > 0 ? 4 : 3));
    return good;
}

/* Whether cell i is outside a window. */
static bool is_out(const struct search *s, const struct window *w, size_t i)
{
    const struct br_joint_cell *c = &s->all.cell[i];
    return (w->far && s->far[i]) || c->at[0] + w->lost[0] >= s->all.sizes[0] ||
           c->at[1] + w->lost[1] >= s->all.sizes[1];
}

static void add_window(struct search *s, struct window w)
{
    w.log_prior = (double)(w.lost[0] + w.lost[1]) * log(br_priors.leaves_coarse);
    for (size_t i = 0; i < s->all.count; i++) {
        w.log_prior += w.far && s->far[i] ? log(br_priors.leaves_inside) : 0;
        w.log_prior += is_out(s, &w, i) ? s->all.cell[i].weight * log(br_priors.unexplained) : 0;
    }
    s->window[s->windows++] = w;
}

/* The laws of laws.h with one parameter; and orders that change at size j, or between it and the
 * next one, with a rate of fine sizes and two coarse sizes before. As on lines, that of the coarse
 * ones may count where these are more, or the others few. */
static void take_options(struct search *s)
{
    enum { FEW = 3, BOTH = 3 };
    for (const struct br_family *f = br_families; f < br_families + BR_FAMILIES; f++) {
        const bool is_floor = f->law == BR_LAW_FLOOR || f->law == BR_LAW_FLOOR_SQUARES ||
                              f->law == BR_LAW_OFFSET,
                   bends = f->law == BR_LAW_NEXT ? f->prior > 0.015
                           : f->law == BR_LAW_SQUARES || f->law == BR_LAW_LOGARITHM
                               ? f->prior >= 0.005
                               : false;
        if (f->curve == 0 && (is_floor || bends))
            s->option[s->options++] = (struct option){*f, is_floor ? 0 : BOTH};
    }
    s->smooth = s->options;
    for (int a = 0; a < BR_AXES; a++) {
        const struct br_joint_size *size = s->all.size[a];
        const size_t m = s->all.sizes[a] - 1;
        for (size_t i = 4; i + 3 <= 2 * m && m <= MOST_SIZES; i++) {
            const size_t j = i / 2, between = i % 2, fine = j - 1 + between, coarse = m - j;
            const bool counts = fine <= FEW || coarse >= fine;
            s->option[s->options++] = (struct option){{.law = BR_LAW_KINK,
                                                       .s = counts ? br_priors.kink_coarse : 0,
                                                       .low = size[j].log_x,
                                                       .high = size[j + between].log_x,
                                                       .prior = br_priors.kink / (double)m},
                                                      1 << a};
        }
    }
}

/* ---- one model ---- */

static double log_evidence(const struct search *s, const struct candidate *c)
{
    const struct br_joint_trial *t = &c->trial;
    double rounded = 0;
    for (size_t i = 0; i < s->used.count; i++)
        rounded += s->used.cell[i].weight * pow(s->used.cell[i].rounded, 2) / t->weight;
    const double f = t->freedom;
    const double squares = t->sum + (pow(br_priors.least_scatter, 2) + rounded) * f;
    return s->window[c->window].log_prior + br_joint_log_prior(&s->all, t) + lgamma(f / 2) -
           f / 2 * log(M_PI * squares) + t->log_determinant / 2 -
           log1p(sqrt(squares / f) / br_priors.usual_scatter);
}

/* The values of a trial in m and s: a constant is that of the power, at a size of one. */
static void in_units(const struct search *s, const struct br_joint_trial *t,
                     double value[BR_UNKNOWNS])
{
    memcpy(value, t->value, sizeof t->value);
    for (int a = 0; a < BR_AXES; a++)
        value[LOG_C(a)] += s->log_error - value[ORDER(a)] * s->unit[a] - t->bend[a];
    value[BR_LOG_F] += s->log_error;
}

static void set_deviations(const struct search *s, struct candidate *c)
{
    int unknown[BR_UNKNOWNS];
    const struct br_joint_trial *t = &c->trial;
    const size_t n = br_joint_unknowns(&t->law, unknown);
    const double residual = t->sum / fmax(1, t->weight - (double)n);
    for (size_t i = 0; i < n; i++) {
        double variance = t->covariance[i][i];
        for (int a = 0; a < BR_AXES; a++) /* the order is behind the constant */
            if (unknown[i] == LOG_C(a) && s->unit[a] != 0)
                variance += s->unit[a] * (s->unit[a] * t->covariance[i + 1][i + 1] -
                                          2 * t->covariance[i][i + 1]);
        c->deviation[unknown[i]] = variance > 0 ? sqrt(residual * variance) : INFINITY;
    }
}

/* Whether the search for an order went to that of a floor, beside another error or with a law. */
static bool ends_at_a_floor(const struct br_joint_trial *t)
{
    int unknown[BR_UNKNOWNS];
    bool ends = false;
    for (int a = 0; a < BR_AXES; a++)
        ends |= br_joint_has(t->law.kind, a) && t->value[ORDER(a)] < 1.001 * br_priors.least_order;
    return ends && br_joint_unknowns(&t->law, unknown) > 2;
}

static bool changes_along(const struct br_joint_law *law, int axis)
{
    return law->of[axis] && law->of[axis]->law == BR_LAW_KINK;
}

/* Adds the fit of a law to the window, from the best of these starts. */
static void add_candidate(struct search *s, const struct br_joint_law *law,
                          const double (*start)[BR_UNKNOWNS], size_t starts)
{
    struct candidate *c = &s->candidate[s->count];
    if (s->count == MOST_TRIALS || !enough(s, law))
        return;
    *c = (struct candidate){.trial = {.sum = INFINITY}, .window = s->now, .log_weight = -INFINITY};
    for (size_t i = 0; i < starts; i++) {
        struct br_joint_trial t = {.law = *law, .sum = INFINITY};
        memcpy(t.value, start[i], sizeof t.value);
        if (starts > 1)
            br_joint_approach(&s->used, 0, &t);
        if (i == 0 || t.sum < c->trial.sum)
            c->trial = t;
    }
    br_joint_descend(&s->used, &c->trial);
    c->laws = (size_t)((law->of[0] != NULL) + (law->of[1] != NULL) + (law->floor != NULL));
    s->count++;
    if (!isfinite(c->trial.sum) || ends_at_a_floor(&c->trial))
        return;
    set_deviations(s, c);
    const double weight = s->any_model ? log_evidence(s, c)
                                       : -br_akaike(c->trial.sum, s->used.count,
                                                    br_joint_unknowns(law, (int[BR_UNKNOWNS]){0})) /
                                             2;
    c->log_weight = isfinite(weight) ? weight : -INFINITY;
    s->best = fmax(s->best, c->log_weight);
}

/* ---- the search ---- */

static const struct br_joint_law plain[] = {
    {.kind = BR_JOINT_BOTH, .sum = BR_SUM_ANY},
    {.kind = BR_JOINT_TIME},
    {.kind = BR_JOINT_SPACE},
    {.kind = BR_JOINT_BOTH, .sum = BR_SUM_ADDS},
    {.kind = BR_JOINT_BOTH, .sum = BR_SUM_SUBTRACTS},
};
enum { PLAIN = sizeof plain / sizeof *plain, KINDS = BR_JOINT_SPACE + 1, STARTS = 15 };

/* The starts of one power: the sum of squares has local minima in r and p. */
static size_t starts_of(const struct br_joint_cells *cells, const struct br_joint_law *law,
                        double (*start)[BR_UNKNOWNS])
{
    static const double orders[][BR_AXES] = {{1, 1}, {2, 2}, {4, 4}, {4, 1}, {1, 4}},
                        correlations[] = {0, -0.9, 0.9};
    const bool both = law->kind == BR_JOINT_BOTH;
    size_t count = 0;
    for (size_t i = 0; i < (both ? 5 : 3); i++)
        for (size_t j = 0; j < (both && law->sum == BR_SUM_ANY ? 3 : 1); j++)
            br_joint_start(cells, orders[i], correlations[j], start[count++]);
    return count;
}

static bool is_tried(const struct search *s, const struct br_joint_law *law)
{
    for (const struct candidate *c = s->candidate; c < s->candidate + s->count; c++) {
        const struct br_joint_law *o = &c->trial.law;
        if (c->window == s->now && o->kind == law->kind && o->sum == law->sum &&
            o->of[0] == law->of[0] && o->of[1] == law->of[1] && o->floor == law->floor)
            return true;
    }
    return false;
}

/* Tries a candidate's model with a law of these axes, as bits; 0: it is a floor. What it adds is
 * small, or larger than the first term, so that a lower order comes up. */
static void extend(struct search *s, const struct candidate *from, const struct br_family *f,
                   int axes)
{
    const bool kink = f->law == BR_LAW_KINK;
    struct br_joint_law law = from->trial.law;
    double start[2][BR_UNKNOWNS];
    for (int i = 0; i < 2; i++) {
        memcpy(start[i], from->trial.value, sizeof *start);
        if (kink && i)
            start[i][BR_THETA] = 0;
        for (int a = 0; a < BR_AXES; a++) {
            double *v = &start[i][BR_OF_AXIS * a];
            if (!(axes >> a & 1))
                continue;
            law.of[a] = f;
            v[BR_SHAPE] = i ? 1.5 : br_joint_shape_start(f);
            v[BR_ORDER] = fmax(0.3, v[BR_ORDER] - 0.5 * i * (kink ? 1 : f->s));
            v[BR_PLACE] = (f->low + f->high) / 2;
        }
    }
    if (!axes)
        law.floor = f;
    if (!is_tried(s, &law))
        add_candidate(s, &law, start, axes && (kink || f->law == BR_LAW_NEXT) ? 2 : 1);
}

/* Tries a candidate's model with each option in this range. Laws of an axis are exchanged where
 * both axes have one. */
static void extend_by(struct search *s, const struct candidate *from, size_t first, size_t end)
{
    const struct br_joint_law *law = &from->trial.law;
    const bool bent = law->of[0] && law->of[1];
    for (const struct option *o = s->option + first; o < s->option + end; o++) {
        for (int a = 0; a < BR_AXES; a++)
            if (o->axes >> a & 1 && br_joint_has(law->kind, a) && (bent || !law->of[a]))
                extend(s, from, &o->family, 1 << a);
        if (from->laws == 0 && law->kind == BR_JOINT_BOTH && o->family.law == BR_LAW_NEXT)
            extend(s, from, &o->family, 3);
        if (!o->axes && !law->floor && !bent)
            extend(s, from, &o->family, 0);
    }
}

/* The likeliest candidate of a window; MOST_WINDOWS: of all. */
static const struct candidate *likeliest(const struct search *s, size_t window)
{
    const struct candidate *best = NULL;
    for (const struct candidate *c = s->candidate; c < s->candidate + s->count; c++)
        if ((c->window == window || window == MOST_WINDOWS) &&
            (!best || c->log_weight > best->log_weight))
            best = c;
    return best;
}

/* Models that are less probable than the best one by more than this logarithm are not extended, nor
 * those with a law that are less probable than one without any (Occam's window). Of one power, all
 * that may be are. */
static const double occam = 5, all_plain = 15;

/* Extends the candidates from `from` on, also those that come so, by the options in this range.
 * plain_margin: in place of all_plain. */
static void grow(struct search *s, size_t from, size_t first, size_t end, double plain_margin)
{
    double plainest = -INFINITY;
    for (size_t i = from; i < s->count; i++)
        if (s->candidate[i].laws == 0)
            plainest = fmax(plainest, s->candidate[i].log_weight);
    for (size_t i = from; i < s->count; i++) {
        const struct candidate c = s->candidate[i];
        if (c.laws == 0   ? !(c.log_weight < plainest - plain_margin)
            : c.laws == 1 ? c.log_weight > fmax(s->best - occam, plainest)
                          : false)
            extend_by(s, &c, first, end);
    }
}

/* Whether a model describes the cells to their digits, with more sizes than unknowns of a bent
 * axis: then no order that changes is tried. */
static bool is_exact(const struct search *s, const struct br_joint_trial *t)
{
    static const double least = 1e-6, digits = 1.5; /* variances of rounding */
    double digits_make = 0;
    bool spare = true;
    for (size_t i = 0; i < s->used.count; i++)
        digits_make +=
            s->used.cell[i].weight * (least * least + digits * pow(s->used.cell[i].rounded, 2));
    for (int a = 0; a < BR_AXES; a++)
        spare = spare && (!t->law.of[a] || sizes_of(&s->used, a) > (t->law.floor ? 4 : 3));
    return spare && t->sum <= digits_make;
}

/* Goes to a window: its cells are used from here on. */
static void look_at(struct search *s, size_t window)
{
    s->now = window;
    s->used.count = 0;
    for (size_t i = 0; i < s->all.count; i++)
        if (!is_out(s, &s->window[window], i))
            s->used.cell[s->used.count++] = s->all.cell[i];
}

/* Tries orders that change; and beside the best change along each axis, all other laws. */
static void grow_changes(struct search *s, size_t from)
{
    grow(s, from, s->smooth, s->options, INFINITY);
    for (int a = 0; a < BR_AXES; a++) {
        size_t best = s->count;
        for (size_t i = from; i < s->count; i++)
            if (s->candidate[i].laws == 1 && changes_along(&s->candidate[i].trial.law, a) &&
                (best == s->count || s->candidate[i].log_weight > s->candidate[best].log_weight))
                best = i;
        if (best < s->count) {
            const struct candidate c = s->candidate[best];
            extend_by(s, &c, 0, s->options);
        }
    }
}

static void search_window(struct search *s, size_t window)
{
    double start[STARTS][BR_UNKNOWNS];
    const size_t from = s->count;
    look_at(s, window);
    for (size_t i = 0; i < (s->any_model ? PLAIN : KINDS); i++)
        add_candidate(s, &plain[i], start, starts_of(&s->used, &plain[i], start));
    if (!s->any_model || s->count == from)
        return;
    grow(s, from, 0, s->smooth, all_plain);
    if (!is_exact(s, &likeliest(s, window)->trial))
        grow_changes(s, from);
    for (int turn = 0; turn < 2; turn++) {
        const struct candidate best = *likeliest(s, window);
        if (best.trial.law.of[0] && best.trial.law.of[1])
            extend_by(s, &best, 0, s->smooth);
    }
}

/* The models of the first windows that are not ruled out, fitted to another one. */
static void refit_window(struct search *s, size_t window, size_t count)
{
    look_at(s, window);
    for (size_t i = 0; i < count; i++) {
        const struct candidate *c = &s->candidate[i];
        if (isfinite(c->log_weight) && (c->log_weight > s->best - occam || c->laws == 0) &&
            !is_tried(s, &c->trial.law))
            add_candidate(s, &c->trial.law, (const double(*)[BR_UNKNOWNS]) & c->trial.value, 1);
    }
}

/* So far off, in logarithms, a cell does not show the order. */
static const double far = 0.5;

/* The window without cells that are far off what the others show, at most a quarter of all. */
static void leave_out_far(struct search *s)
{
    static const double robust = 0.1;
    double start[STARTS][BR_UNKNOWNS];
    struct br_joint_trial best = {.sum = INFINITY};
    size_t count = 0;
    look_at(s, 0);
    for (size_t i = 0; i < KINDS; i++)
        for (size_t j = enough(s, &plain[i]) ? starts_of(&s->used, &plain[i], start) : 0;
             j-- > 0;) {
            struct br_joint_trial t = {.law = plain[i], .sum = INFINITY};
            memcpy(t.value, start[j], sizeof t.value);
            for (double scale = 10 * robust; scale >= robust; scale /= 3)
                br_joint_approach(&s->used, scale, &t);
            if (t.sum < best.sum)
                best = t;
        }
    if (!isfinite(best.sum))
        return;
    br_joint_residuals(&s->used, &best, s->residual);
    for (size_t i = 0; i < s->all.count; i++)
        count += s->far[i] = fabs(s->residual[i]) > far;
    if (count > 0 && 4 * count <= s->all.count)
        add_window(s, (struct window){.far = true});
}

/* All windows: the first has all cells. */
static void search_all(struct search *s)
{
    static const size_t lost[][BR_AXES] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}};
    add_window(s, (struct window){0});
    search_window(s, 0);
    if (!s->any_model || s->count == 0)
        return;
    if (likeliest(s, 0)->trial.worst > far / 2)
        leave_out_far(s);
    if (s->windows > 1)
        search_window(s, 1);
    const size_t count = s->count;
    const struct window from = s->window[likeliest(s, MOST_WINDOWS)->window];
    for (size_t w = 0; w < sizeof lost / sizeof *lost; w++)
        if (s->all.sizes[0] > lost[w][0] + 3 && s->all.sizes[1] > lost[w][1] + 3) {
            add_window(s, (struct window){.far = from.far, .lost = {lost[w][0], lost[w][1]}});
            refit_window(s, s->windows - 1, count);
        }
}

/* ---- intervals ---- */

/* How far neighbours along h and along k have residuals of one sign: the sum of their products, in
 * standard deviations of that of independent ones. A wrong model leaves waves, noise does not. */
static double structure_of(const struct br_joint_cells *cells, const double *residual)
{
    double products = 0, pairs = 0, squares = 0;
    for (size_t i = 0; i < cells->count; i++) {
        const struct br_joint_cell *at = &cells->cell[i];
        squares += residual[i] * residual[i] / (double)cells->count;
        for (int a = 0; a < BR_AXES; a++) {
            size_t next = cells->count, size = 0;
            for (size_t j = 0; j < cells->count; j++) {
                const struct br_joint_cell *o = &cells->cell[j];
                if (o->at[1 - a] == at->at[1 - a] && o->at[a] < at->at[a] && o->at[a] > size) {
                    size = o->at[a];
                    next = j;
                }
            }
            products += next < cells->count ? residual[i] * residual[next] : 0;
            pairs += next < cells->count;
        }
    }
    return pairs > 0 && squares > 0 ? products / squares / sqrt(pairs) : 0;
}

/* Residuals with less structure than this are as independent as noise is. Those below `exact` do
 * not scatter. */
static const double waves = 0.7, exact = 1e-4;

/* Cells that share h or k are not independent: the residuals are deterministic. So the intervals
 * come from leaving out one whole line of the grid after the other (delete-a-group jackknife, Efron
 * 1982), where they are wider. */
static void widen_along(struct search *s, struct candidate *c, int axis)
{
    static const double off_the_end = 0.9;
    int unknown[BR_UNKNOWNS];
    double sum[BR_UNKNOWNS] = {0}, squares[BR_UNKNOWNS] = {0}, groups = 0, whole[BR_UNKNOWNS];
    in_units(s, &c->trial, whole);
    const size_t unknowns = br_joint_unknowns(&c->trial.law, unknown);
    struct br_joint_cells rest = s->used;
    rest.cell = s->rest;
    for (size_t size = 1; size < s->used.sizes[axis]; size++) {
        rest.count = 0;
        for (size_t i = 0; i < s->used.count; i++)
            if (s->used.cell[i].at[axis] != size)
                rest.cell[rest.count++] = s->used.cell[i];
        if (rest.count == s->used.count)
            continue;
        struct br_joint_trial without = c->trial;
        without.sum = INFINITY;
        without.value[BR_THETA] *= off_the_end; /* where it is 1, r has no slope to leave by */
        if (rest.count > unknowns)
            br_joint_descend(&rest, &without);
        double value[BR_UNKNOWNS];
        in_units(s, &without, value);
        for (size_t i = 0; i < unknowns; i++) {
            const double off =
                isfinite(without.sum) ? value[unknown[i]] - whole[unknown[i]] : (double)NAN;
            sum[i] += off;
            squares[i] += off * off;
        }
        groups++;
    }
    const double quantiles =
        gsl_cdf_tdist_Pinv(0.975, groups - 1) / gsl_cdf_tdist_Pinv(0.975, c->trial.freedom);
    for (size_t i = 0; i < unknowns; i++) {
        const double spread = squares[i] - sum[i] * sum[i] / groups;
        const double deviation = sqrt((groups - 1) / groups * fmax(0, spread)) * quantiles;
        if (!(deviation <= c->deviation[unknown[i]])) /* NaN: a refit failed */
            c->deviation[unknown[i]] = isfinite(spread) ? deviation : INFINITY;
    }
}

static void widen(struct search *s, struct candidate *c)
{
    const struct br_joint_law *law = &c->trial.law;
    if (c->widened || changes_along(law, 0) || changes_along(law, 1))
        return; /* the interval reaches from order to order */
    look_at(s, c->window);
    br_joint_residuals(&s->used, &c->trial, s->residual);
    const bool noise = c->trial.sum > exact * exact * c->trial.weight;
    if (s->any_model && (noise || !(law->of[0] || law->of[1])) &&
        structure_of(&s->used, s->residual) < waves)
        return;
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(law->kind, a))
            widen_along(s, c, a);
    c->widened = true;
}

/* ---- what one model makes of the errors ---- */

/* A number with its interval by the deviation of an unknown; NaN: there is none. */
static struct br_estimate estimate(const struct candidate *c, bool has, double value, int unknown)
{
    return br_estimate_of(has ? value : (double)NAN, c->deviation[unknown],
                          (size_t)c->trial.freedom);
}

/* r with its interval by the slope of the sine, within [-1, 1]. */
static struct br_estimate correlation(const struct candidate *c)
{
    static const double fixed[BR_SUMS] = {[BR_SUM_ADDS] = 1, [BR_SUM_SUBTRACTS] = -1};
    const struct br_joint_law *law = &c->trial.law;
    const double theta = c->trial.value[BR_THETA], r = fixed[law->sum];
    if (law->kind == BR_JOINT_BOTH && law->sum != BR_SUM_ANY)
        return (struct br_estimate){r, r, r};
    struct br_estimate e = estimate(c, law->kind == BR_JOINT_BOTH, theta, BR_THETA);
    const double half = fabs(cos(theta)) * (e.high - e.value);
    e.value = sin(e.value);
    e.low = e.value - half < -1 ? -1 : e.value - half; /* NaN stays */
    e.high = e.value + half > 1 ? 1 : e.value + half;
    return e;
}

static void describe(struct search *s, const struct candidate *c, struct br_joint_fit *fit)
{
    static const double most_scatter = 0.3, most_structure = 1;
    static const double round_off = 1e-24; /* a mean square below this */
    const struct br_joint_trial *t = &c->trial;
    const double as_99 =
        gsl_cdf_tdist_Pinv(0.995, t->freedom) / gsl_cdf_tdist_Pinv(0.975, t->freedom);
    double mean = 0, total = 0, value[BR_UNKNOWNS];
    in_units(s, t, value);
    look_at(s, c->window);
    *fit = (struct br_joint_fit){.kind = t->law.kind,
                                 .converged = true,
                                 .points = s->used.count,
                                 .left_out = s->all.count - s->used.count,
                                 .freedom = (size_t)t->freedom,
                                 .worst = t->worst,
                                 .misfit =
                                     t->sum / t->weight > round_off ? sqrt(t->sum / t->weight) : 0,
                                 .r = correlation(c),
                                 .floor = t->law.floor ? exp(value[BR_LOG_F]) : (double)NAN};
    br_joint_residuals(&s->used, t, s->residual);
    for (int a = 0; a < BR_AXES; a++) {
        const bool has = br_joint_has(t->law.kind, a);
        struct br_estimate e = estimate(c, has, value[LOG_C(a)], LOG_C(a));
        fit->c[a] = (struct br_estimate){exp(e.value), exp(e.low), exp(e.high)};
        if (t->law.of[a]) /* its deviation is that of the error at the coarsest size */
            fit->c[a].low = fit->c[a].high = NAN;
        e = fit->order[a] = estimate(c, has, value[ORDER(a)], ORDER(a));
        const double half = as_99 * (e.high - e.value);
        fit->low99[a] = e.value - half;
        fit->high99[a] = e.value + half;
        fit->share[a] = br_joint_share(&s->used, a);
        fit->law[a] = has && t->law.of[a] ? br_law_text(t->law.of[a]->law) : NULL;
    }
    for (size_t i = 0; i < s->used.count; i++)
        mean += s->used.cell[i].log_error / (double)s->used.count;
    for (size_t i = 0; i < s->used.count; i++)
        total += pow(s->used.cell[i].log_error - mean, 2);
    fit->r_squared = total > 0 ? 1 - t->sum / total : NAN;
    fit->scatters = s->any_model && fit->misfit <= most_scatter &&
                    structure_of(&s->used, s->residual) <= most_structure;
}

double br_joint_model(const struct br_joint_fit *fit, const double x[BR_AXES],
                      const double ref[BR_AXES])
{
    double e[BR_AXES] = {0};
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(fit->kind, a))
            e[a] = fit->c[a].value *
                   (pow(x[a], fit->order[a].value) - pow(ref[a], fit->order[a].value));
    const double r = fit->kind == BR_JOINT_BOTH ? fit->r.value : 0;
    const double square = e[0] * e[0] + 2 * r * e[0] * e[1] + e[1] * e[1];
    return sqrt(square < 0 ? 0 : square); /* NaN stays */
}

/* Where the errors of both axes subtract, an order inside the interval may show the least error. */
struct br_estimate br_joint_band(const struct br_joint_fit *fit, enum br_axis axis, double middle,
                                 const double x[BR_AXES], const double ref[BR_AXES])
{
    enum { ORDERS = 32 }; /* of the interval, from end to end; the last one is the order itself */
    const struct br_estimate *order = &fit->order[axis];
    struct br_estimate e = {NAN, NAN, NAN};
    for (size_t i = 0; i <= ORDERS + 1; i++) {
        struct br_joint_fit other = *fit;
        double *p = &other.order[axis].value;
        if (i <= ORDERS)
            *p = order->low + (double)i / ORDERS * (order->high - order->low);
        other.c[axis].value *= pow(middle, order->value - *p);
        e.value = br_joint_model(&other, x, ref);
        e.low = fmin(e.low, e.value); /* without the NaN of before */
        e.high = fmax(e.high, e.value);
    }
    return e;
}

/* ---- one model, or the mixture ---- */

static int by_weight(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    return (x->log_weight < y->log_weight) - (x->log_weight > y->log_weight);
}

static bool one_determined(const struct br_joint_fit *fit)
{
    return br_order_determined(&fit->order[0]) || br_order_determined(&fit->order[1]);
}

/* Whether all orders of the model are determined. */
static bool all_determined(const struct br_joint_fit *fit)
{
    return (!br_joint_has(fit->kind, 0) || br_order_determined(&fit->order[0])) &&
           (!br_joint_has(fit->kind, 1) || br_order_determined(&fit->order[1]));
}

/* The best model whose orders are determined; else that of both errors, if one of them is. */
static void take_one(struct search *s, struct br_joint_fit *fit)
{
    struct br_joint_fit one;
    for (size_t i = 0; i < s->count && !fit->converged; i++) {
        describe(s, &s->candidate[i], &one);
        if (!all_determined(&one))
            continue;
        widen(s, &s->candidate[i]);
        describe(s, &s->candidate[i], &one);
        *fit = all_determined(&one) ? one : *fit;
    }
    for (size_t i = 0; i < s->count && !br_joint_describes(fit); i++) {
        if (s->candidate[i].trial.law.kind != BR_JOINT_BOTH)
            continue;
        widen(s, &s->candidate[i]);
        describe(s, &s->candidate[i], &one);
        if (br_joint_describes(&one) && one_determined(&one))
            *fit = one;
        return;
    }
}

/* The probability that the order of an axis is below this one, by one model. */
static double below(const struct candidate *c, int axis, double order)
{
    const double scale = hypot(c->deviation[ORDER(axis)], c->trial.open[axis]),
                 off = order - c->trial.value[ORDER(axis)],
                 coarse = changes_along(&c->trial.law, axis) ? c->trial.law.of[axis]->s : 0;
    if (!isfinite(scale))
        return 0.5;
    double sum = (1 - coarse) * br_student_below(off / scale, c->trial.freedom);
    if (coarse > 0)
        sum += coarse *
               br_student_below((off - c->trial.value[ORDER(axis) - BR_ORDER + BR_SHAPE]) / scale,
                                c->trial.freedom);
    return sum;
}

/* The order of an axis below which this share of the mixture is. */
static double quantile(const struct search *s, int axis, double all, double share)
{
    double low = -60, high = 60;
    while (high - low > 1e-9) {
        const double at = (low + high) / 2;
        double sum = 0;
        for (size_t i = 0; i < s->count; i++)
            if (br_joint_has(s->candidate[i].trial.law.kind, axis))
                sum += s->candidate[i].log_weight * below(&s->candidate[i], axis, at);
        *(sum < share * all ? &low : &high) = at;
    }
    return (low + high) / 2;
}

/* Models of less weight than this logarithm below the best are not kept, and of less than that not
 * widened. */
static const double kept = 8.5, widened = 0.02;

/* The mixture: from logarithms to weights of sum 1. An axis whose error most of the weight does not
 * see has no order. */
static void take_mixture(struct search *s, struct br_joint_fit *fit)
{
    double sum = 0, sees[BR_AXES] = {0};
    size_t count = 0;
    while (count < s->count && s->candidate[count].log_weight >= s->best - kept)
        sum += exp(s->candidate[count++].log_weight - s->best);
    s->count = count;
    for (size_t i = 0; i < count; i++) {
        struct candidate *c = &s->candidate[i];
        c->log_weight = exp(c->log_weight - s->best) / sum;
        if (c->log_weight > widened)
            widen(s, c);
        for (int a = 0; a < BR_AXES; a++)
            sees[a] += br_joint_has(c->trial.law.kind, a) ? c->log_weight : 0;
    }
    const enum br_joint_kind kind = sees[BR_AXIS_SPACE] < 0.5  ? BR_JOINT_TIME
                                    : sees[BR_AXIS_TIME] < 0.5 ? BR_JOINT_SPACE
                                                               : BR_JOINT_BOTH;
    size_t likely = 0;
    while (likely + 1 < count && s->candidate[likely].trial.law.kind != kind)
        likely++;
    describe(s, &s->candidate[likely], fit);
    for (int a = 0; a < BR_AXES; a++) {
        if (!br_joint_has(fit->kind, a))
            continue;
        fit->order[a] =
            (struct br_estimate){quantile(s, a, sees[a], 0.5), quantile(s, a, sees[a], 0.025),
                                 quantile(s, a, sees[a], 0.975)};
        if (fit->order[a].low < br_priors.least_order) /* no order, or a floor */
            fit->order[a].low = fmin(fit->order[a].low, 0);
        fit->low99[a] = quantile(s, a, sees[a], 0.005);
        fit->high99[a] = quantile(s, a, sees[a], 0.995);
    }
}

static struct br_joint_fit nothing_fitted(size_t points)
{
    const struct br_estimate none = {NAN, NAN, NAN};
    return (struct br_joint_fit){.c = {none, none},
                                 .order = {none, none},
                                 .r = none,
                                 .misfit = NAN,
                                 .worst = NAN,
                                 .r_squared = NAN,
                                 .floor = NAN,
                                 .points = points};
}

/* Cells that the most probable model leaves out; those of a whole size are too coarse. */
static void flag_cells(const struct search *s, struct br_observation *observation)
{
    const struct window *window = &s->window[s->count ? s->candidate[0].window : 0];
    for (size_t i = 0; i < s->all.count; i++)
        observation[i].flag = !is_out(s, window, i)           ? BR_FLAG_NONE
                              : s->window[1].far && s->far[i] ? BR_FLAG_OUTLIER
                                                              : BR_FLAG_COARSE;
}

/* All memory of a search; false: there is none. */
static bool make_room(struct search *s)
{
    const size_t count = s->all.count;
    s->all.cell = br_allocate(3 * count + 1, sizeof *s->all.cell);
    s->all.size[0] = br_allocate(4 * count + 4, sizeof *s->all.size[0]);
    s->all.room = br_allocate(br_joint_room(count) + 2 * count, sizeof *s->all.room);
    s->far = br_allocate(count + 1, sizeof *s->far);
    s->candidate = br_allocate(MOST_TRIALS, sizeof *s->candidate);
    if (!s->all.cell || !s->all.size[0] || !s->all.room || !s->far || !s->candidate)
        return false;
    s->all.size[1] = s->all.size[0] + 2 * count + 2;
    s->residual = s->all.room + br_joint_room(count);
    return true;
}

static void fit_all(struct search *s, struct br_observation *observation, struct br_joint_fit *fit)
{
    take_cells(s, observation);
    take_options(s);
    s->used = s->all;
    s->used.cell = s->all.cell + s->all.count;
    s->rest = s->used.cell + s->all.count;
    search_all(s);
    qsort(s->candidate, s->count, sizeof *s->candidate, by_weight);
    while (s->count && !isfinite(s->candidate[s->count - 1].log_weight))
        s->count--;
    if (s->count && s->any_model)
        take_mixture(s, fit);
    else
        take_one(s, fit);
    if (!one_determined(fit))
        *fit = nothing_fitted(s->all.count);
    flag_cells(s, observation);
}

enum br_status br_joint_fit_solve(struct br_observation *observation, size_t count, bool any_model,
                                  const struct br_observer *observer, struct br_joint_fit *fit,
                                  struct br_error *err)
{
    struct search s = {.any_model = any_model,
                       .best = -INFINITY,
                       .all = {.count = count, .priors = any_model, .observer = observer}};
    *fit = nothing_fitted(count);
    const enum br_status status = make_room(&s) ? BR_OK : br_no_memory(err, "the fits");
    if (!status && count > 0)
        fit_all(&s, observation, fit);
    free(s.all.cell);
    free(s.all.size[0]);
    free(s.all.room);
    free(s.far);
    free(s.candidate);
    if (!status && br_observer_stops(observer))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    return status;
}

bool br_joint_describes(const struct br_joint_fit *fit)
{
    return fit->converged && (fit->misfit <= 0.02 || fit->scatters);
}
