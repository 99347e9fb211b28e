/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/text.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "base/status.h"

struct memory {
    char **text;
    size_t *size, room;
    bool lost;
};

static ssize_t add(void *self, const char *bytes, size_t count)
{
    struct memory *m = self;
    const size_t needed = *m->size + count + 1;
    const size_t room = needed > m->room ? 2 * needed : m->room;
    char *text = m->lost || room == m->room ? *m->text : realloc(*m->text, room);
    m->lost |= !text;
    if (m->lost)
        return 0;
    memcpy(text + *m->size, bytes, count);
    *m->text = text;
    m->room = room;
    *m->size += count;
    text[*m->size] = '\0';
    return (ssize_t)count;
}

static int end(void *self)
{
    struct memory *m = self;
    const bool lost = m->lost;
    if (lost) {
        free(*m->text);
        *m->text = NULL;
        *m->size = 0;
        errno = ENOMEM;
    }
    free(m);
    return lost ? EOF : 0;
}

FILE *br_text_open(char **text, size_t *size)
{
    struct memory *m = malloc(sizeof *m);
    *text = calloc(1, 1);
    *size = 0;
    FILE *file = m && *text
                     ? fopencookie(m, "w", (cookie_io_functions_t){.write = add, .close = end})
                     : NULL;
    if (file)
        *m = (struct memory){.text = text, .size = size, .room = 1};
    else {
        free(*text);
        *text = NULL;
        free(m);
    }
    return file;
}

/* ---- records ---- */

void br_record_bytes(struct br_record *r, void *bytes, size_t size)
{
    if (r->wrong || size == 0)
        return;
    if (!r->from)
        r->wrong = fwrite(bytes, size, 1, r->to) != 1;
    else if (size > r->left)
        r->wrong = true;
    else {
        memcpy(bytes, r->from, size);
        r->from += size;
        r->left -= size;
    }
}

static void pass(struct br_record *r, double *x, double low, double high, bool or_nan)
{
    double value = *x;
    br_record_bytes(r, &value, sizeof value);
    r->wrong |= !((value >= low && value <= high && isfinite(value)) || (or_nan && isnan(value)));
    if (!r->wrong)
        *x = value;
}

void br_record_number(struct br_record *r, double *x, double low, double high)
{
    pass(r, x, low, high, false);
}

void br_record_or_nan(struct br_record *r, double *x, double low, double high)
{
    pass(r, x, low, high, true);
}

void br_record_count(struct br_record *r, size_t *count, size_t low, size_t high)
{
    size_t value = *count;
    br_record_bytes(r, &value, sizeof value);
    r->wrong |= value < low || value > high;
    if (!r->wrong)
        *count = value;
}

void br_record_flag(struct br_record *r, bool *flag)
{
    size_t value = *flag;
    br_record_count(r, &value, 0, 1);
    *flag = value == 1;
}

void br_record_text(struct br_record *r, char **text, size_t most)
{
    const bool reads = r->from;
    size_t size = !reads && *text ? strlen(*text) : 0;
    br_record_count(r, &size, 0, reads && r->left < most ? r->left : most);
    if (reads)
        *text = r->wrong ? NULL : br_allocate(size + 1, 1);
    r->no_memory |= reads && !r->wrong && !*text;
    r->wrong |= r->no_memory;
    br_record_bytes(r, *text, size);
    r->wrong |= reads && *text && (strlen(*text) != size || br_not_utf8(*text));
}
