/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tip of a linear clamped rod or beam, by its eigenfunctions, in long double.
 *
 * Without contact and friction, Kelvin-Voigt damping leaves one scalar equation for each
 * eigenfunction,
 *     rho q_i'' + c lambda_i q_i' + a lambda_i q_i = p_i(t),
 * whose impulse response is elementary. The oracle knows where each of its loads begins, ends,
 * jumps or is narrow, since it is given the parameters and not an expression: it integrates between
 * these places, and never looks for them. */
#ifndef BR_TESTS_MODAL_ORACLE_H
#define BR_TESTS_MODAL_ORACLE_H

#include <stdbool.h>
#include <stddef.h>

struct oracle_step {
    long double at, height; /* at may be -INFINITY */
};

/* A function of s, which is x - s0(t) in m, or t in s. */
struct oracle_factor {
    enum {
        ORACLE_STEPS, /* the sum of the heights of all steps with at <= s; they ascend */
        ORACLE_POWER, /* s^p0, p0 = 0 to 8 */
        ORACLE_WAVE,  /* sin(p0 s) */
        ORACLE_GAUSS, /* exp(-((s - p0) / p1)^2) */
        ORACLE_HAT,   /* max(0, 1 - |s - p0| / p1) */
    } kind;
    double p[2];
    const struct oracle_step *step; /* borrowed */
    size_t steps;
};

/* amplitude space(x - s0(t)) time(t) in N/m, or amplitude time(t) at the tip, in N or N m. */
struct oracle_term {
    enum oracle_place { ORACLE_SPREAD, ORACLE_FORCE, ORACLE_MOMENT } place;
    double amplitude;
    struct oracle_factor space, time;
    bool moving;         /* s0 = start + speed t + swing sin(rate t); else 0 */
    double start, speed; /* m, m/s */
    double swing, rate;  /* m, 1/s; with a swing the load stays inside of the beam */
};

struct oracle_problem {
    bool bending;
    double length, density, stiffness,
        viscosity;                 /* m, kg/m, N or N m^2, the same times s; all > 0 */
    double displacement, velocity; /* initial: these times the first eigenfunction whose mean square
                                      over the beam is 1, m, m/s */
};

/* The tip at one time, with what two numbers of modes differ by. */
struct oracle_tip {
    long double displacement, velocity; /* m, m/s */
    long double displacement_error, velocity_error;
};

/* The factor 1. */
struct oracle_factor oracle_one(void);

/* The value of a factor. */
long double oracle_value(const struct oracle_factor *factor, long double s);

/* tip[k] (out) at the times t[k] > 0, ascending, k < times: the response to one term from rest. */
void oracle_term(const struct oracle_problem *problem, const struct oracle_term *term, size_t times,
                 const double *t, struct oracle_tip *tip);

/* The same for the initial data, without a load. */
void oracle_initial(const struct oracle_problem *problem, size_t times, const double *t,
                    struct oracle_tip *tip);

/* b of the i-th eigenfunction, i >= 1: lambda = (b / L)^2 of the rod, (b / L)^4 of the beam. */
long double oracle_root(bool bending, size_t i);

#endif
