/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run of a program: its process, its folder, its limits, and the numbers that it prints. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/quote.h"
#include "orders/program/process.h"
#include "orders/request.h"

enum {
    TAIL = 301,             /* bytes of a failed run's last lines, with the zero at the end */
    MOST_PRINTED = 1 << 24, /* bytes of a run */
    GRACE = 2,              /* s from SIGTERM to SIGKILL, and from that until nobody waits for what
                               cannot be killed, */
    PATIENCE = 30           /* or for what does not end: a device or a disk holds it */
};

enum end { BY_ITSELF, STOPPED, TOO_LONG, TOO_MUCH };

struct program_run {
    const struct br_orders_request *request;
    const struct br_command_words *words;
    struct br_run_folder folder;
    struct br_process process;
    double own_peak; /* of this process when the run began, bytes */
    double wall;     /* s */
    enum end end;
    struct br_process_end how;
};

/* ---- its process ---- */

/* The usual environment, but with LC_ALL=C; owned, though its texts are not. NULL: no memory. */
static char **make_environment(void)
{
    static char plain[] = "LC_ALL=C";
    size_t count = 0, taken = 0;
    while (environ[count])
        count++;
    char **environment = br_allocate(count + 2, sizeof *environment);
    for (size_t i = 0; i < count && environment; i++)
        if (strncmp(environ[i], "LC_ALL=", 7) != 0)
            environment[taken++] = environ[i];
    if (environment)
        environment[taken] = plain;
    return environment;
}

static enum br_status cannot_run(const struct program_run *r, int failure, struct br_error *err)
{
    const bool wrong = failure == ENOENT || failure == ENOEXEC || failure == EACCES;
    return br_fail(err, wrong ? BR_BAD_INPUT : BR_IO, "%.900s cannot be run: %s%s",
                   r->words->program, strerror(failure),
                   failure == ENOENT ? " (its interpreter?)" : "");
}

static enum br_status start(struct program_run *r, struct br_error *err)
{
    struct rusage own;
    for (int i = 0; i < 2; i++) {
        /* A file without a name, which the program cannot find in its folder. */
        r->process.output[i] = memfd_create("printed", MFD_CLOEXEC);
        if (r->process.output[i] < 0 || fcntl(r->process.output[i], F_SETFL, O_APPEND) != 0)
            return br_fail(err, BR_IO, "no file for what a program prints: %s", strerror(errno));
    }
    r->process.folder = r->folder.file;
    r->process.program = r->words->program;
    r->process.word = r->words->word;
    r->process.environment = make_environment();
    const int failure = r->process.environment ? br_process_start(&r->process) : ENOMEM;
    free(r->process.environment);
    /* The kernel counts memory of this process that the child had before it became the program. */
    getrusage(RUSAGE_SELF, &own);
    r->own_peak = 1024.0 * (double)own.ru_maxrss;
    return failure == ENOMEM ? br_no_memory(err, "a program")
           : failure         ? cannot_run(r, failure, err)
                             : BR_OK;
}

static size_t size_of(int file)
{
    struct stat info;
    return fstat(file, &info) == 0 ? (size_t)info.st_size : SIZE_MAX;
}

static bool prints_too_much(const struct program_run *r)
{
    return size_of(r->process.output[0]) > MOST_PRINTED ||
           size_of(r->process.output[1]) > MOST_PRINTED;
}

/* Why a run must be ended; BY_ITSELF: it need not be. */
static enum end end_of(const struct program_run *r, double wall)
{
    if (br_observer_stops(r->request->observer))
        return STOPPED;
    if (r->end)
        return r->end;
    return prints_too_much(r) ? TOO_MUCH : wall > r->request->seconds ? TOO_LONG : BY_ITSELF;
}

/* Waits for the end, or brings it. What cannot be killed is left after a while. begun: s, before
 * the start, behind which this program may wait for a processor. */
static void watch(struct program_run *r, double begun)
{
    double asked = INFINITY; /* when it was asked to end, s */
    bool ours = true;
    while (!br_process_has_ended(&r->process) &&
           br_seconds() - asked < (ours ? PATIENCE : 2 * GRACE)) {
        const double now = br_seconds();
        r->end = end_of(r, now - begun);
        const bool first = r->end && isinf(asked);
        asked = first ? now : asked;
        if (r->end == TOO_LONG && first) /* not twice: some programs then do not clean up */
            br_process_signal(&r->process, SIGTERM);
        else if (r->end && (r->end != TOO_LONG || now - asked > GRACE))
            ours = br_process_signal(&r->process, SIGKILL);
        /* so that its end is known to some percent */
        const double pause = fmin(fmax(0.02 * (now - begun), 1e-4), 0.016);
        nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * pause)}, NULL);
    }
    r->wall = br_seconds() - begun;
    r->how = br_process_end(&r->process);
    if (!r->end && prints_too_much(r))
        r->end = TOO_MUCH;
}

/* ---- what is left of it ---- */

__attribute__((format(printf, 2, 3))) static void warn(const struct program_run *r,
                                                       const char *format, ...)
{
    const struct br_observer *o = r->request->observer;
    char text[PATH_MAX + 200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (o && o->warn)
        o->warn(o->self, text);
}

static void clean(struct program_run *r)
{
    char path[PATH_MAX];
    if (r->how.survives)
        warn(r,
             "a run cannot be killed, perhaps since it is another user's now; its process group "
             "%ld is left",
             (long)r->process.id);
    if (br_run_folder_stays(&r->folder, path))
        warn(r, "the folder of a run could not be removed, and is left: %s", path);
    for (int i = 0; i < 2; i++)
        if (r->process.output[i] >= 0)
            close(r->process.output[i]);
}

/* ---- its output ---- */

/* The last three lines of a file, quoted, or as much of them as `shown` has room for. */
static void last_lines(int file, char shown[TAIL])
{
    char text[TAIL];
    const size_t size = size_of(file), from = size < TAIL ? 0 : size - (TAIL - 1);
    ssize_t length = pread(file, text, TAIL - 1, (off_t)from);
    while (length > 0 && strchr(" \t\r\n", text[length - 1]))
        length--;
    text[length > 0 ? length : 0] = '\0';
    char *begin = text;
    for (ssize_t i = length - 1, lines = 1; i >= 0; i--) {
        if (text[i] == '\0')
            text[i] = '?';
        if (text[i] == '\n' && begin == text && lines++ == 3)
            begin = text + i + 1;
    }
    while ((*begin & 0xc0) == 0x80) /* the end of a character whose start is cut off */
        begin++;
    br_quoted(shown, TAIL, &br_for_text, begin);
}

enum br_status br_run_failed(const struct br_orders_request *request, struct br_numbers_row *row,
                             struct br_error *err, const char *format, ...)
{
    char *why;
    va_list arguments;
    for (size_t i = 0; i < request->readings; i++)
        row->number[i] = (double)NAN;
    for (int axis = 0; axis < BR_AXES; axis++)
        row->given[axis] = NAN;
    va_start(arguments, format);
    if (vasprintf(&why, format, arguments) < 0)
        why = NULL;
    va_end(arguments);
    free(row->failure);
    row->failure = why;
    err->status = BR_OK;
    return why ? BR_OK : br_no_memory(err, "why a run failed");
}

/* why: what was wrong with its numbers. */
static enum br_status fail_row(const struct program_run *r, const char *why,
                               struct br_numbers_row *row, struct br_error *err)
{
    const int status = r->how.status;
    char what[sizeof err->message], tail[TAIL];
    if (r->end == TOO_LONG)
        snprintf(what, sizeof what, "it did not end within %g s%s", r->request->seconds,
                 r->how.survives ? ", and cannot be killed" : "");
    else if (r->end == TOO_MUCH)
        snprintf(what, sizeof what, "it printed more than %d MiB", MOST_PRINTED >> 20);
    else if (WIFSIGNALED(status))
        snprintf(what, sizeof what, "signal %d (%s)", WTERMSIG(status),
                 strsignal(WTERMSIG(status)));
    else if (WEXITSTATUS(status) != 0)
        snprintf(what, sizeof what, "exit code %d", WEXITSTATUS(status));
    else
        snprintf(what, sizeof what, "%s", why);
    last_lines(r->process.output[1], tail);
    if (!*tail)
        last_lines(r->process.output[0], tail);
    return br_run_failed(r->request, row, err, "%s; %s%s", what,
                         *tail ? "it printed: " : "it printed nothing", tail);
}

/* *text (out, owned): all of a plain file; empty where it is none. */
static enum br_status load(int file, char **text, size_t *length, struct br_error *why)
{
    struct stat info;
    const bool plain = file >= 0 && fstat(file, &info) == 0 && S_ISREG(info.st_mode);
    const size_t size = plain ? (size_t)info.st_size : 0;
    ssize_t got = 1;
    if (size > MOST_PRINTED)
        return br_fail(why, BR_BAD_INPUT, "a file of it has more than %d MiB", MOST_PRINTED >> 20);
    if (!(*text = br_allocate(size + 1, 1)))
        return br_no_memory(why, "a program's output");
    for (; *length < size && got > 0; *length += got > 0 ? (size_t)got : 0)
        got = pread(file, *text + *length, size - *length, (off_t)*length);
    return got >= 0 ? BR_OK : br_fail(why, BR_IO, "a program's output: %s", strerror(errno));
}

/* Reads the numbers of a run: its quantities, and the resolutions that it states itself. */
static enum br_status read_numbers(const struct program_run *r, struct br_numbers_row *row,
                                   struct br_error *why)
{
    const struct br_orders_request *q = r->request;
    enum br_status status = BR_OK;
    for (size_t i = 0, file = 0, quantity = 0; i < q->readings && !status; i++) {
        const struct br_reading *reading = &q->reading[i];
        const struct br_resolution_column *size = br_resolution_column_find(reading->name);
        double *number = size ? &row->given[size->axis] : &row->number[quantity++];
        char *text = NULL;
        size_t length = 0;
        const int own = !reading->file ? -1
                                       : openat(r->folder.file, r->words->file[file++],
                                                O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
        status =
            load(reading->file ? own : r->process.output[reading->complaints], &text, &length, why);
        if (own >= 0)
            close(own);
        if (!status)
            status = br_reading_take(q, i, text, length, number, why);
        if (!status && size && !(*number > 0))
            status = br_fail(why, BR_BAD_INPUT, "%s: found %g, expected a number above 0",
                             reading->name, *number);
        free(text);
    }
    return status;
}

static enum br_status finish(const struct program_run *r, struct br_numbers_row *row,
                             struct br_error *err)
{
    struct br_error why = {0};
    const struct timeval *user = &r->how.usage.ru_utime, *system = &r->how.usage.ru_stime;
    const double peak = 1024.0 * (double)r->how.usage.ru_maxrss;
    if (r->end == STOPPED)
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (r->how.failure)
        return cannot_run(r, r->how.failure, err);
    if (!r->how.known && !r->how.survives)
        return br_fail(err, BR_IO, "the exit code of a program is not known (SIGCHLD is ignored)");
    row->seconds =
        (double)(user->tv_sec + system->tv_sec) + 1e-6 * (double)(user->tv_usec + system->tv_usec);
    row->wall = r->wall;
    row->bytes = peak > r->own_peak ? peak : (double)NAN;
    if (!r->end && WIFEXITED(r->how.status) && WEXITSTATUS(r->how.status) == 0) {
        const enum br_status status = read_numbers(r, row, &why);
        if (status != BR_BAD_INPUT)
            return status ? br_fail(err, status, "%s", why.message) : BR_OK;
    }
    return fail_row(r, why.message, row, err);
}

/* ---- all ---- */

enum br_status br_run_command(const struct br_orders_request *request,
                              const struct br_command_words *words, struct br_numbers_row *row,
                              struct br_error *err)
{
    struct program_run r = {.request = request, .words = words, .process.output = {-1, -1}};
    const int failure = br_run_folder_make(&r.folder);
    if (failure)
        return br_fail(err, BR_IO, "%.900s: no folder to run a program in: %s", br_temporary(),
                       strerror(failure));
    const double begun = br_seconds();
    enum br_status status = start(&r, err);
    if (!status) {
        watch(&r, begun);
        status = finish(&r, row, err);
    }
    clean(&r);
    return status;
}
