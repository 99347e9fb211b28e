/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Markdown for the summary page of a CI job: what failed first, all orders folded away below. */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/check_emitter.h"

static void number(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, " %.3e |", value);
    else
        fprintf(out, " - |");
}

static void print_case(FILE *out, const struct br_check *check, const struct br_case *c)
{
    char name[64], band[64], order[64], range[64];
    fprintf(out, "| ");
    br_quote(out, &br_for_markdown, check->scene->name);
    fprintf(out, " | %s | %s | %s |", br_case_name(c, name, sizeof name),
            br_case_band(c, band, sizeof band), br_order_text(&c->order, order, sizeof order));
    if (isfinite(c->margin))
        fprintf(out, " %+.3f |", c->margin);
    else
        fprintf(out, " - |");
    number(out, c->constant);
    fprintf(out, " %s |", br_case_range(c, range, sizeof range));
    fprintf(out, c->verdict == BR_PASS ? " %s |\n" : " **%s** |\n", br_verdict_names[c->verdict]);
}

static void print_table(FILE *out, const struct br_check_page *page)
{
    fputs(
        "\n| scene | study, norm, part | expected | observed order | margin | constant | its range | "
        "verdict |\n|---|---|---|---|---:|---:|---|---|\n",
        out);
    for (size_t i = 0; i < page->count; i++)
        for (size_t c = 0; c < page->checks[i].count; c++)
            print_case(out, &page->checks[i], &page->checks[i].cases[c]);
    for (size_t i = 0; i < page->skips; i++) {
        fputs("| ", out);
        br_quote(out, &br_for_markdown, page->skipped[i].scene);
        fputs(" | skipped: ", out);
        br_quote(out, &br_for_markdown, page->skipped[i].reason);
        fputs(" | | | | | | |\n", out);
    }
}

static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("  - ", out);
    br_quote(out, &br_for_markdown, text);
    fputc('\n', out);
}

static void print_reasons(FILE *out, const struct br_check_page *page)
{
    for (size_t i = 0; i < page->count; i++)
        if (page->checks[i].failure.status) {
            fprintf(out, "- **cannot be verified** ");
            br_quote(out, &br_for_markdown, page->checks[i].failure.message);
            fputc('\n', out);
        }
    for (size_t i = 0; i < page->count; i++)
        for (size_t c = 0; c < page->checks[i].count; c++) {
            const struct br_case *it = &page->checks[i].cases[c];
            char name[64];
            if (it->verdict == BR_PASS)
                continue;
            fprintf(out, "- **%s** ", br_verdict_names[it->verdict]);
            br_quote(out, &br_for_markdown, page->checks[i].scene->name);
            fprintf(out, ", %s\n", br_case_name(it, name, sizeof name));
            br_case_lines(it, item, out);
        }
}

static void print_comparison(FILE *out, const struct br_comparison *c)
{
    fprintf(out,
            "\nAgainst the earlier check: %zu serious, %zu warnings, %zu notes, %zu the same\n",
            c->tally[BR_SERIOUS], c->tally[BR_WARNING], c->tally[BR_NOTE], c->tally[BR_SAME]);
    if (c->count)
        fputs("\n| severity | what | before | now | |\n|---|---|---:|---|---|\n", out);
    for (size_t i = 0; i < c->count; i++) {
        const struct br_difference *d = &c->difference[i];
        fprintf(out, "| %s | ", br_severity_names[d->severity]);
        br_quote(out, &br_for_markdown, d->subject);
        fputs(" |", out);
        number(out, d->before);
        number(out, d->now);
        fputc(' ', out);
        br_quote(out, &br_for_markdown, d->remark);
        fputs(" |\n", out);
    }
}

static enum br_status emit(FILE *out, const struct br_check_page *page, struct br_error *err)
{
    (void)err;
    char summary[256];
    fprintf(out, "## Orders of convergence\n\n%s\n\n",
            br_check_summary(page, summary, sizeof summary));
    print_reasons(out, page);
    fputs("\n<details><summary>All orders</summary>\n", out);
    print_table(out, page);
    fputs("\n</details>\n", out);
    if (page->comparison)
        print_comparison(out, page->comparison);
    return BR_OK;
}

const struct br_check_emitter br_check_emit_markdown = {
    .name = "markdown",
    .title = "a summary for the page of a CI job",
    .emit = emit,
};
