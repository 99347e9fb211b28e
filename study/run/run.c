/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/run/run.h"

#include <math.h>
#include <string.h>

/* Element-steps between two reports of progress. */
enum { BETWEEN_SIGNS = 1 << 18 };

struct observed_run {
    const struct br_run_request *request;
    struct br_run_report *report;
    struct br_step_checker *checker;
    struct br_energy_meter *meter;
};

/* ---- observers ---- */

static enum br_status start_checks(void *self, struct br_march *march, struct br_error *err)
{
    struct observed_run *r = self;
    struct br_run_report *report = r->report;
    if (r->request->progress)
        br_march_stop_when(march, r->request->progress->stop, r->request->progress->self);
    report->round_off = br_march_round_off(march);
    report->limits = br_certificate_limits(report->method.scheme, report->n, report->round_off);
    const double limit = br_energy_limit(report->n, report->round_off);
    report->energy_limit = limit < br_energy_useless ? limit : INFINITY;
    enum br_status status =
        report->summed
            ? br_energy_meter_create(&r->meter, march, &report->marched, &report->method, err)
            : br_energy_sample(march, &report->marched, &report->energy_start, err);
    if (!status && report->checked)
        status =
            br_step_checker_create(&r->checker, march, &report->marched, &r->report->method, err);
    return status;
}

/* The certificate first: its message is more specific. */
static enum br_status verify_step(const struct br_run_report *report,
                                  const struct br_certificate *c, double imbalance,
                                  struct br_error *verdict)
{
    const enum br_status status = br_certificate_check(c, &report->limits, verdict);
    if (status || imbalance <= report->energy_limit)
        return status;
    return br_fail(verdict, BR_VERDICT,
                   "the energy balance is off by %.3g of the sum of its terms, expected at most "
                   "%.3g",
                   imbalance, report->energy_limit);
}

static void check_step(struct observed_run *r, const struct br_history_row *row, double imbalance)
{
    struct br_run_report *report = r->report;
    const struct br_certificate c = br_step_checker_step(r->checker);
    struct br_error verdict = {0};
    br_certificate_merge(&report->worst, &c);
    if (!verify_step(report, &c, imbalance, &verdict))
        return;
    if (report->bad_steps++ == 0)
        br_fail(&report->verdict, BR_VERDICT, "step %zu, t = %.15g s: %.400s", row->step, row->time,
                verdict.message);
}

static enum br_status watch_checks(void *self, const struct br_march *march,
                                   const struct br_history_row *row, struct br_error *err)
{
    (void)march;
    (void)err;
    struct observed_run *r = self;
    if (row->step == 0)
        return BR_OK;
    struct br_run_report *report = r->report;
    const double imbalance = r->meter ? br_energy_meter_step(r->meter) : 0;
    if (isnan(imbalance) || imbalance > report->energy_worst) /* nothing is above NAN */
        report->energy_worst = imbalance;
    if (r->checker)
        check_step(r, row, imbalance);
    return BR_OK;
}

static enum br_status watch_progress(void *self, const struct br_march *march,
                                     const struct br_history_row *row, struct br_error *err)
{
    (void)march;
    const struct br_run_request *q = ((struct observed_run *)self)->request;
    const size_t every = BETWEEN_SIGNS / q->n + 1;
    if (row->step % every != 0)
        return BR_OK;
    if (q->progress->progress)
        q->progress->progress(q->progress->self, (double)row->step / (double)q->steps);
    if (q->progress->stop && q->progress->stop(q->progress->self))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    return BR_OK;
}

enum { MOST_OBSERVERS = BR_MOST_OUTPUTS + 3 };

/* In the order in which they are called. */
static size_t list_observers(struct observed_run *r,
                             struct br_history_observer list[MOST_OBSERVERS])
{
    const struct br_run_request *q = r->request;
    size_t count = 0;
    list[count++] = br_tip_watch_start(&r->report->watch, &r->report->marched, q->steps);
    r->report->watch.trapezoidal = q->method.scheme != br_time_schemes[0];
    list[count++] =
        (struct br_history_observer){.self = r, .begin = start_checks, .step = watch_checks};
    for (size_t i = 0; i < q->outputs && i < BR_MOST_OUTPUTS; i++)
        list[count++] = q->output[i];
    if (q->progress)
        list[count++] = (struct br_history_observer){.self = r, .step = watch_progress};
    return count;
}

/* ---- the run ---- */

/* The last good state's energies: where the works were not summed, those of the last step, which a
 * march that failed has lost. */
static enum br_status read_energies(struct observed_run *r, const struct br_march *march,
                                    struct br_error *err)
{
    struct br_run_report *p = r->report;
    if (p->summed ? !r->meter : p->failure.status)
        return BR_OK;
    p->at_end = true;
    if (!p->summed)
        return br_energy_sample(march, &p->marched, &p->energy_now, err);
    br_energy_meter_read(r->meter, &p->energy_start, &p->energy_now, &p->work);
    return BR_OK;
}

/* Reads what only the march has. */
static void ask_march(struct br_run_report *p, const struct br_march *march)
{
    const struct br_switch *first;
    p->counts = br_march_counts(march);
    p->contact_unstable = br_march_contact_unstable(march);
    p->switches = br_march_switches(march, &first);
    const size_t kept = p->switches < BR_MOST_SWITCHES ? p->switches : BR_MOST_SWITCHES;
    if (kept)
        memcpy(p->switched, first, kept * sizeof *first);
}

/* A failure of the march is a result; one of its observers is not. */
static bool is_result(enum br_status status)
{
    return status == BR_NOT_FINITE || status == BR_SINGULAR;
}

static enum br_status march(struct observed_run *r, struct br_error *err)
{
    const struct br_run_request *q = r->request;
    struct br_run_report *p = r->report;
    struct br_history_observer observers[MOST_OBSERVERS];
    const struct br_history_request history = {
        .scene = &p->marched,
        .method = &p->method,
        .n = q->n,
        .steps = q->steps,
        .stride = q->stride,
        .level = q->level,
        .levels = q->levels,
        .observer = observers,
        .observers = list_observers(r, observers),
    };
    struct br_march *made = NULL;
    enum br_status status = br_history_run(&history, &made, &p->end, &p->failure);
    if (status && (!made || !is_result(status))) {
        br_fail(err, status, "%.1000s", p->failure.message);
    } else {
        ask_march(p, made);
        status = read_energies(r, made, err);
    }
    br_energy_meter_free(r->meter);
    br_step_checker_free(r->checker);
    br_march_free(made);
    return status;
}

enum br_status br_run(const struct br_run_request *q, struct br_run_report *p, struct br_error *err)
{
    *p = (struct br_run_report){
        .scene = q->scene,
        .method = q->method,
        .n = q->n,
        .steps = q->steps,
        .levels = q->levels,
        .h = q->scene->length / (double)q->n,
        .k = q->scene->duration / (double)q->steps,
        .summed = q->check || q->energies,
        .checked = q->check,
    };
    struct observed_run r = {.request = q, .report = p};
    enum br_status status = br_model_select(q->scene, q->wanted, &p->marched, err);
    if (status)
        return status;
    br_run_fill_model(p);
    return march(&r, err);
}
