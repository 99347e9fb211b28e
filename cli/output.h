/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results, put in place whole or not at all: a set of files in a folder, or one file.
 *
 * A folder holds one set. Its manifest, .beamrate-set, names the files of the set. A program that
 * writes a set locks the file .beamrate-lock of the folder, and writes in the hidden folder
 * .beamrate-new inside. Then:
 *
 *   1. All new files go to the disk.        The folder has the old set; the hidden one is rubbish.
 *   2. The new manifest is renamed into     This decides. From now on the new set is whole in the
 *      the hidden folder.                   two folders together, and every later step can be done
 *                                           again: the hidden folder has what is still to be moved,
 *                                           and the old manifest what is to be removed.
 *   3. The new files are renamed into the   Each new file is in one of the two folders.
 *      folder.
 *   4. Old files that the new manifest      The folder has the new files, and no others of ours.
 *      lacks are removed.
 *   5. The new manifest is renamed over     The folder has the new set; the hidden one is rubbish.
 *      the old one.
 *
 * A program that is ended before step 2 leaves the old set. After one that is ended later, whoever
 * opens the folder next does steps 3 to 5 again. So: a hidden folder with a manifest is a commit to
 * be finished; without one, the folder's own manifest is true.
 *
 * Files that no manifest names belong to somebody: they are neither replaced nor removed. */
#ifndef BR_CLI_OUTPUT_H
#define BR_CLI_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/status.h"

/* Begins with zeros. */
struct br_output {
    char folder[1024];      /* for the results */
    char staging[1400];     /* where they are written first; "": not open */
    int parent, descriptor; /* the open folder and hidden folder; -1: not open */
    int lock;               /* the open file that is locked; -1: not open */
    size_t made;            /* of the path of the first folder that was missing; 0: none was */
    size_t replaced;        /* files of the old set that the new one has, too */
    size_t removed;         /* files of the old set that the new one lacks */
};

/* Makes the folder (and its parents) and the hidden one; finishes or removes what an ended program
 * left behind. Call it before a long computation. Fails with BR_BAD_INPUT if the folder cannot be
 * written or is in use, if its manifest is not ours, or if somebody's file is in the way of a
 * commit that has to be finished; with BR_IO where the disk fails. */
enum br_status br_output_open(struct br_output *output, const char *folder, struct br_error *err);

static inline bool br_output_is_open(const struct br_output *output)
{
    return output->staging[0];
}

/* Opens a new file in the hidden folder for writing. Its name must not begin with a dot. Fails with
 * BR_BAD_INPUT if another result has the name. */
enum br_status br_output_file(const struct br_output *output, const char *name, FILE **file,
                              struct br_error *err);

/* Closes a written file: fails with BR_IO if any write did (a full disk). */
enum br_status br_output_close(FILE *file, const char *name, struct br_error *err);

/* Puts the set in place of the old one. Where somebody's file is in the way, the new set is put
 * into a folder beside it, set-1 or the next number, and the call fails with BR_IO, as it does
 * where the disk fails. Fails with BR_INTERRUPTED after a signal. */
enum br_status br_output_commit(struct br_output *output, struct br_error *err);

/* Removes what has not been put in place, and the folder if br_output_open made it; does nothing
 * after a commit. */
void br_output_discard(struct br_output *output);

/* ---- one file ---- */

/* A file that is written whole or not at all: in memory, then to the disk under a hidden name
 * beside its place, then renamed into it. Begins as zeros. */
struct br_whole_file {
    const char *path; /* as given; borrowed; NULL: not wanted, and all calls do nothing */
    char *place;      /* the path with symbolic links followed; owned; NULL: standard output or
                         error, a device, or a pipe without a name */
    bool renamed;     /* else it is no plain file, or is open already, and is written directly */
    FILE *file;       /* to be written */
    char *text;       /* size bytes: what was written; owned */
    size_t size;
};

/* Opens a file for writing; "-" is standard output. What the program was given open, as standard
 * output, standard error or another descriptor, is written to where it stands. Call it
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

/* Writes a file, whole or not at all; its path has a folder. mode 0: the permissions of a new file.
 * False: errno says why. */
bool br_put_whole(const char *path, mode_t mode, const char *bytes, size_t count);

#endif
