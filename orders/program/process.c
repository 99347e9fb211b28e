/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernel watches in place of a process of ours. The group of a program holds one end of a pipe,
 * and this process holds the other. When that closes, because this process is gone, the first end
 * has an event, for which the kernel sends the group the signal that F_SETSIG chose. A program may
 * close files that it does not know, so it has PR_SET_PDEATHSIG, too.
 *
 * _Fork runs no handlers of pthread_atfork: those of foreign libraries (OpenBLAS) wait for their
 * locks, which another thread may hold for ever. */
#include "orders/program/process.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define RUN "beamrate-run-" /* names of folders begin so */
enum { ABOVE_SHELLS = 10 /* scripts use the files below it */ };

static void pause_briefly(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static void close_if_open(int file)
{
    if (file >= 0)
        close(file);
}

/* ---- folders ---- */

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info;
    (void)type;
    (void)where;
    remove(path);
    return 0;
}

void br_remove_folder(const char *path)
{
    for (int tries = 0; tries < 20 && access(path, F_OK) == 0; tries++) {
        for (int i = 0; i < 10 && tries > 0; i++)
            pause_briefly();
        nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS | FTW_MOUNT);
    }
}

/* Opens a folder and locks it for as long as this process lives. */
static int hold(const char *path, bool *locked)
{
    const int file = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    *locked = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
    return file;
}

const char *br_temporary(void)
{
    const char *set = getenv("TMPDIR");
    return set && *set ? set : "/tmp";
}

void br_run_folders_clean(void)
{
    char path[PATH_MAX];
    DIR *all = opendir(br_temporary());
    for (struct dirent *old; all && (old = readdir(all));) {
        bool locked = false;
        struct stat info;
        const int length = snprintf(path, sizeof path, "%s/%s", br_temporary(), old->d_name);
        if (strncmp(old->d_name, RUN, strlen(RUN)) != 0 || length >= (int)sizeof path)
            continue;
        const int file = hold(path, &locked);
        if (locked && fstat(file, &info) == 0 && info.st_uid == geteuid() &&
            time(NULL) - info.st_mtim.tv_sec > 60) /* a new one is not locked for a moment */
            br_remove_folder(path);
        close_if_open(file);
    }
    if (all)
        closedir(all);
}

int br_run_folder_make(struct br_run_folder *f)
{
    bool locked; /* not every file system has locks */
    const int length = snprintf(f->path, sizeof f->path, "%s/" RUN "XXXXXX", br_temporary());
    f->file = -1;
    if (length >= (int)sizeof f->path)
        return ENAMETOOLONG;
    if (mkdtemp(f->path))
        f->file = hold(f->path, &locked);
    return f->file < 0 ? errno : 0;
}

bool br_run_folder_stays(struct br_run_folder *f, char path[PATH_MAX])
{
    char link[64];
    struct stat info;
    br_remove_folder(f->path);
    const bool stays = fstat(f->file, &info) == 0 && info.st_nlink > 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", f->file);
    const ssize_t length = readlink(link, path, PATH_MAX - 1); /* where it is now */
    path[length > 0 ? length : 0] = '\0';
    close(f->file);
    return stays;
}

/* ---- in the program's process, until it is the program ---- */

/* Asks for SIGKILL to the group when the other end of the pipe closes. Where the kernel has no such
 * signal, the program alone dies with its parent. */
static bool die_with(int alive, pid_t parent)
{
    const int held = fcntl(alive, F_DUPFD, ABOVE_SHELLS); /* not closed by execve */
    const bool grouped = setpgid(0, 0) == 0;
    if (held >= 0 && fcntl(held, F_SETOWN, -getpid()) == 0 && fcntl(held, F_SETSIG, SIGKILL) == 0)
        fcntl(held, F_SETFL, O_ASYNC);
    return grouped && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent;
}

/* Signals that beamrate ignores would stay ignored. */
_Noreturn static void become(const struct br_process *p, pid_t parent, int alive, int report)
{
    static const int usual[] = {SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGXFSZ};
    sigset_t none;
    sigemptyset(&none);
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        signal(usual[i], SIG_DFL);
    const int input = open("/dev/null", O_RDONLY);
    if (die_with(alive, parent) && fchdir(p->folder) == 0 && dup2(input, 0) == 0 &&
        dup2(p->output[0], 1) == 1 && dup2(p->output[1], 2) == 2 &&
        sigprocmask(SIG_SETMASK, &none, NULL) == 0) {
        if (input > 2)
            close(input);
        execve(p->program, p->word, p->environment);
    }
    const int failure = errno;
    _exit(write(report, &failure, sizeof failure) == sizeof failure ? 127 : 126);
}

/* ---- in this process ---- */

int br_process_start(struct br_process *p)
{
    const pid_t self = getpid();
    int alive[2] = {-1, -1}, report[2] = {-1, -1};
    sigset_t all, old;
    sigfillset(&all);
    p->id = -1;
    pthread_sigmask(SIG_SETMASK, &all, &old);
    if (pipe2(alive, O_CLOEXEC) == 0 && pipe2(report, O_CLOEXEC | O_NONBLOCK) == 0)
        p->id = _Fork();
    const int failure = errno;
    if (p->id == 0)
        become(p, self, alive[0], report[1]);
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    close_if_open(alive[0]);
    close_if_open(report[1]);
    p->alive = alive[1];
    p->report = report[0];
    if (p->id > 0)
        return 0;
    close_if_open(p->alive);
    close_if_open(p->report);
    return failure;
}

/* It stays a zombie until the end, so that no other group gets its number. */
bool br_process_has_ended(const struct br_process *p)
{
    siginfo_t info = {.si_pid = 0};
    const int failed = waitid(P_PID, (id_t)p->id, &info, WEXITED | WNOHANG | WNOWAIT);
    return failed ? errno != EINTR : info.si_pid != 0;
}

bool br_process_signal(const struct br_process *p, int number)
{
    return kill(-p->id, number) == 0 || errno != EPERM;
}

struct br_process_end br_process_end(struct br_process *p)
{
    struct br_process_end end = {0};
    br_process_signal(p, SIGKILL);
    const pid_t ended = wait4(p->id, &end.status, WNOHANG, &end.usage);
    end.known = ended == p->id;
    int left = kill(-p->id, 0);
    for (int i = 0; i < 50 && left == 0 && ended != 0; i++) { /* what was killed needs a moment */
        pause_briefly();
        left = kill(-p->id, 0);
    }
    end.survives = ended == 0 || (left != 0 && errno == EPERM);
    if (read(p->report, &end.failure, sizeof end.failure) != sizeof end.failure)
        end.failure = 0;
    close(p->alive);
    close(p->report);
    return end;
}
