/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Foreign programs: small scripts, written here, that do what programs do, good and bad. */
#include "support.h"

#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "solver/clock.h"
#include "study/orders/request.h"

static const struct br_resolution_column cells = {"n", BR_AXIS_SPACE, false, false};
static const struct br_resolution_column unknowns = {"dofs", BR_AXIS_SPACE, false, true};
static const struct br_resolution_column step = {"k", BR_AXIS_TIME, true, false};

static char folder[] = "/tmp/beamrate-test-XXXXXX";
static const double three[] = {16, 4, 8}, two[] = {0.05, 0.1};
static const struct br_reading err_reading = {"err", "err=(.*)", BR_READING_REGEX};

/* n in {4, 8, 16}, one run at once. */
static struct br_orders_request program(const char *command)
{
    return (struct br_orders_request){.command = (char *)command,
                                      .axis[BR_AXIS_SPACE] = {&cells, three, 3},
                                      .dimension = 1,
                                      .reading = &err_reading,
                                      .readings = 1,
                                      .jobs = 1,
                                      .seconds = 10};
}

static const char *path_of(const char *name)
{
    static char path[4][128];
    static size_t last;
    last = (last + 1) % 4;
    snprintf(path[last], sizeof path[last], "%s/%s", folder, name);
    return path[last];
}

static void write_script(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    fprintf(file, "#!/bin/sh\n%s\n", text);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(chmod(path_of(name), 0755), 0);
}

/* The command of a script in the folder, with these words behind it. */
static const char *command_of(const char *name, const char *words)
{
    static char command[512];
    snprintf(command, sizeof command, "%s %s", path_of(name), words);
    return command;
}

/* All of a file, until the next call; "" where there is none. */
static const char *text_of(const char *path)
{
    static char text[512];
    FILE *file = fopen(path, "r");
    text[file ? fread(text, 1, sizeof text - 1, file) : 0] = '\0';
    if (file)
        fclose(file);
    return text;
}

static size_t lines_of(const char *name)
{
    size_t lines = 0;
    for (const char *c = text_of(path_of(name)); *c; c++)
        lines += *c == '\n';
    return lines;
}

static size_t entries_of(const char *path)
{
    DIR *open = opendir(path);
    size_t count = 0;
    assert_non_null(open);
    while (readdir(open))
        count++;
    closedir(open);
    return count - 2;
}

static struct br_numbers run(const struct br_orders_request *p)
{
    struct br_numbers numbers;
    struct br_error err;
    MUST(br_program_run(p, &numbers, &err));
    assert_int_equal(entries_of(path_of("tmp")), 0);
    return numbers;
}

/* Runs a script of that name, and keeps nothing. */
static struct br_numbers run_script(const char *name, const char *text, int jobs)
{
    write_script(name, text);
    struct br_orders_request p = program(command_of(name, "{n}"));
    p.jobs = jobs;
    return run(&p);
}

/* ---- good programs ---- */

static const char good[] = "awk -v n=$1 -v k=$2 'BEGIN { printf \"err=%.17g\\n\", 1 / n^2 + k }'";

static struct br_orders_request on_grid(int jobs)
{
    write_script("good", good);
    struct br_orders_request p = program(command_of("good", "{n} {k}"));
    p.axis[BR_AXIS_TIME] = (struct br_program_axis){&step, two, 2};
    p.jobs = jobs;
    return p;
}

TEST(test_grid)
{
    static const double n[] = {4, 4, 8, 8, 16, 16}, k[] = {0.1, 0.05, 0.1, 0.05, 0.1, 0.05};
    for (int jobs = 1; jobs <= 4; jobs += 3) {
        const struct br_orders_request p = on_grid(jobs);
        struct br_numbers numbers = run(&p);
        assert_int_equal(numbers.rows, 6);
        assert_int_equal(numbers.quantities, 1);
        assert_string_equal(numbers.quantity[0].name, "err");
        assert_false(numbers.quantity[0].is_value);
        assert_ptr_equal(numbers.column[BR_AXIS_TIME], &step);
        for (size_t i = 0; i < 6; i++) {
            const struct br_numbers_row *row = &numbers.row[i];
            assert_null(row->failure);
            assert_false(row->kept);
            assert_true(row->given[BR_AXIS_SPACE] == n[i] && row->given[BR_AXIS_TIME] == k[i]);
            assert_true(row->z[BR_AXIS_SPACE] == 1 / n[i] && row->z[BR_AXIS_TIME] == k[i]);
            CLOSE(row->number[0], 1 / (n[i] * n[i]) + k[i], 1e-15);
        }
        br_numbers_clear(&numbers);
    }
}

/* Each waits for the others. */
TEST(test_at_once)
{
#ifdef _OPENMP
    struct br_numbers numbers =
        run_script("meet",
                   "touch $0.$1\n"
                   "until [ -e $0.4 ] && [ -e $0.8 ] && [ -e $0.16 ]; do sleep 0.02; done\n"
                   "echo err=1",
                   3);
    for (size_t i = 0; i < 3; i++)
        assert_null(numbers.row[i].failure);
    br_numbers_clear(&numbers);
#endif
}

TEST(test_unknowns)
{
    static const double list[] = {64, 8000};
    struct br_orders_request p = program("/usr/bin/printf 'err={dofs}\\n'");
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&unknowns, list, 2};
    p.dimension = 3;
    struct br_numbers numbers = run(&p);
    CLOSE(numbers.row[0].z[BR_AXIS_SPACE], 0.25, 1e-15);
    CLOSE(numbers.row[1].z[BR_AXIS_SPACE], 0.05, 1e-15);
    assert_true(numbers.row[1].number[0] == 8000);
    assert_true(isnan(numbers.row[1].z[BR_AXIS_TIME]));
    br_numbers_clear(&numbers);
}

/* A program as another one sees it: words, folder, environment, input. */
TEST(test_words)
{
    static const double list[] = {1e6}, dt[] = {1.25e-7};
    write_script("words", "{ printf '[%s]' \"$@\"; printf ' %s %s %s\\n' \"$LC_ALL\" \"$(ls -A)\" "
                          "\"$(cat)\"; } > $0.out; pwd > $0.where; echo err=1");
    struct br_orders_request p = program(command_of(
        "words", "a\\ b 'c  d' \"e \\\"f\\\" \\g\" ; | '' x\"y\"'z' $(touch PWN) `touch PWN` "
                 "'; touch PWN' {n}/{k} '{{n} {n}' }"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, list, 1};
    p.axis[BR_AXIS_TIME] = (struct br_program_axis){&step, dt, 1};
    struct br_numbers numbers = run(&p);
    assert_string_equal(text_of(path_of("words.out")),
                        "[a b][c  d][e \"f\" \\g][;][|][][xyz][$(touch][PWN)][`touch][PWN`]"
                        "[; touch PWN][1000000/1.25e-07][{n} 1000000][}] C  \n");
    assert_int_not_equal(access("PWN", F_OK), 0);
    assert_int_not_equal(access(path_of("PWN"), F_OK), 0);
    assert_int_equal(
        strncmp(text_of(path_of("words.where")), path_of("tmp"), strlen(path_of("tmp"))), 0);
    br_numbers_clear(&numbers);
}

/* The language is there once, whatever the caller's is. */
TEST(test_environment)
{
    static char language[] = "language";
    const struct br_reading reading = {language, "^LC_ALL=(.*)", BR_READING_REGEX};
    struct br_orders_request p = program("/usr/bin/env err={n}");
    p.reading = &reading;
    p.values = language;
    setenv("LC_ALL", "POSIX", 1);
    struct br_numbers numbers = run(&p);
    unsetenv("LC_ALL");
    assert_true(numbers.quantity[0].is_value);
    assert_non_null(
        strstr(numbers.row[0].failure, "language: found 'C', expected a finite number"));
    br_numbers_clear(&numbers);
}

/* Without a folder to run in nothing is run, and nothing removed. */
TEST(test_no_folder)
{
    struct br_orders_request p = program("true {n}");
    struct br_numbers numbers;
    struct br_error err;
    char *there = strdup(path_of("tmp")), *long_name = malloc(6000);
    assert_non_null(long_name);
    int length = snprintf(long_name, 6000, "%s", there); /* cut, it names the folder */
    while (length < 5999)
        long_name[length++] = '/';
    long_name[length] = '\0';
    setenv("TMPDIR", long_name, 1);
    REFUSED(br_program_run(&p, &numbers, &err), BR_IO, "File name too long");
    setenv("TMPDIR", "/no/such/folder", 1);
    REFUSED(br_program_run(&p, &numbers, &err), BR_IO, "/no/such/folder: no folder to run");
    setenv("TMPDIR", there, 1);
    assert_int_equal(access(there, F_OK), 0);
    free(there);
    free(long_name);
}

/* A path with a slash is the caller's; a name is of PATH. */
TEST(test_relative)
{
    char before[512];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    write_script("here", "echo err=$1");
    struct br_orders_request p = program("./here {n}");
    struct br_numbers numbers = run(&p);
    assert_true(numbers.row[2].number[0] == 16);
    br_numbers_clear(&numbers);
    struct br_error err;
    p.command = "here {n}";
    REFUSED(br_program_run(&p, &numbers, &err), BR_BAD_INPUT, "'here' is no program");
    assert_int_equal(chdir(before), 0);
}

/* ---- what is refused ---- */

/* What a program is asked with; NULL, 0: as in program(). */
static const struct {
    const char *command, *list;
    struct br_reading reading;
    const char *message;
} refused[] = {
    {.command = "", .message = "empty"},
    {.command = "  ", .message = "empty"},
    {.command = "'' {n}", .message = "empty"},
    {.command = "true", .message = "no {n}"},
    {.command = "true {{n}", .message = "no {n}"},
    {.command = "true {n} {k}", .message = "expected {n}"},
    {.command = "true {n} {m}", .message = "'m}'"},
    {.command = "true {n", .message = "expected {n}"},
    {.command = "true '{n}", .message = "' is not closed"},
    {.command = "true \"{n}", .message = "\" is not closed"},
    {.command = "true {n} \\", .message = "quote \\ is not closed"},
    {.command = "no-such-program-here {n}", .message = "'no-such-program-here' is no program"},
    {.command = "/no/such/program {n}", .message = "'/no/such/program' is no program"},
    {.command = "/tmp {n}", .message = "'/tmp' is no program"},
    {.command = "/etc/passwd {n}", .message = "'/etc/passwd' is no program"},
    {.list = "4,8,4", .message = "n: 4 is given twice"},
    {.list = "4,0,8", .message = "expected positive numbers"},
    {.list = "4,-8,16", .message = "expected positive numbers"},
    {.list = "4,nan,8", .message = "expected positive numbers"},
    {.list = "4,inf,8", .message = "expected positive numbers"},
    {.list = "", .message = "expected positive numbers"},
    {.list = "4,8.5,16", .message = "n: found 8.5, expected a whole number above 0"},
    {.list = "4,8,1e300", .message = "n: found 1e+300, expected a whole number above 0"},
    {.reading = {"", "(.)", BR_READING_REGEX}, .message = "no name"},
    {.reading = {"q", "(", BR_READING_REGEX}, .message = "q: '(' is no extended regular"},
    {.reading = {"q", "a", BR_READING_REGEX}, .message = "has 0 groups, expected one"},
    {.reading = {"q", "(a)(b)", BR_READING_REGEX}, .message = "has 2 groups"},
    {.reading = {"q", "a", BR_READING_JSON}, .message = "'a' is no JSON pointer"},
    {.reading = {"q", "/a~2", BR_READING_JSON}, .message = "is no JSON pointer"},
    {.reading = {"q", "/a~", BR_READING_JSON}, .message = "is no JSON pointer"},
    {.reading = {"q", "", BR_READING_CSV}, .message = "no column"},
};

TEST(test_refused)
{
    struct br_numbers numbers;
    struct br_error err;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        const char *list = refused[i].list, *command = refused[i].command;
        struct br_orders_request r = br_orders_request_default();
        struct br_orders_request p = program(command ? command : "true {n}");
        p.reading = refused[i].reading.name ? &refused[i].reading : p.reading;
        REFUSED(list ? br_orders_request_axis(&r, "n", list, &err)
                     : br_program_run(&p, &numbers, &err),
                BR_BAD_INPUT, refused[i].message);
        br_orders_request_clear(&r);
    }
    static const char *const scripts[][2] = {{"#!/no/such/interpreter\n", "(its interpreter?)"},
                                             {"echo err=1\n", "cannot be run"}};
    for (size_t i = 0; i < 2; i++) {
        write_script("nobody", "");
        FILE *script = fopen(path_of("nobody"), "w");
        fputs(scripts[i][0], script);
        fclose(script);
        const struct br_orders_request p = program(command_of("nobody", "{n}"));
        REFUSED(br_program_run(&p, &numbers, &err), BR_BAD_INPUT, scripts[i][1]);
    }
    struct br_orders_request r = br_orders_request_default();
    MUST(br_orders_request_reading(&r, "err", "err=(.*)", &err));
    REFUSED(br_orders_request_reading(&r, "err", "e=(.*)", &err), BR_BAD_INPUT,
            "err is read twice");
    br_orders_request_clear(&r);
    struct br_orders_request p = program("true {n}");
    p.axis[BR_AXIS_SPACE].column = NULL;
    REFUSED(br_program_run(&p, &numbers, &err), BR_BAD_INPUT, "no list");
    p = program("true {n}");
    p.readings = 0;
    REFUSED(br_program_run(&p, &numbers, &err), BR_BAD_INPUT, "no reading");
}

/* ---- bad programs ---- */

TEST(test_failures)
{
    static const struct {
        const char *script, *failure;
    } cases[] = {
        {"echo one; echo err=1; exit 4", "exit code 4; it printed: one err=1"},
        {"echo a >&2; echo b >&2; printf 'c\\033[1m\\nd\\n\\n' >&2; echo out; exit 3",
         "exit code 3; it printed: b c\\x1b[1m d"},
        {"printf 'a\\0b'; exit 1", "printed: a?b"},
        {"exit 5", "exit code 5; it printed nothing"},
        {"kill -SEGV $$", "signal 11"},
        {"echo err=nan", "err: found 'nan', expected a finite number; it printed: err=nan"},
        {"echo err=-inf", "found '-inf'"},
        {"echo err=1,5", "found '1,5'"},
        {"echo err=", "found ''"},
        {"true", "matches nothing in the output; it printed nothing"},
        {"echo err=1; echo; echo err=2", "matches 2 times, expected once; lines 1, 3"},
        {"head -c 20971520 /dev/zero", "it printed more than 16 MiB"},
        {"echo err=1; head -c 20971520 /dev/zero >&2", "it printed more than 16 MiB"},
        {"yes err=1", "it printed more than 16 MiB"},
        {"printf 'err=1\\n\\0'", "zero byte"},
        {"exec 2>&-; echo err=1; sed -n 1p /nowhere", "exit code 2"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        snprintf(text, sizeof text, "if [ $1 != 8 ]; then echo err=$1; exit; fi\n%s",
                 cases[i].script);
        struct br_numbers numbers = run_script("bad", text, 1);
        assert_null(numbers.row[0].failure);
        assert_null(numbers.row[2].failure);
        assert_true(numbers.row[2].number[0] == 16);
        assert_true(isnan(numbers.row[1].number[0]));
        if (!numbers.row[1].failure || !strstr(numbers.row[1].failure, cases[i].failure))
            fail_msg("'%s': %s", cases[i].script, numbers.row[1].failure);
        br_numbers_clear(&numbers);
    }
}

/* Of what is long its end is shown, in at most 300 bytes, beginning with a whole character. */
TEST(test_long_complaint)
{
    struct br_numbers numbers =
        run_script("long",
                   "{ awk 'BEGIN { for (i = 0; i < 400; i++) printf \"\303\244\" }'\n"
                   "[ $1 = 8 ] && odd=x; echo; echo \"${odd}the reason\"; } >&2; exit 1",
                   1);
    for (size_t i = 0; i < 2; i++) {
        const char *tail = strstr(numbers.row[i].failure, "printed: ") + 9;
        AT_MOST((double)strlen(tail), 300);
        assert_true(strlen(tail) > 250);
        assert_null(strstr(tail, "\\x"));
        assert_string_equal(tail + strlen(tail) - 10, "the reason");
    }
    br_numbers_clear(&numbers);
}

/* Whether the process whose number is in the file does something. A dead one may wait to be buried
 * by others. */
static bool is_alive(const char *name)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/stat", atoi(text_of(path_of(name))));
    const char *end = strrchr(text_of(path), ')');
    return end && end[2] != 'Z' && end[2] != 'X';
}

/* A moment after it was killed, which it may need to die. */
static void expect_dead(const char *name)
{
    static const struct timespec moment = {.tv_nsec = 20000000};
    for (int tries = 0; tries < 100 && is_alive(name); tries++)
        nanosleep(&moment, NULL);
    assert_false(is_alive(name));
}

/* The first obeys SIGTERM, the second and what it starts do not, the third leaves what it has
 * started; no child of theirs survives. */
TEST(test_hanging)
{
    write_script("hang", "[ $1 = 8 ] && trap '' TERM\n"
                         "sleep 60 & echo $! > $0.$1\n"
                         "echo before >&2\n"
                         "[ $1 = 16 ] && echo err=1 && exit\n"
                         "[ $1 = 8 ] && trap 'echo term >> $0.terms' TERM\n"
                         "while [ $1 = 8 ]; do sleep 0.1; done; wait");
    struct br_orders_request p = program(command_of("hang", "{n}"));
    p.jobs = 3;
    p.seconds = 1;
    const double start = br_seconds();
    struct br_numbers numbers = run(&p);
    AT_MOST(br_seconds() - start, 6);
    AT_MOST(2.9, br_seconds() - start);
    assert_string_equal(numbers.row[0].failure, "it did not end within 1 s; it printed: before");
    assert_non_null(strstr(numbers.row[1].failure, "within 1 s; it printed: before"));
    assert_null(numbers.row[2].failure);
    assert_int_equal(lines_of("hang.terms"), 1);
    expect_dead("hang.4");
    expect_dead("hang.8");
    expect_dead("hang.16");
    br_numbers_clear(&numbers);
}

/* ---- cost ---- */

TEST(test_cost)
{
    struct br_numbers numbers =
        run_script("cost",
                   "case $1 in\n"
                   "4) sleep 0.3;;\n"
                   "8) awk 'BEGIN { for (i = 0; i < 4000000; i++) s += i }';;\n"
                   "16) awk 'BEGIN { s = \"x\"; while (length(s) < 1e8) s = s s }';;\n"
                   "esac; echo err=1",
                   1);
    AT_MOST(numbers.row[0].seconds, 0.1);
    AT_MOST(0.05, numbers.row[1].seconds);
    AT_MOST(numbers.row[1].seconds, 5);
    AT_MOST(1.3e8, numbers.row[2].bytes);
    AT_MOST(numbers.row[2].bytes, 9e8);
    if (!isnan(numbers.row[0].bytes))
        AT_MOST(numbers.row[0].bytes, 2e7);
    br_numbers_clear(&numbers);
}

/* ---- kept cells ---- */

static const char counting[] = "echo run >> $0.runs; [ $1 = 8 ] && [ -e $0.fails ] && exit 1\n"
                               "echo err=$1";

static void expect_run(struct br_orders_request *p, size_t runs, double factor)
{
    struct br_numbers numbers = run(p);
    size_t kept = 0;
    for (size_t i = 0; i < numbers.rows; i++) {
        assert_null(numbers.row[i].failure);
        assert_true(numbers.row[i].number[0] == factor * numbers.row[i].given[0]);
        AT_MOST(numbers.row[i].seconds, 5);
        kept += numbers.row[i].kept;
    }
    assert_int_equal(kept, numbers.rows - runs);
    br_numbers_clear(&numbers);
    assert_int_equal(lines_of("count.runs"), runs);
    unlink(path_of("count.runs"));
}

TEST(test_kept)
{
    static const double four[] = {4, 8, 16, 32};
    write_script("count", counting);
    char kept[128];
    snprintf(kept, sizeof kept, "%s", path_of("kept"));
    struct br_orders_request p = program(command_of("count", "{n}"));
    p.kept = kept;
    expect_run(&p, 3, 1);
    expect_run(&p, 0, 1);
    p.anew = true;
    expect_run(&p, 3, 1);
    p.anew = false;
    assert_int_equal(entries_of(kept), 3);
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, four, 4};
    expect_run(&p, 1, 1);
    const struct br_reading other = {"err", "err=0*([0-9]+)", BR_READING_REGEX};
    p.reading = &other;
    expect_run(&p, 4, 1);
    p.reading = &err_reading;
    write_script("count", "echo run >> $0.runs; echo err=$(($1 * 2))");
    expect_run(&p, 4, 2);
    expect_run(&p, 0, 2);
    assert_int_equal(entries_of(kept), 12);
    write_script("count", counting); /* as it was */
    expect_run(&p, 0, 1);
}

/* A script that an interpreter runs counts, too, also behind a =. */
TEST(test_kept_script)
{
    static const char *const forms[] = {
        "script {n}",
        "/bin/sh %s {n}",
        "/usr/bin/env SCRIPT=%s sh -c '. $SCRIPT' x {n}",
    };
    char command[256], kept[128], folders[256];
    char *before = strdup(getenv("PATH"));
    snprintf(kept, sizeof kept, "%s", path_of("kept-script"));
    snprintf(folders, sizeof folders, "/no/such/folder:%s:/usr/bin:/bin", folder);
    setenv("PATH", folders, 1);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        snprintf(command, sizeof command, forms[i], path_of("script"));
        struct br_orders_request p = program(command);
        p.kept = kept;
        for (int version = 1; version <= 2; version++) {
            char text[64];
            snprintf(text, sizeof text, "echo err=%d", version);
            write_script("script", text);
            for (int again = 0; again < 2; again++) {
                struct br_numbers numbers = run(&p);
                assert_true(numbers.row[0].number[0] == version);
                assert_int_equal(numbers.row[0].kept, again);
                br_numbers_clear(&numbers);
            }
        }
    }
    setenv("PATH", before, 1);
    free(before);
}

static const char *spoilt;

static int spoil(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info;
    (void)where;
    if (type != FTW_F)
        return 0;
    FILE *file = fopen(path, "r+");
    assert_non_null(file);
    fputs(spoilt, file);
    assert_int_equal(ftruncate(fileno(file), ftell(file)), 0);
    fclose(file);
    return 0;
}

/* Failed cells are not kept, nor read those that are broken; a program that changes while it runs
 * is not kept under its old name. */
TEST(test_not_kept)
{
    char kept[128];
    snprintf(kept, sizeof kept, "%s", path_of("kept-not"));
    write_script("count", counting);
    write_script("count.fails", "");
    struct br_orders_request p = program(command_of("count", "{n}"));
    p.kept = kept;
    struct br_numbers numbers = run(&p);
    assert_non_null(numbers.row[1].failure);
    br_numbers_clear(&numbers);
    assert_int_equal(entries_of(kept), 2);
    unlink(path_of("count.fails"));
    unlink(path_of("count.runs"));
    expect_run(&p, 1, 1);
    static const char *const texts[] = {"{\"format\": \"beamrate-cell 1\", \"numbers\": [7",
                                        "{\"format\": \"beamrate-cell 1\", \"numbers\": [null]}",
                                        "{\"format\": \"beamrate-cell 1\", \"numbers\": [7, 8]}",
                                        "{\"format\": \"beamrate-cell 2\", \"numbers\": [7]}", ""};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        spoilt = texts[i];
        assert_int_equal(nftw(kept, spoil, 8, FTW_PHYS), 0);
        expect_run(&p, 3, 1);
    }
    expect_run(&p, 0, 1);
    write_script("count", "echo run >> $0.runs; echo '#' >> $0; echo err=$1");
    expect_run(&p, 3, 1);
    assert_int_equal(entries_of(kept), 3);
    struct br_error err = {0};
    write_script("count", counting);
    p.kept = "/dev/null";
    REFUSED(br_program_run(&p, &numbers, &err), BR_IO, "/dev/null: a finished cell could not be");
    p.kept = "/no/such/folder";
    REFUSED(br_program_run(&p, &numbers, &err), BR_IO, "/no/such/folder: No such file");
}

/* The kernel tells no exit codes to those who ignore SIGCHLD. */
TEST(test_unseen)
{
    write_script("unseen", "echo err=1; exit 3");
    const struct br_orders_request p = program(command_of("unseen", "{n}"));
    struct br_numbers numbers;
    struct br_error err;
    signal(SIGCHLD, SIG_IGN);
    const enum br_status status = br_program_run(&p, &numbers, &err);
    signal(SIGCHLD, SIG_DFL);
    REFUSED(status, BR_IO, "SIGCHLD");
}

/* Studies that run beside each other with one folder of kept cells. */
TEST(test_together)
{
    char kept[128];
    snprintf(kept, sizeof kept, "%s", path_of("kept-together"));
    struct br_orders_request p = on_grid(1);
    p.kept = kept;
    pid_t child[3];
    for (int i = 0; i < 3; i++) {
        struct br_numbers numbers;
        child[i] = fork();
        assert_true(child[i] >= 0);
        if (child[i] == 0)
            _exit(br_program_run(&p, &numbers, NULL) || numbers.row[5].failure);
    }
    for (int i = 0; i < 3; i++) {
        int status;
        assert_int_equal(waitpid(child[i], &status, 0), child[i]);
        assert_int_equal(status, 0);
    }
    assert_int_equal(entries_of(kept), 6);
    struct br_numbers numbers = run(&p);
    p.kept = NULL;
    struct br_numbers anew = run(&p);
    for (size_t i = 0; i < 6; i++) {
        assert_true(numbers.row[i].kept && !anew.row[i].kept);
        assert_true(numbers.row[i].number[0] == anew.row[i].number[0]);
    }
    br_numbers_clear(&anew);
    br_numbers_clear(&numbers);
}

/* ---- interruption ---- */

static bool has_started(void *self)
{
    (void)self;
    return access(path_of("slow.started"), F_OK) == 0;
}

static void take_progress(void *self, double fraction)
{
    double *last = self;
    assert_true(fraction > *last && fraction <= 1);
    *last = fraction;
}

TEST(test_interrupted)
{
    double last = 0;
    const struct br_observer observer = {
        .progress = take_progress, .stop = has_started, .self = &last};
    char kept[128];
    snprintf(kept, sizeof kept, "%s", path_of("kept-slow"));
    write_script("slow", "[ $1 != 16 ] && echo err=$1 && exit\n"
                         "echo $$ > $0.pid; touch $0.started; sleep 60");
    struct br_orders_request p = program(command_of("slow", "{n}"));
    p.kept = kept;
    p.observer = &observer;
    struct br_numbers numbers;
    struct br_error err;
    const double start = br_seconds();
    REFUSED(br_program_run(&p, &numbers, &err), BR_INTERRUPTED, "interrupted");
    AT_MOST(br_seconds() - start, 5);
    assert_null(numbers.row);
    expect_dead("slow.pid");
    assert_int_equal(entries_of(path_of("tmp")), 0);
    assert_int_equal(entries_of(kept), 2);
    static const double done[] = {4, 8};
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, done, 2};
    p.observer = NULL;
    numbers = run(&p);
    assert_true(numbers.row[0].kept && numbers.row[1].kept);
    br_numbers_clear(&numbers);
}

/* ---- readings ---- */

TEST(test_readings)
{
    enum { REGEX = BR_READING_REGEX, JSON = BR_READING_JSON, CSV = BR_READING_CSV };
    static const struct {
        int kind;
        const char *what, *output;
        double number;       /* NaN: it fails ... */
        const char *failure; /* ... with this */
    } cases[] = {
        {REGEX, "L2 *= *([-+.0-9e]+)", "x\nL2 = 1.5e-7\ny", 1.5e-7, NULL},
        {REGEX, "^([^ ]+) m$", "0x1p-3 m\r\n1 s\n-2.5e+3 m\n", -2500, NULL},
        {REGEX, "err=(.*)", "err= 12 \r\n", 12, NULL},
        {REGEX, "e=([0-9]+),", "e=1,5\n", 1, NULL},
        {REGEX, "err-([0-9]+)", "err-3 ", 3, NULL},
        {REGEX, "^(.*)$", "3", 3, NULL},
        {REGEX, "(.*)", "3", 3, NULL},
        {REGEX, "([0-9]*)", "12 34", NAN, "matches 2 times, expected once; lines 1, 1"},
        {REGEX, "e=([0-9.]+)", "e=1.5e-7", NAN, "a part of a number only, on line 1: 'e=1.5e-7'"},
        {REGEX, "e=([0-9.]+)", "\ne=1.5D-7", NAN, "part of a number only, on line 2"},
        {REGEX, "e=([0-9.]+)e", "e=1.5e-7", NAN, "part of a number"},
        {REGEX, "e=([0-9.]+)", "e=1,5", NAN, "part of a number"},
        {REGEX, "e=.*([0-9]+)", "e=12", NAN, "part of a number"},
        {REGEX, "e=.*([0-9]+)", "e=1.5e-7", NAN, "part of a number"},
        {REGEX, "e=-?([0-9]+)", "e=-12", NAN, "part of a number"},
        {REGEX, "e=(.*)", "e=1e999", NAN, "found '1e999'"},
        {REGEX, "e=(.*)", "e=1e-999", NAN, "found '1e-999'"},
        {REGEX, "e=(.*)", "e=1 2", NAN, "found '1 2'"},
        {REGEX, "e=(.*)", "e=infinity", NAN, "found 'infinity'"},
        {REGEX, "([0-9])", "1 2 3", NAN, "matches 3 times, expected once; lines 1, 1, 1"},
        {REGEX, "x|e=(1)", "x", NAN, "found ''"},
        {REGEX, "e=(.*)", "", NAN, "matches nothing"},
        {REGEX, "e(.*)",
         "e1111111111111111111111111111111111111111111111111111111111111111111111111111", NAN,
         "of 76 bytes"},
        {JSON, "/a/1/b~1c~0d", "{\"a\": [0, {\"b/c~d\": -2.5e3}]}\n", -2500, NULL},
        {JSON, "", " 12345678901234567890 ", 12345678901234567890.0, NULL},
        {JSON, "/", "{\"\": 1}", 1, NULL},
        {JSON, "/a/01", "{\"a\": [0, 1]}", NAN, "has no '/a/01'"},
        {JSON, "/a/-", "{\"a\": [0, 1]}", NAN, "has no"},
        {JSON, "/a/2", "{\"a\": [0, 1]}", NAN, "has no"},
        {JSON, "/a/b", "{\"a\": 1}", NAN, "has no"},
        {JSON, "/a", "{\"a\": \"1\"}", NAN, "is a text, expected a number"},
        {JSON, "/a", "{\"a\": null}", NAN, "is null"},
        {JSON, "/a", "{\"a\": [1]}", NAN, "is an array"},
        {JSON, "/a", "{\"a\": NaN}", NAN, "no JSON, line 1"},
        {JSON, "/a", "{\"a\": 1e999}", NAN, "no JSON, line 1"},
        {JSON, "/a", "{\"a\": 1, \"a\": 2}", NAN, "no JSON"},
        {JSON, "/a", "{\"a\": 1} x", NAN, "no JSON"},
        {JSON, "/a", "", NAN, "no JSON"},
        {CSV, "L2", "n,L2,x\n4,0.5,1\n8,0.25,2\n", 0.25, NULL},
        {CSV, "L2", "# a\r\n\r\nn, \"L2\"\r\n", NAN, "no row below"},
        {CSV, "L2", ",L2\n4,0.5\n", 0.5, NULL},
        {CSV, "a \"b\", c", "\"n\",\"a \"\"b\"\", c\"\r\n\"1\n2\",\"0.5\"\r\n", 0.5, NULL},
        {CSV, "x", "n,x\n4, 0.5", 0.5, NULL},
        {CSV, "n", "n\n\n3\n\n", 3, NULL},
        {CSV, "y", "n,x\n4,0.5", NAN, "found 0 columns 'y'"},
        {CSV, "x", "x,x\n4,0.5", NAN, "found 2 columns 'x'"},
        {CSV, "x", "n,x\n", NAN, "no row below"},
        {CSV, "x", "", NAN, "the output:1: the table is empty"},
        {CSV, "x", "n,x\n1,5,2\n", NAN, "the output:2: found more than 2 fields"},
        {CSV, "x", "n,x\n1\n", NAN, "the output:2: found fewer than 2 fields"},
        {CSV, "x", "n,x\n1,\n", NAN, "found ''"},
        {CSV, "x", "n,x\n1,nan\n", NAN, "found 'nan'"},
        {CSV, "x", "n,x\n1,\"2", NAN, "quote"},
        {CSV, "x", "n,x\n1,\"2\"3", NAN, "quote"},
        {CSV, "x", "n,x\n1,2\"", NAN, "found '2\"'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct br_reading reading = {"q", cases[i].what, (enum br_reading_kind)cases[i].kind};
        const char *output = cases[i].output;
        struct br_error err = {0};
        double number = 0;
        MUST(br_reading_check(&reading, &err));
        const enum br_status status =
            br_reading_take(&reading, output, strlen(output), &number, &err);
        if (!cases[i].failure && !(status == BR_OK && number == cases[i].number))
            fail_msg("'%s' in '%s': %g, %s", cases[i].what, output, number, err.message);
        if (cases[i].failure && !(status == BR_BAD_INPUT && strstr(err.message, cases[i].failure)))
            fail_msg("'%s' in '%s': %g, %s", cases[i].what, output, number, err.message);
        if (cases[i].failure)
            assert_memory_equal(err.message, "q: ", 3);
    }
}

/* ---- memory ---- */

static enum br_status attempt(const void *data, struct br_error *err)
{
    struct br_numbers numbers;
    const enum br_status status = br_program_run(data, &numbers, err);
    br_numbers_clear(&numbers);
    return status;
}

TEST(test_without_memory)
{
    static const double list[] = {4};
    struct br_orders_request p = program("/usr/bin/printf '{{\"a\": {n}}'");
    const struct br_reading reading = {"a", "/a", BR_READING_JSON};
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, list, 1};
    p.reading = &reading;
    br_test_without_memory(attempt, &p, 10);
}

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info;
    (void)type;
    (void)where;
    return remove(path);
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) && mkdir(path_of("tmp"), 0777) == 0 &&
                   setenv("TMPDIR", path_of("tmp"), 1) == 0
               ? 0
               : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

AROUND_TESTS(make_folder, remove_folder)
