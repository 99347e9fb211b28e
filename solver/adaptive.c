/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps by a tolerance, and the times of switching.
 *
 * Between switches the laws at the tip are smooth: open or closed, stick, slip up or down. So a
 * step keeps the branch on which it began active in all its stages, and the scheme keeps its order.
 * Each branch has a margin that is not negative while it is the right one: the gap or the
 * penetration, h - |lambda| of a tip that sticks, the velocity of one that slips. Where the margin
 * is negative at the step's end, at a stage or between them (br_margins), the step is rejected, and
 * a search finds the length at which the margin is zero. The next step is short, and finds its
 * branches by the laws themselves in its first stage. If a branch is wrong from the start of a
 * step, no search is possible: then a small step uses the laws themselves.
 *
 * A field without inertia and viscosity, or with so little that it follows a load within the least
 * step, jumps where its load does, mostly at the start from rest. No step resolves the jump, and
 * none needs to: the end of a step obeys the equations whatever the state before was. So the least
 * step is accepted, and the scheme restarts after it.
 *
 * The error of a step is estimated in strains (br_field_march_estimate), relative to the largest so
 * far, or to that of a rough march (below). */
#include <gsl/gsl_roots.h>
#include <math.h>
#include <string.h>

#include "solver/march_state.h"

static const double first_step = 1e-7;   /* of the duration */
static const double after_switch = 0.01; /* of the step before it */
static const double least_step = 1e-13;  /* of the duration */
static const double safety = 0.85, most_growth = 5, most_shrinking = 0.1;
static const double idle_growth = 1.4;       /* a smaller growth is not worth new tables */
static const double search_from = 1e-3;      /* of a step: in shorter ones the force is round-off */
static const double switch_accuracy = 1e-12; /* of the step in which it lies */
static const double least_progress = 1e-9;   /* of the duration, between two switches */
static const size_t most_stalled = 200;
static const double met_switch = 1e-10; /* of the margin at the step's beginning */

struct br_adaptive {
    double now, next;      /* time reached and length of the next step, s */
    double largest[2];     /* strain of each field so far, or of a rough march */
    size_t since;          /* steps since the start or the last switch */
    size_t stalled;        /* steps in a row that a switch has made extremely short */
    bool known;            /* the branches of the laws are known */
    bool free;             /* no branch is kept active */
    enum br_regime old[2]; /* the branches before the last switch */
    struct br_switch found[BR_MOST_SWITCHES];
    size_t found_count; /* all switches, also those that are not in `found` */
};

static void recall_all(struct br_march *m, int known)
{
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (m->field[kind].modelled)
            br_field_march_recall(&m->field[kind], known);
}

static void take_back(struct br_march *m, const struct br_tip *tip)
{
    recall_all(m, BR_NOW);
    m->tip = *tip;
}

/* ---- a trial ---- */

struct trial {
    double k, error; /* s; relative to the tolerance */
    double lasting;  /* the error of fields that do not jump */
    struct br_stages stages;
    double strain[2];
};

/* Whether a field's law has branches that a step can keep active. A contact without stiffness has
 * no force, but a bound that follows it has a kink where the tip passes the gap. */
static bool has_branches(const struct br_march *m, enum br_field_kind kind)
{
    const struct br_contact *contact = &m->scene->contact;
    if (kind == BR_AXIAL)
        return br_contact_pushes(contact) ||
               (contact->modelled && br_friction_follows_contact(&m->scene->friction));
    return m->scene->friction.law != BR_FRICTIONLESS && !m->method.friction->needs_regularisation;
}

/* Finds the active branch of each law from a first stage by the laws themselves. */
static enum br_status find_branches(struct br_march *m, const struct br_stages *stages,
                                    const struct br_step *step, struct br_error *err)
{
    struct br_adaptive *a = m->adaptive;
    struct br_stages first = *stages;
    first.count = 1;
    const struct br_tip tip = m->tip;
    enum br_status status = BR_OK;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        m->keeps_branch[kind] = false;
        if (!m->field[kind].modelled)
            continue;
        status = br_march_stages(m, kind, &first, step, m->path, err);
        m->regime[kind] = br_march_regime(m, kind);
    }
    take_back(m, &tip);
    a->known = true;
    return status;
}

/* Whether a field follows a load within the least step. */
static bool jumps(const struct br_march *m, const struct br_field *f)
{
    const double least = least_step * m->scene->duration;
    return f->viscosity <= least * f->stiffness &&
           f->density <= least * (least * f->stiffness * br_field_lowest_mode(f));
}

static void record_error(const struct br_march *m, enum br_field_kind kind, double error,
                         struct trial *trial)
{
    const double scale =
        m->method.tolerance * fmax(trial->strain[kind], m->adaptive->largest[kind]);
    double relative = error > 0 ? INFINITY : 0;
    if (!isfinite(error))
        relative = INFINITY;
    else if (scale > 0)
        relative = error / scale;
    trial->error = fmax(trial->error, relative);
    if (!jumps(m, &m->field[kind].field) || !isfinite(error))
        trial->lasting = fmax(trial->lasting, relative);
}

static enum br_status try_fields(struct br_march *m, const struct br_step *step,
                                 struct trial *trial, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        struct br_field_march *fm = &m->field[kind];
        if (!fm->modelled)
            continue;
        m->keeps_branch[kind] = !m->adaptive->free && has_branches(m, kind);
        m->margins[kind].count = 0;
        if (m->keeps_branch[kind] && m->adaptive->since > 0) /* else another branch's margin */
            br_margins_add(&m->margins[kind], 0, br_march_margin(m, kind));
        status = br_march_stages(m, kind, &trial->stages, step, m->path, err);
        if (status)
            break;
        double error;
        br_field_march_estimate(fm, &trial->stages, &error, &trial->strain[kind]);
        record_error(m, kind, error, trial);
    }
    return status;
}

/* Tries a step of length k from the march's state; the state is then its result. */
static enum br_status try_step(struct br_march *m, double k, struct trial *trial,
                               struct br_error *err)
{
    const double now = m->adaptive->now;
    const struct br_step step = {now, now + k, k};
    *trial = (struct trial){.k = k};
    br_time_scheme_step(m->method.scheme, m->adaptive->since, &trial->stages);
    enum br_status status = BR_OK;
    if (!m->adaptive->known)
        status = find_branches(m, &trial->stages, &step, err);
    return status ? status : try_fields(m, &step, trial, err);
}

/* ---- switches ---- */

struct search {
    struct br_march *march;
    const struct br_tip *tip; /* where the step begins */
    enum br_field_kind kind;
    double beyond;  /* the margin after the switch */
    bool bracketed; /* the margin had the sign before the switch at first */
    struct trial trial;
    enum br_status status;
    struct br_error *err;
};

/* The margin at the end of a step of length k. */
static double margin_after(double k, struct search *s)
{
    if (s->status)
        return 0;
    take_back(s->march, s->tip);
    s->status = try_step(s->march, k, &s->trial, s->err);
    return s->status ? 0 : br_march_margin(s->march, s->kind);
}

/* The margin for GSL. A margin of 0 counts as before the switch: a tip that rests at the gap has
 * the margin 0 until it leaves the gap, which is the switch. The search is then a bisection. */
static double margin_to_cross(double k, void *params)
{
    struct search *s = params;
    const double margin = margin_after(k, s);
    return margin == 0 ? -s->beyond : margin;
}

/* Shortens a step whose end is beyond the switch of one field, to an end just before that switch: a
 * load that jumps at the switch has not jumped there. The state is then the result of the shorter
 * step. */
static enum br_status find_switch(struct search *s, double longest)
{
    gsl_function f = {.function = margin_to_cross, .params = s};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (!solver)
        return br_no_memory(s->err, "a search for a switch");
    const double least = fmax(least_step * s->march->scene->duration, search_from * longest);
    int code = gsl_root_fsolver_set(solver, &f, least, longest);
    s->bracketed = code == 0;
    double k = least;
    for (int i = 0; i < 60 && !code && !s->status; i++) {
        code = gsl_root_fsolver_iterate(solver);
        k = fmax(gsl_root_fsolver_x_lower(solver), least);
        if (!(gsl_root_fsolver_x_upper(solver) - k > switch_accuracy * longest))
            break;
    }
    gsl_root_fsolver_free(solver);
    s->march->adaptive->free = !s->bracketed; /* off the branch at once: use the laws themselves */
    if (!s->status)
        margin_after(k, s);
    s->march->adaptive->free = false;
    return s->status;
}

/* ---- steps ---- */

/* Records the switches. The first step after a switch shows the new branch of the law. Both fields
 * may have switched. */
static void report_switches(struct br_march *m)
{
    struct br_adaptive *a = m->adaptive;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        if (!m->field[kind].modelled || m->regime[kind] == a->old[kind])
            continue;
        if (a->found_count < BR_MOST_SWITCHES)
            a->found[a->found_count] =
                (struct br_switch){a->now, kind, a->old[kind], m->regime[kind]};
        a->found_count++;
    }
}

size_t br_adaptive_switches(const struct br_adaptive *a, const struct br_switch **first)
{
    *first = a->found;
    return a->found_count;
}

static void accept(struct br_march *m, const struct trial *trial, bool switched)
{
    struct br_adaptive *a = m->adaptive;
    if (a->since == 0 && a->now > 0)
        report_switches(m);
    memcpy(a->old, m->regime, sizeof a->old);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        a->largest[kind] = fmax(a->largest[kind], trial->strain[kind]);
        if (m->field[kind].modelled)
            br_march_accept(m, kind, &trial->stages, switched);
    }
    a->known = !switched;
    a->since = switched ? 0 : a->since + 1;
}

/* The next step's length by the error estimate, s. */
static double next_length(const struct br_march *m, const struct trial *trial)
{
    const double order = m->method.scheme->estimate_order;
    const double factor = trial->error > 0 ? safety * pow(trial->error, -1 / order) : most_growth;
    if (!(factor > most_shrinking))
        return most_shrinking * trial->k;
    if (factor > 1 && factor < idle_growth)
        return trial->k;
    return fmin(factor, most_growth) * trial->k;
}

/* Takes a step of at most k, s, whose error estimate is small enough. */
static enum br_status estimated_step(struct br_march *m, double k, struct trial *trial,
                                     struct br_error *err)
{
    struct br_adaptive *a = m->adaptive;
    const double least = least_step * m->scene->duration;
    const struct br_tip tip = m->tip;
    const bool fresh = !a->known;
    for (;;) {
        const enum br_status status = try_step(m, k, trial, err);
        if (status)
            return status;
        const bool jump = !(k > least) && trial->lasting <= 1;
        if (trial->error <= 1 || jump)
            return BR_OK;
        m->counts.rejected++;
        take_back(m, &tip);
        a->known = !fresh;
        if (!(k > least))
            return br_fail(err, BR_NOT_FINITE,
                           "scheme %s: at t = %.17g s no step is small enough: with %g s the "
                           "estimated error is %g times the tolerance of %g",
                           m->method.scheme->name, a->now, trial->k, trial->error,
                           m->method.tolerance);
        k = a->next = fmax(next_length(m, trial), least);
    }
}

/* If the step has gone beyond a switch of a field's law, shortens it to end at the switch. If only
 * the stages or their polynomial show a switch, the margin at the end of a step to that time has to
 * confirm it. */
static enum br_status stop_at_switch(struct br_march *m, const struct br_tip *tip,
                                     enum br_field_kind kind, struct trial *trial, bool *switched,
                                     struct br_error *err)
{
    const double dip = br_margins_dip(&m->margins[kind]), k = dip * trial->k;
    const double end = br_march_margin(m, kind), whole = trial->k;
    struct search search = {
        .march = m, .tip = tip, .kind = kind, .beyond = end, .trial = *trial, .err = err};
    if (!(dip > 0))
        return BR_OK;
    if (dip < 1)
        search.beyond = margin_after(k, &search);
    if (!search.status && search.beyond < 0) {
        search.status = find_switch(&search, k);
        *switched |= search.bracketed || end < 0;
    }
    /* The tip is off the branch from the start, but on it at the end: such a start dies away, and
     * the whole step is taken. */
    if (!search.status && search.beyond < 0 && !search.bracketed && !(end < 0))
        margin_after(whole, &search);
    *trial = search.trial;
    return search.status;
}

/* Whether a step ends on a switch, for example at a time level. The rest of the way to the switch
 * would be a step so short that the tip's force in it is round-off. */
static bool meets_switch(const struct br_margins *m)
{
    return m->count > 1 && m->time[0] == 0 && m->margin[0] > 0 &&
           m->margin[m->count - 1] <= met_switch * m->margin[0];
}

static enum br_status stop_at_switches(struct br_march *m, const struct br_tip *tip,
                                       struct trial *trial, bool *switched, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        if (m->keeps_branch[kind]) {
            status = stop_at_switch(m, tip, kind, trial, switched, err);
            *switched |= meets_switch(&m->margins[kind]);
        }
    return status;
}

/* Fails after too many switches in a row: no branch of contradictory laws would hold. */
static enum br_status check_progress(struct br_march *m, const struct trial *trial, bool switched,
                                     struct br_error *err)
{
    struct br_adaptive *a = m->adaptive;
    const bool moved = !switched || trial->k > least_progress * m->scene->duration;
    a->stalled = moved ? 0 : a->stalled + 1;
    if (a->stalled < most_stalled)
        return BR_OK;
    return br_fail(err, BR_NOT_FINITE,
                   "scheme %s: at t = %.17g s %zu switches in a row lie within %g s: no branch of "
                   "the laws at the tip holds",
                   m->method.scheme->name, a->now, a->stalled,
                   (double)a->stalled * least_progress * m->scene->duration);
}

static enum br_status check_going_on(const struct br_march *m, struct br_error *err)
{
    const size_t most = m->method.most_steps;
    if (m->stop && m->stop(m->stop_self))
        return br_fail(err, BR_INTERRUPTED, "interrupted at t = %.15g s", m->adaptive->now);
    const struct br_counts counts = br_march_counts(m);
    if (most == 0 || counts.steps + counts.rejected < most)
        return BR_OK;
    return br_fail(err, BR_INTERRUPTED, "scheme %s: at t = %g s the limit of %zu steps is reached",
                   m->method.scheme->name, m->adaptive->now, most);
}

/* Advances by at most `longest`, s. */
static enum br_status adaptive_step(struct br_march *m, double longest, struct br_error *err)
{
    struct br_adaptive *a = m->adaptive;
    const struct br_tip tip = m->tip;
    const double wanted = a->next;
    const double k = wanted >= longest ? longest : fmin(wanted, longest / 2);
    struct trial trial;
    enum br_status status = check_going_on(m, err);
    if (!status)
        status = estimated_step(m, k, &trial, err);
    if (status)
        return status;
    const double whole = trial.k;
    bool switched = !(trial.error <= 1); /* a jump */
    status = stop_at_switches(m, &tip, &trial, &switched, err);
    if (status)
        return status;
    if (switched)
        a->next = fmax(after_switch * whole, first_step * m->scene->duration);
    else if (k < wanted && whole == k) /* shortened by a time level: its error says little */
        a->next = fmax(fmin(wanted, most_growth * k), next_length(m, &trial));
    else
        a->next = next_length(m, &trial);
    accept(m, &trial, switched);
    a->now += trial.k;
    return check_progress(m, &trial, switched, err);
}

/* ---- a rough size ---- */

/* An estimate of the size of the solution. A solution that starts at rest is zero at first, so that
 * its first errors need another size to compare with.
 *
 * Two rough marches have no common times. The smaller size of the two is used, since a short
 * impulse at a time of one march acts in it for a whole step. But the size of a march is not used
 * if its times are the zeros of a load. */

/* The largest strains (out) of a few Euler steps to the end. */
static enum br_status rough_march(struct br_march *m, int steps, double largest[2],
                                  struct br_error *err)
{
    static const struct br_stages euler = {.count = 1, .stage = {{1, 1, {[BR_NOW] = 1}}}};
    const double T = m->scene->duration;
    const struct br_tip tip = m->tip;
    enum br_status status = BR_OK;
    largest[0] = largest[1] = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (m->field[kind].modelled)
            br_field_march_keep(&m->field[kind], BR_STAGE);
    for (int n = 0; n < steps && !status; n++) {
        const struct br_step step = {T * n / steps, T * (n + 1) / steps, T / steps};
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
            struct br_field_march *fm = &m->field[kind];
            double size[2];
            if (!fm->modelled)
                continue;
            status = br_march_stages(m, kind, &euler, &step, m->path, err);
            fm->solver->size(fm->state, 0, size);
            largest[kind] = fmax(largest[kind], size[0]);
        }
    }
    recall_all(m, BR_STAGE);
    m->tip = tip;
    return status;
}

/* Estimates the largest strains (out) until the end; the march's state is not changed. */
static enum br_status rough_size(struct br_march *m, double largest[2], struct br_error *err)
{
    const double nothing = 1e-10;
    double one[2], other[2];
    enum br_status status = rough_march(m, 16, one, err);
    if (!status)
        status = rough_march(m, 11, other, err);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++) {
        const double larger = fmax(one[kind], other[kind]), smaller = fmin(one[kind], other[kind]);
        largest[kind] = smaller > nothing * larger ? smaller : larger;
    }
    return status;
}

/* ---- a march ---- */

enum br_status br_adaptive_create(struct br_march *m, struct br_error *err)
{
    m->adaptive = br_allocate(1, sizeof *m->adaptive);
    if (!m->adaptive)
        return br_no_memory(err, "a march");
    m->adaptive->next = first_step * m->scene->duration;
    return rough_size(m, m->adaptive->largest, err);
}

enum br_status br_adaptive_advance(struct br_march *m, struct br_error *err)
{
    struct br_adaptive *a = m->adaptive;
    const size_t level = m->field[BR_AXIAL].done + 1;
    const double end = m->scene->duration * (double)level / (double)m->steps;
    const double least = least_step * m->scene->duration;
    while (end - a->now > least) {
        enum br_status status = adaptive_step(m, end - a->now, err);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
            status = br_march_check_finite(m, kind, a->now, err);
        if (status)
            return status;
    }
    a->now = end;
    return BR_OK;
}

/* ---- margins ---- */

void br_margins_add(struct br_margins *m, double time, double margin)
{
    m->time[m->count] = time;
    m->margin[m->count++] = margin;
}

/* The Lagrange polynomial through all margins. */
static double interpolate(const struct br_margins *m, double time)
{
    double sum = 0;
    for (size_t i = 0; i < m->count; i++) {
        double weight = 1;
        for (size_t j = 0; j < m->count; j++)
            if (j != i)
                weight *= (time - m->time[j]) / (m->time[i] - m->time[j]);
        sum += weight * m->margin[i];
    }
    return sum;
}

double br_margins_dip(const struct br_margins *m)
{
    enum { POINTS = 64 };
    const double round_off = 1e-13;
    double first = 0, begin = 1, largest = 0;
    for (size_t i = 0; i < m->count; i++) {
        if (m->time[i] > 0 && m->margin[i] < 0 && (first == 0 || m->time[i] < first))
            first = m->time[i];
        begin = fmin(begin, m->time[i]);
        largest = fmax(largest, fabs(m->margin[i]));
    }
    if (first > 0)
        return first;
    double lowest = -round_off * largest;
    for (int i = 1; i < POINTS; i++) {
        const double time = begin + (1 - begin) * i / POINTS, margin = interpolate(m, time);
        if (margin < lowest) {
            lowest = margin;
            first = time;
        }
    }
    return first;
}
