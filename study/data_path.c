/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/nearest.h"
#include "study/scene_file.h"

void br_data_path(const char *relative, char *path, size_t size)
{
    const char *folder = getenv("BEAMRATE_DATA");
    if (!folder || !*folder)
        folder = access(BR_SOURCE_DIR "/study/scenes", R_OK) == 0 ? BR_SOURCE_DIR : BR_DATA_DIR;
    snprintf(path, size, "%s/%s", folder, relative);
}

/* Names the bundled scene whose name is near, if there is one. */
static enum br_status refuse(const char *name, const char *path, struct br_error *err)
{
    char **names;
    size_t count;
    const char *nearest = NULL;
    if (!br_scene_list(&names, &count, NULL))
        nearest = br_nearest(name, (const char *const *)names, count);
    const enum br_status status = br_fail(
        err, BR_BAD_INPUT, "scene '%s' is no file and no bundled scene (looked for %s)%s%s%s", name,
        path, nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
    br_scene_list_free(names, count);
    return status;
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
    return refuse(name, path, err);
}

static int is_scene(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && dot > entry->d_name && strcmp(dot, ".yaml") == 0;
}

enum br_status br_scene_list(char ***names, size_t *count, struct br_error *err)
{
    char folder[1024];
    struct dirent **entry;
    *names = NULL;
    *count = 0;
    br_data_path("study/scenes", folder, sizeof folder);
    const int found = scandir(folder, &entry, is_scene, alphasort);
    if (found < 0)
        return br_fail(err, BR_BAD_INPUT, "the bundled scenes: %s: %s", folder, strerror(errno));
    *names = br_allocate((size_t)found + 1, sizeof **names);
    for (int i = 0; i < found; i++) {
        const size_t length = strlen(entry[i]->d_name) - strlen(".yaml");
        if (*names && ((*names)[*count] = br_allocate(length + 1, 1)))
            memcpy((*names)[(*count)++], entry[i]->d_name, length);
        free(entry[i]);
    }
    free(entry);
    return *count == (size_t)found ? BR_OK : br_no_memory(err, "the list of scenes");
}

void br_scene_list_free(char **names, size_t count)
{
    for (size_t i = 0; names && i < count; i++)
        free(names[i]);
    free(names);
}
