/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Claims on Figure 10: the norm over the coefficients of contact and friction. Stable: at both ends
 * of the sweep the norm settles, and between them it stays below the larger end. */
#include <math.h>
#include <stdio.h>

#include "study/paper/claims.h"

/* The contact at the new step, at the figures' h and k or at twice that. */
static double norm_at(const struct br_sweep *s, size_t i, bool doubled)
{
    return doubled ? s->point[i].doubled : s->point[i].most[1];
}

/* The larger relative change over the first and the last decade. */
static double unsettled(const struct br_sweep *s, size_t decade, bool doubled)
{
    const size_t last = s->points - 1;
    return br_larger(fabs(norm_at(s, decade, doubled) / norm_at(s, 0, doubled) - 1),
                     fabs(norm_at(s, last - decade, doubled) / norm_at(s, last, doubled) - 1));
}

static void measure_sweep(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_sweep *s = &p->sweep[which];
    const size_t last = s->points - 1;
    const double low = norm_at(s, 0, false), high = norm_at(s, last, false);
    double most = 0;
    for (size_t i = 0; i <= last; i++)
        most = br_larger(most, norm_at(s, i, false));
    f->value = unsettled(s, p->request.per_decade, false);
    f->error = fabs(f->value - unsettled(s, p->request.per_decade, true));
    f->agreement = br_below(f->value, f->error, 0.01);
    if (!(most <= 1.01 * fmax(low, high)))
        f->agreement = BR_DIFFERS;
    snprintf(
        f->note, sizeof f->note,
        "largest norm over time: %.4g m^(3/2) at %.3g N/m, %.4g at %.3g N/m, nowhere above %.4g",
        low, s->point[0].coefficient, high, s->point[last].coefficient, most);
}

static void measure_contact(const struct br_paper *p, struct br_finding *f)
{
    measure_sweep(p, BR_SWEEP_CONTACT, f);
}

static void measure_friction(const struct br_paper *p, struct br_finding *f)
{
    measure_sweep(p, BR_SWEEP_FRICTION, f);
}

/* The scheme as printed, far beyond its limit. */
static void measure_printed(const struct br_paper *p, struct br_finding *f)
{
    const struct br_sweep *s = &p->sweep[BR_SWEEP_CONTACT];
    const struct br_sweep_point *last = &s->point[s->points - 1], *before = last - 1;
    double limit = NAN;
    for (size_t i = s->points; i-- > 0;)
        if (s->point[i].unstable)
            limit = s->point[i].coefficient;
    f->value = last->most[0] / last->most[1];
    f->error = fabs(f->value - before->most[0] / before->most[1]); /* it is chaos */
    f->agreement = br_below(f->value, f->error, 2);
    snprintf(f->note, sizeof f->note,
             "the lagged contact amplifies from c_H = %.3g N/m on at this k, and its tip chatters: "
             "%.3g against %.3g m^(3/2) at c_H = %.3g N/m",
             limit, last->most[0], last->most[1], last->coefficient);
}

const struct br_claim br_claim_stable_contact = {
    .name = "stable-c_H",
    .section = "3.2.4",
    .figure = 10,
    .statement =
        "The stability of the solution is clearly observed, depending on c_H (contact force "
        "at the new step).",
    .measured = "largest relative change over the outermost decades",
    .unit = "1",
    .measure = measure_contact,
};

const struct br_claim br_claim_stable_printed = {
    .name = "stable-printed",
    .section = "3.2.4",
    .figure = 10,
    .statement = "The same by the scheme as printed, with the contact force of the step before.",
    .measured = "norm over that with the contact at the new step, at the largest c_H",
    .unit = "1",
    .measure = measure_printed,
};

const struct br_claim br_claim_stable_friction = {
    .name = "stable-c_V",
    .section = "3.2.4",
    .figure = 10,
    .statement = "The stability of the solution is clearly observed, depending on c_V.",
    .measured = "largest relative change over the outermost decades",
    .unit = "1",
    .measure = measure_friction,
};
