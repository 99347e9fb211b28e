/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One made-up document that has everything, read back from every format: each cell at its place,
 * numbers to the bit, awkward texts as they are. Documents that are built wrongly, or without
 * memory, are not printed. */
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"
#include "tables/document.h"

/* What is awkward, as it is, and as it must come out. A text stays on its line in all formats but
 * JSON, and what cannot be seen becomes visible. */
static const struct {
    const char *text, *csv, *plain, *markdown, *latex;
} texts[] = {
    {"say", "say", "say", "say", "say"},
    {"a,b \"c\"", "a,b \"c\"", "a,b \"c\"", "a,b \"c\"", "a,b \"c\""},
    {"two\nlines\tand", "two lines and", "two lines and", "two lines and", "two lines and"},
    {"50% & a_b #1 {x} $y^2$ \\ ~", "50% & a_b #1 {x} $y^2$ \\ ~", "50% & a_b #1 {x} $y^2$ \\ ~",
     "50% \\& a\\_b #1 {x} $y^2$ \\\\ ~",
     "50\\% \\& a\\_b \\#1 \\{x\\} \\$y\\^{}2\\$ \\textbackslash{} \\textasciitilde{}"},
    {"a|b *c* `d` <e> [f]", "a|b *c* `d` <e> [f]", "a|b *c* `d` <e> [f]",
     "a\\|b \\*c\\* \\`d\\` \\<e\\> \\[f\\]", "a$|$b *c* `d` $<$e$>$ {[}f]"},
    {"=1+1", "'=1+1", "=1+1", "=1+1", "=1+1"},
    {"\x1b[2J\x7f\xe2\x80\xae", "\\x1b[2J\\x7f\\u202e", "\\x1b[2J\\x7f\\u202e",
     "\\\\x1b\\[2J\\\\x7f\\\\u202e",
     "\\textbackslash{}x1b{[}2J\\textbackslash{}x7f"
     "\\textbackslash{}u202e"},
    {"gr\xc3\xbc\xc3\x9f 2e-3", "gr\xc3\xbc\xc3\x9f 2e-3", "gr\xc3\xbc\xc3\x9f 2e-3",
     "gr\xc3\xbc\xc3\x9f 2e-3", "gr\xc3\xbc\xc3\x9f 2e-3"},
    {"b\xe4m", "b\\xe4m", "b\\xe4m", "b\\\\xe4m", "b\\textbackslash{}xe4m"},
    {"1.5", "1.5", "1.5", "1.5", "1.5"},
};
enum { ROWS = sizeof texts / sizeof *texts, NO_UTF8 = ROWS - 2 };

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

/* Of a cell on several lines. */
#define MANY_WORDS "many words %zu that a person gets on several lines of a cell"

static void put_all_kinds(struct br_document *d)
{
    static const struct br_column columns[] = {
        {.key = "text"},
        {.key = "number", .heading = "a_number", .unit = "m^(3/2)", .format = "%.3e"},
        {.key = "count"},
        {.key = "truth"},
        {.key = "empty"},
        {.key = "hidden", .flags = BR_FOR_PROGRAMS},
        {.key = "seen", .flags = BR_FOR_PEOPLE},
        {.key = "long", .flags = BR_WRAP | BR_FILES_ONLY},
    };
    BR_TABLE(d, "all", "All & sundry", BR_MAIN, columns);
    for (size_t i = 0; i < ROWS; i++) {
        br_put_row(d);
        BR_PUT(d, br_text(texts[i].text), .key = "text");
        BR_PUT(d, br_number(numbers[i]), .key = NULL);
        br_put_mark(d, i == 0 ? "R" : NULL);
        BR_PUT(d, br_count(counts[i]), .key = NULL);
        BR_PUT(d, br_truth(i % 2), .key = NULL);
        BR_PUT(d, br_nothing(), .key = "empty");
        BR_PUT(d, br_number((double)i), .key = "seen");
        br_put_shown(d, "shown %zu", i);
        BR_PUT(d, br_text(i ? "only for programs" : NULL), .key = "hidden");
        char text[100];
        snprintf(text, sizeof text, MANY_WORDS, i);
        BR_PUT(d, br_text(text), .key = "long");
    }
    br_put_rule(d);
}

/* Begins a table with one column. */
static void put_x(struct br_document *d, const char *key, const char *title)
{
    static const struct br_column columns[] = {{.key = "x"}};
    BR_TABLE(d, key, title, 0, columns);
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
    for (int i = 0; i < 30; i++) {
        br_put_row(d);
        BR_PUT(d, br_number(i / 7.0), .key = "y");
    }
    br_put_table(d, "deep", "Too long for a terminal", 0);
    for (size_t i = 0; i < 30; i++) {
        br_put_row(d);
        BR_PUT(d, br_count(i), .key = "z");
    }
    br_put_section(d, "A section");
    br_put_note(d, "A note of %d %%.", 100);
    br_put_picture(d, "made-h", "Error_h");
    br_put_verdict(d, &(struct br_document_verdict){BR_OUTCOME_FAIL, "scene_a", "order", "too low",
                                                    NULL, 0, .seconds = 0.5});
    br_put_verdict_detail(d, "found %g", 0.5);
    br_put_verdict(d, &(struct br_document_verdict){.name = "silent", .seconds = NAN});
    br_put_provenance(d, &provenance);
}

/* What a format prints (NULL: the terminal), of one table where it has a file each; to be freed. */
static char *printed(const struct br_document_format *format, const char *table)
{
    struct br_error err = {0};
    struct br_document d = {0};
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
        MUST(br_document_show(out, &d, &err));
    assert_int_equal(fclose(out), 0);
    br_document_clear(&d);
    return text;
}

static void expect(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("expected:\n%s\nin:\n%s\n", part, text);
}

static void check_bits(double found, double expected)
{
    if (memcmp(&found, &expected, sizeof found) != 0)
        fail_msg("found %.17g, expected %.17g", found, expected);
}

/* ---- JSON ---- */

static const json_t *member(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!value)
        fail_msg("no '%s'", key);
    return value;
}

static void check_json_row(const json_t *row, size_t i)
{
    assert_int_equal(json_object_size(row), 7); /* all but what is for people */
    assert_string_equal(json_string_value(member(row, "text")),
                        i == NO_UTF8 ? texts[i].plain : texts[i].text);
    if (isfinite(numbers[i]))
        check_bits(json_real_value(member(row, "number")), numbers[i]);
    else
        assert_true(json_is_null(member(row, "number")));
    assert_true(json_integer_value(member(row, "count")) == (json_int_t)counts[i]);
    assert_true(json_boolean_value(member(row, "truth")) == (i % 2 == 1));
    assert_true(json_is_boolean(member(row, "truth")) && json_is_null(member(row, "empty")));
    assert_true(json_is_null(member(row, "hidden")) == (i == 0));
}

static void check_json_frame(const json_t *root)
{
    assert_string_equal(json_string_value(member(root, "format")), "beamrate made");
    assert_int_equal(json_integer_value(member(root, "version")), 3);
    assert_string_equal(json_string_value(member(root, "caption")), "A caption, 100 % made_up");
    assert_int_equal(json_array_size(member(root, "answer")), BR_MOST_ANSWERS);
    const json_t *notes = member(root, "notes"), *tip = member(root, "tip");
    assert_int_equal(json_array_size(notes), 2);
    assert_string_equal(json_string_value(json_array_get(notes, 0)), "Answer 11 is short.");
    check_bits(json_real_value(member(tip, "u")), 0.1);
    assert_int_equal(json_integer_value(member(tip, "steps")), 40);
    assert_string_equal(json_string_value(member(root, "again")), "cd 'a b'\nrun \\\n  --all");
    const json_t *verdict = json_array_get(member(root, "verdicts"), 0);
    assert_string_equal(json_string_value(member(verdict, "verdict")), "FAIL");
    assert_string_equal(json_string_value(json_array_get(member(verdict, "details"), 0)),
                        "found 0.5");
    assert_string_equal(
        json_string_value(member(json_array_get(member(root, "pictures"), 0), "stem")), "made-h");
    static const char *const told[][2] = {
        {"version", "v1"}, {"commit", "c2"},     {"compiler", "gcc3"},
        {"flags", "-O4"},  {"machine", "m6"},    {"command_line", "beamrate 'a`b'"},
        {"date", "d7"},    {"scene_path", "p9"}, {"scene_text", "title: \"t10\"\n"}};
    const json_t *p = member(root, "provenance");
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        assert_string_equal(json_string_value(member(p, told[i][0])), told[i][1]);
    assert_int_equal(json_integer_value(member(p, "threads")), 8);
}

static void test_json(void **state)
{
    (void)state;
    char *text = printed(&br_document_json, NULL);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(root);
    check_json_frame(root);
    const json_t *tables = member(root, "tables"), *all = member(tables, "all");
    assert_int_equal(json_object_size(tables), 4);
    assert_null(json_object_get(tables, "grid"));
    assert_int_equal(json_array_size(member(tables, "none")), 0);
    assert_int_equal(json_array_size(all), ROWS);
    for (size_t i = 0; i < ROWS; i++)
        check_json_row(json_array_get(all, i), i);
    for (size_t i = 0; i < 30; i++)
        check_bits(json_real_value(member(json_array_get(member(tables, "list"), i), "y")),
                   (double)i / 7.0);
    const json_t *units = member(member(member(root, "about_tables"), "all"), "units");
    assert_string_equal(json_string_value(member(units, "number")), "m^(3/2)");
    json_decref(root);
    free(text);
}

/* ---- CSV ---- */

/* The next field (RFC 4180) from *at on, which it moves behind the field and its separator. */
static const char *next_field(const char **at)
{
    static char field[400];
    size_t length = 0;
    const bool quoted = **at == '"';
    *at += quoted;
    while (quoted ? **at != '"' || (*at)[1] == '"' : !strchr(",\n", **at)) {
        assert_true(**at && length + 1 < sizeof field);
        *at += quoted && **at == '"';
        field[length++] = *(*at)++;
    }
    field[length] = '\0';
    *at += quoted;
    assert_true(**at == ',' || **at == '\n');
    ++*at;
    return field;
}

static void check_csv_row(const char **at, size_t i)
{
    char expected[100], *end;
    assert_string_equal(next_field(at), texts[i].csv);
    const char *number = next_field(at);
    if (isfinite(numbers[i]))
        check_bits(strtod(number, &end), numbers[i]);
    else
        assert_string_equal(number, "");
    snprintf(expected, sizeof expected, "%zu", counts[i]);
    assert_string_equal(next_field(at), expected);
    assert_string_equal(next_field(at), i % 2 ? "true" : "false");
    assert_string_equal(next_field(at), "");
    assert_string_equal(next_field(at), i ? "only for programs" : "");
    snprintf(expected, sizeof expected,
             "many words %zu that a person gets on several lines of a cell", i);
    assert_string_equal(next_field(at), expected);
    assert_true((*at)[-1] == '\n');
}

static void test_csv(void **state)
{
    (void)state;
    static const char *const keys[] = {"text",  "number [m^(3/2)]", "count", "truth",
                                       "empty", "hidden",           "long"};
    char *text = printed(&br_document_csv, "all");
    const char *at = text;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        assert_string_equal(next_field(&at), keys[i]);
    for (size_t i = 0; i < ROWS; i++)
        check_csv_row(&at, i);
    assert_string_equal(at, "");
    free(text);
    text = printed(&br_document_csv, "none"); /* a head without rows */
    assert_string_equal(text, "x\n");
    free(text);
    text = printed(&br_document_csv, "list");
    at = text;
    assert_string_equal(next_field(&at), "y");
    for (size_t i = 0; i < 30; i++)
        check_bits(strtod(next_field(&at), NULL), (double)i / 7.0);
    assert_string_equal(at, "");
    free(text);
    struct br_document d = {0};
    size_t block = 0, tables = 0;
    build(&d);
    while (br_document_next_table(&d, &block))
        tables++;
    assert_int_equal(tables, 4); /* none for people alone */
    br_document_clear(&d);
}

/* ---- for people ---- */

/* What people see of a number; NULL of one that is not there. */
static const char *seen(size_t i)
{
    static char text[32];
    snprintf(text, sizeof text, "%.3e", numbers[i] == 0 ? 0.0 : numbers[i]); /* zero has no sign */
    ;
    return isfinite(numbers[i]) ? text : "-";
}

/* Below each other, numbers to the right. */
static void check_text_row(const char *text, size_t i)
{
    char row[400], count[32];
    int columns = 0, missing = (int)strlen("a_number, m^(3/2)") - (int)strlen(seen(i));
    for (const char *c = texts[i].plain; *c; c++)
        columns += ((unsigned char)*c & 0xc0) != 0x80;
    snprintf(count, sizeof count, "%zu", counts[i]);
    snprintf(row, sizeof row, "\n%s%*s  %*s%s%s  %19s  %-5s  shown %zu", texts[i].plain,
             (int)strlen(texts[3].plain) - columns, "", missing, "", seen(i), i ? " " : "R", count,
             i % 2 ? "yes" : "no", i);
    expect(text, row);
}

static void test_text(void **state)
{
    (void)state;
    char *text = printed(&br_document_text, NULL);
    expect(text, "A caption, 100 % made_up\n========================\nAnswer 1 is short.\n"
                 "Answer 2 is 50 % & a_b.\n");
    expect(text, "\ntip: 0.1 m\n");
    expect(text, "\nTo do it again:\n  cd 'a b'\n  run \\\n    --all\n");
    expect(text, "\nAll & sundry\ntext ");
    for (size_t i = 0; i < ROWS; i++)
        check_text_row(text, i);
    expect(text, "shown 0  many words 0 that a person gets on several\n");
    expect(text, "\nFor people\nk = 1\n   77\n");
    expect(text, "\nA section\n---------\nA note of 100 %.\n");
    expect(text, "\nPicture made-h: Error_h\n");
    expect(text, "\n1 PASS, 1 FAIL\n\nFAIL scene_a, order: too low\n  found 0.5\n");
    expect(text, "Too long for a terminal");
    assert_null(strstr(text, "For programs"));
    assert_null(strstr(text, "No rows"));
    assert_null(strstr(text, "only for programs"));
    assert_null(strstr(text, "silent"));
    free(text);
    text = printed(NULL, NULL); /* the terminal: what is short, and last the answer */
    expect(text, "\nAll & sundry\ntext ");
    expect(text, "shown 8\n");
    assert_ptr_equal(strstr(text, "Answer 1 "), strstr(text, "Answer 1 is short.\nAnswer 2"));
    assert_true(strstr(text, "Answer 1 ") > strstr(text, "shown 8\n"));
    assert_null(strstr(text, "many words"));
    assert_null(strstr(text, "Too long for a terminal"));
    assert_null(strstr(text, "A note"));
    expect(text, "found 0.5\n\nAnswer 1 is short.\n");
    expect(text, "Answer 10 is short.\nTo do it again:\n  cd 'a b'\n  run \\\n    --all\n");
    free(text);
}

static void test_markdown(void **state)
{
    (void)state;
    char *text = printed(&br_document_markdown, NULL), row[500];
    expect(text, "# A caption, 100 % made\\_up\n\n- Answer 1 is short.\n- Answer 2 is 50 % \\& ");
    expect(text,
           "\n## All \\& sundry\n\n| text | a\\_number, m^(3/2) | count | truth | seen | long "
           "|\n|---|---:|---:|---|---:|---|\n");
    for (size_t i = 0; i < ROWS; i++) {
        snprintf(row, sizeof row, "\n| %s | %s%s | %zu | %s | shown %zu | many words %zu that",
                 texts[i].markdown, seen(i), i ? "" : " (R)", counts[i], i % 2 ? "yes" : "no", i,
                 i);
        expect(text, row);
    }
    expect(text, "\n- tip: 0.1 m\n");
    expect(text, "\n````\ncd 'a b'\nrun \\\n  --all\n````\n");
    expect(text, "\n## For people\n\n| k = 1 |\n|---:|\n| 77 |\n");
    expect(text, "\n![Error\\_h](<made-h.svg>)\n");
    expect(text, "\n- **FAIL** scene\\_a, order: too low\n  - found 0.5\n");
    expect(text, "\nbeamrate v1 (c2), d7: beamrate 'a\\`b'\n");
    assert_null(strstr(text, "For programs"));
    free(text);
}

/* Braces and environments that are opened are closed. */
static void check_latex_closes(const char *text)
{
    long depth = 0, open = 0;
    for (const char *c = text; *c; c++) {
        const bool escaped = c > text && c[-1] == '\\';
        depth += (*c == '{' && !escaped) - (*c == '}' && !escaped);
        open += (strncmp(c, "\\begin{", 7) == 0) - (strncmp(c, "\\end{", 5) == 0);
        assert_true(depth >= 0 && open >= 0);
    }
    assert_int_equal(depth, 0);
    assert_int_equal(open, 0);
}

/* 1.250e-05 as $1.250\cdot10^{-5}$ */
static const char *seen_in_latex(size_t i)
{
    static char text[64];
    const char *number = seen(i), *e = strchr(number, 'e');
    snprintf(text, sizeof text, "$%.*s\\cdot10^{%d}$", e ? (int)(e - number) : 0, number,
             e ? atoi(e + 1) : 0);
    return e ? text : number;
}

static void test_latex(void **state)
{
    (void)state;
    char *text = printed(&br_document_latex, NULL), row[500];
    expect(text, "% beamrate v1 (c2), d7; needs \\usepackage{booktabs,longtable}\n"
                 "Answer 1 is short.\\par\nAnswer 2 is 50 \\% \\& a\\_b.\\par\n");
    expect(text, "\n\\begin{longtable}{lrrlrp{0.25\\textwidth}}\n"
                 "\\caption{A caption, 100 \\% made\\_up: All \\& sundry}\\\\\n\\toprule\n"
                 "text & a\\_number, m$^{3/2}$ & count & truth & seen & long \\\\\n\\midrule\n");
    for (size_t i = 0; i < ROWS; i++) {
        snprintf(row, sizeof row, "\n%s & %s%s & %zu & %s & shown %zu & many words %zu that",
                 texts[i].latex, seen_in_latex(i), i ? "" : "$^{\\mathrm{R}}$", counts[i],
                 i % 2 ? "yes" : "no", i, i);
        expect(text, row);
    }
    expect(text, " \\\\\n\\midrule\n1.5 & "); /* the rule above the last row */
    expect(text, "\ntip: 0.1 m\\par\n");
    expect(text, "\n\\texttt{cd 'a b'}\\par\n\\texttt{run \\textbackslash{}}\\par\n");
    expect(text, "\\caption{Error\\_h}");
    expect(text, "\n\\textbf{FAIL} scene\\_a, order: too low\\par\nfound 0.5\\par\n");
    check_latex_closes(text);
    assert_null(strstr(text, "For programs"));
    free(text);
}

/* ---- HTML ---- */

/* A plain text as it stands in the page. */
static const char *in_html(const char *plain)
{
    static char text[200];
    size_t used = 0;
    for (const char *c = plain; *c; c++) {
        const char as_it_is[] = {*c, '\0'};
        const char *stead = *c == '<'   ? "&lt;"
                            : *c == '>' ? "&gt;"
                            : *c == '&' ? "&amp;"
                            : *c == '"' ? "&quot;"
                                        : as_it_is;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s", stead);
    }
    return text;
}

static void check_html_table(const char *text)
{
    char row[700];
    expect(text, "<h2>All &amp; sundry</h2>\n<div ");
    expect(
        text,
        "<th scope=\"col\" class=\"text\">text</th>\n"
        "<th scope=\"col\" class=\"number\">a_number, m^(3/2)</th>\n<th scope=\"col\" class=\"number\">count</th>\n"
        "<th scope=\"col\" class=\"text\">truth</th>\n<th scope=\"col\" class=\"number\">seen</th>\n"
        "<th scope=\"col\" class=\"text wrap\">long</th>\n</tr>");
    for (size_t i = 0; i < ROWS; i++) {
        snprintf(row, sizeof row,
                 "\n<tr%s><td class=\"text\">%s</td><td class=\"number\">%s%s</td>"
                 "<td class=\"number\">%zu</td><td class=\"text\">%s</td>"
                 "<td class=\"number\">shown %zu</td><td class=\"text wrap\">many words %zu that",
                 i + 1 == ROWS ? " class=\"rule\"" : "", in_html(texts[i].plain), seen(i),
                 i ? "" : " <sup>R</sup>", counts[i], i % 2 ? "yes" : "no", i, i);
        expect(text, row);
    }
}

static void test_html(void **state)
{
    (void)state;
    char *text = printed(&br_document_html, NULL);
    expect(text, "<title>A caption, 100 % made_up</title>");
    expect(text, "<h1>A caption, 100 % made_up</h1>\n<ul class=\"answer\">\n"
                 "<li>Answer 1 is short.</li>\n<li>Answer 2 is 50 % &amp; a_b.</li>\n");
    expect(text, "</ul>\n<h2>Verdicts</h2>\n<p>1 <strong class=\"PASS\">PASS</strong>, "
                 "1 <strong class=\"FAIL\">FAIL</strong></p>\n<ul>\n"
                 "<li><strong class=\"FAIL\">FAIL</strong> scene_a, order: too low</li>\n"
                 "<li class=\"detail\">found 0.5</li>\n</ul>\n");
    check_html_table(text);
    expect(text, "<dl>\n<div><dt>tip</dt>\n<dd>0.1 m</dd></div>\n</dl>\n");
    expect(text, "<p>To do it again</p>\n<pre>cd 'a b'\nrun \\\n  --all\n</pre>\n");
    expect(text, "<details><summary><h2>Too long for a terminal</h2>\n(30 rows)</summary>");
    expect(text, "<h2>A section</h2>\n<p>A note of 100 %.</p>\n");
    expect(text, "Not drawn here: Error_h. Where gnuplot is installed, its script draws it: "
                 "<code>gnuplot made-h.gp</code>");
    expect(text, "<summary>Scene p9</summary>\n<pre>title: &quot;t10&quot;\n</pre>");
    expect(text, "<pre>beamrate 'a`b'\n</pre>\n<dl>\n<div><dt>Version</dt>\n<dd>v1</dd></div>\n");
    expect(text, "<div><dt>Threads</dt>\n<dd>8</dd></div>\n");
    assert_null(strstr(text, "For programs"));
    assert_null(strstr(text, "No rows"));
    assert_null(strstr(text, "silent"));
    free(text);
}

/* Two reports on one page, with what is drawn of their picture. */
static char *made_page(const char *svg)
{
    struct br_error err = {0};
    struct br_document d[2] = {{0}};
    char folder[] = "/tmp/beamrate-page-XXXXXX", path[100], *text = NULL;
    size_t size;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/made-h.svg", folder);
    FILE *file = fopen(path, "w"), *out = open_memstream(&text, &size);
    fputs(svg, file);
    assert_int_equal(fclose(file), 0);
    for (size_t i = 0; i < 2; i++)
        build(&d[i]);
    MUST(br_document_print_page(out, d, 2, folder, &err));
    assert_int_equal(fclose(out), 0);
    assert_int_equal(remove(path) + remove(folder), 0);
    for (size_t i = 0; i < 2; i++)
        br_document_clear(&d[i]);
    return text;
}

static void test_page(void **state)
{
    (void)state;
    char *text = made_page("<?xml?><svg width=\"9\" viewBox=\"0 0 9 5\" xmlns=\"http://x\">"
                           "<title>a title</title><g id='a'/>Z<g id=\"b\" fill='url(#a)'/>"
                           "<text> id=<tspan>'t'</tspan></text>"
                           "<use xlink:href='#a'/></svg>\n");
    expect(text, "<h1>beamrate made: 2 reports</h1>");
    expect(text, "<li><a href=\"#report2\">A caption, 100 % made_up</a> (made)<br>Answer 1 is ");
    expect(text, "<article id=\"report2\">\n<h2>A caption");
    expect(text, "<h3>All &amp; sundry</h3>");
    for (int i = 1; i <= 2; i++) {
        char picture[300];
        snprintf(
            picture, sizeof picture,
            "<svg viewBox=\"0 0 9 5\" role=\"img\" aria-label=\"Error_h\">"
            "<title></title><g id='picture%d-a'/><g id=\"picture%d-b\" fill='url(#picture%d-a)'/>"
            "<text> id=<tspan>'t'</tspan></text><use xlink:href='#picture%d-a'/></svg>\n</div>",
            i, i, i, i);
        expect(text, picture);
    }
    assert_null(strstr(strstr(text, "<dt>Version") + 1, "<dt>Version"));
    free(text);
    text = made_page("<svg viewBox=\"0 0 9 5\"><g id='a'"); /* cut off */
    expect(text, "Not drawn here: Error_h.");
    assert_null(strstr(text, "<svg"));
    free(text);
}

/* ---- what is not printed ---- */

static void unknown_key(struct br_document *d)
{
    put_x(d, "t", "T");
    br_put_row(d);
    BR_PUT(d, br_count(1), .key = "b");
}

static void new_key(struct br_document *d)
{
    br_put_table(d, "t", "T", 0);
    for (size_t i = 0; i < 2; i++) {
        br_put_row(d);
        BR_PUT(d, br_count(1), .key = i ? "second" : "first");
    }
}

static void too_many_cells(struct br_document *d)
{
    put_x(d, "t", "T");
    br_put_row(d);
    BR_PUT(d, br_count(1), .key = NULL);
    BR_PUT(d, br_count(2), .key = NULL);
}

static void no_row(struct br_document *d)
{
    put_x(d, "t", "T");
    BR_PUT(d, br_count(1), .key = "x");
}

static void no_table(struct br_document *d)
{
    br_put_note(d, "outside");
    br_put_row(d);
}

static void same_key(struct br_document *d)
{
    static const struct br_column columns[] = {{.key = "a"}, {.key = "a", .heading = "another"}};
    BR_TABLE(d, "t", "T", 0, columns);
}

static void late_column(struct br_document *d)
{
    static const struct br_column columns[] = {{.key = "late"}};
    put_x(d, "t", "T");
    br_put_row(d);
    br_put_columns(d, columns, 1);
}

static void no_key(struct br_document *d)
{
    br_put_table(d, "t", "T", 0);
    br_put_row(d);
    BR_PUT(d, br_count(1), .heading = "two words");
}

static void key_of_two_words(struct br_document *d)
{
    BR_FACT(d, br_count(1), .key = "two words");
}

static void wrong_format(struct br_document *d)
{
    BR_FACT(d, br_number(1), .key = "a", .format = "%s of it");
}

static void two_numbers(struct br_document *d)
{
    BR_FACT(d, br_number(1), .key = "a", .format = "%g of %g");
}

static void shown_nothing(struct br_document *d)
{
    br_put_shown(d, "early");
}

static void marked_nothing(struct br_document *d)
{
    br_put_mark(d, "R");
}

static void more_of_nothing(struct br_document *d)
{
    br_put_more(d, "more");
}

static void detail_of_nothing(struct br_document *d)
{
    br_put_verdict_detail(d, "why");
}

static void verdict_without_row(struct br_document *d)
{
    put_x(d, "t", "T");
    br_put_verdict(d, &(struct br_document_verdict){.name = "v", .of_row = true});
}

static void test_built_wrongly(void **state)
{
    (void)state;
    static const struct {
        void (*put)(struct br_document *d);
        const char *message;
    } rows[] = {
        {unknown_key, "no cell for 'b'"},
        {too_many_cells, "no cell for 't'"},
        {new_key, "no cell for 'second'"},
        {no_row, "no cell for 'x'"},
        {no_table, "a cell outside of a table, after 'outside'"},
        {same_key, "two columns with the key 'a'"},
        {late_column, "a column after the first row: 'late'"},
        {no_key, "no key for programs: ''"},
        {key_of_two_words, "no key for programs: 'two words'"},
        {wrong_format, "no format of a number: '%s of it'"},
        {two_numbers, "no format of a number: '%g of %g'"},
        {shown_nothing, "no value that is shown as 'early'"},
        {marked_nothing, "no value before the mark 'R'"},
        {more_of_nothing, "no text before 'more'"},
        {detail_of_nothing, "no verdict before 'why'"},
        {verdict_without_row, "no row for the verdict 'v'"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_error err = {0};
        struct br_document d = {0};
        br_document_begin(&d, "wrong", "f", 1, "c");
        MUST(br_document_status(&d, &err));
        rows[i].put(&d);
        br_put_note(&d, "what follows does not repair it");
        for (size_t f = 0; br_document_formats[f]; f++)
            REFUSED(br_document_print(stderr, br_document_formats[f], &d, NULL, &err), BR_IO,
                    rows[i].message);
        REFUSED(br_document_show(stderr, &d, &err), BR_IO, "the report wrong was built wrongly");
        br_document_clear(&d);
    }
}

/* What rounds to zero has no sign, wherever numbers become text; all else stays. */
static void test_no_sign_of_zero(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {"-0.0000 [-0.0001, -0.0000]", "0.0000 [-0.0001, 0.0000]"},
        {"[-0, -0.10) -0.0e+00 -0.1e-00", "[0, -0.10) 0.0e+00 -0.1e-00"},
        {"x-0 1e-00 --k -0 -0x -0.0.", "x-0 1e-00 --k 0 -0x 0.0."},
        {"-0e -... -0.01 -", "-0e -... -0.01 -"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct br_document d = {0};
        br_document_begin(&d, "zero", "f", 1, "c");
        br_put_answer(&d, "%s", rows[i][0]);
        BR_FACT(&d, br_number(-1e-9), .key = "a", .heading = "a", .format = "%.3f");
        char buffer[BR_SHOWN];
        assert_string_equal(d.answer[0], rows[i][1]);
        assert_string_equal(br_document_shown(&d.block[0].what, &d.block[0].cell, buffer), "0.000");
        br_put_shown(&d, "%s", rows[i][0]);
        assert_string_equal(br_document_shown(&d.block[0].what, &d.block[0].cell, buffer),
                            rows[i][1]);
        br_document_clear(&d);
    }
}

/* Two values of one name would be one in JSON. */
static void test_two_values(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct br_document d = {0};
    br_document_begin(&d, "twice", "f", 1, "c");
    br_put_fact(&d, &(struct br_column){.key = "a.b"}, br_count(1));
    br_put_fact(&d, &(struct br_column){.key = "a.b"}, br_count(2));
    REFUSED(br_document_print(stderr, &br_document_json, &d, NULL, &err), BR_IO,
            "the report twice has two values for 'b'");
    br_document_clear(&d);
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
    struct br_error err = {0};
    struct br_document d = {0};
    size_t block = 0, size;
    char *text = NULL;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    until = jansson ? fails : -1;
    br_allocation_fails_at(jansson ? -1 : fails);
    build(&d);
    const struct br_document_table *table = br_document_next_table(&d, &block);
    const enum br_status status =
        format ? br_document_print(out, format, &d, table, &err) : br_document_show(out, &d, &err);
    br_allocation_fails_at(-1);
    assert_int_equal(fclose(out), 0);
    if (status)
        REFUSED(status, BR_NO_MEMORY, "out of memory");
    else
        check_whole(text, whole, fails);
    br_document_clear(&d);
    free(text);
    return status;
}

/* Every allocation fails in turn: each time it is told when the report is printed. */
static void sweep(const struct br_document_format *format, bool jansson, long least)
{
    const bool by_table = format && format->by_table;
    char *whole = printed(format, by_table ? "all" : NULL);
    long i = 0;
    while (print_without(format, whole, i, jansson))
        assert_true(++i < 10000);
    if (i < least)
        fail_msg("%s: %ld allocations failed, expected at least %ld",
                 format ? format->name : "the terminal", i, least);
    free(whole);
}

static void test_no_memory(void **state)
{
    (void)state;
    for (size_t f = 0; br_document_formats[f]; f++)
        sweep(br_document_formats[f], false, 1);
    sweep(NULL, false, 3); /* and the buffers of texts and tables */
    json_set_alloc_funcs(failing_malloc, free);
    sweep(&br_document_json, true, 500);
    json_set_alloc_funcs(malloc, free);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_csv),
        cmocka_unit_test(test_text),
        cmocka_unit_test(test_markdown),
        cmocka_unit_test(test_latex),
        cmocka_unit_test(test_html),
        cmocka_unit_test(test_page),
        cmocka_unit_test(test_built_wrongly),
        cmocka_unit_test(test_no_sign_of_zero),
        cmocka_unit_test(test_two_values),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
