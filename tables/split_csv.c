/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line a part, norm and run; a number that is not there is an empty field (RFC 4180). */
#include <math.h>

#include "tables/split_emitter.h"

static void field(FILE *out, double value)
{
    fputc(',', out);
    if (isfinite(value))
        fprintf(out, "%.17g", value);
}

static void print_line(FILE *out, const struct br_split *s, size_t norm, size_t i)
{
    const struct br_split_line line = br_split_line(s, norm, i);
    const struct br_method *m = &s->method;
    fprintf(out, "%zu,%.10g,%s,%s,%s,%s,%s,%s,%d", s->at.n, br_time_step(s->scene, s->at.steps),
            m->scheme->name, m->contact->name, m->friction->name, m->solver->name,
            s->norm[norm]->name, line.name, line.none == NULL);
    for (int part = 0; part < BR_PARTS; part++)
        field(out, line.error[part]);
    for (int part = 0; part < BR_PARTS; part++)
        field(out, line.none || i == s->shares ? NAN : line.floor[part]);
    field(out, i > s->shares ? NAN : line.share);
    field(out, line.tip[BR_AXIAL]);
    field(out, line.tip[BR_BENDING]);
    fputc('\n', out);
}

static enum br_status emit(FILE *out, const struct br_split_page *page, struct br_error *err)
{
    (void)err;
    fputs("n,k,scheme,contact,friction,solver,norm,part,applies,error,axial,bending,floor,"
          "axial_floor,bending_floor,share,axial_tip,bending_tip\n",
          out);
    for (size_t r = 0; r < page->count; r++)
        for (size_t m = 0; m < page->split[r].norms; m++)
            for (size_t i = 0; i < br_split_lines(&page->split[r]); i++)
                print_line(out, &page->split[r], m, i);
    return BR_OK;
}

const struct br_split_emitter br_split_csv = {"csv", ".csv", "one line a part", emit};
