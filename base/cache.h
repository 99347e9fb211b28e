/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cache: finished work in a folder, one file per entry, so that it is not done again.
 *
 * An entry belongs to one text, which states the whole request (base/statement.h). Its name
 * is the SHA-256 of that text, and its file has the text, the numbers, and a sum of both. It is
 * written whole or not at all (a rename). What is damaged, stands under another's name, or has a
 * number out of its range is not taken. */
#ifndef BR_BASE_CACHE_H
#define BR_BASE_CACHE_H

#include <stdbool.h>

#include "base/observer.h"
#include "base/sha256.h"
#include "base/statement.h"
#include "base/status.h"
#include "base/text.h"

struct br_cache {
    char folder[1100]; /* "": no cache */
    bool take;         /* entries that are there; else they are written anew */
};

/* ---- entries: text.h has their numbers ---- */

/* Reads the entry of a text into *self (out; means nothing where it fails). False: it is not there,
 * or is not to be taken. cache or text NULL: nothing is. */
bool br_cache_take(const struct br_cache *cache, const char *text, br_record_pass *pass,
                   void *self);

/* Writes an entry, but no wrong one. False where that fails (a full disk; see errno). cache NULL:
 * does nothing. */
bool br_cache_put(const struct br_cache *cache, const char *text, br_record_pass *pass, void *self);

/* Whether this process has put an entry into a cache, or taken one. */
bool br_cache_has_work(void);

#endif
