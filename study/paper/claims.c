/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/paper/claims.h"

#include <math.h>
#include <stdio.h>

extern const struct br_claim br_claim_clamped, br_claim_below, br_claim_stuck, br_claim_converges1,
    br_claim_table1, br_claim_converges2, br_claim_table2, br_claim_moves, br_claim_at_bound,
    br_claim_decouples, br_claim_release, br_claim_reaches, br_claim_penetrates,
    br_claim_stable_contact, br_claim_stable_printed, br_claim_stable_friction;

const struct br_claim *const br_claims[] = {
    &br_claim_converges1,
    &br_claim_table1,
    &br_claim_clamped,
    &br_claim_below,
    &br_claim_stuck,
    &br_claim_converges2,
    &br_claim_table2,
    &br_claim_moves,
    &br_claim_at_bound,
    &br_claim_decouples,
    &br_claim_release,
    &br_claim_reaches,
    &br_claim_penetrates,
    &br_claim_stable_contact,
    &br_claim_stable_printed,
    &br_claim_stable_friction,
    NULL,
};

const char *br_agreement_name(enum br_agreement agreement)
{
    static const char *const names[] = {"agree", "differ", "undecided"};
    return names[agreement];
}

struct br_finding br_claim_measure(const struct br_claim *claim, const struct br_paper *paper)
{
    struct br_finding f = {
        .value = NAN, .exact = NAN, .error = NAN, .printed = NAN, .agreement = BR_UNDECIDED};
    claim->measure(paper, &f);
    if (!(isfinite(f.value) && f.error >= 0))
        f.agreement = BR_UNDECIDED;
    return f;
}

enum br_agreement br_below(double value, double error, double limit)
{
    if (value + error < limit)
        return BR_AGREES;
    return value - error >= limit ? BR_DIFFERS : BR_UNDECIDED;
}

enum br_agreement br_above(double value, double error, double limit)
{
    return br_below(-value, error, -limit);
}

enum br_agreement br_same(const struct br_finding *f, double half_digit)
{
    const double ours = isnan(f->exact) ? f->value : f->exact;
    const double bar = isnan(f->exact) ? f->error : 0;
    const double away = fabs(ours - f->printed);
    if (!(away >= 0 && bar >= 0))
        return BR_UNDECIDED;
    return away <= half_digit + bar ? BR_AGREES : BR_DIFFERS;
}

double br_larger(double a, double b)
{
    return isnan(a) || isnan(b) ? NAN : fmax(a, b);
}

double br_smaller(double a, double b)
{
    return -br_larger(-a, -b);
}
