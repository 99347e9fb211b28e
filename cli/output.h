/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results, put in place whole or not at all: a set of files in a folder, or one file.
 *
 * Files are written in a hidden folder, .beamrate, which is locked: a second program that would
 * write there is refused. To commit is to put a manifest (manifest.c) into the hidden folder by
 * one rename. From then on the set is decided:
 *   1. the manifest of the old set is taken away: the folder has no set,
 *   2. the files are renamed into place,
 *   3. what the old manifest lists, the new one does not, and nobody has changed, is removed,
 *   4. the new manifest is renamed into place: the folder has the new set.
 * A program that is ended before that rename leaves the old set, and one that is ended after it
 * leaves the rest to the next one that opens the folder. So a folder with a manifest has all of
 * that set, at every moment. What neither manifest lists is never touched.
 *
 * A folder may have several sets, of several runs. A new one takes the place of those with which it
 * shares a file's name, whatever the formats are; the others stay. */
#ifndef BR_CLI_OUTPUT_H
#define BR_CLI_OUTPUT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "solver/status.h"

/* What the names of all hidden folders and files begin with. Who writes in a hidden folder has
 * locked it; the lock ends with its program, however that ends. */
#define BR_HIDDEN ".beamrate"

/* The page that every run writes: it is that of the run that was last, and of no other set. */
#define BR_PAGE "report.html"

enum { BR_RUN_ID = 40 };

/* Begins as zeros, or with a stem. */
struct br_output {
    const char *stem;       /* of the set's files, where a folder has several sets; borrowed;
                               its manifest is then <stem>.manifest.json. NULL: the only one */
    char folder[1024];      /* where the results will be */
    char staging[1400];     /* where they are being written; "": not open */
    char run[BR_RUN_ID];    /* names the run */
    char hidden[280];       /* the name of the hidden folder, */
    char manifest[280];     /* and of the manifest */
    int parent, descriptor; /* of the two folders, the latter with the lock */
    bool made;              /* the folder was not there before */
};

/* Makes the folder (and its parents) and the hidden one; finishes or removes what others left
 * behind. Fails with BR_BAD_INPUT where the folder cannot be written or is in use, or the place of
 * the manifest is taken, so call it before a long computation; with BR_IO where what was left
 * behind cannot be finished. */
enum br_status br_output_open(struct br_output *output, const char *folder, struct br_error *err);

static inline bool br_output_is_open(const struct br_output *output)
{
    return output->staging[0];
}

/* Opens a file in the hidden folder for writing. Its name must not begin with a dot. */
enum br_status br_output_file(const struct br_output *output, const char *name, FILE **file,
                              struct br_error *err);

/* Closes a written file: fails with BR_IO if any write did (a full disk). */
enum br_status br_output_close(FILE *file, const char *name, struct br_error *err);

/* Puts the set in place of the old one. Where a file in the way is not of the old set (a scene, a
 * person's own), the set is put into a folder beside it that is named after the run, and the call
 * fails with BR_IO, as it does where the disk fails. Fails with BR_INTERRUPTED after a signal. */
enum br_status br_output_commit(struct br_output *output, struct br_error *err);

/* Removes what has not been put in place, and the folder if it was made for nothing; does
 * nothing after a commit. */
void br_output_discard(struct br_output *output);

/* Removes or finishes what others left behind in an open folder. Fails with BR_IO, BR_BAD_INPUT or
 * BR_NO_MEMORY where it cannot be finished. */
enum br_status br_output_sweep(int folder, struct br_error *err);

/* Of these permissions, those that a new file or folder of this program gets. No other thread may
 * make files meanwhile. */
mode_t br_new_permissions(mode_t wanted);

/* ---- one file ---- */

/* A file that is written whole or not at all: in memory, then to the disk under a hidden name
 * beside its place, then renamed into it. Begins as zeros. */
struct br_whole_file {
    const char *path; /* as given; borrowed; NULL: not wanted, and all calls do nothing */
    char *place;      /* where that is, symbolic links followed; owned; NULL: standard output, a
                         device, or a pipe without a name */
    bool renamed;     /* else it is no plain file, and written in place */
    int folder;       /* of one that is renamed, open */
    FILE *file;       /* to be written */
    char *text;       /* size bytes: what was written; owned */
    size_t size;
};

/* Opens a file for writing; "-", or whatever else standard output is, is standard output. Fails
 * with BR_BAD_INPUT, naming the option, where it cannot be written, so call it before a long
 * computation; with BR_NO_MEMORY. Discard it even then. */
enum br_status br_whole_file_open(struct br_whole_file *whole, const char *option, const char *path,
                                  struct br_error *err);

/* Whether two open ones would end in the same place. */
bool br_whole_file_same(const struct br_whole_file *a, const struct br_whole_file *b);

/* Whether it would replace that file, or stand in that folder; neither need be there yet. */
bool br_whole_file_meets(const struct br_whole_file *file, const char *path);

/* Puts what was written in its place. Fails with BR_IO or BR_NO_MEMORY; discard it all the same. */
enum br_status br_whole_file_commit(struct br_whole_file *whole, struct br_error *err);

/* Releases it; what has not been put in its place is lost. */
void br_whole_file_discard(struct br_whole_file *whole);

/* ---- among these files ---- */

/* Writes a file of an open folder, whole or not at all: under a hidden name, which is then renamed.
 * False: errno tells why. */
bool br_put_whole(int folder, const char *name, mode_t mode, const char *bytes, size_t count);

/* Whether two files have one name but for what follows its last dot. */
bool br_same_stem(const char *a, const char *b);

/* Closes a descriptor, unless it is -1; errno is kept. */
void br_close(int descriptor);

/* Makes every folder of the path that is not there yet; *made: whether the last one was not. False:
 * errno tells why. */
bool br_make_folders(const char *path, mode_t last, bool *made);

/* ---- the list of the sets in a folder (manifest.json), for output.c ---- */

/* It is kept as JSON: an array of sets, each with the run that wrote it and its files, each of
 * these with name, size and SHA-256. NULL: no set. */

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

#endif
