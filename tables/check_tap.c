/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Test Anything Protocol, version 13: a test an order, a diagnostic block below it. */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/check_emitter.h"

/* A number that is not there is null. */
static void print_number(FILE *out, const char *key, double value)
{
    if (isfinite(value))
        fprintf(out, "  %s: %.12g\n", key, value);
    else
        fprintf(out, "  %s: null\n", key);
}

static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("    - ", out);
    br_quote(out, &br_for_yaml, text);
    fputc('\n', out);
}

static void print_case(FILE *out, size_t number, const struct br_check *check,
                       const struct br_case *c)
{
    char name[64], band[64], order[64];
    fprintf(out, "%s %zu - ", c->verdict == BR_PASS ? "ok" : "not ok", number);
    br_quote(out, &br_for_tap, check->scene->name);
    fprintf(out, " %s: %s, expected %s: %s\n  ---\n", br_case_name(c, name, sizeof name),
            br_order_text(&c->order, order, sizeof order), br_case_band(c, band, sizeof band),
            br_verdict_names[c->verdict]);
    print_number(out, "order", c->order.value);
    print_number(out, "low", c->order.low);
    print_number(out, "high", c->order.high);
    print_number(out, "tolerance", c->expected.tolerance);
    print_number(out, "margin", c->margin);
    print_number(out, "constant", c->constant);
    print_number(out, "floor", c->expected.floor);
    print_number(out, "ceiling", c->expected.ceiling);
    fprintf(out, "  points:\n");
    br_case_lines(c, item, out);
    fprintf(out, "  ...\n");
}

static enum br_status emit(FILE *out, const struct br_check_page *page, struct br_error *err)
{
    (void)err;
    size_t number = 0, all = page->skips;
    for (size_t i = 0; i < page->count; i++)
        all += page->checks[i].count + (page->checks[i].failure.status != 0);
    fprintf(out, "TAP version 13\n1..%zu\n", all);
    for (size_t i = 0; i < page->count; i++)
        if (page->checks[i].failure.status) {
            fprintf(out, "not ok %zu - ", ++number);
            br_quote(out, &br_for_tap, page->checks[i].scene->name);
            fprintf(out, "\n  ---\n  message: ");
            br_quote(out, &br_for_yaml, page->checks[i].failure.message);
            fprintf(out, "\n  ...\n");
        }
    for (size_t i = 0; i < page->count; i++)
        for (size_t c = 0; c < page->checks[i].count; c++)
            print_case(out, ++number, &page->checks[i], &page->checks[i].cases[c]);
    for (size_t i = 0; i < page->skips; i++) {
        fprintf(out, "ok %zu - ", ++number);
        br_quote(out, &br_for_tap, page->skipped[i].scene);
        fprintf(out, " # SKIP ");
        br_quote(out, &br_for_tap, page->skipped[i].reason);
        fputc('\n', out);
    }
    char summary[256];
    fprintf(out, "# %s\n", br_check_summary(page, summary, sizeof summary));
    return BR_OK;
}

const struct br_check_emitter br_check_emit_tap = {
    .name = "tap",
    .title = "the Test Anything Protocol",
    .emit = emit,
};
