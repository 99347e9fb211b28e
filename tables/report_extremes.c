/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "study/extremes/extremes.h"
#include "tables/report_parts.h"

/* ---- floors, and the round-off that steps gather ---- */

/* The worst over the steps that are marched, and how many are refused. */
static void put_floor_grid(struct br_document *d, const struct br_floors *f)
{
    br_put_table(d, "worst", "Deviation from the exact discrete solution, the worst over k",
                 BR_FOR_PEOPLE);
    for (size_t cell = 0; cell < f->n_count * f->methods; cell++) {
        const size_t row = cell / f->methods, method = cell % f->methods;
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
        BR_PUT(d, br_if(refused < f->k_count, br_number(worst)), .heading = f->method[method].name,
               .format = "%.1e");
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
        char heading[32];
        if (i % f->k_count == 0) {
            br_put_row(d);
            BR_PUT(d, br_text(floor->scene->name), .key = "scene");
            BR_PUT(d, br_text(floor->by->name), .key = "method");
        }
        snprintf(heading, sizeof heading, "N = %.3g", (double)floor->of);
        BR_PUT(d, br_number(br_floor_deviation(floor)), .heading = heading, .format = "%.1e");
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
        br_put_answer(d, "However many steps there are, the round-off that they gather stays below "
                         "what is predicted, and the time levels are n T/N.");
    else
        br_put_answer(d, "Every solver is right to the round-off that it predicts, or refuses.");
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
        br_document_begin(d, "steps", "beamrate extremes steps", 1, "Round-off that steps gather");
        put_floors(d, f);
        br_put_note(d,
                    "Deviation: the largest difference of all nodal displacements from the "
                    "exact discrete solution at the end of the duration, relative to the "
                    "largest displacement of the field; the larger of both fields; 10 elements.");
        br_put_note(d, "Predicted: what a solver loses in a step, and a random walk of "
                       "64 * 2^-52 * sqrt(N). In Example 1 the tip sticks: friction holds its "
                       "velocity, and nothing its displacement.");
        return;
    }
    br_document_begin(d, "floors", "beamrate extremes floors", 1,
                      "Round-off floors of the linear solvers");
    put_floors(d, f);
    br_put_note(d, "Deviation: the largest difference of all nodal displacements from the exact "
                   "discrete solution (the same equations in long double, in a form that loses "
                   "nothing), relative to the largest displacement of the field, after 20 steps of "
                   "Example 2 by implicit Euler with lagged contact; the larger of both fields.");
    br_put_note(d, "Refused: the assembled matrix would leave a march more than a twentieth off. "
                   "'refined' does up to 2 steps of refinement a solve, 'scaled' scales the rows.");
}

/* ---- stability of the contact ---- */

static void put_limits(struct br_document *d, const struct br_stability *s)
{
    br_put_table(d, "limits", "Stability limit of the lagged contact", BR_FILES_ONLY);
    for (size_t i = 0; i < BR_STABILITY_RODS * s->rows; i++) {
        const struct br_stability_row *r = &s->row[i];
        br_put_row(d);
        BR_PUT(d, br_text(r->rod->title), .key = "rod");
        BR_PUT(d, br_number(r->rod->density), .key = "rho", .unit = "kg/m", .format = "%.4g");
        BR_PUT(d, br_number(r->rod->viscosity), .key = "c", .unit = "N s", .format = "%.4g");
        BR_PUT(d, br_number(r->k), .key = "k", .unit = "s", .format = "%.4g");
        BR_PUT(d, br_number(r->limit), .key = "predicted", .unit = "N/m", .format = "%.12g");
        BR_PUT(d, br_number(r->measured), .key = "measured", .unit = "N/m", .format = "%.12g");
        BR_PUT(d, br_number(r->measured / r->limit - 1), .key = "difference", .format = "%.1e");
    }
}

static void put_growth(struct br_document *d, const struct br_stability *s)
{
    br_put_table(d, "cells", "Growth a step of the closed lagged contact", BR_FILES_ONLY);
    for (size_t i = 0; i < BR_STABILITY_RODS * s->rows * BR_STABILITY_COLUMNS; i++) {
        const struct br_stability_row *r = &s->row[i / BR_STABILITY_COLUMNS];
        const size_t j = i % BR_STABILITY_COLUMNS;
        br_put_row(d);
        BR_PUT(d, br_text(r->rod->name), .key = "rod");
        BR_PUT(d, br_number(r->k), .key = "k", .unit = "s", .format = "%.6g");
        BR_PUT(d, br_number(s->stiffness[j]), .key = "c_H", .unit = "N/m", .format = "%.6g");
        BR_PUT(d, br_number(r->radius[j]), .key = "eigenvalue", .heading = "largest eigenvalue",
               .format = "%.15g");
        BR_PUT(d, br_number(r->growth[j] > 1 ? r->growth[j] : NAN), .key = "predicted",
               .heading = "predicted growth", .format = "%.15g");
    }
}

static void put_schemes(struct br_document *d, const struct br_stability *s)
{
    br_put_table(d, "schemes", "Contact at u_n, c_H from 1 to 1e15 N/m", 0);
    for (size_t i = 0; i < s->schemes; i++) {
        const struct br_stability_scheme *c = &s->scheme[i];
        br_put_row(d);
        BR_PUT(d, br_text(c->scheme->name), .key = "scheme");
        BR_PUT(d, br_count(c->marches), .key = "marches");
        BR_PUT(d, br_count(c->failed), .key = "failed");
        BR_PUT(d, br_count(c->uncertain), .key = "uncertain", .heading = "without a certificate");
        BR_PUT(d, br_number(c->force), .key = "force", .heading = "force off by", .format = "%.1e");
        BR_PUT(d, br_number(c->depth), .key = "depth", .heading = "depth off by", .format = "%.1e");
    }
}

static void put_tips(struct br_document *d, const struct br_stability *s)
{
    br_put_table(d, "pressed", "A pressed tip, lagged contact", 0);
    for (size_t i = 0; i < BR_STABILITY_TIPS; i++) {
        const struct br_stability_tip *t = &s->tip[i];
        br_put_row(d);
        BR_PUT(d, br_number(t->limit), .key = "share", .heading = "c_H over its limit");
        BR_PUT(d, br_number(t->stiffness), .key = "c_H", .unit = "N/m");
        BR_PUT(d, br_count(t->opened), .key = "opened", .heading = "times it opened");
        BR_PUT(d, br_number(t->swing), .key = "swing", .format = "%.2e");
        BR_PUT(d, br_number(t->farthest), .key = "farthest", .format = "%.2e");
    }
}

static void put_bounces(struct br_document *d, const struct br_stability *s)
{
    br_put_table(d, "bouncing", "A bouncing rod, lagged contact", 0);
    for (size_t i = 0; i < BR_STABILITY_BOUNCES; i++) {
        const struct br_stability_tip *b = &s->bounce[i];
        br_put_row(d);
        BR_PUT(d, br_number(b->stiffness), .key = "c_H", .unit = "N/m", .format = "%.4g");
        BR_PUT(d, br_number(b->bouncing), .key = "over_bouncing",
               .heading = "over the limit without inertia", .format = "%.4g");
        BR_PUT(d, br_number(b->limit), .key = "over_limit", .heading = "over the limit",
               .format = "%.4g");
        BR_PUT(d, br_count(b->impacts), .key = "impacts");
        BR_PUT(d, br_number(b->energy), .key = "energy", .heading = "largest energy over the first",
               .format = "%.7g");
    }
}

static void answer_stability(struct br_document *d, const struct br_stability *s)
{
    struct br_error err = {0};
    if (br_stability_verdict(s, &err))
        br_put_answer(d, "Not as predicted: %s.", err.message);
    else
        br_put_answer(d, "The contact is stable and unstable exactly where it is predicted to be.");
    br_put_answer(d,
                  "The largest relative difference between a predicted and a measured stability "
                  "limit of the lagged contact is %.1e.",
                  s->limit_error);
    br_put_answer(d,
                  "Between predicted and measured growth, in %zu of %zu cells of the planes, it is "
                  "%.1e.",
                  s->growing, s->cells, s->growth_error);
    if (s->excess > 0)
        br_put_answer(d, "In the other cells eigenvalues are up to %.1e outside the unit circle.",
                      s->excess);
    else
        br_put_answer(d, "In the other cells all eigenvalues are within the unit circle.");
    br_put_answer(d, "Contact at u_n has no limit: every scheme brings a pressed rod to rest with "
                     "c_H up to 1e15 N/m.");
}

void br_report_stability(const struct br_stability *s, struct br_document *d)
{
    br_document_begin(d, "stability", "beamrate extremes stability", 1,
                      "The contact's stability: predicted, and measured by marches");
    answer_stability(d, s);
    put_limits(d, s);
    put_growth(d, s);
    put_schemes(d, s);
    put_tips(d, s);
    put_bounces(d, s);
    br_put_section(d, "How it was measured");
    br_put_note(
        d,
        "Measured: the matrix of a step against a closed contact, column by column by marches of "
        "one step of %zu elements, its largest eigenvalue, and by bisection the c_H where that "
        "leaves the unit circle. Predicted: c_H times the tip's flexibility at s = 2/k is 1.",
        s->n);
    br_put_note(
        d,
        "Pressed tips (the paper's rod, k = %g s, 4000 steps of a constant load): swing of the last "
        "quarter, and largest displacement, over the free rod's. Within the limit they rest, "
        "beyond it they chatter.",
        s->tip_k);
    br_put_note(
        d,
        "Bouncing rods (no viscosity, k = %g s): within the limit without inertia, (a + 2c/k)/L, a "
        "lagged contact never gains energy; between that and the limit a closed one is stable, but "
        "impacts may gain some. Euler with contact at u_n gains none.",
        s->bounce_k);
}
