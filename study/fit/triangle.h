/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the triangle inequality says about a printed table, whatever reference its
 * authors used. Let D(a, b) be the largest distance of the scheme's solutions in
 * two cells over the time levels of a, all of which are levels of b, in the norm of
 * (31). For errors against one common reference
 *     E(a) - E(b) <= D(a, b) <= E(a) + E(b),
 * and with equal time levels also E(b) - E(a) <= D(a, b). Printed errors that
 * break this were not produced by this scheme with a common reference. */
#ifndef BR_STUDY_FIT_TRIANGLE_H
#define BR_STUDY_FIT_TRIANGLE_H

#include "study/grid/study.h"

struct br_triangle {
    struct br_resolution a, b;
    double printed_a, printed_b; /* m^(3/2) */
    double distance;             /* D(a, b), computed, m^(3/2) */
    double least, most;          /* what the printed values allow for D, digits rounded in favour */
    bool contradiction;          /* !(least <= D <= most) */
};

/* Marches pairs of cells that contradict `printed` (n_count * k_count values by rows, NaN where
 * nothing is printed): up to `most` into `triangles` (out); *count: how many. The study's own
 * errors choose them; of those that plainly contradict it, the cheapest come first. */
enum br_status br_triangles(const struct br_study *study, const double *printed, size_t most,
                            struct br_triangle *triangles, size_t *count, int threads,
                            struct br_error *err);

#endif
