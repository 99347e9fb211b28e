/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of a set of results: manifest.json names the run that wrote them, and each file with its
 * size and SHA-256. */
#ifndef BR_MANIFEST_H
#define BR_MANIFEST_H

#include <stdbool.h>

#include "cli/sha256.h"
#include "solver/status.h"

enum { BR_RUN_ID = 40 };

/* Begins as zeros. */
struct br_manifest {
    char run[BR_RUN_ID]; /* names the run: when it began, and 64 random bits */
    size_t count;
    struct br_manifest_file {
        char *name; /* owned */
        long long size;
        char sha256[BR_SHA256_TEXT];
    } * file; /* count, in the order of the alphabet; owned */
};

/* Fails with BR_IO where the system has no random bits. */
enum br_status br_run_id_make(char run[BR_RUN_ID], struct br_error *err);

/* Lists the files of an open folder whose names do not begin with a dot, and waits until the disk
 * has them. Fails with BR_IO or BR_NO_MEMORY; clear it even then. */
enum br_status br_manifest_list(int folder, struct br_manifest *manifest, struct br_error *err);

/* Writes it into an open folder, whole or not at all. Fails with BR_IO or BR_NO_MEMORY. */
enum br_status br_manifest_write(int folder, const char *name, const struct br_manifest *manifest,
                                 struct br_error *err);

/* Reads one of an open folder; one that is not there is empty. Fails with BR_BAD_INPUT where the
 * program has not written it; else with BR_IO or BR_NO_MEMORY. Clear it even then. */
enum br_status br_manifest_read(int folder, const char *name, struct br_manifest *manifest,
                                struct br_error *err);

/* The file of that name; NULL: it is not in the set. */
const struct br_manifest_file *br_manifest_find(const struct br_manifest *manifest,
                                                const char *name);

/* *same (out): whether the file in the open folder is as listed, to the byte. Fails with BR_IO. */
enum br_status br_manifest_compare(int folder, const struct br_manifest_file *file, bool *same,
                                   struct br_error *err);

/* Writes all of the bytes, and waits until the disk has them. False: errno tells why. */
bool br_write_whole(int file, const char *bytes, size_t count);

void br_manifest_clear(struct br_manifest *manifest);

#endif
