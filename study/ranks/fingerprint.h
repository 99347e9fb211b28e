/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_STUDY_RANKS_FINGERPRINT_H
#define BR_STUDY_RANKS_FINGERPRINT_H

#include "study/grid/study.h"

/* What studies ask for, as one number: the same on ranks that have read the same scenes and
 * options. Expressions count by their values at some places and times, to nine digits. Not for
 * studies whose scenes another thread is using. */
unsigned long long br_studies_fingerprint(const struct br_study *studies, size_t count);

#endif
