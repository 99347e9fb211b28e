/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/command_help.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* popt begins the text of an option in the same column, that of its wrapped lines; an option's name
 * stands left of it. */
enum { LEAST_INDENT = 8 };

/* The command's help in a file. */
static enum br_status print_into(const struct br_command *command, FILE *file, struct br_error *err)
{
    char name[64];
    snprintf(name, sizeof name, "beamrate %s", command->name);
    const char *argv[] = {name, "--help", NULL};
    fflush(stdout);
    const int kept = dup(STDOUT_FILENO);
    if (kept < 0 || dup2(fileno(file), STDOUT_FILENO) < 0)
        return br_fail(err, BR_IO, "standard output: %s", strerror(errno));
    const enum br_status status = command->run(2, argv, err);
    fflush(stdout);
    const bool restored = dup2(kept, STDOUT_FILENO) >= 0;
    close(kept);
    return restored ? status : br_fail(err, BR_IO, "standard output: %s", strerror(errno));
}

/* Appends a part of the text to an option's, with single blanks. */
static void append(struct br_help_option *o, const char *text)
{
    const size_t used = strlen(o->help);
    snprintf(o->help + used, sizeof o->help - used, "%s%s", used ? " " : "", text);
}

/* "  -x, --name=ARGUMENT    text" */
static bool read_option(const char *line, struct br_help_option *o)
{
    const char *text = line + strspn(line, " ");
    if (text == line)
        return false;
    if (text[0] == '-' && text[1] != '-' && text[1] && strncmp(text + 2, ", ", 2) == 0)
        text += 4;
    if (strncmp(text, "--", 2) != 0)
        return false;
    *o = (struct br_help_option){0};
    text += 2;
    const size_t name = strcspn(text, "=[ ");
    snprintf(o->name, sizeof o->name, "%.*s", (int)name, text);
    text += name + (text[name] == '[');
    if (*text == '=') {
        const size_t argument = strcspn(text + 1, " ]");
        snprintf(o->argument, sizeof o->argument, "%.*s", (int)argument, text + 1);
        text += 1 + argument;
    }
    text += strspn(text, "] ");
    append(o, text);
    return name > 0;
}

static void read_lines(FILE *file, struct br_command_help *help)
{
    char line[1024];
    bool inside = false; /* an option, whose text may go on */
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        const size_t indent = strspn(line, " ");
        if (help->count < BR_MOST_OPTIONS && read_option(line, &help->option[help->count])) {
            help->count++;
            inside = true;
        } else if (inside && indent >= LEAST_INDENT && line[indent])
            append(&help->option[help->count - 1], line + indent);
        else
            inside = false;
    }
}

enum br_status br_command_help_read(const struct br_command *command, struct br_command_help *help,
                                    struct br_error *err)
{
    *help = (struct br_command_help){0};
    FILE *file = tmpfile();
    if (!file)
        return br_fail(err, BR_IO, "a temporary file: %s", strerror(errno));
    const enum br_status status = print_into(command, file, err);
    rewind(file);
    if (!status)
        read_lines(file, help);
    fclose(file);
    return status;
}
