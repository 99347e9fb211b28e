/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map's cases counted: by method, law and range, by reason, and over planes. */
#ifndef BR_STUDY_EXTREMES_COUNT_H
#define BR_STUDY_EXTREMES_COUNT_H

#include "study/extremes/map.h"

/* What cases are sorted by: a registry. */
struct br_extreme_axis {
    const char *title;
    /* Which of its bins a case falls into, 0, 1, ..., or -1: none. */
    int (*bin)(const struct br_extreme_case *one);
    /* The name of a bin (out); false: there are no more. */
    bool (*label)(int bin, char *text, size_t size);
};
extern const struct br_extreme_axis *const br_extreme_axes[]; /* NULL-terminated */

/* The cases of one bin. */
struct br_extreme_tally {
    const struct br_extreme_axis *axis; /* NULL: all cases */
    char label[64];
    size_t cases, count[BR_EXTREME_CLASSES];
};

/* Verdicts of one class with one reason, numbers apart. */
struct br_extreme_reason {
    enum br_extreme_class which;
    char text[150];      /* with # for numbers */
    size_t cases, first; /* an index */
};

struct br_extreme_counts {
    struct br_extreme_tally *tally; /* tallies, all cases first; owned */
    size_t tallies;
    struct br_extreme_reason *reason; /* reasons, by class and then by count; owned */
    size_t reasons;
};

/* Counts (out; clear them even after a failure). Fails with BR_NO_MEMORY. */
enum br_status br_extreme_count(const struct br_extreme_map *map, struct br_extreme_counts *counts,
                                struct br_error *err);
void br_extreme_counts_clear(struct br_extreme_counts *counts);

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

/* Planes: a registry of pairs. */
struct br_extreme_plane {
    const char *title;
    const struct br_extreme_coordinate *x, *y;
};
enum { BR_EXTREME_PLANES = 4 };
extern const struct br_extreme_plane br_extreme_planes[BR_EXTREME_PLANES];

/* The class that most cases of each cell have (out, y->cells rows of x->cells; NaN: no case); a
 * cell with one that is silently wrong has that. What lies outside counts at the edge. */
void br_extreme_plane_fill(const struct br_extreme_map *map, const struct br_extreme_plane *plane,
                           double *cell);

#endif
