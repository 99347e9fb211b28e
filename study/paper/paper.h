/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Section 3.2 of the paper, marched again: Examples 1 to 4 at the h and k of its figures, the
 * exact solutions at the same time levels, and the sweep of Figure 10. All that the
 * figures show and the claims are measured from. */
#ifndef BR_STUDY_PAPER_PAPER_H
#define BR_STUDY_PAPER_PAPER_H

#include "base/observer.h"
#include "reference/exact/exact.h"
#include "solver/scene.h"
#include "study/grid/study.h"
#include "study/run/history.h"

enum { BR_EXAMPLES = 4, BR_FIGURE_TIMES = 6, BR_EXACT_EARLY = 400 };

/* The resolution of the marches. */
struct br_paper_request {
    size_t n;          /* elements of L: 1000, even */
    size_t per_second; /* steps of 1 s, 1000: an even multiple of 100 */
    size_t per_decade; /* points of the sweep, 4 */
    int threads;       /* 0: all cores */
};
struct br_paper_request br_paper_request_default(void);

/* Reads Example i + 1, i below BR_EXAMPLES; clear it even after a failure. Fails as scenes do. */
enum br_status br_paper_scene(size_t i, struct br_scene *scene, struct br_error *err);

/* One example. */
struct br_example {
    struct br_scene scene;
    struct br_history_record record; /* rows: every step; samples: at the figures' times */
    struct br_history_row *exact;    /* exacts, at the rows' times, without contact force; owned */
    size_t exacts;
    struct br_exact_event *event; /* events; owned */
    size_t events;
};

/* The first instants of Example 1. */
struct br_early {
    struct br_history_record record; /* of the scheme, with k = 0.1 microseconds */
    struct br_history_row exact[BR_EXACT_EARLY + 1];
};

/* One coefficient of Example 4 varied. */
enum { BR_SWEEP_WAYS = 3 };
struct br_sweep_point {
    double coefficient; /* N/m */
    /* |u| + |w| in L2, m^(3/2), at t = T, and the largest of 300 times: with the contact force as
     * printed, at the new step, and that at twice the h and k */
    double last[BR_SWEEP_WAYS], most[BR_SWEEP_WAYS];
    bool unstable; /* br_march_contact_unstable, as printed */
};
struct br_sweep {
    struct br_sweep_point *point; /* points, ascending; owned */
    size_t points;
    double paper; /* the coefficient's value in the paper */
};
enum { BR_SWEEP_CONTACT, BR_SWEEP_FRICTION, BR_SWEEPS };

/* Two cells of a printed table against the exact solution: n = 100, k = 0.01 and 0.005. */
enum { BR_PAPER_TABLES = 2 };
struct br_paper_table {
    size_t n[1], steps[2];
    struct br_study study;
    double printed[2]; /* m^(3/2) */
};

struct br_paper {
    struct br_paper_request request;
    struct br_example example[BR_EXAMPLES];
    struct br_early early;
    struct br_sweep sweep[BR_SWEEPS];
    struct br_paper_table table[BR_PAPER_TABLES];
    double coupled; /* m: how far Example 3's tip at t = T moves when an axial field is added */
};

/* Marches everything, as tasks on the request's threads; the results do not depend on their number.
 * observer may be NULL. Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_NOT_FINITE, BR_INTERRUPTED; clear
 * the paper even then. */
enum br_status br_paper_run(struct br_paper *paper, const struct br_paper_request *request,
                            const struct br_observer *observer, struct br_error *err);
void br_paper_clear(struct br_paper *paper);

/* ---- claims ---- */

/* What the paper says there, as far as it can be checked: a registry. Each claim measures its value
 * from the marches above, and from the exact solution where that has it.
 *
 * To add a claim: a function and a row in claims.c. */

enum br_agreement {
    BR_AGREES,
    BR_DIFFERS,
    BR_UNDECIDED, /* the error bar spans both, or a value is not a number */
};
extern const char *const br_agreement_names[]; /* "agree", "differ", "undecided" */

/* The result of a claim. NaN: not available. */
struct br_finding {
    double value;   /* of the scheme at the figures' h and k */
    double exact;   /* of the continuous problem */
    double error;   /* bar of `value`: |value - exact| and the exact one's own error, or, where
                       there is no exact one, the distance to a second resolution */
    double printed; /* where the paper has a number */
    enum br_agreement agreement;
    char note[240]; /* why, with figures; plain ASCII; may be empty */
};

struct br_claim {
    const char *name;      /* one word */
    const char *section;   /* of the paper */
    int figure;            /* that shows it; 0: none */
    const char *statement; /* what the paper says */
    const char *measured;  /* what `value` is */
    const char *unit;      /* "1" where there is none */
    void (*measure)(const struct br_paper *paper, size_t which, struct br_finding *finding);
    size_t which; /* of the examples, tables or sweeps */
};

/* Ends with a row whose name is NULL; at most BR_MOST_CLAIMS. */
enum { BR_MOST_CLAIMS = 32 };
extern const struct br_claim br_claims[];

/* Measures one claim; a value that is no number leaves it undecided. */
struct br_finding br_claim_measure(const struct br_claim *claim, const struct br_paper *paper);

/* For claims.c: agree where value (and its bar) is below or above a limit, undecided where that
 * spans it. */
enum br_agreement br_below(double value, double error, double limit);
enum br_agreement br_above(double value, double error, double limit);

/* Agrees where a printed number lies within half of its last digit and the bar of the exact value,
 * or of the scheme's where that is not known. */
enum br_agreement br_same(const struct br_finding *finding, double half_digit);

#endif
