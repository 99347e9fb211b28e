/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress.h"

#include <pthread.h>
#include <stdio.h>
#include <unistd.h>

#include "cli/signals.h"
#include "solver/clock.h"

enum { BAR = 40 };

static struct {
    pthread_mutex_t lock;
    const char *what;
    bool quiet, terminal;
    double start, last; /* s */
    int tenths;         /* lines told so far */
} progress = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void draw_bar(double fraction, double left)
{
    char bar[BAR + 1];
    for (int i = 0; i < BAR; i++)
        bar[i] = i < fraction * BAR ? '#' : '.';
    bar[BAR] = '\0';
    fprintf(stderr, "\r%s [%s] %3.0f %%, %.0f s left \033[K", progress.what, bar, 100 * fraction,
            left);
}

static void show(void *self, double fraction)
{
    (void)self;
    pthread_mutex_lock(&progress.lock);
    const double t = br_seconds(), elapsed = t - progress.start;
    const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
    if (progress.terminal && t - progress.last >= 0.1) {
        progress.last = t;
        draw_bar(fraction, left);
    }
    const int tenths = (int)(10 * fraction);
    if (!progress.terminal && tenths > progress.tenths && t - progress.last >= 1) {
        progress.last = t;
        progress.tenths = tenths;
        fprintf(stderr, "%s: %d %%, about %.0f s left\n", progress.what, 10 * tenths, left);
    }
    pthread_mutex_unlock(&progress.lock);
}

static bool stop(void *self)
{
    (void)self;
    return br_signals_caught();
}

const struct br_observer *br_progress_start(const char *what, bool quiet)
{
    static struct br_observer observer;
    progress.what = what;
    progress.quiet = quiet;
    progress.terminal = isatty(STDERR_FILENO) == 1;
    progress.start = br_seconds();
    progress.last = progress.start;
    progress.tenths = 0;
    observer = (struct br_observer){.progress = quiet ? NULL : show, .stop = stop};
    return &observer;
}

void br_progress_end(void)
{
    if (progress.terminal && !progress.quiet)
        fprintf(stderr, "\r\033[K");
}
