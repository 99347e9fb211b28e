/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/progress.h"
#include "cli/provenance.h"
#include "study/scene/quote.h"

/* Names in the hidden folder: the manifest of the new set, which decides it, and of the old set. */
static const char decided[] = ".manifest", replaced[] = ".old";

void br_close(int descriptor)
{
    const int reason = errno;
    if (descriptor >= 0)
        close(descriptor);
    errno = reason;
}

static bool is_there(int folder, const char *name)
{
    struct stat info;
    return fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0;
}

static enum br_status fail_with_errno(const char *name, struct br_error *err)
{
    return br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
}

/* ---- the hidden folder: the program that writes in it has locked it, and is its owner ---- */

static const char owner_name[] = ".owner";

/* Opens and locks a hidden folder or file of this user, new or left behind (info: out). Child
 * processes do not inherit it. -1 with errno; ENOENT: it is gone; EWOULDBLOCK: another program
 * uses it. */
static int take(int parent, const char *name, struct stat *info)
{
    struct stat there;
    const int found = openat(parent, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (found >= 0 && flock(found, LOCK_EX | LOCK_NB) == 0 && fstat(found, info) == 0) {
        const bool still = fstatat(parent, name, &there, AT_SYMLINK_NOFOLLOW) == 0 &&
                           there.st_dev == info->st_dev && there.st_ino == info->st_ino;
        if (still && info->st_uid == geteuid())
            return found;
        errno = still ? EPERM : ENOENT;
    }
    br_close(found);
    return -1;
}

static bool write_owner(int folder)
{
    const int file = openat(folder, owner_name, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0)
        return false;
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    const bool written =
        dprintf(file, "process %ld on %s: %.700s", (long)getpid(), host, br_command_line()) > 0;
    br_close(file);
    return written;
}

static enum br_status refuse(int parent, const char *hidden, struct br_error *err)
{
    char owner[800] = "another program or user", name[300];
    snprintf(name, sizeof name, "%s/%s", hidden, owner_name);
    const int file = openat(parent, name, O_RDONLY | O_CLOEXEC);
    const ssize_t got = file >= 0 ? read(file, owner, sizeof owner - 1) : 0;
    owner[got > 0 ? got : (ssize_t)strlen(owner)] = '\0';
    br_close(file);
    return br_fail(err, BR_BAD_INPUT,
                   "the folder is in use by %s; wait for its end, choose another folder, or, if "
                   "that program has ended, remove %s there",
                   owner, hidden);
}

/* Removes a locked hidden folder and its files; .owner goes last: a folder with that file is ours,
 * so the next program can remove the rest. */
static void remove_hidden(int parent, const char *name, int folder)
{
    struct dirent **entry;
    const int found = scandirat(folder, ".", &entry, NULL, NULL);
    bool empty = found >= 0;
    for (int i = 0; i < found; i++) {
        const char *file = entry[i]->d_name;
        if (strcmp(file, ".") != 0 && strcmp(file, "..") != 0 && strcmp(file, owner_name) != 0)
            empty = unlinkat(folder, file, 0) == 0 && empty;
        free(entry[i]);
    }
    if (found >= 0)
        free(entry);
    if (empty && unlinkat(folder, owner_name, 0) == 0)
        unlinkat(parent, name, AT_REMOVEDIR);
}

/* ---- putting in place: an earlier program may have done some of the steps ---- */

/* A file in the way must be of the old set. */
static enum br_status place(int parent, int folder, const char *name, bool listed,
                            struct br_error *err)
{
    if (!is_there(folder, name) && is_there(parent, name))
        return BR_OK;
    int failed = renameat2(folder, name, parent, name, listed ? 0 : RENAME_NOREPLACE);
    if (failed && !listed && errno == EINVAL && !is_there(parent, name))
        failed = renameat(folder, name, parent, name); /* a file system without that flag */
    return failed ? fail_with_errno(name, err) : BR_OK;
}

/* A file that was changed since belongs to a person: it stays. */
static enum br_status remove_stale(int parent, const json_t *file, struct br_error *err)
{
    bool same;
    const char *name = br_listed_name(file);
    if (br_listed_compare(parent, file, &same, err))
        return err->status;
    if (same)
        return unlinkat(parent, name, 0) == 0 ? BR_OK : fail_with_errno(name, err);
    fputs("beamrate: ", stderr);
    br_quote(stderr, &br_for_text, name);
    fputs(" is of an earlier run and was changed since: it stays\n", stderr);
    return BR_OK;
}

static enum br_status move_files(int parent, int folder, const json_t *old, const json_t *sets,
                                 struct br_error *err)
{
    size_t i, s;
    json_t *file, *set;
    json_array_foreach(br_sets_newest(sets), i, file)
    {
        const char *name = br_listed_name(file);
        if (place(parent, folder, name, br_sets_find(old, name), err))
            return err->status;
    }
    json_array_foreach(old, s, set) json_array_foreach(json_object_get(set, "files"), i, file)
    {
        const char *name = br_listed_name(file);
        if (!br_sets_find(sets, name) && is_there(parent, name) && remove_stale(parent, file, err))
            return err->status;
    }
    return BR_OK;
}

/* name: that of the manifest in the open folder `parent`. */
static enum br_status finish(int parent, int folder, const char *name, struct br_error *err)
{
    json_t *old = NULL, *sets = NULL;
    if (!is_there(folder, replaced) && renameat(parent, name, folder, replaced) != 0 &&
        errno != ENOENT)
        return fail_with_errno(name, err);
    bool failed = br_sets_read(folder, decided, &sets, err) ||
                  br_sets_read(folder, replaced, &old, err) ||
                  move_files(parent, folder, old, sets, err);
    if (!failed &&
        (renameat(folder, decided, parent, name) != 0 || (fsync(parent) != 0 && errno != EINVAL)))
        failed = fail_with_errno(name, err);
    json_decref(old);
    json_decref(sets);
    return failed ? err->status : BR_OK;
}

/* ---- what others left behind ---- */

/* The manifest's name by that of the hidden folder: .beamrate or .beamrate-STEM. */
static void name_manifest(const char *hidden, char name[280])
{
    const char *stem = hidden + strlen(BR_HIDDEN);
    snprintf(name, 280, "%.250s%smanifest.json", *stem ? stem + 1 : "", *stem ? "." : "");
}

static enum br_status sweep_one(int parent, const char *hidden, struct br_error *err)
{
    char name[280];
    struct stat info;
    struct br_error inner = {0};
    const int found = take(parent, hidden, &info);
    if (found < 0)
        return BR_OK;
    name_manifest(hidden, name);
    if (S_ISREG(info.st_mode))
        unlinkat(parent, hidden, 0);
    else if (!is_there(found, owner_name))
        unlinkat(parent, hidden, AT_REMOVEDIR); /* if empty: not signed yet */
    else if (!is_there(found, decided) || !finish(parent, found, name, &inner))
        remove_hidden(parent, hidden, found);
    close(found);
    return inner.status ? br_fail(err, inner.status,
                                  "the results in %s, which an earlier run left, cannot be put in "
                                  "place: %s",
                                  hidden, inner.message)
                        : BR_OK;
}

static int is_hidden(const struct dirent *entry)
{
    const char *name = entry->d_name, *rest = name + strlen(BR_HIDDEN);
    return strncmp(name, BR_HIDDEN, strlen(BR_HIDDEN)) == 0 && (*rest == '\0' || *rest == '-');
}

enum br_status br_output_sweep(int folder, struct br_error *err)
{
    struct dirent **entry;
    const int found = scandirat(folder, ".", &entry, is_hidden, NULL);
    if (found < 0)
        return br_fail(err, br_status_of_errno(errno), "cannot read the folder: %s",
                       strerror(errno));
    enum br_status status = BR_OK;
    for (int i = 0; i < found; i++) {
        if (!status)
            status = sweep_one(folder, entry[i]->d_name, err);
        free(entry[i]);
    }
    free(entry);
    return status;
}

/* ---- opening ---- */

/* Removes the folders of the path that br_make_folders made, if they are empty. */
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

bool br_make_folders(const char *path, mode_t last, size_t *made)
{
    char part[4096], *slash = part;
    snprintf(part, sizeof part, "%s", path);
    *made = 0;
    for (bool more = true; more; *slash = more ? '/' : '\0') {
        slash = strchrnul(slash + 1, '/');
        more = *slash;
        *slash = '\0';
        const bool failed = mkdir(part, more ? 0777 : last) != 0;
        if (failed && errno != EEXIST) {
            remove_folders(part, *made);
            return false;
        }
        *made = failed || *made ? *made : strlen(part);
    }
    return true;
}

/* Before we lock the new folder, another program may remove it as left behind: then try again. */
static enum br_status make_staging(struct br_output *o, struct br_error *err)
{
    enum { TRIALS = 100 };
    struct stat info;
    for (int i = 0; i < TRIALS; i++) {
        if (br_output_sweep(o->parent, err))
            return err->status;
        const bool made = mkdirat(o->parent, o->hidden, 0700) == 0;
        if (!made && errno != EEXIST)
            return br_fail(err, br_status_of_errno(errno), "cannot write in the folder: %s",
                           strerror(errno));
        o->descriptor = take(o->parent, o->hidden, &info);
        if (made && o->descriptor >= 0 && write_owner(o->descriptor))
            return BR_OK;
        const bool retry = o->descriptor >= 0 || errno == ENOENT;
        const int reason = errno;
        if (made && o->descriptor >= 0) { /* a full disk */
            unlinkat(o->descriptor, owner_name, 0);
            unlinkat(o->parent, o->hidden, AT_REMOVEDIR);
        }
        br_close(o->descriptor);
        o->descriptor = -1;
        if (made && reason && reason != ENOENT && reason != EWOULDBLOCK)
            return br_fail(err, br_status_of_errno(reason), "cannot write in the folder: %s",
                           strerror(reason));
        errno = reason;
        if (!made && !retry)
            return refuse(o->parent, o->hidden, err);
    }
    return br_fail(err, BR_BAD_INPUT, "%s is in the way", o->hidden);
}

enum br_status br_output_open(struct br_output *o, const char *folder, struct br_error *err)
{
    struct br_error inner = {0};
    o->staging[0] = '\0';
    o->descriptor = -1;
    if (*folder == '\0' || strlen(folder) >= sizeof o->folder)
        return br_fail(err, BR_BAD_INPUT, "--out: found '%s', expected a folder's name", folder);
    strcpy(o->folder, folder);
    snprintf(o->hidden, sizeof o->hidden, "%s%s%.250s", BR_HIDDEN, o->stem ? "-" : "",
             o->stem ? o->stem : "");
    name_manifest(o->hidden, o->manifest);
    if (!br_make_folders(folder, 0777, &o->made) ||
        (o->parent = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) < 0)
        return br_fail(err, br_status_of_errno(errno), "--out: cannot make the folder %s: %s",
                       folder, strerror(errno));
    snprintf(o->staging, sizeof o->staging, "%s/%s", folder, o->hidden);
    json_t *old = NULL;
    const bool failed = br_run_id_make(o->run, &inner) || make_staging(o, &inner) ||
                        br_sets_read(o->parent, o->manifest, &old, &inner);
    json_decref(old);
    if (!failed)
        return BR_OK;
    br_output_discard(o);
    return br_fail(err, inner.status, "--out: %s: %.900s", folder, inner.message);
}

enum br_status br_output_file(const struct br_output *o, const char *name, FILE **file,
                              struct br_error *err)
{
    char path[2048];
    if (*name == '.' || strchr(name, '/'))
        return br_fail(err, BR_BAD_INPUT,
                       "found '%.900s', expected a file's name that begins with no dot", name);
    snprintf(path, sizeof path, "%s/%s", o->staging, name);
    *file = fopen(path, "w");
    return *file ? BR_OK
                 : br_fail(err, errno == ENOMEM ? BR_NO_MEMORY : BR_IO, "%s: %s", path,
                           strerror(errno));
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

/* The first file of the set whose path is taken by something that no earlier run wrote, as a
 * folder. NULL: there is none. */
static const char *find_foreign(const struct br_output *o, const json_t *sets, const json_t *old)
{
    struct stat info;
    size_t i;
    json_t *file;
    json_array_foreach(br_sets_newest(sets), i, file)
    {
        const char *name = br_listed_name(file);
        if (fstatat(o->parent, name, &info, AT_SYMLINK_NOFOLLOW) == 0 &&
            (S_ISDIR(info.st_mode) || !br_sets_find(old, name)))
            return name;
    }
    return NULL;
}

/* Closes the folders; remove: nothing in the hidden one is needed, so it is removed. */
static void close_output(struct br_output *o, bool remove)
{
    if (remove && o->descriptor >= 0)
        remove_hidden(o->parent, o->hidden, o->descriptor);
    br_close(o->descriptor);
    br_close(o->parent);
    o->staging[0] = '\0';
}

/* If a file is in the way, the results are kept: the hidden folder becomes one beside that file. */
static enum br_status divert(struct br_output *o, json_t *sets, const char *foreign,
                             struct br_error *err)
{
    char name[64];
    snprintf(name, sizeof name, "set-%s", o->run);
    if (br_sets_write(o->descriptor, "manifest.json", sets, err))
        return err->status;
    if (unlinkat(o->descriptor, owner_name, 0) != 0 ||
        fchmod(o->descriptor, br_new_permissions(0777)) != 0 ||
        renameat(o->parent, o->hidden, o->parent, name) != 0)
        return fail_with_errno(name, err);
    close_output(o, false);
    return br_fail(err, BR_IO,
                   "%s/%s was not written by an earlier run and is not replaced: all results are "
                   "in %s/%s instead",
                   o->folder, foreign, o->folder, name);
}

/* After the decision, if this program cannot go on, the next one finishes the hidden folder. */
static enum br_status put_in_place(struct br_output *o, struct br_error *err)
{
    struct br_error inner = {0};
    const enum br_status status = finish(o->parent, o->descriptor, o->manifest, &inner);
    close_output(o, !status);
    return status ? br_fail(err, status,
                            "%s: %.700s; the results are whole in %s/%s: the next command with "
                            "this folder puts them in place first",
                            o->folder, inner.message, o->folder, o->hidden)
                  : BR_OK;
}

enum br_status br_output_commit(struct br_output *o, struct br_error *err)
{
    json_t *sets = NULL, *old = NULL;
    bool failed = br_sets_read(o->parent, o->manifest, &old, err) ||
                  br_sets_add(o->descriptor, o->run, old, &sets, err) ||
                  br_progress_result(BR_OK, err);
    const char *foreign = failed ? NULL : find_foreign(o, sets, old);
    if (foreign)
        failed = divert(o, sets, foreign, err);
    else if (!failed)
        failed = br_sets_write(o->descriptor, decided, sets, err) || put_in_place(o, err);
    json_decref(sets);
    json_decref(old);
    return failed ? err->status : BR_OK;
}

void br_output_discard(struct br_output *o)
{
    if (!o->staging[0])
        return;
    if (o->descriptor >= 0)
        unlinkat(o->descriptor, decided, 0); /* if this fails, its files must stay */
    close_output(o, o->descriptor >= 0 && !is_there(o->descriptor, decided));
    remove_folders(o->folder, o->made);
}
