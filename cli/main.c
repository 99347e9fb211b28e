/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/provenance.h"
#include "cli/signals.h"

extern const struct br_command br_command_check, br_command_study, br_command_tables;

const struct br_command *const br_commands[] = {&br_command_tables, &br_command_study,
                                                &br_command_check, NULL};

static void print_help(FILE *out)
{
    fprintf(out,
            "beamrate: convergence studies of the dynamic frictional contact of a viscoelastic "
            "beam\n\nUsage: beamrate COMMAND [OPTION...]\n\nCommands:\n");
    for (const struct br_command *const *c = br_commands; *c; c++)
        fprintf(out, "  %-8s %-10s %s\n", (*c)->name, (*c)->arguments, (*c)->title);
    fprintf(out,
            "\n'beamrate COMMAND --help' lists a command's options.\n"
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
    return BR_OK;
}

int main(int argc, const char **argv)
{
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(argc < 2 ? stderr : stdout);
        return br_status_exit_code(argc < 2 ? BR_BAD_INPUT : BR_OK);
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("beamrate %s (%s)\n", br_version(), br_commit());
        return 0;
    }
    const struct br_command *command = find_command(argv[1]);
    if (!command) {
        fprintf(stderr, "beamrate: '%s' is no command; 'beamrate --help' lists them\n", argv[1]);
        return br_status_exit_code(BR_BAD_INPUT);
    }
    br_signals_install();
    br_remember_command_line(argc, argv);
    static char name[64]; /* for the usage line */
    snprintf(name, sizeof name, "beamrate %s", command->name);
    argv[1] = name;
    struct br_error err = {0};
    enum br_status status = command->run(argc - 1, argv + 1, &err);
    if (!status)
        status = check_stdout(&err);
    if (status == BR_INTERRUPTED) {
        fprintf(stderr, "beamrate: interrupted; nothing was written\n");
        br_signals_raise_again();
    }
    if (status)
        fprintf(stderr, "beamrate: %s\n", err.message);
    return br_status_exit_code(status);
}
