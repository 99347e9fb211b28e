/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report that was made again, beside what it was. */
#ifndef BR_TABLES_REPEATED_H
#define BR_TABLES_REPEATED_H

#include <jansson.h>

#include "tables/document.h"

struct br_repeated {
    size_t compared, different; /* values */
};

/* Puts what differs between two JSON documents of one report into a document that has begun:
 * numbers beyond the interval or the error that is stated beside them, or beyond round-off;
 * verdicts, words and what one of them does not have. Times of the clock are not compared. */
void br_report_repeated(const json_t *was, const json_t *is, struct br_repeated *found,
                        struct br_document *d);

#endif
