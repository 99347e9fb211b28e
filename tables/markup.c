/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/markup.h"

#include <string.h>

/* ---- pieces ---- */

/* NULL: nothing. */
static void say(const struct br_markup_page *p, const char *text)
{
    if (text)
        fputs(text, p->out);
}

/* An answer or a note. */
static void put_paragraph(const struct br_markup_page *p, const struct br_around *a,
                          const char *text)
{
    say(p, a->before);
    if (p->markup->paragraph)
        p->markup->paragraph(p, text);
    else
        br_markup_put(p, "%s", text);
    say(p, a->after);
}

void br_markup_heading(const struct br_markup_page *p, int level, const char *text)
{
    if (p->markup->title) {
        p->markup->title(p, level, text);
        return;
    }
    fprintf(p->out, p->markup->heading.before, level);
    br_markup_put(p, "%s", text);
    fprintf(p->out, p->markup->heading.after, level);
}

/* Prints each line quoted, in pieces of whole characters. */
void br_markup_lines(const struct br_markup_page *p, const char *lines)
{
    const struct br_markup *m = p->markup;
    say(p, m->lines.before);
    while (*lines) {
        size_t rest = strcspn(lines, "\n");
        say(p, m->line.before);
        while (rest) {
            char piece[1024];
            size_t size = rest < sizeof piece ? rest : sizeof piece - 8;
            for (int i = 0; i < 3 && size < rest && ((unsigned char)lines[size] & 0xc0) == 0x80;
                 i++)
                size++;
            snprintf(piece, sizeof piece, "%.*s", (int)size, lines);
            br_quote(p->out, m->of_lines, piece);
            lines += size;
            rest -= size;
        }
        say(p, m->line.after);
        lines += *lines == '\n';
    }
    say(p, m->lines.after);
}

/* Prints a text by a function of the format; NULL: as any text. */
static void print_by(const struct br_markup_page *p, void (*own)(FILE *out, const char *text),
                     const char *text)
{
    if (own)
        own(p->out, text);
    else
        br_markup_put(p, "%s", text);
}

static void print_unit(const struct br_markup_page *p, const char *before, const char *unit)
{
    say(p, unit ? before : NULL);
    if (unit)
        print_by(p, p->markup->unit, unit);
}

static void print_word(const struct br_markup_page *p, enum br_outcome outcome)
{
    static const int colours[] = {32, 31, 33, 31}; /* of a terminal, by outcomes */
    if (p->colour)
        fprintf(p->out, "\033[1;%dm", colours[outcome]);
    fprintf(p->out, p->markup->word, br_outcome_names[outcome], br_outcome_names[outcome]);
    fputs(p->colour ? "\033[0m" : "", p->out);
}

bool br_markup_word(const struct br_markup_page *p, const char *text, size_t bytes)
{
    for (int word = BR_OUTCOME_PASS; word < BR_OUTCOMES; word++)
        if (strlen(br_outcome_names[word]) == bytes &&
            memcmp(text, br_outcome_names[word], bytes) == 0) {
            print_word(p, (enum br_outcome)word);
            return true;
        }
    return false;
}

/* ---- tables ---- */

/* How a column is aligned; the order is that of br_markup_columns. */
enum alignment { RIGHT, LEFT, WRAPPED };

static enum alignment alignment_of(const struct br_document_table *t, size_t column)
{
    const unsigned flags = t->column[column].flags;
    return flags & BR_WRAP ? WRAPPED : flags & BR_TEXTUAL ? LEFT : RIGHT;
}

void br_markup_columns(const struct br_markup_page *p, const struct br_document_table *t,
                       const char *const word[3])
{
    for (size_t c = 0; c < t->columns; c++)
        if (br_document_is_shown(t, c))
            fputs(word[alignment_of(t, c)], p->out);
}

static void print_value(const struct br_markup_page *p, const struct br_column *column,
                        const struct br_document_cell *cell)
{
    char buffer[BR_SHOWN];
    const char *text = br_document_shown(column, cell, buffer);
    if (cell->value.kind != BR_TEXT || cell->shown)
        print_by(p, p->markup->number, text);
    else if (!br_markup_word(p, text, strlen(text)))
        br_markup_put(p, "%s", text);
    if (cell->mark)
        br_markup_put(p, p->markup->mark, cell->mark);
}

/* row: NULL, the head. The text before a cell may contain its alignment (%s). */
static void print_row(const struct br_markup_page *p, const struct br_document_table *t,
                      const struct br_document_row *row)
{
    const struct br_markup *m = p->markup;
    const struct br_around *cell = row ? &m->cell : &m->head;
    const char *between = row ? m->row.before : "";
    for (size_t c = 0; c < t->columns; c++) {
        if (!br_document_is_shown(t, c))
            continue;
        say(p, between);
        if (cell->before)
            fprintf(p->out, cell->before, m->classes ? m->classes[alignment_of(t, c)] : "");
        if (row) {
            print_value(p, &t->column[c], &row->cell[c]);
        } else {
            print_by(p, m->number, t->column[c].heading);
            print_unit(p, ", ", t->column[c].unit);
        }
        say(p, cell->after);
        between = m->between;
    }
    say(p, row ? m->row.after : NULL);
}

static void print_table(struct br_markup_page *p, const struct br_document_table *t, int level)
{
    const struct br_markup *m = p->markup;
    if (m->table) {
        m->table(p, t);
        return;
    }
    m->open_table(p, t, level);
    print_row(p, t, NULL);
    if (m->open_rows)
        m->open_rows(p, t);
    say(p, m->rows.before);
    for (size_t r = 0; r < t->rows; r++)
        print_row(p, t, &t->row[r]);
    say(p, m->rows.after);
    if (m->close_table)
        m->close_table(p, t);
}

/* ---- blocks ---- */

static void print_command(const struct br_markup_page *p, const struct br_block *b)
{
    br_markup_put(p, p->markup->command, b->what.heading);
    br_markup_lines(p, b->cell.value.text);
}

/* level: of a section; `under` one, tables are a level lower. */
static void print_block(struct br_markup_page *p, const struct br_block *b, int level, bool under)
{
    switch (b->kind) {
    case BR_BLOCK_TABLE:
        print_table(p, b->table, level + under);
        break;
    case BR_BLOCK_SECTION:
        br_markup_heading(p, level, b->text);
        break;
    case BR_BLOCK_NOTE:
        put_paragraph(p, &p->markup->note, b->text);
        break;
    case BR_BLOCK_FACT:
        say(p, p->markup->fact.before);
        br_markup_put(p, p->markup->label, b->what.heading);
        print_value(p, &b->what, &b->cell);
        print_unit(p, " ", b->what.unit);
        say(p, p->markup->fact.after);
        break;
    case BR_BLOCK_COMMAND:
        print_command(p, b);
        break;
    case BR_BLOCK_PICTURE:
        p->markup->picture(p, b);
        break;
    }
}

/* Whether a block is printed. A terminal gets short tables, facts, and the titles of facts. */
static bool is_shown(const struct br_markup_page *p, size_t block)
{
    const struct br_block *b = &p->d->block[block];
    const bool table = b->kind == BR_BLOCK_TABLE;
    const unsigned flags = table ? b->table->flags : b->what.flags;
    const bool has = br_for_people(flags) && (!table || b->table->rows > 0);
    if (!p->terminal || !has)
        return has;
    if (b->kind == BR_BLOCK_SECTION) {
        for (size_t i = block + 1; i < p->d->blocks; i++)
            if (p->d->block[i].kind == BR_BLOCK_SECTION || is_shown(p, i))
                return p->d->block[i].kind == BR_BLOCK_FACT;
        return false;
    }
    return !(flags & BR_FILES_ONLY) &&
           (table ? flags & BR_LONG || b->table->rows <= BR_LONG_TABLE : b->kind == BR_BLOCK_FACT);
}

/* The block with the picture that stands below the answers; p->d->blocks: none does. */
static size_t first_picture(const struct br_markup_page *p)
{
    size_t i = p->markup->picture_first ? 0 : p->d->blocks;
    while (i < p->d->blocks && p->d->block[i].kind != BR_BLOCK_PICTURE)
        i++;
    return i;
}

bool br_markup_has_body(const struct br_markup_page *p)
{
    for (size_t i = 0; i < p->d->blocks; i++)
        if (is_shown(p, i) || p->d->block[i].kind == BR_BLOCK_COMMAND)
            return true;
    return false;
}

/* Prints all blocks but `done`. Facts that follow each other are one list. */
static void print_blocks(struct br_markup_page *p, size_t done)
{
    const struct br_markup *m = p->markup;
    enum br_block_kind before = BR_BLOCK_TABLE;
    bool under = false;
    for (size_t i = 0; i < p->d->blocks && !p->status; i++) {
        const struct br_block *b = &p->d->block[i];
        p->status = br_document_status(p->d, p->err);
        const bool titled = b->kind == BR_BLOCK_TABLE || b->kind == BR_BLOCK_SECTION;
        if (p->status || i == done || !is_shown(p, i))
            continue;
        if (before == BR_BLOCK_FACT && b->kind != before)
            say(p, m->facts.after);
        if (b->kind != before && before != BR_BLOCK_SECTION && !titled)
            say(p, m->gap);
        if (b->kind == BR_BLOCK_FACT && before != b->kind)
            say(p, m->facts.before);
        under |= b->kind == BR_BLOCK_SECTION;
        print_block(p, b, p->level + 1, under);
        before = b->kind;
    }
    say(p, before == BR_BLOCK_FACT ? m->facts.after : NULL);
}

/* ---- verdicts ---- */

static void print_verdict(const struct br_markup_page *p, const struct br_document_verdict *v)
{
    const bool passed = v->outcome == BR_OUTCOME_PASS;
    const size_t letters = strlen(v->name) + strlen(v->message ? v->message : "") +
                           strlen(v->group) + (v->line ? strlen(v->file) : 0) +
                           strlen("INCONCLUSIVE ,  (:1000): ");
    const bool wraps = v->message && p->columns && letters > (size_t)p->columns;
    say(p, p->markup->verdict.before);
    print_word(p, v->outcome);
    fputc(' ', p->out);
    br_markup_put(p, "%s, %s", v->group, v->name);
    if (v->line)
        br_markup_put(p, " (%s:%zu)", v->file, v->line);
    fputs(!v->message ? "" : wraps ? ":\n" : ": ", p->out);
    if (wraps)
        p->markup->paragraph(p, v->message);
    else
        br_markup_put(p, "%s", v->message);
    say(p, p->markup->verdict.after);
    for (size_t i = 0; i < v->details && !(passed && p->terminal); i++)
        br_markup_put(p, p->markup->detail, v->detail[i]);
}

void br_markup_tally(const struct br_markup_page *p)
{
    const char *between = "";
    for (int outcome = BR_OUTCOME_PASS; outcome < BR_OUTCOMES; outcome++) {
        size_t count = 0;
        for (size_t i = 0; i < p->d->verdicts; i++)
            count += p->d->verdict[i].outcome == (enum br_outcome)outcome;
        if (!count)
            continue;
        fprintf(p->out, "%s%zu ", between, count);
        print_word(p, (enum br_outcome)outcome);
        between = ", ";
    }
}

/* Prints the verdicts that did not pass or have a message; above them, but on a terminal, whose
 * answer has it, the number of each kind. */
static void print_verdicts(const struct br_markup_page *p)
{
    const struct br_markup *m = p->markup;
    bool any = false;
    if (p->d->verdicts && !p->terminal) {
        br_markup_heading(p, p->level + 1, "Verdicts");
        say(p, m->note.before);
        br_markup_tally(p);
        say(p, m->note.after);
    }
    for (size_t i = 0; i < p->d->verdicts; i++) {
        const struct br_document_verdict *v = &p->d->verdict[i];
        if (v->outcome == BR_OUTCOME_PASS && !v->message)
            continue;
        say(p, any ? NULL : m->verdicts.before);
        print_verdict(p, v);
        any = true;
    }
    say(p, any ? m->verdicts.after : NULL);
}

void br_markup_head(const struct br_markup_page *p)
{
    const struct br_markup *m = p->markup;
    if (m->begin)
        m->begin(p);
    else
        br_markup_heading(p, p->level, p->d->caption);
    say(p, p->d->answers ? m->answers.before : NULL);
    for (size_t i = 0; i < p->d->answers; i++)
        put_paragraph(p, &m->answer, p->d->answer[i]);
    say(p, p->d->answers ? m->answers.after : NULL);
    print_verdicts(p);
}

void br_markup_body(struct br_markup_page *p)
{
    const size_t picture = first_picture(p);
    if (picture < p->d->blocks)
        p->markup->picture(p, &p->d->block[picture]);
    print_blocks(p, picture);
    const char *gap = p->markup->gap;
    for (size_t i = 0; i < p->d->blocks && p->terminal; i++) /* to be typed next */
        if (p->d->block[i].kind == BR_BLOCK_COMMAND) {
            say(p, gap);
            print_command(p, &p->d->block[i]);
            gap = NULL;
        }
    if (p->markup->end)
        p->markup->end(p);
}

enum br_status br_markup_print(struct br_markup_page *p)
{
    br_markup_head(p);
    br_markup_body(p);
    return p->status;
}
