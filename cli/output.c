/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/text.h"
#include "cli/progress.h"

/* No result can have these names: those begin with no dot. */
static const char lock_name[] = ".beamrate-lock", hidden_name[] = ".beamrate-new",
                  manifest_name[] = ".beamrate-set";
static const char first_line[] = "beamrate-set 3\n";

static enum br_status fail_with_errno(const char *name, struct br_error *err)
{
    return br_fail(err, br_status_of_errno(errno), "%s: %s", name, strerror(errno));
}

static bool sync_folder(int folder)
{
    return fsync(folder) == 0 || errno == EINVAL; /* some file systems have no such call */
}

/* ---- folders ---- */

/* Removes the folders of the path that make_folders made, if they are empty. */
static void remove_folders(const char *path, size_t made)
{
    char part[4096];
    const int reason = errno;
    snprintf(part, sizeof part, "%s", path);
    for (size_t end = strlen(part); made && end >= made; end--)
        if (part[end] == '\0' || part[end] == '/') {
            part[end] = '\0';
            rmdir(part);
        }
    errno = reason;
}

/* Makes every missing folder of the path. *made (out): the length of the path of the first one that
 * was missing; 0: none was. False: errno says why, and none is left. */
static bool make_folders(const char *path, size_t *made)
{
    char part[4096], *slash = part;
    snprintf(part, sizeof part, "%s", path);
    *made = 0;
    for (bool more = true; more; *slash = more ? '/' : '\0') {
        slash = strchrnul(slash + 1, '/');
        more = *slash;
        *slash = '\0';
        const bool failed = mkdir(part, 0777) != 0;
        if (failed && errno != EEXIST) {
            remove_folders(part, *made);
            return false;
        }
        *made = failed || *made ? *made : strlen(part);
    }
    return true;
}

/* ---- manifests: a line for each file, behind the first line ---- */

/* No manifest leads out of its folder, or to a hidden file. */
static bool is_manifest(const char *text, ssize_t length)
{
    return length > 0 && strncmp(text, first_line, strlen(first_line)) == 0 &&
           text[length - 1] == '\n' && !strchr(text, '/') && !strstr(text, "\n.");
}

/* A folder without a manifest has an empty one. *manifest (out, NULL before) is owned by the
 * caller. */
static enum br_status read_manifest(int folder, char **manifest, struct br_error *err)
{
    size_t room = 0;
    const int found = openat(folder, manifest_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (found < 0 && errno == ENOENT)
        return (*manifest = strdup(first_line)) ? BR_OK : br_no_memory(err, manifest_name);
    FILE *file = found < 0 ? NULL : fdopen(found, "r");
    enum br_status status = file ? BR_OK : fail_with_errno(manifest_name, err);
    const ssize_t length = file ? getdelim(manifest, &room, '\0', file) : 0;
    if (file && length < 0 && !feof(file))
        status = fail_with_errno(manifest_name, err);
    else if (file && !is_manifest(*manifest, length))
        status = br_fail(err, BR_BAD_INPUT,
                         "%s is not a list of results of this version; if you remove it, all files "
                         "there count as your own",
                         manifest_name);
    if (file)
        fclose(file);
    else if (found >= 0)
        close(found);
    return status;
}

/* The name in the line behind *line (in/out), which stands in a manifest; false: there is none. */
static bool next_name(const char **line, char name[NAME_MAX + 1])
{
    const char *next = strchr(*line, '\n') + 1, *end = strchr(next, '\n');
    if (!end)
        return false;
    snprintf(name, NAME_MAX + 1, "%.*s", (int)(end - next), next);
    *line = next;
    return true;
}

static bool has_name(const char *manifest, const char *name)
{
    char line[NAME_MAX + 3];
    snprintf(line, sizeof line, "\n%s\n", name);
    return strstr(manifest, line);
}

static bool is_there(int folder, const char *name)
{
    struct stat info;
    return fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0;
}

/* Whether the folder has somebody's file of this name: one that is not in its manifest, or that is
 * no plain file any more. */
static bool is_somebodys(int folder, const char *manifest, const char *name)
{
    struct stat info;
    return fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0 &&
           !(has_name(manifest, name) && S_ISREG(info.st_mode));
}

/* Whether somebody's file has the place of one that is still to be moved; name (out): which. */
static bool is_in_way(const struct br_output *o, const char *new, const char *old,
                      char name[NAME_MAX + 1])
{
    for (const char *line = new; next_name(&line, name);)
        if (is_there(o->descriptor, name) && is_somebodys(o->parent, old, name))
            return true;
    return false;
}

/* ---- the steps of a commit ---- */

static bool sync_file(int folder, const char *name)
{
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    const bool done = file >= 0 && fsync(file) == 0;
    const int reason = errno;
    if (file >= 0)
        close(file);
    errno = reason;
    return done;
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

/* Step 1. *manifest (out), of the new files, is owned by the caller. */
static enum br_status sync_new(const struct br_output *o, char **manifest, struct br_error *err)
{
    size_t size;
    struct dirent **found;
    FILE *out = br_text_open(manifest, &size);
    const int count = out ? scandirat(o->descriptor, ".", &found, is_visible, alphasort) : 0;
    enum br_status status = !out        ? br_no_memory(err, manifest_name)
                            : count < 0 ? fail_with_errno("the new results", err)
                                        : BR_OK;
    if (out)
        fputs(first_line, out);
    for (int i = 0; i < count; i++) {
        if (!status && !sync_file(o->descriptor, found[i]->d_name))
            status = fail_with_errno(found[i]->d_name, err);
        fprintf(out, "%s\n", found[i]->d_name);
        free(found[i]);
    }
    if (out && count >= 0)
        free(found);
    if (!status && !sync_folder(o->descriptor))
        status = fail_with_errno("the new results", err);
    return out && fclose(out) != 0 && !status ? br_no_memory(err, manifest_name) : status;
}

/* Step 2. */
static enum br_status decide(const struct br_output *o, const char *manifest, struct br_error *err)
{
    char path[1500];
    snprintf(path, sizeof path, "%s/%s", o->staging, manifest_name);
    return br_put_whole(path, 0, manifest, strlen(manifest)) && sync_folder(o->descriptor)
               ? BR_OK
               : fail_with_errno(manifest_name, err);
}

/* Steps 3, 4 and 5, which an earlier program may have done. False: errno says why, and name (out)
 * which file it was. */
static bool move_new(struct br_output *o, const char *new, char name[NAME_MAX + 1])
{
    for (const char *line = new; next_name(&line, name);) {
        const bool replaces = is_there(o->parent, name);
        if (!is_there(o->descriptor, name))
            continue;
        if (renameat(o->descriptor, name, o->parent, name) != 0)
            return false;
        o->replaced += replaces;
    }
    return true;
}

static bool remove_old(struct br_output *o, const char *new, const char *old,
                       char name[NAME_MAX + 1])
{
    for (const char *line = old; next_name(&line, name);) {
        if (has_name(new, name) || !is_there(o->parent, name) || is_somebodys(o->parent, old, name))
            continue;
        if (unlinkat(o->parent, name, 0) != 0)
            return false;
        o->removed++;
    }
    return true;
}

static bool replace_manifest(const struct br_output *o, char name[NAME_MAX + 1])
{
    strcpy(name, manifest_name);
    return sync_folder(o->parent) && renameat(o->descriptor, name, o->parent, name) == 0 &&
           sync_folder(o->parent);
}

static enum br_status finish(struct br_output *o, const char *new, const char *old,
                             struct br_error *err)
{
    char name[NAME_MAX + 1];
    if (is_in_way(o, new, old, name))
        return br_fail(err, BR_BAD_INPUT, "%s was not written by an earlier run: move it away",
                       name);
    return move_new(o, new, name) && remove_old(o, new, old, name) && replace_manifest(o, name)
               ? BR_OK
               : fail_with_errno(name, err);
}

/* Removes the hidden folder: the manifest first, so that nothing is decided any more. */
static void remove_hidden(const struct br_output *o)
{
    struct dirent **found;
    if (unlinkat(o->descriptor, manifest_name, 0) != 0 && errno != ENOENT)
        return;
    const int count = scandirat(o->descriptor, ".", &found, NULL, NULL);
    for (int i = 0; i < count; i++) {
        unlinkat(o->descriptor, found[i]->d_name, 0); /* "." and "..": fails */
        free(found[i]);
    }
    if (count >= 0)
        free(found);
    unlinkat(o->parent, hidden_name, AT_REMOVEDIR);
}

/* ---- opening ---- */

/* Who had the lock before has removed its file, so that a lock on that is none. */
static enum br_status lock_folder(struct br_output *o, struct br_error *err)
{
    struct stat info;
    if (!make_folders(o->folder, &o->made) ||
        (o->parent = open(o->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) < 0)
        return br_fail(err, br_status_of_errno(errno), "cannot make the folder: %s",
                       strerror(errno));
    const int file =
        openat(o->parent, lock_name, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (file < 0)
        return br_fail(err, br_status_of_errno(errno), "cannot write %s in the folder: %s",
                       lock_name, strerror(errno));
    if ((flock(file, LOCK_EX | LOCK_NB) == 0 || errno == ENOSYS || errno == ENOLCK) &&
        fstat(file, &info) == 0 && info.st_nlink > 0) {
        o->lock = file;
        return BR_OK;
    }
    close(file);
    return br_fail(err, BR_BAD_INPUT,
                   "the folder is in use by another program; wait for its end, or choose another "
                   "folder");
}

/* Finishes a commit, or removes files that were never one. */
static enum br_status recover(struct br_output *o, struct br_error *err)
{
    struct br_error inner = {0};
    char *old = NULL, *new = NULL;
    o->descriptor = openat(o->parent, hidden_name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (o->descriptor < 0 && errno != ENOENT)
        return br_fail(err, br_status_of_errno(errno), "%s is in the way: %s", hidden_name,
                       strerror(errno));
    enum br_status status = read_manifest(o->parent, &old, err);
    if (!status && o->descriptor >= 0) {
        if (!is_there(o->descriptor, manifest_name) ||
            (!read_manifest(o->descriptor, &new, &inner) && !finish(o, new, old, &inner)))
            remove_hidden(o);
        else
            status = br_fail(err, inner.status,
                             "the results of an earlier run, which are in %s, cannot be put in "
                             "place (remove it to discard them): %.700s",
                             hidden_name, inner.message);
    }
    if (o->descriptor >= 0)
        close(o->descriptor);
    o->descriptor = -1;
    free(old);
    free(new);
    return status;
}

static enum br_status make_hidden(struct br_output *o, struct br_error *err)
{
    if (mkdirat(o->parent, hidden_name, 0777) != 0 ||
        (o->descriptor = openat(o->parent, hidden_name, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) < 0)
        return br_fail(err, br_status_of_errno(errno), "cannot make %s: %s", hidden_name,
                       strerror(errno));
    snprintf(o->staging, sizeof o->staging, "%s/%s", o->folder, hidden_name);
    return BR_OK;
}

/* Ends the lock, whose file goes first: without the lock it may be another program's. discarded:
 * the folder goes, too, if we made it. */
static void close_output(struct br_output *o, bool discarded)
{
    if (o->lock >= 0) {
        unlinkat(o->parent, lock_name, 0);
        if (discarded)
            remove_folders(o->folder, o->made);
        close(o->lock);
    }
    if (o->descriptor >= 0)
        close(o->descriptor);
    if (o->parent >= 0)
        close(o->parent);
    o->staging[0] = '\0';
}

enum br_status br_output_open(struct br_output *o, const char *folder, struct br_error *err)
{
    struct br_error inner = {0};
    *o = (struct br_output){.parent = -1, .descriptor = -1, .lock = -1};
    if (*folder == '\0' || strlen(folder) >= sizeof o->folder)
        return br_fail(err, BR_BAD_INPUT, "--out: found '%s', expected a folder's name", folder);
    strcpy(o->folder, folder);
    if (!lock_folder(o, &inner) && !recover(o, &inner) && !make_hidden(o, &inner))
        return BR_OK;
    close_output(o, true);
    return br_fail(err, inner.status, "--out: %s: %.900s", folder, inner.message);
}

/* ---- its files ---- */

enum br_status br_output_file(const struct br_output *o, const char *name, FILE **file,
                              struct br_error *err)
{
    char path[2048];
    if (*name == '.' || strpbrk(name, "/\n"))
        return br_fail(err, BR_BAD_INPUT,
                       "found '%.900s', expected a file's name that does not begin with a dot",
                       name);
    snprintf(path, sizeof path, "%s/%s", o->staging, name);
    *file = fopen(path, "wx"); /* one result must not replace another */
    if (!*file && errno == EEXIST)
        return br_fail(err, BR_BAD_INPUT,
                       "two results are called %.900s; rename the file of a scene", name);
    return *file ? BR_OK : fail_with_errno(path, err);
}

enum br_status br_output_close(FILE *file, const char *name, struct br_error *err)
{
    const bool failed = fflush(file) != 0 || ferror(file);
    const int reason = errno;
    if (fclose(file) != 0 || failed)
        return br_fail(err, BR_IO, "%s could not be written whole: %s", name, strerror(reason));
    return BR_OK;
}

/* ---- committing ---- */

/* If a file is in the way, the results are kept: the hidden folder becomes one beside that file. */
static enum br_status divert(struct br_output *o, const char *in_way, struct br_error *err)
{
    enum { MOST = 999 };
    char name[32];
    int moved = -1;
    for (int i = 1; i <= MOST && moved; i++) {
        snprintf(name, sizeof name, "set-%d", i);
        moved = renameat(o->parent, hidden_name, o->parent, name);
        if (moved && errno != ENOTEMPTY && errno != EEXIST && errno != ENOTDIR)
            break;
    }
    if (moved)
        return br_fail(err, BR_IO, "%s/%s was not written by an earlier run: %s", o->folder, in_way,
                       strerror(errno));
    close_output(o, false);
    return br_fail(err, BR_IO,
                   "%s/%s was not written by an earlier run, and is not replaced: all results are "
                   "in %s/%s instead; move that file away, or choose another folder",
                   o->folder, in_way, o->folder, name);
}

static enum br_status put_in_place(struct br_output *o, const char *new, const char *old,
                                   struct br_error *err)
{
    struct br_error inner = {0};
    if (!finish(o, new, old, &inner))
        remove_hidden(o);
    close_output(o, false);
    return inner.status ? br_fail(err, inner.status,
                                  "%s: %.700s; the results are whole in %s/%s: the next command "
                                  "with this folder puts them in place first",
                                  o->folder, inner.message, o->folder, hidden_name)
                        : BR_OK;
}

enum br_status br_output_commit(struct br_output *o, struct br_error *err)
{
    char *old = NULL, *new = NULL, name[NAME_MAX + 1];
    enum br_status status = read_manifest(o->parent, &old, err);
    if (!status)
        status = sync_new(o, &new, err);
    if (!status)
        status = br_progress_result(BR_OK, err);
    if (!status && is_in_way(o, new, old, name))
        status = divert(o, name, err);
    else if (!status && !(status = decide(o, new, err)))
        status = put_in_place(o, new, old, err);
    free(old);
    free(new);
    return status;
}

void br_output_discard(struct br_output *o)
{
    if (!br_output_is_open(o))
        return;
    remove_hidden(o);
    close_output(o, true);
}
