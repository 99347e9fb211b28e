/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What foreign strings become in each kind of text, by cases written by hand. */
#include "checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"

static const struct {
    const char *name;
    const struct br_quoting *target;
} targets[] = {
    {"text", &br_for_text},
    {"gnuplot", &br_for_gnuplot},
    {"latex", &br_for_latex},
    {"xml", &br_for_xml},
    {"markdown", &br_for_markdown},
    {"csv", &br_for_csv},
    {"shell", &br_for_shell},
    {"github", &br_for_github},
    {"github property", &br_for_github_property},
};
enum { TARGETS = sizeof targets / sizeof *targets };

/* Both ways of writing, which must agree. */
static const char *quoted(const struct br_quoting *target, const char *text)
{
    static char buffer[4096], stream[4096];
    memset(stream, 0, sizeof stream);
    FILE *out = fmemopen(stream, sizeof stream, "w");
    assert_non_null(out);
    br_quote(out, target, text);
    assert_int_equal(fclose(out), 0);
    assert_ptr_equal(br_quoted(buffer, sizeof buffer, target, text), buffer);
    assert_string_equal(buffer, stream);
    return buffer;
}

/* The pieces between texts, the numbers, and a text that is not there. */
TEST(test_print)
{
    static const char *volatile absent; /* NULL, of which the compiler does not know */
    char text[200] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    assert_non_null(out);
    br_print(out, &br_for_xml, "<a n=\"%zu\" x='%+.2f' %%>%s%s</a>%d%g%%", (size_t)7, 1.5, "a<b",
             absent, -3, 1e9);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(text, "<a n=\"7\" x='+1.50' %>a&lt;b</a>-31e+09%");
}

TEST(test_targets)
{
    static const struct {
        const struct br_quoting *target;
        const char *text, *written;
    } cases[] = {
        {&br_for_text, "5'' beam, 100 %s", "5'' beam, 100 %s"},
        {&br_for_text, "a\nb\tc\r", "a b c "},
        {&br_for_text, "\x1b[31m\x7f\xc2\x85", "\\x1b[31m\\x7f\\x85"},
        {&br_for_text,
         "a\xe2\x80\xae"
         "b\xe2\x81\xa6",
         "a\\u202eb\\u2066"},
        {&br_for_text, "\xff\xc0\xafx\xe2\x80", "\\xff\\xc0\\xafx\\xe2\\x80"},
        {&br_for_text, "Tr\xc3\xa4ger \xf0\x9f\x9a\x80", "Tr\xc3\xa4ger \xf0\x9f\x9a\x80"},
        {&br_for_gnuplot, "plain {/Symbol m}", "'plain {/Symbol m}'"},
        {&br_for_gnuplot, "5'' beam", "\"5\\047\\047 beam\""},
        {&br_for_gnuplot, "'\"`@\\#{}", "\"\\047\\042\\140\\100\\134\\043\\173\\175\""},
        {&br_for_gnuplot, "", "''"},
        {&br_for_gnuplot, "a]]>b &#65; &lt;", "\"a]] >b & \\04365; &lt;\""},
        {&br_for_latex, "\\input{x} 5% $a_b^c$ ~#&",
         "\\textbackslash{}input\\{x\\} 5\\% "
         "\\$a\\_b\\^{}c\\$ \\textasciitilde{}\\#\\&"},
        {&br_for_latex, "\x1b[m", "\\textbackslash{}x1b{[}m"},
        {&br_for_markdown, "</td><script>|", "\\</td\\>\\<script\\>\\|"},
        {&br_for_markdown, "[a](b) &lt; *_`\\", "\\[a\\](b) \\&lt; \\*\\_\\`\\\\"},
        {&br_for_xml, "]]>&<\"'", "]]&gt;&amp;&lt;&quot;'"},
        {&br_for_xml, "\x01", "\\x01"},
        {&br_for_csv, "a", "a"},
        {&br_for_csv, "a,\"b\"", "\"a,\"\"b\"\"\""},
        {&br_for_csv, "=1+1", "'=1+1"},
        {&br_for_csv, "@a,b", "\"'@a,b\""},
        {&br_for_csv, "+cmd|x", "'+cmd|x"},
        {&br_for_csv, "\t =1+1", "'  =1+1"},
        {&br_for_csv, "-1.5e-3", "-1.5e-3"},
        {&br_for_csv, "-inf", "-inf"},
        {&br_for_csv, "", ""},
        {&br_for_github, "100 %, a::b\n", "100 %25, a::b "},
        {&br_for_github_property, "100 %, a::b", "100 %25%2C a%3A%3Ab"},
        {&br_for_shell, "a-b.yaml", "a-b.yaml"},
        {&br_for_shell, "it's $(x)", "'it'\\''s $(x)'"},
        {&br_for_shell, "", "''"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_string_equal(quoted(cases[i].target, cases[i].text), cases[i].written);
}

/* No byte comes out of any target that a terminal would obey. */
TEST(test_nothing_hidden)
{
    for (unsigned long code = 1; code < 0x3000; code++) {
        char text[8] = {(char)code};
        if (code >= 0x800)
            snprintf(text, sizeof text, "%c%c%c", (int)(0xe0 | code >> 12),
                     (int)(0x80 | (code >> 6 & 0x3f)), (int)(0x80 | (code & 0x3f)));
        else if (code >= 0x80)
            snprintf(text, sizeof text, "%c%c", (int)(0xc0 | code >> 6),
                     (int)(0x80 | (code & 0x3f)));
        const bool hidden = code < ' ' || (code >= 0x7f && code < 0xa0) || code == 0x200e ||
                            code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
                            (code >= 0x2066 && code <= 0x2069);
        for (size_t t = 0; t < TARGETS && hidden; t++)
            if (strstr(quoted(targets[t].target, text), text))
                fail_msg("%s lets U+%04lx through", targets[t].name, code);
        if (!hidden && code >= 0xa0 && code < 0x2000 && code != 0x61c)
            assert_string_equal(quoted(&br_for_text, text), text);
    }
}

/* A buffer of any size is filled with whole pieces, and its quotes are closed. */
TEST(test_room)
{
    char buffer[64];
    for (size_t size = 3; size < sizeof buffer; size++) {
        memset(buffer, 'x', sizeof buffer);
        br_quoted(buffer, size, &br_for_gnuplot, "''\xc3\xa4''''");
        assert_true(strlen(buffer) < size);
        assert_int_equal(buffer[strlen(buffer) - 1], '"');
        assert_int_equal(buffer[size], 'x');
        const size_t inside = strlen(buffer) - 2;
        assert_true(inside % 4 == (inside > 8 ? 2 : 0));
    }
}

/* Comments end with their line, and a data file goes on below. */
TEST(test_comment)
{
    char text[128] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    br_write_comment(out, "a\nsystem('x')\x1b \\");
    br_write_comment(out, "");
    fclose(out);
    assert_string_equal(text, "a system('x')\\x1b \\.\n\n");
}

TEST(test_names)
{
    static const char *const cases[][2] = {
        {"example2", "example2"},
        {"My beam_1.5-x+y", "My beam_1.5-x+y"},
        {"Tr\xc3\xa4ger", "Tr\xc3\xa4ger"},
        {"<touch MARK", "_touch MARK"},
        {"|x", "_x"},
        {"-x", "_x"},
        {".x", "_x"},
        {" x", "_x"},
        {"x'.system('y').'", "x_.system__y__._"},
        {"a\nb\x1b\xff\xe2\x80\xae", "a_b___"},
        {"100%s`$(a)\\", "100_s___a__"},
    };
    char name[512];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(name, sizeof name, "%s", cases[i][0]);
        assert_int_equal(br_is_name(name), strcmp(cases[i][0], cases[i][1]) == 0);
        br_make_name(name);
        assert_string_equal(name, cases[i][1]);
        assert_true(br_is_name(name));
    }
    assert_false(br_is_name(""));
    memset(name, 'x', 99);
    strcpy(name + 99, "\xc3\xa4 and more");
    br_make_name(name);
    assert_int_equal(strlen(name), 99); /* no half of a character */
}
