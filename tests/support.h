/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions that the test programs share. A check that fails ends its test with a message; no check
 * passes on NaN. */
#ifndef BR_TESTS_SUPPORT_H
#define BR_TESTS_SUPPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/march.h"
#include "study/foresee/warnings.h"
#include "study/grid/study.h"
#include "tests/test.h"

/* |actual - expected| <= tolerance; `what` goes into the message. */
#define CLOSE(actual, expected, tolerance) \
    br_test_close(#actual, actual, expected, tolerance, __FILE__, __LINE__)
#define AT_MOST(actual, limit) br_test_at_most(#actual, actual, limit, __FILE__, __LINE__)
/* The call's status is BR_OK; else the error's message is shown. */
#define MUST(call) br_test_must(call, &err, #call, __FILE__, __LINE__)
/* The call is refused with the status, and its message contains the text. */
#define REFUSED(call, status, text) \
    br_test_refused(call, status, &err, text, #call, __FILE__, __LINE__)

void br_test_close(const char *what, double actual, double expected, double tolerance,
                   const char *file, int line);
void br_test_at_most(const char *what, double actual, double limit, const char *file, int line);
void br_test_must(enum br_status status, const struct br_error *err, const char *what,
                  const char *file, int line);
void br_test_refused(enum br_status status, enum br_status expected, const struct br_error *err,
                     const char *text, const char *what, const char *file, int line);

/* A reproducible generator: SplitMix64 (Steele, Lea and Flood 2014). */
struct br_test_random {
    uint64_t state;
};
double br_test_uniform(struct br_test_random *random, double low, double high);
double br_test_log_uniform(struct br_test_random *random, double low, double high);
size_t br_test_index(struct br_test_random *random, size_t count); /* 0 .. count - 1 */

/* The bundled scene of that name; to be cleared. */
struct br_scene br_test_bundled(const char *name);

/* A bare scene with both fields, unit data and no load, contact or friction: it owns nothing. */
struct br_scene br_test_bare(void);

/* The function of an expression; to be freed with its scene. */
struct br_function br_test_function(const char *expression);

/* space * time from an expression in x and t. */
struct br_load br_test_load(const char *expression);

/* The default method with the solver and the rules of these names; NULL: the default. */
struct br_method br_test_method(const char *solver, const char *contact, const char *friction);

/* Creates a march, and takes its steps up to `until`; both must succeed. */
struct br_march *br_test_march(const struct br_scene *scene, size_t n, size_t steps,
                               const struct br_method *method);
void br_test_advance(struct br_march *march, size_t until);

/* The warning of that kind; NULL: there is none. */
const struct br_warning *br_test_warning(const struct br_warnings *warnings,
                                         enum br_warning_kind kind);

/* A study in the L2 norm, by the default method and, where the judge is a fine run, with a
 * reference by it; the lists are borrowed. */
struct br_study br_test_study(const struct br_scene *scene, const struct br_judge *judge,
                              size_t n_count, const size_t *n, size_t k_count, const size_t *steps);

/* s[0] becomes a chain of studies in all norms of the registry (in/out). */
enum { BR_TEST_NORMS = 3 };
void br_test_all_norms(struct br_study s[BR_TEST_NORMS]);

/* Tip values at the end: u(L), w(L) and w(L/2) of an even mesh, m. */
struct br_test_end {
    double u_tip, w_tip, w_middle;
};
struct br_test_end br_test_run(const struct br_scene *scene, size_t n, size_t steps,
                               const struct br_method *method);

/* Values of tests/data/discrete.csv, see generate_discrete.c. */
struct br_test_golden {
    char scene[32];
    size_t n, steps;
    struct br_test_end end;
};
enum { BR_TEST_MOST_GOLDEN = 16 };
size_t br_test_golden(struct br_test_golden rows[BR_TEST_MOST_GOLDEN]);

/* Largest error of the three values, relative to the largest golden value of its field. */
double br_test_deviation(const struct br_test_end *end, const struct br_test_end *golden);

/* The path of a file, one a program, that now has this text: a scene or another input. */
const char *br_test_scene_file(const char *text);

/* Separates the first cell of a row from the rest, at " | "; returns the rest, or "". */
char *br_test_part(char *row);

/* Replaces each \n in the text by a line's end, in place; returns the text. */
char *br_test_unescape(char *text);

/* Calls `check` for each row of a section of data/text_refusals.txt. */
void br_test_rows(const char *section, void (*check)(char *row));

/* Reading the scene, with its verify part or without, is refused with a message that begins with
 * the file and contains `message`. */
void br_test_scene_refused(const char *text, bool verify, const char *message);

/* Fails every allocation of an attempt in turn: at least `least` attempts fail, and each says so (a
 * few allocations can be done without). attempt: allocates, and cleans up after itself whatever
 * happens. */
void br_test_without_memory(enum br_status (*attempt)(const void *data, struct br_error *err),
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
