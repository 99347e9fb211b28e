/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cmocka without lists: a test is there as soon as it is written.
 *     TEST(test_that_it_works)
 *     {
 *         assert_true(works());
 *     }
 * A program without a main() of its own runs all of its tests, in the order in which they stand. */
#ifndef BR_TESTS_TEST_H
#define BR_TESTS_TEST_H

/* cmocka.h wants these before it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define TEST(name)                                                 \
    static void name(void **fixture);                              \
    __attribute__((constructor)) static void register_##name(void) \
    {                                                              \
        br_test_add(#name, name);                                  \
    }                                                              \
    static void name(__attribute__((unused)) void **fixture)

/* What is called before all tests, and after them; NULL: nothing. What the former leaves in its
 * state is in the tests at *fixture. */
#define AROUND_TESTS(set_up, tear_down)                            \
    __attribute__((constructor)) static void register_set_up(void) \
    {                                                              \
        br_test_around(set_up, tear_down);                         \
    }

/* Ends a test that cannot be made here. cmocka's own skip() is a failure to Meson in some versions.
 */
#define SKIP(why)                              \
    do {                                       \
        print_message("# skipped: %s\n", why); \
        return;                                \
    } while (0)

void br_test_add(const char *name, CMUnitTestFunction test);
void br_test_around(CMFixtureFunction set_up, CMFixtureFunction tear_down);

/* Runs all of them; returns how many fail. */
int br_test_all(void);

#endif
