/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of a command, at one resolution each. */
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <wordexp.h>

#include "base/quote.h"
#include "base/words.h"
#include "orders/request.h"

enum {
    NUMBER = 32, /* bytes of a resolution's text, with the zero at the end */
    SHOWN = 200  /* bytes of foreign text in a message */
};

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
            const double x = s->row->given[i];
            if (column->is_size)
                br_shortest(x, *to, NUMBER);
            else /* counts have no exponent */
                snprintf(*to, NUMBER, "%.0f", x);
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

/* A copy with each brace replaced. The text for a brace has no blanks. NULL: see *err. */
static char *fill(struct split *s, const char *text, struct br_error *err)
{
    char *filled = br_allocate(strlen(text) + 1, NUMBER), *to = filled;
    if (!filled)
        br_no_memory(err, "the words of a command");
    for (s->rest = text; filled && *s->rest;)
        if (*s->rest != '{')
            *to++ = *s->rest++;
        else if (replace(s, &to, err)) {
            free(filled);
            filled = NULL;
        }
    return filled;
}

/* ---- words, as the C library splits them for shells ---- */

/* What wordexp would replace stands for itself: braces, patterns, and $1, which is meant for awk.
 * The library sees other characters in their place. */
static const char own[] = "{}*?[$", other[] = "\1\2\3\4\5\6";

static bool is_variable(const char *sign)
{
    return isalpha((unsigned char)sign[1]) || (sign[1] && strchr("_(", sign[1]));
}

static void exchange(char *text, const char *from, const char *to)
{
    for (char *at = text; *at; at++) {
        const char *found = strchr(from, *at);
        if (found && !(*at == '$' && (is_variable(at) || (at > text && at[-1] == '\\'))))
            *at = to[found - from];
    }
}

/* Refuses what only a shell does, and says how to start one. */
static enum br_status refuse_shell(const char *command, const char *here, const char *what,
                                   struct br_error *err)
{
    char shown[SHOWN], folder[SHOWN];
    const char *quote = strchr(here, ' ') ? "\"" : "";
    if (strchr(command, '\''))
        return br_fail(
            err, BR_BAD_INPUT,
            "the command has %s, and no shell is used: put the command into a script, or "
            "the sign into quotes",
            what);
    return br_fail(err, BR_BAD_INPUT,
                   "the command has %s, and no shell is used; to use one: sh -c 'cd %s%s%s && %s'",
                   what, quote, br_quoted(folder, sizeof folder, &br_for_text, here), quote,
                   br_quoted(shown, sizeof shown, &br_for_text, command));
}

static enum br_status refuse_words(const char *command, const char *here, int failure,
                                   struct br_error *err)
{
    if (failure == WRDE_BADCHAR)
        return refuse_shell(command, here, "a sign of | & ; < > ( ) or a line end", err);
    if (failure == WRDE_CMDSUB)
        return refuse_shell(command, here, "$( or `", err);
    if (failure == WRDE_BADVAL)
        return br_fail(err, BR_BAD_INPUT,
                       "the command has a variable that is not set; in '...' a $ is a $");
    return failure == WRDE_SYNTAX
               ? br_fail(err, BR_BAD_INPUT, "the command ends within quotes, or with a \\")
               : br_no_memory(err, "the words of a command");
}

/* Splits the command into words (out; free them where this succeeds), with their braces. */
static enum br_status take_words(const char *command, const char *here, wordexp_t *words,
                                 struct br_error *err)
{
    size_t length = strlen(command);
    if (command[strcspn(command, other)])
        return br_fail(err, BR_BAD_INPUT, "the command has a control character, expected text");
    while (length && strchr(" \t\n", command[length - 1])) /* the line end of a YAML block */
        length--;
    char *text = strndup(command, length);
    if (!text)
        return br_no_memory(err, "the words of a command");
    exchange(text, own, other);
    *words = (wordexp_t){0};
    const int failure = wordexp(text, words, WRDE_NOCMD | WRDE_UNDEF);
    free(text);
    for (size_t i = 0; i < words->we_wordc && !failure; i++)
        exchange(words->we_wordv[i], other, own);
    if (failure == 0 || failure == WRDE_NOSPACE) /* the latter has some of the words */
        return failure ? (wordfree(words), br_no_memory(err, "the words of a command")) : BR_OK;
    return refuse_words(command, here, failure, err);
}

/* ---- files ---- */

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

static bool is_program(const char *path)
{
    struct stat info;
    return *path == '/' && stat(path, &info) == 0 && S_ISREG(info.st_mode) &&
           access(path, X_OK) == 0;
}

/* The path of a program in PATH; NULL: no memory. It has to be known, since its runs are cached
 * under its contents, and a change of it during a study is noticed. */
static char *search(const char *here, const char *name)
{
    const char *folders = getenv("PATH"), *folder = folders ? folders : "/usr/bin:/bin";
    char *path = strdup(name), *in;
    while (path && *(folder += strspn(folder, ":")) && !is_program(path)) {
        const int length = (int)strcspn(folder, ":");
        free(path);
        if (asprintf(&in, "%.*s/%s", length, folder, name) < 0)
            return NULL;
        path = whole_path(here, in);
        free(in);
        folder += length;
    }
    return path;
}

static enum br_status find_program(const char *here, const char *name, char **program,
                                   struct br_error *err)
{
    const bool direct = strchr(name, '/');
    char shown[SHOWN], *file = whole_path(here, name);
    const bool is_file = file && *file == '/' && access(file, F_OK) == 0;
    *program = direct ? file : search(here, name);
    if (!direct)
        free(file);
    if (!*program)
        return br_no_memory(err, "a program's path");
    if (is_program(*program))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "'%s' is no program%s%s",
                   br_quoted(shown, sizeof shown, &br_for_text, name),
                   direct ? "" : ", no folder of PATH has it",
                   !is_file ? ""
                   : direct ? ": it is not executable; chmod +x makes it so"
                            : "; a file here needs ./ before it");
}

/* The script that an interpreter is to run ("python3 x.py"), where no file has its name; NULL:
 * there is none. Options before it, and whatever is no plain name of a file, are left alone. */
static const char *lost_script(char *const *word)
{
    static const char *const interpreters[] = {"python", "julia", "Rscript", "octave",
                                               "perl",   "ruby",  "sh",      "bash",
                                               "lua",    "node",  "php",     "FreeFem++"};
    bool follows = false;
    for (; *word; word++) {
        const char *slash = strrchr(*word, '/'), *name = slash ? slash + 1 : *word;
        const char *dot = strrchr(name, '.');
        const size_t letters = dot ? strspn(dot + 1, "abcdefghijklmnopqrstuvwxyzR") : 0;
        if (follows && **word == '-') {
            follows = !strchr("cem", (*word)[1]); /* code, or a module */
            continue;
        }
        if (follows && letters && letters <= 3 && !dot[1 + letters] && !strpbrk(*word, " =:") &&
            (**word != '/' || access(*word, F_OK) != 0)) /* a file that is there has its path */
            return *word;
        follows = false;
        for (size_t i = 0; i < sizeof interpreters / sizeof *interpreters; i++) {
            const size_t length = strlen(interpreters[i]);
            follows |= strncmp(name, interpreters[i], length) == 0 &&
                       strspn(name + length, ".0123456789") == strlen(name + length);
        }
    }
    return NULL;
}

/* ---- all ---- */

static enum br_status fill_words(struct split *s, const char *here, const wordexp_t *words,
                                 struct br_command_words *c, struct br_error *err)
{
    const char *const first = words->we_wordc ? words->we_wordv[0] : "";
    const size_t name = strcspn(first, "=/");
    if (!*first)
        return br_fail(err, BR_BAD_INPUT, "the command is empty, expected a program");
    if (strcmp(first, "cd") == 0 || first[name] == '=')
        return refuse_shell(s->request->command, here, first[name] ? "a variable to set" : "'cd'",
                            err);
    for (size_t i = 0; i < words->we_wordc; i++) {
        char *word = fill(s, words->we_wordv[i], err);
        c->word[i] = word && i > 0 ? whole_path(here, word) : word;
        if (i > 0)
            free(word);
        if (!c->word[i])
            return word ? br_no_memory(err, "the words of a command") : err->status;
    }
    for (int i = 0; i < BR_AXES; i++)
        if (s->request->axis[i].column && !s->used[i])
            return br_fail(err, BR_BAD_INPUT, "the command has no {%s}, expected one for its list",
                           s->request->axis[i].column->name);
    if (find_program(here, c->word[0], &c->program, err))
        return err->status;
    const char *lost = lost_script(c->word);
    char shown[SHOWN], folder[SHOWN];
    return lost ? br_fail(err, BR_BAD_INPUT, "%s runs '%s', and no file is there (in %s)",
                          c->word[0], br_quoted(shown, sizeof shown, &br_for_text, lost),
                          br_quoted(folder, sizeof folder, &br_for_text, here))
                : BR_OK;
}

enum br_status br_command_split(const struct br_orders_request *r, const struct br_numbers_row *row,
                                struct br_command_words *c, struct br_error *err)
{
    char here[PATH_MAX]; /* the folder of relative names */
    struct split s = {r, row, NULL, {false}};
    wordexp_t words;
    if (!(r->folder ? realpath(r->folder, here) : getcwd(here, sizeof here)))
        return br_fail(err, BR_IO, "the folder of the command: %s", strerror(errno));
    if (take_words(r->command, here, &words, err))
        return err->status;
    c->word = br_allocate(words.we_wordc + 1, sizeof *c->word);
    c->file = br_allocate(r->readings + 1, sizeof *c->file);
    enum br_status status = c->word && c->file ? fill_words(&s, here, &words, c, err)
                                               : br_no_memory(err, "the words of a command");
    wordfree(&words);
    for (size_t i = 0; i < r->readings && !status; i++)
        if (r->reading[i].file) {
            c->file[c->files++] = fill(&s, r->reading[i].file, err);
            status = c->file[c->files - 1] ? BR_OK : err->status;
        }
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
