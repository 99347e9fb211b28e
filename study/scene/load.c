/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How scenes and data are found. */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/load.h"
#include "base/words.h"
#include "study/scene/file.h"

/* The path in share/beamrate above the file of this code, which is the program or the shared
 * library: what is installed may be moved as a whole. */
static bool find_above(const char *relative, char *path, size_t size)
{
    static const char here;
    char file[PATH_MAX];
    Dl_info own;
    if (!dladdr(&here, &own) ||
        !realpath(own.dli_fname[0] == '/' ? own.dli_fname : "/proc/self/exe", file))
        return false;
    for (char *end; (end = strrchr(file, '/'));) {
        *end = '\0';
        snprintf(path, size, "%s/share/beamrate/%s", file, relative);
        if (access(path, R_OK) == 0)
            return true;
    }
    return false;
}

void br_data_path(const char *relative, char *path, size_t size)
{
    const char *folder = getenv("BEAMRATE_DATA");
    if (!folder || !*folder)
        folder = access(BR_SOURCE_DIR "/study/scenes", R_OK) == 0 ? BR_SOURCE_DIR : NULL;
    if (folder || !find_above(relative, path, size))
        snprintf(path, size, "%s/%s", folder ? folder : BR_DATA_DIR, relative);
}

static bool is_file_name(const char *name)
{
    const char *dot = strrchr(name, '.');
    return strchr(name, '/') || (dot && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0));
}

/* Suggests the file, or the bundled scene, with the most similar name, if there is one. */
static enum br_status refuse(const char *name, const char *path, struct br_error *err)
{
    char **names, suggestion[BR_SUGGESTION] = "", file[PATH_MAX];
    size_t count;
    const enum br_status listed = br_scene_list(&names, &count, NULL);
    const bool of_file = is_file_name(name);
    snprintf(file, sizeof file, "%s.yaml", name);
    if (access(file, F_OK) == 0)
        br_append(suggestion, sizeof suggestion, "; did you mean '%.80s'?", file);
    else if (!listed && !*br_suggest_file(name, suggestion))
        br_suggestion(name, (const char *const *)names, count, suggestion);
    const enum br_status status = br_fail(
        err, BR_BAD_INPUT, "'%s' is neither a file nor a bundled scene%s%s%s%s", name,
        of_file ? "" : " (looked for ", of_file ? "" : path, of_file ? "" : ")", suggestion);
    br_scene_list_free(names, count);
    return status;
}

enum br_status br_scene_find(const char *name, char *path, size_t size, struct br_error *err)
{
    if (strcmp(name, "-") == 0)
        name = BR_STANDARD_INPUT;
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
