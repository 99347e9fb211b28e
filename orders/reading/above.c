/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names by where they stand: in a table of aligned columns, a word of the heading belongs to the
 * column below it. So "L2 error" is one name, although a blank is within. */
#include <string.h>

#include "orders/reading/lines.h"

static bool overlap(struct br_span a, struct br_span b)
{
    return a.begin < b.end && b.begin < a.end;
}

/* The next word of a line, from *at on; its end is 0 behind the last one. */
static struct br_span next_word(const struct br_line *line, size_t *at)
{
    const char *const text = line->text;
    *at += strspn(text + *at, " ");
    const size_t begin = *at;
    *at += strcspn(text + begin, " ");
    return *at > begin ? (struct br_span){line->indent + begin, line->indent + *at}
                       : (struct br_span){0};
}

bool br_spans_widen(struct br_span *span, size_t columns, const struct br_line *row)
{
    size_t count = 0;
    struct br_span word;
    for (size_t at = 0; (word = next_word(row, &at)).end; count++) {
        if (count == columns)
            return false;
        struct br_span *const s = &span[count];
        s->begin = !s->end || word.begin < s->begin ? word.begin : s->begin;
        s->end = word.end > s->end ? word.end : s->end;
    }
    return count == columns;
}

/* The column with a name whose numbers, or the rates behind them, are below a word; columns: there
 * is none, or there are two. */
static size_t column_below(struct br_span word, const struct br_span *span, const bool *skipped,
                           size_t columns)
{
    size_t found = columns, named = columns;
    for (size_t i = 0; i < columns; i++) {
        named = skipped[i] ? named : i;
        if (!overlap(word, span[i]) || found == named)
            continue;
        if (found < columns)
            return columns;
        found = named;
    }
    return found;
}

/* Whether each word stands above its own column, or above none. */
static bool stand_above_own(const struct br_line *heading, const struct br_span *span,
                            size_t columns)
{
    size_t count = 0;
    struct br_span word;
    for (size_t at = 0; (word = next_word(heading, &at)).end; count++)
        for (size_t i = 0; i < columns; i++)
            if (overlap(word, span[i]) && !(count < columns && overlap(word, span[count])))
                return false;
    return count == columns;
}

bool br_names_above(const struct br_line *heading, const struct br_span *span, const bool *skipped,
                    size_t columns, char *room, const char **name)
{
    size_t last = columns, end = 0;
    struct br_span word;
    for (size_t i = 1; i < columns; i++)
        if (span[i].begin < span[i - 1].end)
            return false; /* they are not aligned */
    if (stand_above_own(heading, span, columns))
        return false; /* one word each */
    memset(name, 0, columns * sizeof *name);
    for (size_t at = 0; (word = next_word(heading, &at)).end;) {
        const size_t length = word.end - word.begin,
                     column = column_below(word, span, skipped, columns);
        const char *const text = heading->text + (word.begin - heading->indent);
        if (strspn(text, ".,:;#*-") >= length)
            continue; /* a sign alone is no name */
        if (column == columns || (last < columns && column < last) ||
            (column == last && word.begin > end + 1)) /* one name has single blanks */
            return false;
        if (column == last)
            room[-1] = ' ';
        else
            name[column] = room;
        memcpy(room, text, length);
        room[length] = '\0';
        room += length + 1;
        last = column;
        end = word.end;
    }
    for (size_t i = 0; i < columns; i++)
        if (!name[i] != skipped[i])
            return false;
    return true;
}
