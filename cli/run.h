/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The march that the options of `run` ask for (run_plan.c), and its pictures (pictures.c). */
#ifndef BR_CLI_RUN_H
#define BR_CLI_RUN_H

#include "cli/session.h"
#include "plots/pictures.h"
#include "study/run/run.h"

struct br_run_plan {
    struct br_opened_scene opened;
    struct br_scene marched;       /* borrows from `opened` */
    struct br_run_request request; /* without outputs */
    size_t *level;                 /* the request's levels; owned */
};

/* Checks the options against the open scene. Fails with BR_BAD_INPUT, naming the option, what was
 * found and what was expected; clear the plan even then. */
enum br_status br_run_plan_make(struct br_run_plan *plan, const struct br_options *options,
                                struct br_error *err);
void br_run_plan_clear(struct br_run_plan *plan);

/* ---- pictures of a march (pictures.c): a moving picture (--animate), and the tip's history, which
 * is a picture of --out ---- */

/* Begin with the options, and zeros for the rest. */
struct br_pictures {
    const char *animate; /* a file; NULL: not wanted */
    bool history;        /* rows of the tip are kept for br_history_draw */
    bool quiet;
    const struct br_scene *scene;
    size_t n, steps; /* of the march */

    char stem[256];          /* of the movie's files */
    struct br_output output; /* its folder */
    bool missing;            /* gnuplot is not installed */
    size_t rows, frames;     /* steps between rows and frames that are kept; 0: none is */
    struct br_history_record record;
    struct br_history_observer keep; /* writes into the record */
};

/* Opens the movie's files, so call it before a long march. Fails with BR_BAD_INPUT: a file of
 * another kind, a folder that cannot be written; discard it even then. Without gnuplot scripts and
 * data are written, with a note. */
enum br_status br_pictures_open(struct br_pictures *pictures, struct br_error *err);

/* An observer that keeps rows and frames; the pictures must outlive the march. */
struct br_history_observer br_pictures_observer(struct br_pictures *pictures);

/* Draws the movie and puts it in place, whole or not at all. Fails with BR_IO. */
enum br_status br_pictures_finish(struct br_pictures *pictures, struct br_error *err);
void br_pictures_discard(struct br_pictures *pictures);

#endif
