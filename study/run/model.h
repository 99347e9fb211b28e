/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run models of its scene and what it skips, and why. */
#ifndef BR_STUDY_RUN_MODEL_H
#define BR_STUDY_RUN_MODEL_H

#include "solver/march.h"

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

/* What decides on the rows. Borrowed. */
struct br_model_question {
    const struct br_scene *scene, *marched;
    const struct br_method *method;
    size_t n, steps;
    size_t looks;    /* output times of the fields */
    bool every_step; /* the fields are rebuilt every step, for energies or a certificate */
};

/* Fills the rows (out); returns their number. */
size_t br_model_rows(const struct br_model_question *question,
                     struct br_model_row row[BR_MOST_MODEL_ROWS]);

#endif
