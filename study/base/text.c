/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/base/text.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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
