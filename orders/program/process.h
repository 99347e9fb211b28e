/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program of others, which never outlives this one, and the folder in which it runs. */
#ifndef BR_ORDERS_PROGRAM_PROCESS_H
#define BR_ORDERS_PROGRAM_PROCESS_H

#include <limits.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/types.h>

/* ---- folders ---- */

struct br_run_folder {
    char path[PATH_MAX];
    int file; /* open, and locked where the file system has locks */
};

/* The folder for these folders. */
const char *br_temporary(void);

/* Makes a new folder (out). Returns an errno; 0: it is there, so remove it. */
int br_run_folder_make(struct br_run_folder *folder);

/* Removes the folder with all that is in it, and closes it. Returns true and its path (out), which
 * a program may have changed, where it stays: it is too deep, or closed to writers, or moved. */
bool br_run_folder_stays(struct br_run_folder *folder, char path[PATH_MAX]);

/* Removes the folders of runs that nobody has locked: killed processes left them. */
void br_run_folders_clean(void);

/* Removes a folder with all files in it. Processes that have just been killed may still write for a
 * moment, so it tries several times. */
void br_remove_folder(const char *path);

/* ---- processes ---- */

/* Begins with the members above the number, which are borrowed until the end. */
struct br_process {
    const char *program; /* absolute path */
    char **word, **environment;
    int folder;    /* open; it runs there */
    int output[2]; /* open files for its standard output and error */

    pid_t id;
    int alive;  /* the end of a pipe; the kernel kills the program when it closes */
    int report; /* the end of a pipe, with an errno where the program could not be started */
};

/* Starts the program in a process group of its own, without input, with default signals. The
 * kernel kills the group when this process is gone, by whatever signal, and the program when the
 * thread that called this ends. What leaves the group (setsid, a shell's job control) is not
 * reached. Returns an errno; 0: it was started, so end it. */
int br_process_start(struct br_process *process);

bool br_process_has_ended(const struct br_process *process);

/* Sends a signal to the group. False: all of it is another user's. */
bool br_process_signal(const struct br_process *process, int number);

/* How a program ended. */
struct br_process_end {
    int failure;   /* errno: it was not started; 0: it was */
    bool known;    /* else it still runs, or somebody else was told its exit code */
    bool survives; /* it, or something in its group, cannot be killed: it may be another user's */
    int status;    /* as of wait4 */
    struct rusage usage;
};

/* Kills what is left of the group, and releases what start took. Does not wait for the program. */
struct br_process_end br_process_end(struct br_process *process);

#endif
