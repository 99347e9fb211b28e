/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finished work that is kept in a folder, one file per entry, so that it is not done again.
 *
 * An entry belongs to one text, which states the whole request (base/statement.h). Its name
 * is the SHA-256 of that text, and its file has the text, the numbers, and a sum of both. It is
 * written whole or not at all (a rename). What is damaged, stands under another's name, or has a
 * number out of its range is not taken, and is counted. */
#ifndef BR_BASE_KEPT_H
#define BR_BASE_KEPT_H

#include <stdatomic.h>
#include <stdbool.h>

#include "base/observer.h"
#include "base/sha256.h"
#include "base/statement.h"
#include "base/status.h"
#include "base/text.h"

struct br_kept {
    char folder[1100]; /* "": nothing is kept */
    bool take;         /* entries that are there; else they are written anew */
    double slice;      /* s of work between two times of writing, */
    double
        most_reference; /* the share of it that the reference may take, which is marched in each */
    char program[BR_SHA256_TEXT]; /* the sum of the executable; "": entries are of any version */
    const char *machine;          /* what this one is, borrowed; NULL: entries are of any */
    atomic_size_t taken;          /* cells, trials */
    atomic_size_t bad;            /* entries that were damaged, */
    atomic_size_t lost;           /* or could not be written */
};

/* Entries will be in DIR/.kept, which the first one makes. Fails with BR_IO. */
enum br_status br_kept_open(struct br_kept *kept, const char *folder, bool take,
                            const char *machine, struct br_error *err);

/* Begins the text of an entry: program and machine, and what work it is of ("trial"). */
void br_kept_begin(const struct br_kept *kept, const char *work, struct br_statement *text);

/* ---- entries: text.h has their numbers ---- */

/* Reads the entry of a text into *self (out; means nothing where it fails). False: it is not there,
 * or is not to be taken. kept or text NULL: nothing is. */
bool br_kept_take(struct br_kept *kept, const char *text, br_record_pass *pass, void *self);

/* Writes an entry, but no wrong one. Where that fails (a full disk; see errno), the work may go on,
 * and it is counted. kept NULL: does nothing. */
bool br_kept_put(struct br_kept *kept, const char *text, br_record_pass *pass, void *self);

#endif
