/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table for a terminal and its .txt file. */
#include <math.h>
#include <string.h>

#include "tables/emitter.h"
#include "tables/sentences.h"

static char flag_letter(enum br_flag flag)
{
    static const char letters[] = {' ', 'R', 'F', 'X', 'U'};
    return letters[flag];
}

static void heading(FILE *out, const struct br_report *r, const char *title)
{
    const struct br_study *s = r->study;
    fprintf(out, "\n%-12s", title);
    for (size_t j = 0; j < s->k_count; j++) {
        char text[32];
        snprintf(text, sizeof text, "k = %g", br_time_step(s->scene, s->steps[j]));
        fprintf(out, "%12s", text);
    }
}

static void print_number(FILE *out, double value, const char *format, char mark)
{
    char text[32] = "-";
    if (isfinite(value))
        snprintf(text, sizeof text, format, value);
    fprintf(out, "%11s%c", text, mark);
}

/* The errors of one part, with the slopes of rows and columns. */
static void print_errors(FILE *out, const struct br_report *r, enum br_part part)
{
    const struct br_study *s = br_report_fitted(r);
    char buffer[64];
    heading(out, r, br_part_names[part]);
    fprintf(out, "   slope in k [95 %%]\n");
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "n = %-8zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            print_number(out, c->error[part], "%.3e", flag_letter(c->flag[part]));
        }
        fprintf(out, "   %s\n", br_order_text(&r->fits[part].by_n[i].order, buffer, sizeof buffer));
    }
    fprintf(out, "slope in h  ");
    for (size_t j = 0; j < s->k_count; j++)
        print_number(out, r->fits[part].by_k[j].order.value, "%.2f", ' ');
    fprintf(out, "\n+- (95 %%)   ");
    for (size_t j = 0; j < s->k_count; j++) {
        const struct br_estimate *e = &r->fits[part].by_k[j].order;
        print_number(out, (e->high - e->low) / 2, "%.2f", ' ');
    }
    fputc('\n', out);
}

/* The total against the reference that is not fitted. */
static void print_beside(FILE *out, const struct br_report *r)
{
    const struct br_study *s = r->study;
    heading(out, r, s->judge->name);
    fputc('\n', out);
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "n = %-8zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            print_number(out, c->error[BR_PART_TOTAL], "%.3e", flag_letter(c->flag[BR_PART_TOTAL]));
        }
        fputc('\n', out);
    }
}

static void print_printed(FILE *out, const struct br_report *r)
{
    const struct br_study *s = r->study;
    heading(out, r, "printed");
    fputc('\n', out);
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "n = %-8zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++)
            print_number(out, r->printed[i * s->k_count + j], "%.3e", ' ');
        fputc('\n', out);
    }
    heading(out, r, "ours/printed");
    fputc('\n', out);
    for (size_t i = 0; i < s->n_count; i++) {
        fprintf(out, "n = %-8zu", s->n[i]);
        for (size_t j = 0; j < s->k_count; j++)
            print_number(out, br_report_ratio(r, i * s->k_count + j), "%.3f", ' ');
        fputc('\n', out);
    }
}

static enum br_status emit(FILE *out, const struct br_report *r, const struct br_provenance *p,
                           struct br_error *err)
{
    (void)p, (void)err;
    const struct br_writer w = {br_print_wrapped, out};
    br_print_caption(out, r->caption);
    br_say_method(r, &w);
    for (int part = 0; part < BR_PARTS; part++)
        if (br_part_shown(r, (enum br_part)part))
            print_errors(out, r, (enum br_part)part);
    if (r->exact)
        print_beside(out, r);
    if (r->printed)
        print_printed(out, r);
    fputc('\n', out);
    br_say_flags(r, &w);
    fputc('\n', out);
    br_say_events(r, &w);
    if (br_has_events(r))
        fputc('\n', out);
    br_say_orders(r, &w);
    if (r->printed)
        fputc('\n', out);
    br_say_printed(r, &w);
    return BR_OK;
}

const struct br_emitter br_emit_text = {"text", ".txt", "for the terminal", emit};
