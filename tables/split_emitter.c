/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/split_emitter.h"

#include <math.h>

extern const struct br_split_emitter br_split_text, br_split_csv, br_split_markdown, br_split_latex,
    br_split_json;

const struct br_split_emitter *const br_split_emitters[] = {
    &br_split_text, &br_split_csv, &br_split_markdown, &br_split_latex, &br_split_json, NULL};

size_t br_split_lines(const struct br_split *split)
{
    return split->shares + 2;
}

static bool models(const struct br_split *split, enum br_field_kind kind)
{
    return kind == BR_AXIAL ? split->scene->axial.modelled : split->scene->bending.modelled;
}

static struct br_split_line sum_of(const struct br_split *split, size_t norm)
{
    struct br_split_line line = {.name = "sum", .share = split->sum[norm][BR_PART_TOTAL] > 0};
    for (int part = 0; part < BR_PARTS; part++)
        line.error[part] = split->sum[norm][part];
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        line.tip[kind] = split->tip_sum[kind];
    return line;
}

static struct br_split_line share_line(const struct br_split *split, const struct br_share *share,
                                       size_t norm)
{
    struct br_split_line line = {.name = share->source ? share->source->name : "whole",
                                 .none = share->none};
    for (int part = 0; part < BR_PARTS; part++) {
        line.error[part] = share->error[norm][part];
        line.floor[part] = share->floor[norm][part];
    }
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        line.tip[kind] = share->tip[kind];
    line.share = share->none || br_share_told(share, norm, BR_PART_TOTAL)
                     ? br_share_of_sum(split, share, norm, BR_PART_TOTAL)
                     : NAN;
    return line;
}

struct br_split_line br_split_line(const struct br_split *split, size_t norm, size_t i)
{
    const struct br_share *share = i < split->shares ? &split->share[i] : &split->whole;
    struct br_split_line line =
        i == split->shares ? sum_of(split, norm) : share_line(split, share, norm);
    if (!models(split, BR_AXIAL))
        line.error[BR_PART_AXIAL] = line.tip[BR_AXIAL] = NAN;
    if (!models(split, BR_BENDING))
        line.error[BR_PART_BENDING] = line.tip[BR_BENDING] = NAN;
    return line;
}

enum { TEXT = 32 };

const char *br_split_error_text(const struct br_split_line *line, enum br_part part, char *buffer)
{
    const double error = line->error[part], floor = line->floor[part];
    if (!isfinite(error))
        snprintf(buffer, TEXT, "-");
    else if (floor > 0 && !(error > floor))
        snprintf(buffer, TEXT, "< %.1e", floor);
    else
        snprintf(buffer, TEXT, "%.3e", error);
    return buffer;
}

const char *br_split_share_text(const struct br_split_line *line, char *buffer)
{
    if (!isfinite(line->share))
        snprintf(buffer, TEXT, "-");
    else if (line->share > 0 && line->share < 1e-3)
        snprintf(buffer, TEXT, "%.1e %%", 100 * line->share);
    else
        snprintf(buffer, TEXT, "%.1f %%", 100 * line->share);
    return buffer;
}

const char *br_split_tip_text(const struct br_split_line *line, enum br_field_kind kind,
                              char *buffer)
{
    if (isfinite(line->tip[kind]))
        snprintf(buffer, TEXT, "%+.3e", line->tip[kind]);
    else
        snprintf(buffer, TEXT, "-");
    return buffer;
}

const char *br_split_run_text(const struct br_split *s, char *buffer, size_t size)
{
    const struct br_method *m = &s->method;
    size_t used = (size_t)snprintf(buffer, size, "n = %zu, k = %.10g s: %s", s->at.n,
                                   br_time_step(s->scene, s->at.steps), m->scheme->name);
    if (m->scheme->adaptive && used < size)
        used += (size_t)snprintf(buffer + used, size - used, " with tolerance %g", m->tolerance);
    if (s->scene->contact.modelled && used < size)
        used += (size_t)snprintf(buffer + used, size - used, ", contact %s", m->contact->name);
    if (s->scene->friction.law != BR_FRICTIONLESS && used < size)
        used += (size_t)snprintf(buffer + used, size - used, ", friction %s", m->friction->name);
    if (m->axial_degree != 1 && used < size)
        used += (size_t)snprintf(buffer + used, size - used, ", axial elements of degree %d",
                                 m->axial_degree);
    if (used < size)
        snprintf(buffer + used, size - used, ", solver %s", m->solver->name);
    return buffer;
}

/* ---- sentences ---- */

static void say(const struct br_writer *w, const char *text)
{
    w->paragraph(w->self, text);
}

void br_split_say_chain(const struct br_split *s, const struct br_writer *w)
{
    char text[512];
    for (size_t m = 0; m < s->norms; m++)
        say(w, s->norm[m]->title);
    snprintf(
        text, sizeof text,
        "A part is the distance of two marches, or of a march from the solution (%s), of which "
        "the second has one source of error less, from the top down; so the parts add up to the "
        "whole, as functions, and at the tip (x = L, t = T, with signs, m) as numbers.",
        s->judge->name);
    say(w, text);
    say(w, "< is below the floor: cannot be told from round-off and from the errors of what it is "
           "measured by.");
    if (s->scene->remark)
        say(w, s->scene->remark);
}

static void say_sum(const struct br_split *s, size_t m, const struct br_writer *w)
{
    char text[256];
    const double whole = s->whole.error[m][BR_PART_TOTAL], sum = s->sum[m][BR_PART_TOTAL];
    snprintf(text, sizeof text,
             "The whole is %.3g of the sum of its parts%s (%s), and %.1e of the "
             "solution.",
             whole / sum, whole < 0.9 * sum ? ", which point against each other" : "",
             s->norm[m]->name, whole / s->scale[m]);
    say(w, text);
}

void br_split_say_run(const struct br_split *s, const struct br_writer *w)
{
    char text[256];
    for (size_t m = 0; m < s->norms; m++)
        say_sum(s, m, w);
    snprintf(
        text, sizeof text, "Without time error: %s. At the tip the parts add up but for %.1e m.%s",
        s->refined.name,
        fmax(fabs(s->tip_sum[BR_AXIAL] - s->whole.tip[BR_AXIAL]),
             fabs(s->tip_sum[BR_BENDING] - s->whole.tip[BR_BENDING])),
        s->method.scheme->adaptive ? " The part called time is what the tolerance leaves." : "");
    say(w, text);
    if (s->unstable)
        say(w, "The lagged contact is beyond its stability limit: its part is bounded chatter.");
}
