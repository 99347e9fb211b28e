/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/scene/file.h"
#include "study/scene/nearest.h"

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

static const char standard_input[] = "/dev/stdin";

enum br_status br_scene_find(const char *name, char *path, size_t size, struct br_error *err)
{
    if (strcmp(name, "-") == 0)
        name = standard_input;
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

/* The stream is read once, to its end: a pipe has no second time. */
static enum br_status read_all(const char *path, FILE *file, char *text, struct br_error *err)
{
    errno = 0;
    const size_t length = fread(text, 1, BR_LONGEST_SCENE + 1, file);
    if (ferror(file))
        return br_fail(err,
                       errno == EINTR    ? BR_INTERRUPTED
                       : errno == EISDIR ? BR_BAD_INPUT
                                         : BR_IO,
                       "%s: %s", path, strerror(errno));
    if (length > BR_LONGEST_SCENE)
        return br_fail(err, BR_BAD_INPUT, "%s: found more than %d bytes, expected a scene", path,
                       BR_LONGEST_SCENE);
    const char *zero = memchr(text, 0, length);
    size_t line = 1;
    for (const char *c = text; zero && c < zero; c++)
        line += *c == '\n';
    return zero ? br_fail(err, BR_BAD_INPUT, "%s:%zu: found a zero byte, expected text", path, line)
                : BR_OK;
}

enum br_status br_scene_load(const char *path, char **text, struct br_error *err)
{
    *text = NULL;
    FILE *file = strcmp(path, standard_input) == 0 ? stdin : fopen(path, "rb");
    if (!file)
        return br_fail(err,
                       errno == EINTR    ? BR_INTERRUPTED
                       : errno == ENOMEM ? BR_NO_MEMORY
                                         : BR_BAD_INPUT,
                       "%s: %s", path, strerror(errno));
    *text = br_allocate(BR_LONGEST_SCENE + 2, 1);
    enum br_status status =
        *text ? read_all(path, file, *text, err) : br_no_memory(err, "the scene");
    if (file != stdin)
        fclose(file);
    if (status) {
        free(*text);
        *text = NULL;
    }
    return status;
}

enum br_status br_scene_open(const char *name, char *path, size_t size, char **text,
                             struct br_scene *scene, struct br_error *err)
{
    *text = NULL;
    *scene = (struct br_scene){0};
    enum br_status status = br_scene_find(name, path, size, err);
    if (!status)
        status = br_scene_load(path, text, err);
    return status ? status : br_scene_read_text(path, *text, scene, err);
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
    if (found < 0 && errno == ENOMEM)
        return br_no_memory(err, "the list of scenes");
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
