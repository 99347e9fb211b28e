/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ordered commit: puts a new set of results in the place of the old one, whole or not at all.
 *
 * The list of a folder, .beamrate-set, says which of its files are results, and which size and time
 * each had when it was written. A new set is first written in a hidden folder inside. Then:
 *
 *   1. All new files go to the disk.        The folder has the old set; the hidden one is rubbish.
 *   2. The new list is renamed into the     This decides. From now on the new set is whole in the
 *      hidden folder.                       two folders together, and every later step can be done
 *                                           again: the hidden folder has what is still to be moved,
 *                                           and the old list what is to be removed.
 *   3. The new files are renamed into the   Each new file is in one of the two folders.
 *      folder.
 *   4. Old files that the new list lacks    The folder has the new files, and no others of ours.
 *      are removed.
 *   5. The new list is renamed over the     The folder has the new set; the hidden one is rubbish.
 *      old one.
 *
 * A program that is ended before step 2 leaves the old set. After one that is ended later, whoever
 * opens the folder next does steps 3 to 5 again. So: a hidden folder with a list is a commit to be
 * finished; without one, the folder's own list is true. All this is done under the folder's lock.
 *
 * A file is as we wrote it if it has the listed size and time. All others, and all that are not
 * listed, belong to somebody: they are neither replaced nor removed. */
#ifndef BR_CLI_COMMIT_H
#define BR_CLI_COMMIT_H

#include <stdbool.h>

#include "base/status.h"

/* The page that every run writes: it belongs to the set of the last run only. */
#define BR_PAGE "report.html"

enum { BR_FILE_NAME = 256 }; /* bytes of a file's name, with its end */

/* Fails with BR_BAD_INPUT if the open folder has a list that is not ours; with BR_IO or
 * BR_NO_MEMORY if it cannot be read. */
enum br_status br_set_check(int folder, struct br_error *err);

/* Steps 1 and 2 for the files in the hidden folder, without those whose names begin with a dot. A
 * folder may have sets of several runs; this one takes the place of those with which it shares a
 * file's name, whatever the formats are. in_way (out): "", or the name of a new file whose place
 * somebody's file has: then nothing is decided. Fails as br_set_check, with BR_IO if the disk
 * fails, and with BR_INTERRUPTED after a signal. */
enum br_status br_set_decide(int folder, int hidden, char in_way[BR_FILE_NAME],
                             struct br_error *err);
bool br_set_is_decided(int hidden);

/* Steps 3 to 5. Fails with BR_IO where the disk does, and with BR_BAD_INPUT if somebody's file is
 * in the way: it can be called again. */
enum br_status br_set_finish(int folder, int hidden, struct br_error *err);

/* Removes the hidden folder and its files: the list first, so that nothing is decided any more. */
void br_set_remove(int folder, const char *hidden_name, int hidden);

#endif
