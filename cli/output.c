/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/provenance.h"

static const char lock_name[] = ".beamrate-lock", hidden_name[] = ".beamrate-new";

enum { TRIALS = 1000 }; /* to lock what others remove meanwhile */

void br_close(int descriptor)
{
    const int reason = errno;
    if (descriptor >= 0)
        close(descriptor);
    errno = reason;
}

bool br_sync_folder(int folder)
{
    return fsync(folder) == 0 || errno == EINVAL; /* some file systems have no such call */
}

/* ---- folders ---- */

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

/* ---- the lock ---- */

static bool lock(int file, bool wait)
{
    return flock(file, LOCK_EX | (wait ? 0 : LOCK_NB)) == 0 || errno == ENOSYS || errno == ENOLCK;
}

/* Who had the lock before may have removed the file, which is then nobody's: begin again. */
int br_lock_file(int folder, const char *name, bool wait)
{
    const int flags = O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    struct stat ours, there;
    for (int i = 0; i < TRIALS; i++) {
        const int file = openat(folder, name, flags, 0666);
        if (file < 0)
            return -1;
        if (!lock(file, wait) || fstat(file, &ours) != 0) {
            br_close(file);
            return -1;
        }
        if (fstatat(folder, name, &there, AT_SYMLINK_NOFOLLOW) == 0 &&
            there.st_ino == ours.st_ino && there.st_dev == ours.st_dev)
            return file;
        close(file);
    }
    errno = ESTALE;
    return -1;
}

static void write_owner(int file)
{
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    if (ftruncate(file, 0) == 0)
        dprintf(file, "process %ld on %s: %.700s", (long)getpid(), host, br_command_line());
}

static void read_owner(int folder, char owner[800])
{
    const int file = openat(folder, lock_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    const ssize_t got = file >= 0 ? read(file, owner, 799) : 0;
    owner[got > 0 ? got : 0] = '\0';
    br_close(file);
    if (!*owner)
        strcpy(owner, "another program");
}

static enum br_status fail_to_lock(const struct br_output *o, struct br_error *err)
{
    char owner[800];
    if (errno != EWOULDBLOCK)
        return br_fail(err, br_status_of_errno(errno), "cannot write %s in the folder: %s",
                       lock_name, strerror(errno));
    read_owner(o->parent, owner);
    return br_fail(err, BR_BAD_INPUT,
                   "the folder is in use by %s; wait for its end, or choose another folder", owner);
}

/* ---- opening ---- */

/* Before we have the lock, the program that made the folder first may remove it: make it again. */
static enum br_status make_and_lock(struct br_output *o, struct br_error *err)
{
    for (int i = 0; i < TRIALS && o->lock < 0 && (i == 0 || errno == ENOENT); i++) {
        br_close(o->parent);
        o->parent = br_make_folders(o->folder, 0777, &o->made)
                        ? open(o->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC)
                        : -1;
        if (o->parent < 0)
            return br_fail(err, br_status_of_errno(errno), "cannot make the folder: %s",
                           strerror(errno));
        o->lock = br_lock_file(o->parent, lock_name, false);
    }
    if (o->lock < 0)
        return fail_to_lock(o, err);
    write_owner(o->lock);
    return BR_OK;
}

/* Finishes a commit, or removes files that were never one. */
static enum br_status clear_hidden(const struct br_output *o, struct br_error *err)
{
    struct br_error inner = {0};
    const int hidden =
        openat(o->parent, hidden_name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (hidden < 0)
        return errno == ENOENT ? BR_OK
                               : br_fail(err, br_status_of_errno(errno), "%s is in the way: %s",
                                         hidden_name, strerror(errno));
    if (!br_set_is_decided(hidden) || !br_set_finish(o->parent, hidden, &inner))
        br_set_remove(o->parent, hidden_name, hidden);
    close(hidden);
    return inner.status ? br_fail(err, inner.status,
                                  "the results of an earlier run, which are in %s, cannot be put "
                                  "in place (remove it to discard them): %.700s",
                                  hidden_name, inner.message)
                        : BR_OK;
}

static enum br_status make_hidden(struct br_output *o, struct br_error *err)
{
    if (mkdirat(o->parent, hidden_name, 0700) != 0 ||
        (o->descriptor = openat(o->parent, hidden_name, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) < 0)
        return br_fail(err, br_status_of_errno(errno), "cannot make %s: %s", hidden_name,
                       strerror(errno));
    snprintf(o->staging, sizeof o->staging, "%s/%s", o->folder, hidden_name);
    return BR_OK;
}

/* Ends the lock. Its file goes first: without the lock it may be another program's. */
static void close_output(struct br_output *o)
{
    if (o->lock >= 0)
        unlinkat(o->parent, lock_name, 0);
    br_close(o->lock);
    br_close(o->descriptor);
    br_close(o->parent);
    o->staging[0] = '\0';
}

enum br_status br_output_open(struct br_output *o, const char *folder, struct br_error *err)
{
    struct br_error inner = {0};
    o->staging[0] = '\0';
    o->parent = o->descriptor = o->lock = -1;
    if (*folder == '\0' || strlen(folder) >= sizeof o->folder)
        return br_fail(err, BR_BAD_INPUT, "--out: found '%s', expected a folder's name", folder);
    strcpy(o->folder, folder);
    if (!make_and_lock(o, &inner) && !clear_hidden(o, &inner) && !br_set_check(o->parent, &inner) &&
        !make_hidden(o, &inner))
        return BR_OK;
    close_output(o);
    remove_folders(o->folder, o->made);
    return br_fail(err, inner.status, "--out: %s: %.900s", folder, inner.message);
}

/* ---- its files ---- */

enum br_status br_output_file(const struct br_output *o, const char *name, FILE **file,
                              struct br_error *err)
{
    char path[2048];
    if (*name == '.' || strchr(name, '/'))
        return br_fail(err, BR_BAD_INPUT,
                       "found '%.900s', expected a file's name that does not begin with a dot",
                       name);
    snprintf(path, sizeof path, "%s/%s", o->staging, name);
    *file = fopen(path, "wx"); /* one result must not replace another */
    if (!*file && errno == EEXIST)
        return br_fail(err, BR_BAD_INPUT,
                       "two results are called %.900s; rename the file of a scene", name);
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

/* If a file is in the way, the results are kept: the hidden folder becomes one beside that file. */
static enum br_status divert(struct br_output *o, const char *in_way, struct br_error *err)
{
    enum { MOST = 999 };
    char name[32];
    bool moved = false, taken = fchmod(o->descriptor, br_new_permissions(0777)) == 0;
    for (int i = 1; i <= MOST && taken && !moved; i++) {
        snprintf(name, sizeof name, "set-%d", i);
        moved = renameat(o->parent, hidden_name, o->parent, name) == 0;
        taken = errno == ENOTEMPTY || errno == EEXIST || errno == ENOTDIR;
    }
    if (!moved)
        return br_fail(err, BR_IO,
                       "%s/%s was not written by an earlier run, or has changed since: "
                       "%s",
                       o->folder, in_way, strerror(errno));
    close_output(o);
    return br_fail(err, BR_IO,
                   "%s/%s was not written by an earlier run, or has changed since, and is not "
                   "replaced: all results are in %s/%s instead; move that file away, or choose "
                   "another folder",
                   o->folder, in_way, o->folder, name);
}

enum br_status br_output_commit(struct br_output *o, struct br_error *err)
{
    struct br_error inner = {0};
    char in_way[BR_FILE_NAME];
    if (br_set_decide(o->parent, o->descriptor, in_way, err))
        return err->status;
    if (*in_way)
        return divert(o, in_way, err);
    if (!br_set_finish(o->parent, o->descriptor, &inner))
        br_set_remove(o->parent, hidden_name, o->descriptor);
    close_output(o);
    return inner.status ? br_fail(err, inner.status,
                                  "%s: %.700s; the results are whole in %s/%s: the next command "
                                  "with this folder puts them in place first",
                                  o->folder, inner.message, o->folder, hidden_name)
                        : BR_OK;
}

void br_output_discard(struct br_output *o)
{
    if (!br_output_is_open(o))
        return;
    br_set_remove(o->parent, hidden_name, o->descriptor);
    close_output(o);
    remove_folders(o->folder, o->made);
}
