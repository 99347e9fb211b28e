/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/fit.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>

/* The unknowns are log C and the order of each axis, and theta with r = sin(theta). */
enum { THETA = 2 * BR_AXES, UNKNOWNS };
#define LOG_C(axis) (2 * (axis))
#define ORDER(axis) (2 * (axis) + 1)

/* The unknowns that a kind of model has, and their number. */
static const struct {
    int unknown[UNKNOWNS];
    size_t count;
} kinds[] = {
    [BR_JOINT_BOTH] = {{0, 1, 2, 3, THETA}, UNKNOWNS},
    [BR_JOINT_TIME] = {{LOG_C(BR_AXIS_TIME), ORDER(BR_AXIS_TIME)}, 2},
    [BR_JOINT_SPACE] = {{LOG_C(BR_AXIS_SPACE), ORDER(BR_AXIS_SPACE)}, 2},
};

bool br_joint_has(enum br_joint_kind kind, int axis)
{
    return kind != (axis == BR_AXIS_SPACE ? BR_JOINT_TIME : BR_JOINT_SPACE);
}

/* The observations are scaled so that the largest h, the largest k and the largest error are one.
 * So no result depends on the units of a scene. */
struct problem {
    const struct br_observation *observation;
    size_t count;
    enum br_joint_kind kind;
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

/* C (x^order - x_ref^order); an order is positive. */
static double signed_error(double log_c, double order, double x, double x_ref)
{
    if (!(order > 0))
        return NAN;
    return exp(log_c + order * log(x)) - exp(log_c + order * log(x_ref));
}

/* Its derivative with respect to the order; with respect to log C it is the error itself. */
static double signed_rate(double log_c, double order, double x, double x_ref)
{
    const double rate = exp(log_c + order * log(x)) * log(x);
    return x_ref > 0 ? rate - exp(log_c + order * log(x_ref)) * log(x_ref) : rate;
}

static double combine(double a, double b, double r)
{
    const double square = a * a + 2 * r * a * b + b * b;
    return sqrt(square < 0 ? 0 : square); /* NaN stays */
}

static void spread(const struct problem *problem, const gsl_vector *v, double full[UNKNOWNS])
{
    for (size_t i = 0; i < UNKNOWNS; i++)
        full[i] = 0;
    for (size_t i = 0; i < kinds[problem->kind].count; i++)
        full[kinds[problem->kind].unknown[i]] = gsl_vector_get(v, i);
}

/* The two errors; 0 where the model does not have one. */
static void find_errors(const struct problem *problem, const double full[UNKNOWNS],
                        const struct br_observation *o, double error[BR_AXES])
{
    for (int a = 0; a < BR_AXES; a++)
        error[a] = br_joint_has(problem->kind, a)
                       ? signed_error(full[LOG_C(a)], full[ORDER(a)], o->x[a], o->ref[a])
                       : 0;
}

static const double least_model = 1e-300;

/* Residuals log(model / error). */
static int residuals(const gsl_vector *v, void *params, gsl_vector *out)
{
    const struct problem *problem = params;
    double full[UNKNOWNS];
    spread(problem, v, full);
    const double r = sin(full[THETA]);
    if (br_observer_stops(problem->observer))
        return GSL_EFAILED;
    for (size_t i = 0; i < problem->count; i++) {
        const struct br_observation *o = &problem->observation[i];
        double error[BR_AXES];
        find_errors(problem, full, o, error);
        const double m = combine(error[0], error[1], r);
        const double f = log((m < least_model ? least_model : m) / o->error);
        if (!isfinite(f))
            return GSL_EDOM;
        gsl_vector_set(out, i, f);
    }
    return GSL_SUCCESS;
}

/* d log(model) / d unknown: with m^2 = a^2 + 2 r a b + b^2, m dm = (a + r b) da + (b + r a) db +
 * a b dr. */
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
        const double m = combine(error[0], error[1], r), square = m * m;
        for (int a = 0; a < BR_AXES; a++) {
            const double by = (error[a] + r * error[1 - a]) / square;
            rate[LOG_C(a)] = by * error[a];
            rate[ORDER(a)] = by * signed_rate(full[LOG_C(a)], full[ORDER(a)], o->x[a], o->ref[a]);
        }
        rate[THETA] = error[0] * error[1] / square * slope;
        for (size_t j = 0; j < kinds[problem->kind].count; j++) {
            const double value = square > 0 ? rate[kinds[problem->kind].unknown[j]] : 0;
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
    return unknown == THETA || unknown % 2 ? 0 : problem->log_unit[unknown / 2];
}

/* What is added to an unknown in m and s to get it in scaled units. It is 0 but for constants; the
 * order of a constant is the next unknown. */
static double shift(const struct problem *problem, int unknown, const double full[UNKNOWNS])
{
    if (unknown == THETA || unknown % 2)
        return 0;
    return full[unknown + 1] * log_unit(problem, unknown) - problem->log_error;
}

/* Start values; for the constants the least errors at the largest h and at the largest k. */
static void start_at(const struct problem *problem, double p, double r, double full[UNKNOWNS])
{
    full[ORDER(BR_AXIS_SPACE)] = p;
    full[ORDER(BR_AXIS_TIME)] = 1;
    full[THETA] = asin(r);
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
    const double unit = log_unit(problem, kinds[problem->kind].unknown[i]);
    if (unit == 0 || !(c > 0))
        return c;
    const double order = gsl_matrix_get(covariance, i + 1, i + 1);
    return order > 0 ? c + unit * unit * order - 2 * unit * gsl_matrix_get(covariance, i, i + 1)
                     : 0;
}

static void read_attempt(const struct problem *problem, gsl_multifit_nlinear_workspace *w,
                         struct attempt *out)
{
    const size_t unknowns = kinds[problem->kind].count;
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
        const int u = kinds[problem->kind].unknown[i];
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
    const size_t unknowns = kinds[problem->kind].count;
    gsl_multifit_nlinear_parameters parameters = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_workspace *w = gsl_multifit_nlinear_alloc(
        gsl_multifit_nlinear_trust, &parameters, problem->count, unknowns);
    if (w) {
        double start[UNKNOWNS];
        for (size_t i = 0; i < unknowns; i++) {
            const int u = kinds[problem->kind].unknown[i];
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

/* The best of several starts: the sum of squares has local minima in r and p. */
static struct attempt best_attempt(const struct problem *problem)
{
    static const double orders[] = {1, 2, 4}, correlations[] = {-0.9, 0, 0.9};
    struct attempt best = {.sum = INFINITY};
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++)
        for (size_t j = 0; j < sizeof correlations / sizeof *correlations; j++) {
            double full[UNKNOWNS];
            start_at(problem, orders[i], correlations[j], full);
            const struct attempt a = attempt_from(problem, full);
            if (a.sum < best.sum || (i == 0 && j == 0))
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
        if (rest.count > kinds[problem->kind].count)
            without = attempt_from(&rest, a->value);
        for (int u = 0; u < UNKNOWNS; u++) {
            const double shift = isfinite(without.sum) ? without.value[u] - a->value[u] : NAN;
            sum[u] += shift;
            squares[u] += shift * shift;
        }
    }
    const double freedom = (double)(problem->count - kinds[problem->kind].count);
    const double quantiles =
        gsl_cdf_tdist_Pinv(0.975, groups - 1) / gsl_cdf_tdist_Pinv(0.975, freedom);
    for (size_t i = 0; i < kinds[problem->kind].count; i++) {
        const int u = kinds[problem->kind].unknown[i];
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

static void describe(const struct problem *problem, const struct attempt *a,
                     struct br_joint_fit *fit)
{
    const size_t freedom = problem->count - kinds[problem->kind].count;
    *fit = (struct br_joint_fit){
        .kind = problem->kind,
        .converged = true,
        .points = problem->count,
        .freedom = freedom,
        .r = correlation(a->value[THETA], a->deviation[THETA], freedom),
    };

    for (int i = 0; i < BR_AXES; i++) {
        const struct br_estimate log_c =
            br_estimate_of(a->value[LOG_C(i)], a->deviation[LOG_C(i)], freedom);
        fit->c[i] = (struct br_estimate){exp(log_c.value), exp(log_c.low), exp(log_c.high)};
        fit->order[i] = br_estimate_of(a->value[ORDER(i)], a->deviation[ORDER(i)], freedom);
    }
    double mean = 0, total = 0;
    for (size_t i = 0; i < problem->count; i++)
        mean += log(problem->observation[i].error) / (double)problem->count;
    for (size_t i = 0; i < problem->count; i++)
        total += pow(log(problem->observation[i].error) - mean, 2);
    fit->misfit = sqrt(a->sum / (double)problem->count);
    fit->worst = a->worst;
    fit->r_squared = total > 0 ? 1 - a->sum / total : NAN;
}

double br_joint_model(const struct br_joint_fit *fit, const double x[BR_AXES],
                      const double ref[BR_AXES])
{
    double error[BR_AXES] = {0};
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(fit->kind, a))
            error[a] = signed_error(log(fit->c[a].value), fit->order[a].value, x[a], ref[a]);
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
    bool good = problem->count >= kinds[problem->kind].count + 2;
    for (int a = 0; a < BR_AXES; a++)
        if (br_joint_has(problem->kind, a))
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

/* A kind of model, fitted. */
struct candidate {
    struct attempt attempt;
    double criterion; /* infinite: there is no fit */
    bool widened;
};

/* Sets the fit to a kind that is accepted, with jackknife intervals. The jackknife is slow and only
 * widens intervals, so it is not done for a kind that is refused without it. */
static bool take_kind(struct problem *problem, enum br_joint_kind kind, struct candidate *c,
                      bool (*accepts)(const struct br_joint_fit *),
                      struct br_observation *workspace, struct br_joint_fit *fit)
{
    struct br_joint_fit one;
    problem->kind = kind;
    describe(problem, &c->attempt, &one);
    if (accepts(&one) && !c->widened) {
        for (int a = 0; a < BR_AXES; a++)
            if (br_joint_has(kind, a))
                widen_by_jackknife(problem, &c->attempt, a, workspace);
        c->widened = true;
        describe(problem, &c->attempt, &one);
    }
    if (!accepts(&one))
        return false;
    *fit = one;
    return true;
}

/* The kind with the least criterion that is not done; BR_JOINT_SPACE + 1: there is none left. */
static int next_best(const struct candidate *candidate, const bool *done)
{
    int best = BR_JOINT_SPACE + 1;
    for (int kind = BR_JOINT_BOTH; kind <= BR_JOINT_SPACE; kind++)
        if (!done[kind] && isfinite(candidate[kind].criterion) &&
            (best > BR_JOINT_SPACE || candidate[kind].criterion < candidate[best].criterion))
            best = kind;
    return best;
}

enum br_status br_joint_fit_solve(const struct br_observation *observation, size_t count,
                                  const struct br_observer *observer, struct br_joint_fit *fit,
                                  struct br_error *err)
{
    struct candidate candidate[BR_JOINT_SPACE + 1];
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
    problem.observer = observer;
    problem.room = room;
    problem.starved = &starved;
    for (int kind = BR_JOINT_BOTH; kind <= BR_JOINT_SPACE; kind++) {
        struct candidate *c = &candidate[kind];
        *c = (struct candidate){.attempt = {.sum = INFINITY}, .criterion = INFINITY};
        problem.kind = (enum br_joint_kind)kind;
        if (enough(&problem))
            c->attempt = best_attempt(&problem);
        if (isfinite(c->attempt.sum))
            c->criterion = br_akaike(c->attempt.sum, count, kinds[kind].count);
    }
    bool done[BR_JOINT_SPACE + 1] = {false}, taken = false;
    for (int kind; !taken && (kind = next_best(candidate, done)) <= BR_JOINT_SPACE;
         done[kind] = true)
        taken = take_kind(&problem, (enum br_joint_kind)kind, &candidate[kind], all_determined,
                          own + count, fit);
    if (!br_joint_describes(fit) && isfinite(candidate[BR_JOINT_BOTH].criterion))
        take_kind(&problem, BR_JOINT_BOTH, &candidate[BR_JOINT_BOTH], one_determined, own + count,
                  fit);
    free(own);
    free(room);
    if (br_observer_stops(observer))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    return starved ? br_no_memory(err, "the fits") : BR_OK;
}
