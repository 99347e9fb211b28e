/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A made-up page in all formats: what is awkward comes out as it is, and nothing is lost. */
#include <jansson.h>
#include <string.h>

#include "support.h"
#include "tables/sheet.h"

enum { ROWS = 6, COLUMNS = 3 };

static const char *const headings[COLUMNS] = {"who, \"how\"", "n", "error"};
static const char *const cells[ROWS][COLUMNS] = {
    {"plain", "100", "1.5e-05"},
    {"50 % & a_b #1 {x} $y$ a^b \\ ~", "1000000", "-"},
    {"a|b *c* `d` <e>", "-7", "nan"},
    {"1e-3", "0x1p3", "9007199254740993"},
    {"gr\xc3\xbc\xc3\x9f", "18446744073709551615", "inf"},
    {"2e-3 of it", "1", "tol 1e-05"},
};

static const char *heading(const void *self, size_t column, bool *number)
{
    assert_string_equal(self, "self");
    *number = column > 0;
    return headings[column];
}

static void cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    assert_string_equal(self, "self");
    snprintf(text, BR_CELL, "%s", cells[row][column]);
}

static void say(const void *self, const struct br_writer *w)
{
    assert_string_equal(self, "page");
    w->paragraph(w->self, "Verdict: 0 of 5 are silently wrong, 100 % told.");
}

static void say_notes(const void *self, const struct br_writer *w)
{
    assert_string_equal(self, "page");
    w->paragraph(w->self, "first_note");
    w->paragraph(w->self, "second_note");
    w->paragraph(w->self, "third_note");
}

static const struct br_provenance provenance = {
    .version = "1", .commit = "c", .command_line = "beamrate extremes 'a`b'", .date = "today"};

static struct br_page made_page(void)
{
    return (struct br_page){
        .name = "made",
        .caption = "A page, 100 % made up",
        .table = {{"first", "All & sundry", COLUMNS, ROWS, true, "self", heading, cell},
                  {"empty", "Nothing", COLUMNS, 0, false, "self", heading, cell}},
        .tables = 2,
        .self = "page",
        .say = say,
        .say_notes = say_notes,
        .notes_title = "Notes",
        .notes_shown = 1,
        .provenance = &provenance,
    };
}

/* What a format prints; static. */
static const char *printed(const char *format)
{
    static char text[8192];
    struct br_error err = {0};
    const struct br_page page = made_page();
    const struct br_page_emitter *e = br_page_emitter_find(format);
    FILE *file = fmemopen(text, sizeof text, "w");
    assert_non_null(file);
    if (e)
        assert_int_equal(e->emit(file, &page, &err), BR_OK);
    else
        assert_int_equal(br_page_show(file, &page, &err), BR_OK);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void expect(const char *text, const char *part)
{
    if (strstr(text, part))
        return;
    print_error("expected:\n%s\nin:\n%s\n", part, text);
    fail();
}

static void test_text(void **state)
{
    (void)state;
    const char *text = printed("text");
    expect(text, "A page, 100 % made up\n=====================\nVerdict: 0 of 5");
    expect(text, "\nAll & sundry\n"
                 "who, \"how\"                                        n             error\n"
                 "plain                                           100           1.5e-05\n");
    expect(text, "\ngr\xc3\xbc\xc3\x9f                           18446744073709551615"
                 "               inf\n"
                 "2e-3 of it                                        1         tol 1e-05\n");
    expect(text, "\nNothing\nwho, \"how\"  n  error\n\nfirst_note\nsecond_note\nthird_note\n");
    const char *shown = printed("the terminal's");
    assert_null(strstr(shown, "sundry"));
    expect(shown, "first_note\n... and 2 more");
    assert_null(strstr(shown, "second_note"));
}

static void test_csv(void **state)
{
    (void)state;
    assert_string_equal(printed("csv"), "table,\"who, \"\"how\"\"\",n,error\n"
                                        "first,plain,100,1.5e-05\n"
                                        "first,50 % & a_b #1 {x} $y$ a^b \\ ~,1000000,\n"
                                        "first,a|b *c* `d` <e>,-7,nan\n"
                                        "first,1e-3,0x1p3,9007199254740993\n"
                                        "first,gr\xc3\xbc\xc3\x9f,18446744073709551615,inf\n"
                                        "first,2e-3 of it,1,tol 1e-05\n"
                                        "\n"
                                        "table,\"who, \"\"how\"\"\",n,error\n");
}

static void test_markdown(void **state)
{
    (void)state;
    const char *text = printed("markdown");
    expect(text, "# A page, 100 % made up\n\n- Verdict: 0 of 5");
    expect(text, "\n## All \\& sundry\n\n| who, \"how\" | n | error |\n|---|---:|---:|\n");
    expect(text, "| 50 % \\& a\\_b #1 {x} $y$ a^b \\\\ ~ | 1000000 | - |\n");
    expect(text, "| a\\|b \\*c\\* \\`d\\` \\<e\\> | -7 | nan |\n");
    expect(text, "\n## Notes\n\n- first\\_note\n- second\\_note\n");
    expect(text, "\nbeamrate 1 (c), today: beamrate extremes 'a\\`b'\n");
}

static void test_latex(void **state)
{
    (void)state;
    const char *text = printed("latex");
    expect(text, "% beamrate 1 (c), today; needs \\usepackage{booktabs,longtable}\n"
                 "Verdict: 0 of 5 are silently wrong, 100 \\% told.\\par\n");
    expect(text,
           "\\begin{longtable}{lrr}\n\\caption{A page, 100 \\% made up: All \\& sundry}\\\\\n");
    expect(text, "\nplain & 100 & $1.5\\cdot10^{-5}$ \\\\\n");
    expect(text, "50 \\% \\& a\\_b \\#1 \\{x\\} \\$y\\$ a\\^{}b \\textbackslash{} "
                 "\\textasciitilde{} & 1000000 & - \\\\\n");
    expect(text, "a$|$b *c* `d` $<$e$>$ & -7 & nan \\\\\n");
    expect(text, "\n$1\\cdot10^{-3}$ & 0x1p3 & 9007199254740993 \\\\\n");
    expect(text, "\n2e-3 of it & 1 & tol $1\\cdot10^{-5}$ \\\\\n");
    expect(text, "first\\_note\\par\n");
}

/* A cell of the first table. */
static const json_t *at(const json_t *root, size_t row, size_t column)
{
    const json_t *table = json_array_get(json_object_get(root, "tables"), 0);
    return json_array_get(json_array_get(json_object_get(table, "rows"), row), column);
}

static void test_json(void **state)
{
    (void)state;
    json_t *root = json_loads(printed("json"), 0, NULL);
    assert_non_null(root);
    assert_string_equal(json_string_value(json_object_get(root, "caption")),
                        "A page, 100 % made up");
    assert_int_equal(json_array_size(json_object_get(root, "tables")), 2);
    assert_int_equal(json_array_size(json_object_get(root, "sentences")), 1);
    assert_int_equal(json_array_size(json_object_get(root, "notes")), 3);
    assert_int_equal(json_integer_value(at(root, 0, 1)), 100);
    assert_true(json_real_value(at(root, 0, 2)) == 1.5e-05);
    assert_true(json_is_null(at(root, 1, 2)));
    assert_int_equal(json_integer_value(at(root, 2, 1)), -7);
    assert_string_equal(json_string_value(at(root, 2, 2)), "nan");
    assert_string_equal(json_string_value(at(root, 3, 0)), "1e-3"); /* of a column of text */
    assert_string_equal(json_string_value(at(root, 3, 1)), "0x1p3");
    assert_int_equal(json_integer_value(at(root, 3, 2)), 9007199254740993); /* no double has it */
    assert_string_equal(json_string_value(at(root, 4, 1)), "18446744073709551615");
    assert_string_equal(json_string_value(at(root, 4, 2)), "inf");
    assert_string_equal(
        json_string_value(json_object_get(json_object_get(root, "provenance"), "commit")), "c");
    json_decref(root);
}

static void test_no_memory(void **state)
{
    (void)state;
    struct br_error err = {0};
    const struct br_page page = made_page();
    FILE *file = tmpfile();
    br_allocation_fails_at(0);
    assert_int_equal(br_page_emitters[0]->emit(file, &page, &err), BR_NO_MEMORY);
    br_allocation_fails_at(-1);
    fclose(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_text),  cmocka_unit_test(test_csv),  cmocka_unit_test(test_markdown),
        cmocka_unit_test(test_latex), cmocka_unit_test(test_json), cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
