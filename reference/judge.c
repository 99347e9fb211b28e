/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/judge.h"

#include <string.h>

const struct br_judge *const br_judges[] = {
    &br_judge_fine,
    &br_judge_exact,
#ifdef BR_HAVE_MATHEVAL
    &br_judge_mms,
#endif
    NULL,
};

const struct br_judge *br_judge_find(const char *name)
{
    for (const struct br_judge *const *j = br_judges; *j; j++)
        if (strcmp((*j)->name, name) == 0)
            return *j;
    return NULL;
}
