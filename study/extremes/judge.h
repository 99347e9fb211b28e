/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a march was right, or said that it was not: the promise, held against one case.
 *
 * A case is read, looked ahead at, and marched as `run --check` does. Then
 *   - the certificate of every step, the energy balance and the numbers themselves must be sound;
 *   - the exact solution, or where that cannot be promised in time another scheme on a finer mesh
 * by shorter steps, tells how far off the displacements are, against what was stated before the
 *     march (prediction.h);
 *   - the same scene in other units (metre, second and kilogram each by a random factor) must give
 *     the same answer, to the predicted round-off and what a change of the data by 1e-12 does to
 *     it, which is 1000 times what the other units do to them.
 * Silently wrong is an answer that is further off than the error that is stated, with its interval,
 * or than 5 % where none is stated and no warning says so; or that breaks an equation or a law.
 * Each field counts by its own size. */
#ifndef BR_STUDY_EXTREMES_JUDGE_H
#define BR_STUDY_EXTREMES_JUDGE_H

#include "study/extremes/case.h"
#include "study/foresee/warnings.h"

enum br_extreme_class {
    BR_EXTREME_RIGHT,
    BR_EXTREME_WARNED,   /* inaccurate, and says so */
    BR_EXTREME_UNKNOWN,  /* inaccurate, and says that its error is not known */
    BR_EXTREME_UNSTABLE, /* as predicted */
    BR_EXTREME_REFUSED,
    BR_EXTREME_UNJUDGED, /* given up by the map */
    BR_EXTREME_WRONG,
    BR_EXTREME_CLASSES
};
struct br_extreme_names {
    const char *word;            /* for programs */
    const char *title, *heading; /* for people: of a picture's key, and short */
};
extern const struct br_extreme_names br_extreme_names[BR_EXTREME_CLASSES];

/* Who tells how accurate it is. */
enum br_extreme_by { BR_BY_NOBODY, BR_BY_EXACT, BR_BY_REFINEMENT };
extern const char *const br_extreme_judges[];

struct br_extreme_verdict {
    enum br_extreme_class which;
    enum br_extreme_by by;
    bool known;       /* the run states its error */
    double error;     /* of displacements, over the largest; NaN: not known */
    double stated;    /* the most that the error is stated to be, of the field that is nearest to it
                         or beyond; INFINITY: nothing is stated; NaN: not compared */
    double units;     /* the same between two systems of units; NaN: not compared */
    double round_off; /* predicted */
    unsigned warned;  /* bits: 1 << br_warning_kind */
    char why[200];    /* of what is not right; one line */
};

/* How judging is done; zeros: as the map does. */
struct br_extreme_judging {
    int rounding; /* of the marches, as fesetround takes it */
    bool quick;   /* without the other units and the exact solution */
    double boast; /* stated errors are taken for so many times smaller, so that tests see what is
                     called wrong; 0: as stated */
};

/* Judges a case; *verdict (out). Fails with BR_NO_MEMORY. */
enum br_status br_extreme_judge(const struct br_extreme_case *one,
                                const struct br_extreme_judging *judging,
                                struct br_extreme_verdict *verdict, struct br_error *err);

#endif
