/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: many cases, drawn from a seed, judged side by side. What comes out does not
 * depend on the number of threads, nor on how often it was interrupted. */
#ifndef BR_STUDY_EXTREMES_MAP_H
#define BR_STUDY_EXTREMES_MAP_H

#include "study/extremes/judge.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"

enum { BR_EXTREME_MOST_SHRUNK = 20 };

/* What is asked for. All borrowed. */
struct br_extreme_request {
    uint64_t seed;
    size_t cases;
    int threads; /* 0: all cores */
    struct br_extreme_judging judging;
    const char *kept;    /* file of what is done, from which a run goes on; NULL: none */
    const char *program; /* one line: cases that another program has kept are not taken */
    const char *folder;  /* where reproducer scenes are written; NULL: nowhere */
    const struct br_observer *observer; /* NULL: nobody */
    /* Who judges; NULL: br_extreme_judge. May be called from any thread. */
    enum br_status (*judge)(const struct br_extreme_case *one,
                            const struct br_extreme_judging *judging,
                            struct br_extreme_verdict *verdict, struct br_error *err);
};

/* A case that is silently wrong, made small. */
struct br_extreme_shrunk {
    struct br_extreme_case one;
    struct br_extreme_verdict verdict;
    char file[64];                    /* name of its scene in the folder */
    char command[BR_EXTREME_COMMAND]; /* that repeats it */
};

struct br_extreme_map {
    uint64_t seed;
    size_t cases;
    struct br_extreme_case *one;        /* cases; owned */
    struct br_extreme_verdict *verdict; /* cases; owned */
    size_t resumed;                     /* of them, found in the kept file */
    size_t count[BR_EXTREME_CLASSES];
    struct br_extreme_shrunk *shrunk; /* owned */
    size_t shrunks;                   /* of the first ones that are wrong */
};

/* Fills the map (out; clear it even after a failure). Fails with BR_NO_MEMORY, BR_IO, and with
 * BR_INTERRUPTED: the kept file then has what is done. */
enum br_status br_extreme_map_run(const struct br_extreme_request *request,
                                  struct br_extreme_map *map, struct br_error *err);
void br_extreme_map_clear(struct br_extreme_map *map);

/* ---- for map.c and shrink.c ---- */

bool br_extreme_stopped(const struct br_extreme_request *request);
enum br_status br_extreme_ask(const struct br_extreme_request *request,
                              const struct br_extreme_case *one, struct br_extreme_verdict *verdict,
                              struct br_error *err);

/* Makes a case that is wrong (in/out) small while it stays wrong, so that a person can read it:
 * drops fields, forces and laws, takes the default rows of the registries, plain shapes, fewer
 * elements and steps, unit length and duration, and numbers of one digit, over and over, as long
 * as something is gained. Fails as judging does, and with BR_INTERRUPTED. */
enum br_status br_extreme_shrink(const struct br_extreme_request *request,
                                 struct br_extreme_case *one, struct br_error *err);

#endif
