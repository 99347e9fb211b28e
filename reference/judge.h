/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What cells are judged by: a registry. A judge knows the solution at the time
 * levels t_i = i T / levels and gives it, element by element, in the orthonormal
 * Legendre modes of solver/modes.h on the meshes it was asked for. */
#ifndef BR_JUDGE_H
#define BR_JUDGE_H

#include <stdio.h>

#include "solver/march.h"

struct br_judge_request {
    const struct br_scene *scene; /* must outlive the judge */
    struct br_method method;      /* fine only */
    size_t n;                     /* fine only: its elements */
    size_t levels;                /* time levels after t = 0; for fine, its steps */
    bool modest;                  /* exact only: give up where it takes more than moderate work */
    size_t mesh_count;            /* the meshes that it will be looked at on */
    const size_t *mesh;           /* mesh_count, elements; borrowed during create */
};

/* What a judge knows of itself. */
struct br_judge_report {
    double own_error[2]; /* by br_field_kind, L2, m^(3/2); NaN: it cannot tell */
    double round_off;    /* predicted, relative to the solution */
    double seconds;      /* of its work so far, one thread */
    bool unstable;       /* br_march_contact_unstable, of a fine run */
};

struct br_judge {
    const char *name;   /* as on the command line */
    const char *syntax; /* with its arguments */
    const char *title;  /* one line for a person */
    const char *citation;
    bool nests; /* cells must nest in its own mesh and time levels */

    /* Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_SINGULAR or BR_NOT_FINITE (it cannot
     * promise a solution of this scene); free *self even then. */
    enum br_status (*create)(void **self, const struct br_judge_request *request,
                             struct br_error *err);
    void (*free)(void *self); /* accepts NULL */

    /* Goes on to time level i, never back. */
    enum br_status (*advance)(void *self, size_t i, struct br_error *err);

    /* The displacement there, on the mesh of that index: its modes (out, n *
     * br_mode_count values), and the square of the L2 norm of what they leave out. */
    void (*look)(void *self, enum br_field_kind kind, size_t mesh, double *modes, double *rest);

    struct br_judge_report (*report)(const void *self);

    /* What a reader should know of the solution, one line after the other (events at
     * the tip, with the errors of their times), or nothing. */
    void (*tell)(const void *self, FILE *out);
};

extern const struct br_judge br_judge_fine, br_judge_exact;
extern const struct br_judge br_judge_mms; /* only where built with libmatheval */

/* NULL-terminated. */
extern const struct br_judge *const br_judges[];
const struct br_judge *br_judge_find(const char *name);

#endif
