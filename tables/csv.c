/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line a cell; a number that is not there is an empty field (RFC 4180). */
#include <math.h>

#include "tables/emitter.h"

static void field(FILE *out, const char *format, double value)
{
    if (isfinite(value))
        fprintf(out, format, value);
}

static void exact_fields(FILE *out, const struct br_cell *c)
{
    for (int part = 0; part < BR_PARTS; part++) {
        fputc(',', out);
        field(out, "%.17g", c->error[part]);
    }
    fprintf(out, ",%s", br_flag_name(c->flag[BR_PART_TOTAL]));
}

static enum br_status emit(FILE *out, const struct br_report *r, const struct br_provenance *p,
                           struct br_error *err)
{
    (void)p, (void)err;
    const struct br_study *s = r->study;
    fprintf(out,
            "n,k,error,axial,bending,printed,ratio,seconds,flag,axial_flag,bending_flag,"
            "worst_time%s\n",
            r->exact ? ",exact,exact_axial,exact_bending,exact_flag" : "");
    for (size_t i = 0; i < s->n_count * s->k_count; i++) {
        const struct br_cell *c = &s->cell[i];
        fprintf(out, "%zu,%.10g", c->at.n, br_time_step(s->scene, c->at.steps));
        for (int part = 0; part < BR_PARTS; part++) {
            fputc(',', out);
            field(out, "%.17g", c->error[part]);
        }
        fputc(',', out);
        field(out, "%.10g", r->printed ? r->printed[i] : NAN);
        fputc(',', out);
        field(out, "%.10g", br_report_ratio(r, i));
        fprintf(out, ",%.6f", c->seconds);
        for (int part = 0; part < BR_PARTS; part++)
            fprintf(out, ",%s", br_flag_name(c->flag[part]));
        fputc(',', out);
        field(out, "%.10g", c->worst_time[BR_PART_TOTAL]);
        if (r->exact)
            exact_fields(out, &r->exact->cell[i]);
        fputc('\n', out);
    }
    return BR_OK;
}

const struct br_emitter br_emit_csv = {"csv", ".csv", "one line a cell", emit};
