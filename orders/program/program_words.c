/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of a command, at one resolution each. */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/quote.h"
#include "orders/request.h"

enum {
    NUMBER = 32, /* bytes of a resolution's text, with the zero at the end */
    SHOWN = 200  /* bytes of foreign text in a message */
};

/* Prints counts without a point, and sizes with as few digits as they need. */
static void print_number(const struct br_resolution_column *column, double x, char text[NUMBER])
{
    snprintf(text, NUMBER, "%.0f", x);
    for (int digits = 1; column->is_size && digits <= 17; digits++) {
        snprintf(text, NUMBER, "%.*g", digits, x);
        if (strtod(text, NULL) == x)
            break;
    }
}

/* A command that is split into words. */
struct split {
    const struct br_orders_request *request;
    const struct br_numbers_row *row;
    const char *rest;
    bool used[BR_AXES];
};

/* Replaces a brace by its text. */
static enum br_status replace(struct split *s, char **to, struct br_error *err)
{
    char shown[NUMBER], expected[3 * NUMBER] = "";
    if (s->rest[1] == '{') {
        *(*to)++ = '{';
        s->rest += 2;
        return BR_OK;
    }
    if (s->request->repeat > 1 && strncmp(s->rest, "{repeat}", 8) == 0) {
        *to += sprintf(*to, "%zu", s->row->repeat);
        s->rest += 8;
        return BR_OK;
    }
    for (int i = 0; i < BR_AXES; i++) {
        const struct br_resolution_column *column = s->request->axis[i].column;
        const size_t length = column ? strlen(column->name) : 0, end = strlen(expected);
        if (!column)
            continue;
        if (strncmp(s->rest + 1, column->name, length) == 0 && s->rest[1 + length] == '}') {
            print_number(column, s->row->given[i], *to);
            *to += strlen(*to);
            s->rest += length + 2;
            s->used[i] = true;
            return BR_OK;
        }
        snprintf(expected + end, sizeof expected - end, "%s{%s}", end ? " or " : "", column->name);
    }
    return br_fail(err, BR_BAD_INPUT, "found '{' before '%s', expected %s; {{ is a brace",
                   br_quoted(shown, sizeof shown, &br_for_text, s->rest + 1), expected);
}

/* Refuses what only a shell does, and says how to start one. */
static enum br_status refuse_shell(const struct split *s, const char *here, const char *sign,
                                   int length, struct br_error *err)
{
    char shown[SHOWN], folder[SHOWN];
    const bool quotes = strchr(s->request->command, '\'');
    br_quoted(shown, sizeof shown, &br_for_text, s->request->command);
    br_quoted(folder, sizeof folder, &br_for_text, here);
    return quotes ? br_fail(err, BR_BAD_INPUT,
                            "the command has '%.*s', and no shell is used: put the command into a "
                            "script, or '%.*s' into quotes",
                            length, sign, length, sign)
                  : br_fail(err, BR_BAD_INPUT,
                            "the command has '%.*s', and no shell is used; to use one: sh -c 'cd "
                            "%s && %s'",
                            length, sign, folder, shown);
}

/* Takes the next word; there must be one. The text for a brace has no blanks and no quotes. */
static enum br_status take_word(struct split *s, const char *here, char *to, struct br_error *err)
{
    char quote = '\0'; /* the open one; zero: none */
    while (*s->rest && (quote || !strchr(" \t\n", *s->rest))) {
        const char c = *s->rest, next = s->rest[1];
        const bool escape =
            c == '\\' && next && (!quote || (quote == '"' && strchr("\"\\$`", next)));
        const bool shell =
            !quote && (strchr("|&;<>`", c) ||
                       (c == '$' && (isalpha((unsigned char)next) || next == '(' || next == '{')));
        if (shell)
            return refuse_shell(s, here, s->rest, 1 + (c == next), err);
        if (c == '{') {
            if (replace(s, &to, err))
                return err->status;
            continue;
        }
        if (escape)
            *to++ = next;
        else if (c == quote)
            quote = '\0';
        else if (!quote && strchr("'\"\\", c)) /* a \ comes here only as the last character */
            quote = c;
        else
            *to++ = c;
        s->rest += 1 + escape;
    }
    *to = '\0';
    return quote ? br_fail(err, BR_BAD_INPUT, "the command's quote %c is not closed", quote)
                 : BR_OK;
}

/* The whole path of a word that names a file in `here`, since the program runs in another folder;
 * any other word as it is. */
static char *whole_path(const char *here, const char *word)
{
    struct stat info;
    char *path;
    if (asprintf(&path, "%s/%s", here, word) < 0)
        return NULL;
    if (!*word || *word == '/' || stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        strcpy(path, word);
    return path;
}

/* Finds the program as a shell does; relative paths, also those in PATH, are relative to `here`. */
static enum br_status find_program(const char *here, const char *name, char **program,
                                   struct br_error *err)
{
    const char *folders = getenv("PATH");
    char shown[SHOWN];
    struct stat info;
    const bool direct = strchr(name, '/');
    for (const char *f = direct ? "" : folders ? folders : "/usr/bin:/bin"; f;) {
        const int length = (int)strcspn(f, ":");
        const bool absolute = direct ? *name == '/' : *f == '/';
        free(*program);
        if (asprintf(program, "%s%s%.*s%s%s", absolute ? "" : here, absolute ? "" : "/", length, f,
                     length ? "/" : "", name) < 0) {
            *program = NULL;
            return br_no_memory(err, "a program's path");
        }
        if (stat(*program, &info) == 0 && S_ISREG(info.st_mode) && access(*program, X_OK) == 0)
            return BR_OK;
        f = f[length] ? f + length + 1 : NULL;
    }
    free(*program);
    if (asprintf(program, "%s%s%s", *name == '/' ? "" : here, *name == '/' ? "" : "/", name) < 0)
        *program = NULL;
    const bool here_too = *program && stat(*program, &info) == 0 && S_ISREG(info.st_mode);
    return br_fail(err, BR_BAD_INPUT, "'%s' is no program%s",
                   br_quoted(shown, sizeof shown, &br_for_text, name),
                   !direct ? here_too ? ", no folder of PATH has it; a file here needs ./ before it"
                                      : ", no folder of PATH has it"
                   : here_too ? ": it is not executable; chmod +x makes it so"
                              : "");
}

/* word: a buffer for any word. */
static enum br_status take_words(struct split *s, const char *here, char *word,
                                 struct br_command_words *c, struct br_error *err)
{
    for (size_t i = 0; *(s->rest += strspn(s->rest, " \t\n")); i++) {
        const char *begin = s->rest;
        const size_t name = strcspn(begin, "= \t\n'\"");
        if (i == 0 && (strncmp(begin, "cd ", 3) == 0 || (name && begin[name] == '=')))
            return refuse_shell(s, here, begin, (int)name + (begin[name] == '='), err);
        if (take_word(s, here, word, err))
            return err->status;
        c->word[i] = i ? whole_path(here, word) : strdup(word);
        if (!c->word[i])
            return br_no_memory(err, "the words of a command");
    }
    if (!c->word[0] || !*c->word[0])
        return br_fail(err, BR_BAD_INPUT, "the command is empty, expected a program");
    for (int i = 0; i < BR_AXES; i++)
        if (s->request->axis[i].column && !s->used[i])
            return br_fail(err, BR_BAD_INPUT, "the command has no {%s}, expected one for its list",
                           s->request->axis[i].column->name);
    return find_program(here, c->word[0], &c->program, err);
}

/* Takes the name of a file that a reading looks into. */
static enum br_status take_file(struct split *s, const char *file, char *word,
                                struct br_command_words *c, struct br_error *err)
{
    char *to = word;
    for (s->rest = file; *s->rest;)
        if (*s->rest != '{')
            *to++ = *s->rest++;
        else if (replace(s, &to, err))
            return err->status;
    *to = '\0';
    c->file[c->files] = strdup(word);
    return c->file[c->files++] ? BR_OK : br_no_memory(err, "what is read");
}

enum br_status br_command_split(const struct br_orders_request *request,
                                const struct br_numbers_row *row, struct br_command_words *c,
                                struct br_error *err)
{
    char here[PATH_MAX]; /* the folder of relative names */
    if (!(request->folder ? realpath(request->folder, here) : getcwd(here, sizeof here)))
        return br_fail(err, BR_IO, "the folder of the command: %s", strerror(errno));
    size_t most = strlen(request->command) + 1;
    for (size_t i = 0; i < request->readings; i++)
        if (request->reading[i].file && strlen(request->reading[i].file) >= most)
            most = strlen(request->reading[i].file) + 1;
    char *word = br_allocate(most, NUMBER);
    struct split s = {request, row, .rest = request->command};
    c->word = br_allocate(most + 1, sizeof *c->word);
    c->file = br_allocate(request->readings + 1, sizeof *c->file);
    enum br_status status = word && c->word && c->file
                                ? take_words(&s, here, word, c, err)
                                : br_no_memory(err, "the words of a command");
    for (size_t i = 0; i < request->readings && !status; i++)
        if (request->reading[i].file)
            status = take_file(&s, request->reading[i].file, word, c, err);
    free(word);
    return status;
}

void br_command_clear(struct br_command_words *c)
{
    for (char **word = c->word; word && *word; word++)
        free(*word);
    for (size_t i = 0; i < c->files; i++)
        free(c->file[i]);
    free(c->word);
    free(c->file);
    free(c->program);
}
