/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A registry of references. A reference gives the solution at the time levels t_i = i T / levels,
 * in the measures of solver/modes.h and on the meshes that were requested. */
#ifndef BR_REFERENCE_REFERENCE_H
#define BR_REFERENCE_REFERENCE_H

#include <stdio.h>

#include "base/observer.h"
#include "solver/march.h"
#include "solver/method.h"

struct br_reference_request {
    const struct br_scene *scene;  /* must outlive the reference */
    struct br_method method;       /* fine only */
    size_t n;                      /* fine only: its elements */
    int axial_degree;              /* of the elements whose modes it will be sampled in */
    size_t levels;                 /* time levels after t = 0; for fine, its steps */
    size_t lead;                   /* time levels that the axial field may be ahead by */
    bool modest;                   /* exact only: give up where it takes more than moderate work */
    bool measured[2][BR_MEASURES]; /* by br_field_kind: what it will be sampled for */
    size_t mesh_count;             /* the meshes that it will be sampled on */
    const size_t *mesh;            /* mesh_count, elements; borrowed during create */
    const struct br_observer *observer; /* NULL: nobody; `preparing`: of exact alone, of the allowed
                                           work that it may take. Borrowed */
};

/* What a reference reports of its accuracy and cost. */
struct br_reference_report {
    double own_error[2][BR_MEASURES]; /* by br_field_kind, largest over time; m^(3/2) and
                                         its rates, the tip's in m; NaN: not known */
    double round_off;                 /* predicted, relative to the solution */
    double seconds;                   /* of its work so far, one thread */
    bool unstable;                    /* br_march_contact_unstable, of a fine run */
    struct {
        double from, length; /* s; length 0: not known */
        int phase;           /* enum br_phase */
    } shortest;              /* of the tip's phases: what larger steps do not resolve */
};

/* What a reference is sampled for. */
struct br_sample_at {
    enum br_field_kind kind;
    enum br_measure measure;
    size_t mesh; /* an index into the request's meshes */
};

struct br_reference {
    const char *name;   /* as on the command line */
    const char *syntax; /* with its arguments */
    const char *title;  /* one line for a person */
    const char *citation;
    bool nests; /* cells must nest in its own mesh and time levels */

    /* Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_SINGULAR or BR_NOT_FINITE (it cannot
     * promise a solution of this scene); free *self even then. */
    enum br_status (*create)(void **self, const struct br_reference_request *request,
                             struct br_error *err);
    void (*free)(void *self); /* accepts NULL */

    /* Advances one field to time level i, never back. Two threads may advance and sample the two
     * fields. The axial field is advanced first, by at most the request's lead. */
    enum br_status (*advance)(void *self, enum br_field_kind kind, size_t i, struct br_error *err);

    /* Samples a measure at that time level, on the mesh of that index. view: out, and the values
     * where its pointer points; the tip has one, in m. */
    void (*sample)(void *self, const struct br_sample_at *at, struct br_view *view);

    struct br_reference_report (*report)(const void *self);

    /* Prints notes on the solution, one per line (events at the tip, with the errors of their
     * times), or nothing. */
    void (*print_notes)(const void *self, FILE *out);
};

extern const struct br_reference br_reference_fine, br_reference_exact, br_reference_mms;

/* Stands for no reference: its functions are NULL (study/grid/sweep.h). */
extern const struct br_reference br_reference_none;

/* NULL-terminated. */
extern const struct br_reference *const br_references[];
const struct br_reference *br_reference_find(const char *name);

/* The best reference of a scene: `mms` where a solution is given, else `exact`. */
const struct br_reference *br_reference_best(const struct br_scene *scene);

#endif
