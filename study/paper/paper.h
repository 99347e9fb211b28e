/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Section 3.2 of the paper, marched again: Examples 1 to 4 at the h and k of its figures, the
 * exact solutions at the same time levels, and the sweep of Figure 10. All that the
 * figures show and the claims are measured from. */
#ifndef BR_STUDY_PAPER_PAPER_H
#define BR_STUDY_PAPER_PAPER_H

#include "reference/exact/exact.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/run/history.h"

enum { BR_EXAMPLES = 4, BR_FIGURE_TIMES = 6, BR_EXACT_EARLY = 400 };

/* What it is marched with. */
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
    struct br_history_record record; /* rows: every step; looks: at the figures' times */
    struct br_history_row *exact;    /* exacts, at the rows' times, without contact force; owned */
    size_t exacts;
    struct br_exact_event *event; /* events; owned */
    size_t events;
    struct br_exact_report report[BR_EXACT_FIELDS];
};

/* The first instants of Example 1. */
struct br_early {
    double duration;                 /* s */
    struct br_history_record record; /* of the scheme, with k = duration / 1000 */
    struct br_history_row exact[BR_EXACT_EARLY + 1];
};

/* One coefficient of Example 4 varied. */
struct br_sweep_point {
    double coefficient;      /* N/m */
    double last[2], most[2]; /* |u| + |w| in L2, m^(3/2): at t = T, and the largest of 300 times;
                                with the contact force as printed [0], and at the new step [1] */
    double doubled;          /* most[1] at twice the h and k */
    bool unstable;           /* br_march_contact_unstable, as printed */
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
    double wall_seconds;
};

/* Marches everything, as tasks on the request's threads; the results do not depend on their number.
 * observer may be NULL. Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_NOT_FINITE, BR_INTERRUPTED; clear
 * the paper even then. */
enum br_status br_paper_run(struct br_paper *paper, const struct br_paper_request *request,
                            const struct br_observer *observer, struct br_error *err);
void br_paper_clear(struct br_paper *paper);

/* The times of an example's curves, s, ascending; *count of them. */
const double *br_figure_times(size_t example, size_t *count);

#endif
