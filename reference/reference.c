/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/reference.h"

#include <string.h>

#include "solver/scene.h"

const struct br_reference br_reference_none = {
    .name = "none",
};

const struct br_reference *const br_references[] = {
    &br_reference_exact,
    &br_reference_fine,
    &br_reference_mms,
    NULL,
};

const struct br_reference *br_reference_find(const char *name)
{
    for (const struct br_reference *const *j = br_references; *j; j++)
        if (strcmp((*j)->name, name) == 0)
            return *j;
    return NULL;
}

const struct br_reference *br_reference_best(const struct br_scene *scene)
{
    return scene->axial.solution || scene->bending.solution ? &br_reference_mms
                                                            : &br_reference_exact;
}
