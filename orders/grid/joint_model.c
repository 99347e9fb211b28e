/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/grid/joint_model.h"

#include <math.h>
#include <string.h>

#define OF(axis, what) (BR_OF_AXIS * (axis) + (what))

size_t br_joint_room(size_t count)
{
    return (count + 2 * BR_UNKNOWNS) * (3 * BR_UNKNOWNS + 3);
}

size_t br_joint_unknowns(const struct br_joint_law *law, int unknown[BR_UNKNOWNS])
{
    size_t count = 0;
    for (int a = 0; a < BR_AXES; a++)
        for (int u = BR_LOG_C; u < BR_OF_AXIS && br_joint_has(law->kind, a); u++)
            if (u != BR_SHAPE || law->of[a])
                unknown[count++] = OF(a, u);
    if (law->kind == BR_JOINT_BOTH && law->sum == BR_SUM_ANY)
        unknown[count++] = BR_THETA;
    if (law->floor)
        unknown[count++] = BR_LOG_F;
    return count;
}

/* ---- the model ---- */

/* The logarithm of a correction at x. A next term a z^s of either sign is 1 + (exp(shape) - 1) x^s;
 * of all other laws the shape is the logarithm of the parameter. */
static double bend(const struct br_family *f, double shape, double x, double finest)
{
    if (f->law == BR_LAW_NEXT)
        return log1p(expm1(shape) * pow(x, f->s));
    const struct br_law_place at = {log(x / finest), pow(x / finest, f->s), 1};
    return br_law_bend(f, exp(shape), &at).correction;
}

/* The same, 0 at the coarsest size, so that the constant is that of the error there. */
static double correction(const struct br_family *f, double shape, double x, double finest)
{
    return bend(f, shape, x, finest) - bend(f, shape, 1, finest);
}

double br_joint_bend(const struct br_joint_cells *cells, const struct br_joint_trial *trial,
                     int axis)
{
    const struct br_family *f = trial->law.of[axis];
    return f ? bend(f, trial->value[OF(axis, BR_SHAPE)], 1, cells->finest[axis]) : 0;
}

/* The errors of one axis at all sizes, with their rates. */
static void fill_axis(const struct br_joint_cells *cells, const struct br_joint_law *law,
                      const double v[BR_UNKNOWNS], int axis)
{
    static const double step = 1e-4;
    const struct br_family *f = law->of[axis];
    for (size_t i = 0; i < cells->sizes[axis]; i++) {
        struct br_joint_size *s = &cells->size[axis][i];
        const double shape = v[OF(axis, BR_SHAPE)], finest = cells->finest[axis];
        const bool none = !br_joint_has(law->kind, axis) || s->x == 0;
        const double bend = none || !f ? 0 : correction(f, shape, s->x, finest);
        s->error = none ? 0 : exp(v[OF(axis, BR_LOG_C)] + v[OF(axis, BR_ORDER)] * s->log_x + bend);
        s->rate[BR_LOG_C] = s->error;
        s->rate[BR_ORDER] = none ? 0 : s->error * s->log_x;
        s->rate[BR_SHAPE] = none || !f ? 0
                                       : s->error *
                                             (correction(f, shape + step, s->x, finest) -
                                              correction(f, shape - step, s->x, finest)) /
                                             (2 * step);
    }
}

static double correlation(const struct br_joint_law *law, const double v[BR_UNKNOWNS])
{
    static const double fixed[BR_SUMS] = {[BR_SUM_ADDS] = 1, [BR_SUM_SUBTRACTS] = -1};
    return law->sum == BR_SUM_ANY ? sin(v[BR_THETA]) : fixed[law->sum];
}

/* An order is above zero; beside another error, or with a law, above that of a floor. No error
 * falls by more than this. */
static const double most_order = 30;

static bool allowed(const struct br_joint_law *law, const double v[BR_UNKNOWNS])
{
    const bool alone = law->kind != BR_JOINT_BOTH && !law->of[0] && !law->of[1] && !law->floor;
    const double least = alone ? 0 : br_priors.least_order;
    for (int a = 0; a < BR_AXES; a++) {
        const struct br_family *f = law->of[a];
        const double order = v[OF(a, BR_ORDER)], shape = v[OF(a, BR_SHAPE)];
        if (!br_joint_has(law->kind, a))
            continue;
        if (!(order > least && order < most_order) ||
            (f && f->law != BR_LAW_NEXT && !(shape > log(f->low) && shape < log(f->high))) ||
            (f && !(fabs(shape) < 12)))
            return false;
    }
    return true;
}

/* The residual log(model/error) of a cell, and its rates (NULL: not needed): with m^2 = a^2 + 2 r a
 * b + b^2, m dm = (a + r b) da + (b + r a) db + a b dr, and with a floor f, m + f or sqrt(m^2 +
 * f^2) in place of m. */
static double residual_of(const struct br_joint_cells *cells, const struct br_joint_law *law,
                          const double v[BR_UNKNOWNS], const struct br_joint_cell *c, double *rate)
{
    static const double least = 1e-300;
    const double r = correlation(law, v);
    const double level = law->floor ? exp(v[BR_LOG_F]) : 0;
    const bool offset = law->floor && law->floor->law == BR_LAW_OFFSET;
    const bool adds = offset || (law->floor && law->floor->law == BR_LAW_FLOOR);
    const struct br_joint_size *at[BR_AXES], *ref[BR_AXES];
    double e[BR_AXES];
    for (int a = 0; a < BR_AXES; a++) {
        at[a] = &cells->size[a][c->at[a]];
        ref[a] = &cells->size[a][c->against[a]];
        e[a] = at[a]->error - ref[a]->error;
    }
    const double square_m = e[0] * e[0] + 2 * r * e[0] * e[1] + e[1] * e[1];
    const double m = sqrt(square_m < 0 ? 0 : square_m); /* NaN stays */
    const double all = adds ? m + (offset ? -level : level) : hypot(m, level);
    const double square = adds ? m * all : all * all;
    for (int a = 0; a < BR_AXES && rate; a++)
        for (int u = 0; u < BR_OF_AXIS; u++)
            rate[OF(a, u)] = (e[a] + r * e[1 - a]) / square * (at[a]->rate[u] - ref[a]->rate[u]);
    if (rate) {
        rate[BR_THETA] = e[0] * e[1] / square * cos(v[BR_THETA]);
        rate[BR_LOG_F] = adds ? (offset ? -level : level) / all : level * level / square;
    }
    return log(fabs(all) < least ? least : fabs(all)) - c->log_error;
}

void br_joint_residuals(struct br_joint_cells *cells, const struct br_joint_trial *trial,
                        double *residual)
{
    for (int a = 0; a < BR_AXES; a++)
        fill_axis(cells, &trial->law, trial->value, a);
    for (size_t i = 0; i < cells->count; i++)
        residual[i] = residual_of(cells, &trial->law, trial->value, &cells->cell[i], NULL);
}

double br_joint_change(const struct br_joint_cells *cells, const struct br_joint_trial *trial,
                       int axis)
{
    double most = 0;
    const double shape = trial->value[OF(axis, BR_SHAPE)];
    for (size_t i = 1; i < cells->sizes[axis] && trial->law.of[axis]; i++) {
        const double off = fabs(
            correction(trial->law.of[axis], shape, cells->size[axis][i].x, cells->finest[axis]));
        most = fmax(most, off / (1 + off));
    }
    return most;
}

double br_joint_share(const struct br_joint_cells *cells, int axis)
{
    double most = 0;
    for (size_t i = 0; i < cells->count; i++) {
        double e[BR_AXES];
        for (int a = 0; a < BR_AXES; a++)
            e[a] = fabs(cells->size[a][cells->cell[i].at[a]].error -
                        cells->size[a][cells->cell[i].against[a]].error);
        most = fmax(most, e[axis] / (e[0] + e[1]));
    }
    return most;
}

/* ---- priors ---- */

/* The probability of one power along an axis. With that of lines, 0.45, next terms behind 2 % noise
 * are taken for other orders in 9 % of grids, with this in 3 %. */
static const double one_power = 0.2;

struct normal {
    double mean, deviation;
};

static struct normal prior_of(const struct br_joint_cells *cells, const struct br_joint_law *law,
                              int unknown)
{
    if (unknown == BR_THETA)
        return (struct normal){0, 1};
    if (unknown == BR_LOG_F)
        return (struct normal){cells->lowest - 1.5, 1.5};
    if (unknown % BR_OF_AXIS == BR_LOG_C)
        return (struct normal){0, 5};
    if (unknown % BR_OF_AXIS == BR_ORDER)
        return (struct normal){2, 2};
    const struct br_family *f = law->of[unknown / BR_OF_AXIS];
    return f->law == BR_LAW_NEXT
               ? (struct normal){0, 1.5}
               : (struct normal){log(f->low * f->high) / 2, log(f->high / f->low) / sqrt(12)};
}

double br_joint_log_prior(const struct br_joint_cells *cells, const struct br_joint_trial *trial)
{
    static const double usual_next = 0.3, of_sum[BR_SUMS] = {0.4, 0.3, 0.1, 0.2};
    const struct br_joint_law *law = &trial->law;
    int unknown[BR_UNKNOWNS];
    double sum = law->kind == BR_JOINT_BOTH ? log(of_sum[law->sum] * 2) : 0;
    for (size_t i = br_joint_unknowns(law, unknown); i-- > 0;) {
        const struct normal p = prior_of(cells, law, unknown[i]);
        const double at = (trial->value[unknown[i]] - p.mean) / p.deviation;
        const struct br_family *f = unknown[i] < BR_THETA && unknown[i] % BR_OF_AXIS == BR_SHAPE
                                        ? law->of[unknown[i] / BR_OF_AXIS]
                                        : NULL;
        if (f && f->law == BR_LAW_NEXT) /* heavier tails, and three rows of the table in one */
            sum += log(2.25 * f->prior / M_PI / usual_next) -
                   log1p(pow(trial->value[unknown[i]] / usual_next, 2));
        else
            sum += -at * at / 2 - log(p.deviation * sqrt(2 * M_PI)) + (f ? log(f->prior) : 0);
    }
    for (int a = 0; a < BR_AXES; a++)
        sum += br_joint_has(law->kind, a) && !law->of[a] ? log(one_power) : 0;
    return sum + (law->floor ? log(law->floor->prior) : 0);
}

/* ---- the fit, by Levenberg and Marquardt ---- */

struct system {
    double *residual, *rates;             /* count; count * unknowns */
    double *other_residual, *other_rates; /* of the values before */
    double *a, *b;                        /* with added rows */
    int unknown[BR_UNKNOWNS];
    size_t unknowns;
    double noise; /* of residuals, beside which priors weigh; 0: there are no priors */
    double robust;
};

/* The sum to be made small, at these values; infinite: they are not allowed. */
static double evaluate(struct br_joint_cells *cells, const struct br_joint_law *law,
                       struct system *s, const double v[BR_UNKNOWNS])
{
    double sum = 0, all[BR_UNKNOWNS];
    if (!allowed(law, v) || br_observer_stops(cells->observer))
        return INFINITY;
    for (int a = 0; a < BR_AXES; a++)
        fill_axis(cells, law, v, a);
    for (size_t i = 0; i < cells->count; i++) {
        const struct br_joint_cell *c = &cells->cell[i];
        double r = residual_of(cells, law, v, c, all), scale = sqrt(c->weight);
        if (s->robust > 0) {
            const double off = r / s->robust;
            sum += c->weight * s->robust * s->robust * log1p(off * off);
            scale /= sqrt(1 + off * off);
        } else
            sum += c->weight * r * r;
        s->residual[i] = scale * r;
        for (size_t j = 0; j < s->unknowns; j++)
            s->rates[i * s->unknowns + j] = scale * all[s->unknown[j]];
    }
    for (size_t j = 0; j < s->unknowns && s->noise > 0; j++) {
        const struct normal p = prior_of(cells, law, s->unknown[j]);
        sum += pow(s->noise * (v[s->unknown[j]] - p.mean) / p.deviation, 2);
    }
    return isfinite(sum) ? sum : INFINITY;
}

/* The system of one step, with priors and damping as added rows. Returns the number of rows. */
static size_t make_system(const struct br_joint_cells *cells, const struct br_joint_law *law,
                          struct system *s, const double v[BR_UNKNOWNS],
                          const double scale[BR_UNKNOWNS], double damping)
{
    const size_t n = s->unknowns;
    size_t rows = cells->count;
    memcpy(s->a, s->rates, rows * n * sizeof *s->a);
    for (size_t i = 0; i < rows; i++)
        s->b[i] = -s->residual[i];
    for (size_t j = 0; j < n; j++) {
        const struct normal p = prior_of(cells, law, s->unknown[j]);
        const double row[] = {s->noise / p.deviation, sqrt(damping) * scale[j]},
                     off[] = {row[0] * (p.mean - v[s->unknown[j]]), 0};
        for (int i = 0; i < 2; i++) {
            if (!(row[i] > 0))
                continue;
            memset(&s->a[rows * n], 0, n * sizeof *s->a);
            s->a[rows * n + j] = row[i];
            s->b[rows++] = off[i];
        }
    }
    return rows;
}

static const double least_pivot = 1e-14;

static void swap(double **a, double **b)
{
    double *const other = *a;
    *a = *b;
    *b = other;
}

/* From the values of a trial down to a minimum, until a step gains less than this share of the
 * variance of a residual. */
static void minimise(struct br_joint_cells *cells, struct system *s, struct br_joint_trial *t,
                     double share)
{
    double step[BR_UNKNOWNS], scale[BR_UNKNOWNS] = {0}, damping = 1e-3;
    double now = evaluate(cells, &t->law, s, t->value);
    const size_t n = s->unknowns;
    const double enough = share / (double)cells->count;
    for (int turn = 0, calm = 0; turn < 200 && isfinite(now) && calm < 2 && damping < 1e10;
         turn++) {
        double next[BR_UNKNOWNS], most = 0;
        for (size_t j = 0; j < n; j++) {
            double norm = 0;
            for (size_t i = 0; i < cells->count; i++)
                norm += s->rates[i * n + j] * s->rates[i * n + j];
            scale[j] = fmax(scale[j], sqrt(norm));
        }
        const size_t rows = make_system(cells, &t->law, s, t->value, scale, damping);
        br_least_squares_solve(s->a, s->b, rows, n, least_pivot, step, t->covariance);
        memcpy(next, t->value, sizeof next);
        for (size_t j = 0; j < n; j++) {
            next[s->unknown[j]] += step[j];
            most = fmax(most, fabs(step[j]));
        }
        swap(&s->rates, &s->other_rates);
        swap(&s->residual, &s->other_residual);
        const double then = evaluate(cells, &t->law, s, next);
        if (then <= now) {
            calm = most < 1e-9 || now - then <= enough * now ? calm + 1 : 0;
            memcpy(t->value, next, sizeof next);
            now = then;
            damping = damping > 1e-14 ? damping / 10 : damping;
        } else {
            swap(&s->rates, &s->other_rates);
            swap(&s->residual, &s->other_residual);
            if (most < 1e-10)
                break;
            damping *= 10;
        }
    }
    t->sum = now;
}

/* The sum without priors, the covariance, and what printed digits leave open of the orders: cells
 * of one size may be rounded the same way. */
static void finish(struct br_joint_cells *cells, struct system *s, struct br_joint_trial *t)
{
    const size_t n = s->unknowns;
    if (!isfinite(t->sum) || !isfinite(evaluate(cells, &t->law, s, t->value)))
        return;
    const size_t rows = make_system(cells, &t->law, s, t->value, (double[BR_UNKNOWNS]){0}, 0);
    br_least_squares_solve(s->a, NULL, rows, n, 1e-12, NULL, t->covariance);
    t->sum = t->worst = t->weight = 0;
    for (size_t i = 0; i < cells->count; i++) {
        t->sum += s->residual[i] * s->residual[i];
        t->worst = fmax(t->worst, fabs(s->residual[i]));
        t->weight += cells->cell[i].weight;
    }
    for (int a = 0; a < BR_AXES; a++) {
        size_t order = n;
        double square = 0, xx = 0, x = 0, one = 0;
        for (size_t j = 0; j < n; j++)
            order = s->unknown[j] == OF(a, BR_ORDER) ? j : order;
        for (size_t size = 1; size < cells->sizes[a] && order < n; size++) {
            double sum = 0;
            for (size_t i = 0; i < cells->count; i++) {
                double share = 0;
                for (size_t j = 0; j < n && cells->cell[i].at[a] == size; j++)
                    share += t->covariance[order * n + j] * s->rates[i * n + j];
                sum += fabs(share) * sqrt(cells->cell[i].weight) * cells->cell[i].rounded;
            }
            square += sum * sum;
        }
        t->rounded[a] = sqrt(square);
        for (size_t i = 0; i < cells->count && order < n; i++) {
            const double *rate = &s->rates[i * n + order];
            xx += rate[0] * rate[0], x += rate[0] * rate[-1], one += rate[-1] * rate[-1];
        }
        t->slope[a] = sqrt(1 / (xx - x * x / one));
    }
}

void br_joint_descend(struct br_joint_cells *cells, double robust, struct br_joint_trial *t)
{
    struct system s = {.robust = robust};
    const size_t most = cells->count + 2 * BR_UNKNOWNS;
    s.residual = cells->room;
    s.other_residual = s.residual + most;
    s.b = s.other_residual + most;
    s.rates = s.b + most;
    s.other_rates = s.rates + most * BR_UNKNOWNS;
    s.a = s.other_rates + most * BR_UNKNOWNS;
    s.unknowns = br_joint_unknowns(&t->law, s.unknown);
    s.noise = cells->priors ? 1e-6 : 0;
    minimise(cells, &s, t, cells->priors ? 0.1 : 1e-12);
    if (cells->priors && isfinite(t->sum)) { /* once more, beside the noise that is seen */
        s.noise = fmin(0.3, sqrt(t->sum / (double)cells->count) + 1e-8);
        minimise(cells, &s, t, 1e-3);
    }
    if (robust == 0)
        finish(cells, &s, t);
}

/* ---- starts ---- */

void br_joint_start(const struct br_joint_cells *cells, const double order[BR_AXES], double r,
                    double value[BR_UNKNOWNS])
{
    for (int a = 0; a < BR_AXES; a++) {
        double least = INFINITY; /* at the coarsest size */
        for (size_t i = 0; i < cells->count; i++)
            if (cells->size[a][cells->cell[i].at[a]].x == 1)
                least = fmin(least, cells->cell[i].log_error);
        value[OF(a, BR_LOG_C)] = isfinite(least) ? least : 0;
        value[OF(a, BR_ORDER)] = order[a];
        value[OF(a, BR_SHAPE)] = 0;
    }
    value[BR_THETA] = asin(r);
    value[BR_LOG_F] = cells->lowest - log(2);
}

double br_joint_shape_start(const struct br_family *family)
{
    return family->law == BR_LAW_NEXT        ? 0.3
           : family->law == BR_LAW_LOGARITHM ? log(fmax(4, 1.5 * family->low))
                                             : log(family->low * family->high) / 2;
}
