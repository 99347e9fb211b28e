/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/check_emitter.h"

#include <math.h>

extern const struct br_check_emitter br_check_emit_text, br_check_emit_junit, br_check_emit_json,
    br_check_emit_tap, br_check_emit_markdown;

const struct br_check_emitter *const br_check_emitters[] = {
    &br_check_emit_text, &br_check_emit_junit,    &br_check_emit_json,
    &br_check_emit_tap,  &br_check_emit_markdown, NULL,
};

const char *br_case_name(const struct br_case *c, char *buffer, size_t size)
{
    snprintf(buffer, size, "%s %s %s", br_verify_names[c->kind], c->expected.norm->name,
             br_part_names[c->expected.part]);
    return buffer;
}

const char *br_case_band(const struct br_case *c, char *buffer, size_t size)
{
    snprintf(buffer, size, "%g +- %g", c->expected.order, c->expected.tolerance);
    return buffer;
}

const char *br_case_range(const struct br_case *c, char *buffer, size_t size)
{
    const struct br_expectation *e = &c->expected;
    if (isfinite(e->floor))
        snprintf(buffer, size, "%g to %g", e->floor, e->ceiling);
    else if (isfinite(e->ceiling))
        snprintf(buffer, size, "at most %g", e->ceiling);
    else
        snprintf(buffer, size, "-");
    return buffer;
}

void br_case_lines(const struct br_case *c, void (*line)(void *self, const char *text), void *self)
{
    char text[1024];
    for (size_t i = 0; i < c->points; i++) {
        const struct br_point *p = &c->point[i];
        char against[64] = "the solution";
        if (p->against.n)
            snprintf(against, sizeof against, "n = %zu, k = T/%zu", p->against.n, p->against.steps);
        snprintf(text, sizeof text, "n = %zu, k = T/%zu against %s: error %.4e, constant %.4e%s%s",
                 p->at.n, p->at.steps, against, p->error, p->constant,
                 p->flag    ? ", left out: "
                 : !p->used ? ", coarser than those that count"
                            : "",
                 br_flag_name(p->flag));
        line(self, text);
    }
    if (c->reason[0])
        line(self, c->reason);
}

const char *br_check_summary(const struct br_check_page *page, char *buffer, size_t size)
{
    size_t orders = 0;
    for (size_t i = 0; i < page->count; i++)
        orders += page->checks[i].count;
    int used = snprintf(buffer, size, "%zu order%s in %zu scene%s: ", orders,
                        orders == 1 ? "" : "s", page->count, page->count == 1 ? "" : "s");
    for (int v = BR_PASS; v <= BR_INCONCLUSIVE; v++)
        used += snprintf(buffer + used, size - (size_t)used, "%zu %s%s",
                         br_check_tally(page->checks, page->count, (enum br_verdict)v),
                         br_verdict_names[v], v < BR_INCONCLUSIVE ? ", " : "");
    const struct br_check *first;
    const size_t failures = br_check_failures(page->checks, page->count, &first);
    if (failures)
        used += snprintf(buffer + used, size - (size_t)used, ", %zu cannot be verified", failures);
    if (page->skips)
        used += snprintf(buffer + used, size - (size_t)used, ", %zu skipped", page->skips);
    snprintf(buffer + used, size - (size_t)used, "%s; %.1f s",
             page->stopped ? "; stopped at the first scene that failed" : "", page->wall_seconds);
    return buffer;
}
