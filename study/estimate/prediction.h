/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Predicts the error of a run before the run: of each field the largest L2 norm over all time
 * levels, relative to the largest L2 norm of that field's solution. docs/error.md explains it, with
 * the formula and a picture.
 *
 * The run is marched beside a reference R, a more accurate march by a tolerance. Their distance is
 * the error; the distance of a check, with half of R's elements and a larger tolerance, bounds the
 * error of R, and widens the interval. If the run is too dear for that, time and space go apart, on
 * a coarse mesh and with few steps, and are extrapolated by the observed order if it is plausible.
 * What no march follows makes the error not known.
 *
 * tests/test_prediction.c and each case of `tests/lab/map.c` compare predictions with the exact
 * solution. */
#ifndef BR_STUDY_ESTIMATE_PREDICTION_H
#define BR_STUDY_ESTIMATE_PREDICTION_H

#include <stdbool.h>

#include "study/estimate/warnings.h"

enum { BR_PREDICTED_TEXT = 120 };

/* An error relative to the solution. */
struct br_predicted {
    double error, low, high; /* high: INFINITY where it may be as large as the solution */
    double order;            /* the observed order; NaN: none was observed, or needed */
};

struct br_prediction {
    bool known;
    char why[200];                /* not known: why */
    bool bounded;                 /* `whole` has low and high, even if it is not known */
    struct br_predicted field[2]; /* of discretisation, by br_field_kind; zeros: not
                                     modelled */
    double size[2];   /* of the fields, by br_field_kind: their largest L2 norms in the marches,
                         m^(3/2) */
    double at_tip[2]; /* the ratio of the tip's error to that norm in the marches, m^(-1/2) */
    struct br_predicted space, time, whole; /* of the field whose upper bound is the larger */
    double round_off; /* relative to the exact discrete solution: br_predict_round_off */
    double seconds;   /* that the prediction took */
};

/* "0.0014, between 0.00046 and 0.0042": an error as people read it. */
const char *br_predicted_interval(const struct br_predicted *e, char text[BR_PREDICTED_TEXT]);

/* Predicts (out). Takes some ten milliseconds, or less than the run itself if the run takes longer,
 * or the work of planned->budget. An unknown error is no failure. Fails with BR_NO_MEMORY. */
enum br_status br_predict(const struct br_planned_march *planned, struct br_prediction *prediction,
                          struct br_error *err);

/* The stated upper bound of a field's error, relative to its solution: that of the discretisation
 * error plus a bound of round-off. INFINITY: nothing is stated. */
double br_predicted_most(const struct br_prediction *prediction, enum br_field_kind kind);

/* The same at the tip of a beam of that length, m, for an error that is largest there and grows
 * like x (axial) or x^2 (bending): the field's rms error times 3^(1/2) or 5^(1/2); or more, as the
 * marches show. It is an estimate. */
double br_predicted_tip(const struct br_prediction *prediction, enum br_field_kind kind,
                        double length);

/* Whether a beam with friction follows its load at once: it has no inertia, and its viscous
 * relaxation is shorter than a step k, s. Friction then keeps the effect of the load's peaks and
 * jumps. Stages of a higher order overshoot these, steps of Euler's method do not: they are the
 * reference. */
bool br_follows_at_once(const struct br_scene *scene, double k);

/* A method that solves the same equations more accurately on the same steps: `scheme`, contact
 * at the new time level, friction that does not iterate, since the error of an iteration
 * accumulates over many steps, and the solver with the least round-off. Choose a scheme with next
 * to no numerical damping: a reference by the run's own scheme would hide the damping of both. */
struct br_method br_accurate_method(const struct br_method *own, const char *scheme);

/* Round-off of the displacements, relative to the exact discrete solution, as the linear solver
 * predicts it: the larger of the modelled fields'. */
double br_predict_round_off(const struct br_planned_march *planned);

#endif
