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

/* The beginning of the names of all hidden folders and files. A program locks the hidden folder in
 * which it writes; the lock ends with the program, however that ends. */
#define BR_HIDDEN ".beamrate"

/* The page that every run writes: it belongs to the set of the last run only. */
#define BR_PAGE "report.html"

enum { BR_RUN_ID = 40 };

/* Begin with zeros, or with a stem and zeros. */
struct br_output {
    const char *stem;       /* of the set's files, where a folder has several sets; borrowed;
                               its manifest is then <stem>.manifest.json. NULL: the only one */
    char folder[1024];      /* for the results */
    char staging[1400];     /* where they are written first; "": not open */
    char run[BR_RUN_ID];    /* the name of the run */
    char hidden[280];       /* the name of the hidden folder, */
    char manifest[280];     /* and of the manifest */
    int parent, descriptor; /* the open folder and hidden folder; the latter has the lock */
    size_t made;            /* as of br_make_folders */
};

/* Makes the folder (and its parents) and the hidden one; finishes or removes what other programs
 * left behind. Call it before a long computation. Fails with BR_BAD_INPUT if the folder cannot be
 * written or is in use, or something else has the name of the manifest; with BR_IO if what was left
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

/* Removes what has not been put in place, and the folder if br_output_open made it; does nothing
 * after a commit. */
void br_output_discard(struct br_output *output);

/* Removes or finishes what other programs left behind in an open folder. Fails with BR_IO,
 * BR_BAD_INPUT or BR_NO_MEMORY if it cannot finish. */
enum br_status br_output_sweep(int folder, struct br_error *err);

/* The wanted permissions without those that the umask takes away. No other thread may make files
 * meanwhile. */
mode_t br_new_permissions(mode_t wanted);

/* ---- one file ---- */

/* A file that is written whole or not at all: in memory, then to the disk under a hidden name
 * beside its place, then renamed into it. Begins as zeros. */
struct br_whole_file {
    const char *path; /* as given; borrowed; NULL: not wanted, and all calls do nothing */
    char *place;      /* the path with symbolic links followed; owned; NULL: standard output, a
                         device, or a pipe without a name */
    bool renamed;     /* else it is no plain file, and is written directly */
    int folder;       /* open, if `renamed` */
    FILE *file;       /* to be written */
    char *text;       /* size bytes: what was written; owned */
    size_t size;
};

/* Opens a file for writing; "-", or another name of standard output, is standard output. Call it
 * before a long computation. Fails with BR_BAD_INPUT, naming the option, if the file cannot be
 * written; with BR_NO_MEMORY. Discard it even then. */
enum br_status br_whole_file_open(struct br_whole_file *whole, const char *option, const char *path,
                                  struct br_error *err);

/* Whether two open files would be written to the same path. */
bool br_whole_file_same(const struct br_whole_file *a, const struct br_whole_file *b);

/* Whether the file would replace that of the path, or would be in that folder; none need exist. */
bool br_whole_file_meets(const struct br_whole_file *file, const char *path);

/* Puts the written text in place. Fails with BR_IO or BR_NO_MEMORY. Discard the file afterwards. */
enum br_status br_whole_file_commit(struct br_whole_file *whole, struct br_error *err);

/* Releases it; what has not been put in its place is lost. */
void br_whole_file_discard(struct br_whole_file *whole);

/* ---- shared by output.c, manifest.c and whole_file.c ---- */

/* Writes a file of an open folder, whole or not at all: under a hidden name, which is then renamed.
 * False: errno says why. */
bool br_put_whole(int folder, const char *name, mode_t mode, const char *bytes, size_t count);

/* Whether two files have one name but for what follows its last dot. */
bool br_same_stem(const char *a, const char *b);

/* Closes a descriptor, unless it is -1; errno is kept. */
void br_close(int descriptor);

/* Makes every missing folder of the path. *made (out): the length of the path of the first one that
 * was missing; 0: none was. False: errno says why, and none is left. */
bool br_make_folders(const char *path, mode_t last, size_t *made);

/* ---- the list of the sets in a folder (manifest.json), for output.c ---- */

/* The list is kept as JSON: an array of sets. A set has the run that wrote it and its files. A file
 * has a name, a size and a SHA-256. NULL: no set. */

/* Fails with BR_IO where the system has no random bits. */
enum br_status br_run_id_make(char run[BR_RUN_ID], struct br_error *err);

/* *sets (out, owned by the caller): the new set, that is, the files of an open folder whose names
 * do not begin with a dot; and the old sets that share no name with it. What follows a name's last
 * dot does not count, nor does the page, which old sets lose. Waits until the files are on the
 * disk. Fails with BR_IO or BR_NO_MEMORY. */
enum br_status br_sets_add(int folder, const char *run, const json_t *old, json_t **sets,
                           struct br_error *err);

/* Writes the sets into a file of an open folder, whole or not at all. Fails with BR_IO or
 * BR_NO_MEMORY. */
enum br_status br_sets_write(int folder, const char *name, json_t *sets, struct br_error *err);

/* Reads the sets; *sets (out) is owned by the caller; NULL: there is no such file. Fails with
 * BR_BAD_INPUT if beamrate has not written the file, or with BR_IO or BR_NO_MEMORY. */
enum br_status br_sets_read(int folder, const char *name, json_t **sets, struct br_error *err);

/* The file of that name; NULL: no set has it. And the files of the set that was written last. */
json_t *br_sets_find(const json_t *sets, const char *name);
json_t *br_sets_newest(const json_t *sets);
const char *br_listed_name(const json_t *file);

/* *same (out): whether the file in the open folder has the listed bytes. Fails with BR_IO. */
enum br_status br_listed_compare(int folder, const json_t *file, bool *same, struct br_error *err);

#endif
