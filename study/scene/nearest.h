/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What somebody may have meant who mistyped a name. */
#ifndef BR_STUDY_SCENE_NEAREST_H
#define BR_STUDY_SCENE_NEAREST_H

#include <stddef.h>

/* The nearest of count names, by the number of letters that differ; NULL: none is near. */
const char *br_nearest(const char *word, const char *const *names, size_t count);

#endif
