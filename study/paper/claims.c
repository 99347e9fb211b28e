/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/paper/paper.h"

#include <math.h>
#include <stdio.h>

const char *const br_agreement_names[] = {"agree", "differ", "undecided"};

struct br_finding br_claim_measure(const struct br_claim *claim, const struct br_paper *paper)
{
    struct br_finding f = {
        .value = NAN, .exact = NAN, .error = NAN, .printed = NAN, .agreement = BR_UNDECIDED};
    claim->measure(paper, claim->which, &f);
    if (!(isfinite(f.value) && f.error >= 0))
        f.agreement = BR_UNDECIDED;
    return f;
}

enum br_agreement br_below(double value, double error, double limit)
{
    if (value + error < limit)
        return BR_AGREES;
    return value - error >= limit ? BR_DIFFERS : BR_UNDECIDED;
}

enum br_agreement br_above(double value, double error, double limit)
{
    return br_below(-value, error, -limit);
}

enum br_agreement br_same(const struct br_finding *f, double half_digit)
{
    const double ours = isnan(f->exact) ? f->value : f->exact;
    const double bar = isnan(f->exact) ? f->error : 0;
    const double away = fabs(ours - f->printed);
    if (!(away >= 0 && bar >= 0))
        return BR_UNDECIDED;
    return away <= half_digit + bar ? BR_AGREES : BR_DIFFERS;
}

/* The larger, the smaller; or a NaN if there is one. */
static double larger(double a, double b)
{
    return isnan(a) || isnan(b) ? NAN : fmax(a, b);
}

static double smaller(double a, double b)
{
    return -larger(-a, -b);
}

/* ---- the scheme beside the exact solution ---- */

/* A quantity of a row of an example. */
typedef double of_row(const struct br_example *e, const struct br_history_row *row);

static double deflection(const struct br_example *e, const struct br_history_row *row)
{
    (void)e;
    return fabs(row->displacement[BR_BENDING]);
}

static double share_of_bound(const struct br_example *e, const struct br_history_row *row)
{
    (void)e;
    return fabs(row->friction_force) / row->friction_bound;
}

static double distance_from_bound(const struct br_example *e, const struct br_history_row *row)
{
    return fabs(share_of_bound(e, row) - 1);
}

static double opening(const struct br_example *e, const struct br_history_row *row)
{
    return e->scene.contact.gap - row->displacement[BR_AXIAL];
}

/* The largest over the steps; the row of t = 0 has no stress yet. */
static double most(const struct br_example *e, const struct br_history_row *row, size_t rows,
                   of_row *of)
{
    double value = -INFINITY;
    for (size_t i = 1; i < rows; i++)
        value = larger(value, of(e, &row[i]));
    return value;
}

static void compare_most(const struct br_example *e, of_row *of, struct br_finding *f)
{
    f->value = most(e, e->record.row, e->record.rows, of);
    f->exact = most(e, e->exact, e->exacts, of);
    f->error = fabs(f->value - f->exact);
}

/* The time of a row, s. */
static double time_of(const struct br_history_row *row, size_t rows, size_t i)
{
    return i < rows ? row[i].time : NAN;
}

/* The last of an example's events that begins one of two phases; NULL: none. */
static const struct br_exact_event *last_event(const struct br_example *e, enum br_phase a,
                                               enum br_phase b)
{
    const struct br_exact_event *last = NULL;
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].phase == a || e->event[i].phase == b)
            last = &e->event[i];
    return last;
}

/* ---- Example 1: stick ---- */

/* The largest |w| over the beam at the figure's times, m. */
static double most_of_beam(const struct br_history_record *record)
{
    double value = 0;
    for (size_t sample = 0; sample < record->samples; sample++) {
        const double *nodal = br_history_field(record, sample, BR_BENDING, false);
        for (size_t node = 0; node <= record->n; node++)
            value = larger(value, fabs(nodal[2 * node]));
    }
    return value;
}

/* What the eye can see in Figure 2: a hundredth of the beam's largest deflection. */
enum { VISIBLE = 100 };

static void measure_clamped(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    const double visible = most_of_beam(&e->record) / VISIBLE;
    compare_most(e, deflection, f);
    f->agreement = br_below(f->value, f->error, visible);
    snprintf(f->note, sizeof f->note,
             "visible in a picture: one hundredth of the beam's largest deflection, %.3g m",
             visible);
}

static void measure_below(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    compare_most(e, share_of_bound, f);
    f->agreement = br_below(f->value, f->error, 1);
    snprintf(f->note, sizeof f->note, "at the figure's time levels, from t = %.3g s on",
             time_of(e->exact, e->exacts, 1));
}

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
static void measure_stuck(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    const struct br_exact_event *stick = last_event(e, BR_STICK, BR_STICK);
    const double own = stick ? stick->error : NAN;
    f->value = last_movement(&e->record);
    f->exact = stick ? stick->time : NAN;
    f->error = fabs(f->value - f->exact) + own;
    f->agreement = f->exact > own ? BR_DIFFERS : br_below(f->exact, own, 1e-15);
    snprintf(
        f->note, sizeof f->note,
        "the exact tip slips by %.3g m until then; steps of %.3g s are too long for this slip, "
        "with those of %.3g s it ends at %.4g s",
        fabs(e->exacts ? e->exact[e->exacts - 1].displacement[BR_BENDING] : NAN),
        time_of(e->record.row, e->record.rows, 1),
        time_of(p->early.record.row, p->early.record.rows, 1), last_movement(&p->early.record));
}

/* ---- the tables ---- */

/* What the exact solution of a table's cells may be off by, m^(3/2). */
static double error_of_exact(const struct br_paper_table *t)
{
    const struct br_reference_report *reference = &t->study.reference_report;
    return reference->own_error[0][BR_DISPLACEMENT] + reference->own_error[1][BR_DISPLACEMENT];
}

static void measure_order(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_paper_table *t = &p->table[which];
    const struct br_cell *cell = t->study.cell;
    const double error = cell[0].error[BR_PART_TOTAL], half = cell[1].error[BR_PART_TOTAL];
    f->value = log2(error / half);
    f->error = error_of_exact(t) * (1 / error + 1 / half) / M_LN2;
    f->agreement = br_above(f->value, f->error, 0.5);
    snprintf(
        f->note, sizeof f->note,
        "n = %zu, k halved to %.3g s: the error against the exact solution goes from %.3e to %.3e "
        "m^(3/2); printed %.3e and %.3e",
        t->n[0], br_time_step(t->study.scene, t->steps[1]), error, half, t->printed[0],
        t->printed[1]);
}

static void measure_cell(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_paper_table *t = &p->table[which];
    f->value = t->study.cell[0].error[BR_PART_TOTAL];
    f->error = error_of_exact(t);
    f->printed = t->printed[0];
    f->agreement = br_same(f, 0.5e-3 * pow(10, floor(log10(f->printed))));
    snprintf(f->note, sizeof f->note,
             "printed over ours: %.2f; 'beamrate tables' shows all cells, and that no choice of "
             "reference explains this",
             f->printed / f->value);
}

/* ---- Example 2 ---- */

/* The time of the steps at rest, s; *slowest: the least |w_t(L)| after t = 0, m/s. */
static double resting(const struct br_history_record *record, double *slowest)
{
    size_t steps = 0;
    *slowest = INFINITY;
    for (size_t i = 1; i < record->rows; i++) {
        const double speed = fabs(record->row[i].velocity[BR_BENDING]);
        steps += !(speed > 0);
        *slowest = smaller(*slowest, speed);
    }
    return (double)steps * time_of(record->row, record->rows, 1);
}

static double exact_rest(const struct br_example *e)
{
    double rest = 0, since = NAN;
    for (size_t i = 0; i < e->events; i++) {
        if (e->event[i].field != BR_BENDING)
            continue;
        if (!isnan(since))
            rest += e->event[i].time - since;
        since = e->event[i].phase == BR_STICK ? e->event[i].time : NAN;
    }
    return rest + (isnan(since) ? 0 : e->scene.duration - since);
}

static void measure_moves(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    double slowest;
    f->value = resting(&e->record, &slowest);
    f->exact = exact_rest(e);
    f->error = fabs(f->value - f->exact);
    f->agreement = f->value + f->error > 0 ? BR_DIFFERS : BR_AGREES;
    snprintf(f->note, sizeof f->note, "the slowest step moves at %.3g m/s", slowest);
}

static void measure_at_bound(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    compare_most(e, distance_from_bound, f);
    f->agreement = br_below(f->value, f->error, 1e-9);
}

/* ---- Example 3 ---- */

static void measure_decouples(const struct br_paper *p, size_t which, struct br_finding *f)
{
    (void)which;
    f->value = p->coupled;
    f->exact = f->error = 0; /* (2), (4), (9), (11), (12) (i) contain no axial displacement */
    f->agreement = br_below(f->value, 0, 1e-15);
    snprintf(f->note, sizeof f->note, "with the rod and the contact of Example 1 added");
}

/* The last row at which the tip has not moved; 0: none. */
static size_t last_at_rest(const struct br_history_record *record)
{
    size_t i = 1;
    while (i < record->rows && fabs(record->row[i].friction_force) < record->row[i].friction_bound)
        i++;
    return i - 1;
}

/* Theory: with a load q(t) L the propped cantilever's reaction is 3/8 q L; the bound is c_V. */
static double theory_release(const struct br_scene *scene)
{
    const double time = scene->duration;
    const double q = br_load_value(&scene->bending.load, scene->length / 2, time);
    return scene->friction.coefficient / (0.375 * fabs(q) / time * scene->length);
}

static void measure_release(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    const struct br_exact_event *slip = last_event(e, BR_SLIP_DOWN, BR_SLIP_UP); /* for good */
    f->value = e->record.row[last_at_rest(&e->record)].time;
    f->exact = slip ? slip->time : NAN;
    f->error = fabs(f->value - f->exact) + (slip ? slip->error : NAN) +
               e->record.row[1].time; /* known to a step */
    f->printed = 0.68;
    f->agreement = br_same(f, 0.005);
    snprintf(
        f->note, sizeof f->note,
        "theory, 3/8 q L = c_V: %.10g s; at t = %.3g s the scheme's stress is %.1f N of %.0f N",
        theory_release(&e->scene), e->record.at[2].time, fabs(e->record.at[2].friction_force),
        e->scene.friction.coefficient);
}

static void measure_reaches(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    const size_t first = last_at_rest(&e->record) + 1; /* that slips */
    f->value = first < e->record.rows ? fabs(e->record.row[first].friction_force) : NAN;
    f->exact = f->printed = e->scene.friction.coefficient; /* (12): slip at the bound only */
    f->error = fabs(f->value - f->exact);
    f->agreement = br_below(f->error, 0, 1e-9 * f->exact);
}

/* ---- Example 4 ---- */

static void measure_penetrates(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_example *e = &p->example[which];
    const bool opens = last_event(e, BR_OPEN, BR_OPEN);
    compare_most(e, opening, f);
    f->value = -f->value; /* the least penetration is the largest opening */
    f->exact = -f->exact;
    f->agreement = opens ? BR_DIFFERS : br_above(f->exact, 0, 0);
    snprintf(f->note, sizeof f->note,
             "the least is that of the first step, %.3g s; the exact contact %s",
             time_of(e->record.row, e->record.rows, 1),
             opens ? "opens" : "never opens after t = 0");
}

/* ---- Figure 10 ---- */

/* The norm over the coefficients of contact and friction. Stable: at both ends of the sweep the
 * norm settles, and between them it stays below the larger end. */

/* The contact at the new step, at the figures' h and k or at twice that. */
static double norm_at(const struct br_sweep *s, size_t i, bool doubled)
{
    return s->point[i].most[doubled ? 2 : 1];
}

/* The larger relative change over the first and the last decade. */
static double unsettled(const struct br_sweep *s, size_t decade, bool doubled)
{
    const size_t last = s->points - 1;
    return larger(fabs(norm_at(s, decade, doubled) / norm_at(s, 0, doubled) - 1),
                  fabs(norm_at(s, last - decade, doubled) / norm_at(s, last, doubled) - 1));
}

static void measure_sweep(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_sweep *s = &p->sweep[which];
    const size_t last = s->points - 1;
    const double low = norm_at(s, 0, false), high = norm_at(s, last, false);
    double largest = 0;
    for (size_t i = 0; i <= last; i++)
        largest = larger(largest, norm_at(s, i, false));
    f->value = unsettled(s, p->request.per_decade, false);
    f->error = fabs(f->value - unsettled(s, p->request.per_decade, true));
    f->agreement = br_below(f->value, f->error, 0.01);
    if (!(largest <= 1.01 * fmax(low, high)))
        f->agreement = BR_DIFFERS;
    snprintf(
        f->note, sizeof f->note,
        "largest norm over time: %.4g m^(3/2) at %.3g N/m, %.4g at %.3g N/m, nowhere above %.4g",
        low, s->point[0].coefficient, high, s->point[last].coefficient, largest);
}

/* The scheme as printed, far beyond its limit. */
static void measure_printed(const struct br_paper *p, size_t which, struct br_finding *f)
{
    const struct br_sweep *s = &p->sweep[which];
    const struct br_sweep_point *last = &s->point[s->points - 1], *before = last - 1;
    double limit = NAN;
    for (size_t i = s->points; i-- > 0;)
        if (s->point[i].unstable)
            limit = s->point[i].coefficient;
    f->value = last->most[0] / last->most[1];
    f->error = fabs(f->value - before->most[0] / before->most[1]); /* it is chaotic */
    f->agreement = br_below(f->value, f->error, 2);
    snprintf(f->note, sizeof f->note,
             "the lagged contact amplifies from c_H = %.3g N/m on at this k, and its tip chatters: "
             "%.3g against %.3g m^(3/2) at c_H = %.3g N/m",
             limit, last->most[0], last->most[1], last->coefficient);
}

/* ---- the claims ---- */

const struct br_claim br_claims[] = {
    {"converges1", "3.2.1", 0, "Table 1: the convergence of the numerical scheme is deduced.",
     "order in k at n = 100", "1", measure_order, 0},
    {"table1", "3.2.1", 0, "Table 1: the error at n = 100, k = 0.01 s.", "error (31)", "m^(3/2)",
     measure_cell, 0},
    {"clamped", "3.2.1", 2, "The right end of the beam keeps clamped.", "largest |w(L,t)|", "m",
     measure_clamped, 0},
    {"below", "3.2.1", 3, "The tangential stress does not achieve the friction bound.",
     "largest |sigma_V| / h", "1", measure_below, 0},
    {"stuck", "3.2.1", 2, "The beam remains stuck to the obstacle.",
     "time until which the tip slips", "s", measure_stuck, 0},
    {"converges2", "3.2.2", 0, "Table 2: the convergence of the numerical scheme is deduced.",
     "order in k at n = 100", "1", measure_order, 1},
    {"table2", "3.2.2", 0, "Table 2: the error at n = 100, k = 0.01 s.", "error (31)", "m^(3/2)",
     measure_cell, 1},
    {"moves", "3.2.2", 4, "There is always movement of the contact node.", "time at rest", "s",
     measure_moves, 1},
    {"at-bound", "3.2.2", 4, "The tangential stress equals the friction bound.",
     "largest ||sigma_V| / h - 1|", "1", measure_at_bound, 1},
    {"decouples", "3.2.3", 0, "With Tresca's conditions the problem decouples.",
     "how far an axial field moves w(L,t)", "m", measure_decouples, 2},
    {"release", "3.2.3", 5, "The contact node is clamped until time t = 0.68 s.",
     "last time at rest", "s", measure_release, 2},
    {"reaches", "3.2.3", 6,
     "It lets go when the tangential stress reaches the friction bound, 3000 N.",
     "|sigma_V| in the first step that slips", "N", measure_reaches, 2},
    {"penetrates", "3.2.4", 7, "There is always penetration of the beam into the obstacle.",
     "least u(L,t) - g for t > 0", "m", measure_penetrates, 3},
    {"stable-c_H", "3.2.4", 10,
     "The stability of the solution is clearly observed, depending on c_H (contact force "
     "at the new step).",
     "largest relative change over the outermost decades", "1", measure_sweep, BR_SWEEP_CONTACT},
    {"stable-printed", "3.2.4", 10,
     "The same by the scheme as printed, with the contact force of the step before.",
     "norm over that with the contact at the new step, at the largest c_H", "1", measure_printed,
     BR_SWEEP_CONTACT},
    {"stable-c_V", "3.2.4", 10,
     "The stability of the solution is clearly observed, depending on c_V.",
     "largest relative change over the outermost decades", "1", measure_sweep, BR_SWEEP_FRICTION},
    {0},
};
