/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of the sets of results in a folder: manifest.json names for each set the run that wrote
 * it, and each file with its size and SHA-256. */
#ifndef BR_CLI_MANIFEST_H
#define BR_CLI_MANIFEST_H

#include <jansson.h>
#include <stdbool.h>

#include "cli/sha256.h"
#include "solver/status.h"

enum { BR_RUN_ID = 40 };

/* The page that every run writes: it is that of the run that was last, and of no other set. */
#define BR_PAGE "report.html"

/* Begins as zeros. */
struct br_manifest {
    json_t *sets; /* an array, as it is in the file; owned; NULL: none */
    size_t count;
    struct br_manifest_file {
        char *name; /* owned */
        long long size;
        char sha256[BR_SHA256_TEXT];
        size_t set; /* that it belongs to */
    } * file;       /* count, of all sets; owned */
};

/* Fails with BR_IO where the system has no random bits. */
enum br_status br_run_id_make(char run[BR_RUN_ID], struct br_error *err);

/* Lists a new set after those of the old manifest with which it shares no name (but for what
 * follows a name's last dot; the page does not count, they lose it): the files of an open folder
 * whose names do not begin with a dot; and waits until the disk has them. Fails with BR_IO or
 * BR_NO_MEMORY; clear it even then. */
enum br_status br_manifest_list(int folder, const char *run, const struct br_manifest *old,
                                struct br_manifest *manifest, struct br_error *err);

/* Writes it into an open folder, whole or not at all. Fails with BR_IO or BR_NO_MEMORY. */
enum br_status br_manifest_write(int folder, const char *name, const struct br_manifest *manifest,
                                 struct br_error *err);

/* Reads one of an open folder; one that is not there is empty. Fails with BR_BAD_INPUT where the
 * program has not written it; else with BR_IO or BR_NO_MEMORY. Clear it even then. */
enum br_status br_manifest_read(int folder, const char *name, struct br_manifest *manifest,
                                struct br_error *err);

/* The file of that name; NULL: it is in no set. */
const struct br_manifest_file *br_manifest_find(const struct br_manifest *manifest,
                                                const char *name);

/* *same (out): whether the file in the open folder is as listed, to the byte. Fails with BR_IO. */
enum br_status br_manifest_compare(int folder, const struct br_manifest_file *file, bool *same,
                                   struct br_error *err);

/* Writes all of the bytes, and waits until the disk has them. False: errno tells why. */
bool br_write_whole(int file, const char *bytes, size_t count);

/* Whether the file is of the set that was written last. */
bool br_manifest_newest(const struct br_manifest *manifest, const struct br_manifest_file *file);

void br_manifest_clear(struct br_manifest *manifest);

#endif
