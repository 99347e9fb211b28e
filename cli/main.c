/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "cli/suggest.h"
#include "plots/render.h"
#include "study/ranks/ranks.h"
#include "study/ranks/spread.h"
#include "study/scene/quote.h"
#include "tables/json_value.h"

extern const struct br_command br_command_check, br_command_completions, br_command_extremes,
    br_command_figures, br_command_plan, br_command_run, br_command_scenes, br_command_study,
    br_command_tables, br_command_trade;

const struct br_command *const br_commands[] = {
    &br_command_tables,
    &br_command_study,
    &br_command_check,
    &br_command_run,
    &br_command_trade,
    &br_command_plan,
    &br_command_extremes,
    &br_command_figures,
    &br_command_scenes,
    &br_command_completions,
    NULL,
};

static void print_help(FILE *out)
{
    fprintf(out,
            "beamrate: convergence studies of the dynamic frictional contact of a viscoelastic "
            "beam\n\nUsage: beamrate COMMAND [OPTION...]\n\nCommands:\n");
    for (const struct br_command *const *c = br_commands; *c; c++)
        fprintf(out, "  %-11s %-13s %s\n", (*c)->name, (*c)->arguments, (*c)->title);
    fprintf(out,
            "\n'beamrate COMMAND --help' lists a command's options, with examples; here are some "
            "to begin\nwith:\n"
            "  beamrate tables --n 100,200,400 --k 0.01,0.005 --reference fine:1600,1e-3\n"
            "  beamrate study example2 --norm l2,energy,tip\n"
            "  beamrate check example2 example3\n"
            "  beamrate scenes --new my_scene.yaml\n\n"
            "Exit codes: 0 done, 1 a verdict failed, 2 bad input, 3 the computation failed.\n");
}

static const struct br_command *find_command(const char *name)
{
    for (const struct br_command *const *c = br_commands; *c; c++)
        if (strcmp((*c)->name, name) == 0)
            return *c;
    return NULL;
}

/* Standard output closed or full is a failure too. */
static enum br_status check_stdout(struct br_error *err)
{
    if (fflush(stdout) != 0 || ferror(stdout))
        return br_fail(err, BR_IO, "standard output could not be written");
    if (br_json_lacked_memory())
        return br_no_memory(err, "a JSON document");
    return BR_OK;
}

/* Only rank 0 of several speaks. */
static enum br_status join_ranks(struct br_error *err)
{
    const enum br_status status = br_ranks_start(err);
    if (!br_ranks_first() && !freopen("/dev/null", "w", stdout))
        return br_fail(err, BR_IO, "/dev/null: %s", strerror(errno));
    return status;
}

static bool is_help(const char *word)
{
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0;
}

static enum br_status unknown(const char *word, struct br_error *err)
{
    const char *names[64] = {"--help", "--version", "help"};
    size_t count = 3;
    for (const struct br_command *const *c = br_commands; *c && count < 64; c++)
        names[count++] = (*c)->name;
    const char *nearest = br_nearest(word, names, count);
    if (nearest)
        return br_fail(err, BR_BAD_INPUT, "'%s' is no command; did you mean '%s'?", word, nearest);
    return br_fail(err, BR_BAD_INPUT, "'%s' is no command; 'beamrate --help' lists them", word);
}

static enum br_status run_command(int argc, const char **argv, struct br_error *err)
{
    if (argc < 2 || (is_help(argv[1]) && argc == 2)) {
        print_help(argc < 2 ? stderr : stdout);
        return argc < 2 ? br_fail(err, BR_BAD_INPUT, "no command is given") : BR_OK;
    }
    if (is_help(argv[1])) /* 'help COMMAND' is 'COMMAND --help' */
        return run_command(3, (const char *[]){argv[0], argv[2], "--help", NULL}, err);
    if (strcmp(argv[1], "--version") == 0) {
        printf("beamrate %s (%s)\n", br_version(), br_commit());
        return BR_OK;
    }
    const struct br_command *command = find_command(argv[1]);
    if (!command)
        return unknown(argv[1], err);
    br_signals_install();
    br_gnuplot_stop_when(br_signals_caught);
    const enum br_status status = br_remember_command_line(argc, argv, err);
    if (status)
        return status;
    static char name[64]; /* for the usage line */
    snprintf(name, sizeof name, "beamrate %s", command->name);
    argv[1] = name;
    return command->run(argc - 1, argv + 1, err);
}

/* A message may repeat what a file says. */
static void complain(const char *message)
{
    fputs("beamrate: ", stderr);
    br_quote(stderr, &br_for_text, message);
    fputc('\n', stderr);
}

/* Libraries that have no memory, or no thread, end the program: popt, OpenMP. */
static bool returned;

static void name_the_end(int code, void *self)
{
    (void)self;
    static const char message[] = "beamrate: out of memory or threads: a library gave up\n";
    if (returned || code == 0)
        return;
    (void)!write(STDERR_FILENO, message, sizeof message - 1);
    _exit(br_status_exit_code(BR_NO_MEMORY));
}

static int run_all(int argc, const char **argv)
{
    struct br_error err = {0};
    enum br_status status = join_ranks(&err);
    if (!status)
        status = run_command(argc, argv, &err);
    if (!status)
        status = check_stdout(&err);
    status = br_spread_end(status, &err);
    if (!br_ranks_first())
        return 0; /* rank 0 tells, and ends with the exit code */
    if (status == BR_INTERRUPTED) {
        fprintf(stderr, "beamrate: interrupted; no file is half written\n");
        br_signals_raise_again();
    }
    if (!status && br_signals_caught()) { /* a script that runs many commands must hear of it */
        fprintf(stderr, "beamrate: interrupted when all was written\n");
        br_signals_raise_again();
    }
    if (status)
        complain(err.message);
    return br_status_exit_code(status);
}

int main(int argc, const char **argv)
{
    on_exit(name_the_end, NULL);
    br_json_lacked_memory(); /* from now on it remembers */
    const int code = run_all(argc, argv);
    returned = true;
    return code;
}
