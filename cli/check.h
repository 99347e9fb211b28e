/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of `check`: study files of any program, and what else a program can check. */
#ifndef BR_CLI_CHECK_H
#define BR_CLI_CHECK_H

#include "base/observer.h"
#include "cli/session.h"
#include "orders/expectation/check.h"

/* Sources that are no study files: scenes. Each function gets `self`. */
struct br_other_sources {
    void *self;
    /* The path (out) of a source by its name. */
    enum br_status (*find)(const char *name, char *path, size_t size, struct br_error *err);
    /* Reads a source, and begins its check (out). path: borrowed. */
    enum br_status (*read)(void *self, const char *path, const char *text, struct br_check *check,
                           struct br_error *err);
    /* After all are read: refuses options that none of them uses, and says how long it will take.
     */
    enum br_status (*begin)(void *self, struct br_error *err);
    void (*warn)(void *self);
    enum br_status (*run)(void *self, int threads, const struct br_observer *observer,
                          struct br_error *err);
};

/* Checks `count` sources and writes the verdicts. whole: they are all that there are. other: NULL,
 * there are study files alone; else it is used until the end of the call. */
enum br_status br_check_sources(const struct br_options *options, struct br_session *session,
                                char *const *name, size_t count, bool whole,
                                const struct br_other_sources *other, struct br_error *err);

#endif
