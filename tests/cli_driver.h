/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs the program as a user does, in a folder of its own. $BEAMRATE is its path. */
#ifndef BR_TESTS_CLI_DRIVER_H
#define BR_TESTS_CLI_DRIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/resource.h>

enum { CLI_MOST_OUTPUT = 1 << 16, CLI_MOST_WORDS = 32 };

/* The environment in which the program is run. */
struct cli_circumstances {
    const char *path;    /* PATH; NULL: as it is */
    const char *data;    /* BEAMRATE_DATA; NULL: as it is */
    rlim_t file_size;    /* largest file, bytes; 0: any */
    int interrupt_after; /* ms after it begins to catch signals; 0: never */
    const char *errors;  /* the file that standard error goes to; NULL: to the output */
};

struct cli_outcome {
    int exit_code;                /* or -signal */
    char output[CLI_MOST_OUTPUT]; /* standard output and, by default, error */
};

/* Runs `beamrate word...` (NULL-terminated); circumstances NULL: the usual ones. */
void cli_run(const char *const *word, const struct cli_circumstances *c, struct cli_outcome *out);

/* Runs a line that is split at single blanks; a word of '' is empty. */
void cli_run_line(const char *line, const struct cli_circumstances *c, struct cli_outcome *out);

/* Runs a line, and checks its exit code and that its output contains the text. */
void cli_expect(const char *line, const struct cli_circumstances *c, int exit_code,
                const char *message);

/* The working folder of every run, and files in it. */
const char *cli_folder(void);
void cli_path(const char *name, char path[512]);
bool cli_is_there(const char *name);
size_t cli_count_files(const char *name); /* hidden ones too; no list of sets, no .cache */
void cli_write_file(const char *name, const char *text);
const char *cli_read(const char *name); /* its first 256 KiB, until the next call */

/* Set-up and tear-down of a group of tests. */
int cli_make_folder(void **state);
int cli_remove_folder(void **state);

#endif
