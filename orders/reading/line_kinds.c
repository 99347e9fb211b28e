/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a line of a table is: a row, a comment, a title, a footer, a row of means, or that of a run
 * that failed. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/words.h"
#include "orders/reading/layout.h"

/* ---- rows ---- */

static bool says_one_of(const char *const *words, const char *text)
{
    while (*words && !strcasestr(text, *words))
        words++;
    return *words;
}

static const char *const crashes[] = {"segmentation fault", "segfault",  "core dumped",
                                      "traceback",          "mpi_abort", NULL};

bool br_says_failure(const char *text)
{
    static const char *const words[] = {
        "fail",      "diverg",    "crash",      "abort",    "killed",   "not conv",  "no conv",
        "out of m",  "no memory", "blew up",    "blows up", "timeout",  "timed out", "unstable",
        "did not f", "oom",       "terminated", "stopped",  "overflow", NULL};
    return says_one_of(words, text) || says_one_of(crashes, text);
}

/* Whether a line, or one of those below it, up to the next row, says that a run failed. */
static bool says_failure(const struct layout *l, size_t line, size_t lines)
{
    bool says = false;
    for (size_t i = line; i < l->lines && i < line + lines && !l->row[i].is_row && !says; i++)
        says = br_says_failure(l->line[i].text);
    return says;
}

/* Whether a line has numbers in half of the columns of numbers, or nothing at all. */
static bool is_like_rows(const struct layout *l, const struct row *r)
{
    size_t all = 0, there = 0;
    for (size_t c = 0; c < l->width && r->count == l->width; c++) {
        all += 2 * l->has_number[c] > l->rows;
        there += 2 * l->has_number[c] > l->rows && r->token[c].content < BR_WORD;
    }
    return r->count == l->width && 2 * there >= all && (r->numbers || !r->words);
}

/* Whether a line of names and numbers tells of a failure instead: "N = 32: diverged in step 3". */
static bool tells_failure(const struct layout *l, size_t line)
{
    bool others = false;
    const struct br_token *const token = l->row[line].token;
    for (size_t c = 0; c < l->width && l->first < l->lines && token->name; c++)
        others |= strcmp(token[c].name, l->row[l->first].token[c].name) != 0;
    return others && says_failure(l, line, 1);
}

static enum br_status find_rows(struct layout *l)
{
    l->first = l->lines;
    for (size_t i = 0; i < l->lines; i++) {
        l->row[i].is_row =
            l->line[i].kind == BR_LINE_TEXT && is_like_rows(l, &l->row[i]) && !tells_failure(l, i);
        l->first = l->row[i].is_row && l->first == l->lines ? i : l->first;
        l->last = l->row[i].is_row ? i : l->last;
    }
    return l->first < l->lines
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT, "%s:1: found no row of numbers", l->path);
}

/* Whether the first word of a row is one of means, where others have a number. */
static bool is_summary(const struct row *r)
{
    static const char *const words[] = {"mean",  "average", "avg", "overall", "slope",
                                        "order", "eoc",     "fit", "total",   "median",
                                        "min",   "max",     "std", "rate",    "conv"};
    const char *const text = r->count ? r->token->text + strspn(r->token->text, "*_ ") : "";
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strncasecmp(text, words[i], strlen(words[i])) == 0)
            return true;
    return false;
}

size_t br_layout_next_text(const struct layout *l, size_t line, int step)
{
    do
        line += (size_t)step;
    while (line < l->lines && l->line[line].kind != BR_LINE_TEXT);
    return line < l->lines ? line : l->lines;
}

bool br_layout_is_short(const struct layout *l, size_t line)
{
    const struct row *r = &l->row[line];
    return line < l->lines && l->by > BR_BY_COLONS && r->count < l->width && r->count > 1 &&
           r->numbers && !r->words;
}

bool br_layout_is_row(const struct layout *l, size_t line)
{
    return line >= l->first && line <= l->last &&
           (l->row[line].is_row || br_layout_is_short(l, line));
}

/* Whether a row has a word where others have a number. */
static bool has_other_words(const struct layout *l, size_t line)
{
    bool words = false;
    for (size_t i = 0; i < l->width; i++)
        words |= l->has_number[i] > 1 && l->row[line].token[i].content >= BR_WORD;
    return words;
}

/* Finds the ends of the table: without titles and rows of means; with a first or last row that is
 * short. */
static void find_ends(struct layout *l)
{
    while (l->first < l->last && !l->row[br_layout_next_text(l, l->first, 1)].is_row &&
           has_other_words(l, l->first)) {
        l->row[l->first].is_row = false;
        while (!l->row[l->first].is_row)
            l->first = br_layout_next_text(l, l->first, 1);
    }
    while (l->last > l->first && l->has_number[0] && is_summary(&l->row[l->last]))
        for (l->row[l->last].is_row = false; !l->row[l->last].is_row;)
            l->last = br_layout_next_text(l, l->last, -1);
    const size_t above = br_layout_next_text(l, l->first, -1),
                 below = br_layout_next_text(l, l->last, 1);
    l->first = br_layout_is_short(l, above) ? above : l->first;
    l->last = br_layout_is_short(l, below) ? below : l->last;
}

enum br_status br_layout_refuse_row(const struct layout *l, size_t line, const char *like)
{
    return br_fail(l->err, BR_BAD_INPUT, "%s:%zu: found %s than the %zu fields of the %s", l->path,
                   l->line[line].number, l->row[line].count > l->width ? "more" : "fewer", l->width,
                   like);
}

/* Whether two columns rise or fall through all rows: they are one sequence, whatever stands between
 * them. */
static bool is_sequence(const struct layout *l)
{
    size_t columns = 0, rows = 0;
    for (size_t c = 0; c < l->width; c++, rows = 0) {
        struct br_field_number number, before = {0};
        size_t up = 0, down = 0, read = 0;
        for (size_t i = l->first; i <= l->last; i++) {
            const struct row *r = &l->row[i];
            rows += r->is_row;
            if (!r->is_row || !br_field_read(r->token[c].text, l->fields->mark, &number))
                continue;
            up += read && number.value > before.value;
            down += read && number.value < before.value;
            before = number;
            read++;
        }
        columns += read > 2 && read + 1 >= rows && (up + 1 == read || down + 1 == read);
    }
    return columns > 1;
}

/* ---- failed runs: rows with a size, and without numbers ---- */

/* The column whose heading a name is, or ends with as a word: "Run N"; l->width: there is none. */
static size_t column_of(const struct layout *l, const char *name)
{
    size_t column = 0;
    const size_t all = strlen(name);
    for (; column < l->width; column++) {
        const char *const heading = l->fields->heading[column];
        size_t size = heading ? strcspn(heading, strpbrk(name, "[(") ? "" : "[(") : 0;
        while (size && heading[size - 1] == ' ')
            size--;
        if (size && all >= size && strncasecmp(name + all - size, heading, size) == 0 &&
            (all == size || name[all - size - 1] == ' '))
            break;
    }
    return column;
}

static bool is_number(const struct layout *l, const char *text, double *value)
{
    struct br_field_number number;
    const bool reads = text && br_field_read(text, l->fields->mark, &number);
    *value = reads ? number.value : (double)NAN;
    return reads;
}

/* Takes what a line states (l->field): numbers behind the names of columns, or else fields up to
 * the first column of numbers. Returns the column of its size; l->width: there is none; BR_NO_ROW:
 * it has a size of no column. *whole (out): all values are of columns, and no other column is
 * named. */
static size_t take_stated(struct layout *l, size_t line, bool *named, bool *whole)
{
    size_t column = l->width, first = 0;
    double number;
    memset(l->field, 0, l->width * sizeof *l->field);
    const size_t count =
        br_line_stated(l->line[line].text, l->by, l->fields->mark, l->room, l->token, whole);
    for (size_t i = 0; i < count; i++) {
        const size_t c = column_of(l, l->token[i].name);
        const bool is_size = c == 0 || br_size_name_odds(l->token[i].name) >= BR_USUAL_NAME;
        column = is_size && column >= l->width ? (c < l->width ? c : BR_NO_ROW) : column;
        *whole &= c < l->width && !l->field[c];
        if (c < l->width && !l->field[c])
            l->field[c] = l->token[i].text;
    }
    for (size_t c = 0; c < l->width && *whole; c++) {
        const char *const heading = l->fields->heading[c];
        *whole = l->field[c] || !heading || strlen(heading) < 3 ||
                 !strcasestr(l->line[line].text, heading); /* "error 1.2-2" */
    }
    *named = column < l->width;
    if (column != l->width || l->by <= BR_BY_COLONS)
        return column;
    memset(l->field, 0, l->width * sizeof *l->field);
    const struct row r = br_layout_look_at(l, line, l->room);
    while (first < l->width && l->has_number[first] < l->rows)
        first++;
    if (first >= r.count || first == l->width || is_summary(&r))
        return l->width;
    char *const size = r.token[first].text; /* "128: no memory", of commas "128 failed" */
    if (r.token[first].content != BR_NUMBER)
        size[strcspn(size, " :")] = '\0';
    for (size_t i = 0; i <= first; i++)
        l->field[i] = r.token[i].text;
    return is_number(l, l->field[first], &number) ? first : l->width;
}

/* Whether a row has all that a line states. */
static bool is_stated_in(const struct layout *l, const struct row *r)
{
    bool all = true;
    double a, b;
    for (size_t c = 0; c < l->width && all; c++)
        all = !l->field[c] || (is_number(l, l->field[c], &a) && is_number(l, r->token[c].text, &b)
                                   ? a == b
                                   : strcmp(l->field[c], r->token[c].text) == 0);
    return all;
}

/* Whether a size may be one of a run: above 0, or level 0 with a number beside it. */
static bool may_be_size(const struct layout *l, double size)
{
    size_t stated = 0;
    for (size_t c = 0; c < l->width; c++)
        stated += l->field[c] != NULL;
    return size > 0 || (size == 0 && stated > 1);
}

/* Whether no row has what a line states; *follows (out): its size continues those of the rows. */
static bool is_further(const struct layout *l, size_t line, size_t column, bool *follows)
{
    double size, row, first = NAN, before = NAN, after = NAN, last = NAN;
    for (size_t i = l->first; i <= l->last; i++) {
        if (!l->row[i].is_row || !is_number(l, l->row[i].token[column].text, &row))
            continue;
        if (is_stated_in(l, &l->row[i]))
            return false;
        first = isnan(first) ? row : first;
        before = i < line ? row : before;
        after = i > line && isnan(after) ? row : after;
        last = row;
    }
    const bool reads = is_number(l, l->field[column], &size) && may_be_size(l, size);
    const double up = isnan(after) ? before - first : isnan(before) ? last - after : after - before;
    *follows = !((size - before) * up <= 0) && !((after - size) * up <= 0);
    return reads;
}

static enum br_status make_row(struct layout *l, size_t line)
{
    struct row *r = &l->row[line];
    double number;
    if (br_layout_count_row(l, line))
        return l->err->status;
    r->token = br_store_take(&l->fields->store, l->width, sizeof *r->token);
    for (size_t c = 0; c < l->width && r->token; c++) {
        const char *const text = l->field[c] ? l->field[c] : "";
        r->token[c] = (struct br_token){br_store_copy(&l->fields->store, text), NULL, BR_MISSING};
        l->has_number[c] += !*text || is_number(l, text, &number);
    }
    if (l->fields->store.failed)
        return br_no_memory(l->err, "the table");
    r->count = l->width;
    r->is_row = l->has_failed = true;
    l->first = line < l->first ? line : l->first;
    l->last = line > l->last ? line : l->last;
    return BR_OK;
}

enum { MOST_LINES = 20 /* of a failure */ };

/* Makes a line that states a further size a row: where a run failed, or did not end. Refuses what
 * may be one, and a failure without a number below the last row. */
static enum br_status take_failed_run(struct layout *l, size_t line)
{
    bool named, whole, follows;
    const bool is_text = l->line[line].kind == BR_LINE_TEXT, is_log = l->by <= BR_BY_COLONS;
    const size_t column = take_stated(l, line, &named, &whole);
    const bool is_footer = line > l->last && !strpbrk(l->line[line].text, "0123456789");
    bool refuses =
        !l->has_failed && line > l->first &&
        (is_footer ? says_failure(l, line, 1) : says_one_of(crashes, l->line[line].text));
    if (column == BR_NO_ROW)
        refuses = says_failure(l, line, 1);
    else if (column < l->width) {
        if (!is_further(l, line, column, &follows))
            return BR_OK;
        const bool fails = says_failure(l, line, is_text ? MOST_LINES : 1);
        const bool may_run = is_log && is_text && (line > l->first || follows);
        if (named ? fails || (may_run && whole) : fails && follows)
            return make_row(l, line);
        refuses = named ? may_run : follows && line > l->last;
    }
    return !refuses || !is_text
               ? BR_OK
               : br_fail(l->err, BR_BAD_INPUT,
                         "%s:%zu: found '%.40s', expected a row of %zu fields: write nan for a "
                         "number that is missing, or # before a line that is no row",
                         l->path, l->line[line].number, l->line[line].text, l->width);
}

/* Takes failed runs. Refuses what is no row between rows, but text in a sequence, and rows beside
 * them that are others. */
static enum br_status check_lines(struct layout *l)
{
    size_t before = l->first, others = 0;
    const bool sequence = is_sequence(l);
    for (size_t i = 0; i < l->lines; i++) {
        const struct row *r = &l->row[i];
        const bool is_text = l->line[i].kind == BR_LINE_TEXT;
        const bool inside = i >= l->first && i <= l->last;
        const bool is_data = (r->numbers > 1 || i > l->last) && r->numbers > r->words &&
                             l->by > BR_BY_COLONS && !br_layout_is_row(l, i);
        if (is_text && r->count != l->width && is_data && !(r->words && !inside))
            return br_layout_refuse_row(l, i, l->fields->heading_line ? "heading" : "first row");
        if ((is_text || i > l->first) && l->line[i].kind != BR_LINE_EMPTY && !r->is_used &&
            !br_layout_is_row(l, i) && take_failed_run(l, i))
            return l->err->status;
        if (!is_text || br_layout_is_row(l, i)) {
            before = br_layout_is_row(l, i) ? i : before;
            continue;
        }
        others += is_data;
        if ((inside && !(sequence && r->numbers <= r->words)) || others > 1)
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: found '%.40s' between or beside the rows of lines %zu to %zu, "
                           "expected one table",
                           l->path, l->line[i].number, l->line[i].text, l->line[l->first].number,
                           l->line[inside ? before : l->last].number);
    }
    return BR_OK;
}

/* Whether a row has the size of the first one again: a number that the second row does not have,
 * beside the same words. */
static bool begins_again(const struct layout *l, size_t line)
{
    bool again = false;
    const struct row *first = &l->row[l->first],
                     *next = &l->row[br_layout_next_text(l, l->first, 1)];
    for (size_t i = 0; i < l->width; i++) {
        const char *const text = first->token[i].text;
        const bool is_same = strcmp(text, l->row[line].token[i].text) == 0;
        if (2 * l->has_number[i] <= l->rows && !is_same)
            return false;
        again |= is_same && !br_field_is_missing(text) &&
                 !br_layout_is_rate(l->fields->heading[i]) &&
                 (i >= next->count || strcmp(text, next->token[i].text) != 0);
    }
    return again;
}

/* Refuses rows that begin again behind a gap or a rule: a table of its own. */
static enum br_status check_blocks(const struct layout *l)
{
    for (size_t i = l->first + 1; i <= l->last && l->row[l->first].count == l->width; i++)
        if (l->row[i].is_row &&
            l->line[i].number > l->line[br_layout_next_text(l, i, -1)].number + 1 &&
            begins_again(l, i))
            return br_fail(l->err, BR_BAD_INPUT,
                           "%s:%zu: the rows begin again as on line %zu, expected one table",
                           l->path, l->line[i].number, l->line[l->first].number);
    return BR_OK;
}

enum br_status br_layout_find_kinds(struct layout *l)
{
    if (find_rows(l))
        return l->err->status;
    find_ends(l);
    const enum br_status status = br_layout_find_heading(l);
    if (l->fields->store.failed)
        return br_no_memory(l->err, "the table");
    return status || check_lines(l) || check_blocks(l) ? l->err->status : BR_OK;
}

/* Names all lines that are in no row, but comments at the top. */
void br_layout_leave_lines(const struct layout *l)
{
    for (size_t i = 0; i < l->lines; i++) {
        const struct row *r = &l->row[i];
        const bool is_comment = l->line[i].kind == BR_LINE_COMMENT;
        if (l->line[i].kind == BR_LINE_EMPTY || r->is_used || (is_comment && i < l->first))
            continue;
        for (char *c = l->line[i].text; (c = strchr(c, BR_BOX_BAR));)
            *c = '|';
        l->fields->left[l->fields->lefts++] =
            (struct br_left_line){l->line[i].number, l->line[i].text,
                                  is_comment                              ? "comment"
                                  : i < l->first                          ? "title"
                                  : i < l->last                           ? "between rows"
                                  : r->count == l->width && is_summary(r) ? "summary"
                                                                          : "footer"};
    }
}
