/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/claims_emitter.h"

#include <math.h>
#include <string.h>

extern const struct br_claims_emitter br_claims_text, br_claims_csv, br_claims_markdown,
    br_claims_latex;

const struct br_claims_emitter *const br_claims_emitters[] = {
    &br_claims_text, &br_claims_csv, &br_claims_markdown, &br_claims_latex, NULL};

const char *br_claim_value(double value, double error, const char *unit, char *buffer, size_t size)
{
    if (!isfinite(value)) {
        snprintf(buffer, size, "-");
        return buffer;
    }
    size_t used = (size_t)snprintf(buffer, size, "%.6g", value);
    if (isfinite(error))
        used += (size_t)snprintf(buffer + used, size - used, " +- %.2g", error);
    if (strcmp(unit, "1") != 0)
        snprintf(buffer + used, size - used, " %s", unit);
    return buffer;
}

const char *br_claims_summary(const struct br_claims_page *page, char *buffer, size_t size)
{
    size_t count[3] = {0};
    for (size_t i = 0; br_claims[i]; i++)
        count[page->finding[i].agreement]++;
    snprintf(buffer, size, "%zu agree, %zu differ, %zu undecided", count[BR_AGREES],
             count[BR_DIFFERS], count[BR_UNDECIDED]);
    return buffer;
}
