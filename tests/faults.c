/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linked into a program, this makes one of its calls fail or last long, or ends the program
 * there: BR_FAULT="KIND N WHAT", or br_memory_fails_at. KIND memory: malloc and the like, also in
 * libraries; disk: calls that change a folder, fsync, and opening the program's own files. N: the
 * number of the call since main, from 1 on; 0: every call. WHAT: fail (ENOMEM, EIO), from (all
 * later calls fail, too), kill, stop (SIGTERM), pause (SIGSTOP), slow. The file $BR_FAULT_LOG is
 * made when the call is reached. */
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "faults.h"

static atomic_long calls;
static long which = -1;
static char kind[16], what[16];
static const char *record;

__attribute__((constructor)) static void read_fault(void)
{
    const char *fault = getenv("BR_FAULT");
    if (fault && sscanf(fault, "%15s %ld %15s", kind, &which, what) != 3)
        abort();
    record = getenv("BR_FAULT_LOG");
}

/* Whether this call must fail. */
static bool fails(const char *of)
{
    if (which < 0 || strcmp(kind, of) != 0)
        return false;
    const long call = atomic_fetch_add(&calls, 1) + 1;
    const bool hit = which == 0 || call == which || (call > which && strcmp(what, "from") == 0);
    if (!hit)
        return false;
    if (record)
        syscall(SYS_close, syscall(SYS_openat, AT_FDCWD, record, O_CREAT | O_WRONLY, 0600));
    if (strcmp(what, "kill") == 0)
        syscall(SYS_kill, getpid(), SIGKILL);
    if (strcmp(what, "stop") == 0)
        syscall(SYS_kill, getpid(), SIGTERM);
    if (strcmp(what, "pause") == 0)
        syscall(SYS_kill, getpid(), SIGSTOP);
    if (strcmp(what, "slow") == 0)
        syscall(SYS_nanosleep, &(struct timespec){.tv_nsec = 20000000}, NULL);
    return strcmp(what, "fail") == 0 || strcmp(what, "from") == 0;
}

/* ---- memory ---- */

long br_memory_fails_at(long n)
{
    strcpy(kind, "memory");
    strcpy(what, "fail");
    which = n;
    return atomic_exchange(&calls, 0);
}

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t unit, size_t size);

static bool no_memory(void)
{
    if (!fails("memory"))
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return no_memory() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return no_memory() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    return no_memory() ? NULL : __libc_realloc(old, size);
}

void *aligned_alloc(size_t unit, size_t size)
{
    return no_memory() ? NULL : __libc_memalign(unit, size);
}

void *memalign(size_t unit, size_t size)
{
    return no_memory() ? NULL : __libc_memalign(unit, size);
}

int posix_memalign(void **out, size_t unit, size_t size)
{
    if (no_memory())
        return ENOMEM;
    *out = __libc_memalign(unit, size);
    return *out ? 0 : ENOMEM;
}

/* ---- the disk ---- */

static bool disk_fails(void)
{
    if (!fails("disk"))
        return false;
    errno = EIO;
    return true;
}

int renameat2(int from, const char *old, int to, const char *new, unsigned flags)
{
    return disk_fails() ? -1 : (int)syscall(SYS_renameat2, from, old, to, new, flags);
}

int renameat(int from, const char *old, int to, const char *new)
{
    return disk_fails() ? -1 : (int)syscall(SYS_renameat2, from, old, to, new, 0);
}

int unlinkat(int folder, const char *name, int flags)
{
    return disk_fails() ? -1 : (int)syscall(SYS_unlinkat, folder, name, flags);
}

int mkdirat(int folder, const char *name, mode_t mode)
{
    return disk_fails() ? -1 : (int)syscall(SYS_mkdirat, folder, name, mode);
}

int mkostemp(char *name, int flags)
{
    return disk_fails() ? -1 : mkostemps(name, 0, flags);
}

int fsync(int file)
{
    return disk_fails() ? -1 : (int)syscall(SYS_fsync, file);
}

int openat(int folder, const char *name, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return disk_fails() ? -1 : (int)syscall(SYS_openat, folder, name, flags, mode);
}
