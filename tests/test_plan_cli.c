/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate plan` as a user runs it: what is refused, what is written, and that its command lines
 * repeat what it proposes. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "cli_driver.h"
#include "support.h"

#define SMALL " --methods euler+implicit,bdf2 --repeats 1 --threads 2"

static double number(const json_t *o, const char *key)
{
    return json_number_value(json_object_get(o, key));
}

/* The words of a printed command line, without the program. */
static const char *words_of(const json_t *root, const char *key)
{
    return json_string_value(json_object_get(root, key)) + strlen("beamrate ");
}

static void test_written(void **state)
{
    (void)state;
    static struct cli_outcome out;
    cli_run_line("plan example2 --error 1e-3 --out o" SMALL, NULL, &out);
    assert_int_equal(out.exit_code, 0);
    assert_non_null(strstr(out.output, "Met: the achieved error"));
    const char *command = strstr(out.output, "\n  beamrate run example2 ");
    assert_non_null(command); /* alone on its line, below the answer, once */
    assert_null(strstr(command + strlen("\n  beamrate"), "beamrate run"));
    assert_true(command > strstr(out.output, "Met:"));
    char path[512], words[1024], seen[64];
    cli_path("o/example2-plan.json", path);
    json_t *root = json_load_file(path, 0, NULL);
    assert_non_null(root);
    const json_t *trials = json_object_get(json_object_get(root, "tables"), "trials");
    const json_t *chosen = json_array_get(trials, (size_t)number(root, "chosen"));
    const double error = number(chosen, "relative_error");
    assert_true(error <= 1e-3 && error >= 1e-3 / 3);
    assert_true(number(chosen, "round") > 0);
    assert_true(fabs(number(chosen, "predicted_error") / error - 1) < 0.5);
    static const char *const others[] = {"txt", "md", "tex"};
    snprintf(seen, sizeof seen, "%.3e", error);
    for (size_t i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "o/example2-plan.%s", others[i]);
        if (!strstr(cli_read(path), seen))
            fail_msg("%s does not say %s", path, seen);
    }
    snprintf(seen, sizeof seen, "%.17g", error);
    assert_non_null(strstr(cli_read("o/example2-plan.csv"), seen));
    const char *method = json_string_value(json_object_get(chosen, "method"));
    assert_non_null(method); /* which one is a matter of this machine's times */
    snprintf(seen, sizeof seen, "scheme %.*s,", (int)strcspn(method, "+"), method);
    cli_expect(words_of(root, "run"), NULL, 0, seen);
    snprintf(words, sizeof words, "%s --repeats 1 --no-plots --out t", words_of(root, "trade"));
    cli_expect(words, NULL, 0, "Cheapest way to an error");
    cli_path("t/example2.json", path);
    json_t *trade = json_load_file(path, 0, NULL);
    assert_non_null(trade);
    const json_t *again =
        json_array_get(json_object_get(json_object_get(trade, "tables"), "trials"), 0);
    CLOSE(number(again, "relative_error") / error, 1, 1e-9);
    json_decref(trade);
    json_decref(root);
}

/* A goal that cannot be reached is a failure that says what came nearest. */
static void test_missed(void **state)
{
    (void)state;
    cli_expect("plan example2 --seconds 1e-9" SMALL, NULL, 3, "the goal was missed");
    cli_expect("plan example2 --seconds 1e-9" SMALL, NULL, 3, "Missed: nothing");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_written),
        cmocka_unit_test(test_missed),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
