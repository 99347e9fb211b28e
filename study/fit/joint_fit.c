/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/fit.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>

/* The unknowns are log C and the order of each axis, theta with r = sin(theta), the logarithm of a
 * floor, and the drift of each axis. */
enum { THETA = 2 * BR_AXES, LOG_F, DRIFT, UNKNOWNS = DRIFT + BR_AXES };
#define LOG_C(axis) (2 * (axis))
#define ORDER(axis) (2 * (axis) + 1)

/* What a model has beside its powers: a floor f that adds to their error e, as e + f or by squares,
 * or next terms, C x^p exp(D x). */
enum extra { PLAIN, FLOOR_ADDS, FLOOR_BY_SQUARES, DRIFTS, EXTRAS };
#define IN_H LOG_C(BR_AXIS_SPACE), ORDER(BR_AXIS_SPACE)
#define IN_K LOG_C(BR_AXIS_TIME), ORDER(BR_AXIS_TIME)

static const struct model {
    enum br_joint_kind kind;
    enum extra extra;
    int unknown[UNKNOWNS];
    size_t count;
} models[] = {
    /* Those without extras come first: the others start from them. */
    {BR_JOINT_BOTH, PLAIN, {IN_H, IN_K, THETA}, 5},
    {BR_JOINT_TIME, PLAIN, {IN_K}, 2},
    {BR_JOINT_SPACE, PLAIN, {IN_H}, 2},
    {BR_JOINT_BOTH, FLOOR_ADDS, {IN_H, IN_K, THETA, LOG_F}, 6},
    {BR_JOINT_TIME, FLOOR_ADDS, {IN_K, LOG_F}, 3},
    {BR_JOINT_SPACE, FLOOR_ADDS, {IN_H, LOG_F}, 3},
    {BR_JOINT_BOTH, FLOOR_BY_SQUARES, {IN_H, IN_K, THETA, LOG_F}, 6},
    {BR_JOINT_TIME, FLOOR_BY_SQUARES, {IN_K, LOG_F}, 3},
    {BR_JOINT_SPACE, FLOOR_BY_SQUARES, {IN_H, LOG_F}, 3},
    {BR_JOINT_BOTH, DRIFTS, {IN_H, IN_K, THETA, DRIFT + BR_AXIS_SPACE, DRIFT + BR_AXIS_TIME}, 7},
    {BR_JOINT_TIME, DRIFTS, {IN_K, DRIFT + BR_AXIS_TIME}, 3},
    {BR_JOINT_SPACE, DRIFTS, {IN_H, DRIFT + BR_AXIS_SPACE}, 3},
};
enum { KINDS = BR_JOINT_SPACE + 1, MODELS = sizeof models / sizeof *models };

static bool has_floor(const struct model *model)
{
    return model->extra == FLOOR_ADDS || model->extra == FLOOR_BY_SQUARES;
}

bool br_joint_has(enum br_joint_kind kind, int axis)
{
    return kind != (axis == BR_AXIS_SPACE ? BR_JOINT_TIME : BR_JOINT_SPACE);
}

/* The observations are scaled so that the largest h, the largest k and the largest error are one.
 * So no result depends on the units of a scene. */
struct problem {
    const struct br_observation *observation;
    size_t count;
    const struct model *model;
    bool any_model;
    const struct br_observer *observer;  /* may be NULL; where it stops, no fit is found any more */
    double log_unit[BR_AXES], log_error; /* logarithms of those units in m, s, m^(3/2) */
    bool *starved;                       /* set if memory ends */
    double *room;                        /* for `count` values of one axis */
};

struct br_estimate br_estimate_of(double value, double deviation, size_t freedom)
{
    const double half = freedom > 0 ? gsl_cdf_tdist_Pinv(0.975, (double)freedom) * deviation : NAN;
    return (struct br_estimate){value, value - half, value + half};
}

static double combine(double a, double b, double r)
{
    const double square = a * a + 2 * r * a * b + b * b;
    return sqrt(square < 0 ? 0 : square); /* NaN stays */
}

static double above_floor(double error, double level, bool adds)
{
    return adds ? error + level : hypot(error, level);
}

static void spread(const struct problem *problem, const gsl_vector *v, double full[UNKNOWNS])
{
    for (size_t i = 0; i < UNKNOWNS; i++)
        full[i] = 0;
    for (size_t i = 0; i < problem->model->count; i++)
        full[problem->model->unknown[i]] = gsl_vector_get(v, i);
}

/* C x^order exp(drift x); x is 0 for the continuous problem. An order is positive. */
static double power(const double full[UNKNOWNS], int axis, double x)
{
    const double order = full[ORDER(axis)];
    return order > 0 ? exp(full[LOG_C(axis)] + order * log(x) + full[DRIFT + axis] * x)
                     : (double)NAN;
}

/* The two errors, less those of the reference; 0 where the model does not have one. */
static void find_errors(const struct problem *problem, const double full[UNKNOWNS],
                        const struct br_observation *o, double error[BR_AXES])
{
    for (int a = 0; a < BR_AXES; a++)
        error[a] = br_joint_has(problem->model->kind, a)
                       ? power(full, a, o->x[a]) - power(full, a, o->ref[a])
                       : 0;
}

/* The rates of an error with its order and, where the logarithms are sizes, with its drift. With
 * log C, it is the error itself. */
static double rate_with(const double full[UNKNOWNS], int axis, const struct br_observation *o,
                        double (*of)(double))
{
    const double x = o->x[axis], ref = o->ref[axis];
    return power(full, axis, x) * of(x) - (ref > 0 ? power(full, axis, ref) * of(ref) : 0);
}

static double size_itself(double x)
{
    return x;
}

static const double least_model = 1e-300;

/* log(model / error) of an observation. */
static double residual(const struct problem *problem, const double full[UNKNOWNS], size_t i)
{
    const struct br_observation *o = &problem->observation[i];
    const struct model *model = problem->model;
    double error[BR_AXES];
    find_errors(problem, full, o, error);
    double m = combine(error[0], error[1], sin(full[THETA]));
    if (has_floor(model))
        m = above_floor(m, exp(full[LOG_F]), model->extra == FLOOR_ADDS);
    return log((m < least_model ? least_model : m) / o->error);
}

static int residuals(const gsl_vector *v, void *params, gsl_vector *out)
{
    const struct problem *problem = params;
    double full[UNKNOWNS];
    spread(problem, v, full);
    if (br_observer_stops(problem->observer))
        return GSL_EFAILED;
    for (size_t i = 0; i < problem->count; i++) {
        const double f = residual(problem, full, i);
        if (!isfinite(f))
            return GSL_EDOM;
        gsl_vector_set(out, i, f);
    }
    return GSL_SUCCESS;
}

/* d log(model) / d unknown: with m^2 = a^2 + 2 r a b + b^2, m dm = (a + r b) da + (b + r a) db +
 * a b dr, and with a floor f, m + f or sqrt(m^2 + f^2) in place of m. */
static int jacobian(const gsl_vector *v, void *params, gsl_matrix *out)
{
    const struct problem *problem = params;
    double full[UNKNOWNS];
    spread(problem, v, full);
    const double r = sin(full[THETA]), slope = cos(full[THETA]);
    for (size_t i = 0; i < problem->count; i++) {
        const struct br_observation *o = &problem->observation[i];
        double error[BR_AXES], rate[UNKNOWNS];
        find_errors(problem, full, o, error);
        const double m = combine(error[0], error[1], r);
        const double level = has_floor(problem->model) ? exp(full[LOG_F]) : 0;
        const bool adds = problem->model->extra == FLOOR_ADDS;
        const double all = above_floor(m, level, adds), square = adds ? m * all : all * all;
        for (int a = 0; a < BR_AXES; a++) {
            const double by = (error[a] + r * error[1 - a]) / square;
            rate[LOG_C(a)] = by * error[a];
            rate[ORDER(a)] = by * rate_with(full, a, o, log);
            rate[DRIFT + a] = by * rate_with(full, a, o, size_itself);
        }
        rate[LOG_F] = adds ? level / all : level * level / square;
        rate[THETA] = error[0] * error[1] / square * slope;
        for (size_t j = 0; j < problem->model->count; j++) {
            const double value = square > 0 ? rate[problem->model->unknown[j]] : 0;
            if (!isfinite(value))
                return GSL_EDOM;
            gsl_matrix_set(out, i, j, value);
        }
    }
    return GSL_SUCCESS;
}

/* The logarithm of the unit of a constant's axis; 0 for the other unknowns. */
static double log_unit(const struct problem *problem, int unknown)
{
    return unknown >= THETA || unknown % 2 ? 0 : problem->log_unit[unknown / 2];
}

/* What is added to an unknown in m and s to get it in scaled units. It is 0 but for constants,
 * whose order is the next unknown, and a floor; a drift is that of the coarsest size. */
static double shift(const struct problem *problem, int unknown, const double full[UNKNOWNS])
{
    if (unknown == LOG_F)
        return -problem->log_error;
    if (unknown >= THETA || unknown % 2)
        return 0;
    return full[unknown + 1] * log_unit(problem, unknown) - problem->log_error;
}

static double least_error(const struct problem *problem)
{
    double least = INFINITY;
    for (size_t i = 0; i < problem->count; i++)
        least = fmin(least, problem->observation[i].error);
    return least;
}

/* Start values; for the constants the least errors at the largest h and at the largest k. */
static void start_at(const struct problem *problem, const double order[BR_AXES], double r,
                     double full[UNKNOWNS])
{
    full[ORDER(BR_AXIS_SPACE)] = order[BR_AXIS_SPACE];
    full[ORDER(BR_AXIS_TIME)] = order[BR_AXIS_TIME];
    full[THETA] = asin(r);
    full[DRIFT] = full[DRIFT + 1] = 0;
    full[LOG_F] = log(least_error(problem) / 2) - shift(problem, LOG_F, full);
    for (int a = 0; a < BR_AXES; a++) {
        double at_coarse = INFINITY;
        for (size_t i = 0; i < problem->count; i++)
            if (problem->observation[i].x[a] == 1)
                at_coarse = fmin(at_coarse, problem->observation[i].error);
        full[LOG_C(a)] = log(at_coarse) - shift(problem, LOG_C(a), full);
    }
}

/* One start of one kind. */
struct attempt {
    double sum, worst; /* sum of squared residuals (infinite: no fit); largest magnitude */
    double value[UNKNOWNS], deviation[UNKNOWNS]; /* in m and s; NaN where not in the model */
};

/* The variance of unknown i in m and s; of a constant, that of log C - order log_unit. Where it is
 * not positive, the problem is rank deficient. */
static double variance_of(const struct problem *problem, const gsl_matrix *covariance, size_t i)
{
    const double c = gsl_matrix_get(covariance, i, i);
    const double unit = log_unit(problem, problem->model->unknown[i]);
    if (unit == 0 || !(c > 0))
        return c;
    const double order = gsl_matrix_get(covariance, i + 1, i + 1);
    return order > 0 ? c + unit * unit * order - 2 * unit * gsl_matrix_get(covariance, i, i + 1)
                     : 0;
}

static void read_attempt(const struct problem *problem, gsl_multifit_nlinear_workspace *w,
                         struct attempt *out)
{
    const size_t unknowns = problem->model->count;
    const gsl_vector *f = gsl_multifit_nlinear_residual(w);
    double sum = 0, worst = 0;
    for (size_t i = 0; i < f->size; i++) {
        sum += gsl_vector_get(f, i) * gsl_vector_get(f, i);
        worst = fmax(worst, fabs(gsl_vector_get(f, i)));
    }
    if (!isfinite(sum))
        return;
    double room[UNKNOWNS * UNKNOWNS];
    gsl_matrix_view covariance = gsl_matrix_view_array(room, unknowns, unknowns);
    gsl_matrix *jacobian = gsl_multifit_nlinear_jac(w); /* not used any more */
    br_least_squares_solve(jacobian->data, NULL, jacobian->size1, unknowns, 1e-12, NULL, room);
    const double variance = sum / (double)(problem->count - unknowns);
    double full[UNKNOWNS];
    spread(problem, gsl_multifit_nlinear_position(w), full);
    for (size_t i = 0; i < unknowns; i++) {
        const int u = problem->model->unknown[i];
        const double c = variance_of(problem, &covariance.matrix, i);
        out->value[u] = full[u] - shift(problem, u, full);
        out->deviation[u] = c > 0 ? sqrt(variance * c) : INFINITY;
    }
    out->sum = sum;
    out->worst = worst;
}

/* A fit that starts from the given values of all unknowns, in m and s. */
static struct attempt attempt_from(const struct problem *problem, const double full[UNKNOWNS])
{
    struct attempt out = {.sum = INFINITY};
    for (int i = 0; i < UNKNOWNS; i++)
        out.value[i] = out.deviation[i] = NAN;
    const size_t unknowns = problem->model->count;
    gsl_multifit_nlinear_parameters parameters = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_workspace *w = gsl_multifit_nlinear_alloc(
        gsl_multifit_nlinear_trust, &parameters, problem->count, unknowns);
    if (w) {
        double start[UNKNOWNS];
        for (size_t i = 0; i < unknowns; i++) {
            const int u = problem->model->unknown[i];
            start[i] = full[u] + shift(problem, u, full);
        }
        const gsl_vector_view from = gsl_vector_view_array(start, unknowns);
        gsl_multifit_nlinear_fdf fdf = {.f = residuals,
                                        .df = jacobian,
                                        .n = problem->count,
                                        .p = unknowns,
                                        .params = (void *)problem};
        int info;
        if (gsl_multifit_nlinear_init(&from.vector, &fdf, w) == GSL_SUCCESS) {
            gsl_multifit_nlinear_driver(500, 1e-13, 1e-13, 0, NULL, NULL, &info, w);
            read_attempt(problem, w, &out);
        }
    }
    *problem->starved |= !w;
    gsl_multifit_nlinear_free(w);
    return out;
}

/* The best of several starts: the sum of squares has local minima in r and p. A model with extras
 * starts from that without them, too. */
static struct attempt best_attempt(const struct problem *problem, const struct attempt *plain)
{
    static const double orders[][BR_AXES] = {{1, 1}, {2, 1}, {4, 1}, {1, 4}, {4, 4}},
                        correlations[] = {-0.9, 0, 0.9};
    struct attempt best = {.sum = INFINITY};
    double full[UNKNOWNS];
    if (plain) {
        start_at(problem, orders[0], 0, full);
        for (size_t i = 0; i < problem->model->count; i++) {
            const int u = problem->model->unknown[i];
            full[u] = u < LOG_F ? plain->value[u] : full[u];
        }
        best = attempt_from(problem, full);
    }
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++)
        for (size_t j = 0; j < sizeof correlations / sizeof *correlations; j++) {
            if (plain && j != 1)
                continue;
            start_at(problem, orders[i], correlations[j], full);
            const struct attempt a = attempt_from(problem, full);
            if (a.sum < best.sum || (!plain && i == 0 && j == 0))
                best = a;
        }
    return best;
}

/* ---- intervals ---- */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The different values of h (or k) among the observations, ascending; their number. */
static size_t distinct(const struct problem *problem, int axis, double *value)
{
    size_t count = 0;
    for (size_t i = 0; i < problem->count; i++)
        value[i] = problem->observation[i].x[axis];
    qsort(value, problem->count, sizeof *value, by_size);
    for (size_t i = 0; i < problem->count; i++)
        if (count == 0 || value[i] != value[count - 1])
            value[count++] = value[i];
    return count;
}

/* Cells that share h or k are not independent: the residuals are deterministic. So the intervals
 * come from leaving out one whole line of the grid after the other (delete-a-group jackknife, Efron
 * 1982), where they are wider. */
static void widen_by_jackknife(const struct problem *problem, struct attempt *a, int axis,
                               struct br_observation *workspace)
{
    const size_t count = distinct(problem, axis, problem->room);
    const double groups = (double)count;
    double sum[UNKNOWNS] = {0}, squares[UNKNOWNS] = {0};
    for (size_t i = 0; i < count && !br_observer_stops(problem->observer); i++) {
        struct problem rest = *problem;
        rest.observation = workspace;
        rest.count = 0;
        for (size_t j = 0; j < problem->count; j++)
            if (problem->observation[j].x[axis] != problem->room[i])
                workspace[rest.count++] = problem->observation[j];
        struct attempt without = {.sum = INFINITY};
        if (rest.count > problem->model->count)
            without = attempt_from(&rest, a->value);
        for (int u = 0; u < UNKNOWNS; u++) {
            const double shift = isfinite(without.sum) ? without.value[u] - a->value[u] : NAN;
            sum[u] += shift;
            squares[u] += shift * shift;
        }
    }
    const double freedom = (double)(problem->count - problem->model->count);
    const double quantiles =
        gsl_cdf_tdist_Pinv(0.975, groups - 1) / gsl_cdf_tdist_Pinv(0.975, freedom);
    for (size_t i = 0; i < problem->model->count; i++) {
        const int u = problem->model->unknown[i];
        const double spread = squares[u] - sum[u] * sum[u] / groups;
        const double deviation = sqrt((groups - 1) / groups * fmax(0, spread)) * quantiles;
        if (!(deviation <= a->deviation[u])) /* NaN: a refit failed */
            a->deviation[u] = isfinite(spread) ? deviation : INFINITY;
    }
}

double br_akaike(double sum, size_t count, size_t unknowns)
{
    const double n = (double)count, u = (double)unknowns + 1; /* the variance is an unknown, too */
    if (!(n > u + 1))
        return INFINITY;
    return n * log(fmax(sum, 1e-300) / n) + 2 * u + 2 * u * (u + 1) / (n - u - 1);
}

/* r = sin(theta) with its interval by the slope of the sine, within [-1, 1]. */
static struct br_estimate correlation(double theta, double deviation, size_t freedom)
{
    struct br_estimate e = br_estimate_of(sin(theta), fabs(cos(theta)) * deviation, freedom);
    e.low = e.low < -1 ? -1 : e.low; /* NaN stays */
    e.high = e.high > 1 ? 1 : e.high;
    return e;
}

/* How far neighbours along h and along k have residuals of one sign: the sum of their products, in
 * standard deviations of that of independent ones. A wrong model leaves waves, noise does not. */
static double structure_of(const struct problem *problem, const double full[UNKNOWNS], double sum)
{
    const double mean_square = sum / (double)problem->count;
    double products = 0, pairs = 0;
    for (size_t i = 0; i < problem->count; i++)
        for (int a = 0; a < BR_AXES; a++) {
            const struct br_observation *at = &problem->observation[i], *next = NULL;
            for (const struct br_observation *o = problem->observation;
                 o < problem->observation + problem->count; o++)
                if (o->x[1 - a] == at->x[1 - a] && o->x[a] < at->x[a] &&
                    (!next || o->x[a] > next->x[a]))
                    next = o;
            if (!next)
                continue;
            products += residual(problem, full, i) *
                        residual(problem, full, (size_t)(next - problem->observation));
            pairs++;
        }
    return pairs > 0 && mean_square > 0 ? products / mean_square / sqrt(pairs) : 0;
}

static const double most_scatter = 0.3, most_structure = 1;

static void describe(const struct problem *problem, const struct attempt *a,
                     struct br_joint_fit *fit)
{
    const size_t freedom = problem->count - problem->model->count;
    *fit = (struct br_joint_fit){
        .kind = problem->model->kind,
        .converged = true,
        .points = problem->count,
        .freedom = freedom,
        .r = correlation(a->value[THETA], a->deviation[THETA], freedom),
        .floor = has_floor(problem->model) ? exp(a->value[LOG_F]) : (double)NAN,
    };

    double full[UNKNOWNS] = {0};
    for (size_t i = 0; i < problem->model->count; i++) {
        const int u = problem->model->unknown[i];
        full[u] = a->value[u];
    }
    for (int i = 0; i < BR_AXES; i++) {
        const struct br_estimate log_c =
            br_estimate_of(a->value[LOG_C(i)], a->deviation[LOG_C(i)], freedom);
        fit->c[i] = (struct br_estimate){exp(log_c.value), exp(log_c.low), exp(log_c.high)};
        fit->order[i] = br_estimate_of(a->value[ORDER(i)], a->deviation[ORDER(i)], freedom);
        full[LOG_C(i)] += shift(problem, LOG_C(i), full);
    }
    full[LOG_F] += shift(problem, LOG_F, full);
    double mean = 0, total = 0;
    for (size_t i = 0; i < problem->count; i++)
        mean += log(problem->observation[i].error) / (double)problem->count;
    for (size_t i = 0; i < problem->count; i++)
        total += pow(log(problem->observation[i].error) - mean, 2);
    fit->misfit = sqrt(a->sum / (double)problem->count);
    fit->worst = a->worst;
    fit->r_squared = total > 0 ? 1 - a->sum / total : NAN;
    fit->scatters = problem->any_model && fit->misfit <= most_scatter &&
                    structure_of(problem, full, a->sum) <= most_structure;
}

double br_joint_model(const struct br_joint_fit *fit, const double x[BR_AXES],
                      const double ref[BR_AXES])
{
    double error[BR_AXES] = {0}, full[UNKNOWNS] = {0};
    for (int a = 0; a < BR_AXES; a++) {
        full[LOG_C(a)] = log(fit->c[a].value);
        full[ORDER(a)] = fit->order[a].value;
        if (br_joint_has(fit->kind, a))
            error[a] = power(full, a, x[a]) - power(full, a, ref[a]);
    }
    return combine(error[0], error[1], fit->kind == BR_JOINT_BOTH ? fit->r.value : 0);
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

/* Whether some observation differs from its reference in h (or k). */
static bool varies(const struct problem *problem, int axis)
{
    for (size_t i = 0; i < problem->count; i++)
        if (problem->observation[i].x[axis] != problem->observation[i].ref[axis])
            return true;
    return false;
}

/* An order needs three sizes; the fit needs two more points than unknowns. */
static bool enough(const struct problem *problem)
{
    bool good = problem->count >= problem->model->count + 2;
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(problem->model->kind, a))
            good = good && varies(problem, a) && distinct(problem, a, problem->room) >= 3;
    return good;
}

/* Whether all orders of the model are determined. */
static bool all_determined(const struct br_joint_fit *fit)
{
    bool determined = true;
    for (int a = 0; a < BR_AXES; a++)
        determined &= !br_joint_has(fit->kind, a) || br_order_determined(&fit->order[a]);
    return determined;
}

/* Whether the model describes the errors and one of its orders is determined. */
static bool one_determined(const struct br_joint_fit *fit)
{
    return br_joint_describes(fit) &&
           (br_order_determined(&fit->order[0]) || br_order_determined(&fit->order[1]));
}

/* The scaled problem; own: out, its observations, count. */
static struct problem problem_of(const struct br_observation *observation, size_t count,
                                 struct br_observation *own)
{
    struct br_observation most = {.error = 0};
    for (size_t i = 0; i < count; i++) {
        for (int a = 0; a < BR_AXES; a++)
            most.x[a] = fmax(most.x[a], observation[i].x[a]);
        most.error = fmax(most.error, observation[i].error);
    }
    struct problem problem = {.observation = own, .count = count, .log_error = log(most.error)};
    for (int a = 0; a < BR_AXES; a++)
        problem.log_unit[a] = log(most.x[a]);
    for (size_t i = 0; i < count; i++) {
        own[i].error = observation[i].error / most.error;
        for (int a = 0; a < BR_AXES; a++) {
            own[i].x[a] = observation[i].x[a] / most.x[a];
            own[i].ref[a] = observation[i].ref[a] / most.x[a];
        }
    }
    return problem;
}

/* A model, fitted. */
struct candidate {
    struct attempt attempt;
    double criterion; /* infinite: there is no fit */
    bool widened;
};

/* Sets the fit to a model that is accepted, with jackknife intervals. The jackknife is slow and
 * only widens intervals, so it is not done for a model that is refused without it. */
static bool take_model(struct problem *problem, size_t model, struct candidate *c,
                       bool (*accepts)(const struct br_joint_fit *),
                       struct br_observation *workspace, struct br_joint_fit *fit)
{
    struct br_joint_fit one;
    problem->model = &models[model];
    describe(problem, &c->attempt, &one);
    if (accepts(&one) && !c->widened) {
        for (int a = 0; a < BR_AXES; a++)
            if (br_joint_has(problem->model->kind, a))
                widen_by_jackknife(problem, &c->attempt, a, workspace);
        c->widened = true;
        describe(problem, &c->attempt, &one);
    }
    if (!accepts(&one))
        return false;
    *fit = one;
    return true;
}

/* The model with the least criterion that is not done; MODELS: there is none left. */
static size_t next_best(const struct candidate *candidate, const bool *done)
{
    size_t best = MODELS;
    for (size_t i = 0; i < MODELS; i++)
        if (!done[i] && isfinite(candidate[i].criterion) &&
            (best == MODELS || candidate[i].criterion < candidate[best].criterion))
            best = i;
    return best;
}

/* Models whose criterion is within this of the best one's are not ruled out (Burnham, Anderson and
 * Huyvaert, Behavioral Ecology and Sociobiology 65, 23-35, 2011). */
static const double not_ruled_out = 7;

/* A misfit of all powers below this is round-off, and no extras explain it. */
static const double exact = 1e-5;

/* Intervals reach over those of all models that the errors do not rule out. */
static void widen_by_others(struct problem *problem, const struct candidate *candidate,
                            struct br_joint_fit *fit)
{
    const bool none[MODELS] = {false};
    const double least = candidate[next_best(candidate, none)].criterion;
    for (size_t i = 0; i < MODELS; i++) {
        const struct attempt *a = &candidate[i].attempt;
        for (int axis = 0; axis < BR_AXES && candidate[i].criterion <= least + not_ruled_out;
             axis++) {
            const struct br_estimate other = br_estimate_of(
                a->value[ORDER(axis)], a->deviation[ORDER(axis)], problem->count - models[i].count);
            if (!br_joint_has(fit->kind, axis) || !br_joint_has(models[i].kind, axis))
                continue;
            fit->order[axis].low = fmin(fit->order[axis].low, other.low);
            fit->order[axis].high = fmax(fit->order[axis].high, other.high);
        }
    }
}

/* Fits all models; those with extras only where powers leave something to explain. */
static void fit_models(struct problem *problem, struct candidate candidate[MODELS])
{
    double least = INFINITY; /* sum of squares, of powers alone */
    for (size_t i = 0; i < MODELS; i++) {
        struct candidate *c = &candidate[i];
        const struct attempt *plain = i < KINDS ? NULL : &candidate[i % KINDS].attempt;
        *c = (struct candidate){.attempt = {.sum = INFINITY}, .criterion = INFINITY};
        problem->model = &models[i];
        if (!enough(problem) || (plain && !problem->any_model) ||
            (plain && !(least > exact * exact * (double)problem->count && isfinite(plain->sum))))
            continue;
        c->attempt = best_attempt(problem, plain);
        if (isfinite(c->attempt.sum))
            c->criterion = br_akaike(c->attempt.sum, problem->count, models[i].count);
        if (!plain)
            least = fmin(least, c->attempt.sum);
    }
}

enum br_status br_joint_fit_solve(const struct br_observation *observation, size_t count,
                                  bool any_model, const struct br_observer *observer,
                                  struct br_joint_fit *fit, struct br_error *err)
{
    struct candidate candidate[MODELS];
    *fit = nothing_fitted(count);
    struct br_observation *own = br_allocate(2 * count, sizeof *own);
    double *room = br_allocate(count, sizeof *room);
    if (!own || !room) {
        free(own);
        free(room);
        return br_no_memory(err, "the fits");
    }
    bool starved = false;
    struct problem problem = problem_of(observation, count, own);
    problem.any_model = any_model;
    problem.observer = observer;
    problem.room = room;
    problem.starved = &starved;
    fit_models(&problem, candidate);
    bool done[MODELS] = {false}, taken = false;
    for (size_t i; !taken && (i = next_best(candidate, done)) < MODELS; done[i] = true)
        taken = take_model(&problem, i, &candidate[i], all_determined, own + count, fit);
    if (!br_joint_describes(fit) && isfinite(candidate[BR_JOINT_BOTH].criterion))
        taken |= take_model(&problem, BR_JOINT_BOTH, &candidate[BR_JOINT_BOTH], one_determined,
                            own + count, fit);
    if (taken && any_model)
        widen_by_others(&problem, candidate, fit);
    free(own);
    free(room);
    if (br_observer_stops(observer))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    return starved ? br_no_memory(err, "the fits") : BR_OK;
}
