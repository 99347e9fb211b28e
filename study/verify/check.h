/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks of scenes against what is expected of them (verify.h), with a verdict on each expectation:
 * from the order's 95 % interval, not from a slope. */
#ifndef BR_STUDY_VERIFY_CHECK_H
#define BR_STUDY_VERIFY_CHECK_H

#include "study/base/observer.h"
#include "study/fit/fit.h"
#include "study/verify/verify.h"

enum br_verdict {
    BR_PASS,         /* the interval lies within the band */
    BR_FAIL,         /* it lies outside; or the constant is out of its range; or an error is not
                        a number, or missing */
    BR_INCONCLUSIVE, /* it straddles, or too few points are left: counts as failing */
};
extern const char *const br_verdict_names[]; /* "PASS", "FAIL", "INCONCLUSIVE" */

/* One error of a study. */
struct br_point {
    struct br_resolution at, against; /* against: zeros for the continuous problem */
    double z, z_against;              /* h/L or k/T, what the order is in; and that of `against` */
    double error;                     /* in the norm's unit */
    double constant;                  /* C of e = C (z^order - z_against^order) */
    char label[64];                   /* "n = 40", for messages */
    enum br_flag flag;                /* why it is left out */
    bool used;                        /* for the order: it is not left out */
    bool lost; /* the search for the order left it out (line_order.h), and nothing before it */
    char failure[256];      /* of the march; "": it went well */
    struct br_estimate fit; /* the line of the order there, and its band; NaN: there is none, or
                               the order is that of a joint fit, which is no line */
    double deviation;       /* the error's standard deviation, where it is a mean; 0: it is none */
    double rounding;        /* half a unit of its last digit, where it was printed; 0: it was not */
};

/* The order that two points show, the coarser one first; NaN as br_order_rate. */
double br_point_rate(const struct br_point *coarse, const struct br_point *fine);

/* An expectation and what was observed. */
struct br_case {
    enum br_verify_kind kind;
    struct br_expectation expected; /* order: NaN where nothing is expected */
    const char *measure, *part;     /* norm, or column, of the errors; borrowed */
    const char *unit;               /* of the errors; "": not known; borrowed */
    struct br_point *point;         /* points, from coarse to fine; owned */
    size_t points, used;
    bool may_miss; /* a point without a number is left out by name; else it fails the case */
    struct br_estimate order;
    double low99, high99;      /* the order's 99 % interval: what lies outside is excluded */
    bool exponential; /* `expected` is not an order, but what the factor below is to be */
    struct br_estimate factor; /* exponential convergence: one more of 1/z divides the error by it;
                                  NaN: it is none, or that of n^g */
    const char *law;  /* what explains the errors best, beside one power; NULL: one power */
    double constant;  /* the largest of the finest five used points'; NaN: none */
    const char *open; /* why no order can be judged, and what would show one; NULL; borrowed */
    bool of_grid; /* the order is that of a joint fit, orders from point to point are another axis's */
    double duration;  /* T of the scene, s; 0: of another program */
    double down_to;   /* errors stop falling there, as is expected; 0: nowhere */
    double margin;    /* from the interval to the nearer end of the band; < 0: outside */
    enum br_verdict verdict;
    char reason[768]; /* why it does not pass, and what would make it pass or fail; or "" */
    char note[512];   /* what was left out; or "" */
};

/* Finds the order of a case, and leaves out the points that do not show it (line_order.h), whose
 * kind, expected, measure, part, unit and points (at, against, z, z_against, error, label, flag,
 * failure) are set, from at least so many that are not left out; without a verdict. Fails with
 * BR_NO_MEMORY. */
enum br_status br_case_observe(struct br_case *c, size_t least, struct br_error *err);

/* Takes an order and a constant from elsewhere, the joint fit of a grid, which describes all
 * points: none is left out. */
void br_case_take_order(struct br_case *c, struct br_estimate order, double constant);

/* The verdict on what was observed. */
void br_case_judge(struct br_case *c);

/* ---- checks of scenes ---- */

/* Checks scenes against what is expected of them (verify.h): marches, measures, judges. */

struct br_check {
    /* in; borrowed */
    const char *path;               /* of the scene, for messages */
    bool no_file;                   /* the path is a word for --run or standard input */
    const char *name;               /* of the scene, or of the study of another program */
    const struct br_scene *scene;   /* NULL: of another program, whose cases are given */
    const struct br_verify *verify; /* NULL likewise */
    char problem[40];               /* a hash of what is solved, for comparisons; "": none */
    const char *data;               /* as in struct br_verify; NULL: not known */
    /* out */
    struct br_error failure; /* BR_BAD_INPUT: the scene cannot be verified (its reference or a
                                method refuses it), with file and line; there are no cases then */
    struct br_case *cases;   /* by study, in the order of the expectations; owned */
    size_t count;
    double seconds;       /* of all marches of the solver, one thread */
    double element_steps; /* of these, elements times steps, a field */
};

/* Checks scenes, all at once (those of other programs are left as they are), on `threads` threads
 * (0: all cores); the verdicts do not depend on their number. A march that fails is a verdict; a
 * scene that cannot be verified has a `failure`, and the others go on. Fails as br_study_run_each
 * does. */
enum br_status br_check_run(struct br_check *checks, size_t count, int threads,
                            const struct br_observer *observer, struct br_error *err);
void br_check_clear(struct br_check *check);

/* The study that is marched for pair h of neighbours, or for the joint path (h = 0), but for its
 * norm. */
struct br_study br_check_study(const struct br_check *check, enum br_verify_kind kind, size_t h);

/* How many checks have a failure, and which is the first; NULL: none. */
size_t br_check_failures(const struct br_check *checks, size_t count,
                         const struct br_check **first);

/* How many cases of all checks have a verdict. */
size_t br_check_tally(const struct br_check *checks, size_t count, enum br_verdict verdict);

#endif
