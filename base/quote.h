/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quotes strings that do not come from the program itself (titles, remarks, names of files,
 * messages that repeat them). All output of such strings uses one of these targets; only JSON is
 * written by jansson.
 *
 * In all targets a text stays on one line: line ends and tabs become blanks. Invisible characters
 * become visible: control characters, marks that change the direction of writing, and bytes that
 * are not UTF-8 are written as \x1b, \u202e, \xff.
 *
 * To add a target: add one record. What text files hold must be UTF-8: br_text_load refuses others.
 */
#ifndef BR_BASE_QUOTE_H
#define BR_BASE_QUOTE_H

#include <stdbool.h>
#include <stdio.h>

/* How a target quotes a text. */
struct br_quoting {
    const char *around; /* quotes before and after the text, ... */
    const char *bare;   /* or these, if it has none of the `rough` characters */
    const char *rough;
    bool nothing;        /* an empty text gets `around`, too */
    const char *start;   /* a text that begins with one of these, behind blanks, and is no number */
    const char *prefix;  /* gets this prefix */
    const char *escaped; /* characters that get a backslash before them */
    const char *broken[2]; /* texts that get a blank before their last character */
    struct br_stead {
        char character;
        const char *stead;
    } stead[20]; /* replacements of other characters; ends with zeros */
};

extern const struct br_quoting br_for_text;     /* a terminal, a text file */
extern const struct br_quoting br_for_gnuplot;  /* a string, with its quotes */
extern const struct br_quoting br_for_markup;   /* gnuplot's enhanced text, within a string */
extern const struct br_quoting br_for_latex;    /* running text, or a cell */
extern const struct br_quoting br_for_markdown; /* the same; no HTML comes through */
extern const struct br_quoting br_for_xml;      /* text, or an attribute's value */
extern const struct br_quoting br_for_csv;      /* a field (RFC 4180), never a formula */
extern const struct br_quoting br_for_github;   /* the message of a GitHub annotation */
extern const struct br_quoting br_for_github_property;
extern const struct br_quoting br_for_shell; /* a word */

/* Writes a text for a target. */
void br_quote(FILE *out, const struct br_quoting *target, const char *text);

/* printf whose texts are written for a target (NULL: an empty one): of %s, %d, %zu, %%, numbers. */
__attribute__((format(printf, 3, 4))) void br_print(FILE *out, const struct br_quoting *target,
                                                    const char *format, ...);

/* The same as br_quote into a buffer, which it returns. Characters that do not fit are left out as
 * a whole. */
char *br_quoted(char *buffer, size_t size, const struct br_quoting *target, const char *text);

/* Writes a comment of a gnuplot script or a data file, and the end of its line. */
void br_write_comment(FILE *out, const char *text);

/* The first byte of a text that is not UTF-8; NULL: all of it is. */
const char *br_not_utf8(const char *text);

/* Whether a text may be a file's name, or the beginning of one: letters, digits, blanks, _ . - +
 * and visible characters that are not ASCII, without a blank or . - + at the start. No program
 * reads such a name as a command, an option or a pattern. */
bool br_is_name(const char *text);

/* Makes such a name of a text, in place: other characters become _. At most 100 bytes. */
void br_make_name(char *text);

#endif
