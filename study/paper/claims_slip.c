/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Claims on Example 2 (slip), 3 (Tresca) and 4 (oscillating forces). */
#include <math.h>
#include <stdio.h>

#include "study/paper/claims.h"

/* ---- Example 2 ---- */

/* The tip rests in these steps' time, s; *slowest: the least |w_t(L)| after t = 0, m/s. */
static double resting(const struct br_history_record *record, double *slowest)
{
    size_t steps = 0;
    *slowest = INFINITY;
    for (size_t i = 1; i < record->rows; i++) {
        const double speed = fabs(record->row[i].velocity[BR_BENDING]);
        steps += !(speed > 0);
        *slowest = br_smaller(*slowest, speed);
    }
    return record->rows > 1 ? (double)steps * record->row[1].time : NAN;
}

static double exact_rest(const struct br_example *e)
{
    double rest = 0, since = NAN;
    for (size_t i = 0; i < e->events; i++) {
        if (e->event[i].field != BR_EXACT_BENDING)
            continue;
        if (!isnan(since))
            rest += e->event[i].time - since;
        since = e->event[i].phase == BR_STICK ? e->event[i].time : NAN;
    }
    return rest + (isnan(since) ? 0 : e->scene.duration - since);
}

static void measure_moves(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[1];
    double slowest;
    f->value = resting(&e->record, &slowest);
    f->exact = exact_rest(e);
    f->error = fabs(f->value - f->exact);
    f->agreement = f->value + f->error > 0 ? BR_DIFFERS : BR_AGREES;
    snprintf(f->note, sizeof f->note, "the slowest step moves at %.3g m/s", slowest);
}

const struct br_claim br_claim_moves = {
    .name = "moves",
    .section = "3.2.2",
    .figure = 4,
    .statement = "There is always movement of the contact node.",
    .measured = "time at rest",
    .unit = "s",
    .measure = measure_moves,
};

static void measure_at_bound(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[1];
    f->value = f->exact = 0;
    for (size_t i = 1; i < e->record.rows; i++) {
        const struct br_history_row *row = &e->record.row[i];
        f->value = br_larger(f->value, fabs(fabs(row->friction_force) / row->friction_bound - 1));
    }
    for (size_t i = 1; i < e->exacts; i++)
        f->exact = br_larger(
            f->exact, fabs(fabs(e->exact[i].friction_force) / e->exact[i].friction_bound - 1));
    f->error = fabs(f->value - f->exact);
    f->agreement = br_below(f->value, f->error, 1e-9);
}

const struct br_claim br_claim_at_bound = {
    .name = "at-bound",
    .section = "3.2.2",
    .figure = 4,
    .statement = "The tangential stress equals the friction bound.",
    .measured = "largest ||sigma_V| / h - 1|",
    .unit = "1",
    .measure = measure_at_bound,
};

/* ---- Example 3 ---- */

static void measure_decouples(const struct br_paper *p, struct br_finding *f)
{
    f->value = p->coupled;
    f->exact = f->error = 0; /* (2), (4), (9), (11), (12) (i) hold no axial displacement */
    f->agreement = br_below(f->value, 0, 1e-15);
    snprintf(f->note, sizeof f->note, "with the rod and the contact of Example 1 added");
}

const struct br_claim br_claim_decouples = {
    .name = "decouples",
    .section = "3.2.3",
    .statement = "With Tresca's conditions the problem decouples.",
    .measured = "how far an axial field moves w(L,t)",
    .unit = "m",
    .measure = measure_decouples,
};

/* The last row at which the tip has not moved; 0: none. */
static size_t last_at_rest(const struct br_history_record *record)
{
    size_t i = 1;
    while (i < record->rows && fabs(record->row[i].friction_force) < record->row[i].friction_bound)
        i++;
    return i - 1;
}

/* When the exact tip begins to slip for good, s. */
static double exact_release(const struct br_example *e, double *own)
{
    double time = *own = NAN;
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].phase == BR_SLIP_DOWN || e->event[i].phase == BR_SLIP_UP) {
            time = e->event[i].time;
            *own = e->event[i].error;
        }
    return time;
}

/* Theory: with a load q(t) L the propped cantilever's reaction is 3/8 q L; the bound is c_V. */
static double theory_release(const struct br_scene *scene)
{
    const double time = scene->duration;
    const double q = br_load_value(&scene->bending.load, scene->length / 2, time);
    return scene->friction.coefficient / (0.375 * fabs(q) / time * scene->length);
}

static void measure_release(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[2];
    double own;
    const size_t last = last_at_rest(&e->record);
    f->value = e->record.row[last].time;
    f->exact = exact_release(e, &own);
    f->error = fabs(f->value - f->exact) + own + e->record.row[1].time; /* it is told by steps */
    f->printed = 0.68;
    f->agreement = br_same(f, 0.005);
    snprintf(
        f->note, sizeof f->note,
        "theory, 3/8 q L = c_V: %.10g s; at t = %.3g s the scheme's stress is %.1f N of %.0f N",
        theory_release(&e->scene), e->record.at[2].time, fabs(e->record.at[2].friction_force),
        e->scene.friction.coefficient);
}

const struct br_claim br_claim_release = {
    .name = "release",
    .section = "3.2.3",
    .figure = 5,
    .statement = "The contact node is clamped until time t = 0.68 s.",
    .measured = "last time at rest",
    .unit = "s",
    .measure = measure_release,
};

/* The stress of the first step that slips. */
static double stress_at_release(const struct br_history_record *record)
{
    const size_t first = last_at_rest(record) + 1;
    return first < record->rows ? fabs(record->row[first].friction_force) : NAN;
}

static void measure_reaches(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[2];
    f->value = stress_at_release(&e->record);
    f->exact = f->printed = e->scene.friction.coefficient; /* (12): slip at the bound only */
    f->error = fabs(f->value - f->exact);
    f->agreement = br_below(f->error, 0, 1e-9 * f->exact);
}

const struct br_claim br_claim_reaches = {
    .name = "reaches",
    .section = "3.2.3",
    .figure = 6,
    .statement = "It lets go when the tangential stress reaches the friction bound, 3000 N.",
    .measured = "|sigma_V| in the first step that slips",
    .unit = "N",
    .measure = measure_reaches,
};

/* ---- Example 4 ---- */

static void measure_penetrates(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[3];
    const double gap = e->scene.contact.gap;
    bool opens = false;
    f->value = f->exact = INFINITY;
    for (size_t i = 1; i < e->record.rows; i++)
        f->value = br_smaller(f->value, e->record.row[i].displacement[BR_AXIAL] - gap);
    for (size_t i = 1; i < e->exacts; i++)
        f->exact = br_smaller(f->exact, e->exact[i].displacement[BR_AXIAL] - gap);
    for (size_t i = 0; i < e->events; i++)
        opens = opens || e->event[i].phase == BR_OPEN;
    f->error = fabs(f->value - f->exact);
    f->agreement = opens ? BR_DIFFERS : br_above(f->exact, 0, 0);
    snprintf(f->note, sizeof f->note,
             "the least is that of the first step, %.3g s; the exact contact %s",
             e->record.rows > 1 ? e->record.row[1].time : NAN,
             opens ? "opens" : "never opens after t = 0");
}

const struct br_claim br_claim_penetrates = {
    .name = "penetrates",
    .section = "3.2.4",
    .figure = 7,
    .statement = "There is always penetration of the beam into the obstacle.",
    .measured = "least u(L,t) - g for t > 0",
    .unit = "m",
    .measure = measure_penetrates,
};
