/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A check against an earlier one: what has moved, and how serious that is, so that a slow drift is
 * seen before an order breaks. */
#ifndef BR_ORDERS_EXPECTATION_COMPARISON_H
#define BR_ORDERS_EXPECTATION_COMPARISON_H

#include "orders/expectation/check.h"

struct json_t;

enum br_severity {
    BR_SAME,    /* nothing that is worth a line */
    BR_NOTE,    /* moved a little, or new */
    BR_WARNING, /* moved by a quarter of the tolerance, 5 % of a constant, or 1.5 times the cost */
    BR_SERIOUS, /* another scene or method; moved by the whole tolerance, twice the constant; a
                   worse verdict; gone */
};
extern const char *const br_severity_names[];

/* The results of an earlier check: name, data, problem and cost of each scene; norm, order,
 * constant, expectation and verdict of each case. */
struct br_old_check {
    const char *path;       /* of the report; borrowed */
    struct br_check *check; /* count; owned with their cases */
    size_t count;
    const char *version; /* of the program; NULL: not known */
    struct json_t *json; /* owned; its strings are borrowed above; methods.N.KIND has the settings
                            of check N */
};
void br_old_check_clear(struct br_old_check *old);

/* The text of a setting of check i as its report has it, or the usual one where the key is missing;
 * NULL: it is needed, or is no value. buffer: for a number. */
const char *br_old_setting(const struct br_old_check *old, size_t i, enum br_verify_kind kind,
                           const struct br_setting *setting, char buffer[BR_SETTING_USUAL]);

struct br_difference {
    char subject[192];  /* "example1 space l2 axial: order" */
    double before, now; /* NaN: there is none */
    enum br_severity severity;
    char remark[320]; /* or "" */
};

struct br_comparison {
    struct br_difference *difference; /* the most serious first; owned */
    size_t count;
    size_t tally[BR_SERIOUS + 1];
    const char *version; /* of the program then; NULL: not known; borrowed */
};

/* Whether a comparison makes sense, before anything is run: the names of the scenes must differ,
 * and at least one of them must have been there before, of the same problem, with its settings.
 * Fails with BR_BAD_INPUT. */
enum br_status br_compare_check(const struct br_check *checks, size_t count,
                                const struct br_old_check *old, struct br_error *err);

/* Compares the checks with an earlier one. A case that was there before and is not there any more
 * is serious, where its scene is checked now, or where these checks are all there are (`whole`). An
 * expectation that has been loosened is a warning. Fails with BR_NO_MEMORY. */
enum br_status br_compare(const struct br_check *checks, size_t count, bool whole,
                          const struct br_old_check *old, struct br_comparison *comparison,
                          struct br_error *err);
void br_comparison_clear(struct br_comparison *comparison);

#endif
