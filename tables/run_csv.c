/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/run/run.h"
#include "study/scene/quote.h"
#include "tables/reports.h"

void br_history_csv_head(FILE *out)
{
    fprintf(out, "step,t,u,w,u_t,w_t,contact_force,friction_force,friction_bound\n");
}

void br_history_csv_row(FILE *out, const struct br_history_row *row)
{
    const double values[] = {
        row->time,
        row->displacement[BR_AXIAL],
        row->displacement[BR_BENDING],
        row->velocity[BR_AXIAL],
        row->velocity[BR_BENDING],
        row->contact_force,
        row->friction_force,
        row->friction_bound,
    };
    fprintf(out, "%zu", row->step);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (isfinite(values[i]))
            fprintf(out, ",%.17g", values[i]);
        else
            fputc(',', out);
    fputc('\n', out);
}

void br_history_csv_stopped(FILE *out, const char *message)
{
    fprintf(out, "# stopped: ");
    br_quote(out, &br_for_text, message);
    fputc('\n', out);
}
