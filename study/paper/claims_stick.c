/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Claims on Example 1 (stick) and on the two tables. */
#include <math.h>
#include <stdio.h>

#include "study/paper/claims.h"

/* The largest |w(L, t)| over the rows, m. */
static double most_deflection(const struct br_history_record *record)
{
    double most = 0;
    for (size_t i = 0; i < record->rows; i++)
        most = br_larger(most, fabs(record->row[i].displacement[BR_BENDING]));
    return most;
}

/* The same over the beam at the figure's times. */
static double most_of_beam(const struct br_history_record *record)
{
    double most = 0;
    for (size_t look = 0; look < record->looks; look++) {
        const double *nodal = br_history_field(record, look, BR_BENDING, false);
        for (size_t node = 0; node <= record->n; node++)
            most = br_larger(most, fabs(nodal[2 * node]));
    }
    return most;
}

/* What the eye can see in Figure 2: a hundredth of the beam's largest deflection. */
enum { VISIBLE = 100 };

static void measure_clamped(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[0];
    f->value = most_deflection(&e->record);
    f->exact = 0;
    for (size_t i = 0; i < e->exacts; i++)
        f->exact = br_larger(f->exact, fabs(e->exact[i].displacement[BR_BENDING]));
    f->error = fabs(f->value - f->exact);
    const double visible = most_of_beam(&e->record) / VISIBLE;
    f->agreement = br_below(f->value, f->error, visible);
    snprintf(f->note, sizeof f->note,
             "to the eye: one hundredth of the beam's largest deflection is %.3g m", visible);
}

const struct br_claim br_claim_clamped = {
    .name = "clamped",
    .section = "3.2.1",
    .figure = 2,
    .statement = "The right end of the beam keeps clamped.",
    .measured = "largest |w(L,t)|",
    .unit = "m",
    .measure = measure_clamped,
};

/* The largest |sigma_V| / h over the steps; the first has no stress. */
static double most_used(const struct br_history_record *record)
{
    double most = 0;
    for (size_t i = 1; i < record->rows; i++)
        most = br_larger(most, fabs(record->row[i].friction_force) / record->row[i].friction_bound);
    return most;
}

static void measure_below(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[0];
    f->value = most_used(&e->record);
    f->exact = 0;
    for (size_t i = 1; i < e->exacts; i++)
        f->exact =
            br_larger(f->exact, fabs(e->exact[i].friction_force) / e->exact[i].friction_bound);
    f->error = fabs(f->value - f->exact);
    f->agreement = br_below(f->value, f->error, 1);
    snprintf(f->note, sizeof f->note, "at the figure's time levels, from t = %.3g s on",
             e->exacts > 1 ? e->exact[1].time : NAN);
}

const struct br_claim br_claim_below = {
    .name = "below",
    .section = "3.2.1",
    .figure = 3,
    .statement = "The tangential stress does not achieve the friction bound.",
    .measured = "largest |sigma_V| / h",
    .unit = "1",
    .measure = measure_below,
};

/* The last time at which the tip moves, s. */
static double last_movement(const struct br_history_record *record)
{
    double last = 0;
    for (size_t i = 0; i < record->rows; i++)
        if (fabs(record->row[i].friction_force) >= record->row[i].friction_bound)
            last = record->row[i].time;
    return last;
}

/* The continuous problem slips first: the bound grows slower than the reaction. */
static void measure_stuck(const struct br_paper *p, struct br_finding *f)
{
    const struct br_example *e = &p->example[0];
    double own = NAN;
    f->value = last_movement(&e->record);
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].phase == BR_STICK) {
            f->exact = e->event[i].time;
            own = e->event[i].error;
        }
    f->error = fabs(f->value - f->exact) + own;
    f->agreement = f->exact > own ? BR_DIFFERS : br_below(f->exact, own, 1e-15);
    snprintf(
        f->note, sizeof f->note,
        "the exact tip slips by %.3g m until then; steps of %.3g s jump over it, those of %.3g s "
        "see it end at %.4g s",
        fabs(e->exacts ? e->exact[e->exacts - 1].displacement[BR_BENDING] : NAN),
        e->record.rows > 1 ? e->record.row[1].time : NAN,
        p->early.record.rows > 1 ? p->early.record.row[1].time : NAN,
        last_movement(&p->early.record));
}

const struct br_claim br_claim_stuck = {
    .name = "stuck",
    .section = "3.2.1",
    .figure = 2,
    .statement = "The beam remains stuck to the obstacle.",
    .measured = "time until which the tip slips",
    .unit = "s",
    .measure = measure_stuck,
};

/* ---- the tables ---- */

static void measure_order(const struct br_paper_table *t, struct br_finding *f)
{
    const struct br_cell *cell = t->study.cell;
    const double *own = t->study.judged_by.own_error[0];
    const double error = cell[0].error[BR_PART_TOTAL], half = cell[1].error[BR_PART_TOTAL];
    f->value = log2(error / half);
    f->error = (own[BR_DISPLACEMENT] + t->study.judged_by.own_error[1][BR_DISPLACEMENT]) *
               (1 / error + 1 / half) / M_LN2;
    f->printed = log2(t->printed[0] / t->printed[1]);
    f->agreement = br_above(f->value, f->error, 0.5);
    snprintf(
        f->note, sizeof f->note,
        "n = %zu, k halved to %.3g s: the error against the exact solution goes from %.3e to %.3e "
        "m^(3/2); printed %.3e and %.3e",
        t->n[0], br_time_step(t->study.scene, t->steps[1]), error, half, t->printed[0],
        t->printed[1]);
}

static void measure_cell(const struct br_paper_table *t, struct br_finding *f)
{
    f->value = t->study.cell[0].error[BR_PART_TOTAL];
    f->error = t->study.judged_by.own_error[0][BR_DISPLACEMENT] +
               t->study.judged_by.own_error[1][BR_DISPLACEMENT];
    f->printed = t->printed[0];
    f->agreement = br_same(f, 0.5e-3 * pow(10, floor(log10(f->printed))));
    snprintf(
        f->note, sizeof f->note,
        "printed over ours: %.2f; 'beamrate tables' shows all cells, and that no reference can "
        "repair it",
        f->printed / f->value);
}

#define TABLE(number)                                                                          \
    static void measure_order##number(const struct br_paper *p, struct br_finding *f)          \
    {                                                                                          \
        measure_order(&p->table[number - 1], f);                                               \
    }                                                                                          \
    static void measure_cell##number(const struct br_paper *p, struct br_finding *f)           \
    {                                                                                          \
        measure_cell(&p->table[number - 1], f);                                                \
    }                                                                                          \
    const struct br_claim br_claim_converges##number = {                                       \
        .name = "converges" #number,                                                           \
        .section = "3.2." #number,                                                             \
        .statement = "Table " #number ": the convergence of the numerical scheme is deduced.", \
        .measured = "order in k at n = 100",                                                   \
        .unit = "1",                                                                           \
        .measure = measure_order##number,                                                      \
    };                                                                                         \
    const struct br_claim br_claim_table##number = {                                           \
        .name = "table" #number,                                                               \
        .section = "3.2." #number,                                                             \
        .statement = "Table " #number ": the error at n = 100, k = 0.01 s.",                   \
        .measured = "error (31)",                                                              \
        .unit = "m^(3/2)",                                                                     \
        .measure = measure_cell##number,                                                       \
    }
TABLE(1);
TABLE(2);
