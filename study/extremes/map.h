/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: many cases, drawn from a seed, judged side by side, and counted by method
 * and law, by reason, and over planes. What comes out does not depend on the number of
 * threads, nor on how often it was interrupted. */
#ifndef BR_STUDY_EXTREMES_MAP_H
#define BR_STUDY_EXTREMES_MAP_H

#include "study/extremes/judge.h"
#include "study/grid/observer.h"
#include "study/kept/kept.h"

enum { BR_EXTREME_MOST_SHRUNK = 20 };

/* What is asked for. All borrowed. */
struct br_extreme_request {
    uint64_t seed;
    size_t cases;
    int threads; /* 0: all cores */
    struct br_extreme_judging judging;
    struct br_kept *kept;               /* verdicts that need not be found again; NULL: none */
    const char *folder;                 /* where reproducer scenes are written; NULL: nowhere */
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

/* The cases of a kind. */
struct br_extreme_tally {
    const char *title; /* what they are counted by: "time scheme" */
    const char *label; /* "euler"; NULL: all cases */
    size_t cases, count[BR_EXTREME_CLASSES];
};

/* Verdicts of one class with one reason, numbers apart. */
struct br_extreme_reason {
    enum br_extreme_class which;
    char text[150];      /* with # for numbers */
    size_t cases, first; /* an index */
};

struct br_extreme_map {
    uint64_t seed;
    size_t cases;
    struct br_extreme_case *one;        /* cases; owned */
    struct br_extreme_verdict *verdict; /* cases; owned */
    size_t count[BR_EXTREME_CLASSES];
    struct br_extreme_shrunk *shrunk; /* owned */
    size_t shrunks;                   /* of the first ones that are wrong */
    struct br_extreme_tally *tally;   /* tallies, all cases first; owned */
    size_t tallies;
    struct br_extreme_reason *reason; /* reasons, by class and then by count; owned */
    size_t reasons;
};

/* Fills the map (out; clear it even after a failure). Fails with BR_NO_MEMORY, BR_IO, and with
 * BR_INTERRUPTED. */
enum br_status br_extreme_map_run(const struct br_extreme_request *request,
                                  struct br_extreme_map *map, struct br_error *err);
void br_extreme_map_clear(struct br_extreme_map *map);

/* Answers: cases that were marched and judged; and what they state. */
struct br_extreme_rate {
    size_t answers, wrong;
    double low, high; /* of the share that is silently wrong: 95 %, Clopper and Pearson 1934 */
    size_t unstated;  /* whose error is said to be not known */
    size_t unstated_unstable; /* of these, beyond the lagged contact's limit */
};
struct br_extreme_rate br_extreme_rate(const struct br_extreme_map *map);

/* A number of a case: a coordinate of a plane. */
struct br_extreme_coordinate {
    const char *title;                               /* enhanced */
    double (*value)(const struct br_extreme_case *); /* NaN or 0: not in the plane */
    double low, high;                                /* decades of the plane's edges */
    size_t cells;
};

struct br_extreme_plane {
    const char *title;
    struct br_extreme_coordinate x, y;
};
enum { BR_EXTREME_PLANES = 4 };
extern const struct br_extreme_plane br_extreme_planes[BR_EXTREME_PLANES];

/* The class that most cases of each cell have (out, y.cells rows of x.cells; NaN: no case); a
 * cell with one that is silently wrong has that. What lies outside counts at the edge. */
void br_extreme_plane_fill(const struct br_extreme_map *map, const struct br_extreme_plane *plane,
                           double *cell);

#endif
