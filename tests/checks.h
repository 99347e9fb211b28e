/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all test programs share. A check that fails ends its test with a message; no check passes on
 * NaN. */
#ifndef BR_TESTS_CHECKS_H
#define BR_TESTS_CHECKS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"
#include "tests/test.h"

/* Of the last call of a test that failed. */
/* Its symbol is another one than that of the C library's function, which gold takes for the same.
 */
extern _Thread_local struct br_error err __asm__("br_test_err");

/* |actual - expected| <= tolerance; `what` goes into the message. */
#define CLOSE(actual, expected, tolerance) \
    br_test_close(#actual, actual, expected, tolerance, __FILE__, __LINE__)
#define AT_MOST(actual, limit) br_test_at_most(#actual, actual, limit, __FILE__, __LINE__)
/* The call's status is BR_OK; else the error's message is shown. */
#define MUST(call) br_test_must(call, &err, #call, __FILE__, __LINE__)
/* The call is refused with the status, and its message contains the text. This error is then
 * judged: the next refusal needs one of its own. */
#define REFUSED(call, status, text) \
    br_test_refused(call, status, &err, text, #call, __FILE__, __LINE__)

/* A variable that is cleared, or freed, at the end of its block; from the last one to the first.
 *     OWNED(br_numbers) numbers = read("h,l2\n1,1\n"); */
#define OWNED(type) __attribute__((cleanup(type##_clear))) struct type
#define FREED __attribute__((cleanup(br_test_free)))

void br_test_free(void *pointer); /* a pointer to one */

void br_test_close(const char *what, double actual, double expected, double tolerance,
                   const char *file, int line);
void br_test_at_most(const char *what, double actual, double limit, const char *file, int line);
void br_test_must(enum br_status status, const struct br_error *why, const char *what,
                  const char *file, int line);
void br_test_refused(enum br_status status, enum br_status expected, struct br_error *why,
                     const char *text, const char *what, const char *file, int line);

/* A reproducible generator: SplitMix64 (Steele, Lea and Flood 2014). */
struct br_test_random {
    uint64_t state;
};
double br_test_uniform(struct br_test_random *random, double low, double high);
double br_test_log_uniform(struct br_test_random *random, double low, double high);
double br_test_decades(struct br_test_random *random, double low, double high); /* 10^x */
size_t br_test_index(struct br_test_random *random, size_t count);              /* 0 .. count - 1 */
bool br_test_once_in(struct br_test_random *random, size_t times); /* with probability 1/times */

/* A generator for item `index` of a seed, independent of the draws for other items. */
struct br_test_random br_test_random_of(uint64_t seed, size_t index);

/* The path of a file, one a program, that now has this text: a scene or another input. */
const char *br_test_scene_file(const char *text);

/* Separates the first cell of a row from the rest, at " | "; returns the rest, or "". */
char *br_test_part(char *row);

/* Replaces each \n in the text by a line's end, in place; returns the text. */
char *br_test_unescape(char *text);

/* Calls `check` for each row of a section of data/text_refusals.txt. */
void br_test_rows(const char *section, void (*check)(char *row));

/* Fails every allocation of an attempt in turn: at least `least` attempts fail, and each says so (a
 * few allocations can be done without). attempt: allocates, and cleans up after itself whatever
 * happens. */
void br_test_without_memory(enum br_status (*attempt)(const void *data, struct br_error *why),
                            const void *data, long least);

/* Compares the printed text with golden/made/NAME.txt: they must agree to the byte, but numbers may
 * differ by the relative tolerance. With BR_TEST_UPDATE set the text is stored: read the change. */
void br_test_stored(const char *name, void (*print)(FILE *out), double tolerance);

/* Whether long tests are to be left out (BR_TEST_QUICK is set: valgrind). */
bool br_test_quick(void);

/* Whether everything is tested, also what takes minutes: ./bootstrap test --long. */
bool br_test_long(void);

/* 1, or more if long double has no more digits than double, as under valgrind. */
double br_test_slack(void);

#endif
