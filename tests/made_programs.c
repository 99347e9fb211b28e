/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made_programs.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "orders/program/process.h"

const struct br_resolution_column cells = {.name = "n", .axis = BR_AXIS_SPACE};
const struct br_resolution_column step = {.name = "k", .axis = BR_AXIS_TIME, .is_size = true};

char folder[] = "/tmp/beamrate-test-XXXXXX";
static const double three[] = {16, 4, 8}, two[] = {0.05, 0.1};
const struct br_reading err_reading = {"err", "err=(.*)", BR_READING_REGEX, NULL, false, false};

struct br_orders_request program(const char *command)
{
    return (struct br_orders_request){.command = (char *)command,
                                      .axis[BR_AXIS_SPACE] = {&cells, three, 3},
                                      .dimension = 1,
                                      .reading = &err_reading,
                                      .readings = 1,
                                      .jobs = 1,
                                      .seconds = PATIENCE};
}

const char *path_of(const char *name)
{
    static char path[4][128];
    static size_t last;
    last = (last + 1) % 4;
    snprintf(path[last], sizeof path[last], "%s/%s", folder, name);
    return path[last];
}

void write_script(const char *name, const char *text)
{
    FILE *file = fopen(path_of(name), "w");
    assert_non_null(file);
    fprintf(file, "#!/bin/sh\n%s\n", text);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(chmod(path_of(name), 0755), 0);
}

const char *command_of(const char *name, const char *words)
{
    static char command[512];
    snprintf(command, sizeof command, "%s %s", path_of(name), words);
    return command;
}

void shell(const char *format, ...)
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

void has_entries(const char *name, size_t count)
{
    shell("test $(ls -A %s | wc -l) -eq %zu", name, count);
}

struct br_numbers numbers;

void run(const struct br_orders_request *p)
{
    br_numbers_clear(&numbers);
    MUST(br_program_run(p, &numbers, &err));
    has_entries("tmp", 0);
}

void refuse(const struct br_orders_request *p, enum br_status status, const char *message)
{
    br_numbers_clear(&numbers);
    REFUSED(br_program_run(p, &numbers, &err), status, message);
    assert_null(numbers.row);
}

void run_limited(struct br_orders_request *p, double seconds, const char *marks)
{
    for (p->seconds = seconds;; p->seconds *= 4) {
        shell("rm -f %s", marks);
        run(p);
        if (!numbers.row[numbers.rows - 1].failure || p->seconds > PATIENCE)
            return;
    }
}

const char good[] = "awk -v n=$1 -v k=$2 'BEGIN { printf \"err=%.17g\\n\", 1 / n^2 + k }'";

struct br_orders_request on_grid(int jobs)
{
    write_script("good", good);
    struct br_orders_request p = program(command_of("good", "{n} {k}"));
    p.axis[BR_AXIS_TIME] = (struct br_program_axis){&step, two, 2};
    p.jobs = jobs;
    return p;
}

void expect_dead(const char *name)
{
    shell("for i in $(seq 15000); do grep -qs '^State:.[^ZX]' /proc/$(cat %s)/status || exit 0; "
          "sleep 0.02; done; exit 1",
          name);
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
