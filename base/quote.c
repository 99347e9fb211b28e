/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/quote.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ---- the targets ---- */

const struct br_quoting br_for_text = {.around = ""};

/* Nothing is special between single quotes, but gnuplot 5.4 breaks its own rule for a single quote
 * there. Octal codes mean the same in blocks and outside, and have no other effect. gnuplot puts
 * "]]>" and "&#" into SVG as they are, where they are not text. */
const struct br_quoting br_for_gnuplot = {
    .around = "\"",
    .bare = "'",
    .rough = "']&",
    .broken = {"]]>", "&#"},
    .stead = {{'"', "\\042"},
              {'\'', "\\047"},
              {'\\', "\\134"},
              {'`', "\\140"},
              {'@', "\\100"},
              {'#', "\\043"},
              {'{', "\\173"},
              {'}', "\\175"}},
};

const struct br_quoting br_for_markup = {.around = "", .escaped = "_^{}@&~\\"};

/* [ is in braces since it could be the option of a \\ before it. */
const struct br_quoting br_for_latex = {
    .around = "",
    .escaped = "_%&#${}",
    .stead = {{'^', "\\^{}"},
              {'\\', "\\textbackslash{}"},
              {'~', "\\textasciitilde{}"},
              {'[', "{[}"},
              {'|', "$|$"},
              {'<', "$<$"},
              {'>', "$>$"}},
};

const struct br_quoting br_for_markdown = {.around = "", .escaped = "*_|`<>[]&\\"};

const struct br_quoting br_for_xml = {
    .around = "",
    .stead = {{'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}},
};

/* Spreadsheets evaluate a text that begins like a formula. */
const struct br_quoting br_for_csv = {
    .around = "\"",
    .bare = "",
    .rough = ",\"\n\r",
    .start = "=+-@",
    .prefix = "'",
    .stead = {{'"', "\"\""}},
};

const struct br_quoting br_for_github = {.around = "", .stead = {{'%', "%25"}}};

const struct br_quoting br_for_github_property = {
    .around = "",
    .stead = {{'%', "%25"}, {':', "%3A"}, {',', "%2C"}},
};

const struct br_quoting br_for_shell = {
    .around = "'",
    .bare = "",
    .rough = " \t\r\n'\"\\$*?;&|<>()[]{}#~`!^",
    .nothing = true,
    .stead = {{'\'', "'\\''"}},
};

/* ---- characters ---- */

/* Returns the bytes of the first character, 0: not UTF-8. *code (out): its number. */
static size_t decode(const unsigned char *text, unsigned long *code)
{
    static const unsigned long least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char c = text[0];
    const size_t length = c < 0x80 ? 1 : c >> 5 == 6 ? 2 : c >> 4 == 14 ? 3 : c >> 3 == 30 ? 4 : 0;
    *code = length < 2 ? c : c & (0x7fUL >> length);
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 0;
        *code = *code << 6 | (text[i] & 0x3fUL);
    }
    const bool surrogate = *code >= 0xd800 && *code < 0xe000;
    return *code < least[length] || surrogate || *code > 0x10ffff ? 0 : length;
}

const char *br_not_utf8(const char *text)
{
    unsigned long code;
    for (size_t length; *text; text += length) {
        length = decode((const unsigned char *)text, &code);
        if (!length)
            return text;
    }
    return NULL;
}

/* Whether a character is invisible or changes how its neighbours are shown. */
static bool is_hidden(unsigned long code)
{
    static const unsigned long ranges[][2] = {
        {0, 0x1f},        {0x7f, 0x9f},     {0x61c, 0x61c},   {0x200b, 0x200f}, {0x2028, 0x202e},
        {0x2060, 0x206f}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb}, {0xfffe, 0xffff}, {0xe0000, 0xe007f},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (code >= ranges[i][0] && code <= ranges[i][1])
            return true;
    return false;
}

enum { PIECE = 32 };

/* Writes a visible character of `length` bytes for the target. */
static void write_visible(const struct br_quoting *target, const char *text, size_t length,
                          char piece[PIECE])
{
    const bool escaped = *text && target->escaped && strchr(target->escaped, *text);
    snprintf(piece, PIECE, "%s%.*s", escaped ? "\\" : "", (int)length, text);
    for (const struct br_stead *s = target->stead; s->character; s++)
        if (s->character == *text)
            snprintf(piece, PIECE, "%s", s->stead);
}

/* Writes the first character of a text for the target, or more, if a blank must follow; returns its
 * number of bytes. */
static size_t next_piece(const struct br_quoting *target, const char *text, char piece[PIECE])
{
    unsigned long code;
    const size_t length = decode((const unsigned char *)text, &code);
    for (int i = 0; i < 2 && target->broken[i]; i++) {
        const size_t first = strlen(target->broken[i]) - 1;
        if (strncmp(text, target->broken[i], first + 1) != 0)
            continue;
        snprintf(piece, PIECE, "%.*s ", (int)first, text);
        return first;
    }
    if (strchr("\n\r\t", *text))
        snprintf(piece, PIECE, " ");
    else if (length && !is_hidden(code))
        write_visible(target, text, length, piece);
    else {
        write_visible(target, "\\", 1, piece);
        const size_t used = strlen(piece);
        snprintf(piece + used, PIECE - used, length && code > 0xff ? "u%04lx" : "x%02lx",
                 length ? code : (unsigned char)*text);
    }
    return length ? length : 1;
}

/* The quotes before and after a text. */
static const char *quotes(const struct br_quoting *target, const char *text)
{
    const bool rough = !target->bare || (!*text && target->nothing) || strpbrk(text, target->rough);
    return rough ? target->around : target->bare;
}

static const char *prefix(const struct br_quoting *target, const char *text)
{
    char *end;
    const char *first = text + strspn(text, " \t\r\n"); /* spreadsheets skip blanks, too */
    if (!target->start || !*first || !strchr(target->start, *first))
        return "";
    strtod(first, &end);
    return *end ? target->prefix : "";
}

/* ---- writing ---- */

void br_quote(FILE *out, const struct br_quoting *target, const char *text)
{
    const bool bare = quotes(target, text) != target->around;
    fprintf(out, "%s%s", quotes(target, text), prefix(target, text));
    for (const char *c = text; *c;) {
        char piece[PIECE];
        c += next_piece(bare ? &br_for_text : target, c, piece);
        fputs(piece, out);
    }
    fputs(quotes(target, text), out);
}

void br_print(FILE *out, const struct br_quoting *target, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    for (const char *c = format; *c;) {
        char conversion[16];
        const size_t plain = strcspn(c, "%");
        fwrite(c, 1, plain, out);
        c += plain;
        const size_t size = *c ? 2 + strspn(c + 1, "+-.0123456789z") : 0;
        snprintf(conversion, sizeof conversion, "%.*s", (int)size, c);
        c += size;
        if (size && c[-1] == 's') {
            const char *text = va_arg(arguments, const char *);
            br_quote(out, target, text ? text : "");
        } else if (size && c[-1] == 'd')
            fprintf(out, conversion, va_arg(arguments, int));
        else if (size && c[-1] == 'u')
            fprintf(out, conversion, va_arg(arguments, size_t));
        else if (size && c[-1] != '%')
            fprintf(out, conversion, va_arg(arguments, double));
        else if (size)
            fputc('%', out);
    }
    va_end(arguments);
}

char *br_quoted(char *buffer, size_t size, const struct br_quoting *target, const char *text)
{
    const char *around = quotes(target, text);
    const bool bare = around != target->around;
    const size_t end = strlen(around) + 1;
    size_t used = (size_t)snprintf(buffer, size, "%s%s", around, prefix(target, text));
    while (*text) {
        char piece[PIECE];
        text += next_piece(bare ? &br_for_text : target, text, piece);
        if (used + strlen(piece) + end > size)
            break;
        used += (size_t)snprintf(buffer + used, size - used, "%s", piece);
    }
    snprintf(buffer + used, size - used, "%s", around);
    return buffer;
}

/* A backslash at the end would continue the comment on the next line. */
void br_write_comment(FILE *out, const char *text)
{
    const size_t length = strlen(text);
    br_quote(out, &br_for_text, text);
    fputs(length && text[length - 1] == '\\' ? ".\n" : "\n", out);
}

/* The number of bytes of the next character of a name. *kept (out): whether a name may have it. */
static size_t check_character(const char *c, bool first, bool *kept)
{
    unsigned long code;
    const size_t length = decode((const unsigned char *)c, &code);
    *kept = length > 1 ? !is_hidden(code)
                       : length && (isalnum((unsigned char)*c) || *c == '_' ||
                                    (!first && strchr(" .-+", *c)));
    return length ? length : 1;
}

bool br_is_name(const char *text)
{
    bool kept = *text;
    for (const char *c = text; *c && kept;)
        c += check_character(c, c == text, &kept);
    return kept;
}

void br_make_name(char *text)
{
    enum { MOST = 100 };
    char *to = text;
    for (const char *c = text; *c;) {
        bool kept;
        const size_t length = check_character(c, to == text, &kept);
        if (to + length > text + MOST)
            break;
        memmove(to, kept ? c : "_", kept ? length : 1);
        to += kept ? length : 1;
        c += length;
    }
    *to = '\0';
}
