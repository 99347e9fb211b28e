/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One scene marched from 0 to T, and watched: rows of the tip as they come, and the nodal fields at
 * chosen time levels. Nothing is kept but what an observer keeps, so 1e7 steps take no memory. */
#ifndef BR_STUDY_RUN_HISTORY_H
#define BR_STUDY_RUN_HISTORY_H

#include "solver/march.h"

/* The tip at one time level; what is not modelled is zero. */
struct br_history_row {
    size_t step;            /* 0 .. steps */
    double time;            /* s */
    double displacement[2]; /* by br_field_kind, m; NAN for bending in what `step` is told */
    double velocity[2];     /* m/s */
    double contact_force;   /* c_H (u - g)_+ as the step used it, N */
    double friction_force;  /* lambda, N; NAN at step 0, where the scheme has none */
    double friction_bound;  /* h(t_n), N */
};

/* Who watches a march; every function may be NULL. A status other than BR_OK ends the march and is
 * what br_history_run returns. The march is at the row's time level. */
struct br_history_observer {
    void *self;
    /* Once, at t = 0: who wants to may watch the march's stages. */
    enum br_status (*begin)(void *self, struct br_march *march, struct br_error *err);
    /* Every time level, from 0 on. The bending displacement of the row is NAN: it costs a pass over
     * the elements, which br_march_tip_displacement makes. */
    enum br_status (*step)(void *self, const struct br_march *march,
                           const struct br_history_row *row, struct br_error *err);
    /* Every level of the request's stride, the first and the last, with all values; of a march that
     * fails the last good one, its bending displacement NAN where it had not been asked for. */
    enum br_status (*row)(void *self, const struct br_history_row *row, struct br_error *err);
    /* The chosen levels: br_march_get has the fields. */
    enum br_status (*look)(void *self, const struct br_march *march,
                           const struct br_history_row *row, struct br_error *err);
};

/* What is marched, and what is told to whom. All borrowed. */
struct br_history_request {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n, steps;
    size_t stride;       /* steps between rows; 0: no rows */
    const size_t *level; /* levels, ascending, of 0 .. steps: where `look` is called */
    size_t levels;
    const struct br_history_observer *observer; /* observers */
    size_t observers;
};

/* How a march went; filled also where it failed. */
struct br_history_end {
    struct br_history_row last; /* the last good one, with all values; step 0 if none was */
    double set_up_seconds, march_seconds; /* the latter with what observers took */
};

/* Marches the request's scene. Fails as br_march_create and br_march_step do; a march that blows up
 * stops at that step and says when, in which field, and from what value on. Everything up to then
 * has been told. The march is handed to *march (out, owned by the caller; NULL where it could not
 * be set up) if `march` is not NULL, at its last level, for what may be asked of it. */
enum br_status br_history_run(const struct br_history_request *request, struct br_march **march,
                              struct br_history_end *end, struct br_error *err);

/* The stride that makes at most so many rows, the first and the last included. */
size_t br_history_stride(size_t steps, size_t most_rows);

/* ---- an observer that keeps what it is told ---- */

/* Rows, and the nodal fields at the looks; clear it. */
struct br_history_record {
    size_t n;
    size_t unknowns[2];         /* of a node, by br_field_kind, where there is a look */
    struct br_history_row *row; /* rows */
    size_t rows, most_rows;
    struct br_history_row *at; /* looks: the tip there */
    double *field;             /* looks times n + 1 nodes' values, see br_history_field */
    size_t looks, most_looks;
};

/* An observer that fills a record (in: zeroed; it must outlive the march). */
struct br_history_observer br_history_recorder(struct br_history_record *record, size_t n);
void br_history_record_clear(struct br_history_record *record);

/* The kept nodal values of a look, laid out as in solver/field.h: displacement or velocity. */
const double *br_history_field(const struct br_history_record *record, size_t look,
                               enum br_field_kind kind, bool velocity);

#endif
