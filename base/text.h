/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is written into memory: a text, as a file, and records of numbers. The C library's
 * open_memstream loses a write that lacks memory and says nothing of it, neither by ferror nor by
 * fclose. */
#ifndef BR_BASE_TEXT_H
#define BR_BASE_TEXT_H

#include <stdbool.h>
#include <stdio.h>

/* Opens it; NULL: out of memory. fclose is 0 where all that was written is in *text (out, owned by
 * the caller): *size bytes (out) and a zero. Else *text is NULL and *size 0. */
FILE *br_text_open(char **text, size_t *size);

/* ---- numbers as bytes, for this program on this machine ---- */

/* One function passes the numbers of a record, to read and to write them. Each has a range, with
 * its ends; a number out of it, or a rest, makes the record wrong, and nothing passes any more. */
struct br_record {
    const char *from; /* `left` bytes; NULL: it writes */
    size_t left;
    FILE *to;
    bool wrong;
    bool no_memory; /* for a text that was read: why it is wrong */
};
typedef void br_record_pass(struct br_record *record, void *self);

void br_record_bytes(struct br_record *record, void *bytes, size_t size); /* of any value */
void br_record_number(struct br_record *record, double *x, double low, double high);
void br_record_or_nan(struct br_record *record, double *x, double low, double high);
void br_record_count(struct br_record *record, size_t *count, size_t low, size_t high);
void br_record_flag(struct br_record *record, bool *flag);
/* UTF-8, of at most `most` bytes. What is read is owned by the caller, even of a wrong record. */
void br_record_text(struct br_record *record, char **text, size_t most);

#endif
