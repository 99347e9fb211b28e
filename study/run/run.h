/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marches one scene once, and reports all that is known of it: what is modelled, what is skipped,
 * and why. */
#ifndef BR_STUDY_RUN_RUN_H
#define BR_STUDY_RUN_RUN_H

#include "base/observer.h"
#include "reference/certificate/certificate.h"
#include "reference/energy/energy.h"
#include "solver/march.h"
#include "solver/scene.h"
#include "study/run/history.h"

/* Fields that are asked for, as bits; 0: those that the scene needs. */
enum { BR_WANT_AXIAL = 1 << BR_AXIAL, BR_WANT_BENDING = 1 << BR_BENDING };

/* The part of a scene that is to be marched: *marched (out) borrows all that the scene owns, so it
 * is not to be cleared, and must not outlive it. With wanted == 0 all is marched but the axial part
 * beside Tresca's friction, whose bound does not need it. Fails with BR_BAD_INPUT where a field is
 * wanted that the scene does not have, or that is not enough: Coulomb's bound needs the axial. */
enum br_status br_model_select(const struct br_scene *scene, unsigned wanted,
                               struct br_scene *marched, struct br_error *err);

/* One part of the scene, or of the work. */
struct br_model_row {
    const char *key;  /* one word, for programs */
    const char *part; /* for a person */
    bool modelled;
    char why[256]; /* how it is modelled, or why it is skipped */
};

enum { BR_MOST_MODEL_ROWS = 16 };

/* ---- a run ---- */

enum { BR_MOST_OUTPUTS = 8 };

/* What is asked for. All borrowed. */
struct br_run_request {
    const struct br_scene *scene;
    unsigned wanted; /* see BR_WANT_AXIAL */
    struct br_method method;
    size_t n, steps;
    size_t stride;       /* steps between rows */
    const size_t *level; /* levels, ascending: output times of the fields */
    size_t levels;
    bool check;    /* the certificate and the energy balance of every step */
    bool energies; /* the energy balance alone, for programs */
    const struct br_history_observer *output; /* outputs: who writes rows and fields */
    size_t outputs;                           /* at most BR_MOST_OUTPUTS */
    const struct br_observer *progress;       /* may be NULL */
};

/* The results. */
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
    double energy_worst, energy_limit; /* imbalance of a step; INFINITY: it is not checked, since
                                          round-off alone may be too much */
    struct br_error verdict;           /* BR_OK, or the first step beyond a limit */
    size_t bad_steps;

    double round_off;      /* predicted, of the displacements */
    bool contact_unstable; /* br_march_contact_unstable */
};

/* Fills in what is modelled, and why, from the rest of the report. */
void br_run_fill_model(struct br_run_report *report);

/* Marches and fills the report (out). A march that fails is a result: report->failure, BR_OK is
 * returned. Fails with BR_BAD_INPUT where the march cannot begin, with BR_NO_MEMORY,
 * BR_INTERRUPTED, and with what an output fails with. */
enum br_status br_run(const struct br_run_request *request, struct br_run_report *report,
                      struct br_error *err);

#endif
