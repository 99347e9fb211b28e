/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of the sets of results in a folder (manifest.json), for output.c. It is kept as JSON: an
 * array of sets, each with the run that wrote it and its files, each of these with name, size and
 * SHA-256. NULL: no set. */
#ifndef BR_CLI_MANIFEST_H
#define BR_CLI_MANIFEST_H

#include <jansson.h>
#include <stdbool.h>

#include "solver/status.h"

enum { BR_RUN_ID = 40 };

/* Fails with BR_IO where the system has no random bits. */
enum br_status br_run_id_make(char run[BR_RUN_ID], struct br_error *err);

/* *sets (out, owned by the caller): the old sets with which a new one shares no name (but for what
 * follows a name's last dot; the page does not count, they lose it), and that one: the files of an
 * open folder whose names do not begin with a dot; and waits until the disk has them. Fails with
 * BR_IO or BR_NO_MEMORY. */
enum br_status br_sets_add(int folder, const char *run, const json_t *old, json_t **sets,
                           struct br_error *err);

/* Writes them into a file of an open folder, whole or not at all. Fails with BR_IO or BR_NO_MEMORY.
 */
enum br_status br_sets_write(int folder, const char *name, json_t *sets, struct br_error *err);

/* Reads them; *sets (out) is owned by the caller, NULL where there is no such file. Fails with
 * BR_BAD_INPUT where the program has not written it; else with BR_IO or BR_NO_MEMORY. */
enum br_status br_sets_read(int folder, const char *name, json_t **sets, struct br_error *err);

/* The file of that name; NULL: it is in no set. The files of the set that was written last. */
json_t *br_sets_find(const json_t *sets, const char *name);
json_t *br_sets_newest(const json_t *sets);
const char *br_listed_name(const json_t *file);

/* *same (out): whether the file in the open folder is as listed, to the byte. Fails with BR_IO. */
enum br_status br_listed_compare(int folder, const json_t *file, bool *same, struct br_error *err);

/* Writes all of the bytes, and waits until the disk has them. False: errno tells why. */
bool br_write_whole(int file, const char *bytes, size_t count);

#endif
