/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A convergence study: a grid of cells (n, k) against one reference, with the error in one norm
 * over all the time levels of each cell. */
#ifndef BR_STUDY_GRID_STUDY_H
#define BR_STUDY_GRID_STUDY_H

#include "orders/axis.h"
#include "reference/reference.h"
#include "study/grid/norms.h"
#include "study/scene/resolution.h"

struct br_statement;

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
        *cell_method; /* br_study_cells of them: of each cell instead, on elements
                         of method's degree; NULL: all alike. Borrowed */
    const struct br_reference *reference_kind; /* the reference */
    struct br_method reference_method;         /* of a fine run */
    struct br_resolution reference; /* a fine run's; otherwise n = 0, and steps are set to the
                                       least common multiple of the cells' */
    const struct br_reference *reference_check; /* measures the reference's own error; NULL: none.
                                       Set to NULL where it cannot promise a solution */
    size_t n_count, k_count;
    bool path;                  /* the cells are (n[i], steps[i]) alone, and n_count = k_count */
    const size_t *n;            /* n_count, borrowed */
    const size_t *steps;        /* k_count, borrowed */
    struct br_study *next_norm; /* the same study in another norm, all else being equal: measured
                                   on the same marches; NULL: none. Borrowed */
    bool here;                  /* of all studies of a call: by this process (sweep.h) */
    /* out */
    struct br_cell *cell; /* br_study_cells of them, by rows of equal n; owned */
    struct br_reference_report reference_report;
    char *events;                     /* lines that the reference prints; owned; may be NULL */
    double reference_scale;           /* the norm of the reference itself */
    double reference_size[2];         /* the same of each field, by br_field_kind */
    double reference_error[BR_PARTS]; /* by the reference check; without one: NaN */
    double reference_tip[2];          /* the reference's displacement at x = L, t = T, m */
    struct br_error failure; /* of the reference or the grid; the rest then means nothing */
};

void br_study_clear(struct br_study *study);

/* Checks the grid, sets the reference's time levels where it has none, and makes the cells, in all
 * norms. Fails with BR_BAD_INPUT, naming the nearest values that would do, or BR_NO_MEMORY. */
enum br_status br_study_prepare(struct br_study *study, struct br_error *err);

/* The most steps of a fine run between two time levels of the cells; 1: of other references. */
static inline size_t br_study_longest_gap(const struct br_study *s)
{
    size_t most = 1;
    for (size_t j = 0; j < s->k_count; j++)
        most = s->steps[j] > most ? s->steps[j] : most;
    return s->reference_kind->nests && most < s->reference.steps ? s->reference.steps / most : 1;
}

/* How many cells a study has. */
static inline size_t br_study_cells(const struct br_study *s)
{
    return s->path ? s->n_count : s->n_count * s->k_count;
}

/* The method that marches a cell. */
static inline const struct br_method *br_study_method(const struct br_study *s, size_t cell)
{
    return s->cell_method ? &s->cell_method[cell] : &s->method;
}

/* Which n[i] a cell has. */
static inline size_t br_study_row(const struct br_study *s, size_t cell)
{
    return s->path ? cell : cell / s->k_count;
}

/* The resolution that a cell is to have. */
static inline struct br_resolution br_study_resolution(const struct br_study *s, size_t cell)
{
    return (struct br_resolution){s->n[br_study_row(s, cell)],
                                  s->steps[s->path ? cell : cell % s->k_count]};
}

/* The cell of row i (n) and column j (k); not of a path. */
static inline const struct br_cell *br_study_cell(const struct br_study *study, size_t i, size_t j)
{
    return &study->cell[i * study->k_count + j];
}

/* The least number of equal time steps that has the levels of a and of b; 0: more than 2^52. */
size_t br_common_levels(size_t a, size_t b);

/* The reference's own k, s, and h, m; 0 where it has none. */
static inline double br_reference_step(const struct br_study *s)
{
    return s->reference_kind->nests ? br_time_step(s->scene, s->reference.steps) : 0;
}

static inline double br_reference_mesh(const struct br_study *s)
{
    return br_mesh_size(s->scene, s->reference.n);
}

/* All that a study asks in its norm. */
void br_state_study(struct br_statement *statement, const struct br_study *study);

/* ---- over h and over k ---- */

/* The number of meshes, or of time steps, of a study; the size of one, m or s (0: the continuous
 * problem); and the index of a cell from its indices along an axis and along the other axis. */
static inline size_t br_axis_count(const struct br_study *s, int axis)
{
    return axis == BR_AXIS_SPACE ? s->n_count : s->k_count;
}

static inline double br_axis_size(const struct br_scene *scene, int axis, struct br_resolution at)
{
    return axis == BR_AXIS_SPACE ? br_mesh_size(scene, at.n) : br_time_step(scene, at.steps);
}

static inline size_t br_axis_cell(const struct br_study *s, int axis, size_t along, size_t at)
{
    return axis == BR_AXIS_SPACE ? along * s->k_count + at : at * s->k_count + along;
}

#endif
