/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/ida_march.h"

#include <float.h>
#include <ida/ida.h>
#include <math.h>
#include <string.h>
#include <sunlinsol/sunlinsol_band.h>

enum { MOST_STEPS = 2000000 };

/* Of the terms of lambda, of the scales. */
static const double reaction_noise = 1e-8, motion_noise = 1e-13;

/* ---- failures ---- */

static enum br_status fail(const struct br_ida_march *m, const char *what, struct br_error *err)
{
    return br_fail(err, BR_NOT_FINITE,
                   "scheme ida stopped at t = %.9g s: %s; expected with tolerance %g and %zu "
                   "elements to reach %g s. A larger tolerance, fewer elements or scheme adaptive "
                   "may help",
                   m->reached, what, m->tolerance, m->system.field[BR_AXIAL].n,
                   m->system.scene->duration);
}

/* What IDA or a function that it called has said. */
static enum br_status ida_failed(const struct br_ida_march *m, const char *call, int flag,
                                 struct br_error *err)
{
    if (m->system.err.status)
        return br_fail(err, m->system.err.status, "%.900s", m->system.err.message);
    char *name = IDAGetReturnFlagName(flag);
    char what[400];
    snprintf(what, sizeof what, "%s gave %s%s%s", call, name ? name : "an error",
             m->said[0] ? ", " : "", m->said);
    free(name);
    return fail(m, what, err);
}

/* ---- steps ---- */

void br_ida_add_counts(const struct br_ida_march *m, struct br_counts *counts)
{
    long steps = 0, rejected = 0, unsolved = 0, solves = 0, set_ups = 0;
    IDAGetNumSteps(m->ida, &steps);
    IDAGetNumErrTestFails(m->ida, &rejected);
    IDAGetNumNonlinSolvConvFails(m->ida, &unsolved);
    IDAGetNumNonlinSolvIters(m->ida, &solves);
    IDAGetNumJacEvals(m->ida, &set_ups);
    counts->steps += (size_t)steps;
    counts->rejected += (size_t)(rejected + unsolved);
    counts->stages += (size_t)solves;
    counts->set_ups += (size_t)set_ups;
}

void br_ida_violated(const struct br_ida_march *m, double error, bool violated[BR_IDA_LAWS])
{
    const struct br_ida_system *s = &m->system;
    double margin[BR_IDA_LAWS], noise[BR_IDA_LAWS] = {0};
    const double *y = N_VGetArrayPointer(m->y), *rate = N_VGetArrayPointer(m->rate);
    br_ida_margins(s, y, rate, margin);
    const double motion = fmax(error, motion_noise);
    if (s->modelled[BR_AXIAL])
        noise[BR_IDA_CONTACT] = motion * br_ida_scale_of_tip(&m->scale, BR_AXIAL, 0);
    if (s->modelled[BR_BENDING])
        noise[BR_IDA_FRICTION] = motion * br_ida_scale_of_tip(&m->scale, BR_BENDING, 1);
    if (s->regime.friction == BR_IDA_STICK && !(s->mu > 0)) {
        br_ida_reaction(s, y, rate, &noise[BR_IDA_FRICTION]);
        noise[BR_IDA_FRICTION] *= fmax(error, reaction_noise);
    }
    for (int law = 0; law < BR_IDA_LAWS; law++)
        violated[law] = !(margin[law] >= -noise[law]);
}

/* After a call of IDASolve: what it said, where it is, whether a law's branch ends there. */
static enum br_status look(struct br_ida_march *m, int flag, struct br_error *err)
{
    if (flag < 0)
        return ida_failed(m, "IDASolve", flag, err);
    if (!isfinite(N_VMaxNorm(m->y)))
        return fail(m, "its solution is not finite", err);
    const enum br_status status = br_ida_load(&m->system, m->reached, err);
    if (status)
        return status;
    br_ida_violated(m, m->tolerance, m->switched);
    int roots[BR_IDA_LAWS] = {0};
    if (flag == IDA_ROOT_RETURN)
        IDAGetRootInfo(m->ida, roots);
    for (int law = 0; law < BR_IDA_LAWS; law++)
        m->switched[law] |= roots[law] < 0;
    struct br_counts counts = m->counts;
    br_ida_add_counts(m, &counts);
    if (m->most && counts.steps + counts.rejected >= m->most)
        return br_fail(err, BR_INTERRUPTED,
                       "scheme ida: at t = %g s %zu steps were made, and no more", m->reached,
                       m->most);
    if (counts.steps > MOST_STEPS)
        return fail(m, "more than two million steps", err);
    return BR_OK;
}

enum br_status br_ida_step(struct br_ida_march *m, struct br_error *err)
{
    if (!m->begun || m->switched[BR_IDA_CONTACT] || m->switched[BR_IDA_FRICTION])
        return br_ida_switch(m, err);
    const int flag =
        IDASolve(m->ida, m->system.scene->duration, &m->reached, m->y, m->rate, IDA_ONE_STEP);
    return look(m, flag, err);
}

enum br_status br_ida_see(struct br_ida_march *m, double t, struct br_error *err)
{
    int flag = IDAGetDky(m->ida, t, 0, m->seen);
    if (!flag)
        flag = IDAGetDky(m->ida, t, 1, m->seen_rate);
    if (flag)
        return ida_failed(m, "IDAGetDky", flag, err);
    if (br_ida_sticks(&m->system)) /* to the last digit */
        N_VGetArrayPointer(m->seen)[br_ida_tip_row(&m->system, BR_BENDING)] = 0;
    const enum br_status status = br_ida_load(&m->system, t, err);
    if (!status)
        br_ida_tip(&m->system, N_VGetArrayPointer(m->seen), N_VGetArrayPointer(m->seen_rate),
                   &m->tip);
    return status;
}

/* y' = -(dG/dy')^-1 G(t, y, 0), since G is linear in y'. */
static enum br_status fit_rates(struct br_ida_march *m, double t, struct br_error *err)
{
    N_VConst(0, m->rate);
    if (br_ida_residual(t, m->y, m->rate, m->work, &m->system))
        return br_fail(err, m->system.err.status, "%.900s", m->system.err.message);
    N_VScale(-1, m->work, m->work);
    SUNMatZero(m->rates);
    br_ida_rate_matrix(&m->system, m->rates);
    if (SUNLinSolSetup(m->rate_solver, m->rates) ||
        SUNLinSolSolve(m->rate_solver, m->rates, m->rate, m->work, 0))
        return br_fail(err, BR_SINGULAR, "the mass matrix of scheme ida is singular");
    return BR_OK;
}

enum br_status br_ida_begin(struct br_ida_march *m, double t, double h, struct br_error *err)
{
    const double end = m->system.scene->duration;
    N_VScale(1, m->start, m->y);
    const enum br_status status = fit_rates(m, t, err);
    if (status)
        return status;
    int flag = IDAReInit(m->ida, t, m->y, m->rate);
    if (!flag)
        flag = IDASetInitStep(m->ida, fmin(h, (end - t) / 2));
    if (!flag)
        flag = IDASetStopTime(m->ida, end);
    if (flag)
        return ida_failed(m, "IDAReInit", flag, err);
    m->reached = t;
    flag = IDASolve(m->ida, end, &m->reached, m->y, m->rate, IDA_ONE_STEP);
    return look(m, flag, err);
}
