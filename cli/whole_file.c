/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/whole_file.h"

#include <errno.h>
#include <libgen.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/output.h"

static enum br_status refuse(const char *option, const char *path, const char *reason,
                             struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "--%s: cannot write '%s': %s", option, path, reason);
}

/* The permissions that a new file would have had. */
static void set_permissions(int descriptor, const struct stat *old)
{
    const mode_t mask = umask(0);
    umask(mask);
    (void)!fchmod(descriptor, old ? old->st_mode & 07777 : 0666 & ~mask);
}

/* The path of a file that is not there yet in its folder, which is; NULL with errno. */
static char *place_of_new(const char *path)
{
    struct stat link;
    if (lstat(path, &link) == 0) { /* a symbolic link, or it would be there */
        errno = ENOENT;
        return NULL;
    }
    char *folder_part = strdup(path), *name_part = strdup(path), *place = NULL;
    char *folder = folder_part ? realpath(dirname(folder_part), NULL) : NULL;
    if (folder && name_part && asprintf(&place, "%s/%s", folder, basename(name_part)) < 0)
        place = NULL;
    free(folder);
    free(folder_part);
    free(name_part);
    return place;
}

static enum br_status open_staging(struct br_whole_file *w, const char *option,
                                   const struct stat *old, struct br_error *err)
{
    if (old && access(w->place, W_OK) < 0)
        return refuse(option, w->path, strerror(errno), err);
    const int length = snprintf(w->staging, sizeof w->staging, "%s.XXXXXX", w->place);
    const int descriptor = length < (int)sizeof w->staging ? mkstemp(w->staging) : -1;
    if (descriptor < 0) {
        w->staging[0] = '\0';
        return refuse(option, w->path, strerror(errno), err);
    }
    set_permissions(descriptor, old);
    w->file = fdopen(descriptor, "w");
    return w->file ? BR_OK : refuse(option, w->path, strerror(errno), err);
}

static bool is_standard_output(const char *path, const struct stat *there)
{
    struct stat out;
    return strcmp(path, "-") == 0 ||
           (there && fstat(STDOUT_FILENO, &out) == 0 && !S_ISCHR(out.st_mode) &&
            there->st_dev == out.st_dev && there->st_ino == out.st_ino);
}

enum br_status br_whole_file_open(struct br_whole_file *w, const char *option, const char *path,
                                  struct br_error *err)
{
    *w = (struct br_whole_file){.path = path};
    if (!path)
        return BR_OK;
    if (!*path)
        return refuse(option, path, "expected a file's name", err);
    struct stat old;
    const bool there = stat(path, &old) == 0;
    if (is_standard_output(path, there ? &old : NULL)) {
        w->file = stdout;
        return BR_OK;
    }
    w->place = there ? realpath(path, NULL) : place_of_new(path);
    if (!w->place)
        return refuse(option, path, strerror(errno), err);
    if (!there || S_ISREG(old.st_mode))
        return open_staging(w, option, there ? &old : NULL, err);
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
    char *place = w->staging[0] ? realpath(path, NULL) : NULL;
    const bool same = place && strcmp(place, w->place) == 0;
    free(place);
    return same;
}

/* Where a folder is or will be; to be freed; NULL: nowhere. */
static char *place_of_folder(const char *folder)
{
    char *place = realpath(folder, NULL), *copy = place ? NULL : strdup(folder);
    if (place || !copy)
        return place;
    for (size_t n = strlen(copy); n > 1 && copy[n - 1] == '/'; n--)
        copy[n - 1] = '\0';
    char *slash = strrchr(copy, '/'), *name = slash ? slash + 1 : copy;
    char *parent = slash ? strndup(copy, (size_t)(slash - copy)) : strdup(".");
    char *root = parent ? realpath(*parent ? parent : "/", NULL) : NULL;
    if (root && asprintf(&place, "%s/%s", root, name) < 0)
        place = NULL;
    free(root);
    free(parent);
    free(copy);
    return place;
}

bool br_whole_file_is_in(const struct br_whole_file *w, const char *folder)
{
    char *place = w->staging[0] ? place_of_folder(folder) : NULL;
    const size_t length = place ? strlen(place) : 0;
    const bool inside = place && strncmp(w->place, place, length) == 0 &&
                        (w->place[length] == '\0' ||
                         (w->place[length] == '/' && !strchr(w->place + length + 1, '/')));
    free(place);
    return inside;
}

enum br_status br_whole_file_commit(struct br_whole_file *w, struct br_error *err)
{
    if (!w->file || w->file == stdout)
        return BR_OK; /* main checks standard output at the end */
    FILE *file = w->file;
    w->file = NULL;
    if (!w->staging[0]) {
        const bool failed = ferror(file);
        return fclose(file) != 0 || failed
                   ? br_fail(err, BR_IO, "%s could not be written whole", w->path)
                   : BR_OK;
    }
    enum br_status status = br_output_close(file, w->path, err);
    if (!status && rename(w->staging, w->place) < 0)
        status = br_fail(err, BR_IO, "%s: %s", w->path, strerror(errno));
    if (!status)
        w->staging[0] = '\0';
    return status;
}

void br_whole_file_discard(struct br_whole_file *w)
{
    if (w->file && w->file != stdout)
        fclose(w->file);
    w->file = NULL;
    if (w->staging[0])
        unlink(w->staging);
    w->staging[0] = '\0';
    free(w->place);
    w->place = NULL;
}
