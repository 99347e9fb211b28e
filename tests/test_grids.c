/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every number of a report at its own row and column of every plot: no two numbers
 * of the report are the same, so that one in another's place is seen. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made_report.h"
#include "plots/plots.h"

/* One line of a data file, against the cell whose line it must be. */
static void check_point(const char *line, const struct br_report *r, size_t index, bool over_h,
                        int parts, bool printed)
{
    const struct br_cell *c = &br_report_fitted(r)->cell[index];
    char *rest;
    assert_int_equal(strtoul(line, &rest, 10), over_h ? c->at.n : c->at.steps);
    CLOSE(strtod(rest, &rest), 1 / (double)(over_h ? c->at.n : c->at.steps), 1e-15);
    for (int part = 0; part < parts; part++) {
        char flag[32];
        int length;
        const double value = strtod(rest, &rest);
        if (c->flag[part] == BR_FLAG_FAILED) /* whatever number it left behind */
            assert_true(isnan(value));
        else
            CLOSE(value, c->error[part], 0);
        assert_int_equal(sscanf(rest, " %31s%n", flag, &length), 1);
        rest += length;
        const char *name = br_flag_name(c->flag[part]);
        assert_string_equal(flag, *name ? name : "-");
    }
    if (printed) {
        const double value = strtod(rest, &rest);
        if (isfinite(r->printed[index]))
            CLOSE(value, r->printed[index], 0);
        else
            assert_true(isnan(value));
    }
    assert_string_equal(rest, "");
}

/* The next line that is neither empty nor a comment. */
static char *next_point(char **rest)
{
    char *line;
    while ((line = strsep(rest, "\n")) && (*line == '\0' || *line == '#'))
        ;
    return line;
}

/* A block over h at one k, or over k at one n, ascending in n or steps. */
static void check_block(char **rest, const struct br_report *r, bool over_h, size_t fixed,
                        int parts, bool printed)
{
    for (size_t i = 0; i < (over_h ? BR_MADE_N : BR_MADE_K); i++) {
        const size_t index = over_h ? i * BR_MADE_K + fixed : fixed * BR_MADE_K + i;
        const char *line = next_point(rest);
        assert_non_null(line);
        check_point(line, r, index, over_h, parts, printed);
    }
}

static void check_blocks(char **rest, const struct br_report *r, bool over_h, bool printed)
{
    for (size_t fixed = 0; fixed < (over_h ? BR_MADE_K : BR_MADE_N); fixed++)
        check_block(rest, r, over_h, fixed, 1, printed);
}

static void test_plots(void **state)
{
    (void)state;
    for (size_t i = 0; br_plots[i]; i++) {
        struct br_made_report m;
        br_made_report(&m, i % 2);
        struct br_cell *failed = &m.cell[i % 2][11];
        failed->error[0] = failed->error[1] = failed->error[2] = 3e-3; /* stopped half way */
        char *text = NULL;
        size_t size;
        FILE *out = open_memstream(&text, &size);
        assert_non_null(out);
        br_plots[i]->write_data(out, &m.report);
        assert_int_equal(fclose(out), 0);
        char *rest = text;
        const char *name = br_plots[i]->name;
        if (strcmp(name, "h") == 0) {
            check_blocks(&rest, &m.report, true, false);
        } else if (strcmp(name, "k") == 0) {
            check_blocks(&rest, &m.report, false, false);
        } else if (strcmp(name, "printed") == 0) {
            check_blocks(&rest, &m.report, false, true);
            check_blocks(&rest, &m.report, true, true);
        } else if (strcmp(name, "parts") == 0) {
            check_block(&rest, &m.report, true, BR_MADE_K - 1, 3, false);
            check_block(&rest, &m.report, false, BR_MADE_N - 1, 3, false);
        } else {
            fail_msg("nothing is known of the plot %s", name);
        }
        assert_null(next_point(&rest));
        free(text);
        br_made_report_clear(&m);
    }
}

static void test_plot_names(void **state)
{
    (void)state;
    struct br_made_report m;
    br_made_report(&m, false);
    static const char *const bad[] = {"", "a/b", "../a", "<a", "|a", "-a", "a\nb", " a"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct br_error err = {0};
        char file[64];
        m.report.name = bad[i];
        REFUSED(br_plot_file(&br_plot_h, &m.report, "gp", file, sizeof file, &err), BR_BAD_INPUT,
                "expected the beginning of a file name");
        REFUSED(br_plot_write(&br_plot_h, &m.report, "/tmp", &err), BR_BAD_INPUT, "report's name");
    }
    br_made_report_clear(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plots),
        cmocka_unit_test(test_plot_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
