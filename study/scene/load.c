/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How files of others are found, opened and read: tables, scenes, study files, baselines. */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/base/quote.h"
#include "study/base/words.h"
#include "study/scene/file.h"

static enum br_status fail_with_errno(const char *path, struct br_error *err)
{
    return br_fail(err, br_status_of_errno(errno), "%s: %s", path, strerror(errno));
}

/* Waits for bytes or for the end, however long a writer takes, but not for ever for a writer. */
static enum br_status wait_for(const char *path, int file, bool writer, struct br_error *err)
{
    enum { PATIENCE = 5 /* s */ };
    struct pollfd wanted = {.fd = file, .events = POLLIN};
    const int ready = poll(&wanted, 1, writer ? -1 : 1000 * PATIENCE);
    if (ready < 0)
        return fail_with_errno(path, err);
    return ready ? BR_OK
                 : br_fail(err, BR_BAD_INPUT,
                           "%s: is a pipe into which nothing writes (waited %d s)", path, PATIENCE);
}

/* Reads the stream once, to its end: a pipe cannot be read again. A named pipe has an end where it
 * has no writer: before its first one, too. */
static enum br_status read_all(const char *path, int file, size_t longest, const char *what,
                               char *text, struct br_error *err)
{
    struct stat info;
    size_t length = 0;
    bool writer = fstat(file, &info) != 0 || !S_ISFIFO(info.st_mode) || file == STDIN_FILENO;
    for (ssize_t got = 1; length <= longest;) {
        got = read(file, text + length, longest + 1 - length);
        length += got > 0 ? (size_t)got : 0;
        if (got < 0 && errno != EAGAIN)
            return fail_with_errno(path, err);
        if (got == 0 && writer)
            break;
        writer |= got != 0;
        if (got <= 0 && wait_for(path, file, writer, err))
            return err->status;
        writer = true;
    }
    if (length > longest)
        return br_fail(err, BR_BAD_INPUT, "%s: found more than %zu bytes, expected a %s", path,
                       longest, what);
    const char *bad = br_not_utf8(text), *zero = memchr(text, 0, length);
    size_t line = 1;
    bad = bad ? bad : zero;
    for (const char *c = text; bad && c < bad; c++)
        line += *c == '\n';
    return bad ? br_fail(err, BR_BAD_INPUT,
                         "%s:%zu: found the byte 0x%02x (byte %td of the file), expected text in "
                         "UTF-8",
                         path, line, (unsigned char)*bad, bad - text + 1)
               : BR_OK;
}

enum br_status br_text_load(const char *path, size_t longest, const char *what, char **text,
                            struct br_error *err)
{
    const bool standard = strcmp(path, BR_STANDARD_INPUT) == 0;
    *text = NULL;
    const int file = standard ? STDIN_FILENO : open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return fail_with_errno(path, err);
    *text = br_allocate(longest + 2, 1); /* memory that is not written is not used */
    enum br_status status =
        *text ? read_all(path, file, longest, what, *text, err) : br_no_memory(err, "a file");
    if (!standard)
        close(file);
    if (status) {
        free(*text);
        *text = NULL;
    }
    return status;
}

/* ---- where scenes and data are ---- */

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

/* Suggests the bundled scene with the most similar name, if there is one. */
static enum br_status refuse(const char *name, const char *path, struct br_error *err)
{
    char **names, suggestion[BR_SUGGESTION] = "";
    size_t count;
    if (!br_scene_list(&names, &count, NULL))
        br_suggestion(name, (const char *const *)names, count, suggestion);
    const enum br_status status =
        br_fail(err, BR_BAD_INPUT, "scene '%s' is no file and no bundled scene (looked for %s)%s",
                name, path, suggestion);
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
