/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's judge: a fine run of the same scheme. It shares every bug of the
 * solver, and has an error of its own. */
#include <math.h>

#include "reference/judge.h"
#include "solver/clock.h"

struct fine {
    struct br_march *march;
    double seconds[2]; /* by br_field_kind */
};

static void fine_free(void *self)
{
    struct fine *f = self;
    if (!f)
        return;
    br_march_free(f->march);
    free(f);
}

static enum br_status fine_create(void **self, const struct br_judge_request *r,
                                  struct br_error *err)
{
    struct fine *f = br_allocate(1, sizeof *f);
    *self = f;
    if (!f)
        return br_no_memory(err, "the reference");
    const double start = br_seconds();
    enum br_status status = br_march_create(&f->march, r->scene, r->n, r->levels, &r->method, err);
    if (!status && r->lead > 0)
        status = br_march_allow_lead(f->march, r->lead, err);
    f->seconds[BR_AXIAL] = br_seconds() - start;
    return status;
}

static enum br_status fine_advance(void *self, enum br_field_kind kind, size_t i,
                                   struct br_error *err)
{
    struct fine *f = self;
    const double start = br_seconds();
    enum br_status status = BR_OK;
    while (!status && br_march_field_steps(f->march, kind) < i)
        status = br_march_step_field(f->march, kind, err);
    f->seconds[kind] += br_seconds() - start;
    return status;
}

/* Its own mesh is the only one. */
static void fine_look(void *self, const struct br_look_at *at, struct br_view *view)
{
    const struct fine *f = self;
    br_look(f->march, at->kind, at->measure, view);
}

static struct br_judge_report fine_report(const void *self)
{
    const struct fine *f = self;
    struct br_judge_report report = {
        .round_off = br_march_round_off(f->march),
        .seconds = f->seconds[BR_AXIAL] + f->seconds[BR_BENDING],
        .unstable = br_march_contact_unstable(f->march),
    };
    for (int measure = 0; measure < BR_MEASURES; measure++)
        report.own_error[BR_AXIAL][measure] = report.own_error[BR_BENDING][measure] = NAN;
    return report;
}

static void fine_tell(const void *self, FILE *out)
{
    (void)self, (void)out;
}

const struct br_judge br_judge_fine = {
    .name = "fine",
    .syntax = "fine:N,K",
    .title = "a run of the same scheme with N elements and steps of K seconds",
    .citation = "Campo et al. 2006, section 3.2.1",
    .nests = true,
    .create = fine_create,
    .free = fine_free,
    .advance = fine_advance,
    .look = fine_look,
    .report = fine_report,
    .tell = fine_tell,
};
