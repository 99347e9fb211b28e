/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One made-up document that has everything, in every format as it is stored in golden/made.
 * Documents that are built wrongly, or without memory, are not printed. */
#include <fcntl.h>
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "checks.h"
#include "tables/document.h"

/* What is awkward. A text stays on its line in all formats but JSON, and what cannot be seen
 * becomes visible. */
static const char *const texts[] = {
    "say",
    "a,b \"c\"",
    "two\nlines\tand",
    "50% & a_b #1 {x} $y^2$ \\ ~",
    "a|b *c* `d` <e> [f]",
    "=1+1",
    "\x1b[2J\x7f\xe2\x80\xae",
    "gr\xc3\xbc\xc3\x9f 2e-3",
    "b\xe4m",
    "1.5",
};
enum { ROWS = sizeof texts / sizeof *texts };

static const double numbers[ROWS] = {1.0 / 3, -0.0, 5e-324,   DBL_MAX, 0.1,
                                     -1e300,  NAN,  INFINITY, 1.25e-5};
static const size_t counts[ROWS] = {0, 1, 7, 9007199254740993, 4, 5, 6, 1000000, INT64_MAX};

static const struct br_provenance provenance = {
    .version = "v1",
    .commit = "c2",
    .compiler = "gcc3",
    .flags = "-O4",
    .command_line = "beamrate 'a`b'",
    .machine = "m6",
    .date = "d7",
    .threads = 8,
    .scene_path = "p9",
    .scene_text = "title: \"t10\"\n",
};

static void put_all_kinds(struct br_document *d)
{
    br_put_table(d, "all", "All & sundry", BR_MAIN);
    for (size_t i = 0; i < ROWS; i++) {
        br_put_row(d);
        BR_PUT(d, br_text(texts[i]), .key = "text");
        BR_PUT(d, br_number(numbers[i]), .key = "number", .heading = "a_number", .unit = "m^(3/2)",
               .format = "%.3e");
        br_put_mark(d, i == 0 ? "R" : NULL);
        BR_PUT(d, br_count(counts[i]), .key = "count");
        BR_PUT(d, br_truth(i % 2), .key = "truth");
        BR_PUT(d, br_nothing(), .key = "empty");
        br_hide(d, "hidden", NULL, br_text(i ? "only for programs" : NULL));
        BR_PUT(d, br_number((double)i), .key = "seen", .flags = BR_FOR_PEOPLE);
        br_put_shown(d, "shown %zu", i);
        BR_PUT(d,
               br_text(
                   br_format(d, "many words %zu that a person gets on several lines of a cell", i)),
               .key = "long", .flags = BR_WRAP | BR_FILES_ONLY);
    }
}

/* Begins a table with one column, which has had a value. */
static void put_x(struct br_document *d, const char *key, const char *title)
{
    br_put_table(d, key, title, 0);
    br_put_row(d);
    BR_PUT(d, br_text("taken back"), .key = "x", .unit = "m");
    br_put_no_row(d);
}

/* A report of everything. */
static void build(struct br_document *d)
{
    br_document_begin(d, "made", "beamrate made", 3, "A caption, 100 % made_up");
    for (int i = 1; i <= BR_MOST_ANSWERS + 1; i++) {
        br_put_answer(d, "Answer %d is ", i);
        br_put_more(d, "%s.", i == 2 ? "50 % & a_b" : "short");
    }
    br_put_fact(d, &(struct br_column){.key = "tip.u", .heading = "tip", .unit = "m"},
                br_number(0.1));
    br_put_fact(d, &(struct br_column){.key = "tip.steps", .flags = BR_FOR_PROGRAMS}, br_count(40));
    br_put_command(d, "again", "To do it again", "cd 'a b'\nrun \\\n  --all");
    put_all_kinds(d);
    put_x(d, "none", "No rows");
    br_put_table(d, "grid", "For people", BR_FOR_PEOPLE);
    br_put_row(d);
    BR_PUT(d, br_count(77), .heading = "k = 1");
    br_put_table(d, "list", "For programs", BR_FOR_PROGRAMS);
    for (int i = 0; i < 2; i++) {
        br_put_row(d);
        BR_PUT(d, br_number(i / 7.0), .key = "y");
    }
    br_put_table(d, "deep", "Too long for a terminal", 0);
    for (size_t i = 0; i <= BR_LONG_TABLE; i++) {
        br_put_row(d);
        BR_PUT(d, br_count(i), .key = "z");
    }
    br_put_section(d, "A section");
    br_put_note(d, "A note of %d %%.", 100);
    br_put_picture(d, "made-h", "Error_h");
    br_put_verdict(d, &(struct br_document_verdict){BR_OUTCOME_FAIL, "scene_a", "order", "too low",
                                                    NULL, 0, .seconds = 0.5});
    br_put_verdict_detail(d, "found %g", 0.5);
    br_put_verdict(d, &(struct br_document_verdict){.group = "scene_b", .name = "silent"});
    br_put_provenance(d, &provenance);
}

/* What a format prints (NULL: the terminal), of one table where it has a file each; to be freed. */
static char *printed(const struct br_document_format *format, const char *table)
{
    OWNED(br_document) d = {0};
    const struct br_document_table *t;
    char *text = NULL;
    size_t size, block = 0;
    FILE *out = open_memstream(&text, &size);
    build(&d);
    while ((t = br_document_next_table(&d, &block)) && table && strcmp(t->key, table) != 0)
        ;
    if (format)
        MUST(br_document_print(out, format, &d, table ? t : NULL, &err));
    else
        MUST(br_document_show(out, &d, 1, &err));
    assert_int_equal(fclose(out), 0);
    return text;
}

/* Two reports on one page, with what is drawn of their picture. */
static char *made_page(const char *svg)
{
    struct br_document d[2] = {{0}};
    char folder[] = "/tmp/beamrate-page-XXXXXX", path[100], *text = NULL;
    size_t size;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/made-h.svg", folder);
    FILE *file = fopen(path, "w"), *out = open_memstream(&text, &size);
    fputs(svg, file);
    assert_int_equal(fclose(file), 0);
    for (size_t i = 0; i < 2; i++) {
        br_document_begin(&d[i], "made", "beamrate made", 3, "A <caption>");
        br_put_answer(&d[i], "Answer & %zu", i);
        br_put_picture(&d[i], "made-h", "Error_h");
        br_put_provenance(&d[i], &provenance);
    }
    MUST(br_document_print_page(out, d, 2, folder, &err));
    assert_int_equal(fclose(out), 0);
    assert_int_equal(remove(path) + remove(folder), 0);
    for (size_t i = 0; i < 2; i++)
        br_document_clear(&d[i]);
    return text;
}

static void print_pages(FILE *out)
{
    char *text = made_page("<?xml?><svg width=\"9\" viewBox=\"0 0 9 5\" xmlns=\"http://x\">"
                           "<title>a title</title><g id='a'/>Z<g id=\"b\" fill='url(#a)'/>"
                           "<text> id=<tspan>'t'</tspan></text>"
                           "<use xlink:href='#a'/></svg>\n");
    fputs(text, out);
    free(text);
    text = made_page("<svg viewBox=\"0 0 9 5\"><g id='a'"); /* cut off */
    assert_null(strstr(text, "<svg"));
    fputs(text, out);
    free(text);
}

/* Every format; of one that has a file for each table, each. */
static void print_formats(FILE *out)
{
    OWNED(br_document) d = {0};
    build(&d);
    for (size_t f = 0; br_document_formats[f]; f++) {
        const struct br_document_format *format = br_document_formats[f];
        const struct br_document_table *t = NULL;
        size_t block = 0;
        fprintf(out, "==== %s\n", format->name);
        if (!format->by_table)
            MUST(br_document_print(out, format, &d, NULL, &err));
        while (format->by_table && (t = br_document_next_table(&d, &block))) {
            fprintf(out, "---- %s\n", t->key);
            MUST(br_document_print(out, format, &d, t, &err));
        }
    }
    fputs("==== the terminal\n", out);
    MUST(br_document_show(out, &d, 1, &err));
    fputs("==== pages\n", out);
    print_pages(out);
}

TEST(test_formats)
{
    br_test_stored("document", print_formats, 0);
}

/* ---- drawn documents: every format has the same cells ---- */

enum { DRAWN = 40, MOST_TABLES = 3, MOST_COLUMNS = 6, MOST_ROWS = 7, WORD = 48 };

/* What was put, and nothing else, is what each format has to have. Texts are words here; what
 * formats make of other texts is stored above. */
struct drawn {
    size_t tables, columns[MOST_TABLES], rows[MOST_TABLES];
    struct br_value value[MOST_TABLES][MOST_ROWS][MOST_COLUMNS];
    char text[MOST_TABLES][MOST_ROWS][MOST_COLUMNS][WORD];
    char key[MOST_TABLES][MOST_COLUMNS][WORD];
};

static struct br_value draw_value(struct br_test_random *r, size_t kind, char text[WORD])
{
    snprintf(text, WORD, "w%zux", br_test_index(r, 99999));
    const double number = br_test_uniform(r, -1, 1) * pow(10, br_test_uniform(r, -300, 300));
    switch (br_test_index(r, 6) == 0 ? 4 : kind) {
    case 0:
        return br_number(br_test_index(r, 5) ? number : (double)NAN);
    case 1:
        return br_count(br_test_index(r, 1 << 30));
    case 2:
        return br_text(text);
    case 3:
        return br_truth(br_test_index(r, 2));
    default:
        return br_nothing();
    }
}

/* Begins with a table's number and the row's in words, so that rows and tables can be told apart.
 */
static void draw_document(struct drawn *w, struct br_document *d, struct br_test_random *r)
{
    br_document_begin(d, "drawn", "beamrate drawn", 1, "Drawn");
    w->tables = 1 + br_test_index(r, MOST_TABLES);
    for (size_t t = 0; t < w->tables; t++) {
        char name[WORD];
        size_t kind[MOST_COLUMNS];
        w->columns[t] = 2 + br_test_index(r, MOST_COLUMNS - 1);
        w->rows[t] = 1 + br_test_index(r, MOST_ROWS);
        snprintf(name, sizeof name, "t%zu", t);
        br_put_table(d, name, name, 0);
        for (size_t j = 0; j < w->columns[t]; j++) {
            kind[j] = br_test_index(r, 4);
            snprintf(w->key[t][j], WORD, "c%zu", j);
        }
        for (size_t i = 0; i < w->rows[t]; i++) {
            br_put_row(d);
            for (size_t j = 0; j < w->columns[t]; j++) {
                char *text = w->text[t][i][j];
                w->value[t][i][j] = draw_value(r, kind[j], text);
                if (j == 0) {
                    snprintf(text, WORD, "r%zuof%zu", i, t);
                    w->value[t][i][j] = br_text(text);
                }
                BR_PUT(d, w->value[t][i][j], .key = w->key[t][j], .format = "%.4e");
            }
        }
    }
}

/* A cell as people or as programs read it. */
static void word_of(struct br_value v, bool people, char word[WORD])
{
    switch (v.kind) {
    case BR_NUMBER:
        if (isfinite(v.number))
            snprintf(word, WORD, people ? "%.4e" : "%.17g", v.number);
        else
            snprintf(word, WORD, people ? "-" : "");
        break;
    case BR_COUNT:
        snprintf(word, WORD, "%lld", v.count);
        break;
    case BR_TEXT:
        snprintf(word, WORD, "%s", v.text);
        break;
    case BR_TRUTH:
        snprintf(word, WORD, "%s", people ? v.truth ? "yes" : "no" : v.truth ? "true" : "false");
        break;
    default:
        snprintf(word, WORD, people ? "-" : "");
    }
}

/* Takes the marks of a format away: fields are then parted by blanks (of CSV, by commas). */
static void strip_marks(char *line)
{
    static const char *const marks[] = {"<td class=\"number\">",
                                        "<td class=\"text\">",
                                        "</td>",
                                        "<tr>",
                                        "</tr>",
                                        "\\cdot10^",
                                        "\\\\",
                                        "|",
                                        "&",
                                        "$",
                                        "}"};
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        for (char *at; (at = strstr(line, marks[i]));) {
            const size_t size = strlen(marks[i]);
            memset(at, ' ', size);
            if (marks[i][1] == 'c') { /* 1.5\cdot10^{-3}: a word again */
                memmove(at + 1, at + size + 1, strlen(at + size + 1) + 1);
                *at = 'e';
            }
        }
}

/* People do not see a column without a value. */
static bool has_value(const struct drawn *w, size_t t, size_t column)
{
    char word[WORD] = "-";
    for (size_t i = 0; i < w->rows[t] && strcmp(word, "-") == 0; i++)
        word_of(w->value[t][i][column], true, word);
    return strcmp(word, "-") != 0;
}

/* Whether the words of a line are those of the row; numbers may be written in two ways. */
static bool is_row(char *line, const struct drawn *w, size_t t, size_t i)
{
    char *rest, *found = strtok_r(line, " ", &rest), word[WORD];
    for (size_t j = 0; j < w->columns[t]; j++) {
        if (!has_value(w, t, j))
            continue;
        word_of(w->value[t][i][j], true, word);
        char *end, *found_end;
        if (!found || (strcmp(found, word) != 0 &&
                       (strtod(found, &found_end) != strtod(word, &end) || *end || *found_end)))
            return false;
        found = strtok_r(NULL, " ", &rest);
    }
    return !found;
}

/* Each row stands once, in its order. */
static void rows_are_in(const struct br_document_format *format, const struct drawn *w,
                        struct br_document *d)
{
    FREED char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    MUST(br_document_print(out, format, d, NULL, &err));
    assert_int_equal(fclose(out), 0);
    size_t t = 0, i = 0;
    char *rest = text;
    for (char *line; t < w->tables && (line = strsep(&rest, "\n"));) {
        char name[WORD];
        snprintf(name, sizeof name, "r%zuof%zu", i, t);
        if (!strstr(line, name))
            continue;
        strip_marks(line);
        FREED char *copy = strdup(line);
        if (!is_row(line, w, t, i))
            fail_msg("%s has another row %zu of table %zu: %s", format->name, i, t, copy);
        if (++i == w->rows[t]) {
            i = 0;
            t++;
        }
    }
    if (t < w->tables)
        fail_msg("%s lacks row %zu of table %zu", format->name, i, t);
}

static void csv_is(const struct drawn *w, struct br_document *d)
{
    const struct br_document_table *table;
    size_t block = 0;
    for (size_t t = 0; (table = br_document_next_table(d, &block)); t++) {
        char *text = NULL, *expected = NULL, word[WORD];
        size_t size, other;
        FILE *out = open_memstream(&text, &size), *line = open_memstream(&expected, &other);
        MUST(br_document_print(out, &br_document_csv, d, table, &err));
        for (size_t i = 0; i <= w->rows[t]; i++)
            for (size_t j = 0; j < w->columns[t]; j++) {
                if (i > 0)
                    word_of(w->value[t][i - 1][j], false, word);
                fprintf(line, "%s%s", i ? word : w->key[t][j], j + 1 < w->columns[t] ? "," : "\n");
            }
        assert_int_equal(fclose(out) + fclose(line), 0);
        assert_string_equal(text, expected);
        free(text);
        free(expected);
    }
}

static void json_is(const struct drawn *w, struct br_document *d)
{
    FREED char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    MUST(br_document_print(out, &br_document_json, d, NULL, &err));
    assert_int_equal(fclose(out), 0);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    assert_int_equal(json_object_size(json_object_get(root, "tables")), w->tables);
    for (size_t t = 0; t < w->tables; t++) {
        char name[WORD];
        snprintf(name, sizeof name, "t%zu", t);
        const json_t *rows = json_object_get(json_object_get(root, "tables"), name);
        assert_int_equal(json_array_size(rows), w->rows[t]);
        for (size_t i = 0; i < w->rows[t]; i++) {
            const json_t *row = json_array_get(rows, i);
            assert_int_equal(json_object_size(row), w->columns[t]);
            for (size_t j = 0; j < w->columns[t]; j++) {
                const struct br_value v = w->value[t][i][j];
                const json_t *cell = json_object_get(row, w->key[t][j]);
                if (v.kind == BR_NOTHING || (v.kind == BR_NUMBER && !isfinite(v.number)))
                    assert_true(json_is_null(cell));
                else if (v.kind == BR_TEXT)
                    assert_string_equal(json_string_value(cell), v.text);
                else if (v.kind == BR_TRUTH)
                    assert_true(v.truth ? json_is_true(cell) : json_is_false(cell));
                else
                    assert_true(json_number_value(cell) ==
                                (v.kind == BR_COUNT ? (double)v.count : v.number));
            }
        }
    }
    json_decref(root);
}

TEST(formats_have_the_same_cells)
{
    static const struct br_document_format *const people[] = {
        &br_document_text, &br_document_markdown, &br_document_latex, &br_document_html};
    static struct drawn w;
    const char *given = getenv("BR_TEST_SEED");
    const uint64_t seed = given            ? strtoull(given, NULL, 10)
                          : br_test_long() ? (uint64_t)time(NULL)
                                           : 1;
    print_message("# seed %llu\n", (unsigned long long)seed);
    for (size_t i = 0; i < DRAWN; i++) {
        struct br_test_random r = br_test_random_of(seed, i);
        OWNED(br_document) d = {0};
        draw_document(&w, &d, &r);
        for (size_t f = 0; f < sizeof people / sizeof *people; f++)
            rows_are_in(people[f], &w, &d);
        csv_is(&w, &d);
        json_is(&w, &d);
    }
}

/* A unit of the first column, and first columns that not all see. */
static void build_first(struct br_document *d)
{
    static const char *const tables[] = {"t", "u", "v"};
    static const char *const titles[] = {"T", "U", "V"};
    br_document_begin(d, "first", "f", 1, "First");
    for (int i = 0; i < 3; i++) {
        br_put_table(d, tables[i], titles[i], 0);
        br_put_row(d);
        if (i < 2)
            BR_PUT(d, br_count(7), .key = i ? "pe" : "pc",
                   .flags = i ? BR_FOR_PEOPLE : BR_FOR_PROGRAMS);
        BR_PUT(d, br_count(8), .key = "one", .unit = "m");
        BR_PUT(d, br_count(9), .key = "two", .unit = i ? NULL : "s");
    }
}

TEST(test_first_columns)
{
    static const struct {
        const struct br_document_format *format;
        const char *text[3]; /* of each table */
    } rows[] = {
        {&br_document_text, {"\none, m  two, s\n", "\npe  one, m  two\n", "\none, m  two\n"}},
        {&br_document_markdown,
         {"\n| one, m | two, s |", "\n| pe | one, m | two |", "\n| one, m | two |"}},
        {&br_document_latex, {"\none, m & two, s ", "\npe & one, m & two ", "\none, m & two "}},
        {&br_document_html, {">one, m</th>", ">pe</th>", ">one, m</th>"}},
        {&br_document_csv, {"pc,one [m],two [s]\n", "one [m],two\n8,9\n", "one [m],two\n8,9\n"}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_document) d = {0};
        size_t block = 0, size;
        build_first(&d);
        for (size_t t = 0; t < 3; t++) {
            const struct br_document_table *table = br_document_next_table(&d, &block);
            FREED char *text = NULL;
            FILE *out = open_memstream(&text, &size);
            MUST(br_document_print(out, rows[i].format, &d, rows[i].format->by_table ? table : NULL,
                                   &err));
            assert_int_equal(fclose(out), 0);
            if (!strstr(text, rows[i].text[t]) ||
                (rows[i].format->by_table && strstr(text, rows[i].text[t]) != text))
                fail_msg("%s, %zu: found '%s', expected '%s'", rows[i].format->name, t, text,
                         rows[i].text[t]);
        }
    }
}

/* ---- a terminal ---- */

static void build_wide(struct br_document *d)
{
    br_document_begin(d, "wide", "f", 1, "Wide");
    br_put_answer(d, "FAIL: one of two, and words that go on and on until a line ends.");
    br_put_table(d, "t", "T", 0);
    for (int i = 0; i < 2; i++) {
        br_put_row(d);
        BR_PUT(d, br_text(i ? "FAIL" : "PASS"), .key = "verdict");
        BR_PUT(d, br_text(i ? "gr\xc3\xbc\xc3\x9f" : "a name of it"), .key = "name");
        BR_PUT(d, br_number(i - 1.5), .key = "number", .heading = "a heading of words",
               .unit = "m/s");
        br_put_mark(d, i ? " R" : NULL);
        BR_PUT(d, br_text(i ? "no" : "a long text that finds no room on one line of a row"),
               .key = "text", .flags = BR_WRAP);
        BR_PUT(d, br_text("a column that is not wrapped but where a terminal is narrow"),
               .key = "long");
        BR_PUT(d, br_number(1e-9 / 3), .key = "last", .format = "%.4e");
    }
    br_put_table(d, "u", "A title of many words, more than a narrow terminal has room for", 0);
    br_put_row(d);
    BR_PUT(d, br_text("a"), .key = "b");
    br_put_verdict(d, &(struct br_document_verdict){
                          .outcome = BR_OUTCOME_FAIL,
                          .group = "group",
                          .name = "name",
                          .message = "a message of many words that goes on and on until a line "
                                     "ends, and then some more of them"});
}

/* Shows the document on a terminal of so many columns (0: not known), at most 8191 bytes. */
static void show_on_terminal(int columns, char text[8192])
{
    OWNED(br_document) d = {0};
    struct winsize size = {.ws_col = (unsigned short)columns};
    const int ours = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(ours >= 0 && grantpt(ours) == 0 && unlockpt(ours) == 0);
    const int theirs = open(ptsname(ours), O_RDWR | O_NOCTTY);
    struct termios mode;
    assert_int_equal(tcgetattr(theirs, &mode), 0);
    cfmakeraw(&mode);
    assert_int_equal(tcsetattr(theirs, TCSANOW, &mode), 0);
    assert_int_equal(ioctl(theirs, TIOCSWINSZ, &size), 0);
    FILE *out = fdopen(theirs, "w");
    assert_non_null(out);
    build_wide(&d);
    MUST(br_document_show(out, &d, 1, &err));
    assert_int_equal(fclose(out), 0);
    size_t length = 0;
    for (ssize_t got; (got = read(ours, text + length, 8191 - length)) > 0;)
        length += (size_t)got;
    text[length] = '\0';
    close(ours);
}

static int columns_of(const char *line, size_t bytes)
{
    int columns = 0;
    for (size_t i = 0; i < bytes; i++)
        columns += ((unsigned char)line[i] & 0xc0) != 0x80;
    return columns;
}

/* The number of each letter but blanks. */
static void count_letters(const char *text, size_t count[256])
{
    memset(count, 0, 256 * sizeof *count);
    for (; *text; text++)
        count[(unsigned char)*text] += *text != ' ' && *text != '\n';
}

/* No line is wider than the terminal, and nothing is lost; where it is wide enough, or its width is
 * not known, it shows what a pipe gets. */
TEST(test_width)
{
    static char text[8192];
    size_t wide[256], narrow[256];
    FREED char *piped = NULL;
    size_t size;
    struct br_document d = {0};
    FILE *out = open_memstream(&piped, &size);
    assert_non_null(out);
    build_wide(&d);
    MUST(br_document_show(out, &d, 1, &err));
    br_document_clear(&d);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(setenv("NO_COLOR", "1", 1), 0);
    show_on_terminal(0, text);
    assert_string_equal(text, piped);
    show_on_terminal(500, text);
    assert_string_equal(text, piped);
    count_letters(piped, wide);
    for (int columns = 24; columns < 130; columns++) {
        show_on_terminal(columns, text);
        for (const char *line = text; *line; line += strcspn(line, "\n") + 1)
            if (columns_of(line, strcspn(line, "\n")) > columns)
                fail_msg("%d columns: found '%.*s'", columns, (int)strcspn(line, "\n"), line);
        count_letters(text, narrow);
        assert_memory_equal(wide, narrow, sizeof wide);
    }
    static const char at_50[] = "T\n"
                                "verdict  name                a    text\n"
                                "                       heading    \n"
                                "                            of    \n"
                                "                        words,    \n"
                                "                           m/s    \n"
                                "    long                                      last\n"
                                "PASS     a name of it     -1.5    a long text that\n"
                                "                                  finds no room on\n"
                                "                                  one line of a\n"
                                "                                  row\n"
                                "    a column that is not wrapped but    3.3333e-10\n"
                                "    where a terminal is narrow                    \n"
                                "FAIL     gr\xc3\xbc"
                                "\xc3\x9f"
                                "             -0.5 R  no\n"
                                "    a column that is not wrapped but    3.3333e-10\n"
                                "    where a terminal is narrow                    \n";
    show_on_terminal(50, text);
    assert_memory_equal(strstr(text, "T\n"), at_50, sizeof at_50 - 1);
}

static size_t count_of(const char *text, const char *part)
{
    size_t count = 0;
    for (; (text = strstr(text, part)); text++)
        count++;
    return count;
}

/* Verdicts have colours on a terminal that has them, unless NO_COLOR is set. */
TEST(test_colours)
{
    static const struct {
        const char *no_color, *term;
        bool coloured;
    } rows[] = {{NULL, "xterm", true},
                {"", "xterm", true},
                {"0", "xterm", false},
                {NULL, "dumb", false},
                {NULL, NULL, false}};
    static char text[8192];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        rows[i].no_color ? setenv("NO_COLOR", rows[i].no_color, 1) : unsetenv("NO_COLOR");
        rows[i].term ? setenv("TERM", rows[i].term, 1) : unsetenv("TERM");
        show_on_terminal(200, text);
        assert_int_equal(count_of(text, "\033[1;32mPASS\033[0m"), rows[i].coloured);
        assert_int_equal(count_of(text, "\033[1;31mFAIL\033[0m"), 3 * rows[i].coloured);
        assert_int_equal(count_of(text, "\033"), 8 * rows[i].coloured);
    }
}

/* ---- what is not printed ---- */

/* Each case is built wrongly in its own way; what begins a table comes before it. */
static void build_wrongly(struct br_document *d, size_t i)
{
    switch (i) {
    case 0:
        br_put_row(d);
        BR_PUT(d, br_count(1), .key = "b");
        break;
    case 1:
        br_put_no_row(d);
        BR_PUT(d, br_count(1), .key = "b");
        break;
    case 2:
        br_put_table(d, "t", "T", 0);
        for (size_t row = 0; row < 2; row++) {
            br_put_row(d);
            BR_PUT(d, br_count(1), .key = row ? "second" : "first");
        }
        break;
    case 3:
        put_x(d, "u", "U");
        BR_PUT(d, br_count(1), .key = "x");
        break;
    case 4:
        br_put_note(d, "outside");
        br_put_row(d);
        break;
    case 5:
        br_put_table(d, "u", "U", 0);
        br_put_row(d);
        BR_PUT(d, br_count(1), .key = "a");
        BR_PUT(d, br_count(1), .key = "a", .heading = "another");
        break;
    case 6:
        br_put_note(d, "outside");
        br_put_no_row(d);
        break;
    case 7:
        br_put_table(d, "u", "U", 0);
        br_put_row(d);
        BR_PUT(d, br_count(1), .heading = "two words");
        break;
    case 8:
        BR_FACT(d, br_count(1), .key = "two words");
        break;
    case 9:
        BR_FACT(d, br_number(1), .key = "a", .format = "%s of it");
        break;
    case 10:
        BR_FACT(d, br_number(1), .key = "a", .format = "%g of %g");
        break;
    case 11:
        br_put_shown(d, "early");
        break;
    case 12:
        br_put_mark(d, "R");
        break;
    case 13:
        br_put_more(d, "more");
        break;
    case 14:
        br_put_verdict_detail(d, "why");
        break;
    case 15:
        BR_PUT(d, br_count(1), .key = "x");
        BR_PUT(d, br_count(2), .key = "x");
        break;
    default:
        put_x(d, "u", "U");
        br_put_verdict(d, &(struct br_document_verdict){.name = "v", .of_row = true});
        break;
    }
}

TEST(test_built_wrongly)
{
    static const char *const messages[] = {
        "no cell for 'b'",
        "no cell for 'b'",
        "no cell for 'second'",
        "no cell for 'x'",
        "a cell outside of a table, after 'outside'",
        "two values in a row for 'a'",
        "a cell outside of a table, after 'outside'",
        "no key for programs: ''",
        "no key for programs: 'two words'",
        "no format of a number: '%s of it'",
        "no format of a number: '%g of %g'",
        "no value that is shown as 'early'",
        "no value before the mark 'R'",
        "no text before 'more'",
        "no verdict before 'why'",
        "two values in a row for 'x'",
        "no row for the verdict 'v'",
    };
    for (size_t i = 0; i < sizeof messages / sizeof *messages; i++) {
        OWNED(br_document) d = {0};
        br_document_begin(&d, "wrong", "f", 1, "c");
        MUST(br_document_status(&d, &err));
        put_x(&d, "t", "T");
        br_put_row(&d);
        build_wrongly(&d, i);
        br_put_note(&d, "what follows does not repair it");
        for (size_t f = 0; br_document_formats[f]; f++)
            REFUSED(br_document_print(stderr, br_document_formats[f], &d, NULL, &err), BR_IO,
                    messages[i]);
        REFUSED(br_document_show(stderr, &d, 1, &err), BR_IO, "the report wrong was built wrongly");
    }
}

/* A row that is taken back leaves columns, but neither values nor their alignment. */
TEST(test_row_is_taken_back)
{
    struct br_document d = {0};
    br_document_begin(&d, "back", "f", 1, "c");
    put_x(&d, "t", "T");
    br_put_row(&d);
    BR_PUT(&d, br_nothing(), .key = "x");
    const struct br_document_table *t = d.block[0].table;
    assert_int_equal(t->rows, 1);
    assert_int_equal(t->columns, 1);
    assert_false(br_document_is_shown(t, 0));
    assert_int_equal(t->column[0].flags, 0);
    br_document_clear(&d);
}

/* What rounds to zero has no sign, wherever numbers become text; all else stays. */
TEST(test_no_sign_of_zero)
{
    static const char *const rows[][2] = {
        {"-0.0000 [-0.0001, -0.0000]", "0.0000 [-0.0001, 0.0000]"},
        {"[-0, -0.10) -0.0e+00 -0.1e-00", "[0, -0.10) 0.0e+00 -0.1e-00"},
        {"x-0 1e-00 --k -0 -0x -0.0.", "x-0 1e-00 --k 0 -0x 0.0."},
        {"-0e -... -0.01 -", "-0e -... -0.01 -"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_document) d = {0};
        br_document_begin(&d, "zero", "f", 1, "c");
        br_put_answer(&d, "%s", rows[i][0]);
        BR_FACT(&d, br_number(-1e-9), .key = "a", .heading = "a", .format = "%.3f");
        char buffer[BR_SHOWN];
        assert_string_equal(d.answer[0], rows[i][1]);
        assert_string_equal(br_document_shown(&d.block[0].what, &d.block[0].cell, buffer), "0.000");
        br_put_shown(&d, "%s", rows[i][0]);
        assert_string_equal(br_document_shown(&d.block[0].what, &d.block[0].cell, buffer),
                            rows[i][1]);
    }
}

/* Two values of one name would be one in JSON. */
TEST(test_two_values)
{
    OWNED(br_document) d = {0};
    br_document_begin(&d, "twice", "f", 1, "c");
    br_put_fact(&d, &(struct br_column){.key = "a.b"}, br_count(1));
    br_put_fact(&d, &(struct br_column){.key = "a.b"}, br_count(2));
    REFUSED(br_document_print(stderr, &br_document_json, &d, NULL, &err), BR_IO,
            "the report twice has two values for 'b'");
}

/* ---- without memory ---- */

static long until; /* allocations of jansson's until one fails */

static void *failing_malloc(size_t size)
{
    return until-- == 0 ? NULL : malloc(size);
}

static void check_whole(const char *text, const char *whole, long failed)
{
    size_t same = 0;
    while (text[same] && text[same] == whole[same])
        same++;
    if (text[same] || whole[same])
        fail_msg("allocation %ld failed: found '%.60s', expected '%.60s'", failed, text + same,
                 whole + same);
}

/* Builds and prints; `fails`: which allocation, of jansson's or of all others. What is printed in
 * spite of that must be whole. */
static enum br_status print_without(const struct br_document_format *format, const char *whole,
                                    long fails, bool jansson)
{
    OWNED(br_document) d = {0};
    size_t block = 0, size;
    FREED char *text = NULL;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    until = jansson ? fails : -1;
    br_allocation_fails_at(jansson ? -1 : fails);
    build(&d);
    const struct br_document_table *table = br_document_next_table(&d, &block);
    const enum br_status status = format ? br_document_print(out, format, &d, table, &err)
                                         : br_document_show(out, &d, 1, &err);
    br_allocation_fails_at(-1);
    assert_int_equal(fclose(out), 0);
    if (status)
        REFUSED(status, BR_NO_MEMORY, "out of memory");
    else
        check_whole(text, whole, fails);
    return status;
}

/* Every allocation fails in turn: each time it is told when the report is printed. */
static void sweep(const struct br_document_format *format, bool jansson, long least)
{
    const bool by_table = format && format->by_table;
    FREED char *whole = printed(format, by_table ? "all" : NULL);
    long i = 0;
    while (print_without(format, whole, i, jansson))
        assert_true(++i < 10000);
    if (i < least)
        fail_msg("%s: %ld allocations failed, expected at least %ld",
                 format ? format->name : "the terminal", i, least);
}

TEST(test_no_memory)
{
    for (size_t f = 0; br_document_formats[f]; f++)
        sweep(br_document_formats[f], false, 1);
    sweep(NULL, false, 3); /* and the buffers of texts and tables */
    json_set_alloc_funcs(failing_malloc, free);
    sweep(&br_document_json, true, 500);
    json_set_alloc_funcs(malloc, free);
}
