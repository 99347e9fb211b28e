/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What section 3.2 of the paper says, as far as it can be checked: a registry. Each claim measures
 * its value from the marches of study/paper/paper.h, and from the exact solution where that knows
 * it.
 *
 * To add a claim: a function and a row in claims.c. */
#ifndef BR_STUDY_PAPER_CLAIMS_H
#define BR_STUDY_PAPER_CLAIMS_H

#include "study/paper/paper.h"

enum br_agreement {
    BR_AGREES,
    BR_DIFFERS,
    BR_UNDECIDED, /* the error bar spans both, or a value is not a number */
};
const char *br_agreement_name(enum br_agreement agreement); /* "agree", "differ", "undecided" */

/* What was found. NaN: not there. */
struct br_finding {
    double value;   /* of the scheme at the figures' h and k */
    double exact;   /* of the continuous problem */
    double error;   /* bar of `value`: |value - exact| and the exact one's own error, or, where
                       there is no exact one, the distance to a second resolution */
    double printed; /* where the paper has a number */
    enum br_agreement agreement;
    char note[240]; /* why, with figures; plain ASCII; may be empty */
};

struct br_claim {
    const char *name;      /* one word */
    const char *section;   /* of the paper */
    int figure;            /* that shows it; 0: none */
    const char *statement; /* what the paper says */
    const char *measured;  /* what `value` is */
    const char *unit;      /* "1" where there is none */
    void (*measure)(const struct br_paper *paper, struct br_finding *finding);
};

/* Ends with a row whose name is NULL; at most BR_MOST_CLAIMS. */
enum { BR_MOST_CLAIMS = 32 };
extern const struct br_claim br_claims[];

/* Measures one claim; a value that is no number leaves it undecided. */
struct br_finding br_claim_measure(const struct br_claim *claim, const struct br_paper *paper);

/* Inside: agree where value (and its bar) is below or above a limit, undecided where that spans it.
 */
enum br_agreement br_below(double value, double error, double limit);
enum br_agreement br_above(double value, double error, double limit);

/* Agrees where a printed number lies within half of its last digit and the bar of the exact value,
 * or of the scheme's where that is not known. */
enum br_agreement br_same(const struct br_finding *finding, double half_digit);

#endif
