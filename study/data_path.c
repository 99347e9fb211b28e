/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "study/scene_file.h"

void br_data_path(const char *relative, char *path, size_t size)
{
    const char *folder = getenv("BEAMRATE_DATA");
    if (!folder || !*folder)
        folder = access(BR_SOURCE_DIR "/study/scenes", R_OK) == 0 ? BR_SOURCE_DIR : BR_DATA_DIR;
    snprintf(path, size, "%s/%s", folder, relative);
}

enum br_status br_scene_find(const char *name, char *path, size_t size, struct br_error *err)
{
    if (access(name, F_OK) == 0) {
        if ((size_t)snprintf(path, size, "%s", name) >= size)
            return br_fail(err, BR_BAD_INPUT, "the path '%s' is too long", name);
        return BR_OK;
    }
    char relative[512];
    snprintf(relative, sizeof relative, "study/scenes/%s.yaml", name);
    br_data_path(relative, path, size);
    if (access(path, R_OK) == 0)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "scene '%s' is no file and no bundled scene (looked for %s)",
                   name, path);
}
