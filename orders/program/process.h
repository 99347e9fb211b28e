/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program of others, which never outlives this one. */
#ifndef BR_ORDERS_PROGRAM_PROCESS_H
#define BR_ORDERS_PROGRAM_PROCESS_H

#include <limits.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/types.h>

/* How a program ended. */
struct br_process_end {
    char folder[PATH_MAX]; /* it ran there; empty: the folder could not be made */
    bool known;            /* else its keeper was killed */
    int failure;           /* errno: it could not be started; 0: it was */
    int status;            /* as of wait4 */
    struct rusage usage;
};

/* Begins with the members above the keeper set, which are borrowed until the end. */
struct br_process {
    const char *program; /* absolute path */
    char **word, **environment;
    const char *where; /* it runs in a new folder in this one */
    int output[2];     /* open files for its standard output and error */
    const char *const *file; /* files, in its folder, that are copied when it has ended */
    const int *copy;         /* files: open, for the copies */
    size_t files, most;      /* most: bytes of a copy; one more tells that there were more */

    pid_t keeper;
    struct br_process_end *end; /* shared with the keeper */
};

/* Starts the program in a group of its own, without input, with default signals. When it ends, all
 * that it has started is killed, and its folder removed. The same is done when the thread that
 * called this ends, or this process, by any signal. Returns an errno; 0: wait for it. */
int br_process_start(struct br_process *process);

/* Whether it and all that it has started have ended. */
bool br_process_has_ended(const struct br_process *process);

/* Asks the program's group to end (SIGTERM), or kills it and all that it has started. */
void br_process_terminate(const struct br_process *process);
void br_process_kill(const struct br_process *process);

/* Waits for the end, and releases what start took. */
struct br_process_end br_process_wait(struct br_process *process);

/* Removes a folder with all files in it; "": none. Processes that have just been killed may still
 * write for a moment, so it tries several times. */
void br_remove_folder(const char *folder);

#endif
