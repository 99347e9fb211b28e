/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns of errors that others have published, with the order that the same source states of each:
 * tests/data/published.txt. */
#ifndef BR_TESTS_LAB_PUBLISHED_H
#define BR_TESTS_LAB_PUBLISHED_H

#include "tests/lab/errors.h"

enum { BR_MOST_PUBLISHED = 256, BR_PUBLISHED_NAME = 80 };

/* Which ones were looked at while the priors of the laws were chosen, which were chosen before any
 * of them was tried, and which before the mixture of laws was. */
enum br_published_group { BR_PUBLISHED_FIRST, BR_PUBLISHED_LATER, BR_PUBLISHED_LAST };

struct br_published {
    enum br_published_group group;
    char name[BR_PUBLISHED_NAME];
    struct br_error_line line;
};

/* Reads all columns; returns how many, 0 where the file is not as it has to be. */
size_t br_published_read(struct br_published column[BR_MOST_PUBLISHED]);

#endif
