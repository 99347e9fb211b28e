/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"

/* ---- signals ---- */

static volatile sig_atomic_t caught;

/* A second Ctrl-C, a second or two later, ends the program at once. Before, it is the same request:
 * `timeout` and launchers send their signal twice, to the process and to its group. */
static void remember(int number)
{
    static volatile sig_atomic_t first; /* s */
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!caught) {
        first = (sig_atomic_t)now.tv_sec;
        caught = number;
    } else if ((sig_atomic_t)now.tv_sec - first >= 2) {
        signal(number, SIG_DFL);
        raise(number);
    }
}

void br_signals_install(void)
{
    struct sigaction action = {.sa_handler = remember}, now;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (sigaction(SIGHUP, NULL, &now) == 0 && now.sa_handler != SIG_IGN) /* not under nohup */
        sigaction(SIGHUP, &action, NULL);
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGCHLD, SIG_DFL); /* else the kernel tells no exit codes of programs */
}

bool br_signals_caught(void)
{
    return caught != 0;
}

void br_signals_raise_again(void)
{
    const int number = caught ? caught : SIGINT;
    signal(number, SIG_DFL);
    fflush(stdout); /* it may name results that are written; a second signal ends a full pipe */
    raise(number);
}

/* ---- progress ---- */

/* After less time, s, or less of the work, the time left cannot be estimated. */
static const double least_elapsed = 1, least_fraction = 0.05;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct progress {
    const char *what;
    bool quiet, terminal;
    double start, last; /* s */
    double fraction;    /* of all parts */
    size_t part, parts; /* it works on number `part` of `parts`, from 0 on */
    int tenths;         /* of the work, at the last printed line */
} progress;

/* percent: of the work. A terminal has one line, which is written over. */
static void print_share(double percent)
{
    fprintf(stderr, "%s%s: %.0f %%, ", progress.terminal ? "\r" : "", progress.what, percent);
}

/* Early in the work no time is printed: many tasks start at once, so an estimate would be poor. */
static void print_left(double elapsed, double fraction)
{
    const double left = elapsed * (1 - fraction) / fraction;
    if (!(elapsed >= least_elapsed && fraction >= least_fraction))
        fprintf(stderr, "begun");
    else if (left < 0.5)
        fprintf(stderr, "nearly done");
    else
        fprintf(stderr, "about %.0f s left", left);
}

static void show(void *self, double fraction)
{
    (void)self;
    pthread_mutex_lock(&lock);
    fraction = ((double)progress.part + fraction) / (double)progress.parts;
    progress.fraction = fraction;
    const double t = br_seconds(), waited = t - progress.last;
    const int tenths = (int)(10 * fraction);
    const bool due = progress.terminal ? waited >= 0.1 : tenths > progress.tenths && waited >= 1;
    if (due) {
        progress.last = t;
        progress.tenths = tenths;
        print_share(progress.terminal ? 100 * fraction : 10 * tenths);
        print_left(t - progress.start, fraction);
        fputs(progress.terminal ? " \033[K" : "\n", stderr);
        fflush(stderr);
    }
    pthread_mutex_unlock(&lock);
}

/* share: of the most work that it may take; mostly it takes far less, so no time is printed. The
 * line fits in 40 columns. A log has it once. */
static void print_wait(double share)
{
    static bool said;
    if (progress.terminal)
        fprintf(stderr, "exact reference: %.1f %% \033[K", 100 * share);
    else if (!said)
        fprintf(stderr, "%s: computing the exact reference\n", progress.what);
    said = true;
}

/* The scene's marches wait for its exact reference. `show` prints the marches of others. */
static void show_waiting(void *self, double share)
{
    (void)self;
    pthread_mutex_lock(&lock);
    const double t = br_seconds();
    if (t - progress.last >= (progress.terminal ? 0.1 : 1)) {
        progress.last = t;
        if (progress.terminal)
            print_share(100 * progress.fraction);
        print_wait(share);
        fflush(stderr);
    }
    pthread_mutex_unlock(&lock);
}

static void warn(void *self, const char *what)
{
    (void)self;
    pthread_mutex_lock(&lock);
    fprintf(stderr, "%sbeamrate: warning: %s\n",
            progress.terminal && !progress.quiet ? "\r\033[K" : "", what);
    pthread_mutex_unlock(&lock);
}

static bool stop(void *self)
{
    (void)self;
    return br_signals_caught();
}

void br_progress_part(size_t i, size_t parts)
{
    progress.part = i;
    progress.parts = parts;
}

const struct br_observer *br_progress_start(const char *what, bool quiet)
{
    static const struct br_observer shown = {show, stop, NULL, show_waiting, warn},
                                    silent = {.stop = stop, .warn = warn};
    const bool terminal = isatty(STDERR_FILENO) == 1;
    const double t = br_seconds();
    progress =
        (struct progress){.what = what,
                          .quiet = quiet,
                          .terminal = terminal,
                          .start = t,
                          .last = terminal ? 0 : t, /* a terminal gets the first line at once */
                          .parts = 1};
    return quiet ? &silent : &shown;
}

void br_progress_end(void)
{
    if (progress.terminal && !progress.quiet)
        fprintf(stderr, "\r\033[K");
    fflush(stderr);
}

enum br_status br_progress_result(enum br_status status, struct br_error *err)
{
    return !status && br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : status;
}
