/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/judge.h"

#include <string.h>

#include "solver/scene.h"

const struct br_judge br_judge_none = {
    .name = "none",
};

const struct br_judge *const br_judges[] = {
    &br_judge_exact, &br_judge_fine, &br_judge_mms, NULL,
};

const struct br_judge *br_judge_find(const char *name)
{
    for (const struct br_judge *const *j = br_judges; *j; j++)
        if (strcmp((*j)->name, name) == 0)
            return *j;
    return NULL;
}

const struct br_judge *br_judge_best(const struct br_scene *scene)
{
    return scene->axial.solution || scene->bending.solution ? &br_judge_mms : &br_judge_exact;
}
