/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orders of a grid: a mixture of models (joint_model.h), as those of a line (line_order.h).
 * Each axis has a law of the one family; models with more laws are tried only where those with
 * fewer are not ruled out (Occam's window: Madigan and Raftery, Journal of the American Statistical
 * Association 89, 1535-1546, 1994). Each is fitted to all cells, and to windows without cells that
 * are far off, or without the coarsest sizes. With S the sum of squares of n residuals that k
 * unknowns leave, H their curvature with that of the priors, the evidence is (Laplace)
 *     prior Gamma(f/2) (pi S)^(-f/2) det(H)^(-1/2),   f = n - k. */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "orders/grid/joint_model.h"

#define LOG_C(axis) (BR_OF_AXIS * (axis) + BR_LOG_C)
#define ORDER(axis) (BR_OF_AXIS * (axis) + BR_ORDER)
#define SHAPE(axis) (BR_OF_AXIS * (axis) + BR_SHAPE)

bool br_joint_has(enum br_joint_kind kind, int axis)
{
    return kind != (axis == BR_AXIS_SPACE ? BR_JOINT_TIME : BR_JOINT_SPACE);
}

struct br_estimate br_estimate_of(double value, double deviation, size_t freedom)
{
    const double half = freedom > 0 ? gsl_cdf_tdist_Pinv(0.975, (double)freedom) * deviation : NAN;
    return (struct br_estimate){value, value - half, value + half};
}

/* ---- the cells ---- */

enum { MOST_TRIALS = 600, MOST_WINDOWS = 12 };

struct candidate {
    struct br_joint_trial trial;
    double log_weight;             /* of the mixture; -infinite: there is no fit */
    double deviation[BR_UNKNOWNS]; /* of values in m and s */
    double open[BR_AXES];          /* what else is not known of an order, as a scale */
    size_t window, freedom, extras;
    bool widened;
};

struct search {
    struct br_joint_cells all, used; /* all cells; those of a window */
    struct br_joint_cell *room;      /* for so many again, for the jackknife */
    double unit[BR_AXES], log_error; /* of scaled sizes and errors: logarithms in m, s, m^(3/2) */
    bool any_model;
    bool *out[MOST_WINDOWS]; /* what each window leaves out */
    double log_prior[MOST_WINDOWS];
    size_t windows, now;
    bool has_far; /* the second window is that without cells that are far off */
    struct candidate *candidate;
    size_t count;
    double best; /* the largest log_weight */
};

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The different sizes of an axis, ascending, after 0. value: room for two a cell. */
static void take_sizes(struct search *s, const struct br_observation *o, int axis, double *value)
{
    struct br_joint_cells *c = &s->all;
    size_t n = 0;
    for (size_t i = 0; i < c->count; i++) {
        value[n++] = o[i].x[axis];
        value[n++] = o[i].ref[axis];
    }
    qsort(value, n, sizeof *value, by_value);
    const double most = value[n - 1];
    s->unit[axis] = log(most);
    c->size[axis][c->sizes[axis]++].x = 0;
    for (size_t i = 0; i < n; i++)
        if (value[i] / most > c->size[axis][c->sizes[axis] - 1].x) {
            struct br_joint_size *next = &c->size[axis][c->sizes[axis]++];
            next->x = value[i] / most;
            next->log_x = log(next->x);
        }
    c->finest[axis] = 1;
    for (size_t i = 0; i < c->count; i++) {
        c->finest[axis] = fmin(c->finest[axis], o[i].x[axis] / most);
        for (size_t j = 1; j < c->sizes[axis]; j++) {
            if (c->size[axis][j].x == o[i].x[axis] / most)
                c->cell[i].at[axis] = j;
            if (c->size[axis][j].x == o[i].ref[axis] / most)
                c->cell[i].against[axis] = j;
        }
    }
}

static void take_cells(struct search *s, const struct br_observation *o, double *value)
{
    struct br_joint_cells *c = &s->all;
    for (size_t i = 0; i < c->count; i++)
        value[i] = log(o[i].error);
    qsort(value, c->count, sizeof *value, by_value);
    s->log_error = value[c->count / 2];
    c->lowest = value[0] - s->log_error;
    for (size_t i = 0; i < c->count; i++) {
        double copies = 0;
        for (size_t j = 0; j < c->count && s->any_model; j++)
            copies += o[j].error == o[i].error;
        c->cell[i].log_error = log(o[i].error) - s->log_error;
        c->cell[i].weight = s->any_model ? 1 / copies : 1;
        c->cell[i].rounded = o[i].rounding / o[i].error / sqrt(3);
        c->cell[i].from = i;
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

static double weight_of(const struct br_joint_cells *c)
{
    double sum = 0;
    for (size_t i = 0; i < c->count; i++)
        sum += c->cell[i].weight;
    return sum;
}

/* A fit needs more cells than unknowns, and that of an axis more sizes: one that goes through all
 * of them shows nothing. */
static bool enough(const struct search *s, const struct br_joint_law *law)
{
    int unknown[BR_UNKNOWNS];
    const double spare = s->any_model ? 1 : 2, noise = 1e-9;
    bool good = weight_of(&s->used) + noise >= (double)br_joint_unknowns(law, unknown) + spare;
    for (int a = 0; a < BR_AXES; a++)
        good = good && (!br_joint_has(law->kind, a) ||
                        sizes_of(&s->used, a) >= (law->of[a] && s->now > 0 ? 4 : 3));
    return good;
}

/* ---- evidence ---- */

double br_akaike(double sum, size_t count, size_t unknowns)
{
    const double n = (double)count, u = (double)unknowns + 1; /* the variance is an unknown, too */
    if (!(n > u + 1))
        return INFINITY;
    return n * log(fmax(sum, 1e-300) / n) + 2 * u + 2 * u * (u + 1) / (n - u - 1);
}

/* The logarithm of the determinant of a covariance, by Cholesky; NaN: it has none. */
static double log_determinant(const double *covariance, size_t n)
{
    double l[BR_UNKNOWNS][BR_UNKNOWNS], sum = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++) {
            double left = covariance[i * n + j];
            for (size_t k = 0; k < j; k++)
                left -= l[i][k] * l[j][k];
            l[i][j] = i == j ? sqrt(left) : left / l[j][j];
            sum += i == j ? 2 * log(l[i][i]) : 0;
        }
    return sum;
}

static double log_evidence(const struct search *s, const struct candidate *c, size_t unknowns)
{
    const struct br_joint_trial *t = &c->trial;
    double rounded = 0;
    for (size_t i = 0; i < s->used.count; i++)
        rounded += s->used.cell[i].weight * pow(s->used.cell[i].rounded, 2) / t->weight;
    const double f = (double)c->freedom;
    const double squares = t->sum + (pow(br_priors.least_scatter, 2) + rounded) * f;
    return s->log_prior[c->window] + br_joint_log_prior(&s->all, t) + gsl_sf_lngamma(f / 2) -
           f / 2 * log(M_PI * squares) + log_determinant(t->covariance, unknowns) / 2 -
           log1p(sqrt(squares / f) / br_priors.usual_scatter);
}

/* What a known deviation adds to the scale of Student's distribution, so that it widens the 95 %
 * interval as the normal distribution would: the ratio of their quantiles, to 3 %. */
static double of_known(double freedom)
{
    return freedom < 2 ? 0.154 : 1 - 1.1 / freedom;
}

/* The values of a trial in m and s: a constant is that of the power, at a size of one. */
static void in_units(const struct search *s, const struct br_joint_trial *t,
                     double value[BR_UNKNOWNS])
{
    memcpy(value, t->value, sizeof t->value);
    for (int a = 0; a < BR_AXES; a++)
        value[LOG_C(a)] +=
            s->log_error - value[ORDER(a)] * s->unit[a] - br_joint_bend(&s->used, t, a);
    value[BR_LOG_F] += s->log_error;
}

/* Their deviations, and what is not known of an order beside them: a law is truncated, and printed
 * digits are rounded. free: the degrees of freedom. */
static void set_deviations(const struct search *s, struct candidate *c, const int *unknown,
                           size_t unknowns, double free)
{
    const double *covariance = c->trial.covariance, residual = c->trial.sum / free;
    for (size_t i = 0; i < unknowns; i++) {
        const double *row = &covariance[i * unknowns];
        double variance = row[i];
        for (int a = 0; a < BR_AXES; a++) {
            const double unit = s->unit[a], change = br_joint_change(&s->used, &c->trial, a);
            if (unknown[i] == LOG_C(a) && unit != 0)
                variance += unit * unit * row[unknowns + i + 1] - 2 * unit * row[i + 1];
            if (unknown[i] == ORDER(a))
                c->open[a] = hypot(c->trial.slope[a] * (1e-6 + br_priors.truncation * change +
                                                        br_priors.next_term * change * change),
                                   of_known(free) * c->trial.rounded[a]);
        }
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

/* Adds the fit of a law to the window, from the best of these starts. */
static struct candidate *add_candidate(struct search *s, const struct br_joint_law *law,
                                       const double (*start)[BR_UNKNOWNS], size_t starts)
{
    int unknown[BR_UNKNOWNS];
    struct candidate *c = &s->candidate[s->count];
    if (s->count == MOST_TRIALS || !enough(s, law))
        return NULL;
    *c = (struct candidate){.trial = {.sum = INFINITY}, .window = s->now};
    for (size_t i = 0; i < starts; i++) {
        struct br_joint_trial t = {.law = *law, .sum = INFINITY};
        memcpy(t.value, start[i], sizeof t.value);
        br_joint_descend(&s->used, 0, &t);
        if (t.sum < c->trial.sum)
            c->trial = t;
    }
    if (!isfinite(c->trial.sum) || ends_at_a_floor(&c->trial))
        return NULL;
    const size_t unknowns = br_joint_unknowns(law, unknown);
    const double free = c->trial.weight - (double)unknowns;
    c->freedom = free >= 1 ? (size_t)(free + 1e-9) : 1;
    set_deviations(s, c, unknown, unknowns, free);
    c->extras = (size_t)((law->of[0] != NULL) + (law->of[1] != NULL) + (law->floor != NULL));
    c->log_weight = s->any_model ? log_evidence(s, c, unknowns)
                                 : -br_akaike(c->trial.sum, s->used.count, unknowns) / 2;
    if (!isfinite(c->log_weight))
        return NULL;
    s->best = fmax(s->best, c->log_weight);
    s->count++;
    return c;
}

/* ---- the search ---- */

static const double orders[][BR_AXES] = {{1, 1}, {2, 1}, {4, 1}, {1, 4}, {4, 4}},
                    correlations[] = {0, -0.9, 0.9};
enum { STARTS = 15 };

static const struct br_joint_law plain[] = {
    {.kind = BR_JOINT_BOTH, .sum = BR_SUM_ANY},
    {.kind = BR_JOINT_TIME},
    {.kind = BR_JOINT_SPACE},
    {.kind = BR_JOINT_BOTH, .sum = BR_SUM_ADDS},
    {.kind = BR_JOINT_BOTH, .sum = BR_SUM_SUBTRACTS},
};
enum { PLAIN = sizeof plain / sizeof *plain, KINDS = BR_JOINT_SPACE + 1 };

/* The starts of one power: the sum of squares has local minima in r and p. */
static size_t starts_of(const struct br_joint_cells *cells, const struct br_joint_law *law,
                        double (*start)[BR_UNKNOWNS])
{
    size_t count = 0;
    const size_t turns = law->kind == BR_JOINT_BOTH && law->sum == BR_SUM_ANY ? 3 : 1;
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++)
        for (size_t j = 0; j < turns; j++)
            br_joint_start(cells, orders[i], correlations[j], start[count++]);
    return count;
}

static bool same_law(const struct br_joint_law *a, const struct br_joint_law *b)
{
    return a->kind == b->kind && a->sum == b->sum && a->of[0] == b->of[0] && a->of[1] == b->of[1] &&
           a->floor == b->floor;
}

/* Starts from those of a candidate with a law of these axes: a small next term, or one that is
 * larger than the first, so that a lower order comes up. */
static void extend(struct search *s, const struct candidate *from, struct br_joint_law law,
                   const struct br_family *family, int first, int last)
{
    double start[2][BR_UNKNOWNS];
    for (int a = first; a <= last; a++)
        law.of[a] = family;
    for (size_t i = 0; i < s->count; i++)
        if (s->candidate[i].window == s->now && same_law(&s->candidate[i].trial.law, &law))
            return;
    for (int i = 0; i < 2; i++) {
        memcpy(start[i], from->trial.value, sizeof *start);
        for (int a = first; a <= last; a++) {
            start[i][SHAPE(a)] = i ? 1.5 : br_joint_shape_start(family);
            start[i][ORDER(a)] = fmax(0.3, start[i][ORDER(a)] - 0.5 * i * family->s);
        }
    }
    add_candidate(s, &law, start, first <= last && family->law == BR_LAW_NEXT ? 2 : 1);
}

static bool is_of_axis(const struct br_family *f)
{
    return f->curve == 0 &&
           (f->law == BR_LAW_NEXT                                    ? f->prior > 0.015
            : f->law == BR_LAW_SQUARES || f->law == BR_LAW_LOGARITHM ? f->prior >= 0.005
                                                                     : false);
}

static bool is_floor(const struct br_family *f)
{
    return f->curve == 0 &&
           (f->law == BR_LAW_FLOOR || f->law == BR_LAW_FLOOR_SQUARES || f->law == BR_LAW_OFFSET);
}

/* Models that are less probable than the best one by more than this logarithm are not extended, nor
 * those with a law that are less probable than one without any (Occam's window). Of one power, all
 * that may be are. */
static const double occam = 5, all_plain = 15;

static void extend_all(struct search *s, size_t extras)
{
    double least = s->best - all_plain;
    for (size_t i = 0; i < s->count && extras > 0; i++)
        if (s->candidate[i].window == s->now && s->candidate[i].extras == 0)
            least = fmax(fmax(least, s->best - occam), s->candidate[i].log_weight);
    for (size_t i = 0, end = s->count; i < end; i++) {
        const struct candidate from = s->candidate[i];
        if (from.window != s->now || from.extras != extras || from.log_weight < least)
            continue;
        for (const struct br_family *f = br_families; f < br_families + BR_FAMILIES; f++) {
            struct br_joint_law law = from.trial.law;
            for (int a = 0; a < BR_AXES && is_of_axis(f); a++)
                if (br_joint_has(law.kind, a) && !law.of[a])
                    extend(s, &from, law, f, a, a);
            if (extras == 0 && is_of_axis(f) && f->law == BR_LAW_NEXT && law.kind == BR_JOINT_BOTH)
                extend(s, &from, law, f, 0, 1);
            if (is_floor(f) && !law.floor) {
                law.floor = f;
                extend(s, &from, law, f, 1, 0);
            }
        }
    }
}

/* Goes to a window: its cells are used from here on. */
static void look_at(struct search *s, size_t window)
{
    s->now = window;
    s->used.count = 0;
    for (size_t i = 0; i < s->all.count; i++)
        if (!s->out[window][i])
            s->used.cell[s->used.count++] = s->all.cell[i];
}

/* Of the best model of a window whose axes both have laws: each other law of each axis, beside the
 * law of the other axis. */
static void exchange(struct search *s)
{
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct candidate *best = NULL;
        for (size_t i = 0; i < s->count; i++) {
            const struct candidate *c = &s->candidate[i];
            if (c->window == s->now && (!best || c->log_weight > best->log_weight))
                best = c;
        }
        if (!best || !best->trial.law.of[0] || !best->trial.law.of[1])
            return;
        const struct candidate from = *best;
        for (const struct br_family *f = br_families; f < br_families + BR_FAMILIES; f++) {
            struct br_joint_law law = from.trial.law;
            if (is_of_axis(f))
                extend(s, &from, law, f, axis, axis);
        }
    }
}

static void search_window(struct search *s, size_t window)
{
    double start[STARTS][BR_UNKNOWNS];
    look_at(s, window);
    for (size_t i = 0; i < (s->any_model ? PLAIN : KINDS); i++)
        add_candidate(s, &plain[i], start, starts_of(&s->used, &plain[i], start));
    for (size_t extras = 0; extras < 2 && s->any_model; extras++)
        extend_all(s, extras);
    for (int turn = 0; turn < 2 && s->any_model; turn++)
        exchange(s);
}

/* The models of the first windows that are not ruled out, fitted to another one. */
static void refit_window(struct search *s, size_t window, size_t count)
{
    look_at(s, window);
    for (size_t i = 0; i < count; i++) {
        const struct candidate *from = &s->candidate[i];
        bool known = !(from->log_weight > s->best - occam || from->extras == 0);
        for (size_t j = count; j < s->count && !known; j++)
            known = s->candidate[j].window == window &&
                    same_law(&s->candidate[j].trial.law, &from->trial.law);
        if (!known)
            add_candidate(s, &from->trial.law, (const double(*)[BR_UNKNOWNS]) & from->trial.value,
                          1);
    }
}

/* ---- windows ---- */

/* The prior of the cells that are out; of a size as a whole: it counts once. */
static void close_window(struct search *s, double share)
{
    double sum = log(share);
    size_t out = 0;
    for (size_t i = 0; i < s->all.count; i++)
        if (s->out[s->windows][i]) {
            sum += s->all.cell[i].weight * log(br_priors.unexplained);
            out++;
        }
    s->log_prior[s->windows] = sum;
    s->windows += out > 0 || s->windows == 0;
}

static bool *open_window(struct search *s)
{
    memset(s->out[s->windows], 0, s->all.count * sizeof *s->out[0]);
    return s->out[s->windows];
}

static const struct candidate *likeliest(const struct search *s)
{
    size_t best = 0;
    for (size_t i = 1; i < s->count; i++)
        best = s->candidate[i].log_weight > s->candidate[best].log_weight ? i : best;
    return &s->candidate[best];
}

/* So far off, in logarithms, a cell does not show the order. */
static const double far = 0.5;

/* The window without cells that are far off what the others show, at most a quarter of all. */
static void leave_out_far(struct search *s, double *room)
{
    static const double robust = 0.1;
    double start[STARTS][BR_UNKNOWNS];
    struct br_joint_trial best = {.sum = INFINITY};
    look_at(s, 0);
    for (size_t i = 0; i < KINDS; i++)
        for (size_t j = enough(s, &plain[i]) ? starts_of(&s->used, &plain[i], start) : 0;
             j-- > 0;) {
            struct br_joint_trial t = {.law = plain[i], .sum = INFINITY};
            memcpy(t.value, start[j], sizeof t.value);
            for (double scale = 10 * robust; scale >= robust; scale /= 3)
                br_joint_descend(&s->used, scale, &t);
            if (t.sum < best.sum)
                best = t;
        }
    if (!isfinite(best.sum))
        return;
    br_joint_residuals(&s->used, &best, room);
    bool *out = open_window(s);
    size_t count = 0;
    for (size_t i = 0; i < s->all.count; i++)
        count += out[i] = fabs(room[i]) > far;
    if (count > 0 && 4 * count <= s->all.count)
        close_window(s, pow(br_priors.leaves_inside, (double)count));
}

/* Windows without the coarsest sizes of one axis or of both, of those that window `from` has. */
static void leave_out_coarse(struct search *s, size_t from)
{
    static const int lost[][BR_AXES] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}};
    for (size_t w = 0; w < sizeof lost / sizeof *lost && s->windows < MOST_WINDOWS; w++) {
        bool *out = open_window(s), fits = true;
        for (int a = 0; a < BR_AXES; a++) {
            size_t coarsest = 0;
            for (size_t i = 0; i < s->all.count; i++)
                coarsest = s->all.cell[i].at[a] > coarsest ? s->all.cell[i].at[a] : coarsest;
            fits = fits && coarsest >= (size_t)lost[w][a] + 3;
            for (size_t i = 0; i < s->all.count; i++)
                out[i] |= s->out[from][i] || s->all.cell[i].at[a] + (size_t)lost[w][a] > coarsest;
        }
        if (fits)
            close_window(s, pow(br_priors.leaves_coarse, lost[w][0] + lost[w][1]));
    }
}

static void search_all(struct search *s, double *room)
{
    open_window(s);
    close_window(s, 1);
    search_window(s, 0);
    if (!s->any_model || s->count == 0)
        return;
    if (likeliest(s)->trial.worst > far / 2)
        leave_out_far(s, room);
    s->has_far = s->windows > 1;
    if (s->has_far)
        search_window(s, 1);
    const size_t first = s->windows, count = s->count;
    leave_out_coarse(s, likeliest(s)->window);
    for (size_t w = first; w < s->windows; w++)
        refit_window(s, w, count);
}

/* ---- intervals ---- */

/* How far neighbours along h and along k have residuals of one sign: the sum of their products, in
 * standard deviations of that of independent ones. A wrong model leaves waves, noise does not. */
static double structure_of(const struct br_joint_cells *cells, const double *residual)
{
    double products = 0, pairs = 0, squares = 0;
    for (const struct br_joint_cell *at = cells->cell; at < cells->cell + cells->count; at++) {
        squares += pow(residual[at - cells->cell], 2) / (double)cells->count;
        for (int a = 0; a < BR_AXES; a++) {
            const struct br_joint_cell *next = NULL;
            for (const struct br_joint_cell *o = cells->cell; o < cells->cell + cells->count; o++)
                if (o->at[1 - a] == at->at[1 - a] && o->at[a] < at->at[a] &&
                    (!next || o->at[a] > next->at[a]))
                    next = o;
            if (!next)
                continue;
            products += residual[at - cells->cell] * residual[next - cells->cell];
            pairs++;
        }
    }
    return pairs > 0 && squares > 0 ? products / squares / sqrt(pairs) : 0;
}

/* Residuals with less structure than this are as independent as noise is. */
static const double waves = 0.7;

/* Residuals below this do not scatter. */
static const double exact = 1e-4;

/* Cells that share h or k are not independent: the residuals are deterministic. So the intervals
 * come from leaving out one whole line of the grid after the other (delete-a-group jackknife, Efron
 * 1982), where they are wider. */
static void widen_along(struct search *s, struct candidate *c, int axis)
{
    int unknown[BR_UNKNOWNS];
    double sum[BR_UNKNOWNS] = {0}, squares[BR_UNKNOWNS] = {0}, groups = 0, whole[BR_UNKNOWNS];
    in_units(s, &c->trial, whole);
    const size_t unknowns = br_joint_unknowns(&c->trial.law, unknown);
    struct br_joint_cells rest = s->used;
    rest.cell = s->room;
    for (size_t size = 1; size < s->used.sizes[axis]; size++) {
        rest.count = 0;
        for (size_t i = 0; i < s->used.count; i++)
            if (s->used.cell[i].at[axis] != size)
                rest.cell[rest.count++] = s->used.cell[i];
        if (rest.count == s->used.count)
            continue;
        struct br_joint_trial without = c->trial;
        without.sum = INFINITY;
        if (rest.count > unknowns)
            br_joint_descend(&rest, 0, &without);
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
        gsl_cdf_tdist_Pinv(0.975, groups - 1) / gsl_cdf_tdist_Pinv(0.975, (double)c->freedom);
    for (size_t i = 0; i < unknowns; i++) {
        const double spread = squares[i] - sum[i] * sum[i] / groups;
        const double deviation = sqrt((groups - 1) / groups * fmax(0, spread)) * quantiles;
        if (!(deviation <= c->deviation[unknown[i]])) /* NaN: a refit failed */
            c->deviation[unknown[i]] = isfinite(spread) ? deviation : INFINITY;
    }
}

static void widen(struct search *s, struct candidate *c, double *room)
{
    if (c->widened)
        return;
    look_at(s, c->window);
    br_joint_residuals(&s->used, &c->trial, room);
    const bool bent = c->trial.law.of[0] || c->trial.law.of[1];
    const bool noise = c->trial.sum > exact * exact * c->trial.weight;
    if (s->any_model && (noise || !bent) && structure_of(&s->used, room) < waves)
        return;
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(c->trial.law.kind, a))
            widen_along(s, c, a);
    c->widened = true;
}

static const double most_scatter = 0.3, most_structure = 1;

/* r with its interval by the slope of the sine, within [-1, 1]. */
static struct br_estimate correlation(const struct candidate *c, double theta)
{
    static const double fixed[BR_SUMS] = {[BR_SUM_ADDS] = 1, [BR_SUM_SUBTRACTS] = -1};
    const double r = fixed[c->trial.law.sum];
    if (c->trial.law.kind != BR_JOINT_BOTH)
        return (struct br_estimate){NAN, NAN, NAN};
    if (c->trial.law.sum != BR_SUM_ANY)
        return (struct br_estimate){r, r, r};
    struct br_estimate e =
        br_estimate_of(sin(theta), fabs(cos(theta)) * c->deviation[BR_THETA], c->freedom);
    e.low = e.low < -1 ? -1 : e.low; /* NaN stays */
    e.high = e.high > 1 ? 1 : e.high;
    return e;
}

/* A mean square below this is that of round-off. */
static const double round_off = 1e-24;

/* What one model makes of the errors, in m and s. */
static void describe(struct search *s, const struct candidate *c, double *room,
                     struct br_joint_fit *fit)
{
    const struct br_joint_trial *t = &c->trial;
    double mean = 0, total = 0, value[BR_UNKNOWNS];
    in_units(s, t, value);
    look_at(s, c->window);
    *fit = (struct br_joint_fit){.kind = t->law.kind,
                                 .converged = true,
                                 .points = s->used.count,
                                 .left_out = s->all.count - s->used.count,
                                 .freedom = c->freedom,
                                 .worst = t->worst,
                                 .misfit =
                                     round_off < t->sum / t->weight ? sqrt(t->sum / t->weight) : 0,
                                 .r = correlation(c, value[BR_THETA]),
                                 .floor = t->law.floor ? exp(value[BR_LOG_F]) : (double)NAN};
    br_joint_residuals(&s->used, t, room);
    for (int a = 0; a < BR_AXES; a++) {
        const bool has = br_joint_has(t->law.kind, a);
        fit->share[a] = br_joint_share(&s->used, a);
        const double none = has ? 0 : NAN;
        const struct br_estimate log_c =
            br_estimate_of(value[LOG_C(a)] + none, c->deviation[LOG_C(a)], c->freedom);
        fit->c[a] = (struct br_estimate){exp(log_c.value), exp(log_c.low), exp(log_c.high)};
        if (t->law.of[a]) /* its deviation is that of the error at the coarsest size */
            fit->c[a].low = fit->c[a].high = NAN;
        fit->order[a] = br_estimate_of(value[ORDER(a)] + none, c->deviation[ORDER(a)], c->freedom);
        fit->low99[a] = fit->order[a].low;
        fit->high99[a] = fit->order[a].high;
        fit->law[a] = has && t->law.of[a] ? br_law_text(t->law.of[a]->law) : NULL;
    }
    for (size_t i = 0; i < s->used.count; i++)
        mean += s->used.cell[i].log_error / (double)s->used.count;
    for (size_t i = 0; i < s->used.count; i++)
        total += pow(s->used.cell[i].log_error - mean, 2);
    fit->r_squared = total > 0 ? 1 - t->sum / total : NAN;
    fit->scatters = s->any_model && fit->misfit <= most_scatter &&
                    structure_of(&s->used, room) <= most_structure;
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

/* ---- one model, or the mixture ---- */

static int by_weight(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;
    return (x->log_weight < y->log_weight) - (x->log_weight > y->log_weight);
}

/* Whether all orders of the model are determined. */
static bool all_determined(const struct br_joint_fit *fit)
{
    bool determined = true;
    for (int a = 0; a < BR_AXES; a++)
        determined &= !br_joint_has(fit->kind, a) || br_order_determined(&fit->order[a]);
    return determined;
}

static bool one_determined(const struct br_joint_fit *fit)
{
    return br_order_determined(&fit->order[0]) || br_order_determined(&fit->order[1]);
}

/* The best model whose orders are determined; else that of both errors, if one of them is. */
static void take_one(struct search *s, double *room, struct br_joint_fit *fit)
{
    struct br_joint_fit one;
    for (size_t i = 0; i < s->count && !fit->converged; i++) {
        describe(s, &s->candidate[i], room, &one);
        if (!all_determined(&one))
            continue;
        widen(s, &s->candidate[i], room);
        describe(s, &s->candidate[i], room, &one);
        *fit = all_determined(&one) ? one : *fit;
    }
    for (size_t i = 0; i < s->count && !br_joint_describes(fit); i++) {
        if (s->candidate[i].trial.law.kind != BR_JOINT_BOTH)
            continue;
        widen(s, &s->candidate[i], room);
        describe(s, &s->candidate[i], room, &one);
        if (br_joint_describes(&one) && one_determined(&one))
            *fit = one;
        return;
    }
}

static double scale_of(const struct candidate *c, int axis)
{
    return hypot(c->deviation[ORDER(axis)], c->open[axis]);
}

/* The order of an axis below which this share of the mixture is. */
static double quantile(const struct search *s, int axis, double all, double share)
{
    double low = -60, high = 60;
    for (int turn = 0; turn < 60 && high - low > 1e-12; turn++) {
        const double at = (low + high) / 2;
        double below = 0;
        for (size_t i = 0; i < s->count; i++) {
            const struct candidate *c = &s->candidate[i];
            const double scale = scale_of(c, axis), off = at - c->trial.value[ORDER(axis)];
            if (br_joint_has(c->trial.law.kind, axis))
                below += c->log_weight *
                         (isfinite(scale) ? gsl_cdf_tdist_P(off / scale, (double)c->freedom) : 0.5);
        }
        *(below < share * all ? &low : &high) = at;
    }
    return (low + high) / 2;
}

/* Models of less weight than this are not kept, and of less than that not widened. */
static const double kept = 8.5, widened = 0.02;

/* The mixture: from logarithms to weights of sum 1. An axis whose error most of the weight does not
 * see has no order. */
static void take_mixture(struct search *s, double *room, struct br_joint_fit *fit)
{
    double sum = 0, sees[BR_AXES] = {0};
    for (size_t i = 0; i < s->count; i++) {
        s->count = s->candidate[i].log_weight < s->best - kept ? i : s->count;
        sum += i < s->count ? exp(s->candidate[i].log_weight - s->best) : 0;
    }
    for (size_t i = 0; i < s->count; i++) {
        struct candidate *c = &s->candidate[i];
        c->log_weight = exp(c->log_weight - s->best) / sum;
        if (c->log_weight > widened)
            widen(s, c, room);
        for (int a = 0; a < BR_AXES; a++)
            sees[a] += br_joint_has(c->trial.law.kind, a) ? c->log_weight : 0;
    }
    const enum br_joint_kind kind = sees[BR_AXIS_SPACE] < 0.5  ? BR_JOINT_TIME
                                    : sees[BR_AXIS_TIME] < 0.5 ? BR_JOINT_SPACE
                                                               : BR_JOINT_BOTH;
    size_t likely = 0;
    while (likely + 1 < s->count && s->candidate[likely].trial.law.kind != kind)
        likely++;
    describe(s, &s->candidate[likely], room, fit);
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
    const size_t window = s->count ? s->candidate[0].window : 0;
    for (size_t i = 0; i < s->all.count; i++)
        observation[i].flag = !s->out[window][i]           ? BR_FLAG_NONE
                              : s->has_far && s->out[1][i] ? BR_FLAG_OUTLIER
                                                           : BR_FLAG_COARSE;
}

/* All memory of a search of so many cells; false: there is none. */
static bool make_room(struct search *s, size_t count)
{
    s->all.cell = br_allocate(3 * count + 1, sizeof *s->all.cell);
    s->all.size[0] = br_allocate(4 * count + 4, sizeof *s->all.size[0]);
    s->all.room = br_allocate(br_joint_room(count) + 2 * count, sizeof *s->all.room);
    s->out[0] = br_allocate(MOST_WINDOWS * count + 1, sizeof *s->out[0]);
    s->candidate = br_allocate(MOST_TRIALS, sizeof *s->candidate);
    if (!s->all.cell || !s->all.size[0] || !s->all.room || !s->out[0] || !s->candidate)
        return false;
    for (size_t i = 1; i < MOST_WINDOWS; i++)
        s->out[i] = s->out[0] + i * count;
    s->all.size[1] = s->all.size[0] + 2 * count + 2;
    s->used = s->all;
    s->used.cell = s->all.cell + count;
    s->room = s->used.cell + count;
    return true;
}

enum br_status br_joint_fit_solve(struct br_observation *observation, size_t count, bool any_model,
                                  const struct br_observer *observer, struct br_joint_fit *fit,
                                  struct br_error *err)
{
    struct search s = {.any_model = any_model, .best = -INFINITY};
    *fit = nothing_fitted(count);
    s.all.count = count;
    s.all.priors = any_model;
    s.all.observer = observer;
    enum br_status status = make_room(&s, count) ? BR_OK : br_no_memory(err, "the fits");
    if (!status && count > 0) {
        double *room = s.all.room + br_joint_room(count);
        take_cells(&s, observation, room);
        struct br_joint_cell *const own = s.used.cell;
        s.used = s.all;
        s.used.cell = own;
        search_all(&s, room);
        qsort(s.candidate, s.count, sizeof *s.candidate, by_weight);
        if (s.count && any_model)
            take_mixture(&s, room, fit);
        else
            take_one(&s, room, fit);
        if (!one_determined(fit))
            *fit = nothing_fitted(count);
        flag_cells(&s, observation);
    }
    free(s.all.cell);
    free(s.all.size[0]);
    free(s.all.room);
    free(s.out[0]);
    free(s.candidate);
    if (!status && br_observer_stops(observer))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    return status;
}

bool br_joint_describes(const struct br_joint_fit *fit)
{
    return fit->converged && (fit->misfit <= 0.02 || fit->scatters);
}
