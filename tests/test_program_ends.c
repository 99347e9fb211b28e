/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How programs end that do not end by themselves, and what they leave. */
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "made_programs.h"
#include "orders/program/process.h"

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
