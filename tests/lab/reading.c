/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Is a stranger's table read as a person reads it? Cases of tests/data/reading, or of other files,
 * with what a person reads, typed before the program was tried. The oracle has its own reading of
 * numbers, and of tables that are simple; it shares nothing with the one that it checks. A case:
 *
 *     @@ KIND/NAME | OPTIONS | EXPECTATION
 *     @# source, or a remark
 *     the table, to the next line of @@
 *
 * Options are those of `beamrate orders`, words apart by blanks, '...' around a word that has some.
 * The expectation is `ask` (a refusal that names an option), `refuse` (any refusal), or, by ";":
 *     h[COLUMN] = 8 4 2 1    sizes, row by row, up to a factor; also 1/8, and `^-1/2 100 400 1600`;
 *                            COLUMN: its heading, "": none. ~ for = : to 3 %, else to 0.6 %
 *     k[COLUMN] = ...        time steps; several axes: the k-th numbers are of one row
 *     e = L2 @ 1e-3, H1      errors, with the number at the finest size; * is any name
 *     v = drag               values without a known limit
 *     left = Overall         what the answer has to name as left aside
 *     or ask                 a refusal that names an option is as good
 *     or cases               so is an answer for each case of the table
 *
 * Each table is found to be right, right but assumed, asked, refused (without an option), or wrong:
 * read otherwise and claimed, or said to be assumed. Then come copies of the simple tables: those
 * that mean the same (columns and rows in other orders, other separators) must keep the answer;
 * those whose headings are spoilt (hidden, swapped, h called n) must keep the sizes, or ask.
 *
 * usage: reading [--dry] [--all] [FILE...] (own, public1 to 3); --dry: reads the cases only;
 * --all: names all tables that are not right */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "orders/request.h"
#include "tests/checks.h"

enum {
    MOST_CASES = 600,
    MOST_SIZES = 200,
    MOST_NAMES = 32,
    MOST_FIELDS = 32,
    LONGEST = 1 << 16, /* of a case's table, bytes */
    LONGEST_FILE = 1 << 21,
    LEAST_RIGHT = 95 /* percent of all tables */
};

/* ---- cases ---- */

struct sizes {
    char column[80]; /* "": it has no heading */
    double z[MOST_SIZES];
    size_t count; /* 0: the axis is not refined */
    double tolerance;
};

struct name {
    char text[80];
    double finest; /* NaN: it is not stated */
    bool is_value;
};

struct expected {
    bool asks, refuses, may_ask, may_answer_cases;
    struct sizes axis[BR_AXES];
    struct name name[MOST_NAMES], left[MOST_NAMES];
    size_t names, lefts;
};

struct table_case {
    char kind[24], name[80], options[400];
    struct expected expected;
    const char *table;
    size_t length;
};

static void bail(const char *name, const char *what, const char *found)
{
    printf("Bail out! %s: %s '%s'\n", name, what, found);
    exit(99);
}

/* Takes the text to the next `end`, without the blanks around it; returns what follows, or NULL. */
static char *part(char *text, char end, char **word)
{
    char *const stop = strchr(text, end), *last = stop ? stop : text + strlen(text);
    *word = text + strspn(text, " ");
    while (last > *word && last[-1] == ' ')
        last--;
    *last = '\0';
    return stop ? stop + 1 : NULL;
}

/* A number, or a fraction. */
static double fraction(const char *name, const char *text)
{
    char *end;
    double z = strtod(text, &end);
    if (*end == '/')
        z /= strtod(end + 1, &end);
    if (end == text || *end)
        bail(name, "no number", text);
    return z;
}

/* Reads "h[N] = ^-1 10 20 40". */
static void read_sizes(const char *name, char *text, struct sizes *s)
{
    char *bracket = strchr(text, '['), *list = strpbrk(text, "=~"), *word;
    double power = 1;
    if (bracket && bracket < list) {
        char *end = bracket + strlen(bracket);
        while (*end != ']' || end > list) /* the heading may have brackets */
            end--;
        snprintf(s->column, sizeof s->column, "%.*s", (int)(end - bracket - 1), bracket + 1);
        list = end + strcspn(end, "=~");
    }
    s->tolerance = *list == '~' ? 0.03 : 0.006;
    for (list++; list && *list;) {
        list = part(list + strspn(list, " "), ' ', &word);
        if (*word == '^')
            power = fraction(name, word + 1);
        else if (*word && s->count < MOST_SIZES)
            s->z[s->count++] = pow(fraction(name, word), power);
    }
    if (s->count < 3)
        bail(name, "fewer than three sizes in", text);
}

static size_t read_names(const char *name, char *list, bool is_value, struct name *out,
                         size_t count)
{
    char *word, *number;
    while (list) {
        list = part(list, ',', &word);
        struct name *n = &out[count++];
        if (count == MOST_NAMES)
            bail(name, "too many names in", word);
        n->finest = NAN;
        n->is_value = is_value;
        char *at = strstr(word, " @ ");
        if (at) {
            *at = '\0';
            part(at + 3, ' ', &number);
            n->finest = fraction(name, number);
        }
        snprintf(n->text, sizeof n->text, "%s", word);
    }
    return count;
}

static void read_expected(const char *name, char *text, struct expected *e)
{
    char *item;
    while (text) {
        text = part(text, ';', &item);
        char *equals = strchr(item, '=');
        if (strcmp(item, "ask") == 0)
            e->asks = true;
        else if (strcmp(item, "refuse") == 0)
            e->refuses = true;
        else if (strcmp(item, "or ask") == 0)
            e->may_ask = true;
        else if (strcmp(item, "or cases") == 0)
            e->may_answer_cases = true;
        else if ((item[0] == 'h' || item[0] == 'k') && strchr(" [=~", item[1]))
            read_sizes(name, item, &e->axis[item[0] == 'k' ? BR_AXIS_TIME : BR_AXIS_SPACE]);
        else if (equals && (item[0] == 'e' || item[0] == 'v') && strchr(" =", item[1]))
            e->names = read_names(name, equals + 1, item[0] == 'v', e->name, e->names);
        else if (equals && strncmp(item, "left", 4) == 0)
            e->lefts = read_names(name, equals + 1, false, e->left, e->lefts);
        else
            bail(name, "found the expectation", item);
    }
    const size_t h = e->axis[BR_AXIS_SPACE].count, k = e->axis[BR_AXIS_TIME].count;
    if (!(e->asks || e->refuses) && ((!h && !k) || !e->names || (h && k && h != k)))
        bail(name, "expected sizes and names in", "the case");
}

/* Reads the heading of a case: its line after "@@". */
static void read_heading(char *line, struct table_case *c)
{
    char *kind, *options = "", *expectation, *rest = part(line, '|', &kind);
    char *slash = strchr(kind, '/');
    rest = rest ? part(rest, '|', &options) : NULL;
    if (!slash || !rest)
        bail(kind, "expected KIND/NAME | OPTIONS |", "EXPECTATION");
    expectation = rest;
    snprintf(c->kind, sizeof c->kind, "%.*s", (int)(slash - kind), kind);
    snprintf(c->name, sizeof c->name, "%s", kind);
    snprintf(c->options, sizeof c->options, "%s", options);
    read_expected(c->name, expectation, &c->expected);
}

/* Reads the cases of a text, which is changed. */
static size_t read_cases(char *text, struct table_case *cases, size_t count)
{
    while (text && *text) {
        char *next = strchr(text, '\n');
        const bool heads = strncmp(text, "@@ ", 3) == 0;
        if (next)
            *next++ = '\0';
        if (heads && count == MOST_CASES)
            bail(text, "too many cases", "");
        if (heads) {
            cases[count] = (struct table_case){0};
            read_heading(text + 3, &cases[count]);
            while (next && strncmp(next, "@# ", 3) == 0)
                next = strchr(next, '\n') ? strchr(next, '\n') + 1 : NULL;
            char *end = next ? strstr(next, "\n@@ ") : NULL;
            cases[count].table = next ? next : "";
            cases[count].length = end ? (size_t)(end + 1 - next) : next ? strlen(next) : 0;
            next = end ? end + 1 : NULL;
            count++;
        }
        text = next;
    }
    return count;
}

/* ---- a reading, and what it is worth ---- */

enum verdict { RIGHT, ASSUMED, ASKED, REFUSED, WRONG, WRONG_ASSUMED, VERDICTS };
static const char *const verdict_names[] = {"right",   "assumed", "asks",
                                            "refused", "wrong",   "wrong, assumed"};

struct outcome {
    enum verdict verdict;
    size_t unnamed; /* left aside, and not named */
    char why[600];
};

static char *copy_of(const char *text, size_t length)
{
    char *copy = strndup(text, length);
    if (!copy)
        bail("memory", "", "");
    return copy;
}

/* Sets the options. Returns false where there is no such option. */
static bool set_options(const char *options, struct br_orders_request *r)
{
    char text[400], *next = text;
    snprintf(text, sizeof text, "%s", options);
    const struct {
        const char *name;
        char **text;
    } lists[] = {{"--column", &r->columns},
                 {"--error", &r->errors},
                 {"--value", &r->values},
                 {"--where", &r->where}};
    char *name = NULL;
    while (*(next += strspn(next, " "))) {
        char *word = *next == '\'' ? next + 1 : next;
        next = word + strcspn(word, *next == '\'' ? "'" : " ");
        if (*next)
            *next++ = '\0';
        bool known = !name;
        for (size_t i = 0; name && i < sizeof lists / sizeof *lists; i++)
            if (strcmp(name, lists[i].name) == 0) {
                *lists[i].text = copy_of(word, strlen(word));
                known = true;
            }
        if (name && strcmp(name, "--dimension") == 0) {
            r->dimension = strtod(word, NULL);
            r->assumed_dimension = false;
            known = true;
        }
        if (!known)
            return false;
        name = name ? NULL : word;
    }
    return true;
}

/* Letters and digits of a name, small. */
static void plain(const char *text, char out[80])
{
    size_t n = 0;
    for (; *text && n < 79; text++)
        if (isalnum((unsigned char)*text) || (unsigned char)*text >= 0x80)
            out[n++] = (char)tolower((unsigned char)*text);
    out[n] = '\0';
}

/* How well names agree: 2: they are one; 1: one is within the other; 0: they are not. */
static int agree(const char *expected, const char *found)
{
    char a[80], b[80];
    plain(expected, a);
    plain(found, b);
    if (strcmp(expected, "*") == 0 || strcmp(a, b) == 0)
        return 2;
    return *a && *b && (strstr(a, b) || strstr(b, a));
}

/* Whether a quantity is what the name expects. how: the agreement that is asked for. */
static bool is_named(const struct br_numbers *n, size_t quantity, const struct name *e, int how)
{
    const struct br_quantity *q = &n->quantity[quantity];
    const double finest = n->row[n->rows - 1].number[quantity];
    return agree(e->text, q->name) >= how && q->is_value == e->is_value &&
           (isnan(e->finest) || fabs(finest - e->finest) <= 1e-9 * fabs(e->finest));
}

static bool same_names(const struct br_numbers *n, const struct expected *e, char *why)
{
    bool taken[MOST_NAMES] = {false}, had[MOST_NAMES] = {false};
    size_t matched = 0, used = 0;
    for (int how = 2; how >= 1; how--)
        for (size_t i = 0; i < e->names; i++)
            for (size_t j = 0; j < n->quantities && j < MOST_NAMES && !had[i]; j++)
                if (!taken[j] && is_named(n, j, &e->name[i], how)) {
                    taken[j] = had[i] = true;
                    matched++;
                }
    if (matched == e->names && n->quantities == e->names)
        return true;
    for (size_t i = 0; i < n->quantities; i++)
        used += (size_t)snprintf(why + used, used < 400 ? 400 - used : 0, "%s%s%s",
                                 i ? ", " : "quantities: ", n->quantity[i].name,
                                 n->quantity[i].is_value ? " (value)" : "");
    return false;
}

/* A row of numbers, or of what is expected. */
struct place {
    size_t line; /* its place in the table; where rows have no lines, sizes decide */
    double z[BR_AXES];
};

static int by_place(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->line != y->line)
        return x->line < y->line ? -1 : 1;
    const int first = (x->z[0] < y->z[0]) - (x->z[0] > y->z[0]);
    return first ? first : (x->z[1] < y->z[1]) - (x->z[1] > y->z[1]);
}

/* Whether the sizes of an axis are the expected ones, up to a factor. */
static bool same_axis(const struct place *found, const struct place *expected, size_t rows,
                      int axis, double tolerance, char *why)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < rows; i++) {
        const double ratio = found[i].z[axis] / expected[i].z[axis];
        least = fmin(least, ratio);
        most = fmax(most, ratio);
    }
    if (most / least - 1 <= tolerance)
        return true;
    snprintf(why, 400, "ratios of sizes from %.4g to %.4g", least, most);
    return false;
}

/* What differs in a copy of a table. */
struct change {
    bool names;    /* so they do not count */
    bool reversed; /* the rows */
};

/* Whether the sizes are the expected ones, row by row. reversed: the rows of the table are. */
static bool same_sizes(const struct br_numbers *n, const struct expected *e, struct change change,
                       char *why)
{
    struct place found[MOST_SIZES] = {{0}}, expected[MOST_SIZES] = {{0}};
    const size_t rows = e->axis[0].count ? e->axis[0].count : e->axis[1].count;
    /* Without a name a time step may be any size. */
    const int turn = change.names && !n->column[0] != !n->column[1] &&
                     !e->axis[0].count != !e->axis[1].count && !n->column[0] != !e->axis[0].count;
    for (int axis = 0; axis < BR_AXES; axis++)
        if (!n->column[axis] != !e->axis[axis ^ turn].count) {
            snprintf(why, 400, "%s axis of %s", n->column[axis] ? "an" : "no", axis ? "k" : "h");
            return false;
        }
    if (rows != n->rows) {
        snprintf(why, 400, "%zu rows, expected %zu", n->rows, rows);
        return false;
    }
    const bool lines = rows > 1 && n->row[0].line != n->row[1].line;
    for (size_t i = 0; i < rows; i++) {
        found[i].line = lines ? n->row[i].line : 0;
        expected[i].line = lines ? change.reversed ? rows - i : i : 0;
        for (int axis = 0; axis < BR_AXES; axis++) {
            found[i].z[axis] = n->column[axis] ? n->row[i].z[axis] : 1;
            expected[i].z[axis] = n->column[axis] ? e->axis[axis ^ turn].z[i] : 1;
        }
    }
    qsort(found, rows, sizeof *found, by_place);
    qsort(expected, rows, sizeof *expected, by_place);
    for (int axis = 0; axis < BR_AXES; axis++)
        if (!same_axis(found, expected, rows, axis,
                       n->column[axis] ? e->axis[axis ^ turn].tolerance : 0, why))
            return false;
    return true;
}

/* The verdict on numbers, or on a refusal. */
/* Whether a text is named as left aside. */
static bool names_left(const struct br_numbers *n, const char *text)
{
    for (size_t i = 0; i < n->lefts; i++)
        if (strstr(n->left[i].what, text))
            return true;
    return false;
}

static struct outcome find_outcome(const struct br_numbers *n, enum br_status status,
                                   const struct br_error *why, const struct expected *e,
                                   struct change change)
{
    struct outcome o = {.verdict = RIGHT};
    if (status) {
        const bool helps = strstr(why->message, "--") || strstr(why->message, "dimension:");
        snprintf(o.why, sizeof o.why, "%.590s", why->message);
        if (!(e->refuses || ((e->asks || e->may_ask) && helps)))
            o.verdict = helps ? ASKED : REFUSED;
        return o;
    }
    const bool assumed = n->assumed || n->unsettled;
    if (e->may_answer_cases && strstr(n->taken, "a study for each of")) {
        o.verdict = assumed ? ASSUMED : RIGHT;
        return o;
    }
    if (e->asks || e->refuses)
        snprintf(o.why, sizeof o.why, "it should ask");
    else if (same_sizes(n, e, change, o.why) && (change.names || same_names(n, e, o.why))) {
        for (size_t i = 0; i < e->lefts; i++)
            o.unnamed += !names_left(n, e->left[i].text);
        o.verdict = assumed ? ASSUMED : RIGHT;
        return o;
    }
    const size_t used = strlen(o.why);
    snprintf(o.why + used, sizeof o.why - used, " (%.200s)", n->taken);
    o.verdict = assumed ? WRONG_ASSUMED : WRONG;
    return o;
}

static struct outcome read_table(const char *table, const struct table_case *c,
                                 struct change change)
{
    OWNED(br_numbers) n = {0};
    OWNED(br_orders_request) r = br_orders_request_default();
    r.path = copy_of(c->name, strlen(c->name));
    r.table = copy_of(table, strlen(table));
    enum br_status status = BR_OK;
    if (set_options(c->options, &r))
        status = br_orders_read(&r, &n, &err);
    else
        status = br_fail(&err, BR_BAD_INPUT, "no such option: %s", c->options);
    const struct outcome o = find_outcome(&n, status, &err, &c->expected, change);
    return o;
}

/* ---- simple tables, and their copies ---- */

/* Rows of fields, the heading first. */
struct grid {
    char *field[MOST_SIZES][MOST_FIELDS];
    size_t rows, columns;
    char *room;
};

/* Makes two blanks and more a tab. */
static void join_blanks(char *line)
{
    char *out = line;
    for (; *line; line++)
        if (line[0] == ' ' && line[1] == ' ') {
            line += strspn(line, " ") - 1;
            *out++ = '\t';
        } else
            *out++ = *line;
    *out = '\0';
}

/* Splits a table whose lines all have the same number of fields; returns whether this is one.
 * separator: '2': two blanks. */
static bool split_by(const struct table_case *c, char separator, struct grid *g)
{
    char *line, *word;
    const bool two = separator == '2';
    memset(g, 0, sizeof *g);
    g->room = copy_of(c->table, c->length);
    for (char *next = g->room; next;) {
        size_t count = 0;
        next = part(next, '\n', &line);
        if (two)
            join_blanks(line);
        separator = two ? '\t' : separator;
        if (!g->rows)
            line += strspn(line, "#% "); /* the heading may be a comment */
        if (separator == '|' && *line == '|')
            line++;
        if (separator == '|' && *line && line[strlen(line) - 1] == '|')
            line[strlen(line) - 1] = '\0';
        if (!*line || (separator == '|' && strspn(line, "|-: +") == strlen(line)))
            continue;
        if (g->rows == MOST_SIZES)
            return false;
        for (char *rest = line; rest && count < MOST_FIELDS;) {
            rest = part(rest + (separator == ' ' ? strspn(rest, " ") : 0), separator, &word);
            if (separator != ' ' || *word)
                g->field[g->rows][count++] = word;
        }
        if (count < 2 || (g->rows && count != g->columns))
            return false;
        g->columns = count;
        g->rows++;
    }
    return g->rows >= 4;
}

static bool is_number(const char *text)
{
    char *end;
    if (strspn(text, "-") == strlen(text) || strcmp(text, "NA") == 0)
        return true;
    strtod(text, &end);
    return *end == '\0';
}

/* Whether a word of the heading comes twice: apart by blanks, it may be a part of two names. */
static bool repeats_a_word(const struct grid *g)
{
    bool repeats = false;
    for (size_t i = 0; i < g->columns; i++)
        for (size_t j = 0; j < i; j++)
            repeats |= strcmp(g->field[0][i], g->field[0][j]) == 0;
    return repeats;
}

/* Whether a table is simple: a heading of words, and rows of numbers. */
static bool split(const struct table_case *c, struct grid *g)
{
    static const char separators[] = "|\t,; 2";
    for (size_t s = 0; s < 6; s++) {
        bool simple = split_by(c, separators[s], g) && !(separators[s] == ' ' && repeats_a_word(g));
        for (size_t i = 0; simple && i < g->rows; i++)
            for (size_t j = 0; j < g->columns; j++)
                simple &= i ? is_number(g->field[i][j])
                            : !is_number(g->field[i][j]) && !strpbrk(g->field[i][j], ",#%\"'&$");
        if (simple)
            return true;
        free(g->room);
    }
    g->room = NULL;
    return false;
}

struct copy {
    const struct grid *g;
    const char *heading[MOST_FIELDS];
    size_t column[MOST_FIELDS]; /* which column comes where */
    bool reversed;              /* the rows */
    bool turned;                /* rows become columns */
    const char *separator;
};

static void write_copy(const struct copy *copy, char text[LONGEST])
{
    size_t used = 0;
    const struct grid *g = copy->g;
    const size_t lines = copy->turned ? g->columns : g->rows;
    const size_t fields = copy->turned ? g->rows : g->columns;
    for (size_t i = 0; i < lines; i++) {
        for (size_t j = 0; j < fields; j++) {
            const size_t below = copy->turned ? j : i;
            const size_t row = below && copy->reversed ? g->rows - below : below;
            const size_t column = copy->column[copy->turned ? i : j];
            const char *field = row ? g->field[row][column] : copy->heading[column];
            used += (size_t)snprintf(text + used, LONGEST - used, "%s%s", j ? copy->separator : "",
                                     *field ? field : "-");
        }
        used += (size_t)snprintf(text + used, LONGEST - used, "\n");
    }
}

static struct copy copy_as_it_is(const struct grid *g)
{
    struct copy copy = {.g = g, .separator = ","};
    for (size_t j = 0; j < g->columns; j++) {
        copy.heading[j] = g->field[0][j];
        copy.column[j] = j;
    }
    return copy;
}

/* The column of a heading; columns: there is none. */
static size_t find_column(const struct grid *g, const char *heading)
{
    size_t j = 0;
    while (j < g->columns && strcmp(g->field[0][j], heading) != 0)
        j++;
    return j;
}

static bool is_rate(const char *heading)
{
    static const char *const words[] = {"rate", "order", "eoc", "roc", "conv", "slope", "ratio"};
    char text[80];
    plain(heading, text);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strstr(text, words[i]))
            return true;
    return false;
}

static const struct sizes *first_axis(const struct expected *e)
{
    return &e->axis[e->axis[BR_AXIS_SPACE].count ? BR_AXIS_SPACE : BR_AXIS_TIME];
}

/* What a copy does to a table; returns false where it does not apply. */
static bool permute(struct copy *copy, const struct expected *e)
{
    (void)e;
    for (size_t j = 0; j < copy->g->columns; j++)
        copy->column[j] = copy->g->columns - 1 - j;
    return true;
}

static bool rotate(struct copy *copy, const struct expected *e)
{
    (void)e;
    for (size_t j = 0; j < copy->g->columns; j++)
        copy->column[j] = (j + 1) % copy->g->columns;
    return true;
}

static bool reverse(struct copy *copy, const struct expected *e)
{
    copy->reversed = true;
    return e->names > 0;
}

static bool as_csv(struct copy *copy, const struct expected *e)
{
    (void)copy;
    return e->names > 0;
}

static bool with_blanks(struct copy *copy, const struct expected *e)
{
    copy->separator = "   ";
    return e->names > 0;
}

static bool with_bars(struct copy *copy, const struct expected *e)
{
    copy->separator = " | ";
    return e->names > 0;
}

static bool with_tabs(struct copy *copy, const struct expected *e)
{
    copy->separator = "\t";
    return e->names > 0;
}

static bool turn(struct copy *copy, const struct expected *e)
{
    const size_t size = find_column(copy->g, first_axis(e)->column);
    copy->turned = true;
    return size < copy->g->columns && isalpha((unsigned char)*copy->heading[size]);
}

static bool hide(struct copy *copy, const struct expected *e)
{
    static const char *const hidden[] = {"c1", "c2", "c3", "c4", "c5", "c6", "c7", "c8"};
    for (size_t j = 0; j < copy->g->columns && j < sizeof hidden / sizeof *hidden; j++)
        if (!is_rate(copy->heading[j]))
            copy->heading[j] = hidden[j];
    return e->names > 0;
}

static bool swap(struct copy *copy, const struct expected *e)
{
    const size_t size = find_column(copy->g, first_axis(e)->column);
    const size_t error = find_column(copy->g, e->name[0].text);
    if (size == copy->g->columns || error == copy->g->columns)
        return false;
    const char *heading = copy->heading[size];
    copy->heading[size] = copy->heading[error];
    copy->heading[error] = heading;
    return true;
}

/* A size is called n, and a count h. */
static bool misname(struct copy *copy, const struct expected *e)
{
    const size_t size = find_column(copy->g, first_axis(e)->column);
    if (size == copy->g->columns || e->axis[BR_AXIS_TIME].count)
        return false;
    const bool grows = strtod(copy->g->field[1][size], NULL) <
                       strtod(copy->g->field[copy->g->rows - 1][size], NULL);
    const bool falls = e->axis[BR_AXIS_SPACE].z[0] > e->axis[BR_AXIS_SPACE].z[1];
    copy->heading[size] = grows == falls ? "h" : "n";
    return true;
}

static const struct {
    const char *name;
    bool (*make)(struct copy *, const struct expected *);
    bool keeps;  /* it means the same */
    size_t most; /* wrong claims that are let pass: what headings that lie can make true */
} copies[] = {
    {"columns from right to left", permute, true, 0},
    {"columns moved by one", rotate, true, 0},
    {"rows from fine to coarse", reverse, true, 0},
    {"CSV", as_csv, true, 0},
    {"blanks", with_blanks, true, 0},
    {"bars", with_bars, true, 0},
    {"tabs", with_tabs, true, 0},
    {"rows as columns", turn, true, 0},
    {"all headings hidden but rates", hide, false, 0},
    {"headings of size and error swapped", swap, false, 2},
    {"h called n, n called h", misname, false, 2},
};
enum { COPIES = sizeof copies / sizeof *copies };

/* ---- tables of results ---- */

struct tally {
    char kind[40];
    size_t all, of[VERDICTS], unnamed;
};

static void count(struct tally *t, const struct outcome *o)
{
    t->all++;
    t->of[o->verdict]++;
    t->unnamed += o->unnamed;
}

static void print(const struct tally *t)
{
    printf("# %-36s %5zu", t->kind, t->all);
    for (size_t i = 0; i < VERDICTS; i++)
        printf(" %7zu", t->of[i]);
    printf("\n");
}

static void print_heading(const char *what)
{
    printf("# %-36s %5s %7s %7s %7s %7s %7s %7s\n", what, "all", "right", "assumed", "asks",
           "refused", "wrong", "w.ass.");
}

static void try_copies(const struct table_case *c, enum verdict original, bool all,
                       struct tally *tallies)
{
    static char text[LONGEST];
    struct grid g;
    if (original > ASSUMED || *c->options || !c->expected.names || !split(c, &g))
        return;
    for (size_t i = 0; i < COPIES; i++) {
        struct copy copy = copy_as_it_is(&g);
        if (!copies[i].make(&copy, &c->expected))
            continue;
        write_copy(&copy, text);
        const struct outcome o =
            read_table(text, c, (struct change){!copies[i].keeps, copy.reversed});
        count(&tallies[i], &o);
        if (o.verdict >= WRONG || (copies[i].keeps && o.verdict > ASSUMED) || (all && o.verdict))
            printf("# %s, %s: %s: %s\n", c->name, copies[i].name, verdict_names[o.verdict], o.why);
    }
    free(g.room);
}

/* The tally of a kind; the last is that of all. */
static struct tally *tally_of(struct tally *tallies, size_t *kinds, const char *kind)
{
    size_t i = 0;
    while (i < *kinds && strcmp(tallies[i].kind, kind) != 0)
        i++;
    if (i == *kinds)
        snprintf(tallies[(*kinds)++].kind, sizeof tallies->kind, "%s", kind);
    return &tallies[i];
}

static char *contents(const char *path)
{
    FILE *file = fopen(path, "r");
    char *text = br_allocate(LONGEST_FILE, 1);
    if (!file || !text)
        bail(path, "cannot be", "read");
    text[fread(text, 1, LONGEST_FILE - 1, file)] = '\0';
    fclose(file);
    return text;
}

/* That a case's names are in its table, for cases that are not tried yet. */
static void check(const struct table_case *c)
{
    FREED char *table = copy_of(c->table, c->length);
    const struct expected *e = &c->expected;
    size_t lines = 0;
    for (const char *t = table; *t; t++)
        lines += *t == '\n';
    for (size_t i = 0; i < e->names; i++)
        if (strcmp(e->name[i].text, "*") != 0 && !strstr(table, e->name[i].text) &&
            !strstr(c->options, e->name[i].text))
            printf("# %s: no '%s' in the table\n", c->name, e->name[i].text);
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct sizes *s = &e->axis[axis];
        if (s->count && !strstr(table, s->column) && !strstr(c->options, s->column))
            printf("# %s: no '%s' in the table\n", c->name, s->column);
        if (s->count > lines && !strchr("[{", table[0]))
            printf("# %s: more sizes than lines\n", c->name);
    }
}

enum { USUAL = 4 };
static const char *const files_of_ours[USUAL] = {"own", "public1", "public2", "public3"};

int main(int arguments, char **argument)
{
    static struct table_case cases[MOST_CASES];
    static struct tally kinds[MOST_CASES + 1], spoilt[COPIES];
    static char *texts[MOST_CASES], usual[4096];
    struct tally total = {.kind = "all"};
    size_t number = 0, known = 0, files = 0;
    bool dry = false, all = false;
    int first = 1;
    for (; first < arguments && strncmp(argument[first], "--", 2) == 0; first++) {
        dry |= strcmp(argument[first], "--dry") == 0;
        all |= strcmp(argument[first], "--all") == 0;
    }
    const bool own = first == arguments;
    for (int i = 0; i < (own ? USUAL : arguments - first); i++) {
        snprintf(usual, sizeof usual, "%s/tests/data/reading/%s.txt",
                 getenv("BEAMRATE_DATA") ? getenv("BEAMRATE_DATA") : ".", files_of_ours[i % USUAL]);
        texts[files] = contents(own ? usual : argument[first + i]);
        number = read_cases(texts[files++], cases, number);
    }
    for (size_t i = 0; i < COPIES; i++)
        snprintf(spoilt[i].kind, sizeof spoilt[i].kind, "%s", copies[i].name);
    printf("TAP version 13\n1..2\n");
    for (size_t i = 0; i < number; i++) {
        if (dry) {
            check(&cases[i]);
            continue;
        }
        FREED char *table = copy_of(cases[i].table, cases[i].length);
        const struct outcome o = read_table(table, &cases[i], (struct change){false, false});
        count(tally_of(kinds, &known, cases[i].kind), &o);
        count(&total, &o);
        if (o.verdict >= WRONG || (all && o.verdict > ASSUMED))
            printf("# %s: %s: %s\n", cases[i].name, verdict_names[o.verdict], o.why);
        try_copies(&cases[i], o.verdict, all, spoilt);
    }
    print_heading("tables of a kind");
    for (size_t i = 0; i < known; i++)
        print(&kinds[i]);
    print(&total);
    printf("# left aside without a word: %zu\n", total.unnamed);
    print_heading("copies of the right ones");
    const size_t read = total.of[RIGHT] + total.of[ASSUMED];
    const bool good = !total.of[WRONG] && !total.unnamed && read * 100 >= LEAST_RIGHT * total.all;
    bool kept = true;
    for (size_t i = 0; i < COPIES; i++) {
        const struct tally *t = &spoilt[i];
        print(t);
        kept &= t->of[WRONG] <= copies[i].most &&
                (!copies[i].keeps || t->of[RIGHT] + t->of[ASSUMED] == t->all);
    }
    printf("%sok 1 - %zu tables\n%sok 2 - copies\n", good ? "" : "not ", number,
           kept ? "" : "not ");
    for (size_t i = 0; i < files; i++)
        free(texts[i]);
    return !good || !kept;
}
