/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The claims of section 3.2 with what was found: one const record a format. */
#ifndef BR_TABLES_CLAIMS_EMITTER_H
#define BR_TABLES_CLAIMS_EMITTER_H

#include "study/paper/claims.h"
#include "tables/emitter.h"

struct br_claims_page {
    const struct br_finding *finding;       /* in the order of br_claims; borrowed */
    size_t n, per_second;                   /* h = L/n; k = 1 s / per_second */
    const struct br_provenance *provenance; /* without a scene */
};

struct br_claims_emitter {
    const char *name;
    const char *extension; /* of its file, with the dot; NULL: the terminal's */
    void (*emit)(FILE *out, const struct br_claims_page *page); /* write errors stay in `out` */
};

/* NULL-terminated; the first is the terminal's. */
extern const struct br_claims_emitter *const br_claims_emitters[];

/* "0.7999 +- 2e-3 s", "-" where the number is not there; buffer: at least 64 bytes. */
const char *br_claim_value(double value, double error, const char *unit, char *buffer, size_t size);

/* "3 differ, 13 agree, 0 undecided" */
const char *br_claims_summary(const struct br_claims_page *page, char *buffer, size_t size);

#endif
