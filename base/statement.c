/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/statement.h"

#include <stdarg.h>
#include <stdlib.h>

#include "base/text.h"

void br_statement_begin(struct br_statement *s)
{
    *s = (struct br_statement){0};
    s->file = br_text_open(&s->text, &s->size);
    s->failed = !s->file;
}

char *br_statement_end(struct br_statement *s)
{
    s->failed |= s->file && fclose(s->file) != 0;
    if (s->failed) {
        free(s->text);
        s->text = NULL;
    }
    return s->text;
}

void br_state(struct br_statement *s, const char *name, const char *format, ...)
{
    char *value = NULL;
    va_list values;
    va_start(values, format);
    const int size = s->failed ? -1 : vasprintf(&value, format, values);
    va_end(values);
    if (size < 0)
        s->failed = true;
    else {
        s->failed |= fprintf(s->file, "%s %d %s\n", name, size, value) < 0;
        free(value);
    }
}
