/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Strings that others have written (titles, remarks, names of files, messages that repeat them) on
 * their way into a text. Everything that the program writes passes one of these targets; JSON is
 * jansson's.
 *
 * In all targets a text stays on its line: line ends and tabs become blanks. What cannot be seen
 * becomes visible: control characters, marks that turn the direction of writing, and bytes that are
 * no UTF-8 are written as \x1b, \u202e, \xff.
 *
 * To add a target: one record. */
#ifndef BR_STUDY_SCENE_QUOTE_H
#define BR_STUDY_SCENE_QUOTE_H

#include <stdbool.h>
#include <stdio.h>

/* What a text becomes. */
struct br_quoting {
    const char *around; /* stands before and after it, ... */
    const char *bare;   /* or this, where it has none of the `rough` characters */
    const char *rough;
    bool nothing;        /* an empty text needs to be seen, too */
    const char *start;   /* a text that begins with one of these, and is no number, ... */
    const char *guard;   /* gets this before it */
    const char *escaped; /* characters that get a backslash before them */
    struct br_stead {
        char character;
        const char *stead;
    } stead[20]; /* what is written for other characters; ends with zeros */
};

extern const struct br_quoting br_for_text;     /* a terminal, a text file */
extern const struct br_quoting br_for_gnuplot;  /* a string, with its quotes */
extern const struct br_quoting br_for_markup;   /* gnuplot's enhanced text, within a string */
extern const struct br_quoting br_for_latex;    /* running text, or a cell */
extern const struct br_quoting br_for_markdown; /* the same; no HTML comes through */
extern const struct br_quoting br_for_xml;      /* text, or an attribute's value */
extern const struct br_quoting br_for_csv;      /* a field (RFC 4180), never a formula */
extern const struct br_quoting br_for_yaml;     /* a double-quoted scalar */
extern const struct br_quoting br_for_tap;      /* a description, without directives */
extern const struct br_quoting br_for_github;   /* the message of a GitHub annotation */
extern const struct br_quoting br_for_github_property;
extern const struct br_quoting br_for_shell;      /* a word */
extern const struct br_quoting br_for_completion; /* a string of any shell, without backslashes */
extern const struct br_quoting br_for_zsh;        /* the same within the brackets of _arguments */

/* Writes a text for a target. */
void br_quote(FILE *out, const struct br_quoting *target, const char *text);

/* The same into a buffer, which it returns; what has no room is left out, whole characters of it.
 */
char *br_quoted(char *buffer, size_t size, const struct br_quoting *target, const char *text);

/* A comment of a gnuplot script or a data file, to the end of its line. */
void br_write_comment(FILE *out, const char *text);

/* Whether a text is UTF-8 throughout. */
bool br_is_utf8(const char *text);

/* Whether a text may be a file's name, or begin one: letters, digits, blanks, _ . - + and what is
 * not ASCII and can be seen, with no blank and none of . - + at the start. Such a name is no
 * command, no option and no pattern to anybody. */
bool br_is_name(const char *text);

/* Makes one of a text, in place: what may not stand there becomes _. At most 100 bytes. */
void br_make_name(char *text);

#endif
