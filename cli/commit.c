/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commit.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/quote.h"
#include "base/text.h"
#include "cli/output.h"
#include "cli/progress.h"

/* No result can have this name: those begin with no dot. */
static const char list_name[] = ".beamrate-set", first_line[] = "beamrate-set 2\n";

/* A file of a set: a line of the list. */
struct entry {
    unsigned set;    /* files of one run have the same number, from 1 on; 0: to be left out */
    long long bytes; /* its size */
    long long time;  /* when it was last changed, ns since 1970 */
    char name[BR_FILE_NAME];
};

/* Begins as zeros. */
struct list {
    struct entry *entry; /* `count` of them; owned */
    size_t count, room;
};

static enum br_status fail_with_errno(const char *name, struct br_error *err)
{
    return errno == ENOMEM ? br_no_memory(err, name)
                           : br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
}

static bool is_there(int folder, const char *name)
{
    struct stat info;
    return fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0;
}

/* ---- lists ---- */

static bool append(struct list *l, const struct entry *entry)
{
    if (!br_grow(&l->entry, l->count, &l->room, sizeof *l->entry))
        return false;
    l->entry[l->count++] = *entry;
    return true;
}

static const struct entry *find(const struct list *l, const char *name)
{
    for (size_t i = 0; i < l->count; i++)
        if (strcmp(l->entry[i].name, name) == 0)
            return &l->entry[i];
    return NULL;
}

static long long time_of(const struct stat *info)
{
    return info->st_mtim.tv_sec * 1000000000LL + info->st_mtim.tv_nsec;
}

/* Whether the file is as we wrote it. */
static bool is_ours(int folder, const struct entry *e)
{
    struct stat info;
    return fstatat(folder, e->name, &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(info.st_mode) &&
           info.st_size == e->bytes && time_of(&info) == e->time;
}

/* No list leads out of its folder, or to a hidden file. */
static bool read_line(const char *line, struct entry *e)
{
    int end = 0;
    sscanf(line, "%9u %18lld %19lld %255[^\n]%n", &e->set, &e->bytes, &e->time, e->name, &end);
    return end > 0 && strcmp(line + end, "\n") == 0 && e->set > 0 && e->name[0] != '.' &&
           !strchr(e->name, '/');
}

static enum br_status read_lines(FILE *file, struct list *l, struct br_error *err)
{
    char line[BR_FILE_NAME + 64];
    struct entry e;
    bool ours = fgets(line, sizeof line, file) && strcmp(line, first_line) == 0;
    while (ours && fgets(line, sizeof line, file)) {
        ours = read_line(line, &e);
        if (ours && !append(l, &e))
            return br_no_memory(err, list_name);
    }
    if (ours && ferror(file))
        return fail_with_errno(list_name, err);
    return ours ? BR_OK
                : br_fail(err, BR_BAD_INPUT,
                          "%s is not a list of results of this version; if you remove it, all "
                          "files there count as your own",
                          list_name);
}

/* A folder without a list has an empty one. */
static enum br_status read_list(int folder, struct list *l, struct br_error *err)
{
    *l = (struct list){0};
    const int found = openat(folder, list_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (found < 0 && errno == ENOENT)
        return BR_OK;
    if (found < 0 && errno == ELOOP)
        return br_fail(err, BR_BAD_INPUT, "%s is a symbolic link; remove it", list_name);
    FILE *file = found < 0 ? NULL : fdopen(found, "r");
    if (!file) {
        br_close(found);
        return fail_with_errno(list_name, err);
    }
    const enum br_status status = read_lines(file, l, err);
    fclose(file);
    return status;
}

static enum br_status write_list(int folder, const struct list *l, struct br_error *err)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = br_text_open(&text, &size);
    if (!file)
        return br_no_memory(err, list_name);
    fputs(first_line, file);
    for (const struct entry *e = l->entry; e < l->entry + l->count; e++)
        fprintf(file, "%u %lld %lld %s\n", e->set, e->bytes, e->time, e->name);
    enum br_status status = BR_OK;
    if (fclose(file) != 0)
        status = br_no_memory(err, list_name);
    else if (!br_put_whole(folder, list_name, br_new_permissions(0666), text, size) ||
             !br_sync_folder(folder))
        status = fail_with_errno(list_name, err);
    free(text);
    return status;
}

enum br_status br_set_check(int folder, struct br_error *err)
{
    struct list l;
    const enum br_status status = read_list(folder, &l, err);
    free(l.entry);
    return status;
}

/* ---- the new list ---- */

/* For one file; its time is final when it is on the disk. */
static bool add_new(int hidden, const char *name, struct list *new, unsigned set)
{
    struct stat info;
    struct entry e = {.set = set};
    const int file = openat(hidden, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    const bool known = file >= 0 && fsync(file) == 0 && fstat(file, &info) == 0;
    br_close(file);
    if (!known)
        return false;
    e.bytes = info.st_size;
    e.time = time_of(&info);
    snprintf(e.name, sizeof e.name, "%s", name);
    return append(new, &e);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

/* Step 1; new is empty. */
static enum br_status list_new(int hidden, const struct list *old, struct list *new,
                               struct br_error *err)
{
    unsigned last = 0;
    for (size_t i = 0; i < old->count; i++)
        last = old->entry[i].set > last ? old->entry[i].set : last;
    struct dirent **found;
    const int count = scandirat(hidden, ".", &found, is_visible, alphasort);
    if (count < 0)
        return fail_with_errno("the new results", err);
    enum br_status status = BR_OK;
    for (int i = 0; i < count; i++) {
        if (!status && !add_new(hidden, found[i]->d_name, new, last + 1))
            status = fail_with_errno(found[i]->d_name, err);
        free(found[i]);
    }
    free(found);
    if (!status && !br_sync_folder(hidden))
        status = fail_with_errno("the new results", err);
    return status;
}

/* Whether two files have one name but for what follows its last dot. */
static bool same_stem(const char *a, const char *b)
{
    const char *end = strrchr(a, '.'), *other = strrchr(b, '.');
    const size_t length = end ? (size_t)(end - a) : strlen(a);
    return length == (other ? (size_t)(other - b) : strlen(b)) && strncmp(a, b, length) == 0;
}

/* Whether a new file has this name, whatever the formats are. All runs share the page. */
static bool is_replaced(const struct list *new, const char *name)
{
    for (size_t i = 0; i < new->count && strcmp(name, BR_PAGE) != 0; i++)
        if (strcmp(new->entry[i].name, BR_PAGE) != 0 && same_stem(new->entry[i].name, name))
            return true;
    return false;
}

/* Marks all files of each old set of which a file is replaced. */
static void leave_out_replaced(struct list *old, const struct list *new)
{
    for (size_t i = 0; i < old->count; i++) {
        const unsigned set = old->entry[i].set;
        if (set && is_replaced(new, old->entry[i].name))
            for (size_t j = 0; j < old->count; j++)
                old->entry[j].set = old->entry[j].set == set ? 0 : old->entry[j].set;
    }
}

/* Adds the old sets that stay, without a page if the new set has one. */
static enum br_status add_kept(struct list *new, struct list *old, struct br_error *err)
{
    leave_out_replaced(old, new);
    for (size_t i = 0; i < old->count; i++)
        if (old->entry[i].set && !find(new, old->entry[i].name) && !append(new, &old->entry[i]))
            return br_no_memory(err, list_name);
    return BR_OK;
}

/* The first file that is still to be moved and whose place somebody's file has; NULL: none. */
static const char *find_in_way(int folder, int hidden, const struct list *new,
                               const struct list *old)
{
    for (size_t i = 0; i < new->count; i++) {
        const char *name = new->entry[i].name;
        const struct entry *was = find(old, name);
        if (is_there(hidden, name) && is_there(folder, name) && !(was && is_ours(folder, was)))
            return name;
    }
    return NULL;
}

enum br_status br_set_decide(int folder, int hidden, char in_way[BR_FILE_NAME],
                             struct br_error *err)
{
    struct list old, new = {0};
    bool failed = read_list(folder, &old, err) || list_new(hidden, &old, &new, err) ||
                  br_progress_result(BR_OK, err);
    const char *name = failed ? NULL : find_in_way(folder, hidden, &new, &old);
    snprintf(in_way, BR_FILE_NAME, "%s", name ? name : "");
    if (!failed && !name)
        failed = add_kept(&new, &old, err) || write_list(hidden, &new, err);
    free(old.entry);
    free(new.entry);
    return failed ? err->status : BR_OK;
}

bool br_set_is_decided(int hidden)
{
    return is_there(hidden, list_name);
}

/* ---- putting in place: an earlier program may have done some of the steps ---- */

static enum br_status move_new(int folder, int hidden, const struct list *new, struct br_error *err)
{
    for (size_t i = 0; i < new->count; i++) {
        const char *name = new->entry[i].name;
        if (is_there(hidden, name) && renameat(hidden, name, folder, name) != 0)
            return fail_with_errno(name, err);
    }
    return BR_OK;
}

static enum br_status remove_old(int folder, const struct list *new, const struct list *old,
                                 struct br_error *err)
{
    for (size_t i = 0; i < old->count; i++) {
        const struct entry *e = &old->entry[i];
        if (find(new, e->name) || !is_there(folder, e->name))
            continue;
        if (!is_ours(folder, e)) {
            fputs("beamrate: ", stderr);
            br_quote(stderr, &br_for_text, e->name);
            fputs(" comes from an earlier run and has been changed since: it is not removed\n",
                  stderr);
        } else if (unlinkat(folder, e->name, 0) != 0)
            return fail_with_errno(e->name, err);
    }
    return BR_OK;
}

enum br_status br_set_finish(int folder, int hidden, struct br_error *err)
{
    struct list old = {0}, new;
    bool failed = read_list(hidden, &new, err) || read_list(folder, &old, err);
    const char *in_way = failed ? NULL : find_in_way(folder, hidden, &new, &old);
    if (in_way)
        failed = br_fail(err, BR_BAD_INPUT,
                         "%s was not written by an earlier run, or has changed "
                         "since: move it away",
                         in_way);
    failed = failed || move_new(folder, hidden, &new, err) || remove_old(folder, &new, &old, err);
    if (!failed && (!br_sync_folder(folder) ||
                    renameat(hidden, list_name, folder, list_name) != 0 || !br_sync_folder(folder)))
        failed = fail_with_errno(list_name, err);
    free(old.entry);
    free(new.entry);
    return failed ? err->status : BR_OK;
}

void br_set_remove(int folder, const char *hidden_name, int hidden)
{
    struct dirent **found;
    if (unlinkat(hidden, list_name, 0) != 0 && errno != ENOENT)
        return;
    const int count = scandirat(hidden, ".", &found, NULL, NULL);
    for (int i = 0; i < count; i++) {
        unlinkat(hidden, found[i]->d_name, 0); /* "." and "..": fails */
        free(found[i]);
    }
    if (count >= 0)
        free(found);
    unlinkat(folder, hidden_name, AT_REMOVEDIR);
}
