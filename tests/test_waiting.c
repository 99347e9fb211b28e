/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text on a terminal while a user waits. */
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli_driver.h"
#include "support.h"

static const char slow[] =
    "title: slow\nlength: 2 m\nduration: 1 s\ndensity: 1 kg/m\naxial:\n  stiffness: 1 N\n"
    "  viscosity: 0.1 N s\n  load: sin(50*t*x) [N/m]\nverify:\n  joint:\n    n: 2, 4, 8, 16\n"
    "    k: 0.1, 0.05, 0.025, 0.0125 s\n    l2: 1 +- 0.9\n";

struct terminal {
    int end;
    char shown[1 << 16];
};

/* Keeps the terminal's text, until all writers have closed it. */
static void *watch_terminal(void *self)
{
    struct terminal *t = self;
    size_t used = 0;
    for (ssize_t got; (got = read(t->end, t->shown + used, sizeof t->shown - 1 - used)) > 0;)
        used += (size_t)got;
    return NULL;
}

/* The load is f(x, t), no product: the exact reference first approximates it for a long time. */
TEST(test_waiting)
{
    static struct terminal terminal;
    static struct cli_outcome out;
    static const char what[] = "checking: 0 %, exact reference: ";
    char name[64];
    pthread_t reader;
    cli_write_file("slow.yaml", slow);
    terminal.end = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_true(terminal.end >= 0 && grantpt(terminal.end) == 0 && unlockpt(terminal.end) == 0);
    assert_int_equal(ptsname_r(terminal.end, name, sizeof name), 0);
    const int open_meanwhile = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    assert_int_equal(pthread_create(&reader, NULL, watch_terminal, &terminal), 0);
    cli_run_line("check slow.yaml", &(struct cli_circumstances){.errors = name}, &out);
    close(open_meanwhile);
    assert_int_equal(pthread_join(reader, NULL), 0);
    close(terminal.end);
    const char *first = strstr(terminal.shown, what);
    assert_non_null(first);
    const char *second = strstr(first + 1, what);
    if (!second || !(atof(second + strlen(what)) > atof(first + strlen(what))))
        fail_msg("nothing moves: %s", terminal.shown);
    assert_null(strstr(terminal.shown, "< ")); /* no limit, and no time before 5 % */
    for (const char *at = terminal.shown; (at = strstr(at, " %, about ")); at++) {
        const char *number = at;
        while (number > terminal.shown && strchr("0123456789", number[-1]))
            number--;
        assert_true(atof(number) >= 5);
    }
}

AROUND_TESTS(cli_make_folder, cli_remove_folder)
