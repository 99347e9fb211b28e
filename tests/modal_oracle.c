/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sum over the modes, and what those add that are left out. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "tests/modal_oracle_parts.h"

enum { NODES = ORACLE_NODES };

/* ---- one term: the sum over the modes and what the others add ---- */

/* The modes that are left out follow their load almost at once:
 *     q = p / (lambda k) - rho s^2 p / (lambda k)^2 + ..., k = c s + a,
 * in Laplace's variable s. The sums over all modes of both terms are known, so the rest of the sums
 * times these two responses is the tail. */
struct solver {
    const struct oracle_problem *problem;
    const struct oracle_term *term;
    size_t times;
    const double *t;
    struct oracle_panels panels;
    real *time, *shift; /* at the panels' nodes */
    real *drive;        /* one mode's, where the load moves */
    real *rest[2];      /* the sums' rests: at the nodes where the load moves, else one */
    real round_off[2];  /* of one rest */
    real (*slow)[4];    /* by times: y, z, G, G' of a G(t) that does not move */
    real (*state)[2];   /* one mode's */
    struct oracle_tip *sum;
};

static void make_solver(struct solver *s, size_t most)
{
    const struct oracle_problem *p = s->problem;
    const struct oracle_term *term = s->term;
    real fastest = (real)p->stiffness / (real)p->viscosity;
    if (term->moving)
        fastest = fmaxl(fastest, oracle_root(p->bending, most) / p->length *
                                     (fabs(term->speed) + fabs(term->swing * term->rate)));
    if (term->time.kind == ORACLE_WAVE)
        fastest = fmaxl(fastest, fabs(term->time.p[0]));
    oracle_panels(&s->panels, term, p->length, 2 / fastest, s->times, s->t);
    const size_t nodes = s->panels.count * NODES, rests = term->moving ? nodes : 1;
    s->time = calloc(nodes + 1, sizeof *s->time);
    s->shift = calloc(nodes + 1, sizeof *s->shift);
    s->drive = calloc(nodes + 1, sizeof *s->drive);
    s->rest[0] = calloc(rests, sizeof *s->rest[0]);
    s->rest[1] = calloc(rests, sizeof *s->rest[1]);
    s->slow = calloc(s->times, sizeof *s->slow);
    s->state = calloc(s->times, sizeof *s->state);
    s->sum = calloc(s->times, sizeof *s->sum);
    for (size_t i = 0; i < nodes; i++) {
        const size_t panel = i / NODES;
        const real length = s->panels.length[s->panels.class_of[panel]];
        const real t = s->panels.start[panel] + length * oracle_gauss()->node[i % NODES];
        s->time[i] = oracle_value(&term->time, t);
        s->shift[i] = term->start + term->speed * t + term->swing * sinl(term->rate * t);
    }
}

static void clear_solver(struct solver *s)
{
    oracle_panels_free(&s->panels);
    free(s->time);
    free(s->shift);
    free(s->drive);
    free(s->rest[0]);
    free(s->rest[1]);
    free(s->slow);
    free(s->state);
    free(s->sum);
}

/* The load's part in a weight, where it does not move. */
static real part(const struct solver *s, const struct oracle_weight *w)
{
    const real length = s->problem->length;
    switch (s->term->place) {
    case ORACLE_FORCE:
        return oracle_weight_value(w, 1) / length;
    case ORACLE_MOMENT:
        return oracle_weight_slope(w) / (length * length);
    default:
        return oracle_spread(w, &s->term->space, 0, length);
    }
}

/* drive (out, nodes): the same over time, where it moves. */
static void moving_part(const struct solver *s, const struct oracle_weight *w, real *drive)
{
    for (size_t i = 0; i < s->panels.count * NODES; i++)
        drive[i] = s->time[i] * oracle_spread(w, &s->term->space, s->shift[i], s->problem->length);
}

/* y, z, G, G' (out) at the times of a G at the nodes. */
static void slow_response(const struct solver *s, const real *drive, real (*slow)[4])
{
    const struct oracle_equation e = oracle_slow_equation(s->problem);
    real(*state)[2] = calloc(s->times, sizeof *state);
    oracle_respond(&e, &s->panels, drive, s->times, state);
    for (size_t k = 0; k < s->times; k++) {
        real value = 0, slope = 0;
        const size_t last = s->panels.reached[k] - 1;
        for (size_t j = 0; j < NODES; j++) {
            const real length = s->panels.length[s->panels.class_of[last]];
            value += oracle_gauss()->end_value[j] * drive[last * NODES + j];
            slope += oracle_gauss()->end_slope[j] * drive[last * NODES + j] * 2 / length;
        }
        slow[k][0] = state[k][0];
        slow[k][1] = state[k][1];
        slow[k][2] = value;
        slow[k][3] = slope;
    }
    free(state);
}

/* value (out): y, z (power 2 only: rho s^2 / k^2) of one time, and their derivatives. */
static void tail_terms(const struct oracle_problem *p, const real slow[4], int power, real value[2])
{
    const real a = p->stiffness, c = p->viscosity, y = slow[0], z = slow[1], g = slow[2];
    const real dy = (g - a * y) / c, dz = (y - a * z) / c;
    value[0] = power == 1 ? y : -(real)p->density * (g - 2 * a * y + a * a * z) / (c * c);
    value[1] = power == 1 ? dy : -(real)p->density * (slow[3] - 2 * a * dy + a * a * dz) / (c * c);
}

/* tip (out): the sums and the tail. */
static void finish(const struct solver *s, struct oracle_tip *tip)
{
    real(*slow)[4] = s->term->moving ? calloc(s->times, sizeof *slow) : s->slow;
    for (size_t k = 0; k < s->times; k++)
        tip[k] = s->sum[k];
    for (int power = 1; power <= 2; power++) {
        if (s->term->moving)
            slow_response(s, s->rest[power - 1], slow);
        for (size_t k = 0; k < s->times; k++) {
            const real rest = s->term->moving ? 1 : *s->rest[power - 1];
            real value[2];
            tail_terms(s->problem, slow[k], power, value);
            tip[k].displacement += rest * value[0];
            tip[k].velocity += rest * value[1];
            tip[k].displacement_error += s->round_off[power - 1] * fabsl(value[0]);
            tip[k].velocity_error += s->round_off[power - 1] * fabsl(value[1]);
        }
    }
    if (s->term->moving)
        free(slow);
}

static void begin(struct solver *s)
{
    const real scale = powl(s->problem->length, s->problem->bending ? 4 : 2);
    for (int power = 1; power <= 2; power++) {
        const struct oracle_weight w = {NULL, s->problem->bending, power};
        real *rest = s->rest[power - 1], factor = powl(scale, power);
        if (s->term->moving)
            moving_part(s, &w, rest);
        else
            *rest = part(s, &w);
        for (size_t i = 0; i < (s->term->moving ? s->panels.count * NODES : 1); i++)
            rest[i] *= factor;
        /* Modes are taken away from it until little is left; b^8 has lost some digits. */
        if (!s->term->moving)
            s->round_off[power - 1] = 16 * LDBL_EPSILON * fabsl(*rest);
    }
    if (!s->term->moving)
        slow_response(s, s->time, s->slow);
}

static void add_mode(struct solver *s, size_t i)
{
    const struct oracle_mode mode = oracle_mode(s->problem->bending, i);
    const struct oracle_weight w = {&mode, s->problem->bending, 0};
    const struct oracle_equation e = oracle_mode_equation(s->problem, mode.b);
    const real lambda = e.stiffness / (real)s->problem->stiffness,
               tip = oracle_mode_value(&mode, 1);
    const real p = s->term->moving ? 1 : part(s, &w);
    if (s->term->moving)
        moving_part(s, &w, s->drive);
    oracle_respond(&e, &s->panels, s->term->moving ? s->drive : s->time, s->times, s->state);
    for (size_t k = 0; k < s->times; k++) {
        s->sum[k].displacement += tip * p * s->state[k][0];
        s->sum[k].velocity += tip * p * s->state[k][1];
    }
    for (size_t j = 0; j < (s->term->moving ? s->panels.count * NODES : 1); j++) {
        const real q = s->term->moving ? s->drive[j] : p;
        s->rest[0][j] -= tip * q / lambda;
        s->rest[1][j] -= tip * q / (lambda * lambda);
    }
}

/* Whether the modes are enough; the errors are how far the last doubling has gone. */
static bool settled(size_t times, const struct oracle_tip *before, struct oracle_tip *tip)
{
    real most[2] = {0, 0}, error[2] = {0, 0};
    for (size_t k = 0; k < times; k++) {
        const real change[] = {fabsl(tip[k].displacement - before[k].displacement),
                               fabsl(tip[k].velocity - before[k].velocity)};
        tip[k].displacement_error += change[0];
        tip[k].velocity_error += change[1];
        most[0] = fmaxl(most[0], fabsl(tip[k].displacement));
        most[1] = fmaxl(most[1], fabsl(tip[k].velocity));
        error[0] = fmaxl(error[0], change[0]);
        error[1] = fmaxl(error[1], change[1]);
    }
    return error[0] <= 1e-13L * most[0] && error[1] <= 1e-11L * most[1];
}

void oracle_term(const struct oracle_problem *problem, const struct oracle_term *term, size_t times,
                 const double *t, struct oracle_tip *tip)
{
    const size_t least = 32;
    const size_t most = (term->moving ? 4 : problem->bending ? 8 : 32) * least;
    struct solver s = {.problem = problem, .term = term, .times = times, .t = t};
    make_solver(&s, most);
    struct oracle_tip *before = calloc(times, sizeof *before);
    begin(&s);
    size_t modes = 0;
    for (size_t goal = least; goal <= most; goal *= 2) {
        while (modes < goal)
            add_mode(&s, ++modes);
        for (size_t k = 0; k < times; k++)
            before[k] = tip[k];
        finish(&s, tip);
        if (settled(times, before, tip) && goal > least)
            break;
    }
    for (size_t k = 0; k < times; k++) {
        tip[k].displacement *= term->amplitude;
        tip[k].velocity *= term->amplitude;
        tip[k].displacement_error *= fabs(term->amplitude);
        tip[k].velocity_error *= fabs(term->amplitude);
    }
    free(before);
    clear_solver(&s);
}

void oracle_initial(const struct oracle_problem *problem, size_t times, const double *t,
                    struct oracle_tip *tip)
{
    const struct oracle_mode mode = oracle_mode(problem->bending, 1);
    const struct oracle_equation e = oracle_mode_equation(problem, mode.b);
    const real scale = oracle_mode_value(&mode, 1),
               given[] = {problem->displacement, problem->velocity};
    for (size_t k = 0; k < times; k++) {
        real carry[2][2], now[2];
        e.carry(&e, t[k], carry);
        for (int i = 0; i < 2; i++)
            now[i] = scale * (carry[i][0] * given[0] + carry[i][1] * given[1]);
        tip[k] = (struct oracle_tip){.displacement = now[0], .velocity = now[1]};
    }
}
