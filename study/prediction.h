/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discretisation error of a run, predicted before it: the largest L2 norm of the error over all
 * time levels, relative to the largest of the solution, as `trade` has it.
 *
 * Coarse marches of the same method, against finer ones, tell it: the run's own steps where they
 * are few, else so many as are cheap, on a coarse mesh; the run's first steps, of their own length,
 * for what happens at t = 0; and the run's own mesh, or one of 128 elements, at few steps. What
 * lies beyond is extrapolated by the order that was observed where that makes sense, else by
 * theory's. That switching (stick and slip, contact) spoils orders above one is not seen by coarse
 * marches: the upper bound then takes order one.
 *
 * Over eight bundled scenes, three methods, n from 3 to 100 and 1 to 200 steps, held against the
 * exact solution (tests/test_prediction.c): of 288 predictions, all known, 96 % are within a factor
 * 3 and 99 % within 10, none is 100 times too low.
 */
#ifndef BR_PREDICTION_H
#define BR_PREDICTION_H

#include <stdbool.h>

#include "study/warnings.h"

/* A part of the error, relative to the solution. */
struct br_predicted {
    double error, low, high;
    double order; /* as it was observed; NaN: it was not, or not needed */
};

struct br_prediction {
    bool known;
    char why[200]; /* not known: why */
    bool bounded;  /* low and high of `whole` mean something, also where it is not known */
    struct br_predicted space, time, whole;
    double round_off; /* relative to the exact discrete solution: br_predict_round_off */
    double seconds;   /* that the prediction took */
};

/* Predicts (out). Takes some milliseconds, and less than the run itself where that takes longer;
 * what it cannot tell is no failure. Fails with BR_NO_MEMORY. */
enum br_status br_predict(const struct br_outlook *outlook, struct br_prediction *prediction,
                          struct br_error *err);

/* Round-off of the displacements, relative to the exact discrete solution, as the linear solver
 * predicts it: the larger of the modelled fields'. */
double br_predict_round_off(const struct br_outlook *outlook);

#endif
