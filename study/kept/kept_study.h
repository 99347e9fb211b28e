/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies whose finished cells are kept. */
#ifndef BR_STUDY_KEPT_KEPT_STUDY_H
#define BR_STUDY_KEPT_KEPT_STUDY_H

#include "base/kept.h"
#include "study/grid/engine.h"

/* The engine of studies whose cells are kept: kept cells are not marched again, and the others are
 * written as soon as their slice is done. Results have the bits of the whole study in one run, if
 * the kept cells are of studies with the same lists of n and k; else they differ by the round-off
 * of the reference, whose meshes and time levels these lists determine. Fails also with BR_IO,
 * where an entry disappears meanwhile. `kept` is borrowed; NULL: the usual engine. */
struct br_engine br_kept_engine(struct br_kept *kept);

#endif
