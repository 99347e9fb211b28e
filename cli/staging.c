/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/staging.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char prefix[] = ".beamrate-";

/* -1, errno EWOULDBLOCK: somebody else has it. Programs that are started do not inherit it. */
static int open_and_lock(int parent, const char *name)
{
    const int folder = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder >= 0 && flock(folder, LOCK_EX | LOCK_NB) != 0) {
        const int reason = errno;
        close(folder);
        errno = reason;
        return -1;
    }
    return folder;
}

/* Between making and locking it somebody may sweep it away: then another one is made. */
bool br_staging_make(const char *folder, char *path, size_t size, int *lock)
{
    enum { TRIALS = 100 };
    for (int i = 0; i < TRIALS; i++) {
        snprintf(path, size, "%s/%sXXXXXX", folder, prefix);
        if (!mkdtemp(path))
            return false;
        *lock = open_and_lock(AT_FDCWD, path);
        const bool taken = *lock < 0 && (errno == EWOULDBLOCK || errno == ENOENT);
        if (!taken && access(path, F_OK) == 0)
            return true;
        if (*lock >= 0)
            close(*lock);
    }
    errno = EBUSY;
    return false;
}

static void remove_files(int folder)
{
    const int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = copy >= 0 ? fdopendir(copy) : NULL;
    if (!list)
        return;
    for (struct dirent *entry; (entry = readdir(list));)
        unlinkat(folder, entry->d_name, 0); /* a folder stays, "." and ".." too */
    closedir(list);
}

static void sweep_one(int parent, const char *name)
{
    struct stat info;
    const int folder = open_and_lock(parent, name);
    if (folder < 0)
        return;
    if (fstat(folder, &info) == 0 && info.st_uid == geteuid()) {
        remove_files(folder);
        unlinkat(parent, name, AT_REMOVEDIR);
    }
    close(folder);
}

void br_staging_sweep(const char *folder)
{
    DIR *list = opendir(folder);
    if (!list)
        return;
    for (struct dirent *entry; (entry = readdir(list));)
        if (strncmp(entry->d_name, prefix, sizeof prefix - 1) == 0 &&
            strlen(entry->d_name) == sizeof prefix - 1 + 6)
            sweep_one(dirfd(list), entry->d_name);
    closedir(list);
}
