/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/scene.h"
#include "study/extremes/extremes.h"
#include "tables/beam/report_parts.h"

/* ---- floors, and the round-off that steps gather ---- */

/* The worst over the steps that are marched, and how many are refused. */
static void put_floor_grid(struct br_document *d, const struct br_floors *f)
{
    br_put_table(d, "worst", "Deviation from the exact discrete solution, the worst over k",
                 BR_FOR_PEOPLE);
    for (size_t cell = 0; cell < f->n_count * f->method.count; cell++) {
        const size_t row = cell / f->method.count, method = cell % f->method.count;
        size_t refused = 0;
        double worst = 0;
        for (size_t j = 0; j < f->k_count; j++) {
            const struct br_floor *floor = br_floor_at(f, 0, method, row, j);
            const double deviation = br_floor_deviation(floor);
            refused += floor->refused.status != BR_OK;
            if (!floor->refused.status && !isnan(worst) && !(deviation <= worst))
                worst = deviation;
        }
        if (method == 0) {
            br_put_row(d);
            BR_PUT(d, br_count(br_floor_at(f, 0, 0, row, 0)->n), .key = "n");
        }
        BR_PUT(d, br_if(refused < f->k_count, br_number(worst)),
               .heading = f->method.list[method].name, .format = "%.1e");
        if (refused == f->k_count)
            br_put_shown(d, "refused");
        else if (refused)
            br_put_shown(d, "%.1e, %zu refused", worst, refused);
    }
}

static void put_gathered_grid(struct br_document *d, const struct br_floors *f)
{
    br_put_table(d, "gathered", "Deviation from the exact discrete solution after N steps",
                 BR_FOR_PEOPLE);
    for (size_t i = 0; i < f->floors; i++) {
        const struct br_floor *floor = &f->floor[i];
        char key[32], heading[32];
        if (i % f->k_count == 0) {
            br_put_row(d);
            BR_PUT(d, br_text(floor->scene->name), .key = "scene");
            BR_PUT(d, br_text(floor->by->name), .key = "method");
        }
        snprintf(key, sizeof key, "N%zu", floor->of); /* numbers may differ in later digits */
        snprintf(heading, sizeof heading, "N = %.3g", (double)floor->of);
        if (strtod(heading + strlen("N = "), NULL) != (double)floor->of)
            snprintf(heading, sizeof heading, "N = %zu", floor->of);
        BR_PUT(d, br_number(br_floor_deviation(floor)), .key = key, .heading = heading,
               .format = "%.1e");
        if (floor->refused.status)
            br_put_shown(d, "refused");
    }
}

static const char *floor_outcome(const struct br_floor *f)
{
    if (f->refused.status || !f->steps)
        return f->refused.status ? "refused" : "not marched";
    return br_floor_deviation(f) <= br_floor_limit(f) ? "as predicted" : "ABOVE";
}

static void put_floor(struct br_document *d, const struct br_floor *f, bool gathered)
{
    br_put_row(d);
    if (gathered)
        BR_PUT(d, br_text(f->scene->name), .key = "scene");
    BR_PUT(d, br_text(f->by->name), .key = gathered ? "method" : "solver");
    if (!gathered) {
        BR_PUT(d, br_count(f->n), .key = "n");
        BR_PUT(d, br_number(f->k), .key = "k", .unit = "s");
    }
    BR_PUT(d, br_count(gathered ? f->of : f->steps), .key = "steps");
    BR_PUT(d, br_number(f->deviation[BR_AXIAL]), .key = "axial", .format = "%.2e");
    BR_PUT(d, br_number(f->deviation[BR_BENDING]), .key = "bending", .format = "%.2e");
    if (!gathered) {
        BR_PUT(d, br_number(f->tip[BR_AXIAL]), .key = "axial_tip", .heading = "axial tip",
               .format = "%.2e");
        BR_PUT(d, br_number(f->tip[BR_BENDING]), .key = "bending_tip", .heading = "bending tip",
               .format = "%.2e");
    }
    BR_PUT(d, br_number(f->predicted), .key = "predicted", .format = "%.2e");
    if (gathered)
        BR_PUT(d, br_number(f->time_error), .key = "time_levels", .heading = "time levels",
               .format = "%.2e");
    BR_PUT(d, br_text(floor_outcome(f)), .key = "outcome");
    BR_PUT(d, br_failure_text(&f->refused), .key = "message", .heading = "why", .flags = BR_WRAP);
}

static void put_floors(struct br_document *d, const struct br_floors *f)
{
    struct br_error err = {0};
    if (br_floors_verdict(f, &err))
        br_put_answer(d, "ABOVE: %s", err.message);
    else if (f->gathered)
        br_put_answer(d, "For every number of steps, the accumulated round-off stays below its "
                         "prediction, and the time levels are n T/N.");
    else
        br_put_answer(d, "Every solver is accurate to its predicted round-off, or refuses.");
    if (f->gathered) {
        put_gathered_grid(d, f);
        br_put_table(d, "steps", "Every scene, method and number of steps",
                     BR_FILES_ONLY | BR_MAIN);
    } else {
        put_floor_grid(d, f);
        br_put_table(d, "floors", "Every solver, mesh and time step", BR_FILES_ONLY | BR_MAIN);
    }
    for (size_t i = 0; i < f->floors; i++)
        put_floor(d, &f->floor[i], f->gathered);
    br_put_section(d, "What is measured");
}

void br_report_floors(const struct br_floors *f, struct br_document *d)
{
    if (f->gathered) {
        br_document_begin(d, "steps", "beamrate extremes steps", 1,
                          "Accumulated round-off of many "
                          "steps");
        put_floors(d, f);
        br_put_note(d,
                    "Deviation: the largest difference of all nodal displacements from the "
                    "exact discrete solution at the end of the duration, relative to the "
                    "largest displacement of the field; the larger of both fields; 10 elements.");
        br_put_note(d, "Predicted: the round-off of a solver in one step, and a random walk of 64 "
                       "* 2^-52 * sqrt(N). In example1 the tip sticks: friction keeps its velocity "
                       "at 0, but nothing corrects its displacement.");
        return;
    }
    br_document_begin(d, "floors", "beamrate extremes floors", 1,
                      "Round-off floors of the linear solvers");
    put_floors(d, f);
    br_put_note(
        d,
        "Deviation: the largest difference of all nodal displacements from the exact "
        "discrete solution (the same march by 'plain' in long double), relative to the "
        "largest displacement of the field at all time levels, after 20 steps of %s by "
        "implicit Euler with lagged contact, or with contact at u_n where the lagged one is "
        "beyond its stability limit; the larger of both fields.",
        f->scene[0]->name);
    br_put_note(d, "Refused: with the assembled matrix, the error of a march would exceed 5 %%.");
}

/* ---- stability ---- */

/* Begins a row of a column. */
static void put_column(struct br_document *d, const struct br_stability_plane *p,
                       const struct br_stability_column *c)
{
    br_put_row(d);
    BR_PUT(d, br_text(p->by->name), .key = "method");
    BR_PUT(d, br_text(p->over_stiffness ? "c_H" : "n"), .key = "over");
    BR_PUT(d, br_count(c->n), .key = "n");
    BR_PUT(d, br_number(c->stiffness), .key = "c_H", .unit = "N/m", .format = "%.4g");
}

static void put_limits(struct br_document *d, const struct br_stability_plane *p)
{
    for (size_t i = 0; i < p->columns; i++) {
        const struct br_stability_column *c = &p->column[i];
        put_column(d, p, c);
        BR_PUT(d, br_if(c->largest > 0, br_number(c->largest)), .key = "largest",
               .heading = "largest stable k", .unit = "s", .format = "%.4g");
        BR_PUT(d, br_number(c->broken), .key = "broken", .heading = "breaks at k", .unit = "s",
               .format = "%.4g");
        BR_PUT(d, br_number(c->predicted), .key = "predicted",
               .heading = "by theory, if it stays closed", .unit = "s", .format = "%.4g");
    }
}

static void put_points(struct br_document *d, const struct br_stability *s,
                       const struct br_stability_plane *p)
{
    for (size_t i = 0; i < p->columns * s->rows; i++) {
        const struct br_stability_column *c = &p->column[i / s->rows];
        const struct br_stability_point *point = &c->point[i % s->rows];
        put_column(d, p, c);
        BR_PUT(d, br_number(s->scene->duration / (double)point->steps), .key = "k", .unit = "s",
               .format = "%.4g");
        BR_PUT(d, br_text(br_stability_words[point->outcome]), .key = "outcome");
        BR_PUT(d, br_number(point->share), .key = "share", .heading = "share of energy",
               .format = "%.2g");
        BR_PUT(d, br_text(*point->why ? point->why : NULL), .key = "message", .flags = BR_WRAP);
    }
}

/* Where the scene itself breaks. The columns are meshes. */
static void answer_meshes(struct br_document *d, const struct br_stability *s,
                          const struct br_stability_plane *p)
{
    const struct br_stability_column *worst = p->column;
    for (size_t i = 1; i < p->columns; i++)
        if (p->column[i].largest < worst->largest)
            worst = &p->column[i];
    if (isinf(worst->broken)) {
        br_put_answer(d,
                      "%s by %s does not break: all steps that were tried, up to k = %.4g s, are "
                      "stable at n = %zu",
                      s->scene->name, p->by->name, worst->largest, p->column[0].n);
        if (p->columns > 1)
            br_put_more(d, " to %zu.", p->column[p->columns - 1].n);
        else
            br_put_more(d, ".");
        return;
    }
    br_put_answer(d, "%s by %s %s: at n = %zu ", s->scene->name, p->by->name,
                  worst->by == BR_REFUSED ? "is refused with long steps" : "breaks", worst->n);
    if (isfinite(worst->stiffness))
        br_put_more(d, "and c_H = %.4g N/m ", worst->stiffness);
    if (worst->largest > 0)
        br_put_more(d, "the largest stable k is %.4g s.", worst->largest);
    else
        br_put_more(d, "no k that was tried is stable, not even %.4g s.", worst->broken);
    if (isfinite(worst->predicted))
        br_put_more(d, " Theory gives %.4g s for a contact that stays closed.", worst->predicted);
}

/* From which c_H on it breaks. */
static void answer_stiffnesses(struct br_document *d, const struct br_stability_plane *p)
{
    size_t sound = 0;
    while (sound < p->columns && isinf(p->column[sound].broken))
        sound++;
    const struct br_stability_column *last = &p->column[p->columns - 1], *c = &p->column[sound];
    if (sound == p->columns)
        br_put_answer(d, "With c_H up to %.3g N/m all these k are stable at n = %zu, too.",
                      last->stiffness, last->n);
    else if (sound == 0)
        br_put_answer(d, "At n = %zu it breaks with all c_H that were tried, from %.3g N/m on.",
                      c->n, c->stiffness);
    else
        br_put_answer(
            d,
            "Over c_H, at n = %zu: up to %.3g N/m all these k are stable; at %.3g N/m k is stable "
            "up to %.4g s.",
            c->n, c[-1].stiffness, c->stiffness, c->largest);
}

void br_report_stability(const struct br_stability *s, struct br_document *d)
{
    struct br_error err = {0};
    const struct br_stability_plane *end = s->plane + s->planes;
    size_t count[] = {0, 0, 0};
    br_document_begin(d, "stability", "beamrate extremes stability", 2, "Where the scene breaks");
    for (const struct br_stability_plane *p = s->plane; p < end; p++) {
        if (p->over_stiffness)
            answer_stiffnesses(d, p);
        else
            answer_meshes(d, s, p);
        for (size_t i = 0; i < 3; i++)
            count[i] += br_stability_count(s, p, (enum br_stability_outcome)i);
    }
    br_put_answer(d, "%zu marches are stable, %zu are unstable, %zu are refused.", count[BR_STABLE],
                  count[BR_UNSTABLE], count[BR_REFUSED]);
    if (br_stability_verdict(s, &err))
        br_put_answer(d, "NOT AS PREDICTED: %s.", err.message);
    br_put_table(d, "limits", "The largest stable k of each column", BR_FILES_ONLY);
    for (const struct br_stability_plane *p = s->plane; p < end; p++)
        put_limits(d, p);
    br_put_table(d, "points", "All marches", BR_FILES_ONLY | BR_MAIN);
    for (const struct br_stability_plane *p = s->plane; p < end; p++)
        put_points(d, s, p);
    br_put_section(d, "What is unstable");
    br_put_note(d,
                "A march is unstable if it is not finite, or if its scheme adds energy. The work "
                "of loads and the initial energy do not count. Implicit Euler: the share of energy "
                "that the scheme added, by the balance of every step, over what was put into the "
                "field; more than %g is unstable. With contact at u_n it adds nothing.",
                br_stability_most(&(struct br_method){.scheme = br_time_schemes[0]}));
    br_put_note(d, "Other schemes: the energy at the end over the energy that the loads put in, in "
                   "this march and in one by implicit Euler with contact at u_n; more than 10 is "
                   "unstable.");
    br_put_note(d,
                "By theory a lagged contact that stays closed is stable if c_H G(2/k) is at most "
                "1; one that opens and closes gains no energy if c_H is at most (a + 2c/k)/L.");
}
