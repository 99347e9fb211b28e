/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/signals.h"
#include "cli/staging.h"
#include "study/scene/quote.h"
#include "tables/json_value.h"

/* Of the hidden folder: the manifests of the new set, which decides it, and of the old one. */
static const char decided[] = ".manifest", replaced[] = ".old";

static bool is_there(int folder, const char *name)
{
    struct stat info;
    return fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0;
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
    return failed ? br_fail(err, BR_IO, "%s: %s", name, strerror(errno)) : BR_OK;
}

/* What has been changed since is a person's own. */
static enum br_status remove_stale(int parent, const struct br_manifest_file *f,
                                   struct br_error *err)
{
    bool same;
    const enum br_status status = br_manifest_compare(parent, f, &same, err);
    if (status)
        return status;
    if (!same) {
        fputs("beamrate: ", stderr);
        br_quote(stderr, &br_for_text, f->name);
        fputs(" is of an earlier run and was changed since: it stays\n", stderr);
    }
    return !same || unlinkat(parent, f->name, 0) == 0
               ? BR_OK
               : br_fail(err, BR_IO, "%s: %s", f->name, strerror(errno));
}

static enum br_status move_all(int parent, int folder, const char *name, struct br_error *err)
{
    struct br_manifest old = {.sets = NULL}, set = {.sets = NULL};
    enum br_status status = br_manifest_read(folder, decided, &set, err);
    if (!status)
        status = br_manifest_read(folder, replaced, &old, err);
    for (size_t i = 0; i < set.count && !status; i++) {
        const char *file = set.file[i].name;
        if (br_manifest_newest(&set, &set.file[i]))
            status = place(parent, folder, file, br_manifest_find(&old, file), err);
    }
    for (size_t i = 0; i < old.count && !status; i++)
        if (!br_manifest_find(&set, old.file[i].name) && is_there(parent, old.file[i].name))
            status = remove_stale(parent, &old.file[i], err);
    if (!status && renameat(folder, decided, parent, name) != 0)
        status = br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
    if (!status && fsync(parent) != 0 && errno != EINVAL)
        status = br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
    br_manifest_clear(&old);
    br_manifest_clear(&set);
    return status;
}

/* name: of the manifest in the open folder `parent`. */
static enum br_status finish(int parent, int folder, const char *name, struct br_error *err)
{
    if (!is_there(folder, replaced) && renameat(parent, name, folder, replaced) != 0 &&
        errno != ENOENT)
        return br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
    return move_all(parent, folder, name, err);
}

/* ---- what others left behind ---- */

/* The manifest's name by that of the hidden folder: .beamrate or .beamrate-STEM. */
static void name_manifest(const char *hidden, char name[280])
{
    const char *stem = hidden + strlen(BR_STAGING_PREFIX);
    snprintf(name, 280, "%.250s%smanifest.json", *stem ? stem + 1 : "", *stem ? "." : "");
}

static enum br_status sweep_one(int parent, const char *hidden, struct br_error *err)
{
    char name[280];
    const int folder = br_staging_take(parent, hidden);
    if (folder < 0) {
        br_staging_remove_file(parent, hidden);
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
    br_staging_remove(parent, hidden, folder);
    return BR_OK;
}

static bool is_hidden(const char *name)
{
    const size_t length = strlen(BR_STAGING_PREFIX);
    return strncmp(name, BR_STAGING_PREFIX, length) == 0 &&
           (name[length] == '\0' || name[length] == '-');
}

enum br_status br_output_sweep(int folder, struct br_error *err)
{
    const int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = copy >= 0 ? fdopendir(copy) : NULL;
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

static enum br_status make_staging(struct br_output *o, struct br_error *err)
{
    enum { TRIALS = 100 };
    enum br_status status = BR_OK;
    for (int i = 0; i < TRIALS && !status && o->descriptor < 0; i++) {
        status = br_output_sweep(o->parent, err);
        if (!status)
            status = br_staging_make(o->parent, o->hidden, &o->descriptor, err);
    }
    if (!status && o->descriptor < 0)
        return br_fail(err, BR_BAD_INPUT, "%s is in the way", o->hidden);
    return status;
}

static enum br_status check_manifest(const struct br_output *o, struct br_error *err)
{
    struct br_manifest old = {.sets = NULL};
    const enum br_status status = br_manifest_read(o->parent, o->manifest, &old, err);
    br_manifest_clear(&old);
    return status;
}

enum br_status br_output_open(struct br_output *o, const char *folder, struct br_error *err)
{
    struct br_error inner = {0};
    o->staging[0] = '\0';
    o->descriptor = -1;
    if (*folder == '\0' || strlen(folder) >= sizeof o->folder)
        return br_fail(err, BR_BAD_INPUT, "--out: found '%s', expected a folder's name", folder);
    strcpy(o->folder, folder);
    snprintf(o->hidden, sizeof o->hidden, "%s%s%.250s", BR_STAGING_PREFIX, o->stem ? "-" : "",
             o->stem ? o->stem : "");
    name_manifest(o->hidden, o->manifest);
    if (!make_folders(folder, &o->made) ||
        (o->parent = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) < 0)
        return br_fail(err, BR_BAD_INPUT, "--out: cannot make the folder %s: %s", folder,
                       strerror(errno));
    snprintf(o->staging, sizeof o->staging, "%s/%s", folder, o->hidden);
    enum br_status status = br_run_id_make(o->run, &inner);
    if (!status)
        status = make_staging(o, &inner);
    if (!status)
        status = check_manifest(o, &inner);
    if (!status)
        return BR_OK;
    br_output_discard(o);
    return br_fail(err, status, "--out: %s: %.900s", folder, inner.message);
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
static const char *find_foreign(const struct br_output *o, const struct br_manifest *set,
                                const struct br_manifest *old)
{
    struct stat info;
    for (size_t i = 0; i < set->count; i++)
        if (br_manifest_newest(set, &set->file[i]) &&
            fstatat(o->parent, set->file[i].name, &info, AT_SYMLINK_NOFOLLOW) == 0 &&
            (S_ISDIR(info.st_mode) || !br_manifest_find(old, set->file[i].name)))
            return set->file[i].name;
    return NULL;
}

static void close_output(struct br_output *o)
{
    if (o->descriptor >= 0)
        close(o->descriptor);
    close(o->parent);
    o->staging[0] = '\0';
}

/* Nothing that was computed is lost: the hidden folder becomes one beside what is in the way. */
static enum br_status divert(struct br_output *o, const struct br_manifest *set,
                             const char *foreign, struct br_error *err)
{
    char name[64];
    const mode_t mask = umask(0);
    umask(mask);
    snprintf(name, sizeof name, "set-%s", o->run);
    const enum br_status status = br_manifest_write(o->descriptor, "manifest.json", set, err);
    if (status)
        return status;
    if (unlinkat(o->descriptor, ".owner", 0) != 0 || fchmod(o->descriptor, 0777 & ~mask) != 0 ||
        renameat(o->parent, o->hidden, o->parent, name) != 0)
        return br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
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
    if (status)
        br_fail(err, status,
                "%s: %.700s; the results are whole in %s: the next command with this folder puts "
                "them in place first",
                o->folder, inner.message, o->staging);
    else {
        br_staging_remove(o->parent, o->hidden, o->descriptor);
        o->descriptor = -1;
    }
    close_output(o);
    return status;
}

enum br_status br_output_commit(struct br_output *o, struct br_error *err)
{
    struct br_manifest set = {.sets = NULL}, old = {.sets = NULL};
    enum br_status status = br_manifest_read(o->parent, o->manifest, &old, err);
    if (!status)
        status = br_manifest_list(o->descriptor, o->run, &old, &set, err);
    const char *foreign = status ? NULL : find_foreign(o, &set, &old);
    if (!status && br_json_lacked_memory())
        status = br_no_memory(err, "a JSON document");
    if (!status && br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    if (foreign && !status)
        status = divert(o, &set, foreign, err);
    else if (!status)
        status = br_manifest_write(o->descriptor, decided, &set, err);
    if (!status)
        status = put_in_place(o, err);
    br_manifest_clear(&set);
    br_manifest_clear(&old);
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
    if (o->descriptor >= 0) {
        unlinkat(o->descriptor, decided, 0); /* where it cannot go, its files must stay */
        if (!is_there(o->descriptor, decided)) {
            br_staging_remove(o->parent, o->hidden, o->descriptor);
            o->descriptor = -1;
        }
    }
    close_output(o);
    if (o->made)
        rmdir(o->folder); /* fails, as it should, where there are results */
}
