/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs that are kept, and programs that change. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "made_programs.h"

static const char counting[] = "echo run >> $0.runs; [ $1 = 8 ] && [ -e $0.fails ] && exit 1\n"
                               "echo err=$1";

static void expect_run(struct br_orders_request *p, size_t runs, double factor)
{
    run(p);
    size_t cached = 0;
    for (size_t i = 0; i < numbers.rows; i++) {
        assert_null(numbers.row[i].failure);
        assert_true(numbers.row[i].number[0] == factor * numbers.row[i].given[0]);
        AT_MOST(numbers.row[i].seconds, 5);
        cached += numbers.row[i].cached;
    }
    assert_int_equal(cached, numbers.rows - runs);
    shell("touch count.runs; test $(wc -l < count.runs) -eq %zu && rm count.runs", runs);
}

TEST(test_cache)
{
    static const double four[] = {4, 8, 16, 32};
    write_script("count", counting);
    char cache[128];
    snprintf(cache, sizeof cache, "%s", path_of("cache"));
    struct br_orders_request p = program(command_of("count", "{n}"));
    p.cache = cache;
    expect_run(&p, 3, 1);
    expect_run(&p, 0, 1);
    p.anew = true;
    expect_run(&p, 3, 1);
    p.anew = false;
    has_entries(cache, 3);
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, four, 4};
    expect_run(&p, 1, 1);
    const struct br_reading other = {"err", "err=0*([0-9]+)", BR_READING_REGEX, NULL, false, false};
    p.reading = &other;
    expect_run(&p, 4, 1);
    p.reading = &err_reading;
    write_script("count", "echo run >> $0.runs; echo err=$(($1 * 2))");
    expect_run(&p, 4, 2);
    expect_run(&p, 0, 2);
    has_entries(cache, 12);
    write_script("count", counting); /* as it was */
    expect_run(&p, 0, 1);
}

/* A script that an interpreter runs counts, too, also behind a =. */
TEST(test_cached_script)
{
    static const char *const forms[] = {
        "script {n}",
        "/bin/sh %s {n}",
        "/usr/bin/env SCRIPT=%s sh -c '. $SCRIPT' x {n}",
    };
    char command[256], cache[128], folders[256];
    FREED char *before = strdup(getenv("PATH"));
    snprintf(cache, sizeof cache, "%s", path_of("cache-script"));
    snprintf(folders, sizeof folders, "/no/such/folder:%s:/usr/bin:/bin", folder);
    setenv("PATH", folders, 1);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        snprintf(command, sizeof command, forms[i], path_of("script"));
        struct br_orders_request p = program(command);
        p.cache = cache;
        for (int version = 1; version <= 2; version++) {
            char text[64];
            snprintf(text, sizeof text, "echo err=%d", version);
            write_script("script", text);
            for (int again = 0; again < 2; again++) {
                run(&p);
                assert_true(numbers.row[0].number[0] == version);
                assert_int_equal(numbers.row[0].cached, again);
            }
        }
    }
    setenv("PATH", before, 1);
}

/* Failed cells are not kept, nor read those that are broken. */
TEST(test_not_cached)
{
    char cache[128];
    snprintf(cache, sizeof cache, "%s", path_of("cache-not"));
    write_script("count", counting);
    write_script("count.fails", "");
    struct br_orders_request p = program(command_of("count", "{n}"));
    p.cache = cache;
    run(&p);
    assert_non_null(numbers.row[1].failure);
    has_entries(cache, 2);
    shell("rm count.fails count.runs");
    expect_run(&p, 1, 1);
    static const char *const texts[] = {"", "beamrate kept 1\n", "beamrate kept 2\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        shell("for cell in %s/*; do printf '%s' > $cell; done", cache, texts[i]);
        expect_run(&p, 3, 1);
    }
    expect_run(&p, 0, 1);
    p.cache = "/dev/null";
    refuse(&p, BR_IO, "/dev/null: a finished cell could not be");
    p.cache = "/no/such/folder";
    refuse(&p, BR_IO, "/no/such/folder: No such file");
}

/* Studies that run beside each other with one folder of cached cells. */
TEST(test_together)
{
    char cache[128];
    snprintf(cache, sizeof cache, "%s", path_of("cache-together"));
    struct br_orders_request p = on_grid(1);
    p.cache = cache;
    pid_t child[3];
    for (int i = 0; i < 3; i++) {
        child[i] = fork();
        assert_true(child[i] >= 0);
        if (child[i] == 0)
            _exit(br_program_run(&p, &numbers, &err) || numbers.row[5].failure);
    }
    for (int i = 0; i < 3; i++) {
        int status;
        assert_int_equal(waitpid(child[i], &status, 0), child[i]);
        assert_int_equal(status, 0);
    }
    has_entries(cache, 6);
    p.cache = NULL;
    run(&p);
    double anew[6];
    for (size_t i = 0; i < 6; i++) {
        assert_false(numbers.row[i].cached);
        anew[i] = numbers.row[i].number[0];
    }
    p.cache = cache;
    run(&p);
    for (size_t i = 0; i < 6; i++)
        assert_true(numbers.row[i].cached && numbers.row[i].number[0] == anew[i]);
}

/* ---- a program that changes ---- */

/* A row is of the program with which the study began, or it has no number, and is not kept. */
TEST(test_changes)
{
    static const char *const forms[] = {"%s {n}", "/bin/sh %s {n}",
                                        "/usr/bin/env A=1 B=2 SCRIPT=%s sh -c '. $SCRIPT' x {n}"};
    static const char *const ways[] = {"echo '#' >> %s", "cp -p %1$s new && mv new %1$s", "rm %s"};
    char command[256], cache[128], text[512], way[256];
    for (size_t i = 0; i < 9; i++) {
        const char *path = path_of("changes");
        snprintf(command, sizeof command, forms[i / 3], path);
        snprintf(way, sizeof way, ways[i % 3], path);
        snprintf(text, sizeof text, "echo run >> %s.runs; [ $1 = 8 ] && %s; echo err=$1; exit",
                 path, way);
        write_script("changes", text);
        snprintf(cache, sizeof cache, "%s", path_of("cache-changes"));
        struct br_orders_request p = program(command);
        p.cache = cache;
        run(&p);
        assert_true(numbers.row[0].number[0] == 4 && !numbers.row[0].failure);
        for (size_t j = 1; j < 3; j++) {
            const struct br_numbers_row *row = &numbers.row[j];
            const char *why = i == 2 && j == 2 ? "changes' is no program"
                                               : "or a file that the command names, changed during";
            if (!row->failure || !strstr(row->failure, why))
                fail_msg("%s: %s", command, row->failure);
            assert_true(isnan(row->number[0]) && !row->cached);
        }
        has_entries(cache, 1);
        shell("rm -r %s changes.runs", cache);
    }
}
