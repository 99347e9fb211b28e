/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of a study: its grids, for people, with a row for each mesh and a column for each time
 * step; and the contradictions in the printed table. */
#include <math.h>

#include "solver/scene.h"
#include "study/fit/report.h"
#include "tables/report_parts.h"

bool br_part_is_shown(const struct br_report *r, enum br_part part)
{
    const struct br_scene *s = r->study->scene;
    return part == BR_PART_TOTAL || (s->axial.modelled && s->bending.modelled);
}

struct grid {
    const char *key;
    const struct br_study *study;
    enum br_part part;
    double (*value)(const struct br_report *r, size_t cell); /* NULL: the study's errors */
    const char *format;
    unsigned flags;
};

static void put_grid(struct br_document *d, const struct br_report *r, const struct grid *g,
                     const char *title)
{
    static const char *const marks[BR_CELL_FLAGS] = {"", "R", "F", "X", "U", "S"};
    const struct br_study *s = g->study;
    char buffer[64];
    br_put_table(d, g->key, title, BR_FOR_PEOPLE | g->flags);
    for (size_t i = 0; i < s->n_count; i++) {
        br_put_row(d);
        BR_PUT(d, br_count(s->n[i]), .key = "n");
        for (size_t j = 0; j < s->k_count; j++) {
            const struct br_cell *c = br_study_cell(s, i, j);
            const double value = g->value ? g->value(r, i * s->k_count + j) : c->error[g->part];
            char key[32];
            snprintf(key, sizeof key, "steps%zu", s->steps[j]);
            snprintf(buffer, sizeof buffer, "k = %g", br_time_step(s->scene, s->steps[j]));
            BR_PUT(d, br_number(value), .key = key, .heading = buffer, .format = g->format);
            br_put_mark(d, g->value ? NULL : marks[c->flag[g->part]]);
        }
    }
}

static double printed_of(const struct br_report *r, size_t cell)
{
    return r->printed[cell];
}

static void put_error_grid(struct br_document *d, const struct br_report *r,
                           const struct br_study *s, enum br_part part)
{
    static const char *const names[] = {"Total", "Axial", "Bending"};
    const bool fitted = s == br_report_fitted(r);
    char title[200];
    const struct grid g = {
        .key = fitted ? br_part_names[part] : s->judge->name,
        .study = s,
        .part = part,
        .format = "%.3e",
        .flags = part == BR_PART_TOTAL && fitted ? 0 : BR_FILES_ONLY,
    };
    snprintf(title, sizeof title, "%s error against %s, %s", names[part], s->judge->name,
             s->norm->unit);
    put_grid(d, r, &g, title);
}

void br_put_grids(struct br_document *d, const struct br_report *r)
{
    const struct grid printed = {"printed", r->study, .value = printed_of, .format = "%.3e",
                                 .flags = BR_FILES_ONLY};
    const struct grid ratio = {"ratio", r->study, .value = br_report_ratio, .format = "%.3f"};
    char title[64];
    for (enum br_part part = 0; part < BR_PARTS; part++)
        if (br_part_is_shown(r, part))
            put_error_grid(d, r, br_report_fitted(r), part);
    if (r->exact)
        put_error_grid(d, r, r->study, BR_PART_TOTAL);
    if (!r->printed)
        return;
    put_grid(d, r, &printed, "Printed error, m^(3/2)");
    snprintf(title, sizeof title, "Ours (against %s) over printed", r->study->judge->name);
    put_grid(d, r, &ratio, title);
}

void br_put_triangles(struct br_document *d, const struct br_report *r)
{
    static const struct br_column columns[] = {
        {.key = "a_n", .heading = "n"},
        {.key = "a_k", .heading = "k", .unit = "s"},
        {.key = "b_n", .heading = "and n"},
        {.key = "b_k", .heading = "k", .unit = "s"},
        {.key = "printed_a", .heading = "printed", .format = "%.3e"},
        {.key = "printed_b", .heading = "and", .format = "%.3e"},
        {.key = "least", .heading = "need at least", .format = "%.2e"},
        {.key = "most", .heading = "at most", .format = "%.2e"},
        {.key = "distance", .heading = "are apart", .format = "%.2e"},
        {.key = "contradiction"},
    };
    if (!r->printed)
        return;
    BR_TABLE(d, "triangles", "Pairs of printed cells (triangle inequality), m^(3/2)", BR_FILES_ONLY,
             columns);
    for (size_t i = 0; i < r->triangles; i++) {
        const struct br_triangle *t = &r->triangle[i];
        BR_PUT_ROW(d, br_count(t->a.n), br_number(br_time_step(r->study->scene, t->a.steps)),
                   br_count(t->b.n), br_number(br_time_step(r->study->scene, t->b.steps)),
                   br_number(t->printed_a), br_number(t->printed_b), br_number(t->least),
                   br_number(t->most), br_number(t->distance), br_truth(t->contradiction));
    }
    br_put_note(d, "For every reference, the distance of two solutions is at least the difference "
                   "of their errors, and at most the sum. The last column but one is the distance "
                   "of the scheme's own solutions.");
}
