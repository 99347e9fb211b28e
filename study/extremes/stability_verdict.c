/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether marches do what the stability of the contact says. */
#include <math.h>

#include "study/extremes/stability.h"

static enum br_status check_planes(const struct br_stability *s, struct br_error *err)
{
    const double most = br_stability_tolerance;
    if (!(s->limit_error <= most))
        return br_fail(err, BR_VERDICT,
                       "a measured stability limit is %.3g off the predicted one, relative, "
                       "expected at most %g",
                       s->limit_error, most);
    if (!(s->growth_error <= most))
        return br_fail(err, BR_VERDICT,
                       "a measured growth is %.3g off the predicted one, relative, expected at "
                       "most %g",
                       s->growth_error, most);
    if (!(s->excess <= most))
        return br_fail(err, BR_VERDICT,
                       "a step within the limit has an eigenvalue that is %.3g outside the unit "
                       "circle, expected at most %g",
                       s->excess, most);
    return BR_OK;
}

/* Ten steps of a hundred relaxation times leave 1e-8 of the way to the rest with bdf3, and less
 * with all others. */
static const double rest = 1e-7;

static enum br_status check_scheme(const struct br_stability_scheme *c, struct br_error *err)
{
    if (c->failed || c->uncertain)
        return br_fail(err, BR_VERDICT,
                       "scheme %s with contact at u_n: %zu of %zu marches failed, %zu are beyond "
                       "their certificate's limits",
                       c->scheme->name, c->failed, c->marches, c->uncertain);
    if (!(c->force <= rest && c->depth <= rest))
        return br_fail(err, BR_VERDICT,
                       "scheme %s with contact at u_n: a pressed rod's contact force is %.3g off, "
                       "its penetration %.3g, expected at most %g",
                       c->scheme->name, c->force, c->depth, rest);
    return BR_OK;
}

/* Within the limit a tip comes to rest; beyond it, it opens again and again, or swings. */
static enum br_status check_tip(const struct br_stability_tip *t, struct br_error *err)
{
    if (!isfinite(t->farthest) || !isfinite(t->swing))
        return br_fail(err, BR_VERDICT, "at %g of the limit a pressed tip is nowhere", t->share);
    if (t->share < 1 && !(t->swing <= 1e-11 && t->opened == 0))
        return br_fail(err, BR_VERDICT,
                       "at %g of the limit a pressed tip does not rest: it swings by %.3g of the "
                       "free displacement and opened %zu times",
                       t->share, t->swing, t->opened);
    if (t->share > 1 && !(t->opened > 0))
        return br_fail(err, BR_VERDICT, "at %g of the limit a pressed tip does not chatter",
                       t->share);
    return BR_OK;
}

/* Where no energy can be gained. */
static enum br_status check_bounce(const struct br_stability_bounce *b, struct br_error *err)
{
    if (b->bouncing <= 1 && !(b->energy <= 1 + 1e-12))
        return br_fail(err, BR_VERDICT,
                       "a bouncing rod within %g of the limit without inertia has %.15g times its "
                       "energy",
                       b->bouncing, b->energy);
    return BR_OK;
}

enum br_status br_stability_verdict(const struct br_stability *s, struct br_error *err)
{
    enum br_status status = check_planes(s, err);
    for (size_t i = 0; i < s->schemes && !status; i++)
        status = check_scheme(&s->scheme[i], err);
    for (size_t i = 0; i < BR_STABILITY_TIPS && !status; i++)
        status = check_tip(&s->tip[i], err);
    for (size_t i = 0; i < BR_STABILITY_BOUNCES && !status; i++)
        status = check_bounce(&s->bounce[i], err);
    return status;
}
