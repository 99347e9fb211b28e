/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/cache.h"
#include "base/quote.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/session.h"
#include "tables/json_value.h"

extern const struct br_command br_command_help;

const struct br_command *br_find_command(const char *name)
{
    for (const struct br_command *const *c = br_program.commands; *c; c++)
        if (strcmp((*c)->name, name) == 0)
            return *c;
    return NULL;
}

/* The command that takes a file of this name; NULL: it looks like none. */
static const char *command_of_file(const char *word)
{
    struct stat info;
    const bool there = stat(word, &info) == 0 && !S_ISDIR(info.st_mode);
    const char *dot = strrchr(word, '.');
    if (dot && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0))
        return "check";
    return there || (dot > word && dot[1] && word[0] != '-') ? "orders" : NULL;
}

static enum br_status unknown(const char *word, struct br_error *err)
{
    for (const char *const *other = br_program.of_beamrate; other && *other; other++)
        if (strcmp(*other, word) == 0)
            return br_fail(err, BR_BAD_INPUT,
                           "'%s' is a command of the program beamrate, not of %s", word,
                           br_program.name);
    const char *command = command_of_file(word);
    if (command)
        return br_fail(err, BR_BAD_INPUT, "'%s' is no command; did you mean: %s %s %s", word,
                       br_program.name, command, word);
    const char *names[64] = {"--help", "--version"};
    size_t count = 2;
    for (const struct br_command *const *c = br_program.commands; *c && count < 64; c++)
        names[count++] = (*c)->name;
    char suggestion[BR_SUGGESTION];
    br_suggestion(word, names, count, suggestion);
    return br_fail(err, BR_BAD_INPUT, "'%s' is no command%s", word,
                   *suggestion ? suggestion : "; '--help' lists them");
}

static enum br_status run(const struct br_command *command, const struct br_options *options,
                          struct br_error *err)
{
    struct br_session session = br_session_begin(options);
    const enum br_status status = command->run(options, &session, err);
    br_session_close(&session);
    return status;
}

static enum br_status run_command(int argc, const char **argv, struct br_error *err)
{
    const char *word = argc > 1 ? argv[1] : "";
    const bool help = strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
    if (argc < 2) { /* a failure: a job whose variable is empty has checked nothing */
        br_print_help(stderr);
        return br_fail(err, BR_BAD_INPUT, "no command is given; '%s help' lists them",
                       br_program.name);
    }
    if (strcmp(word, "--version") == 0) {
        br_print_version(br_program.name);
        return BR_OK;
    }
    const struct br_command *command = help ? &br_command_help : br_find_command(word);
    if (!command)
        return unknown(word, err);
    br_signals_install();
    br_stop_when(br_signals_caught);
    if (br_remember_command_line(argc, argv, err))
        return err->status;
    struct br_options options;
    enum br_status status = br_options_parse(argc - 1, argv + 1, command, &options, err);
    if (!status && br_option_given(&options, BR_OPT_HELP))
        br_print_command_help(stdout, command);
    else if (!status)
        status = run(command, &options, err);
    br_options_clear(&options);
    return status;
}

/* False at exit: a library (popt) ended the program, for lack of memory. */
static bool returned;

static void name_the_end(int code, void *self)
{
    (void)self;
    static const char message[] = "beamrate: out of memory: a library gave up\n";
    if (returned || code == 0)
        return;
    (void)!write(STDERR_FILENO, message, sizeof message - 1);
    _exit(br_status_exit_code(BR_NO_MEMORY));
}

/* Whether the reader of standard output has left, as head does when it has its lines. */
static bool reader_left(void)
{
    struct pollfd out = {.fd = STDOUT_FILENO};
    return ferror(stdout) && poll(&out, 1, 0) == 1 && (out.revents & POLLERR);
}

static int run_all(int argc, const char **argv)
{
    /* A failing function sets this error. One that fails without setting it still fails, since
     * chains of calls return err->status. */
    struct br_error err = {BR_IO, "a failure without a message: this is a defect of the program"};
    bool failed = br_program.beam && br_program.beam->start(&err);
    if (!br_is_first() && !freopen("/dev/null", "w", stdout)) /* only rank 0 prints */
        failed = br_fail(&err, BR_IO, "/dev/null: %s", strerror(errno));
    failed = failed || run_command(argc, argv, &err);
    if (!failed && (fflush(stdout) != 0 || ferror(stdout))) /* closed, or full */
        failed = br_fail(&err, BR_IO, "standard output could not be written");
    if (failed && err.status == BR_IO && reader_left()) { /* no error: it ends as others do */
        signal(SIGPIPE, SIG_DFL);
        raise(SIGPIPE);
    }
    if (!failed && br_json_lacked_memory())
        failed = br_no_memory(&err, "a JSON document");
    enum br_status status = failed ? err.status : BR_OK;
    status = br_program.beam ? br_program.beam->end(status, &err) : status;
    if (!br_is_first())
        return 0; /* rank 0 prints the error, and ends with the exit code */
    if (status == BR_INTERRUPTED) {
        fprintf(stderr, "beamrate: interrupted; no file is half written%s\n",
                br_cache_has_work() ? "; --resume continues the same command" : "");
        br_signals_raise_again();
    }
    if (!status && br_signals_caught()) { /* a script must see that a signal came */
        fprintf(stderr, "beamrate: interrupted after everything was written\n");
        br_signals_raise_again();
    }
    if (status) /* the message may quote a file */
        br_print(stderr, &br_for_text, "beamrate: %s\n", err.message);
    return br_status_exit_code(status);
}

int br_run_program(int argc, const char **argv)
{
    setvbuf(stderr, NULL, _IOLBF, BUFSIZ); /* lines of several programs do not mix */
    on_exit(name_the_end, NULL);
    gsl_set_error_handler_off(); /* its default ends the program; all its results are checked */
    br_json_lacked_memory();     /* installs its allocator */
    const int code = run_all(argc, argv);
    returned = true;
    return code;
}
