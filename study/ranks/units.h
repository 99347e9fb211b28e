/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work of a call of br_study_run, cut into units for ranks: whole studies, or slices of their
 * cells. Every rank makes the same list. */
#ifndef BR_STUDY_RANKS_UNITS_H
#define BR_STUDY_RANKS_UNITS_H

#include "study/grid/study.h"

/* Some cells of a study, with its reference. */
struct br_unit {
    size_t study;         /* an index into the call's studies */
    size_t slice, slices; /* which, of how many; 0 of 1: the whole study */
    double cost;          /* about, ns of one thread */
};

/* The list, in groups of units that one rank marches at once; the first ones begin first. */
struct br_units {
    struct br_unit *unit; /* count, by groups; owned */
    size_t count;
    size_t *first; /* groups + 1: where each group begins; owned */
    size_t groups;
};

/* What a study costs, about, in ns of one thread: its reference, and one cell. */
double br_reference_cost(const struct br_study *study);
double br_cell_cost(const struct br_study *study, size_t cell);

/* Which slice each cell belongs to (out, br_study_cells), so that all cost about the same. Returns
 * the largest cost of a slice's cells, ns. Fails by -1: out of memory. */
double br_slice_cells(const struct br_study *study, size_t slices, size_t *owner);

/* Cuts prepared studies (those that have failed are left out) for so many ranks, of so many threads
 * each. Fails with BR_NO_MEMORY; clear the list even then. */
enum br_status br_units_create(struct br_units *units, const struct br_study *studies, size_t count,
                               int ranks, int threads, struct br_error *err);
void br_units_clear(struct br_units *units);

#endif
