/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/test.h"

#include <stdlib.h>

enum { MOST_TESTS = 64 };

static struct CMUnitTest tests[MOST_TESTS];
static size_t count;
static CMFixtureFunction first, last;

void br_test_add(const char *name, CMUnitTestFunction test)
{
    if (count == MOST_TESTS)
        abort();
    tests[count++] = (struct CMUnitTest){.name = name, .test_func = test};
}

void br_test_around(CMFixtureFunction set_up, CMFixtureFunction tear_down)
{
    first = set_up;
    last = tear_down;
}

int br_test_all(void)
{
    return _cmocka_run_group_tests("tests", tests, count, first, last);
}

__attribute__((weak)) int main(void)
{
    return br_test_all();
}
