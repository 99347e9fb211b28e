/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Foreign programs: small scripts, written here, that do what programs do, good and bad. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "made_programs.h"

static const struct br_resolution_column unknowns = {
    .name = "dofs", .axis = BR_AXIS_SPACE, .is_volume = true};

/* ---- good programs ---- */

TEST(test_grid)
{
    static const double n[] = {4, 4, 8, 8, 16, 16}, k[] = {0.1, 0.05, 0.1, 0.05, 0.1, 0.05};
    for (int jobs = 1; jobs <= 4; jobs += 3) {
        const struct br_orders_request p = on_grid(jobs);
        run(&p);
        assert_int_equal(numbers.rows, 6);
        assert_int_equal(numbers.quantities, 1);
        assert_string_equal(numbers.quantity[0].name, "err");
        assert_false(numbers.quantity[0].is_value);
        assert_ptr_equal(numbers.column[BR_AXIS_TIME], &step);
        for (size_t i = 0; i < 6; i++) {
            const struct br_numbers_row *row = &numbers.row[i];
            assert_null(row->failure);
            assert_false(row->cached);
            assert_true(row->given[BR_AXIS_SPACE] == n[i] && row->given[BR_AXIS_TIME] == k[i]);
            assert_true(row->z[BR_AXIS_SPACE] == 1 / n[i] && row->z[BR_AXIS_TIME] == k[i]);
            CLOSE(row->number[0], 1 / (n[i] * n[i]) + k[i], 1e-15);
        }
    }
}

/* Each waits for the others. */
TEST(test_at_once)
{
    write_script("meet", "touch $0.$1\n"
                         "until [ -e $0.4 ] && [ -e $0.8 ] && [ -e $0.16 ]; do sleep 0.02; done\n"
                         "echo err=1");
    struct br_orders_request p = program(command_of("meet", "{n}"));
    p.jobs = 3;
    run(&p);
    for (size_t i = 0; i < 3; i++)
        assert_null(numbers.row[i].failure);
}

/* Fortran's exponents; a D of a hexadecimal number is a digit. */
TEST(test_exponents)
{
    static const char *const text[] = {"0.5D-01", "5.q-2", "-.5d+2", "0x1D", "5e-2"};
    static const double number[] = {0.05, 0.05, -50, 29, 0.05};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        char line[64];
        snprintf(line, sizeof line, "/usr/bin/printf 'err=%s\\n' {n}", text[i]);
        const struct br_orders_request p = program(line);
        run(&p);
        CLOSE(numbers.row[0].number[0], number[i], 1e-15);
    }
}

TEST(test_unknowns)
{
    static const double list[] = {64, 8000};
    struct br_orders_request p = program("/usr/bin/printf 'err={dofs}\\n'");
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&unknowns, list, 2};
    p.dimension = 3;
    run(&p);
    CLOSE(numbers.row[0].z[BR_AXIS_SPACE], 0.25, 1e-15);
    CLOSE(numbers.row[1].z[BR_AXIS_SPACE], 0.05, 1e-15);
    assert_true(numbers.row[1].number[0] == 8000);
    assert_true(isnan(numbers.row[1].z[BR_AXIS_TIME]));
}

/* A program as another one sees it: words, folder, environment, input. */
TEST(test_words)
{
    static const double list[] = {1e6}, dt[] = {1.25e-7};
    write_script("words", "{ printf '[%s]' \"$@\"; printf ' %s %s %s\\n' \"$LC_ALL\" \"$(ls -A)\" "
                          "\"$(cat)\"; } > $0.out; pwd > $0.where; echo err=1");
    struct br_orders_request p = program(command_of(
        "words",
        "a\\ b 'c  d' \"e \\\"f\\\" \\g\" \\; '|' '' x\"y\"'z' '$(touch' PWN\\) \"\\`touch\" PWN\\` "
        "'; touch PWN' {n}/{k} '{{n} {n}' } \\*?[a] $BR_TEST_WORD \"$1 \\$2\" '\\$3' ~/x\n"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, list, 1};
    p.axis[BR_AXIS_TIME] = (struct br_program_axis){&step, dt, 1};
    char *home = strdup(getenv("HOME") ? getenv("HOME") : "/");
    setenv("BR_TEST_WORD", "two words", 1);
    setenv("HOME", "/home", 1);
    run(&p);
    setenv("HOME", home, 1);
    free(home);
    char text[512] = "";
    FILE *file = fopen(path_of("words.out"), "r");
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    assert_string_equal(text, "[a b][c  d][e \"f\" \\g][;][|][][xyz][$(touch][PWN)][`touch][PWN`]"
                              "[; touch PWN][1000000/1.25e-07][{n} 1000000][}][*?[a]][two][words]"
                              "[$1 $2][\\$3][/home/x] C  \n");
    assert_int_not_equal(access("PWN", F_OK), 0);
    shell("test ! -e PWN && grep -q ^%s words.where", path_of("tmp"));
}

/* The language is there once, whatever the caller's is. */
TEST(test_environment)
{
    static char language[] = "language";
    const struct br_reading reading = {language, "^LC_ALL=(.*)", BR_READING_REGEX,
                                       NULL,     false,          false};
    struct br_orders_request p = program("/usr/bin/env err={n}");
    p.reading = &reading;
    p.values = language;
    setenv("LC_ALL", "POSIX", 1);
    run(&p);
    unsetenv("LC_ALL");
    assert_true(numbers.quantity[0].is_value);
    assert_non_null(
        strstr(numbers.row[0].failure, "language: found 'C', expected a finite number"));
}

/* Without a folder to run in nothing is run, and nothing removed. */
TEST(test_no_folder)
{
    struct br_orders_request p = program("true {n}");
    char *there = strdup(path_of("tmp")), *long_name = malloc(6000);
    assert_non_null(long_name);
    int length = snprintf(long_name, 6000, "%s", there); /* cut, it names the folder */
    while (length < 5999)
        long_name[length++] = '/';
    long_name[length] = '\0';
    setenv("TMPDIR", long_name, 1);
    refuse(&p, BR_IO, "File name too long");
    setenv("TMPDIR", "/no/such/folder", 1);
    refuse(&p, BR_IO, "/no/such/folder: no folder to run");
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
    run(&p);
    assert_true(numbers.row[2].number[0] == 16);
    p.command = "here {n}";
    refuse(&p, BR_BAD_INPUT,
           "'here' is no program, no folder of PATH has it; a file here needs ./");
    assert_int_equal(chdir(before), 0);
}

/* ---- what is refused ---- */

TEST(test_refused)
{
    static const char *const cases[][2] = {
        {"", "empty"},
        {"  ", "empty"},
        {"'' {n}", "empty"},
        {"true", "no {n}"},
        {"true {{n}", "no {n}"},
        {"true {n} {k}", "expected {n}"},
        {"true {n} {m}", "'m}'"},
        {"true {n", "expected {n}"},
        {"true '{n}", "ends within quotes"},
        {"true \"{n}", "ends within quotes"},
        {"true {n} $br_no_such_variable", "a variable that is not set"},
        {"true {n} \001", "a control character"},
        {"true {n} \\", "ends within quotes, or with a \\"},
        {"no-such-program-here {n}", "'no-such-program-here' is no program"},
        {"/no/such/program {n}", "'/no/such/program' is no program"},
        {"/tmp {n}", "'/tmp' is no program"},
        {"sh -x lost.sh {n}", "sh runs 'lost.sh', and no file is there (in /"},
        {"/bin/sh lost_{n}.sh", "/bin/sh runs 'lost_4.sh', and no file"},
        {"/etc/passwd {n}", "'/etc/passwd' is no program: it is not executable; chmod +x"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct br_orders_request p = program(cases[i][0]);
        refuse(&p, BR_BAD_INPUT, cases[i][1]);
    }
    shell("echo '#!/no/such/interpreter' > nobody; echo echo err=1 > noshell; chmod +x no*");
    const struct br_orders_request nobody = program(command_of("nobody", "{n}"));
    refuse(&nobody, BR_BAD_INPUT, "(its interpreter?)");
    const struct br_orders_request p = program(command_of("noshell", "{n}"));
    refuse(&p, BR_BAD_INPUT, "cannot be run");
}

/* What only a shell understands is refused, with a command that works. */
TEST(test_shell_lines)
{
    static const char *const lines[][2] = {
        {"p {n} | tail -1",
         "has a sign of | & ; < > ( ) or a line end, and no shell is used; to use "
         "one: sh -c 'cd "},
        {"p {n} && q", "has a sign"},
        {"p {n} > out", "has a sign"},
        {"p {n}; q", "has a sign"},
        {"p f(x) {n}", "has a sign"},
        {"p {n}\nq {n}", "has a sign"},
        {"p `q` {n}", "has $( or `, and"},
        {"p $(q) {n}", "has $( or `, and"},
        {"A=1 p {n}", "has a variable to set, and"},
        {"cd x {n}", "has 'cd', and"},
        {"p 'a b' {n} | q", "put the command into a script, or the sign into quotes"},
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        const struct br_orders_request p = program(lines[i][0]);
        refuse(&p, BR_BAD_INPUT, lines[i][1]);
    }
    write_script("good", good);
    char line[256], said[sizeof err.message];
    snprintf(line, sizeof line, "%s {n} 0 | tail -1", path_of("good"));
    struct br_orders_request p = program(line);
    refuse(&p, BR_BAD_INPUT, "to use one: ");
    strcpy(said, strstr(err.message, "to use one: ") + strlen("to use one: "));
    p.command = said;
    run(&p);
    CLOSE(numbers.row[0].number[0], 1. / 16, 1e-15);
}

/* ---- where numbers are read, and how often ---- */

static const char talking[] =
    "echo \"err=9 dofs $(($1 * $1 + 1))\"; echo err=$1; echo err=-$1 >&2\n"
    "mkdir d; echo \"{\\\"e\\\": 0.$1}\" > d/out_$1.json; test $1 -ne 16 || exit 3";

TEST(test_places)
{
    static const double list[] = {4, 8, 16, 32};
    const char *const read[][2] = {{"dofs", "dofs (.*)"}, /* the size before all numbers */
                                   {"last", "last:err=(.*)"},
                                   {"complaint", "stderr:err=(.*)"},
                                   {"file", "file:d/out_{level}.json:json:/e"}};
    write_script("talking", talking);
    struct br_orders_request p = br_orders_request_default();
    for (size_t i = 0; i < 4; i++)
        MUST(br_orders_request_reading(&p, read[i][0], read[i][1], &err));
    p.command = strdup(command_of("talking", "{level}"));
    p.values = strdup("complaint");
    p.axis[BR_AXIS_SPACE].column = br_resolution_column_find("level");
    p.axis[BR_AXIS_SPACE].given = memcpy(malloc(sizeof list), list, sizeof list);
    p.axis[BR_AXIS_SPACE].count = 4;
    run(&p);
    assert_int_equal(numbers.quantities, 3);
    assert_true(numbers.assumed);
    assert_string_equal(numbers.column[BR_AXIS_SPACE]->name, "dofs");
    for (int i = 0; i < 4; i++) {
        const struct br_numbers_row *row = &numbers.row[i];
        if (i == 2) { /* it stands between its neighbours, but states no size */
            char name[64];
            assert_non_null(strstr(row->failure, "exit code 3"));
            CLOSE(row->z[0], ldexp(numbers.row[1].z[0], -8), 1e-15);
            assert_true(isnan(row->given[0]));
            br_numbers_name(&numbers, row, BR_AXIS_SPACE, name);
            assert_string_equal(name, "the run of level = 16");
            continue;
        }
        CLOSE(row->given[0], list[i] * list[i] + 1, 0);
        CLOSE(row->z[0], 1 / sqrt(list[i] * list[i] + 1), 1e-15);
        CLOSE(row->number[0], list[i], 0);
        CLOSE(row->number[1], -list[i], 0);
        CLOSE(row->number[2], i == 3 ? 0.32 : list[i] / 10, 1e-15);
    }
    MUST(br_orders_request_reading(&p, "q", "file:out_{n}:(.)", &err));
    refuse(&p, BR_BAD_INPUT, "found '{' before 'n}', expected {level}");
    br_orders_request_clear(&p);
    static const char *const refused[] = {"file:x", "file::(.)", "file:/etc/passwd:(.)",
                                          "file:../x:(.)", "file:a/../../x:(.)"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        REFUSED(br_orders_request_reading(&p, "q", refused[i], &err), BR_BAD_INPUT,
                "expected file:PATH:REGEX, with a PATH in the folder");
        br_orders_request_clear(&p);
    }
}

/* Many count cells along one side, so without a dimension they are those of a line. */
TEST(test_cells_of_runs)
{
    static const double list[] = {4, 8, 16};
    write_script("counting", "echo err=$1");
    OWNED(br_orders_request) p = br_orders_request_default();
    MUST(br_orders_request_reading(&p, "err", "err=(.*)", &err));
    p.command = strdup(command_of("counting", "{cells}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){
        br_resolution_column_find("cells"), memcpy(malloc(sizeof list), list, sizeof list), 3};
    run(&p);
    assert_true(numbers.assumed && numbers.dimension == 1);
    CLOSE(numbers.row[2].z[BR_AXIS_SPACE], 1. / 16, 1e-15);
}

/* One run after the other: their times do not overlap. */
TEST(test_times_of_repeated)
{
    write_script("slow", "sleep 0.02; echo err=$1");
    struct br_orders_request p = program(command_of("slow", "{n}"));
    p.repeat = 4;
    const double begun = br_seconds();
    run(&p);
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        assert_true(numbers.row[i].wall >= 0.02);
        sum += 4 * numbers.row[i].wall;
    }
    AT_MOST(sum, br_seconds() - begun);
}

/* The mean of 4 runs and its deviation; runs are cached one by one; one that fails fails its cell.
 */
TEST(test_repeated)
{
    char cache[128];
    snprintf(cache, sizeof cache, "%s", path_of("cache-repeated"));
    write_script("drawn", "test $1$2 != 83 || test ! -e $0.fail && echo err=$(($1 + $2 * $2))");
    struct br_orders_request p = program(command_of("drawn", "{n} {repeat}"));
    p.repeat = 4;
    p.cache = cache;
    run(&p);
    assert_int_equal(numbers.rows, 3);
    for (int i = 0; i < 3; i++) {
        CLOSE(numbers.row[i].number[0], (4 << i) + 7.5, 1e-12); /* of 1, 4, 9, 16 */
        CLOSE(numbers.row[i].deviation[0], sqrt((42.25 + 12.25 + 2.25 + 72.25) / 3 / 4), 1e-12);
        assert_false(numbers.row[i].cached);
    }
    has_entries(cache, 12);
    run(&p);
    assert_true(numbers.row[2].cached);
    CLOSE(numbers.row[2].number[0], 23.5, 1e-12);
    p.command = (char *)command_of("drawn", "{n} 1"); /* the same words each time */
    run(&p);
    has_entries(cache, 21);                                       /* the first of each is there */
    assert_false(numbers.row[0].cached || numbers.row[2].cached); /* others are new */
    p.command = (char *)command_of("drawn", "{n} {repeat}");
    shell("touch drawn.fail");
    p.cache = NULL;
    run(&p);
    assert_null(numbers.row[0].failure);
    assert_non_null(numbers.row[1].failure);
    assert_non_null(strstr(numbers.row[1].failure, "exit code 1"));
    assert_true(isnan(numbers.row[1].number[0]));
}

/* Two readings may not state one resolution. */
TEST(test_refused_sizes)
{
    static const struct br_reading both[] = {
        {"dofs", "dofs=(.*)", BR_READING_REGEX, NULL, false, false},
        {"h", "h=(.*)", BR_READING_REGEX, NULL, false, false},
        {"err", "err=(.*)", BR_READING_REGEX, NULL, false, false}};
    struct br_orders_request p = program("true {n}");
    p.reading = both;
    p.readings = 3;
    refuse(&p, BR_BAD_INPUT, "h is read beside dofs, expected one resolution of an axis");
}

TEST(test_refused_lists)
{
    static const char *const lists[][2] = {
        {"4,8,4", "n: 4 is given twice"},
        {"4,0,8", "expected positive numbers"},
        {"4,-8,16", "expected positive numbers"},
        {"4,nan,8", "expected positive numbers"},
        {"4,inf,8", "expected positive numbers"},
        {"", "expected positive numbers"},
        {"4,8.5,16", "n: found 8.5, expected a whole number above 0"},
        {"4,8,1e300", "n: found 1e+300, expected a whole number above 0"},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        OWNED(br_orders_request) r = br_orders_request_default();
        REFUSED(br_orders_request_axis(&r, "n", lists[i][0], &err), BR_BAD_INPUT, lists[i][1]);
    }
    OWNED(br_orders_request) r = br_orders_request_default();
    MUST(br_orders_request_reading(&r, "err", "err=(.*)", &err));
    REFUSED(br_orders_request_reading(&r, "err", "e=(.*)", &err), BR_BAD_INPUT,
            "err is read twice");
    struct br_orders_request p = program("true {n}");
    p.axis[BR_AXIS_SPACE].column = NULL;
    refuse(&p, BR_BAD_INPUT, "no list");
    p = program("true {n}");
    p.readings = 0;
    refuse(&p, BR_BAD_INPUT, "nothing to read");
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
        {"true",
         "matches nothing in the output (stderr:REGEX reads standard error); it printed nothing"},
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
        write_script("bad", text);
        const struct br_orders_request p = program(command_of("bad", "{n}"));
        run(&p);
        assert_null(numbers.row[0].failure);
        assert_null(numbers.row[2].failure);
        assert_true(numbers.row[2].number[0] == 16);
        assert_true(isnan(numbers.row[1].number[0]));
        if (!numbers.row[1].failure || !strstr(numbers.row[1].failure, cases[i].failure))
            fail_msg("'%s': %s", cases[i].script, numbers.row[1].failure);
    }
}

/* Of what is long its end is shown, in at most 300 bytes, beginning with a whole character. */
TEST(test_long_complaint)
{
    write_script("long", "{ awk 'BEGIN { for (i = 0; i < 400; i++) printf \"\303\244\" }'\n"
                         "[ $1 = 8 ] && odd=x; echo; echo \"${odd}the reason\"; } >&2; exit 1");
    const struct br_orders_request p = program(command_of("long", "{n}"));
    run(&p);
    for (size_t i = 0; i < 2; i++) {
        const char *tail = strstr(numbers.row[i].failure, "printed: ") + 9;
        AT_MOST((double)strlen(tail), 300);
        assert_true(strlen(tail) > 250);
        assert_null(strstr(tail, "\\x"));
        assert_string_equal(tail + strlen(tail) - 10, "the reason");
    }
}

/* ---- cost ---- */

TEST(test_cost)
{
    write_script("cost", "case $1 in\n"
                         "4) sleep 0.5;;\n"
                         "8) (ulimit -t 1; while :; do :; done);;\n"
                         "16) awk 'BEGIN { s = \"x\"; while (length(s) < 1e8) s = s s }';;\n"
                         "esac; echo err=1");
    const struct br_orders_request p = program(command_of("cost", "{n}"));
    run(&p);
    AT_MOST(0.5, numbers.row[0].wall);
    AT_MOST(numbers.row[0].seconds, numbers.row[0].wall / 2);
    AT_MOST(0.05, numbers.row[1].seconds);
    AT_MOST(numbers.row[1].seconds, 5);
    AT_MOST(1.3e8, numbers.row[2].bytes);
    AT_MOST(numbers.row[2].bytes, 9e8);
    if (!isnan(numbers.row[0].bytes))
        AT_MOST(numbers.row[0].bytes, 2e7);
}

/* What the system does for a run is its work, too: the shell tells how much that was. */
TEST(test_cost_of_the_system)
{
    static const double one[] = {4};
    write_script("system", "dd if=/dev/zero of=/dev/null bs=1M count=3000 2>/dev/null\n"
                           "times >$0.times; awk -F '[ms ]+' 'NR == 2 { print \"used=\" 60 * ($1 "
                           "+ $3) + $2 + $4 }' $0.times\necho err=1");
    OWNED(br_orders_request) p = br_orders_request_default();
    MUST(br_orders_request_reading(&p, "err", "err=(.*)", &err));
    MUST(br_orders_request_reading(&p, "used", "used=(.*)", &err));
    p.command = strdup(command_of("system", "{cells}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){
        br_resolution_column_find("cells"), memcpy(malloc(sizeof one), one, sizeof one), 1};
    run(&p);
    AT_MOST(0.9 * numbers.row[0].number[1], numbers.row[0].seconds);
}

/* The memory of a cell is that of the run that takes the most, here its second. */
TEST(test_memory_of_repeated)
{
    static const double one[] = {4};
    write_script("second", "case $1 in 2) awk 'BEGIN { s = \"x\"; while (length(s) < 1e8) s = s s "
                           "}';; esac; echo err=1");
    struct br_orders_request p = program(command_of("second", "{repeat} {n}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, one, 1};
    p.repeat = 3;
    run(&p);
    AT_MOST(1.3e8, numbers.row[0].bytes);
}

/* ---- memory ---- */

static enum br_status attempt(const void *data, struct br_error *why)
{
    br_numbers_clear(&numbers);
    return br_program_run(data, &numbers, why);
}

TEST(test_without_memory)
{
    static const double list[] = {4};
    struct br_orders_request p = program("/usr/bin/printf '{{\"a\": {n}}'");
    const struct br_reading reading = {"a", "/a", BR_READING_JSON, NULL, false, false};
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, list, 1};
    p.reading = &reading;
    br_test_without_memory(attempt, &p, 10);
}
