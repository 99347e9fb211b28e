/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A convergence study: a grid of cells (n, k) against one reference, with the error in
 * one norm over all the time levels of each cell. */
#ifndef BR_STUDY_GRID_STUDY_H
#define BR_STUDY_GRID_STUDY_H

#include "reference/judge.h"
#include "study/grid/norm.h"

/* A discretisation: n equal elements, `steps` equal time steps of T/steps. */
struct br_resolution {
    size_t n, steps;
};

/* Why a cell is left out of the fits. */
enum br_flag {
    BR_FLAG_NONE,
    BR_FLAG_REFERENCE, /* the reference's own error is not small beside it */
    BR_FLAG_ROUND_OFF, /* it is at the round-off of a solver */
    BR_FLAG_FAILED,    /* the march failed, or its error is not a number */
    BR_FLAG_UNSTABLE,  /* lagged contact beyond its stability limit: bounded chatter */
};
const char *br_flag_name(
    enum br_flag flag); /* "", "reference", "round-off", "failed", "unstable" */

struct br_cell {
    struct br_resolution at;
    struct br_resolution against; /* what it is compared with; zeros: the continuous problem */
    double error[BR_PARTS];       /* in the norm's unit; NaN: failed */
    double worst_time[BR_PARTS];  /* where the maximum was, s */
    double tip[2];                /* displacement at x = L, t = T, by br_field_kind, m */
    double seconds;               /* of the march alone, one thread */
    enum br_flag flag[BR_PARTS];
    bool unstable;           /* br_march_contact_unstable */
    struct br_error failure; /* status BR_OK where the march went well */
};

struct br_study {
    /* in */
    const struct br_scene *scene;
    const struct br_norm *norm;
    struct br_method method; /* of the cells */
    const struct br_method
        *cell_method;                  /* br_study_cells of them: of each cell instead, on elements
                                          of method's degree; NULL: all alike. Borrowed */
    const struct br_judge *judge;      /* the reference */
    struct br_method reference_method; /* of a fine run */
    struct br_resolution reference;    /* a fine run's; otherwise n = 0, and steps are set to the
                                          least common multiple of the cells' */
    const struct br_judge *auditor;    /* measures the reference's own error; NULL: nobody. Set
                                          to NULL where it cannot promise a solution */
    size_t n_count, k_count;
    bool path;                  /* the cells are (n[i], steps[i]) alone, and n_count = k_count */
    const size_t *n;            /* n_count, borrowed */
    const size_t *steps;        /* k_count, borrowed */
    struct br_study *next_norm; /* the same study in another norm, all else being equal: measured
                                   on the same marches; NULL: none. Borrowed */
    /* out */
    struct br_cell *cell; /* br_study_cells of them, by rows of equal n; owned */
    struct br_judge_report judged_by;
    char *events;                     /* what the reference tells, lines; owned; may be NULL */
    double reference_scale;           /* the norm of the reference itself */
    double reference_size[2];         /* the same of each field, by br_field_kind */
    double reference_error[BR_PARTS]; /* by the auditor; without one: NaN */
    double reference_tip[2];          /* the reference's displacement at x = L, t = T, m */
    struct br_error failure; /* of the reference or the grid; the rest then means nothing */
};

void br_study_clear(struct br_study *study);

/* How many cells a study has. */
size_t br_study_cells(const struct br_study *study);

/* What a cell is marched by. */
const struct br_method *br_study_method(const struct br_study *study, size_t cell);

/* Which n[i] a cell has. */
size_t br_study_row(const struct br_study *study, size_t cell);

/* What a cell's grid is to be. */
struct br_resolution br_study_resolution(const struct br_study *study, size_t cell);

/* The cell of row i (n) and column j (k); not of a path. */
const struct br_cell *br_study_cell(const struct br_study *study, size_t i, size_t j);

/* Steps of size k that make up the scene's duration. Refuses k that does not
 * divide it (BR_BAD_INPUT) with the nearest that do. */
enum br_status br_steps_of(const struct br_scene *scene, double k, size_t *steps,
                           struct br_error *err);

/* k = T/steps, s, and h = L/n, m. For 0 steps or elements, as an exact reference has, 0. */
double br_time_step(const struct br_scene *scene, size_t steps);
double br_mesh_size(const struct br_scene *scene, size_t n);

/* The reference's own k, s, and h, m; 0 where it has none. */
double br_reference_step(const struct br_study *study);
double br_reference_mesh(const struct br_study *study);

#endif
