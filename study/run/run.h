/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One scene, marched once, with all that can be told of it. */
#ifndef BR_STUDY_RUN_RUN_H
#define BR_STUDY_RUN_RUN_H

#include "reference/certificate/certificate.h"
#include "reference/energy/energy.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/run/model.h"
#include "study/run/step_cost.h"
#include "study/run/tip_watch.h"

enum { BR_MOST_OUTPUTS = 8 };

/* What is asked for. All borrowed. */
struct br_run_request {
    const struct br_scene *scene;
    unsigned wanted; /* fields, see study/run/model.h */
    struct br_method method;
    size_t n, steps;
    size_t stride;       /* steps between rows */
    const size_t *level; /* levels, ascending: output times of the fields */
    size_t levels;
    bool check;    /* the certificate and the energy balance of every step */
    bool energies; /* the energy balance */
    bool explain;  /* what the parts of a step cost */
    const struct br_history_observer *output; /* outputs: who writes rows and fields */
    size_t outputs;                           /* at most BR_MOST_OUTPUTS */
    const struct br_observer *progress;       /* NULL: nobody */
};

/* What has come out. */
struct br_run_report {
    const struct br_scene *scene; /* of the request */
    struct br_scene marched;      /* borrows from it */
    struct br_method method;
    size_t n, steps, levels;
    double h, k; /* m, s */
    struct br_history_end end;
    struct br_error failure; /* BR_OK: it reached T; else why it stopped after end.last */
    struct br_tip_watch watch;
    struct br_counts counts;
    struct br_switch switched[BR_MOST_SWITCHES]; /* those that the scheme itself has found */
    size_t switches;                             /* also of those that are not kept */
    struct br_model_row model[BR_MOST_MODEL_ROWS];
    size_t model_rows;

    bool at_end; /* energy_now is known */
    struct br_energy energy_start, energy_now;
    bool summed; /* work is known, up to energy_now */
    struct br_work work;

    bool checked;
    struct br_certificate worst, limits;
    double energy_worst, energy_limit; /* imbalance of a step; INFINITY: it is not judged, since
                                          round-off alone may be too much */
    struct br_error verdict;           /* BR_OK, or the first step beyond a limit */
    size_t bad_steps;

    bool explained;
    struct br_step_cost cost;

    double round_off;      /* predicted, of the displacements */
    bool contact_unstable; /* br_march_contact_unstable */
};

/* Marches and fills the report (out). A march that fails is a result: report->failure, BR_OK is
 * returned. Fails with BR_BAD_INPUT where the march cannot begin, with BR_NO_MEMORY,
 * BR_INTERRUPTED, and with what an output fails with. */
enum br_status br_run(const struct br_run_request *request, struct br_run_report *report,
                      struct br_error *err);

#endif
