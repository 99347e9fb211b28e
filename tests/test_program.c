/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Foreign programs: small scripts, written here, that do what programs do, good and bad. */
#include "checks.h"

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "orders/program/process.h"
#include "orders/request.h"

static const struct br_resolution_column cells = {.name = "n", .axis = BR_AXIS_SPACE};
static const struct br_resolution_column unknowns = {
    .name = "dofs", .axis = BR_AXIS_SPACE, .is_volume = true};
static const struct br_resolution_column step = {
    .name = "k", .axis = BR_AXIS_TIME, .is_size = true};

static char folder[] = "/tmp/beamrate-test-XXXXXX";
static const double three[] = {16, 4, 8}, two[] = {0.05, 0.1};
static const struct br_reading err_reading = {"err", "err=(.*)", BR_READING_REGEX,
                                              NULL,  false,      false};

/* Longer than any run takes that ends by itself, s. */
enum { PATIENCE = 600 };

/* n in {4, 8, 16}, one run at once. */
static struct br_orders_request program(const char *command)
{
    return (struct br_orders_request){.command = (char *)command,
                                      .axis[BR_AXIS_SPACE] = {&cells, three, 3},
                                      .dimension = 1,
                                      .reading = &err_reading,
                                      .readings = 1,
                                      .jobs = 1,
                                      .seconds = PATIENCE};
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

/* A shell command, in the folder, that must succeed. */
__attribute__((format(printf, 1, 2))) static void shell(const char *format, ...)
{
    char command[1024];
    va_list arguments;
    const int used = snprintf(command, sizeof command, "cd %s && ", folder);
    va_start(arguments, format);
    vsnprintf(command + used, sizeof command - (size_t)used, format, arguments);
    va_end(arguments);
    if (system(command) != 0)
        fail_msg("failed: %s", command);
}

static void has_entries(const char *name, size_t count)
{
    shell("test $(ls -A %s | wc -l) -eq %zu", name, count);
}

static struct br_numbers numbers; /* of the last run */

static void run(const struct br_orders_request *p)
{
    br_numbers_clear(&numbers);
    MUST(br_program_run(p, &numbers, &err));
    has_entries("tmp", 0);
}

static void refuse(const struct br_orders_request *p, enum br_status status, const char *message)
{
    br_numbers_clear(&numbers);
    REFUSED(br_program_run(p, &numbers, &err), status, message);
    assert_null(numbers.row);
}

/* The last run ends once the others have made their marks: if it does not within the time limit,
 * the machine is loaded, and all run again with a longer one. */
static void run_limited(struct br_orders_request *p, double seconds, const char *marks)
{
    for (p->seconds = seconds;; p->seconds *= 4) {
        shell("rm -f %s", marks);
        run(p);
        if (!numbers.row[numbers.rows - 1].failure || p->seconds > PATIENCE)
            return;
    }
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

/* The process whose number is in the file does nothing, a moment after it was killed, which it may
 * need to die. A dead one may wait to be buried by others. */
static void expect_dead(const char *name)
{
    shell("for i in $(seq 15000); do grep -qs '^State:.[^ZX]' /proc/$(cat %s)/status || exit 0; "
          "sleep 0.02; done; exit 1",
          name);
}

/* The first obeys SIGTERM, the second and what it starts do not, the third leaves what it has
 * started; no child of theirs survives. */
TEST(test_hanging)
{
    static const double all[] = {4, 8, 16};
    write_script("hang", "[ $1 = 8 ] && trap '' TERM\n"
                         "sleep 3600 & echo $! > $0.$1\n"
                         "[ $1 = 8 ] && trap 'echo term >> $0.terms' TERM\n"
                         "echo before >&2; touch $0.mark$1\n"
                         "[ $1 != 16 ] || while :; do\n"
                         "[ -e $0.mark4 ] && [ -e $0.mark8 ] && echo err=1 && exit\n"
                         "sleep 0.02; done\n"
                         "while [ $1 = 8 ]; do sleep 0.1; done; wait");
    struct br_orders_request p = program(command_of("hang", "{n}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, all, 3};
    p.jobs = 3;
    const double start = br_seconds();
    run_limited(&p, 1, "hang.mark* hang.terms");
    AT_MOST(2.9, br_seconds() - start);
    char said[80];
    snprintf(said, sizeof said, "it did not end within %g s; it printed: before", p.seconds);
    assert_string_equal(numbers.row[0].failure, said);
    assert_non_null(strstr(numbers.row[1].failure, said + strlen("it did not end ")));
    assert_null(numbers.row[2].failure);
    shell("test $(wc -l < hang.terms) -eq 1");
    expect_dead("hang.4");
    expect_dead("hang.8");
    expect_dead("hang.16");
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

/* ---- cached cells ---- */

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

/* The kernel tells no exit codes to those who ignore SIGCHLD. */
TEST(test_unseen)
{
    write_script("unseen", "echo err=1; exit $1");
    const struct br_orders_request p = program(command_of("unseen", "{n}"));
    signal(SIGCHLD, SIG_IGN);
    br_numbers_clear(&numbers);
    REFUSED(br_program_run(&p, &numbers, &err), BR_IO, "the exit code of a program is not known");
    signal(SIGCHLD, SIG_DFL);
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
    char cache[128];
    snprintf(cache, sizeof cache, "%s", path_of("cache-slow"));
    write_script("slow", "[ $1 != 16 ] && echo err=$1 && exit\n"
                         "echo $$ > $0.pid; touch $0.started; exec sleep 3600");
    struct br_orders_request p = program(command_of("slow", "{n}"));
    p.cache = cache;
    p.observer = &observer;
    refuse(&p, BR_INTERRUPTED, "interrupted");
    assert_null(numbers.row);
    expect_dead("slow.pid");
    has_entries("tmp", 0);
    has_entries(cache, 2);
    static const double done[] = {4, 8};
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, done, 2};
    p.observer = NULL;
    run(&p);
    assert_true(numbers.row[0].cached && numbers.row[1].cached);
}

/* A program and what it has started end with this process, whatever ends that. A folder that this
 * process could not remove is removed by the next study. */
TEST(test_no_survivors)
{
    write_script("nest", "echo $$ > $0.$1\n"
                         "sh -c 'sleep 3600 & echo $! > '$0.$1.a'; exec sleep 3600' &\n"
                         "(sh -c 'echo $$ > '$0.$1.b'; exec sleep 3600' &)\n"
                         "until [ -s $0.$1.a ] && [ -s $0.$1.b ]; do sleep 0.01; done\n"
                         "echo err=1; [ $1 = 4 ] || exec sleep 3600");
    static const double one[] = {4}, other[] = {8};
    static const int deadly[] = {0, SIGKILL, SIGTERM, SIGHUP, SIGQUIT};
    struct br_orders_request p = program(command_of("nest", "{n}"));
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) {
        shell("rm -f nest.4* nest.8*");
        p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, deadly[i] ? other : one, 1};
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            for (size_t j = 1; j < sizeof deadly / sizeof *deadly; j++)
                if (deadly[j] != SIGKILL)
                    signal(deadly[j], SIG_DFL); /* nohup and background jobs ignore some */
            _exit(br_program_run(&p, &numbers, &err) || numbers.row[0].failure);
        }
        if (deadly[i]) {
            shell("until [ -s nest.8.a ] && [ -s nest.8.b ]; do sleep 0.01; done");
            kill(child, deadly[i]);
        }
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_int_equal(deadly[i] ? WTERMSIG(status) : status, deadly[i]);
        for (const char *const *end = (const char *const[]){"", ".a", ".b", NULL}; *end; end++) {
            char name[32];
            snprintf(name, sizeof name, "nest.%d%s", deadly[i] ? 8 : 4, *end);
            expect_dead(name);
        }
        has_entries("tmp", deadly[i] != 0);
        br_run_folders_clean();
        has_entries("tmp", deadly[i] != 0); /* it is too new */
        shell("touch -c -d '5 minutes ago' tmp/*");
        br_run_folders_clean();
        has_entries("tmp", 0);
    }
}

/* A program has the usual signals, also where this process ignores them. */
TEST(test_usual_signals)
{
    static const int usual[] = {SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGXFSZ};
    static const double one[] = {4};
    void (*old[5])(int);
    unsigned long long ignored = ~0ull;
    write_script("usual",
                 "sed -n 's/^SigIgn:[^0-9a-f]*//p' /proc/self/status > $0.ignored; echo err=1");
    struct br_orders_request p = program(command_of("usual", "{n}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, one, 1};
    for (int i = 0; i < 5; i++)
        old[i] = signal(usual[i], SIG_IGN);
    br_numbers_clear(&numbers);
    const enum br_status status = br_program_run(&p, &numbers, &err);
    for (int i = 0; i < 5; i++)
        signal(usual[i], old[i]);
    MUST(status);
    FILE *file = fopen(path_of("usual.ignored"), "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%llx", &ignored), 1);
    fclose(file);
    for (int i = 0; i < 5; i++)
        assert_int_equal(ignored >> (usual[i] - 1) & 1, 0);
}

/* What a program has started is asked to end, too, before it is killed. */
TEST(test_group_is_asked)
{
    write_script("asked", "[ $1 != 16 ] || until [ -e $0.mark ]; do sleep 0.02; done\n"
                          "[ $1 != 16 ] || { echo err=1; exit; }\n"
                          "sh -c 'trap \"echo asked > $0.child; exit\" TERM\n"
                          "touch $0.mark; while :; do sleep 0.1; done' $0 &\n"
                          "trap : TERM; until [ -e $0.mark ]; do sleep 0.1; done; wait; wait");
    static const double two_sizes[] = {4, 16};
    struct br_orders_request p = program(command_of("asked", "{n}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, two_sizes, 2};
    p.jobs = 2;
    run_limited(&p, 3, "asked.mark asked.child");
    assert_non_null(strstr(numbers.row[0].failure, "it did not end within "));
    assert_null(numbers.row[1].failure);
    shell("test -e asked.child");
}

/* ---- what is left ---- */

static char warned[5000];

static void take_warning(void *self, const char *what)
{
    (void)self;
    snprintf(warned, sizeof warned, "%s", what);
}

/* A folder that a program has moved or hidden below a path that is too long. */
TEST(test_folders_that_stay)
{
    static const char *const scripts[] = {
        "mv \"$PWD\" $0.moved; echo err=1",
        "for i in $(seq 30); do mkdir $(printf %0200d 0); cd $(printf %0200d 0); done; echo err=1"};
    static const double one[] = {4};
    const struct br_observer observer = {.warn = take_warning};
    for (int i = 0; i < 2; i++) {
        write_script("stay", scripts[i]);
        struct br_orders_request p = program(command_of("stay", "{n}"));
        p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, one, 1};
        p.observer = &observer;
        *warned = '\0';
        br_numbers_clear(&numbers);
        MUST(br_program_run(&p, &numbers, &err));
        assert_null(numbers.row[0].failure);
        const char *path = strchr(warned, '/');
        assert_non_null(strstr(warned, "the folder of a run could not be removed, and is left: "));
        assert_true(strncmp(path, path_of(i ? "tmp/beamrate-run-" : "stay.moved"),
                            strlen(path_of(i ? "tmp/beamrate-run-" : "stay.moved"))) == 0);
        assert_int_equal(access(path, F_OK), 0);
        shell("rm -rf stay.moved tmp/*");
    }
}

/* This stands before the C library's own function: programs of another user cannot be killed. */
static bool is_of_another;

int kill(pid_t id, int number)
{
    int (*own)(pid_t, int);
    *(void **)&own = dlsym(RTLD_NEXT, "kill");
    if (!is_of_another || own(id, 0) != 0)
        return own(id, number);
    errno = EPERM;
    return -1;
}

TEST(test_another_user)
{
    static const double one[] = {4};
    const struct br_observer observer = {.warn = take_warning};
    write_script("other", "exec sleep 3600");
    struct br_orders_request p = program(command_of("other", "{n}"));
    p.axis[BR_AXIS_SPACE] = (struct br_program_axis){&cells, one, 1};
    p.observer = &observer;
    p.seconds = 0.5;
    is_of_another = true;
    run(&p);
    is_of_another = false;
    assert_non_null(
        strstr(numbers.row[0].failure, "it did not end within 0.5 s, and cannot be killed;"));
    const char *group = strstr(warned, "process group ");
    int id = 0;
    assert_non_null(group);
    assert_int_equal(sscanf(group, "process group %d is left", &id), 1);
    kill(id, SIGKILL);
    assert_int_equal(waitpid(id, NULL, 0), id);
}

/* Libraries (OpenBLAS) have handlers of fork that wait for each other's locks. */
static int foreign_handlers;

static void count_handler(void)
{
    foreign_handlers++;
}

TEST(test_no_foreign_handlers)
{
    assert_int_equal(pthread_atfork(count_handler, count_handler, count_handler), 0);
    const struct br_orders_request p = on_grid(2);
    run(&p);
    assert_int_equal(foreign_handlers, 0);
    const pid_t child = fork(); /* they are there */
    if (child == 0)
        _exit(foreign_handlers != 2);
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
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
    br_remove_folder(folder);
    return 0;
}

AROUND_TESTS(make_folder, remove_folder)
