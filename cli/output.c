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

/* Of the hidden folder: the manifests of the new set, which decides it, and of the old one. */
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

/* ---- the hidden folder: who writes in it has locked it, and is its owner ---- */

static const char owner_name[] = ".owner";

/* Programs that are started do not inherit it. */
static int open_folder(int parent, const char *name)
{
    return openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

static bool is_still(int parent, const char *name, int folder)
{
    struct stat there, ours;
    return fstatat(parent, name, &there, AT_SYMLINK_NOFOLLOW) == 0 && fstat(folder, &ours) == 0 &&
           there.st_dev == ours.st_dev && there.st_ino == ours.st_ino;
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

static enum br_status refuse(int parent, const char *name, struct br_error *err)
{
    char owner[800] = "another program or user";
    const int folder = open_folder(parent, name);
    const int file = folder >= 0 ? openat(folder, owner_name, O_RDONLY | O_CLOEXEC) : -1;
    const ssize_t got = file >= 0 ? read(file, owner, sizeof owner - 1) : 0;
    owner[got > 0 ? got : (ssize_t)strlen(owner)] = '\0';
    br_close(file);
    br_close(folder);
    return br_fail(err, BR_BAD_INPUT,
                   "the folder is in use by %s; wait for its end, choose another folder, or, if "
                   "that program has ended, remove %s there",
                   owner, name);
}

/* Makes and locks a hidden folder in an open one. BR_OK with folder (out): its descriptor; -1: it
 * is there, and nobody uses it. Fails with BR_BAD_INPUT where it cannot be made, or where another
 * program uses it, which the message names. Between making and locking it somebody may take it for
 * one that was left behind. */
static enum br_status make_hidden(int parent, const char *name, int *folder, struct br_error *err)
{
    const bool made = mkdirat(parent, name, 0700) == 0;
    if (!made && errno != EEXIST)
        return br_fail(err, BR_BAD_INPUT, "cannot write in the folder: %s", strerror(errno));
    *folder = open_folder(parent, name);
    const bool locked = *folder >= 0 && flock(*folder, LOCK_EX | LOCK_NB) == 0;
    const bool taken = !locked && errno == EWOULDBLOCK;
    if (*folder >= 0 && made && !taken && is_still(parent, name, *folder) && write_owner(*folder))
        return BR_OK;
    br_close(*folder);
    const bool gone = *folder < 0 && errno == ENOENT;
    *folder = -1;
    if (made && !taken && errno && errno != ENOENT)
        return br_fail(err, BR_BAD_INPUT, "cannot write in the folder: %s", strerror(errno));
    return locked || gone ? BR_OK : refuse(parent, name, err);
}

/* The descriptor of a hidden folder that this user's program left behind, which is then locked; -1:
 * it is in use, or no such folder. */
static int take_hidden(int parent, const char *name)
{
    struct stat info;
    const int folder = open_folder(parent, name);
    if (folder < 0)
        return -1;
    if (flock(folder, LOCK_EX | LOCK_NB) == 0 && is_still(parent, name, folder) &&
        fstat(folder, &info) == 0 && info.st_uid == geteuid()) {
        if (faccessat(folder, owner_name, F_OK, 0) == 0)
            return folder;
        unlinkat(parent, name, AT_REMOVEDIR); /* where it is empty: ended before it was signed */
    }
    close(folder);
    return -1;
}

/* The names in an open folder, which stays open; NULL with errno. */
static DIR *open_list(int folder)
{
    const int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = copy >= 0 ? fdopendir(copy) : NULL;
    if (!list)
        br_close(copy);
    return list;
}

/* All files but the owner's. False: some are still there. */
static bool empty(int folder)
{
    DIR *list = open_list(folder);
    bool all = list;
    for (struct dirent *entry; list && (entry = readdir(list));) {
        const char *name = entry->d_name;
        if (strcmp(name, ".") != 0 && strcmp(name, "..") != 0 && strcmp(name, owner_name) != 0)
            all = unlinkat(folder, name, 0) == 0 && all;
    }
    if (list)
        closedir(list);
    return all;
}

/* Removes a locked one with its files, and closes it. The owner goes last: what has one is ours,
 * and the next program removes the rest. */
static void remove_hidden(int parent, const char *name, int folder)
{
    if (empty(folder) && unlinkat(folder, owner_name, 0) == 0)
        unlinkat(parent, name, AT_REMOVEDIR);
    close(folder);
}

/* One that nobody is writing. */
static void remove_hidden_file(int parent, const char *name)
{
    struct stat info;
    const int file = openat(parent, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return;
    if (flock(file, LOCK_EX | LOCK_NB) == 0 && fstat(file, &info) == 0 && S_ISREG(info.st_mode) &&
        info.st_uid == geteuid())
        unlinkat(parent, name, 0);
    close(file);
}

/* ---- putting in place: each step may have been done before ---- */

/* What is in the way must be of the old set. */
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

/* What has been changed since is a person's own. */
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
    const json_t *files = br_sets_newest(sets);
    for (size_t i = 0; i < json_array_size(files); i++) {
        const char *name = br_listed_name(json_array_get(files, i));
        if (place(parent, folder, name, br_sets_find(old, name), err))
            return err->status;
    }
    for (size_t s = 0; s < json_array_size(old); s++) {
        files = json_object_get(json_array_get(old, s), "files");
        for (size_t i = 0; i < json_array_size(files); i++) {
            const json_t *file = json_array_get(files, i);
            const char *name = br_listed_name(file);
            if (!br_sets_find(sets, name) && is_there(parent, name) &&
                remove_stale(parent, file, err))
                return err->status;
        }
    }
    return BR_OK;
}

/* name: of the manifest in the open folder `parent`. */
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
    const int folder = take_hidden(parent, hidden);
    if (folder < 0) {
        remove_hidden_file(parent, hidden);
        return BR_OK;
    }
    struct br_error inner = {0};
    name_manifest(hidden, name);
    if (is_there(folder, decided) && finish(parent, folder, name, &inner)) {
        close(folder);
        return br_fail(err, inner.status,
                       "the results in %s, which an earlier run left, cannot be put in place: %s",
                       hidden, inner.message);
    }
    remove_hidden(parent, hidden, folder);
    return BR_OK;
}

static bool is_hidden(const char *name)
{
    const size_t length = strlen(BR_HIDDEN);
    return strncmp(name, BR_HIDDEN, length) == 0 && (name[length] == '\0' || name[length] == '-');
}

enum br_status br_output_sweep(int folder, struct br_error *err)
{
    DIR *list = open_list(folder);
    if (!list)
        return br_fail(err, errno == ENOMEM ? BR_NO_MEMORY : BR_BAD_INPUT,
                       "cannot read the folder: %s", strerror(errno));
    enum br_status status = BR_OK;
    for (struct dirent *entry; !status && (entry = readdir(list));)
        if (is_hidden(entry->d_name))
            status = sweep_one(folder, entry->d_name, err);
    closedir(list);
    return status;
}

/* ---- opening ---- */

bool br_make_folders(const char *path, mode_t last, bool *made)
{
    char part[4096];
    snprintf(part, sizeof part, "%s", path);
    for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(part, 0777) < 0 && errno != EEXIST)
            return false;
        *slash = '/';
    }
    *made = mkdir(part, last) == 0;
    return *made || errno == EEXIST;
}

static enum br_status make_staging(struct br_output *o, struct br_error *err)
{
    enum { TRIALS = 100 };
    for (int i = 0; i < TRIALS; i++) {
        if (br_output_sweep(o->parent, err) ||
            make_hidden(o->parent, o->hidden, &o->descriptor, err))
            return err->status;
        if (o->descriptor >= 0)
            return BR_OK;
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
        return br_fail(err, BR_BAD_INPUT, "--out: cannot make the folder %s: %s", folder,
                       strerror(errno));
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

/* The first file of the set in whose place there is something that no earlier run wrote; a folder
 * is nobody's. NULL: there is none. */
static const char *find_foreign(const struct br_output *o, const json_t *sets, const json_t *old)
{
    struct stat info;
    const json_t *files = br_sets_newest(sets);
    for (size_t i = 0; i < json_array_size(files); i++) {
        const char *name = br_listed_name(json_array_get(files, i));
        if (fstatat(o->parent, name, &info, AT_SYMLINK_NOFOLLOW) == 0 &&
            (S_ISDIR(info.st_mode) || !br_sets_find(old, name)))
            return name;
    }
    return NULL;
}

static void close_output(struct br_output *o)
{
    br_close(o->descriptor);
    br_close(o->parent);
    o->staging[0] = '\0';
}

/* Nothing that was computed is lost: the hidden folder becomes one beside what is in the way. */
static enum br_status divert(struct br_output *o, json_t *sets, const char *foreign,
                             struct br_error *err)
{
    char name[64];
    snprintf(name, sizeof name, "set-%s", o->run);
    if (br_sets_write(o->descriptor, "manifest.json", sets, err))
        return err->status;
    if (unlinkat(o->descriptor, ".owner", 0) != 0 ||
        fchmod(o->descriptor, br_new_permissions(0777)) != 0 ||
        renameat(o->parent, o->hidden, o->parent, name) != 0)
        return fail_with_errno(name, err);
    br_fail(err, BR_IO,
            "%s/%s was not written by an earlier run and is not replaced: all results are in "
            "%s/%s instead",
            o->folder, foreign, o->folder, name);
    close_output(o);
    return BR_IO;
}

/* After the decision the hidden folder is the next program's, if this one cannot go on. */
static enum br_status put_in_place(struct br_output *o, struct br_error *err)
{
    struct br_error inner = {0};
    const enum br_status status = finish(o->parent, o->descriptor, o->manifest, &inner);
    if (!status) {
        remove_hidden(o->parent, o->hidden, o->descriptor);
        o->descriptor = -1;
    }
    close_output(o);
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
    if (o->descriptor >= 0) {
        unlinkat(o->descriptor, decided, 0); /* where it cannot go, its files must stay */
        if (!is_there(o->descriptor, decided)) {
            remove_hidden(o->parent, o->hidden, o->descriptor);
            o->descriptor = -1;
        }
    }
    close_output(o);
    if (o->made)
        rmdir(o->folder); /* fails, as it should, where there are results */
}
