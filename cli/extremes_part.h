/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of `beamrate extremes`: a registry. A part computes by a module of study/, says what it
 * has found by one of tables/, and draws it by plots/. */
#ifndef BR_CLI_EXTREMES_PART_H
#define BR_CLI_EXTREMES_PART_H

#include <stdint.h>

#include "plots/figure.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "tables/document.h"

/* What is asked for. All borrowed; 0 or NULL: the part's own choice. */
struct br_extremes_job {
    size_t cases;  /* of the map */
    uint64_t seed; /* of what is drawn at random */
    int threads;   /* 0: all cores */
    const size_t *n;
    const double *k; /* s */
    size_t n_count, k_count;
    int rounding;       /* as fesetround takes it: of the marches, not of their judges */
    const char *kept;   /* path of a file in which a part that takes long keeps what is done, so
                           that it can be resumed: what it finds there it need not do again, and
                           the file is removed when all is written. NULL: nothing is kept */
    const char *folder; /* for other files of the part (reproducer scenes): the staging folder */
    const struct br_observer *observer; /* NULL: nobody */
};

/* The options that a part heeds: others are refused. --threads is for all. */
enum {
    BR_HEEDS_CASES = 1,
    BR_HEEDS_SEED = 2,
    BR_HEEDS_N = 4,
    BR_HEEDS_K = 8,
    BR_HEEDS_ROUNDING = 16,
    BR_HEEDS_RESUME = 32, /* and job->kept, which others find NULL */
};

struct br_extremes_part {
    const char *name;  /* one word, as on the command line, and of its files */
    const char *title; /* one line for a person */
    unsigned heeds;    /* of the options: BR_HEEDS_... */
    size_t size;       /* of its result, bytes */
    /* Computes the result (out: zeros before). What is found wrong is a result, no failure. Fails
     * with BR_BAD_INPUT, BR_NO_MEMORY, BR_INTERRUPTED, BR_IO. */
    enum br_status (*run)(const struct br_extremes_job *job, void *result, struct br_error *err);
    void (*clear)(void *result); /* also after a failure; NULL: the result owns nothing */
    /* Begins the report and puts all into it but pictures and provenance; its name is the part's.
     */
    void (*report)(const void *result, struct br_document *d);
    /* Picture i, 0, 1, ... (out: zeroed; clear it even after a failure); left without panels: there
     * are no more. Its stem is the part's name, or begins with it and a dash. Fails with
     * BR_NO_MEMORY. */
    enum br_status (*draw)(const void *result, size_t i, struct br_figure *figure,
                           struct br_error *err);
    /* BR_OK, or BR_VERDICT with what has been found wrong. */
    enum br_status (*verdict)(const void *result, struct br_error *err);
};

/* NULL-terminated, in the order in which they run (cli/extremes_parts.c). */
extern const struct br_extremes_part *const br_extremes_parts[];

#endif
