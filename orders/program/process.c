/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program is a child of a keeper, a child of this process that does nothing but wait. The
 * keeper is a subreaper: what the program leaves behind, in any session, becomes a child of the
 * keeper, which kills it. The kernel signals the keeper when this process is gone. Only where the
 * keeper is killed, too, can something be left: the kernel then kills the program, but not what it
 * started. */
#include "orders/program/process.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* What the keeper is told by signals. */
enum { TERMINATE = SIGTERM, KILL_ALL = SIGUSR1 };

static void pause_briefly(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info;
    (void)type;
    (void)where;
    remove(path);
    return 0;
}

void br_remove_folder(const char *folder)
{
    for (int tries = 0; tries < 20 && *folder && access(folder, F_OK) == 0; tries++) {
        for (int i = 0; i < 10 && tries > 0; i++)
            pause_briefly();
        nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS | FTW_MOUNT);
    }
}

/* ---- in the program's process, until it is the program ---- */

/* Signals that beamrate ignores would stay ignored. */
_Noreturn static void become(const struct br_process *p, pid_t keeper)
{
    static const int usual[] = {SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGXFSZ, SIGCHLD};
    sigset_t none;
    sigemptyset(&none);
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        signal(usual[i], SIG_DFL);
    const int input = open("/dev/null", O_RDONLY);
    if (setpgid(0, 0) == 0 && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == keeper &&
        chdir(p->end->folder) == 0 && dup2(input, 0) == 0 && dup2(p->output[0], 1) == 1 &&
        dup2(p->output[1], 2) == 2 && sigprocmask(SIG_SETMASK, &none, NULL) == 0) {
        if (input > 2)
            close(input);
        execve(p->program, p->word, p->environment);
    }
    p->end->failure = errno;
    _exit(127);
}

/* ---- in the keeper ---- */

static void kill_children(void)
{
    char text[4096];
    const int file = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
    const ssize_t length = file >= 0 ? read(file, text, sizeof text - 1) : 0;
    text[length > 0 ? length : 0] = '\0';
    char *rest = text;
    for (long child; (child = strtol(rest, &rest, 10)) > 0;)
        if (!rest[0] || strchr(" \n", rest[0])) /* else the number may be cut off */
            kill((pid_t)child, SIGKILL);
    if (file >= 0)
        close(file);
}

/* Buries a child that has ended. 0: none has; below 0: there is none. */
static pid_t bury(const struct br_process *p, pid_t program)
{
    int status;
    struct rusage usage;
    const pid_t ended = wait4(-1, &status, WNOHANG, &usage);
    if (ended == program) {
        p->end->status = status;
        p->end->usage = usage;
    }
    return ended;
}

/* Kills all children until there are none: those of a dead child become the keeper's. A kernel that
 * does not list them leaves those that have left the program's group. */
static void kill_all(const struct br_process *p, pid_t program)
{
    const bool listed = access("/proc/thread-self/children", R_OK) == 0;
    if (!listed)
        kill(-program, SIGKILL);
    kill_children();
    for (pid_t ended; (ended = bury(p, program)) >= 0;) {
        if (ended == 0 && !listed && kill(-program, 0) != 0)
            break;
        if (ended == 0)
            pause_briefly();
        kill_children();
    }
}

/* Copies a regular file of the program's folder; of any other nothing. */
static void copy_file(const struct br_process *p, size_t i)
{
    char block[1 << 14];
    struct stat info;
    const int folder = open(p->end->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const int from = openat(folder, p->file[i], O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    size_t copied = 0;
    for (ssize_t got = from >= 0 && fstat(from, &info) == 0 && S_ISREG(info.st_mode);
         got > 0 && copied <= p->most; copied += (size_t)got) {
        got = read(from, block, sizeof block);
        if (got > 0 && write(p->copy[i], block, (size_t)got) != got)
            got = -1;
    }
    if (from >= 0)
        close(from);
    if (folder >= 0)
        close(folder);
}

static bool make_folder(const char *where, char folder[PATH_MAX])
{
    const int length = snprintf(folder, PATH_MAX, "%s/beamrate-XXXXXX", where);
    errno = ENAMETOOLONG;
    if (length < PATH_MAX && mkdtemp(folder))
        return true;
    folder[0] = '\0'; /* so that it is not removed */
    return false;
}

/* All signals are blocked. */
_Noreturn static void keep(const struct br_process *p, pid_t parent, const sigset_t *all)
{
    const pid_t keeper = getpid();
    signal(SIGCHLD, SIG_DFL);
    setpgid(0, 0);
    prctl(PR_SET_NAME, "keeper"); /* "killall beamrate" does not mean it */
    const bool watches =
        prctl(PR_SET_CHILD_SUBREAPER, 1) == 0 && prctl(PR_SET_PDEATHSIG, KILL_ALL) == 0;
    const pid_t program =
        watches && getppid() == parent && make_folder(p->where, p->end->folder) ? fork() : -1;
    if (program == 0)
        become(p, keeper);
    const bool failed = program < 0;
    if (failed)
        p->end->failure = errno;
    else
        setpgid(program, program); /* now, or it has done so */
    for (bool over = failed; !over;) {
        const int number = sigwaitinfo(all, NULL);
        if (number == TERMINATE)
            kill(-program, SIGTERM);
        over = number == KILL_ALL;
        for (pid_t ended; number == SIGCHLD && !over && (ended = bury(p, program)) > 0;)
            over = ended == program;
    }
    if (!failed)
        kill_all(p, program);
    for (size_t i = 0; i < p->files && !failed; i++)
        copy_file(p, i);
    br_remove_folder(p->end->folder);
    p->end->known = true;
    _exit(0);
}

/* ---- in this process ---- */

int br_process_start(struct br_process *p)
{
    const pid_t self = getpid();
    sigset_t all, old;
    void *shared =
        mmap(NULL, sizeof *p->end, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        return errno;
    p->end = shared;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &old);
    p->keeper = fork();
    const int failure = errno;
    if (p->keeper == 0)
        keep(p, self, &all);
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    if (p->keeper > 0)
        return 0;
    munmap(p->end, sizeof *p->end);
    return failure;
}

/* The keeper stays a zombie until the wait, so that no other process gets its number. */
bool br_process_has_ended(const struct br_process *p)
{
    siginfo_t info = {.si_pid = 0};
    const int failed = waitid(P_PID, (id_t)p->keeper, &info, WEXITED | WNOHANG | WNOWAIT);
    return failed ? errno != EINTR : info.si_pid != 0;
}

void br_process_terminate(const struct br_process *p)
{
    kill(p->keeper, TERMINATE);
}

void br_process_kill(const struct br_process *p)
{
    kill(p->keeper, KILL_ALL);
    kill(p->keeper, SIGCONT); /* the program may have stopped it */
}

struct br_process_end br_process_wait(struct br_process *p)
{
    while (waitpid(p->keeper, NULL, 0) < 0 && errno == EINTR)
        ;
    const struct br_process_end end = *p->end;
    munmap(p->end, sizeof *p->end);
    return end;
}
