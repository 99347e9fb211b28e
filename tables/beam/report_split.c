/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "solver/scene.h"
#include "study/scene/method_fields.h"
#include "study/trade/split.h"
#include "tables/beam/report_parts.h"

/* "n = 100, k = 0.01 s: scheme euler, solver riccati on avx2, contact lagged" */
static const char *describe(struct br_document *d, const struct br_split *s)
{
    char method[BR_METHOD_TEXT];
    return br_format(
        d, "n = %zu, k = %.10g s: %s", s->at.n, br_time_step(s->scene, s->at.steps),
        br_method_text(&(struct br_meshes){s->scene, &s->at.n, 1}, &s->method, method));
}

/* "99.8 %"; of a share of 0 to 1 */
static const char *share_format(double share)
{
    return share > 0 && share < 1e-3 ? "%.2g %%" : "%.1f %%";
}

static bool is_known(const struct br_share *share, size_t norm)
{
    return !share->none && br_share_known(share, norm, BR_PART_TOTAL);
}

/* "n = 100, ... Error 7.437e-04 m^(3/2), by parts: lag 99.6 %, time 0.2 %, space 0.2 %." */
static void answer_run(struct br_document *d, const struct br_split *s)
{
    br_put_list(d, "", ", ");
    br_put_answer(d, "%s. Error %.3e %s, by parts: ", describe(d, s),
                  s->whole.error[0][BR_PART_TOTAL], s->norm[0]->unit);
    for (size_t i = 0; i < BR_SOURCES; i++)
        if (is_known(&s->share[i], 0)) {
            const double share = br_share_of_sum(s, &s->share[i], 0, BR_PART_TOTAL);
            br_put_item(d, "%s ", s->share[i].name);
            br_put_more(d, share_format(share), 100 * share);
        }
    br_put_more(d, d->items ? "." : "none can be determined.");
    if (s->unstable)
        br_put_more(d, " The lagged contact is beyond its stability limit: its part is bounded "
                       "chatter.");
}

/* The lines of a run: its components, then their sum and the whole. */
enum { OTHERS = 2 };

/* People see "< 3.4e-16" for an error below its floor. */
static void put_line(struct br_document *d, const struct br_split *s, size_t norm, size_t i)
{
    static const char *const key[BR_PARTS] = {"error", "axial", "bending"},
                             *const floor_key[BR_PARTS] = {"floor", "axial_floor", "bending_floor"};
    const bool is_sum = i == BR_SOURCES, is_whole = i > BR_SOURCES;
    const struct br_share *l = is_sum ? &s->sum : is_whole ? &s->whole : &s->share[i];
    const bool known = is_sum || (!is_whole && is_known(l, norm));
    const double share =
        is_sum ? l->error[norm][BR_PART_TOTAL] > 0 : br_share_of_sum(s, l, norm, BR_PART_TOTAL);
    br_hide(d, "norm", NULL, br_text(s->norm[norm]->name));
    br_hide(d, "unit", NULL, br_text(s->norm[norm]->unit));
    BR_PUT(d, br_text(l->name), .key = "part");
    br_hide(d, "applies", NULL, br_truth(!l->none));
    br_put_blank(d, l->none);
    for (enum br_part part = 0; part < BR_PARTS; part++) {
        const double error = br_models(s->scene, part) ? l->error[norm][part] : (double)NAN;
        const double floor = is_sum ? (double)NAN : l->floor[norm][part];
        br_hide(d, floor_key[part], NULL, br_number(floor));
        BR_PUT(d, br_number(error), .key = key[part], .heading = br_part_names[part],
               .format = "%.3e");
        if (isfinite(error) && floor > 0 && !(error > floor))
            br_put_shown(d, "< %.1e", floor);
    }
    BR_PUT(d, br_number(known ? share : NAN), .key = "share", .heading = "of the sum");
    if (known)
        br_put_shown(d, share_format(share), 100 * share);
    BR_PUT(d, br_if(known || is_whole, br_number(l->error[norm][BR_PART_TOTAL] / s->scale[norm])),
           .key = "relative", .heading = "of the solution", .format = "%.2e");
    BR_PUT(d, br_if(br_models(s->scene, BR_PART_AXIAL), br_number(l->tip[BR_AXIAL])),
           .key = "axial_tip", .heading = "axial tip", .unit = "m", .format = "%+.3e");
    BR_PUT(d, br_if(br_models(s->scene, BR_PART_BENDING), br_number(l->tip[BR_BENDING])),
           .key = "bending_tip", .heading = "bending tip", .unit = "m", .format = "%+.3e");
    br_put_blank(d, false);
    br_hide(d, "none", NULL, br_text(l->none));
}

static void put_run(struct br_document *d, const struct br_split *s, size_t run)
{
    char taken[BR_METHOD_TEXT];
    br_put_row(d);
    br_hide(d, "run", NULL, br_count(run));
    br_hide(d, "n", NULL, br_count(s->at.n));
    br_hide(d, "steps", NULL, br_count(s->at.steps));
    br_hide(d, "k", "s", br_number(br_time_step(s->scene, s->at.steps)));
    br_put_method_cells(d, &s->method);
    br_hide(
        d, "solver_taken", NULL,
        br_text(br_method_taken(&(struct br_meshes){s->scene, &s->at.n, 1}, &s->method, taken)));
}

/* For people: a table for each run and norm, with the existing components. */
static void put_run_for_people(struct br_document *d, const struct br_split *s)
{
    for (size_t m = 0; m < s->norms; m++) {
        br_put_table(d, "run",
                     br_format(d, "%s; %s, %s", describe(d, s), s->norm[m]->name, s->norm[m]->unit),
                     BR_FOR_PEOPLE);
        for (size_t i = 0; i < BR_SOURCES + OTHERS; i++) {
            if (i < BR_SOURCES && s->share[i].none)
                continue;
            br_put_row(d);
            put_line(d, s, m, i);
        }
    }
    for (size_t m = 0; m < s->norms; m++) {
        const double whole = s->whole.error[m][BR_PART_TOTAL], sum = s->sum.error[m][BR_PART_TOTAL];
        br_put_note(d,
                    "Norm of the whole error over the sum of the norms of its parts: %.3g%s "
                    "(%s).",
                    whole / sum, whole < 0.9 * sum ? ", so the parts cancel in part" : "",
                    s->norm[m]->name);
    }
    for (size_t i = 0; i < BR_SOURCES; i++)
        if (s->share[i].none)
            br_put_note(d, "Part %s is left out: %s.", s->share[i].name, s->share[i].none);
    br_put_note(
        d,
        "The march without time error is by %s.%s At the tip the sum of the parts differs from "
        "the whole error by %.1e m.",
        s->refined.name,
        s->method.scheme->adaptive ? " The part time is the error that the tolerance allows." : "",
        fmax(fabs(s->sum.tip[BR_AXIAL] - s->whole.tip[BR_AXIAL]),
             fabs(s->sum.tip[BR_BENDING] - s->whole.tip[BR_BENDING])));
}

void br_report_split(const struct br_split *split, size_t count,
                     const struct br_provenance *provenance, struct br_document *d)
{
    const struct br_scene *scene = split->scene;
    char name[512], caption[512];
    snprintf(name, sizeof name, "%.500s-split", scene->name);
    snprintf(caption, sizeof caption, "Where the error comes from: %.400s", scene->title);
    br_document_begin(d, name, "beamrate trade --split", 1, caption);
    br_hide_fact(d, br_text(scene->name), NULL, "scene.name");
    for (size_t r = 0; r < count; r++)
        answer_run(d, &split[r]);
    for (size_t r = 0; r < count; r++)
        put_run_for_people(d, &split[r]);

    br_put_table(d, "runs", "Runs", BR_FOR_PROGRAMS);
    for (size_t r = 0; r < count; r++) {
        const struct br_split *s = &split[r];
        put_run(d, s, r);
        br_hide(d, "axial_tip", "m", br_number(s->tip[BR_AXIAL]));
        br_hide(d, "bending_tip", "m", br_number(s->tip[BR_BENDING]));
        br_hide(d, "solution_axial_tip", "m", br_number(s->solution_tip[BR_AXIAL]));
        br_hide(d, "solution_bending_tip", "m", br_number(s->solution_tip[BR_BENDING]));
        br_hide(d, "predicted_round_off", NULL, br_number(s->predicted_round_off));
        br_hide(d, "unstable", NULL, br_truth(s->unstable));
        br_hide(d, "reference", NULL, br_text(s->reference_kind->name));
        br_hide(d, "refined", NULL, br_text(s->refined.name));
    }

    /* For programs: all lines of all runs. */
    br_put_table(d, "parts", "Parts of the error", BR_FOR_PROGRAMS | BR_MAIN);
    for (size_t r = 0; r < count; r++)
        for (size_t m = 0; m < split[r].norms; m++)
            for (size_t i = 0; i < BR_SOURCES + OTHERS; i++) {
                put_run(d, &split[r], r);
                put_line(d, &split[r], m, i);
            }

    br_put_section(d, "What is measured");
    for (size_t m = 0; m < split->norms; m++)
        br_put_note(d, "%s", split->norm[m]->title);
    br_put_note(d,
                "A part is the distance of two marches, or of a march from the solution (%s). The "
                "second march has one source of error less. So the parts add up to the whole: as "
                "functions, and at the tip (x = L, t = T) as numbers with signs.",
                split->reference_kind->name);
    br_put_note(d, "<: the part is below this floor, which comes from round-off and from the "
                   "errors of the marches that measure it.");
    if (split->scene->remark)
        br_put_note(d, "%s", split->scene->remark);

    br_put_provenance(d, provenance);
}
