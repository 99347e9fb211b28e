/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/grid/joint_model.h"

#include <math.h>
#include <string.h>

bool br_joint_has(enum br_joint_kind kind, int axis)
{
    return kind != (axis == BR_AXIS_SPACE ? BR_JOINT_TIME : BR_JOINT_SPACE);
}

static bool has_unknown(const struct br_family *f, int unknown)
{
    return unknown <= BR_ORDER ||
           (f && (unknown == BR_SHAPE || (f->law == BR_LAW_KINK && f->low < f->high)));
}

size_t br_joint_unknowns(const struct br_joint_law *law, int unknown[BR_UNKNOWNS])
{
    size_t count = 0;
    for (int a = 0; a < BR_AXES; a++)
        for (int u = 0; u < BR_OF_AXIS && br_joint_has(law->kind, a); u++)
            if (has_unknown(law->of[a], u))
                unknown[count++] = BR_OF(a, u);
    if (law->kind == BR_JOINT_BOTH && law->sum == BR_SUM_ANY)
        unknown[count++] = BR_THETA;
    if (law->floor)
        unknown[count++] = BR_LOG_F;
    return count;
}

size_t br_joint_sizes(const struct br_joint_cells *c, int axis)
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

/* ---- the model ---- */

/* The logarithm of the correction by a law at a size, v: the unknowns of the axis. */
static double bend(const struct br_family *f, const double v[BR_OF_AXIS], double log_x,
                   double log_finest)
{
    const double log_z = log_x - log_finest;
    if (f->law == BR_LAW_NEXT)
        return log1p(expm1(v[BR_SHAPE]) * exp(f->s * log_x));
    if (f->law == BR_LAW_KINK)
        return v[BR_SHAPE] * fmax(0, log_x - v[BR_PLACE]);
    const struct br_law_place at = {.log_z = log_z, .power = exp(f->s * log_z), .finest = 1};
    return br_law_bend(f, exp(v[BR_SHAPE]), &at).correction;
}

/* The errors of one axis at all sizes, with their rates. */
static void fill_axis(const struct br_joint_cells *cells, const struct br_joint_law *law,
                      const double value[BR_UNKNOWNS], int axis)
{
    static const double step = 1e-4;
    const struct br_family *f = law->of[axis];
    const double *v = &value[BR_OF(axis, 0)], finest = cells->log_finest[axis];
    const double coarsest = f ? bend(f, v, 0, finest) : 0;
    double up[BR_OF_AXIS], down[BR_OF_AXIS];
    for (struct br_joint_size *s = cells->size[axis]; s < cells->size[axis] + cells->sizes[axis];
         s++) {
        const bool none = !br_joint_has(law->kind, axis) || s->x == 0;
        const double more = none || !f ? 0 : bend(f, v, s->log_x, finest) - coarsest;
        s->error = none ? 0 : exp(v[BR_LOG_C] + v[BR_ORDER] * s->log_x + more);
        s->rate[BR_LOG_C] = s->error;
        s->rate[BR_ORDER] = none ? 0 : s->error * s->log_x;
        for (int u = BR_SHAPE; u < BR_OF_AXIS; u++) {
            s->rate[u] = 0;
            if (none || !f || !has_unknown(f, u))
                continue;
            memcpy(up, v, sizeof up);
            memcpy(down, v, sizeof down);
            up[u] += step;
            down[u] -= step;
            s->rate[u] = s->error / (2 * step) *
                         (bend(f, up, s->log_x, finest) - bend(f, up, 0, finest) -
                          bend(f, down, s->log_x, finest) + bend(f, down, 0, finest));
        }
    }
}

/* An order is above zero; beside another error, or with a law, above that of a floor. No error
 * falls by more than this. */
static const double most_order = 30;

static bool allowed(const struct br_joint_law *law, const double value[BR_UNKNOWNS])
{
    const bool alone = law->kind != BR_JOINT_BOTH && !law->of[0] && !law->of[1] && !law->floor;
    const double least = alone ? 0 : br_priors.least_order;
    for (int a = 0; a < BR_AXES; a++) {
        const struct br_family *f = law->of[a];
        const double *v = &value[BR_OF(a, 0)], shape = f ? v[BR_SHAPE] : 0;
        if (!br_joint_has(law->kind, a))
            continue;
        if (!(v[BR_ORDER] > least && v[BR_ORDER] < most_order && fabs(shape) < 12))
            return false;
        if (f && f->law == BR_LAW_KINK   ? !(v[BR_ORDER] + shape > least)
            : f && f->law != BR_LAW_NEXT ? !(shape > log(f->low) && shape < log(f->high))
                                         : false)
            return false;
    }
    return true;
}

/* How the errors of both axes make one: r, its rate by theta, and the floor. */
struct mixing {
    double r, rate, floor;
    bool adds; /* a floor below 0: an offset */
};

static struct mixing mixing_of(const struct br_joint_law *law, const double v[BR_UNKNOWNS])
{
    static const double fixed[BR_SUMS] = {[BR_SUM_ADDS] = 1, [BR_SUM_SUBTRACTS] = -1};
    const bool any = law->sum == BR_SUM_ANY;
    const double level = law->floor ? exp(v[BR_LOG_F]) : 0;
    return (struct mixing){.r = any ? sin(v[BR_THETA]) : fixed[law->sum],
                           .rate = any ? cos(v[BR_THETA]) : 0,
                           .floor = law->floor && law->floor->law == BR_LAW_OFFSET ? -level : level,
                           .adds = law->floor && law->floor->law != BR_LAW_FLOOR_SQUARES};
}

/* The residual log(model/error) of a cell, and its rates (NULL: not needed): with m^2 = a^2 + 2 r a
 * b + b^2, m dm = (a + r b) da + (b + r a) db + a b dr, and with a floor f, m + f or sqrt(m^2 +
 * f^2) in place of m. */
static double residual_of(const struct br_joint_cells *cells, const struct mixing *mix,
                          const struct br_joint_cell *c, double *rate)
{
    static const double least = 1e-300;
    const double r = mix->r, level = mix->floor;
    const struct br_joint_size *at[BR_AXES], *ref[BR_AXES];
    double e[BR_AXES];
    for (int a = 0; a < BR_AXES; a++) {
        at[a] = &cells->size[a][c->at[a]];
        ref[a] = &cells->size[a][c->against[a]];
        e[a] = at[a]->error - ref[a]->error;
    }
    const double square_m = e[0] * e[0] + 2 * r * e[0] * e[1] + e[1] * e[1];
    const double m = sqrt(square_m < 0 ? 0 : square_m); /* NaN stays */
    const double all = mix->adds ? m + level : level != 0 ? sqrt(m * m + level * level) : m;
    const double square = mix->adds ? m * all : all * all;
    if (rate) {
        for (int a = 0; a < BR_AXES; a++) {
            const double factor = (e[a] + r * e[1 - a]) / square;
            for (int u = 0; u < BR_OF_AXIS; u++)
                rate[BR_OF(a, u)] = factor * (at[a]->rate[u] - ref[a]->rate[u]);
        }
        rate[BR_THETA] = e[0] * e[1] / square * mix->rate;
        rate[BR_LOG_F] = mix->adds ? level / all : level * level / square;
    }
    return log(fabs(all) < least ? least : fabs(all)) - c->log_error;
}

void br_joint_residuals(struct br_joint_cells *cells, const struct br_joint_trial *trial,
                        double *residual)
{
    const struct mixing mix = mixing_of(&trial->law, trial->value);
    for (int a = 0; a < BR_AXES; a++)
        fill_axis(cells, &trial->law, trial->value, a);
    for (size_t i = 0; i < cells->count; i++)
        residual[i] = residual_of(cells, &mix, &cells->cell[i], NULL);
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

/* Three sizes distinguish no law from another: each leads through them. Then each has the prior of
 * a usual one. */
static const double usual = 0.1;
enum { ALIKE = 3 };

struct normal {
    double mean, deviation;
};

/* The normal distribution that is as wide as an even one. */
static struct normal even(double low, double high)
{
    return (struct normal){(low + high) / 2, (high - low) / sqrt(12)};
}

static struct normal prior_of(const struct br_joint_cells *cells, const struct br_joint_law *law,
                              int unknown)
{
    const struct br_family *f = unknown < BR_THETA ? law->of[unknown / BR_OF_AXIS] : NULL;
    if (unknown == BR_THETA)
        return (struct normal){0, 1};
    if (unknown == BR_LOG_F)
        return (struct normal){cells->lowest - 1.5, 1.5};
    switch (unknown % BR_OF_AXIS) {
    case BR_LOG_C:
        return (struct normal){0, 5};
    case BR_ORDER:
        return (struct normal){2, 2};
    case BR_PLACE:
        return even(f->low, f->high);
    default:
        return f->law == BR_LAW_NEXT || f->law == BR_LAW_KINK ? (struct normal){0, 1.5}
                                                              : even(log(f->low), log(f->high));
    }
}

static bool alike(const struct br_joint_cells *cells, int unknown)
{
    return br_joint_sizes(cells, unknown / BR_OF_AXIS) <= ALIKE;
}

double br_joint_log_prior(const struct br_joint_cells *cells, const struct br_joint_trial *trial)
{
    static const double usual_next = 0.3, of_sum[BR_SUMS] = {0.4, 0.3, 0.1};
    const struct br_joint_law *law = &trial->law;
    int unknown[BR_UNKNOWNS];
    double sum = law->kind == BR_JOINT_BOTH ? log(of_sum[law->sum] * 2) : 0;
    for (size_t i = br_joint_unknowns(law, unknown); i-- > 0;) {
        const struct normal p = prior_of(cells, law, unknown[i]);
        const double value = trial->value[unknown[i]], at = (value - p.mean) / p.deviation;
        const bool is_shape = unknown[i] < BR_THETA && unknown[i] % BR_OF_AXIS == BR_SHAPE;
        const struct br_family *f = is_shape ? law->of[unknown[i] / BR_OF_AXIS] : NULL;
        if (f && f->law == BR_LAW_NEXT) /* heavier tails, and three rows of the table in one */
            sum += log(2.25 * f->prior / M_PI / usual_next) - log1p(pow(value / usual_next, 2));
        else
            sum += -at * at / 2 - log(p.deviation * sqrt(2 * M_PI)) +
                   (f ? log(alike(cells, unknown[i]) ? usual : f->prior) : 0);
    }
    for (int a = 0; a < BR_AXES; a++)
        sum += br_joint_has(law->kind, a) && !law->of[a] ? log(one_power) : 0;
    return sum + (law->floor ? log(law->floor->prior) : 0);
}

/* ---- the fit, by Levenberg and Marquardt ---- */

/* The equations of one step: a column for each unknown and one for the right side, `stride` apart;
 * a row for each cell, one for the prior of each unknown, and one for its damping. */
struct equations {
    int unknown[BR_UNKNOWNS];
    size_t unknowns, cells, stride;
    double *now, *next, *work;
    double noise;  /* of residuals, beside which priors weigh; 0: there are no priors */
    double robust; /* residuals above this count less; 0: all count */
};

size_t br_joint_room(size_t count)
{
    return 3 * (count + 2 * BR_UNKNOWNS) * (BR_UNKNOWNS + 1);
}

static struct equations equations_of(const struct br_joint_cells *cells,
                                     const struct br_joint_law *law)
{
    struct equations e = {.cells = cells->count, .stride = cells->count + 2 * BR_UNKNOWNS};
    e.unknowns = br_joint_unknowns(law, e.unknown);
    e.now = cells->room;
    e.next = e.now + e.stride * (BR_UNKNOWNS + 1);
    e.work = e.next + e.stride * (BR_UNKNOWNS + 1);
    return e;
}

/* Sets the equations at these values. Returns the sum to be made small; infinite: they are not
 * allowed. */
static double evaluate(struct br_joint_cells *cells, const struct br_joint_law *law,
                       const struct equations *e, const double v[BR_UNKNOWNS], double *a)
{
    const size_t n = e->unknowns;
    double sum = 0, rate[BR_UNKNOWNS], *b = a + n * e->stride;
    if (!allowed(law, v) || br_observer_stops(cells->observer))
        return INFINITY;
    const struct mixing mix = mixing_of(law, v);
    for (int axis = 0; axis < BR_AXES; axis++)
        fill_axis(cells, law, v, axis);
    for (size_t i = 0; i < e->cells; i++) {
        const struct br_joint_cell *c = &cells->cell[i];
        const double r = residual_of(cells, &mix, c, rate);
        const double off = e->robust > 0 ? pow(r / e->robust, 2) : 0;
        const double scale = sqrt(c->weight / (1 + off));
        sum += c->weight * (e->robust > 0 ? e->robust * e->robust * log1p(off) : r * r);
        b[i] = -scale * r;
        for (size_t j = 0; j < n; j++)
            a[j * e->stride + i] = scale * rate[e->unknown[j]];
    }
    for (size_t j = 0; j < n; j++) {
        const struct normal p = prior_of(cells, law, e->unknown[j]);
        memset(&a[j * e->stride + e->cells], 0, n * sizeof *a);
        a[j * e->stride + e->cells + j] = e->noise / p.deviation;
        b[e->cells + j] = e->noise * (p.mean - v[e->unknown[j]]) / p.deviation;
        sum += b[e->cells + j] * b[e->cells + j];
    }
    return isfinite(sum) ? sum : INFINITY;
}

/* In four sums, which need not wait for each other. */
static double dot(const double *a, const double *b, size_t n)
{
    double sum[4] = {0};
    size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (size_t j = 0; j < 4; j++)
            sum[j] += a[i + j] * b[i + j];
    for (; i < n; i++)
        sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* The step x that makes the sum least, held back by rows of damping times the scale of each
 * unknown; r: the triangle. By modified Gram-Schmidt, with the right side as one more column
 * (Bjorck, BIT 7, 1-21, 1967). No library: its rounding would be that of the installed BLAS. */
static void solve(const struct equations *e, const double scale[BR_UNKNOWNS], double damping,
                  double r[BR_UNKNOWNS][BR_UNKNOWNS + 1], double x[BR_UNKNOWNS])
{
    const size_t n = e->unknowns, rows = e->cells + 2 * n;
    memcpy(e->work, e->now, (n + 1) * e->stride * sizeof *e->work);
    for (size_t j = 0; j <= n; j++) {
        double *held = e->work + j * e->stride + rows - n;
        memset(held, 0, n * sizeof *held);
        if (j < n)
            held[j] = sqrt(damping) * scale[j];
    }
    for (size_t k = 0; k < n; k++) {
        const double *q = e->work + k * e->stride, square = dot(q, q, rows);
        r[k][k] = sqrt(square);
        for (size_t j = k + 1; j <= n; j++) {
            double *of = e->work + j * e->stride;
            const double share = square > 0 ? dot(q, of, rows) / square : 0;
            r[k][j] = share * r[k][k];
            for (size_t i = 0; i < rows; i++)
                of[i] -= share * q[i];
        }
    }
    for (size_t k = n; k-- > 0;) {
        x[k] = r[k][n];
        for (size_t j = k + 1; j < n; j++)
            x[k] -= r[k][j] * x[j];
        x[k] = r[k][k] > 0 ? x[k] / r[k][k] : 0;
    }
}

/* From the values of a trial down to a minimum, until a step gains less than this share of the
 * variance of a residual. */
static void minimise(struct br_joint_cells *cells, struct equations *e, struct br_joint_trial *t,
                     double share)
{
    double r[BR_UNKNOWNS][BR_UNKNOWNS + 1], step[BR_UNKNOWNS], scale[BR_UNKNOWNS] = {0};
    double damping = 1e-3, now = evaluate(cells, &t->law, e, t->value, e->now);
    const size_t n = e->unknowns;
    for (int turn = 0, calm = 0; turn < 200 && isfinite(now) && calm < 2 && damping < 1e10;
         turn++) {
        double next[BR_UNKNOWNS], most = 0;
        for (size_t j = 0; j < n; j++) {
            const double *of = e->now + j * e->stride;
            scale[j] = fmax(scale[j], sqrt(dot(of, of, e->cells)));
        }
        solve(e, scale, damping, r, step);
        memcpy(next, t->value, sizeof next);
        for (size_t j = 0; j < n; j++) {
            next[e->unknown[j]] += step[j];
            most = fmax(most, fabs(step[j]));
        }
        for (int a = 0; a < BR_AXES; a++) {
            double *place = &next[BR_OF(a, BR_PLACE)];
            if (t->law.of[a] && t->law.of[a]->law == BR_LAW_KINK)
                *place = fmin(fmax(*place, t->law.of[a]->low), t->law.of[a]->high);
        }
        const double then = evaluate(cells, &t->law, e, next, e->next);
        if (then <= now) {
            double *const before = e->now;
            e->now = e->next;
            e->next = before;
            calm = most < 1e-9 || now - then <= share / (double)e->cells * now ? calm + 1 : 0;
            memcpy(t->value, next, sizeof next);
            now = then;
            damping = damping > 1e-14 ? damping / 10 : damping;
        } else if (most < 1e-10)
            break;
        else
            damping *= 10;
    }
    t->sum = now;
}

void br_joint_approach(struct br_joint_cells *cells, double robust, struct br_joint_trial *t)
{
    struct equations e = equations_of(cells, &t->law);
    e.robust = robust;
    e.noise = cells->priors ? 1e-6 : 0;
    minimise(cells, &e, t, cells->priors ? 0.1 : 1e-12);
}

/* How large the corrections of an axis are, 0 to 1. */
static double change_of(const struct br_joint_cells *cells, const struct br_joint_trial *t,
                        int axis)
{
    const struct br_family *f = t->law.of[axis];
    double most = 0;
    for (size_t i = 1; i < cells->sizes[axis] && f && f->law != BR_LAW_KINK; i++) {
        const double off = fabs(bend(f, &t->value[BR_OF(axis, 0)], cells->size[axis][i].log_x,
                                     cells->log_finest[axis]) -
                                t->bend[axis]);
        most = fmax(most, off / (1 + off));
    }
    return most;
}

/* The standard deviation of an unknown by printed digits: cells of one size may be rounded the same
 * way. share: of each residual in it. */
static double by_digits(const struct br_joint_cells *cells, int axis, const double *share)
{
    double square = 0;
    for (size_t size = 1; size < cells->sizes[axis]; size++) {
        double sum = 0;
        for (size_t i = 0; i < cells->count; i++)
            if (cells->cell[i].at[axis] == size)
                sum += fabs(share[i]) * sqrt(cells->cell[i].weight) * cells->cell[i].rounded;
        square += sum * sum;
    }
    return sqrt(square);
}

/* Sets what else is not known of the order of an axis; order: of the unknowns. */
static void set_open(const struct br_joint_cells *cells, const struct equations *e, size_t order,
                     int axis, struct br_joint_trial *t)
{
    const size_t m = e->cells;
    const double *x = e->now + order * e->stride, *one = x - e->stride; /* log C is before it */
    double *share = e->work;
    memset(share, 0, m * sizeof *share);
    for (size_t j = 0; j < e->unknowns; j++)
        for (size_t i = 0; i < m; i++)
            share[i] += t->covariance[order][j] * e->now[j * e->stride + i];
    const double along = dot(x, one, m),
                 slope = sqrt(1 / (dot(x, x, m) - along * along / dot(one, one, m)));
    const double change = change_of(cells, t, axis);
    t->open[axis] = hypot(slope * (br_priors.sure + br_priors.truncation * change +
                                   br_priors.next_term * change * change),
                          br_scale_of_known(t->freedom) * by_digits(cells, axis, share));
}

/* The sum without priors, the covariance, and what follows from it. */
static void finish(struct br_joint_cells *cells, struct equations *e, struct br_joint_trial *t)
{
    const size_t n = e->unknowns;
    double r[BR_UNKNOWNS][BR_UNKNOWNS + 1], inverse[BR_UNKNOWNS][BR_UNKNOWNS] = {{0}},
                                            step[BR_UNKNOWNS] = {0};
    if (!isfinite(t->sum) || !isfinite(evaluate(cells, &t->law, e, t->value, e->now)))
        return;
    const double *b = e->now + n * e->stride;
    t->sum = t->worst = t->weight = t->log_determinant = 0;
    for (size_t i = 0; i < e->cells; i++) {
        t->sum += b[i] * b[i];
        t->worst = fmax(t->worst, fabs(b[i]));
        t->weight += cells->cell[i].weight;
    }
    t->freedom = fmax(1, floor(t->weight - (double)n + 1e-9));
    solve(e, step, 0, r, step);
    for (size_t k = 0; k < n; k++) {
        t->log_determinant -= 2 * log(r[k][k]);
        for (size_t i = k + 1; i-- > 0;) { /* R inverse = 1 */
            double sum = i == k;
            for (size_t l = i + 1; l <= k; l++)
                sum -= r[i][l] * inverse[l][k];
            inverse[i][k] = sum / r[i][i];
        }
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            t->covariance[i][j] = dot(inverse[i], inverse[j], n);
    for (int a = 0; a < BR_AXES; a++)
        t->bend[a] =
            t->law.of[a] ? bend(t->law.of[a], &t->value[BR_OF(a, 0)], 0, cells->log_finest[a]) : 0;
    for (size_t j = 0; j < n; j++)
        if (e->unknown[j] < BR_THETA && e->unknown[j] % BR_OF_AXIS == BR_ORDER)
            set_open(cells, e, j, e->unknown[j] / BR_OF_AXIS, t);
}

void br_joint_descend(struct br_joint_cells *cells, struct br_joint_trial *t)
{
    struct equations e = equations_of(cells, &t->law);
    br_joint_approach(cells, 0, t);
    if (cells->priors && isfinite(t->sum)) { /* once more, beside the noise that is seen */
        e.noise = fmin(0.3, sqrt(t->sum / (double)cells->count) + 1e-8);
        minimise(cells, &e, t, 1e-3);
    }
    finish(cells, &e, t);
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
        value[BR_OF(a, BR_LOG_C)] = isfinite(least) ? least : 0;
        value[BR_OF(a, BR_ORDER)] = order[a];
        value[BR_OF(a, BR_SHAPE)] = value[BR_OF(a, BR_PLACE)] = 0;
    }
    value[BR_THETA] = asin(r);
    value[BR_LOG_F] = cells->lowest - log(2);
}

double br_joint_shape_start(const struct br_family *f, double log_finest)
{
    return f->law == BR_LAW_NEXT        ? 0.3
           : f->law == BR_LAW_KINK      ? 0.5
           : f->law == BR_LAW_LOGARITHM ? log(fmax(4, 1 - log_finest))
                                        : log(f->low * f->high) / 2;
}

/* ---- a fit, once it is found ---- */

bool br_joint_describes(const struct br_joint_fit *fit)
{
    return fit->converged && (fit->misfit <= 0.02 || fit->scatters);
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
