/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ida/ida.h>
#include <string.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include "solver/ida_march.h"

/* What Newton's iteration may leave of the tolerance, instead of IDA's 0.33: it would show in the
 * velocity of a tip that begins to slip. */
static const double newton_part = 0.01;
static const double longest_step = 1.0 / 32; /* of the duration: no load is stepped over */

/* ---- what IDA calls, beside ida_system.h ---- */

static int give_weights(N_Vector y, N_Vector weight, void *march)
{
    struct br_ida_march *m = march;
    br_ida_scale_see(&m->scale, N_VGetArrayPointer(y));
    br_ida_scale_weights(&m->scale, N_VGetArrayPointer(weight));
    return 0;
}

/* Warnings are of no use: what is wrong ends in a flag. */
static void keep_message(int code, const char *module, const char *function, char *message,
                         void *march)
{
    (void)module, (void)function;
    struct br_ida_march *m = march;
    if (code < 0)
        snprintf(m->said, sizeof m->said, "%s", message);
}

/* ---- setting up ---- */

static bool make_vectors(struct br_ida_march *m)
{
    N_Vector *const vectors[] = {&m->y, &m->rate, &m->start, &m->work, &m->seen, &m->seen_rate};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        *vectors[i] = N_VNew_Serial((sunindextype)m->system.count, m->context);
        if (!*vectors[i])
            return false;
        N_VConst(0, *vectors[i]);
    }
    return true;
}

static bool make_matrix(struct br_ida_march *m, SUNMatrix *matrix, SUNLinearSolver *solver)
{
    const struct br_ida_system *s = &m->system;
    *matrix = SUNBandMatrix((sunindextype)s->count, (sunindextype)s->upper, (sunindextype)s->lower,
                            m->context);
    if (*matrix)
        *solver = SUNLinSol_Band(m->y, *matrix, m->context);
    return *solver && !SUNLinSolInitialize(*solver);
}

/* Velocities are left out of the error test. Where inertia is small they follow from displacements
 * and loads at once, and after a change of the step length an implicit method of low order then
 * jumps to another error: IDA would never take a longer step again (Example 4 after it sticks:
 * 9000 steps instead of 300). The error of the displacements, which are their integrals, bounds
 * theirs.
 */
static bool leave_out_velocities(struct br_ida_march *m)
{
    const struct br_ida_system *s = &m->system;
    N_VConst(1, m->work);
    double *tested = N_VGetArrayPointer(m->work);
    for (int i = BR_AXIAL; i <= BR_BENDING; i++) {
        const enum br_field_kind kind = (enum br_field_kind)i;
        const size_t unknowns = br_field_unknowns(&s->field[kind]);
        for (size_t node = 1; node <= s->field[kind].n && s->modelled[kind]; node++)
            for (size_t c = 0; c < unknowns; c++)
                tested[br_ida_at(s, kind, node) + unknowns + c] = 0;
    }
    return !IDASetId(m->ida, m->work) && !IDASetSuppressAlg(m->ida, SUNTRUE);
}

static bool attach(struct br_ida_march *m)
{
    int falls[BR_IDA_LAWS];
    for (int law = 0; law < BR_IDA_LAWS; law++)
        falls[law] = -1;
    return !IDASetErrHandlerFn(m->ida, keep_message, m) &&
           !IDAInit(m->ida, br_ida_residual, 0, m->y, m->rate) && !IDASetUserData(m->ida, m) &&
           !IDAWFtolerances(m->ida, give_weights) &&
           !IDASetLinearSolver(m->ida, m->solver, m->jacobian) &&
           !IDASetJacFn(m->ida, br_ida_jacobian) && leave_out_velocities(m) &&
           !IDASetNonlinConvCoef(m->ida, newton_part) &&
           !IDASetMaxStep(m->ida, longest_step * m->system.scene->duration) &&
           !IDARootInit(m->ida, BR_IDA_LAWS, br_ida_roots) && !IDASetRootDirection(m->ida, falls) &&
           !IDASetNoInactiveRootWarn(m->ida);
}

static enum br_status set_initial(struct br_ida_march *m, struct br_error *err)
{
    struct br_ida_system *s = &m->system;
    double *y = N_VGetArrayPointer(m->y);
    enum br_status status = br_ida_initial(s, y, err);
    if (!status)
        status = br_ida_scale_init(&m->scale, s, m->tolerance, err);
    if (status)
        return status;
    br_ida_scale_see(&m->scale, y);
    N_VScale(1, m->y, m->seen);
    const struct br_contact *contact = &s->scene->contact;
    s->regime.closed = contact->modelled && br_ida_tip_displacement(s, BR_AXIAL, y) >= contact->gap;
    s->regime.friction = BR_IDA_STICK; /* tried first where there is friction */
    return BR_OK;
}

enum br_status br_ida_init(struct br_ida_march *m, const struct br_scene *scene, size_t n,
                           const struct br_method *method, struct br_error *err)
{
    *m = (struct br_ida_march){.tolerance = method->tolerance, .most = method->most_steps};
    enum br_status status = br_ida_system_init(&m->system, scene, n, method, err);
    if (status || m->system.count == 0)
        return status;
    if (SUNContext_Create(NULL, &m->context) || !make_vectors(m) ||
        !make_matrix(m, &m->jacobian, &m->solver) || !make_matrix(m, &m->rates, &m->rate_solver) ||
        !(m->ida = IDACreate(m->context)))
        return br_no_memory(err, "a march of scheme ida");
    status = set_initial(m, err);
    if (!status && !attach(m))
        return br_fail(err, BR_NO_MEMORY, "scheme ida could not be set up: %s",
                       m->said[0] ? m->said : "out of memory");
    return status;
}

void br_ida_clear(struct br_ida_march *m)
{
    N_Vector const vectors[] = {m->y, m->rate, m->start, m->work, m->seen, m->seen_rate};
    SUNMatrix const matrices[] = {m->jacobian, m->rates};
    SUNLinearSolver const solvers[] = {m->solver, m->rate_solver};
    if (m->ida)
        IDAFree(&m->ida);
    for (size_t i = 0; i < 2; i++) {
        if (solvers[i])
            SUNLinSolFree(solvers[i]);
        if (matrices[i])
            SUNMatDestroy(matrices[i]);
    }
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        if (vectors[i])
            N_VDestroy(vectors[i]);
    if (m->context)
        SUNContext_Free(&m->context);
    br_ida_system_clear(&m->system);
}
