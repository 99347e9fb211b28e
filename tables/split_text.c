/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table for a terminal and its .txt file. */
#include <math.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/split_emitter.h"

/* The share of the sum as a bar of up to 20 characters. */
static void print_bar(FILE *out, const struct br_split_line *line)
{
    for (double rest = 20 * line->share; rest >= 0.5; rest--)
        fputc('#', out);
}

static void print_line(FILE *out, const struct br_split *s, size_t norm, size_t i)
{
    const struct br_split_line line = br_split_line(s, norm, i);
    char text[32];
    if (line.none) {
        fprintf(out, "%-10s none: %s\n", line.name, line.none);
        return;
    }
    fprintf(out, "%-10s", line.name);
    for (int part = 0; part < BR_PARTS; part++)
        fprintf(out, " %11s", br_split_error_text(&line, (enum br_part)part, text));
    fprintf(out, " %11s", i <= s->shares ? br_split_share_text(&line, text) : "");
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        fprintf(out, " %11s", br_split_tip_text(&line, (enum br_field_kind)kind, text));
    if (i < s->shares && line.share >= 0.025)
        fputs("  ", out), print_bar(out, &line);
    fputc('\n', out);
}

static void print_run(FILE *out, const struct br_split *s)
{
    const struct br_writer w = {br_print_wrapped, out};
    char text[256];
    fprintf(out, "%s\n", br_split_run_text(s, text, sizeof text));
    for (size_t m = 0; m < s->norms; m++) {
        fprintf(out, "\n%-10s %11s %11s %11s %11s %11s %11s\n", s->norm[m]->name, "total", "axial",
                "bending", "of the sum", "tip axial", "tip bending");
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
    const struct br_writer w = {br_print_wrapped, out};
    fputs("Where the error comes from: ", out);
    br_quote(out, &br_for_text, first->scene->title);
    fputc('\n', out);
    br_split_say_chain(first, &w);
    for (size_t i = 0; i < page->count; i++) {
        fputc('\n', out);
        print_run(out, &page->split[i]);
    }
    return BR_OK;
}

const struct br_split_emitter br_split_text = {"text", ".txt", "the table of the terminal", emit};
