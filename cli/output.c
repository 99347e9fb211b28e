/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include "cli/staging.h"
#include "study/quote.h"

/* Every folder of the path that is not there yet; *made: whether the last one was not. */
static bool make_folders(const char *path, bool *made)
{
    char part[1024];
    snprintf(part, sizeof part, "%s", path);
    for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(part, 0777) < 0 && errno != EEXIST)
            return false;
        *slash = '/';
    }
    *made = mkdir(part, 0777) == 0;
    return *made || errno == EEXIST;
}

enum br_status br_output_open(struct br_output *o, const char *folder, struct br_error *err)
{
    o->staging[0] = '\0';
    if (*folder == '\0' || strlen(folder) >= sizeof o->folder)
        return br_fail(err, BR_BAD_INPUT, "--out: found '%s', expected a folder's name", folder);
    strcpy(o->folder, folder);
    if (!make_folders(folder, &o->made))
        return br_fail(err, BR_BAD_INPUT, "--out: cannot make the folder %s: %s", folder,
                       strerror(errno));
    br_staging_sweep(folder);
    if (!br_staging_make(folder, o->staging, sizeof o->staging, &o->lock)) {
        o->staging[0] = '\0';
        return br_fail(err, BR_BAD_INPUT, "--out: cannot write in the folder %s: %s", folder,
                       strerror(errno));
    }
    return BR_OK;
}

static void path_of(const char *folder, const char *name, char path[2048])
{
    snprintf(path, 2048, "%s/%s", folder, name);
}

enum br_status br_output_file(const struct br_output *o, const char *name, FILE **file,
                              struct br_error *err)
{
    char path[2048];
    path_of(o->staging, name, path);
    *file = fopen(path, "w");
    return *file ? BR_OK : br_fail(err, BR_IO, "%s: %s", path, strerror(errno));
}

enum br_status br_output_close(FILE *file, const char *name, struct br_error *err)
{
    const bool failed = fflush(file) != 0 || ferror(file) || fsync(fileno(file)) != 0;
    const int reason = errno;
    if (fclose(file) != 0 || failed)
        return br_fail(err, BR_IO, "%s could not be written whole: %s", name, strerror(reason));
    return BR_OK;
}

/* Calls act for every file in the hidden folder; stops at the first failure. */
static enum br_status for_each(struct br_output *o,
                               enum br_status (*act)(const struct br_output *, const char *,
                                                     struct br_error *),
                               struct br_error *err)
{
    DIR *folder = opendir(o->staging);
    if (!folder)
        return br_fail(err, BR_IO, "%s: %s", o->staging, strerror(errno));
    enum br_status status = BR_OK;
    for (struct dirent *entry; !status && (entry = readdir(folder));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            status = act(o, entry->d_name, err);
    closedir(folder);
    return status;
}

static enum br_status move(const struct br_output *o, const char *name, struct br_error *err)
{
    char from[2048], to[2048];
    path_of(o->staging, name, from);
    path_of(o->folder, name, to);
    return rename(from, to) == 0 ? BR_OK : br_fail(err, BR_IO, "%s: %s", to, strerror(errno));
}

static enum br_status erase(const struct br_output *o, const char *name, struct br_error *err)
{
    (void)err;
    char path[2048];
    path_of(o->staging, name, path);
    unlink(path);
    return BR_OK;
}

/* A folder in the way of a file would leave half a set: look before moving. */
static enum br_status check_target(const struct br_output *o, const char *name,
                                   struct br_error *err)
{
    char to[2048];
    struct stat info;
    path_of(o->folder, name, to);
    if (lstat(to, &info) == 0 && S_ISDIR(info.st_mode))
        return br_fail(err, BR_IO, "%s is a folder, expected a file to replace", to);
    return BR_OK;
}

enum br_status br_output_commit(struct br_output *o, struct br_error *err)
{
    enum br_status status = for_each(o, check_target, err);
    if (!status)
        status = for_each(o, move, err);
    if (!status)
        br_output_discard(o);
    return status;
}

void br_output_announce(const struct br_output *o)
{
    fputs("Written to ", stdout);
    br_quote(stdout, &br_for_text, o->folder);
    fputs("/\n", stdout);
}

void br_output_discard(struct br_output *o)
{
    if (!o->staging[0])
        return;
    for_each(o, erase, NULL);
    rmdir(o->staging);
    if (o->lock >= 0)
        close(o->lock);
    o->staging[0] = '\0';
    if (o->made)
        rmdir(o->folder); /* fails, as it should, where there are results */
}
