/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tests of the beam share. */
#ifndef BR_TESTS_SUPPORT_H
#define BR_TESTS_SUPPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/march.h"
#include "study/estimate/warnings.h"
#include "study/grid/study.h"
#include "tests/checks.h"

/* The bundled scene of that name; to be cleared. */
struct br_scene br_test_bundled(const char *name);

/* For OWNED(br_function) function and OWNED(br_march) *march. */
void br_function_clear(struct br_function *function);
void br_march_clear(struct br_march **march);

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

/* A study in the L2 norm, by the default method and, where the reference is a fine run, with a
 * reference by it; the lists are borrowed. */
struct br_study br_test_study(const struct br_scene *scene,
                              const struct br_reference *reference_kind, size_t n_count,
                              const size_t *n, size_t k_count, const size_t *steps);

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

/* Reading the scene, with its verify part or without, is refused with a message that begins with
 * the file and contains `message`. */
void br_test_scene_refused(const char *text, bool verify, const char *message);

#endif
