/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's reference: a fine run of the same scheme. It shares every bug of the
 * solver, and has an error of its own. */
#include <math.h>

#include "base/clock.h"
#include "reference/reference.h"

/* Where a step advances both fields, each field has a march of its own. */
struct fine {
    struct br_march *march[2]; /* by br_field_kind; the same where fields go apart */
    bool together;             /* a step is one of both fields */
    double seconds[2];
    struct br_method method;
};

static void fine_free(void *self)
{
    struct fine *f = self;
    if (!f)
        return;
    if (f->march[BR_BENDING] != f->march[BR_AXIAL])
        br_march_free(f->march[BR_BENDING]);
    br_march_free(f->march[BR_AXIAL]);
    free(f);
}

static enum br_status create_march(struct fine *f, enum br_field_kind kind,
                                   const struct br_reference_request *r, struct br_error *err)
{
    const enum br_status status =
        br_march_create(&f->march[kind], r->scene, r->n, r->levels, &r->method, err);
    if (!status && r->observer)
        br_march_stop_when(f->march[kind], r->observer->stop, r->observer->self);
    return status;
}

static enum br_status fine_create(void **self, const struct br_reference_request *r,
                                  struct br_error *err)
{
    struct fine *f = br_allocate(1, sizeof *f);
    *self = f;
    if (!f)
        return br_no_memory(err, "the reference");
    const double start = br_seconds();
    f->method = r->method;
    f->together = r->method.scheme->adaptive;
    enum br_status status = create_march(f, BR_AXIAL, r, err);
    if (!status && f->together)
        status = create_march(f, BR_BENDING, r, err);
    else
        f->march[BR_BENDING] = f->march[BR_AXIAL];
    if (!status && !f->together && r->lead > 0)
        status = br_march_allow_lead(f->march[BR_AXIAL], r->lead, err);
    f->seconds[BR_AXIAL] = br_seconds() - start;
    return status;
}

static enum br_status fine_advance(void *self, enum br_field_kind kind, size_t i,
                                   struct br_error *err)
{
    struct fine *f = self;
    const double start = br_seconds();
    enum br_status status = BR_OK;
    while (!status && br_march_field_steps(f->march[kind], kind) < i)
        status = f->together ? br_march_step(f->march[kind], err)
                             : br_march_step_field(f->march[kind], kind, err);
    f->seconds[kind] += br_seconds() - start;
    return status;
}

/* Its own mesh is the only mesh. */
static void fine_sample(void *self, const struct br_sample_at *at, struct br_view *view)
{
    const struct fine *f = self;
    br_march_sample(f->march[at->kind], at->kind, at->measure, view);
}

/* The predicted round-off at the end, relative to the largest displacement of all times: cells are
 * measured against the same (study/fit/fit.c). br_march_round_off would also cover the first steps.
 */
static double round_off(const struct fine *f)
{
    double largest = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (br_march_models(f->march[kind], kind))
            largest = fmax(largest,
                           br_method_round_off(&f->method, br_march_field(f->march[kind], kind)));
    return largest;
}

static struct br_reference_report fine_report(const void *self)
{
    const struct fine *f = self;
    struct br_reference_report report = {
        .round_off = round_off(f),
        .seconds = f->seconds[BR_AXIAL] + f->seconds[BR_BENDING],
        .unstable = br_march_contact_unstable(f->march[BR_AXIAL]),
    };
    for (int measure = 0; measure < BR_MEASURES; measure++)
        report.own_error[BR_AXIAL][measure] = report.own_error[BR_BENDING][measure] = NAN;
    return report;
}

static void fine_print_notes(const void *self, FILE *out)
{
    (void)self, (void)out;
}

const struct br_reference br_reference_fine = {
    .name = "fine",
    .syntax = "fine:N,K",
    .title = "a run of the same scheme with N elements and steps of K seconds",
    .citation = "Campo et al. 2006, section 3.2.1",
    .nests = true,
    .create = fine_create,
    .free = fine_free,
    .advance = fine_advance,
    .sample = fine_sample,
    .report = fine_report,
    .print_notes = fine_print_notes,
};
