/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a digit costs in one scene: trials of many methods at many resolutions, the Pareto front of
 * their errors and seconds, and the cheapest way to each error. Errors are relative: the norm of
 * the error over the norm of the solution. */
#ifndef BR_STUDY_TRADE_TRADE_H
#define BR_STUDY_TRADE_TRADE_H

#include "reference/printed.h"
#include "study/trade/trial.h"

/* Targets: relative errors of 1e-2 to 1e-10. */
enum { BR_TRADE_FIRST_DIGIT = 2, BR_TRADE_LAST_DIGIT = 10, BR_TRADE_DIGITS = 9 };
double br_trade_target(size_t digit); /* 0 .. BR_TRADE_DIGITS - 1 */

/* What is tried. Lists are borrowed; an empty one means the default. */
struct br_trade_grid {
    const size_t *n, *steps;
    const double *tolerance; /* of adaptive schemes */
    size_t n_count, step_count, tolerances;
    const struct br_printed *printed; /* the scene's printed table; NULL: none */
};

struct br_trade {
    struct br_named_methods methods;
    struct br_trial_request request;
    struct br_trial *trial; /* count, those of a named method together; owned */
    size_t count;
    bool *front;                  /* count: on the Pareto front of all; owned */
    size_t best[BR_TRADE_DIGITS]; /* the cheapest trial to each target; `count`: none */
    /* Likewise of each named method. */
    size_t best_of[BR_MOST_NAMED_METHODS][BR_TRADE_DIGITS];
    struct br_trial_outlook outlook;
    void *judge;         /* kept from the outlook on; owned */
    double wall_seconds; /* of all of it */
};

/* Lays out the trials of the named methods, which are set. Without lists of its own a grid is
 * coarse, leaves out what would be heavy, and has the printed table's cells for the paper's method.
 * Fails with BR_NO_MEMORY, BR_BAD_INPUT (no trial at all). */
enum br_status br_trade_lay_out(struct br_trade *trade, const struct br_trade_grid *grid,
                                struct br_error *err);

/* Foresees what the trials take; `request` is set. Fails as br_trials_foresee does. */
enum br_status br_trade_foresee(struct br_trade *trade, struct br_error *err);

/* Holds the trials and chooses. Fails as br_trials_hold does. */
enum br_status br_trade_hold(struct br_trade *trade, struct br_error *err);
void br_trade_clear(struct br_trade *trade);

/* Whether a named method is the paper's own method. */
bool br_trade_is_printed_method(const struct br_named_method *named);

/* -log10 of the relative error, over the seconds; NaN: no trial that counts. */
double br_trade_digits_per_second(const struct br_trial *trial);

/* What --seconds would have to be for all trials, with some to spare. */
double br_trade_seconds_of_all(const struct br_trial_outlook *outlook);

/* How many trials ended like that. */
size_t br_trade_tally(const struct br_trade *trade, enum br_trial_end end);

/* ---- choosing ---- */

/* The trial with the least seconds among those whose error is at most the target, of one named
 * method or of all (NULL); of equals the one with fewer solves, then the first. `count`: there is
 * none. */
size_t br_trials_cheapest(const struct br_trial *trial, size_t count, double target,
                          const struct br_named_method *only);

/* Marks (out, count) the trials that no other one beats in error or seconds without losing in the
 * other; of equals the first. A slower one must be better by more than a millionth. */
void br_trials_front(const struct br_trial *trial, size_t count, bool *front);

#endif
