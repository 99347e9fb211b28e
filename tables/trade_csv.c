/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line a trial; a number that is not there is an empty field (RFC 4180). */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/trade_emitter.h"

static void field(FILE *out, const char *format, double value)
{
    fputc(',', out);
    if (isfinite(value))
        fprintf(out, format, value);
}

static const char trial_heading[] =
    "method,n,steps_or_levels,k,tolerance,relative_error,error,axial,bending,own_error,scale,"
    "seconds,set_up,march,repeats,steps,rejected,solves,iterations,set_ups,end,front,printed,"
    "failure\n";

static void print_trial(FILE *out, const struct br_trade *trade, size_t i)
{
    const struct br_trial *t = &trade->trial[i];
    const bool adaptive = br_contender_adaptive(t->contender);
    const struct br_counts *c = &t->cost.counts;
    fprintf(out, "%s,%zu,%zu", t->contender->name, t->at.n, t->at.steps);
    field(out, "%.10g", adaptive ? NAN : br_trade_step(trade, t));
    field(out, "%.10g", adaptive ? t->tolerance : NAN);
    field(out, "%.10g", br_trial_relative(t, 0, BR_PART_TOTAL));
    for (int part = 0; part < BR_PARTS; part++)
        field(out, "%.17g", t->error[0][part]);
    field(out, "%.10g", t->own[0]);
    field(out, "%.10g", t->scale[0]);
    field(out, "%.6g", br_trial_seconds(t));
    field(out, "%.6g", t->cost.set_up);
    field(out, "%.6g", t->cost.march);
    fprintf(out, ",%zu,%zu,%zu,%zu,%zu,%zu,%s,%d,%d", t->cost.repeats, c->steps, c->rejected,
            c->stages, c->iterations, c->set_ups, br_trial_end_name(t->end), trade->front[i],
            t->printed);
    fputc(',', out);
    br_quote(out, &br_for_csv, t->failure.message);
    fputc('\n', out);
}

enum br_status br_trade_csv(FILE *out, const struct br_trade_page *page, struct br_error *err)
{
    (void)err;
    fputs(trial_heading, out);
    for (size_t i = 0; i < page->trade->count; i++)
        print_trial(out, page->trade, i);
    return BR_OK;
}

/* The cheapest trials, those of every target. */
enum br_status br_trade_csv_summary(FILE *out, const struct br_trade_page *page, size_t pages,
                                    struct br_error *err)
{
    (void)err;
    fprintf(out, "scene,target,%s", trial_heading);
    for (size_t p = 0; p < pages; p++)
        for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
            const struct br_trade *trade = page[p].trade;
            br_quote(out, &br_for_csv, page[p].name);
            fprintf(out, ",%.0e,", br_trade_target(d));
            if (trade->best[d] < trade->count)
                print_trial(out, trade, trade->best[d]);
            else
                fputs(",,,,,,,,,,,,,,,,,,,,,,,\n", out);
        }
    return BR_OK;
}
