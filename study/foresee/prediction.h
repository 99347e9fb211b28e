/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of a run, predicted before it: of each field the largest L2 norm over all time levels,
 * relative to the largest of that field's solution.
 *
 * A run that is short is marched twice: as it is, and by the most accurate method on a finer mesh
 * with smaller steps. Their distance is the error; what a reference of half that mesh and half
 * those steps differs from the first tells how sure it is, and widens the interval. Where the run
 * takes long, cheaper marches tell it: so many steps as are cheap, on a coarse mesh; the run's
 * first steps, of their own length, for what happens at t = 0; and the run's own mesh, or one of
 * 128 elements, at few steps. What lies beyond is extrapolated by the order that was observed where
 * that makes sense, else by theory's. That switching (stick and slip, contact) spoils orders above
 * one is not seen by coarse marches: the upper bound then takes order one.
 *
 * Tests hold it against the exact solution (tests/test_prediction.c), and so does each case of
 * `extremes map`. */
#ifndef BR_STUDY_FORESEE_PREDICTION_H
#define BR_STUDY_FORESEE_PREDICTION_H

#include <stdbool.h>

#include "study/foresee/warnings.h"

enum { BR_PREDICTED_TEXT = 120 };

/* A part of the error, relative to the solution. */
struct br_predicted {
    double error, low, high; /* high: INFINITY where it may be as large as the solution */
    double order;            /* as it was observed; NaN: it was not, or not needed */
};

struct br_prediction {
    bool known;
    char why[200]; /* not known: why */
    bool bounded;  /* low and high of `whole` were found, also where it is not known */
    struct br_predicted field[2]; /* of discretisation, by br_field_kind; zeros: not
                                     modelled */
    double size[2]; /* of the fields, by br_field_kind: their largest L2 norms in the marches that
                       it is predicted from, m^(3/2) */
    struct br_predicted space, time, whole; /* of the field whose upper bound is the larger */
    double round_off; /* relative to the exact discrete solution: br_predict_round_off */
    double seconds;   /* that the prediction took */
};

/* "0.0014, between 0.00046 and 0.0042": an error as people read it. */
const char *br_predicted_interval(const struct br_predicted *e, char text[BR_PREDICTED_TEXT]);

/* Predicts (out). Takes some ten milliseconds, and less than the run itself where that takes
 * longer, or what planned->budget allows; what it cannot tell is no failure. Fails with
 * BR_NO_MEMORY. */
enum br_status br_predict(const struct br_planned_march *planned, struct br_prediction *prediction,
                          struct br_error *err);

/* The most that a field is stated to be off, relative to its solution: the upper bound of the
 * discretisation error, and what round-off adds. INFINITY where nothing is stated. */
double br_predicted_most(const struct br_prediction *prediction, enum br_field_kind kind);

/* The same at the tip of a beam of that length, m, for an error that is largest there and grows
 * like x (axial) or x^2 (bending): the field's rms error times 3^(1/2) or 5^(1/2). It is an
 * estimate. */
double br_predicted_tip(const struct br_prediction *prediction, enum br_field_kind kind,
                        double length);

/* Whether a beam follows its load at once, whose viscosity is gone within a step k, s: friction
 * then keeps what the load's peaks and jumps have left. Stages of a higher order go beyond these;
 * Euler's steps do not, and are what others are compared with. */
bool br_follows_at_once(const struct br_scene *scene, double k);

/* What solves the same equations more accurately on the same steps: a scheme that takes next to no
 * energy from a vibration, contact at the new time level, friction that does not iterate, since
 * what that leaves adds up over many steps, and the solver of the least round-off. A reference of
 * the run's own scheme would not show what that damps away in both. */
struct br_method br_accurate_method(const struct br_method *own, const char *scheme);

/* Round-off of the displacements, relative to the exact discrete solution, as the linear solver
 * predicts it: the larger of the modelled fields'. */
double br_predict_round_off(const struct br_planned_march *planned);

#endif
