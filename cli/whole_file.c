/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/whole_file.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/output.h"

static enum br_status refuse(const char *option, const char *path, struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "--%s: cannot write %s: %s", option, path, strerror(errno));
}

/* The permissions that a new file would have had. */
static void set_permissions(int descriptor, const struct stat *old)
{
    const mode_t mask = umask(0);
    umask(mask);
    (void)!fchmod(descriptor, old ? old->st_mode & 07777 : 0666 & ~mask);
}

static enum br_status open_staging(struct br_whole_file *w, const char *option,
                                   const struct stat *old, struct br_error *err)
{
    if (old && access(w->path, W_OK) < 0)
        return refuse(option, w->path, err);
    const int length = snprintf(w->staging, sizeof w->staging, "%s.XXXXXX", w->path);
    const int descriptor = length < (int)sizeof w->staging ? mkstemp(w->staging) : -1;
    if (descriptor < 0) {
        w->staging[0] = '\0';
        return refuse(option, w->path, err);
    }
    set_permissions(descriptor, old);
    w->file = fdopen(descriptor, "w");
    return w->file ? BR_OK : refuse(option, w->path, err);
}

enum br_status br_whole_file_open(struct br_whole_file *w, const char *option, const char *path,
                                  struct br_error *err)
{
    *w = (struct br_whole_file){.path = path};
    if (!path)
        return BR_OK;
    struct stat old;
    const bool there = stat(path, &old) == 0;
    if (strcmp(path, "-") == 0)
        w->file = stdout;
    else if (there && !S_ISREG(old.st_mode))
        w->file = fopen(path, "w"); /* a pipe, a terminal: nothing to rename; a folder fails */
    else
        return open_staging(w, option, there ? &old : NULL, err);
    return w->file ? BR_OK : refuse(option, path, err);
}

enum br_status br_whole_file_commit(struct br_whole_file *w, struct br_error *err)
{
    if (!w->file || w->file == stdout)
        return BR_OK; /* the caller of main's checks standard output */
    FILE *file = w->file;
    w->file = NULL;
    if (!w->staging[0]) {
        const bool failed = ferror(file);
        return fclose(file) != 0 || failed
                   ? br_fail(err, BR_IO, "%s could not be written whole", w->path)
                   : BR_OK;
    }
    enum br_status status = br_output_close(file, w->path, err);
    if (!status && rename(w->staging, w->path) < 0)
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
}
