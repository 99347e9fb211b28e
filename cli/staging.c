/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/staging.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/provenance.h"

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

/* errno is kept. */
static void close_again(int folder)
{
    const int reason = errno;
    close(folder);
    errno = reason;
}

/* ---- whose it is ---- */

static bool write_owner(int folder)
{
    const int file = openat(folder, owner_name, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0)
        return false;
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    const bool written =
        dprintf(file, "process %ld on %s: %.700s", (long)getpid(), host, br_command_line()) > 0;
    close_again(file);
    return written;
}

static enum br_status refuse(int parent, const char *name, struct br_error *err)
{
    char owner[800] = "another program or user";
    const int folder = open_folder(parent, name);
    const int file = folder >= 0 ? openat(folder, owner_name, O_RDONLY | O_CLOEXEC) : -1;
    const ssize_t got = file >= 0 ? read(file, owner, sizeof owner - 1) : 0;
    owner[got > 0 ? got : (ssize_t)strlen(owner)] = '\0';
    if (file >= 0)
        close(file);
    if (folder >= 0)
        close(folder);
    return br_fail(err, BR_BAD_INPUT,
                   "the folder is in use by %s; wait for its end, choose another folder, or, if "
                   "that program has ended, remove %s there",
                   owner, name);
}

/* ---- making and removing ---- */

/* Between making and locking it somebody may take it for one that was left behind. */
enum br_status br_staging_make(int parent, const char *name, int *folder, struct br_error *err)
{
    const bool made = mkdirat(parent, name, 0700) == 0;
    if (!made && errno != EEXIST)
        return br_fail(err, BR_BAD_INPUT, "cannot write in the folder: %s", strerror(errno));
    *folder = open_folder(parent, name);
    const bool locked = *folder >= 0 && flock(*folder, LOCK_EX | LOCK_NB) == 0;
    const bool taken = !locked && errno == EWOULDBLOCK;
    if (*folder >= 0 && made && !taken && is_still(parent, name, *folder) && write_owner(*folder))
        return BR_OK;
    if (*folder >= 0)
        close_again(*folder);
    const bool gone = *folder < 0 && errno == ENOENT;
    *folder = -1;
    if (made && !taken && errno && errno != ENOENT)
        return br_fail(err, BR_BAD_INPUT, "cannot write in the folder: %s", strerror(errno));
    return locked || gone ? BR_OK : refuse(parent, name, err);
}

int br_staging_take(int parent, const char *name)
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

/* All files but the owner's. False: some are still there. */
static bool empty(int folder)
{
    const int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = copy >= 0 ? fdopendir(copy) : NULL;
    if (!list && copy >= 0)
        close(copy);
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

/* The owner goes last: what has one is ours, and the next program removes the rest. */
void br_staging_remove(int parent, const char *name, int folder)
{
    if (empty(folder) && unlinkat(folder, owner_name, 0) == 0)
        unlinkat(parent, name, AT_REMOVEDIR);
    close(folder);
}

void br_staging_remove_file(int parent, const char *name)
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
