/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/text.h"
#include "tables/json_value.h"

/* The path with symbolic links followed, to be freed. The file need not exist, but its folder. NULL
 * with errno. */
static char *place_of(const char *path)
{
    struct stat link;
    char *place = realpath(path, NULL);
    if (place || errno != ENOENT || !*path || lstat(path, &link) == 0) /* a link to nowhere */
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

/* The folder must take a new file, and an old one must not be protected. */
static bool can_be_replaced(const char *place, bool there)
{
    char *copy = strdup(place);
    const bool can =
        copy && access(dirname(copy), W_OK) == 0 && (!there || access(place, W_OK) == 0);
    free(copy);
    return can;
}

/* Opens a device or a pipe. A pipe must get a reader within some seconds. NULL with errno. */
static FILE *open_special(const char *path)
{
    enum { TRIALS = 100 };
    int file = -1;
    for (int i = 0; i < TRIALS && file < 0 && (i == 0 || errno == ENXIO); i++) {
        file = open(path, O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_TRUNC);
        if (file < 0 && errno == ENXIO && nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL))
            return NULL; /* a signal */
    }
    if (file >= 0)
        fcntl(file, F_SETFL, fcntl(file, F_GETFL) & ~O_NONBLOCK);
    return file >= 0 ? fdopen(file, "w") : NULL;
}

/* The program's own stream, or one of a descriptor that it was given, if that is the file at the
 * path: others write there, too, so the file is written to, not replaced. NULL: none is. */
static FILE *open_already(const char *path, const struct stat *old)
{
    enum { MOST = 9 }; /* a shell gives these numbers */
    struct stat open;
    /* 2>&1: both are one file, and the report keeps standard output */
    const bool complaints = strcmp(path, "/dev/stderr") == 0;
    for (int i = complaints ? STDERR_FILENO : STDOUT_FILENO; i <= MOST; i++) {
        const int mode = fcntl(i, F_GETFL);
        if (mode < 0 || (mode & O_ACCMODE) == O_RDONLY || fstat(i, &open) != 0 ||
            S_ISCHR(open.st_mode) || old->st_dev != open.st_dev || old->st_ino != open.st_ino)
            continue;
        if (i == STDOUT_FILENO || i == STDERR_FILENO)
            return i == STDOUT_FILENO ? stdout : stderr;
        const int copy = fcntl(i, F_DUPFD_CLOEXEC, 0);
        return copy >= 0 ? fdopen(copy, "w") : NULL;
    }
    return NULL;
}

static bool is_standard(const FILE *file)
{
    return file == stdout || file == stderr;
}

enum br_status br_whole_file_open(struct br_whole_file *w, const char *option, const char *path,
                                  struct br_error *err)
{
    *w = (struct br_whole_file){.path = path};
    errno = 0;
    if (!path)
        return BR_OK;
    struct stat old;
    const bool there = stat(path, &old) == 0;
    w->file = strcmp(path, "-") == 0 ? stdout : there ? open_already(path, &old) : NULL;
    if (is_standard(w->file))
        return BR_OK;
    w->place = there && S_ISCHR(old.st_mode) ? NULL : place_of(path);
    if (w->file)
        return BR_OK;
    w->renamed = w->place && (!there || S_ISREG(old.st_mode));
    if (w->renamed && can_be_replaced(w->place, there))
        w->file = br_text_open(&w->text, &w->size);
    else if (there && !w->renamed)
        w->file = open_special(path); /* a pipe or a terminal is not renamed; a folder fails */
    if (!w->file && errno == ENOMEM)
        return br_no_memory(err, path);
    return w->file ? BR_OK
                   : br_fail(err, br_status_of_errno(errno), "--%s: cannot write '%s': %s", option,
                             path,
                             !*path                          ? "expected a file's name"
                             : errno == ENXIO && !w->renamed ? "nothing reads from this pipe"
                                                             : strerror(errno));
}

bool br_whole_file_same(const struct br_whole_file *a, const struct br_whole_file *b)
{
    return a->file && b->file &&
           (a->file == b->file || (a->place && b->place && strcmp(a->place, b->place) == 0));
}

bool br_whole_file_meets(const struct br_whole_file *w, const char *path)
{
    char *place = w->renamed ? place_of(path) : NULL;
    const size_t length = place ? strlen(place) : 0;
    const bool meets = place && strncmp(w->place, place, length) == 0 &&
                       (w->place[length] == '\0' ||
                        (w->place[length] == '/' && !strchr(w->place + length + 1, '/')));
    free(place);
    return meets;
}

/* POSIX has no call that only reads the mask. */
static mode_t new_permissions(void)
{
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

bool br_put_whole(const char *path, mode_t mode, const char *bytes, size_t count)
{
    char *part = NULL;
    const int name = (int)(strrchr(path, '/') - path);
    if (asprintf(&part, "%.*s/.beamrate-XXXXXX", name, path) < 0)
        return false;
    const int made = mkostemp(part, O_CLOEXEC);
    FILE *file = made >= 0 ? fdopen(made, "w") : NULL;
    bool put =
        file && fwrite(bytes, 1, count, file) == count && fflush(file) == 0 && fsync(made) == 0;
    if (put) {
        (void)!fchmod(made, mode ? mode : new_permissions()); /* some file systems have none */
        put = renameat(AT_FDCWD, part, AT_FDCWD, path) == 0;
    }
    const int reason = errno;
    if (!put && made >= 0)
        unlink(part);
    if (file)
        fclose(file);
    else if (made >= 0)
        close(made);
    free(part);
    errno = reason;
    return put;
}

enum br_status br_whole_file_commit(struct br_whole_file *w, struct br_error *err)
{
    if (!w->file || w->file == stdout)
        return BR_OK; /* main checks standard output at the end */
    FILE *file = w->file;
    struct stat old;
    w->file = NULL;
    const bool failed = fflush(file) != 0 || ferror(file);
    if ((!is_standard(file) && fclose(file) != 0) || failed || br_json_lacked_memory())
        return w->renamed ? br_no_memory(err, w->path)
                          : br_fail(err, BR_IO, "%s could not be written whole", w->path);
    if (!w->renamed)
        return BR_OK;
    const mode_t mode = stat(w->place, &old) == 0 ? old.st_mode & 07777 : 0;
    return br_put_whole(w->place, mode, w->text, w->size)
               ? BR_OK
               : br_fail(err, BR_IO, "%s could not be written whole: %s", w->path, strerror(errno));
}

void br_whole_file_discard(struct br_whole_file *w)
{
    if (w->file && !is_standard(w->file))
        fclose(w->file);
    free(w->text);
    free(w->place);
    *w = (struct br_whole_file){.path = NULL};
}
