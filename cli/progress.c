/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress.h"

#include <pthread.h>
#include <stdio.h>
#include <unistd.h>

#include "cli/signals.h"
#include "solver/clock.h"
#include "study/grid/observer.h"

enum { BAR = 40 };

static struct {
    pthread_mutex_t lock;
    const char *what;
    bool quiet, terminal;
    double start, last; /* s */
    double fraction;    /* of the whole work */
    int tenths;         /* lines told so far */
} progress = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void draw_bar(void)
{
    char bar[BAR + 1];
    for (int i = 0; i < BAR; i++)
        bar[i] = i < progress.fraction * BAR ? '#' : '.';
    bar[BAR] = '\0';
    fprintf(stderr, "\r%s [%s] %3.0f %%, ", progress.what, bar, 100 * progress.fraction);
}

static void show(void *self, double fraction)
{
    (void)self;
    pthread_mutex_lock(&progress.lock);
    progress.fraction = fraction;
    const double t = br_seconds(), elapsed = t - progress.start;
    const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
    if (progress.terminal && t - progress.last >= 0.1) {
        progress.last = t;
        draw_bar();
        fprintf(stderr, "%.0f s left \033[K", left);
    }
    const int tenths = (int)(10 * fraction);
    if (!progress.terminal && tenths > progress.tenths && t - progress.last >= 1) {
        progress.last = t;
        progress.tenths = tenths;
        fprintf(stderr, "%s: %d %%, about %.0f s left\n", progress.what, 10 * tenths, left);
    }
    pthread_mutex_unlock(&progress.lock);
}

/* Nothing is marched until the exact reference is there. Of other scenes' marches, done meanwhile,
 * show tells. */
static void show_waiting(void *self, double share)
{
    (void)self;
    pthread_mutex_lock(&progress.lock);
    const double t = br_seconds();
    if (t - progress.last >= (progress.terminal ? 0.1 : 1)) {
        progress.last = t;
        if (progress.terminal)
            draw_bar();
        else
            fprintf(stderr, "%s: ", progress.what);
        fprintf(stderr, "waits for an exact reference, %.1f %% of its most work%s", 100 * share,
                progress.terminal ? " \033[K" : "\n");
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
    progress.last = progress.terminal ? 0 : progress.start; /* a terminal shows it at once */
    progress.fraction = 0;
    progress.tenths = 0;
    observer = (struct br_observer){
        .progress = quiet ? NULL : show, .stop = stop, .preparing = quiet ? NULL : show_waiting};
    return &observer;
}

void br_progress_end(void)
{
    if (progress.terminal && !progress.quiet)
        fprintf(stderr, "\r\033[K");
}

enum br_status br_progress_result(enum br_status status, struct br_error *err)
{
    return !status && br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : status;
}
