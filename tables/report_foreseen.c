/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/foresee/foreseen.h"
#include "study/scene/method_fields.h"
#include "tables/report_parts.h"

void br_report_foreseen(const struct br_foreseen *w, const char *command, int threads,
                        struct br_document *d)
{
    const double available = br_memory_available(), bytes = br_foreseen_bytes(w);
    size_t unknown = 0; /* of the times */
    for (size_t i = 0; i < w->rows; i++)
        unknown += isfinite(w->row[i].seconds) ? 0 : 1;
    br_document_begin(d, "dry-run", "beamrate dry run", 1, command);
    br_put_answer(d, "%zu %s, about %.2g s on %d thread%s and %.2g MB of memory", w->rows,
                  w->rows == 1 ? "march" : "marches and references",
                  br_foreseen_seconds(w, threads), w->alone ? 1 : threads,
                  w->alone || threads == 1 ? "" : "s", bytes / 1e6);
    br_put_more(d, bytes <= available ? "." : ", and only %.2g MB are available.", available / 1e6);
    if (unknown)
        br_put_answer(d,
                      "%zu of them choose their steps as they go: their time is not known and "
                      "not in that.",
                      unknown);
    if (w->then)
        br_put_answer(d, "Then %s.", w->then);
    br_put_answer(d, "Nothing was run, and nothing was written.");
    br_put_table(d, "marches", "What would be marched", BR_MAIN | BR_LONG);
    for (size_t i = 0; i < w->rows; i++) {
        const struct br_foreseen_march *row = &w->row[i];
        const struct br_meshes on = {row->of, &row->at.n, 1};
        const size_t steps = row->at.steps;
        char method[BR_METHOD_TEXT];
        br_put_row(d);
        BR_PUT(d, br_text(row->scene), .key = "scene");
        BR_PUT(d, br_text(row->what), .key = "what");
        BR_PUT(d, br_if(row->at.n, br_count(row->at.n)), .key = "n");
        BR_PUT(d, br_if(steps, br_count(steps)), .key = "steps");
        BR_PUT(d, br_if(steps, br_number(row->of->duration / (double)steps)), .key = "k",
               .unit = "s");
        BR_PUT(d, br_number(row->seconds), .key = "seconds", .heading = "time", .unit = "s",
               .format = "%.2g");
        BR_PUT(d, br_number(row->bytes / 1e6), .key = "megabytes", .heading = "memory",
               .unit = "MB", .format = "%.2g");
        BR_PUT(d, br_text(row->method.scheme ? br_method_text(&on, &row->method, method) : NULL),
               .key = "method", .flags = BR_WRAP);
    }
}
