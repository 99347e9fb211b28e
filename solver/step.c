/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step of the fully discrete problem VP^hk: equation (16) is axial_stage, inequality (17) is
 * bending_stage. A scheme of higher order is a sequence of such steps, its stages (scheme.h): each
 * starts at a sum of known states and has a length tau of its own, which field.k is then. Implicit
 * Euler, the paper's, has one stage, with tau = k. */
#include <math.h>

#include "solver/arithmetic.h"
#include "solver/march_state.h"

/* ---- contact ---- */

/* c_H (u - g)_+ by the law, or on the branch that is kept active. */
static double contact_force(const struct br_march *m, const struct br_contact_state *state)
{
    const struct br_contact *contact = &m->scene->contact;
    if (!contact->modelled || (m->keeps_branch[BR_AXIAL] && m->regime[BR_AXIAL] == BR_REGIME_OPEN))
        return 0;
    return m->keeps_branch[BR_AXIAL] ? br_contact_closed_force(contact, state)
                                     : m->method.contact->force(contact, state);
}

/* (u - g)_+ at the stage's time. A contact force at u_n gives it without cancellation. */
static double penetration(const struct br_march *m)
{
    const struct br_contact *contact = &m->scene->contact;
    if (m->method.contact->at_new_step && br_contact_pushes(contact))
        return br_contact_depth(contact, m->tip.contact_force);
    return br_penetration(contact, m->tip.displacement);
}

/* ---- friction ---- */

/* (u - g)_+ at that fraction of the step. The axial field may have had its stages at other times,
 * if one field has restarted and the other has not; then u is the cubic that the values at both
 * ends determine. */
static double penetration_at(const struct br_march *m, const struct br_tip_path *path,
                             double fraction)
{
    for (int i = 0; i < path->count; i++)
        if (path->time[i] == fraction)
            return path->penetration[i];
    const double s = fraction, r = 1 - fraction;
    const double u = (1 + 2 * s) * r * r * path->start[0] + s * r * r * path->start[1] +
                     s * s * (3 - 2 * s) * path->end[0] - s * s * r * path->end[1];
    return br_penetration(&m->scene->contact, u);
}

/* lambda by the law, or on the branch that is kept active. */
static double friction_force(struct br_march *m, struct br_friction_state *state)
{
    if (m->scene->friction.law == BR_FRICTIONLESS)
        return 0;
    if (m->keeps_branch[BR_BENDING] && m->regime[BR_BENDING] == BR_REGIME_STICK)
        return state->free_velocity / state->compliance;
    if (m->keeps_branch[BR_BENDING] && m->regime[BR_BENDING] == BR_REGIME_FORWARD)
        return state->bound;
    if (m->keeps_branch[BR_BENDING] && m->regime[BR_BENDING] == BR_REGIME_BACKWARD)
        return -state->bound;
    return m->method.friction->force(state);
}

/* ---- (16) and (17) ---- */

/* Equation (16), with rho as in (27): find v_n in E^h with, for all q in E^h,
 *
 *     rho (delta v_n, q) + a1 (u_n,x , q_x) + c1 (v_n,x , q_x)
 *         + c_H (u_{n-1}(L) - g)_+ q(L)  =  (f_H(t_n), q).
 *
 * In matrices (M/k + C + k K) v_n + r e_tip = F_n + M v_{n-1}/k - K u_{n-1}: `predict` gives the
 * tip's velocity v* for r = 0, the contact rule r = c_H (u - g)_+, lagged at u_{n-1} as printed or
 * at u_n, and `finish` v_n with v_n(L) = v* - r z. */
static enum br_status axial_stage(struct br_march *m, double t, struct br_error *err)
{
    struct br_field_march *fm = &m->field[BR_AXIAL];
    struct br_contact_state contact = {
        .displacement = fm->solver->tip_displacement(fm->state),
        .compliance = fm->solver->tip_compliance(fm->state),
        .k = fm->field.k,
    };
    const enum br_status status = br_field_march_predict(fm, t, &contact.free_velocity, err);
    if (status)
        return status;
    m->tip.contact_force = contact_force(m, &contact);
    m->was_closed |= m->tip.contact_force > 0;
    m->tip.velocity[BR_AXIAL] = fm->solver->finish(fm->state, m->tip.contact_force);
    m->tip.displacement = fm->solver->tip_displacement(fm->state);
    return BR_OK;
}

/* Inequality (17), with rho as in (28): find w'_n in V^h, the velocity of w, with, for all q in
 * V^h,
 *
 *     rho (delta w'_n, q - w'_n) + a2 (w_n,xx , (q - w'_n)_xx) + c2 (w'_n,xx , (q - w'_n)_xx)
 *         + h_n |q(L)| - h_n |w'_n(L)|  >=  (f_V(t_n), q - w'_n),
 *
 * h_n = c_V, or c_V (u_n(L) - g)_+ at `depth`. That is the equation of a beam with the force lambda
 * at its tip, lambda in h_n sign-set(w'_n(L)), which is one scalar problem: w'_n(L) = w'* - lambda
 * z. The regularised rule is (30). */
static enum br_status bending_stage(struct br_march *m, double depth, double t,
                                    struct br_error *err)
{
    struct br_field_march *fm = &m->field[BR_BENDING];
    struct br_friction_state friction = {
        .compliance = fm->solver->tip_compliance(fm->state),
        .bound = br_friction_bound(m->scene, depth),
        .regularisation = m->scene->friction.regularisation,
        .last = m->tip.friction_force,
        .iteration = m->method.iteration,
    };
    const enum br_status status = br_field_march_predict(fm, t, &friction.free_velocity, err);
    if (status)
        return status;
    m->tip.friction_bound = friction.bound;
    m->tip.friction_force = friction_force(m, &friction);
    m->counts.iterations += friction.iterations;
    if (m->method.friction->iterates && isnan(m->tip.friction_force) &&
        isfinite(friction.free_velocity) && isfinite(friction.bound))
        return br_fail(err, BR_NOT_FINITE,
                       "friction rule %s did not reach its tolerance of %g in %zu iterations at "
                       "t = %g s, with the parameter %g; --friction exact needs none",
                       m->method.friction->name, friction.iteration.tolerance,
                       friction.iteration.most, t, friction.iteration.parameter);
    m->tip.velocity[BR_BENDING] = fm->solver->finish(fm->state, m->tip.friction_force);
    return BR_OK;
}

/* ---- a step ---- */

static enum br_status stage(struct br_march *m, enum br_field_kind kind,
                            const struct br_stage *stage, const struct br_step *step, int i,
                            struct br_tip_path *path, struct br_error *err)
{
    const double t = br_step_time(step, stage->time);
    if (kind == BR_BENDING)
        return bending_stage(m, penetration_at(m, path, stage->time), t, err);
    const enum br_status status = axial_stage(m, t, err);
    path->time[i] = stage->time;
    path->penetration[i] = penetration(m);
    return status;
}

/* Calls the watchers after a stage, or, with NULL, after an accepted step. They run without traps,
 * since they may meet a NaN and report it, and they round to nearest, whatever mode the march has.
 */
static void notify(const struct br_march *m, const struct br_march_stage *stage,
                   enum br_field_kind kind, bool switched)
{
    const int traps = br_traps_lift(), rounding = fegetround();
    if (rounding != FE_TONEAREST)
        fesetround(FE_TONEAREST);
    for (const struct br_march_watcher *w = m->watcher; w < m->watcher + m->watchers; w++)
        if (stage)
            w->stage(w->self, stage);
        else
            w->step(w->self, kind, switched);
    if (rounding != FE_TONEAREST)
        fesetround(rounding);
    br_traps_restore(traps);
}

enum br_status br_march_stages(struct br_march *m, enum br_field_kind kind,
                               const struct br_stages *stages, const struct br_step *step,
                               struct br_tip_path *path, struct br_error *err)
{
    struct br_field_march *fm = &m->field[kind];
    if (kind == BR_AXIAL) {
        path->count = stages->count;
        path->start[0] = m->tip.displacement;
        path->start[1] = step->k * m->tip.velocity[BR_AXIAL];
    }
    for (int i = 0; i < stages->count; i++) {
        enum br_status status = br_field_march_start_stage(fm, stages, i, step->k, err);
        if (!status)
            status = stage(m, kind, &stages->stage[i], step, i, path, err);
        if (status)
            return status;
        if (m->keeps_branch[kind])
            br_margins_add(&m->margins[kind], stages->stage[i].time, br_march_margin(m, kind));
        const struct br_march_stage report = {
            .kind = kind,
            .index = i,
            .count = stages->count,
            .from = step->from,
            .k = step->k,
            .time = br_step_time(step, stages->stage[i].time),
            .tau = fm->field.k,
        };
        if (m->watchers > 0)
            notify(m, &report, kind, false);
    }
    if (kind == BR_AXIAL) {
        path->end[0] = m->tip.displacement;
        path->end[1] = step->k * m->tip.velocity[BR_AXIAL];
    }
    return BR_OK;
}

void br_march_accept(struct br_march *m, enum br_field_kind kind, const struct br_stages *stages,
                     bool switched)
{
    br_field_march_accept(&m->field[kind], stages, switched);
    if (m->watchers > 0)
        notify(m, NULL, kind, switched);
}

/* Where the contact has a stiffness, the sign of its force decides: a difference of displacements
 * would lose digits. A contact without stiffness does not switch the field, and fixed steps ignore
 * it. But an adaptive scheme ends a step there, for the kink of Coulomb's bound. */
static bool is_closed(const struct br_march *m)
{
    const struct br_contact *contact = &m->scene->contact;
    return br_contact_pushes(contact) || !m->adaptive ? m->tip.contact_force > 0
                                                      : m->tip.displacement > contact->gap;
}

enum br_regime br_march_regime(const struct br_march *m, enum br_field_kind kind)
{
    const struct br_tip *tip = &m->tip;
    if (kind == BR_AXIAL && m->scene->contact.modelled)
        return is_closed(m) ? BR_REGIME_CLOSED : BR_REGIME_OPEN;
    if (kind == BR_AXIAL || m->scene->friction.law == BR_FRICTIONLESS || !(tip->friction_bound > 0))
        return BR_REGIME_NONE;
    if (fabs(tip->friction_force) < tip->friction_bound)
        return BR_REGIME_STICK;
    return tip->friction_force > 0 ? BR_REGIME_FORWARD : BR_REGIME_BACKWARD;
}

double br_march_margin(const struct br_march *m, enum br_field_kind kind)
{
    const struct br_tip *tip = &m->tip;
    switch (m->keeps_branch[kind] ? m->regime[kind] : BR_REGIME_NONE) {
    case BR_REGIME_OPEN:
        return m->scene->contact.gap - tip->displacement;
    case BR_REGIME_CLOSED:
        return tip->displacement - m->scene->contact.gap;
    case BR_REGIME_STICK:
        return tip->friction_bound - fabs(tip->friction_force);
    case BR_REGIME_FORWARD:
        return tip->velocity[BR_BENDING];
    case BR_REGIME_BACKWARD:
        return -tip->velocity[BR_BENDING];
    case BR_REGIME_NONE:
        break;
    }
    return 0;
}
