/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line of a random case reproduces it, whatever the verdict. $BEAMRATE is the program.
 */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/method_fields.h"
#include "tests/cli_driver.h"
#include "tests/lab/map.h"
#include "tests/support.h"

enum { FIRST_OF_EACH = 4, CASES = 30 };

/* Words of a refusal's reason that a scene's name, which stands before it, does not change. */
static bool says(const char *output, const char *why)
{
    const char *after = strstr(why, ": ");
    char part[60];
    snprintf(part, sizeof part, "%.50s", after ? after + 2 : why);
    return strstr(output, part) != NULL;
}

/* The lines of a text joined: each stretch of white space is one blank. */
static void join(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++)
        if (!isspace((unsigned char)*from))
            *to++ = *from;
        else if (to == text || to[-1] != ' ')
            *to++ = ' ';
    *to = '\0';
}

/* What is refused is refused with the same words; what was marched is marched, and states its error
 * or says that it is not known, as it was found. */
static void repeat(const struct br_extreme_case *one, const struct br_extreme_verdict *verdict)
{
    static struct cli_outcome out;
    char text[BR_EXTREME_TEXT], command[BR_EXTREME_COMMAND];
    br_extreme_scene(one, text);
    cli_write_file("case.yaml", text);
    br_extreme_command(one, "case.yaml", command);
    assert_int_equal(strncmp(command, "beamrate ", 9), 0);
    cli_run_line(command + 9, NULL, &out);
    join(out.output);
    const bool refused = verdict->which == BR_EXTREME_REFUSED;
    bool same = refused ? out.exit_code == 2 || out.exit_code == 3 : out.exit_code == 0;
    if (refused)
        same = same && says(out.output, verdict->why);
    else
        same = same && strstr(out.output, verdict->known ? "Estimated error: "
                                                         : "The discretisation error is not known");
    if (!same)
        fail_msg("case %zu was found %s (%s)\n%s\nexit code %d\n%s", one->index,
                 br_extreme_words[verdict->which], verdict->why, command, out.exit_code,
                 out.output);
}

TEST(test_commands)
{
    const struct br_extreme_options options = {.quick = true};
    size_t found[BR_EXTREME_CLASSES] = {0};
    const size_t cases = br_test_long() ? 10 * CASES : CASES;
    for (size_t i = 0; i < cases; i++) {
        struct br_extreme_case one;
        struct br_extreme_verdict verdict;
        br_extreme_draw(2, i, &one);
        assert_int_equal(br_extreme_check(&one, &options, &verdict, &err), BR_OK);
        /* What the map's limit ends goes on for a user. */
        if (verdict.which == BR_EXTREME_UNCHECKED ||
            (!br_test_long() && found[verdict.which] == FIRST_OF_EACH))
            continue;
        found[verdict.which]++;
        repeat(&one, &verdict);
    }
    assert_true(found[BR_EXTREME_RIGHT] && found[BR_EXTREME_WARNED] && found[BR_EXTREME_REFUSED] &&
                found[BR_EXTREME_UNSTABLE] && found[BR_EXTREME_UNKNOWN]);
}

AROUND_TESTS(cli_make_folder, cli_remove_folder)
