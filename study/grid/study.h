/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A convergence study, its cells and their errors. */
#ifndef BR_STUDY_GRID_STUDY_H
#define BR_STUDY_GRID_STUDY_H

#include "reference/judge.h"
#include "solver/modes.h"

/* ---- norms ---- */

/* What the error of a cell is: a registry. A norm is built from measures (solver/modes.h) of the
 * difference at a cell's time levels: the largest over time of one measure and, in the energy norm,
 * a sum over time of another. It is measured for each field and for both. */

/* The error and its components, each with its own maximum over the time levels. */
enum br_part { BR_PART_TOTAL, BR_PART_AXIAL, BR_PART_BENDING, BR_PARTS };
extern const char *const br_part_names[BR_PARTS];

struct br_norm {
    const char *name;                          /* as on the command line, and in file names */
    const char *title;                         /* a sentence for a person: what the error is */
    const char *symbol;                        /* a few words, for the axis of a plot */
    const char *unit, *unit_markup, *unit_tex; /* plain, for gnuplot, for LaTeX */
    const char *theory;                        /* a sentence: what is proved of it */
    enum br_measure level;                     /* its largest value over the time levels counts */
    bool energy;  /* squares add up, and the strain rates' are summed over time */
    bool printed; /* the norm of the paper's tables */
};

extern const struct br_norm br_norm_l2, br_norm_energy, br_norm_tip;

/* NULL-terminated, at most BR_MOST_NORMS; the first is the default. */
enum { BR_MOST_NORMS = 8 };
extern const struct br_norm *const br_norms[];
const struct br_norm *br_norm_find(const char *name);

/* Whether a norm is built from a measure. */
bool br_norm_needs(const struct br_norm *norm, enum br_measure measure);

/* A difference at one time level. */
struct br_sample {
    double time;                 /* s */
    double weight;               /* time since the last sample, s; 0 at t = 0 */
    double size[2][BR_MEASURES]; /* by br_field_kind */
};

/* A norm accumulated over the time levels; starts as zeros. */
struct br_norm_sum {
    double most[BR_PARTS]; /* squared in the energy norm; a NaN stays */
    double time[BR_PARTS]; /* of the largest, s */
    double sum[BR_PARTS];
};

/* Adds a sample. */
void br_norm_add(const struct br_norm *norm, const struct br_scene *scene,
                 const struct br_sample *sample, struct br_norm_sum *sum);

/* The norm of one component so far. */
double br_norm_value(const struct br_norm *norm, const struct br_norm_sum *sum, enum br_part part);

/* The norm of a difference whose sizes, by br_field_kind, are constant in time. NaN if a size is
 * NaN that the norm needs of a modelled field. */
double br_norm_of_constant(const struct br_norm *norm, const struct br_scene *scene,
                           const double size[2][BR_MEASURES], enum br_part part);

/* ---- a study ---- */

struct br_kept;

/* A convergence study: a grid of cells (n, k) against one reference, with the error in
 * one norm over all the time levels of each cell. */

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
    BR_FLAG_STALLED,   /* finer grids have no smaller error */
    BR_FLAG_COARSE,    /* the grid is too coarse for the order of the finer ones */
    BR_FLAG_OUTLIER,   /* the error is far from those of its neighbours */
    BR_CELL_FLAGS
};
const char *br_flag_name(
    enum br_flag flag); /* "", "reference", "round-off", "failed", "unstable", "stagnation",
                      "not asymptotic", "outlier" */

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
    const struct br_judge *auditor; /* measures the reference's own error; NULL: none. Set to NULL
                                       where it cannot promise a solution */
    size_t n_count, k_count;
    bool path;                  /* the cells are (n[i], steps[i]) alone, and n_count = k_count */
    bool alone;                 /* marched by the calling rank, not by all ranks together */
    const size_t *n;            /* n_count, borrowed */
    const size_t *steps;        /* k_count, borrowed */
    struct br_study *next_norm; /* the same study in another norm, all else being equal: measured
                                   on the same marches; NULL: none. Borrowed */
    struct br_kept *kept;       /* where finished cells are kept (study/kept/kept.h); NULL: nowhere.
                                   All studies of a call, or none of them. Borrowed */
    /* out */
    struct br_cell *cell; /* br_study_cells of them, by rows of equal n; owned */
    struct br_judge_report judged_by;
    char *events;                     /* lines that the reference prints; owned; may be NULL */
    double reference_scale;           /* the norm of the reference itself */
    double reference_size[2];         /* the same of each field, by br_field_kind */
    double reference_error[BR_PARTS]; /* by the auditor; without one: NaN */
    double reference_tip[2];          /* the reference's displacement at x = L, t = T, m */
    struct br_error failure; /* of the reference or the grid; the rest then means nothing */
};

void br_study_clear(struct br_study *study);

/* How many cells a study has. */
size_t br_study_cells(const struct br_study *study);

/* The method that marches a cell. */
const struct br_method *br_study_method(const struct br_study *study, size_t cell);

/* Which n[i] a cell has. */
size_t br_study_row(const struct br_study *study, size_t cell);

/* The resolution that a cell is to have. */
struct br_resolution br_study_resolution(const struct br_study *study, size_t cell);

/* The cell of row i (n) and column j (k); not of a path. */
const struct br_cell *br_study_cell(const struct br_study *study, size_t i, size_t j);

/* Steps of size k that make up the scene's duration. Refuses k that does not
 * divide it (BR_BAD_INPUT) with the nearest that do. */
enum br_status br_steps_of(const struct br_scene *scene, double k, size_t *steps,
                           struct br_error *err);

/* Sorts meshes or numbers of steps, the least first. */
void br_sort_counts(size_t *counts, size_t count);

/* k = T/steps, s, and h = L/n, m. For 0 steps or elements, as an exact reference has, 0. */
double br_time_step(const struct br_scene *scene, size_t steps);
double br_mesh_size(const struct br_scene *scene, size_t n);

/* The reference's own k, s, and h, m; 0 where it has none. */
double br_reference_step(const struct br_study *study);
double br_reference_mesh(const struct br_study *study);

#endif
