/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tables/json_value.h"

static enum br_status refuse(const char *option, const char *path, const char *reason,
                             struct br_error *err)
{
    if (errno == ENOMEM)
        return br_no_memory(err, path);
    return br_fail(err, BR_BAD_INPUT, "--%s: cannot write '%s': %s", option, path, reason);
}

/* Where a path leads, or will when it is there: its folder is. Symbolic links are followed; to be
 * freed; NULL with errno. */
static char *place_of(const char *path)
{
    struct stat link;
    char *place = realpath(path, NULL);
    if (place || errno != ENOENT || lstat(path, &link) == 0) /* a link to nowhere */
        return place;
    char *folder_part = strdup(path), *name_part = strdup(path);
    char *folder = folder_part ? realpath(dirname(folder_part), NULL) : NULL;
    if (folder && name_part && asprintf(&place, "%s/%s", folder, basename(name_part)) < 0)
        place = NULL;
    free(folder);
    free(folder_part);
    free(name_part);
    return place;
}

/* The folder of an absolute path; to be freed; NULL without memory. */
static char *folder_of(const char *place)
{
    const size_t length = (size_t)(strrchr(place, '/') - place);
    return strndup(place, length ? length : 1);
}

/* The folder must take a new file, and an old one must not be protected. */
static enum br_status open_in_memory(struct br_whole_file *w, const char *option, bool there,
                                     struct br_error *err)
{
    char *folder = folder_of(w->place);
    if (!folder)
        return br_no_memory(err, w->path);
    const bool writable = (!there || access(w->place, W_OK) == 0) && access(folder, W_OK) == 0;
    const int reason = errno;
    free(folder);
    if (!writable)
        return refuse(option, w->path, strerror(reason), err);
    w->renamed = true;
    w->file = open_memstream(&w->text, &w->size);
    return w->file ? BR_OK : br_no_memory(err, w->path);
}

enum br_status br_whole_file_open(struct br_whole_file *w, const char *option, const char *path,
                                  struct br_error *err)
{
    *w = (struct br_whole_file){.path = path};
    errno = 0;
    if (!path)
        return BR_OK;
    if (!*path)
        return refuse(option, path, "expected a file's name", err);
    struct stat old, out;
    const bool there = stat(path, &old) == 0;
    if (strcmp(path, "-") == 0 ||
        (there && fstat(STDOUT_FILENO, &out) == 0 && !S_ISCHR(out.st_mode) &&
         old.st_dev == out.st_dev && old.st_ino == out.st_ino)) {
        w->file = stdout;
        return BR_OK;
    }
    w->place = place_of(path);
    if (!w->place)
        return refuse(option, path, strerror(errno), err);
    if (!there || S_ISREG(old.st_mode))
        return open_in_memory(w, option, there, err);
    w->file = fopen(path, "w"); /* a pipe, a terminal: nothing to rename; a folder fails */
    return w->file ? BR_OK : refuse(option, path, strerror(errno), err);
}

bool br_whole_file_same(const struct br_whole_file *a, const struct br_whole_file *b)
{
    if (!a->file || !b->file)
        return false;
    if (!a->place || !b->place)
        return a->file == b->file;
    struct stat info;
    const bool device = stat(a->place, &info) == 0 && S_ISCHR(info.st_mode); /* /dev/null */
    return !device && strcmp(a->place, b->place) == 0;
}

bool br_whole_file_replaces(const struct br_whole_file *w, const char *path)
{
    char *place = w->renamed ? realpath(path, NULL) : NULL;
    const bool same = place && strcmp(place, w->place) == 0;
    free(place);
    return same;
}

bool br_whole_file_is_in(const struct br_whole_file *w, const char *folder)
{
    char *place = w->renamed ? place_of(folder) : NULL;
    const size_t length = place ? strlen(place) : 0;
    const bool inside = place && strncmp(w->place, place, length) == 0 &&
                        (w->place[length] == '\0' ||
                         (w->place[length] == '/' && !strchr(w->place + length + 1, '/')));
    free(place);
    return inside;
}

mode_t br_new_permissions(mode_t wanted)
{
    const mode_t mask = umask(0); /* POSIX has no call that only reads it */
    umask(mask);
    return wanted & ~mask;
}

/* Into a hidden file of the folder, which is then renamed. It has the permissions of the old file,
 * or those that a new one would have had. */
static enum br_status write_out(const struct br_whole_file *w, int folder, const char *hidden,
                                int file, struct br_error *err)
{
    struct stat old;
    flock(file, LOCK_EX | LOCK_NB); /* or the next program would sweep it away */
    (void)!fchmod(file, stat(w->place, &old) == 0 ? old.st_mode & 07777 : br_new_permissions(0666));
    if (br_write_whole(file, w->text, w->size) &&
        renameat(folder, hidden, folder, strrchr(w->place, '/') + 1) == 0)
        return BR_OK;
    br_fail(err, BR_IO, "%s could not be written whole: %s", w->path, strerror(errno));
    unlinkat(folder, hidden, 0);
    return BR_IO;
}

static enum br_status write_beside(const struct br_whole_file *w, struct br_error *err)
{
    char *name = folder_of(w->place), *hidden = NULL;
    const int folder = name ? open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    const bool named = name && asprintf(&hidden, "%s/%s-XXXXXX", name, BR_HIDDEN) >= 0;
    free(name);
    if (!named)
        return br_no_memory(err, w->path);
    const bool swept = folder < 0 || !br_output_sweep(folder, err);
    const int file = folder >= 0 && swept ? mkostemp(hidden, O_CLOEXEC) : -1;
    const enum br_status status = file >= 0
                                      ? write_out(w, folder, strrchr(hidden, '/') + 1, file, err)
                                  : swept ? br_fail(err, BR_IO, "%s: %s", w->path, strerror(errno))
                                          : err->status;
    br_close(file);
    br_close(folder);
    free(hidden);
    return status;
}

enum br_status br_whole_file_commit(struct br_whole_file *w, struct br_error *err)
{
    if (!w->file || w->file == stdout)
        return BR_OK; /* main checks standard output at the end */
    FILE *file = w->file;
    w->file = NULL;
    const bool failed = fflush(file) != 0 || ferror(file);
    if (fclose(file) != 0 || failed || br_json_lacked_memory() || (w->renamed && !w->text))
        return w->renamed ? br_no_memory(err, w->path)
                          : br_fail(err, BR_IO, "%s could not be written whole", w->path);
    return w->renamed ? write_beside(w, err) : BR_OK;
}

void br_whole_file_discard(struct br_whole_file *w)
{
    if (w->file && w->file != stdout)
        fclose(w->file);
    free(w->text);
    free(w->place);
    *w = (struct br_whole_file){.path = NULL};
}
