/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the command line refuses: the rows of data/refusals.txt, each in a process of its own.
 * Nothing is written, and nothing but the message is said. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli_driver.h"
#include "support.h"

enum { LINE = 4096 };

/* Parts the first words of a line from the rest, at " | "; returns the rest. */
static char *part(char *line)
{
    char *bar = strstr(line, " | ");
    if (!bar)
        fail_msg("no ' | ' in '%s'", line);
    *bar = '\0';
    return bar + 3;
}

/* \n is a line's end. */
static void write_scene(char *line)
{
    char text[LINE], *c = text;
    const char *name = line + 2;
    for (const char *from = part(line); *from; from++)
        if (strncmp(from, "\\n", 2) == 0) {
            *c++ = '\n';
            from++;
        } else
            *c++ = *from;
    *c = '\0';
    cli_write_file(name, text);
}

static size_t count_warnings(const char *text)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, "beamrate: warning: ")); at++)
        count++;
    return count;
}

/* An argument error comes before warnings. */
static void check_row(char *line)
{
    static struct cli_outcome out;
    char *code = part(line), *message = part(code);
    cli_run_line(line, NULL, &out);
    if (out.exit_code != atoi(code) || !strstr(out.output, message))
        fail_msg("beamrate %s: exit code %d, expected %s with '%s'; it said:\n%s", line,
                 out.exit_code, code, message, out.output);
    if (strstr(message, "--") && count_warnings(out.output))
        fail_msg("beamrate %s: warnings before the refusal:\n%s", line, out.output);
}

static void test_rows(void **state)
{
    (void)state;
    char path[1024], line[LINE];
    size_t rows = 0, before = 0;
    snprintf(path, sizeof path, "%s/tests/data/refusals.txt", getenv("BEAMRATE_DATA"));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        if (line[0] == '@') {
            write_scene(line);
            before = cli_count_files(".");
        } else if (line[0] != '#') {
            check_row(line);
            rows++;
        }
    }
    fclose(file);
    assert_true(rows > 200);
    assert_int_equal(cli_count_files("."), before); /* nothing was begun */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows)};
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
