/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GitHub-flavoured Markdown. */
#include "study/scene/quote.h"
#include "tables/split_emitter.h"

static void item(void *self, const char *text)
{
    FILE *out = self;
    fputs("- ", out);
    br_quote(out, &br_for_markdown, text);
    fputc('\n', out);
}

static void cell(FILE *out, const char *text)
{
    fputc(' ', out);
    br_quote(out, &br_for_markdown, text);
    fputs(" |", out);
}

static void print_line(FILE *out, const struct br_split *s, size_t norm, size_t i)
{
    const struct br_split_line line = br_split_line(s, norm, i);
    char text[32];
    fprintf(out, "| %s |", line.name);
    for (int part = 0; part < BR_PARTS; part++)
        cell(out, line.none ? "" : br_split_error_text(&line, (enum br_part)part, text));
    cell(out, line.none || i > s->shares ? "" : br_split_share_text(&line, text));
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        cell(out, line.none ? "" : br_split_tip_text(&line, (enum br_field_kind)kind, text));
    cell(out, line.none ? line.none : "");
    fputc('\n', out);
}

static void print_run(FILE *out, const struct br_split *s)
{
    const struct br_writer w = {item, out};
    char text[256];
    fputs("\n## ", out);
    br_quote(out, &br_for_markdown, br_split_run_text(s, text, sizeof text));
    fputc('\n', out);
    for (size_t m = 0; m < s->norms; m++) {
        fprintf(out,
                "\n| %s, %s | total | axial | bending | of the sum | tip axial, m | tip bending, m "
                "| none, since |\n|---|---:|---:|---:|---:|---:|---:|---|\n",
                s->norm[m]->name, s->norm[m]->unit);
        for (size_t i = 0; i < br_split_lines(s); i++)
            print_line(out, s, m, i);
    }
    fputc('\n', out);
    br_split_say_run(s, &w);
}

static enum br_status emit(FILE *out, const struct br_split_page *page, struct br_error *err)
{
    (void)err;
    const struct br_split *first = page->split;
    const struct br_writer w = {item, out};
    fputs("# Where the error comes from: ", out);
    br_quote(out, &br_for_markdown, first->scene->title);
    fputs("\n\n", out);
    br_split_say_chain(first, &w);
    for (size_t i = 0; i < page->count; i++)
        print_run(out, &page->split[i]);
    fprintf(out, "\nbeamrate %s (%s), %s\n", page->provenance->version, page->provenance->commit,
            page->provenance->date);
    return BR_OK;
}

const struct br_split_emitter br_split_markdown = {"markdown", ".md", "GitHub-flavoured Markdown",
                                                   emit};
