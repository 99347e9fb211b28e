/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/line/laws.h"

#include <math.h>

const char *br_law_text(enum br_law law)
{
    static const char *const texts[] = {
#define X(name, text) [name] = text,
        BR_LAW_LIST(X)
#undef X
    };
    return texts[law];
}

bool br_law_is_floor(enum br_law law)
{
    return law == BR_LAW_FLOOR || law == BR_LAW_FLOOR_SQUARES || law == BR_LAW_OFFSET;
}

BR_PRIOR_CONST struct br_priors br_priors = {
#define X(name, value, off, why) .name = value,
    BR_PRIOR_LIST(X)
#undef X
};

#define NEXT_TERM(s, share, why)                            \
    {BR_LAW_NEXT, s, 1e-4, 0.1, 0.2 * (share), 0, why},     \
        {BR_LAW_LOWER, s, 0.1, 3, 0.05 * (share), 0, why},  \
    {                                                       \
        BR_LAW_CANCEL, s, 1e-4, 0.99, 0.2 * (share), 0, why \
    }
#define ROW(law, s, low, high, prior, curve, why) \
    {                                             \
        law, s, low, high, prior, curve, why      \
    }

BR_PRIOR_CONST struct br_family br_families[BR_FAMILIES] = {
    NEXT_TERM(0.5, 0.1, "half powers: singular data, boundary layers of time steps"),
    NEXT_TERM(1, 0.4, "the usual next power"),
    NEXT_TERM(1.5, 0.08, "half powers"),
    NEXT_TERM(2, 0.3, "symmetric schemes"),
    NEXT_TERM(3, 0.06, "rare"),
    NEXT_TERM(4, 0.06, "symmetric schemes of order 4"),
    ROW(BR_LAW_NEXT, 1, 1e-3, 0.1, 0.02, 2, "two next terms: h and h^2"),
    ROW(BR_LAW_CANCEL, 1, 1e-3, 0.1, 0.02, 2, "the same with the other sign"),
    ROW(BR_LAW_NEXT, 0.5, 1e-3, 0.1, 0.01, 1, "h^1/2 and h"),
    ROW(BR_LAW_CANCEL, 0.5, 1e-3, 0.1, 0.01, 1, "the same with the other sign"),
    ROW(BR_LAW_LOCKING, 1, 3e-4, 1, 0.004, 0, "thin plates, layers not resolved"),
    ROW(BR_LAW_LOCKING, 0.5, 3e-4, 1, 0.002, 0, "layers that begin with the order 1/2"),
    ROW(BR_LAW_LOCKING, 1.5, 3e-5, 1, 0.002, 0, "the same"),
    ROW(BR_LAW_LOCKING, 2, 1e-5, 1, 0.004, 0, "the same"),
    ROW(BR_LAW_SQUARES, 1. / 3, 0.03, 3, 0.005, 0,
        "two errors in one norm: a corner of 270 degrees"),
    ROW(BR_LAW_SQUARES, 2. / 3, 0.03, 3, 0.005, 0, "the same"),
    ROW(BR_LAW_SQUARES, 1, 0.03, 3, 0.005, 0, "two neighbouring powers"),
    ROW(BR_LAW_LOGARITHM, 1, 1.5, 30, 0.005, 0, "maximum norms, weak singularities"),
    ROW(BR_LAW_LOGARITHM, 0.5, 1.5, 30, 0.005, 0, "the same in a norm of squares"),
    ROW(BR_LAW_LOGARITHM, 1.5, 1.5, 30, 0.003, 0, "other powers of it"),
    ROW(BR_LAW_LOGARITHM, 2, 1.5, 30, 0.003, 0, "the same"),
    ROW(BR_LAW_LOGARITHM, -1, 1.5, 30, 0.003, 0, "the same: errors below the power"),
    ROW(BR_LAW_LOGARITHM, -2, 1.5, 30, 0.003, 0, "differences of values like 1/log n"),
    ROW(BR_LAW_LOGARITHM, -3, 1.5, 30, 0.003, 0, "the same, of 1/log^2 n"),
    ROW(BR_LAW_FLOOR, 0, 0.01, 0.9999, 0.05, 0, "the error of the reference, or of a tolerance"),
    ROW(BR_LAW_FLOOR_SQUARES, 0, 0.1, 0.9999, 0.02, 0, "the same in a norm of squares"),
    ROW(BR_LAW_FLOOR, 0, 0.01, 0.9999, 0.001, 1, "the same with a next term h"),
    ROW(BR_LAW_FLOOR, 0, 0.01, 0.9999, 0.001, 2, "the same with a next term h^2"),
    ROW(BR_LAW_OFFSET, 0, 0.01, 8, 0.03, 0, "a reference that is itself computed"),
    ROW(BR_LAW_OFFSET, 0, 0.01, 8, 0.005, 1, "the same with a next term"),
};

static struct br_law_bend bend_by_logarithm(double s, double a, const struct br_law_place *at)
{
    const double t = a - at->log_z, u = t + at->finer;
    const double left = pow(t, s) - at->lost * pow(u, s);
    const double slope = s * a * (pow(t, s - 1) - at->lost * pow(u, s - 1)) / left;
    return (struct br_law_bend){.correction =
                                    t > 0.1 && left > 0 ? log(left / (1 - at->lost)) : (double)NAN,
                                .weight = 1,
                                .change = 0.05,
                                .slope = fabs(slope)};
}

struct br_law_bend br_law_bend(const struct br_family *f, double parameter,
                               const struct br_law_place *at)
{
    struct br_law_bend b = {.weight = 1};
    double t = parameter * at->power;
    switch (f->law) {
    case BR_LAW_NEXT:
    case BR_LAW_LOWER:
        b.correction = log1p(t);
        b.slope = b.change = t / (1 + t);
        break;
    case BR_LAW_LOCKING:
        b.correction = -log1p(t);
        b.slope = b.change = t / (1 + t);
        break;
    case BR_LAW_CANCEL: /* a difference of two terms scatters more, relative to itself, than each */
        b.correction = log(fabs(1 - t));
        b.weight = fmin(1, (1 - t) * (1 - t) / (1 + t * t)) + 1e-12;
        b.change = fmin(1, t);
        b.slope = t / fabs(1 - t);
        b.density = true;
        break;
    case BR_LAW_SQUARES:
        b.correction = 0.5 * log1p(t * t);
        b.slope = b.change = t * t / (1 + t * t);
        break;
    case BR_LAW_LOGARITHM:
        return bend_by_logarithm(f->s, parameter, at);
    case BR_LAW_FLOOR:
    case BR_LAW_OFFSET: /* log(e - F) = log e + log(1 - F/e) */
        t = (f->law == BR_LAW_OFFSET ? -parameter : parameter) * at->finest;
        b.correction = t < 1 ? -log1p(-t) : (double)NAN;
        b.weight = (1 - t) * (1 - t);
        b.change = fabs(t) / (1 + fabs(t));
        b.slope = fabs(t) / (1 - t);
        break;
    case BR_LAW_FLOOR_SQUARES:
        t = parameter * at->finest;
        b.correction = t < 1 ? -0.5 * log1p(-t * t) : (double)NAN;
        b.weight = (1 - t * t) * (1 - t * t);
        b.change = t * t;
        b.slope = t * t / (1 - t * t);
        break;
    default:
        break;
    }
    return b;
}

double br_law_log_prior(const struct br_family *f, double parameter, double z)
{
    const bool crosses = f->law == BR_LAW_CANCEL && parameter * pow(z, f->s) > 0.8;
    return crosses ? log(br_priors.passes_zero) : 0;
}
