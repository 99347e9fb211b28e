/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The models of a grid (joint_model.h), whose mixture has its orders, as on lines (line_order.h).
 * Each axis has a law of the one family; models with more laws are tried only where those with
 * fewer are not ruled out (Occam's window: Madigan and Raftery, Journal of the American Statistical
 * Association 89, 1535-1546, 1994). Each is fitted to all cells, and to windows without cells that
 * are far off, or without the coarsest sizes. With S the sum of squares of n residuals that k
 * unknowns leave, H their curvature with that of the priors, the evidence is (Laplace)
 *     prior Gamma(f/2) (pi S)^(-f/2) det(H)^(-1/2),   f = n - k. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"
#include "orders/grid/joint_search.h"

/* ---- the cells ---- */

static size_t size_of(const struct br_joint_cells *c, int axis, double x)
{
    size_t i = c->sizes[axis];
    while (i > 0 && c->size[axis][i - 1].x != x)
        i--;
    return i - 1;
}

/* The different sizes of an axis, ascending, after 0. value: room for two a cell. */
static void take_sizes(struct br_joint_search *s, const struct br_point *o, int axis, double *value)
{
    struct br_joint_cells *c = &s->all;
    for (size_t i = 0; i < c->count; i++) {
        value[2 * i] = o[i].x[axis];
        value[2 * i + 1] = o[i].ref[axis];
    }
    qsort(value, 2 * c->count, sizeof *value, br_by_number);
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

static void take_cells(struct br_joint_search *s, const struct br_point *o)
{
    struct br_joint_cells *c = &s->all;
    double *value = s->residual;
    for (size_t i = 0; i < c->count; i++)
        value[i] = log(o[i].error);
    qsort(value, c->count, sizeof *value, br_by_number);
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

/* A fit needs more cells than unknowns, and that of an axis more sizes: one that goes through all
 * of them shows nothing. */
static bool enough(const struct br_joint_search *s, const struct br_joint_law *law)
{
    int unknown[BR_UNKNOWNS];
    const double spare = s->any_model ? 1 : 2, noise = 1e-9;
    double weight = noise;
    for (size_t i = 0; i < s->used.count; i++)
        weight += s->used.cell[i].weight;
    bool good = weight >= (double)br_joint_unknowns(law, unknown) + spare;
    for (int a = 0; a < BR_AXES; a++)
        good = good && (!br_joint_has(law->kind, a) ||
                        br_joint_sizes(&s->used, a) >= (law->of[a] && s->now > 0 ? 4 : 3));
    return good;
}

bool br_joint_is_out(const struct br_joint_search *s, const struct br_joint_window *w, size_t i)
{
    const struct br_joint_cell *c = &s->all.cell[i];
    return (w->far && s->far[i]) || c->at[0] + w->lost[0] >= s->all.sizes[0] ||
           c->at[1] + w->lost[1] >= s->all.sizes[1];
}

static void add_window(struct br_joint_search *s, struct br_joint_window w)
{
    w.log_prior = (double)(w.lost[0] + w.lost[1]) * log(br_priors.leaves_coarse);
    for (size_t i = 0; i < s->all.count; i++) {
        w.log_prior += w.far && s->far[i] ? log(br_priors.leaves_inside) : 0;
        w.log_prior +=
            br_joint_is_out(s, &w, i) ? s->all.cell[i].weight * log(br_priors.unexplained) : 0;
    }
    s->window[s->windows++] = w;
}

/* The laws of laws.h with one parameter; and orders that change at size j, or between it and the
 * next one, with a rate of fine sizes and two coarse sizes before. As on lines, that of the coarse
 * ones may count where these are more, or the others few. */
static void take_options(struct br_joint_search *s)
{
    enum { FEW = 3, BOTH = 3 };
    for (const struct br_family *f = br_families; f < br_families + BR_FAMILIES; f++) {
        const bool is_floor = br_law_is_floor(f->law),
                   bends = f->law == BR_LAW_NEXT ? f->prior > 0.015
                           : f->law == BR_LAW_SQUARES || f->law == BR_LAW_LOGARITHM
                               ? f->prior >= 0.005
                               : false;
        if (f->curve == 0 && (is_floor || bends))
            s->option[s->options++] = (struct br_joint_option){*f, is_floor ? 0 : BOTH};
    }
    s->smooth = s->options;
    for (int a = 0; a < BR_AXES; a++) {
        const struct br_joint_size *size = s->all.size[a];
        const size_t m = s->all.sizes[a] - 1;
        for (size_t i = 4; i + 3 <= 2 * m && m <= BR_JOINT_SIZES; i++) {
            const size_t j = i / 2, between = i % 2, fine = j - 1 + between, coarse = m - j;
            const bool counts = fine <= FEW || coarse >= fine;
            s->option[s->options++] =
                (struct br_joint_option){{.law = BR_LAW_KINK,
                                          .s = counts ? br_priors.kink_coarse : 0,
                                          .low = size[j].log_x,
                                          .high = size[j + between].log_x,
                                          .prior = br_priors.kink / (double)m},
                                         1 << a};
        }
    }
}

/* ---- one model ---- */

static double log_evidence(const struct br_joint_search *s, const struct br_joint_candidate *c)
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

void br_joint_in_units(const struct br_joint_search *s, const struct br_joint_trial *t,
                       double value[BR_UNKNOWNS])
{
    memcpy(value, t->value, sizeof t->value);
    for (int a = 0; a < BR_AXES; a++)
        value[BR_OF(a, BR_LOG_C)] +=
            s->log_error - value[BR_OF(a, BR_ORDER)] * s->unit[a] - t->bend[a];
    value[BR_LOG_F] += s->log_error;
}

static void set_deviations(const struct br_joint_search *s, struct br_joint_candidate *c)
{
    int unknown[BR_UNKNOWNS];
    const struct br_joint_trial *t = &c->trial;
    const size_t n = br_joint_unknowns(&t->law, unknown);
    const double residual = t->sum / fmax(1, t->weight - (double)n);
    for (size_t i = 0; i < n; i++) {
        double variance = t->covariance[i][i];
        for (int a = 0; a < BR_AXES; a++) /* the order is behind the constant */
            if (unknown[i] == BR_OF(a, BR_LOG_C) && s->unit[a] != 0)
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
        ends |= br_joint_has(t->law.kind, a) &&
                t->value[BR_OF(a, BR_ORDER)] < 1.001 * br_priors.least_order;
    return ends && br_joint_unknowns(&t->law, unknown) > 2;
}

bool br_joint_changes_along(const struct br_joint_law *law, int axis)
{
    return law->of[axis] && law->of[axis]->law == BR_LAW_KINK;
}

/* Adds the fit of a law to the window, from the best of these starts. */
static void add_candidate(struct br_joint_search *s, const struct br_joint_law *law,
                          const double (*start)[BR_UNKNOWNS], size_t starts)
{
    struct br_joint_candidate *c = &s->candidate[s->count];
    if (s->count == BR_JOINT_TRIALS || !enough(s, law))
        return;
    *c = (struct br_joint_candidate){
        .trial = {.sum = INFINITY}, .tails = {1, 1}, .window = s->now, .log_weight = -INFINITY};
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

static bool is_tried(const struct br_joint_search *s, const struct br_joint_law *law)
{
    for (const struct br_joint_candidate *c = s->candidate; c < s->candidate + s->count; c++) {
        const struct br_joint_law *o = &c->trial.law;
        if (c->window == s->now && o->kind == law->kind && o->sum == law->sum &&
            o->of[0] == law->of[0] && o->of[1] == law->of[1] && o->floor == law->floor)
            return true;
    }
    return false;
}

/* Tries a candidate's model with a law of these axes, as bits; 0: it is a floor. What it adds is
 * small, or larger than the first term, so that a lower order comes up. */
static void extend(struct br_joint_search *s, const struct br_joint_candidate *from,
                   const struct br_family *f, int axes)
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
            v[BR_SHAPE] = i ? 1.5 : br_joint_shape_start(f, s->used.log_finest[a]);
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
static void extend_by(struct br_joint_search *s, const struct br_joint_candidate *from,
                      size_t first, size_t end)
{
    const struct br_joint_law *law = &from->trial.law;
    const bool bent = law->of[0] && law->of[1];
    for (const struct br_joint_option *o = s->option + first; o < s->option + end; o++) {
        for (int a = 0; a < BR_AXES; a++)
            if (o->axes >> a & 1 && br_joint_has(law->kind, a) && (bent || !law->of[a]))
                extend(s, from, &o->family, 1 << a);
        if (from->laws == 0 && law->kind == BR_JOINT_BOTH && o->family.law == BR_LAW_NEXT)
            extend(s, from, &o->family, 3);
        if (!o->axes && !law->floor && !bent)
            extend(s, from, &o->family, 0);
    }
}

/* The likeliest candidate of a window; BR_JOINT_WINDOWS: of all. */
static const struct br_joint_candidate *likeliest(const struct br_joint_search *s, size_t window)
{
    const struct br_joint_candidate *best = NULL;
    for (const struct br_joint_candidate *c = s->candidate; c < s->candidate + s->count; c++)
        if ((c->window == window || window == BR_JOINT_WINDOWS) &&
            (!best || c->log_weight > best->log_weight))
            best = c;
    return best;
}

/* Models that are less probable than the best one by more than this logarithm are not extended, nor
 * those with a law that are less probable than one without any (Occam's window). Those of one power
 * all are: where no power describes the cells, the worst may be the one that a law mends. */
static const double occam = 5;

/* Extends the candidates from `from` on, also those that come so, by the options in this range. */
static void grow(struct br_joint_search *s, size_t from, size_t first, size_t end)
{
    double plainest = -INFINITY;
    for (size_t i = from; i < s->count; i++)
        if (s->candidate[i].laws == 0)
            plainest = fmax(plainest, s->candidate[i].log_weight);
    for (size_t i = from; i < s->count; i++) {
        const struct br_joint_candidate c = s->candidate[i];
        if (c.laws == 0 || (c.laws == 1 && c.log_weight > fmax(s->best - occam, plainest)))
            extend_by(s, &c, first, end);
    }
}

/* Whether a model describes the cells to their digits, with more sizes than unknowns of a bent
 * axis: then no order that changes is tried. */
static bool is_exact(const struct br_joint_search *s, const struct br_joint_trial *t)
{
    static const double least = 1e-6, digits = 1.5; /* variances of rounding */
    double digits_make = 0;
    bool spare = true;
    for (size_t i = 0; i < s->used.count; i++)
        digits_make +=
            s->used.cell[i].weight * (least * least + digits * pow(s->used.cell[i].rounded, 2));
    for (int a = 0; a < BR_AXES; a++)
        spare = spare && (!t->law.of[a] || br_joint_sizes(&s->used, a) > (t->law.floor ? 4 : 3));
    return spare && t->sum <= digits_make;
}

void br_joint_look_at(struct br_joint_search *s, size_t window)
{
    s->now = window;
    s->used.count = 0;
    for (size_t i = 0; i < s->all.count; i++)
        if (!br_joint_is_out(s, &s->window[window], i))
            s->used.cell[s->used.count++] = s->all.cell[i];
}

/* Tries orders that change; and beside the best change along each axis, all other laws. */
static void grow_changes(struct br_joint_search *s, size_t from)
{
    grow(s, from, s->smooth, s->options);
    for (int a = 0; a < BR_AXES; a++) {
        size_t best = s->count;
        for (size_t i = from; i < s->count; i++)
            if (s->candidate[i].laws == 1 &&
                br_joint_changes_along(&s->candidate[i].trial.law, a) &&
                (best == s->count || s->candidate[i].log_weight > s->candidate[best].log_weight))
                best = i;
        if (best < s->count) {
            const struct br_joint_candidate c = s->candidate[best];
            extend_by(s, &c, 0, s->options);
        }
    }
}

static void search_window(struct br_joint_search *s, size_t window)
{
    double start[STARTS][BR_UNKNOWNS];
    const size_t from = s->count;
    br_joint_look_at(s, window);
    for (size_t i = 0; i < (s->any_model ? PLAIN : KINDS); i++)
        add_candidate(s, &plain[i], start, starts_of(&s->used, &plain[i], start));
    if (!s->any_model || s->count == from)
        return;
    grow(s, from, 0, s->smooth);
    if (!is_exact(s, &likeliest(s, window)->trial))
        grow_changes(s, from);
    for (int turn = 0; turn < 2; turn++) {
        const struct br_joint_candidate best = *likeliest(s, window);
        if (best.trial.law.of[0] && best.trial.law.of[1])
            extend_by(s, &best, 0, s->smooth);
    }
}

/* The models of the first windows that are not ruled out, fitted to another one. */
static void refit_window(struct br_joint_search *s, size_t window, size_t count)
{
    br_joint_look_at(s, window);
    for (size_t i = 0; i < count; i++) {
        const struct br_joint_candidate *c = &s->candidate[i];
        if (isfinite(c->log_weight) && (c->log_weight > s->best - occam || c->laws == 0) &&
            !is_tried(s, &c->trial.law))
            add_candidate(s, &c->trial.law, (const double(*)[BR_UNKNOWNS]) & c->trial.value, 1);
    }
}

/* So far off, in logarithms, a cell does not show the order. */
static const double far = 0.5;

/* The window without cells that are far off what the others show, at most a quarter of all. */
static void leave_out_far(struct br_joint_search *s)
{
    static const double robust = 0.1;
    double start[STARTS][BR_UNKNOWNS];
    struct br_joint_trial best = {.sum = INFINITY};
    size_t count = 0;
    br_joint_look_at(s, 0);
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
        add_window(s, (struct br_joint_window){.far = true});
}

/* All windows: the first has all cells. */
static void search_all(struct br_joint_search *s)
{
    static const size_t lost[][BR_AXES] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}};
    add_window(s, (struct br_joint_window){0});
    search_window(s, 0);
    if (!s->any_model || s->count == 0)
        return;
    if (likeliest(s, 0)->trial.worst > far / 2)
        leave_out_far(s);
    if (s->windows > 1)
        search_window(s, 1);
    const size_t count = s->count;
    const struct br_joint_window from = s->window[likeliest(s, BR_JOINT_WINDOWS)->window];
    for (size_t w = 0; w < sizeof lost / sizeof *lost; w++)
        if (s->all.sizes[0] > lost[w][0] + 3 && s->all.sizes[1] > lost[w][1] + 3) {
            add_window(s,
                       (struct br_joint_window){.far = from.far, .lost = {lost[w][0], lost[w][1]}});
            refit_window(s, s->windows - 1, count);
        }
}

void br_joint_search(struct br_joint_search *s, const struct br_point *point)
{
    take_cells(s, point);
    take_options(s);
    s->used = s->all;
    s->used.cell = s->all.cell + s->all.count;
    s->rest = s->used.cell + s->all.count;
    search_all(s);
}
