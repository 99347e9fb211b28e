/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finished work that is kept in a folder, one file per entry, so that it is not done again.
 *
 * An entry is named after all that its bytes follow from: a SHA-256 of this executable and this
 * machine, the scene's text, and what the work is. So another version never takes it, nor another
 * machine its times. It is written whole or not at all (a rename), and has the sum of its bytes:
 * what is damaged, or was put under another's name, is not taken, and is counted. */
#ifndef BR_STUDY_KEPT_KEPT_H
#define BR_STUDY_KEPT_KEPT_H

#include <stdatomic.h>
#include <stdbool.h>

#include "study/grid/observer.h"
#include "study/grid/study.h"
#include "study/orders/sha256.h"

struct br_kept {
    char folder[1100]; /* "": nothing is kept */
    bool take;         /* entries that are there; else they are written anew */
    double slice;      /* s of work between two times of writing, */
    double
        most_reference; /* the share of it that the reference may take, which is marched in each */
    struct br_sha256 base; /* executable, machine and scene */
    atomic_size_t taken;   /* cells, trials */
    atomic_size_t bad;     /* entries that were damaged, */
    atomic_size_t lost;    /* or could not be written */
};

/* Entries will be in DIR/.kept, which the first one makes; machine: what this one is. Fails with
 * BR_IO. */
enum br_status br_kept_open(struct br_kept *kept, const char *folder, bool take,
                            const char *machine, struct br_error *err);

/* Adds to what entries follow from, as the scene's text to kept->base. */
void br_kept_add(struct br_sha256 *base, const char *text);

/* The name of an entry for a work that a text describes (out). */
void br_kept_key(const struct br_sha256 *base, const char *work, char key[BR_SHA256_TEXT]);

/* Reads an entry: *bytes (out, *size of them) is owned by the caller. False: it is not there, or is
 * not to be taken. kept: NULL, nothing is. */
bool br_kept_read(struct br_kept *kept, const char *key, void **bytes, size_t *size);

/* The same into so many bytes; another size is no entry of this kind. */
bool br_kept_read_into(struct br_kept *kept, const char *key, void *bytes, size_t size);

/* Writes an entry. Where that fails (a full disk; see errno), the work may go on, and it is
 * counted. kept: NULL, does nothing. */
bool br_kept_write(struct br_kept *kept, const char *key, const void *bytes, size_t size);

/* ---- a method in words ---- */

/* All that a march by a method follows from; returns text (out). */
enum { BR_KEPT_METHOD = 700 };
const char *br_kept_method(const struct br_method *method, char text[BR_KEPT_METHOD]);

/* ---- studies ---- */

/* Like br_lockstep, for prepared studies with study->kept: kept cells are not marched again, and
 * the others are written as soon as their slice is done. Results have the bits of the whole study
 * in one run, if the kept cells are of studies with the same lists of n and k; else they differ by
 * the round-off of the reference, whose meshes and time levels these lists determine. Fails also
 * with BR_IO, where an entry disappears meanwhile. */
enum br_status br_kept_lockstep(struct br_study *studies, size_t count, int threads,
                                const struct br_observer *observer, struct br_error *err);

#endif
