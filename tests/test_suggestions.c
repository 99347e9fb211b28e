/* SPDX-License-Identifier: GPL-3.0-or-later */
/* "did you mean": every word that a user may write, with one letter wrong, is suggested. Each list
 * of words is that of the refusal of a word that is like none; each word of it is misspelt. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli_driver.h"
#include "orders/request.h"
#include "study/known/expression.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"
#include "study/scene/named_method.h"
#include "study/scene/units.h"
#include "study/verify/verify.h"
#include "support.h"

AROUND_TESTS(cli_make_folder, cli_remove_folder)

enum { MOST_WORDS = 200, LONGEST = 64 };

struct list {
    char word[MOST_WORDS][LONGEST];
    size_t count;
};

/* Says (out) what the program answers to a word in one place. */
typedef void say(const char *frame, const char *word, char *answer, size_t size);

static char text[4096];

/* frame: a text in which %s is the word. */
static const char *fill(const char *frame, const char *word)
{
    const char *at = strstr(frame, "%s");
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - frame), frame, word, at + 2);
    return text;
}

/* ---- which suggestion is right ---- */

/* Whether one inserted, deleted or changed letter, or a swap of neighbours, makes b of a. */
static bool is_one_off(const char *a, const char *b)
{
    while (*a && *a == *b)
        a++, b++;
    size_t m = strlen(a), n = strlen(b);
    while (m && n && a[m - 1] == b[n - 1])
        m--, n--;
    return m + n == 1 || (m == 1 && n == 1) || (m == 2 && n == 2 && a[0] == b[1] && a[1] == b[0]);
}

static bool lists(const struct list *l, const char *word)
{
    for (size_t i = 0; i < l->count; i++)
        if (strcmp(l->word[i], word) == 0)
            return true;
    return false;
}

/* The suggestion must be `right`, or as near, where another word is. */
static void check_answer(const struct list *all, const char *right, const char *wrong,
                         const char *answer)
{
    static const char mark[] = "did you mean '";
    char found[LONGEST] = "";
    const char *at = strstr(answer, mark);
    if (at)
        snprintf(found, sizeof found, "%.*s", (int)strcspn(at + strlen(mark), "'"),
                 at + strlen(mark));
    size_t near = 0;
    for (size_t i = 0; i < all->count; i++)
        near += is_one_off(all->word[i], wrong);
    if (near == 1 ? strcmp(found, right) != 0 : !(lists(all, found) && is_one_off(found, wrong)))
        fail_msg("'%s' for '%s': %s", wrong, right, answer);
    if (at && strstr(at + 1, mark))
        fail_msg("'%s' has two suggestions: %s", wrong, answer);
}

/* Drops, changes, doubles letter i of a word, or swaps it with the next one. */
static void misspell(const char *word, size_t i, int how, char wrong[LONGEST])
{
    const int head = (int)i;
    if (how == 0)
        snprintf(wrong, LONGEST, "%.*s%s", head, word, word + i + 1);
    else if (how == 1)
        snprintf(wrong, LONGEST, "%.*s%c%s", head, word, word[i] == 'q' ? 'j' : 'q', word + i + 1);
    else if (how == 2)
        snprintf(wrong, LONGEST, "%.*s%c%s", head + 1, word, word[i], word + i + 1);
    else
        snprintf(wrong, LONGEST, "%.*s%c%c%s", head, word, word[i + 1], word[i],
                 word[i + 1] ? word + i + 2 : "");
}

/* A word of which one letter is left is like no other; two blanks are read as one. */
static bool is_fair(const struct list *all, const char *word, const char *wrong)
{
    return strlen(wrong + strspn(wrong, "-")) > 1 && !strstr(wrong, "  ") &&
           strcmp(word, wrong) != 0 && !lists(all, wrong);
}

/* step: of the letters that are misspelt. */
static void try_list(const struct list *all, const struct list *some, say *answer_of,
                     const char *frame, bool all_letters)
{
    char wrong[LONGEST], answer[2048];
    size_t tried = 0;
    for (size_t w = 0; w < some->count; w++) {
        const char *word = some->word[w];
        const size_t middle = strlen(word) / 2;
        for (size_t i = all_letters ? 0 : middle; i < (all_letters ? strlen(word) : middle + 1);
             i++)
            for (int how = 0; how < 4; how++) {
                if (how == 3 && !word[i + 1])
                    continue;
                misspell(word, i, how, wrong);
                if (!is_fair(all, word, wrong))
                    continue;
                answer_of(frame, wrong, answer, sizeof answer);
                if (strstr(answer, "'beamrate ")) /* an option of another command */
                    continue;
                check_answer(all, word, wrong, answer);
                tried++;
            }
    }
    if (!(tried >= 3))
        fail_msg("%s: %zu words were tried", frame, tried);
}

/* ---- lists ---- */

static void add(struct list *l, const char *word, size_t length)
{
    assert_true(l->count < MOST_WORDS && length < LONGEST);
    snprintf(l->word[l->count++], LONGEST, "%.*s", (int)length, word);
}

/* The words after "expected one of: ". */
static struct list read_list(const char *answer)
{
    static const char mark[] = "expected one of: ";
    struct list l = {0};
    const char *at = strstr(answer, mark);
    if (!at)
        fail_msg("no list: %s", answer);
    for (at += strlen(mark); *at; at += strspn(at, ", ")) {
        const size_t length = strcspn(at, ",;\n");
        add(&l, at, length);
        at += length;
        if (*at != ',')
            break;
    }
    return l;
}

/* All words that a place lists; least: how many there are at least. */
static void try_place(say *answer_of, const char *frame, size_t least, bool all_letters)
{
    char answer[2048];
    answer_of(frame, "%%%%%%%%%%%%", answer, sizeof answer);
    if (strstr(answer, "did you mean"))
        fail_msg("a word like none has a suggestion: %s", answer);
    const struct list l = read_list(answer);
    if (l.count < least)
        fail_msg("%s: %zu words: %s", frame, l.count, answer);
    try_list(&l, &l, answer_of, frame, all_letters);
}

/* ---- scenes ---- */

static void say_scene(const char *frame, const char *word, char *answer, size_t size)
{
    OWNED(br_scene) scene;
    OWNED(br_verify) verify;
    assert_int_equal(br_verify_read("s.yaml", fill(frame, word), NULL, &scene, &verify, &err),
                     BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

/* frame: of --set. */
static void say_set(const char *frame, const char *word, char *answer, size_t size)
{
    const struct br_scene_asked asked = {.set = fill(frame, word)};
    OWNED(br_scene) scene;
    assert_int_equal(br_scene_parse("s.yaml", "title: T\n", &asked, &scene, &err), BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

TEST(keys_and_words_of_scenes)
{
    try_place(say_scene, "\"%s\": 1\n", 15, true);
    try_place(say_scene, "axial:\n  \"%s\": 1\n", 9, true);
    try_place(say_scene, "bending:\n  \"%s\": 1\n", 13, true);
    try_place(say_scene, "contact:\n  \"%s\": 1\n", 2, true);
    try_place(say_scene, "friction:\n  \"%s\": 1\n", 4, true);
    try_place(say_scene, "friction:\n  law: \"%s\"\n", 2, true);
    try_place(say_set, "%s=1", 15, true);
    try_place(say_set, "contact.%s=1", 2, true);
    try_place(say_set, "friction.law=%s", 2, true);
    struct list shapes = {{"rectangle", "circle", "tube"}, 3}, parts = {{"shape", "history"}, 2};
    try_list(&shapes, &shapes, say_scene, "section: \"%s 20 mm x 2 mm\"\n", true);
    try_list(&parts, &parts, say_scene, "axial:\n  load: {\"%s\": x}\n", true);
}

#define WHOLE                                                                                        \
    "title: T\nlength: 1 m\nduration: 1 s\ndensity: 0 kg/m\naxial:\n  stiffness: 1 N\n  viscosity: " \
    "1 N s\nverify:\n  "

TEST(keys_of_verify)
{
    try_place(say_scene, WHOLE "\"%s\": 1\n", 3, true);
    char answer[2048];
    say_scene(WHOLE "space:\n    \"%s\": 1\n", "%%%%%%%%%%%%", answer, sizeof answer);
    char *end = strstr(answer, ", or a norm"), *begin = strstr(answer, "expected ");
    assert_true(begin && end);
    struct list l = {0};
    for (const char *at = begin + strlen("expected "); at < end; at += strspn(at, ", ")) {
        add(&l, at, strcspn(at, ","));
        at += strcspn(at, ",");
    }
    for (size_t i = 0; br_norms[i]; i++)
        for (int part = 0; part < BR_PARTS; part++) {
            snprintf(text, sizeof text, "%s%s%s", br_norms[i]->name, part ? " " : "",
                     part ? br_part_names[part] : "");
            add(&l, text, strlen(text));
        }
    assert_true(l.count >= 19);
    try_list(&l, &l, say_scene, WHOLE "space:\n    \"%s\": 1\n", true);
}

static void say_expression(const char *frame, const char *word, char *answer, size_t size)
{
    struct br_function f;
    assert_int_equal(br_expression(fill(frame, *word == '%' ? "foreignname" : word), &f, &err),
                     BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

/* The words of letters alone: "atan2h" with its 2 in front is a number. */
TEST(names_in_expressions)
{
    char answer[2048];
    say_expression("%s(x)", "%", answer, sizeof answer);
    const struct list all = read_list(answer);
    struct list some = {0};
    assert_true(all.count >= 20);
    for (size_t i = 0; i < all.count; i++)
        if (!strpbrk(all.word[i], "0123456789"))
            add(&some, all.word[i], strlen(all.word[i]));
    try_list(&all, &some, say_expression, "%s(x)", true);
}

static struct br_dimension wanted;

static void say_unit(const char *frame, const char *word, char *answer, size_t size)
{
    char suggestion[BR_SUGGESTION];
    struct br_unit unit;
    assert_false(br_unit_read(fill(frame, word), &unit));
    snprintf(answer, size, "%s", br_unit_suggestion(text, wanted, suggestion));
}

/* Each unit, with each prefix that it takes: those of its dimension are suggested. */
TEST(units)
{
    static const char *const prefixes[] = {"", "n", "u", "m", "c", "d", "h", "k", "M", "G", "T"};
    char words[BR_UNIT_WORDS];
    struct list all = {0};
    struct br_unit unit, other;
    char *at = words;
    br_unit_words(words);
    for (char *word; (word = strsep(&at, " "));)
        for (size_t p = 0; p < sizeof prefixes / sizeof *prefixes; p++) {
            char name[LONGEST];
            snprintf(name, sizeof name, "%s%s", prefixes[p], word);
            if (br_unit_read(name, &unit) && !lists(&all, name))
                add(&all, name, strlen(name));
        }
    assert_true(all.count >= 80);
    size_t tried = 0;
    for (size_t w = 0; w < all.count; w++)
        for (size_t i = 0; all.word[w][i]; i++)
            for (int how = 0; how < 3; how++) {
                char wrong[LONGEST], answer[256];
                struct list same = {0};
                misspell(all.word[w], i, how, wrong);
                br_unit_read(all.word[w], &unit);
                wanted = unit.of;
                for (size_t v = 0; v < all.count; v++)
                    if (br_unit_read(all.word[v], &other) && br_dimension_is(other.of, wanted))
                        add(&same, all.word[v], strlen(all.word[v]));
                if (strlen(wrong) < 2 || br_unit_read(wrong, &other))
                    continue;
                say_unit("%s", wrong, answer, sizeof answer);
                check_answer(&same, all.word[w], wrong, answer);
                tried++;
            }
    assert_true(tried >= 300);
}

/* The whole unit is suggested, where one word of it is wrong and the dimension is right. */
TEST(units_of_several_words)
{
    static const struct {
        const char *wrong, *of, *suggestion;
    } rows[] = {
        {"Nx m^2", "N m^2", "; did you mean 'N m^2'?"},
        {"kN/mmm^2", "Pa", "; did you mean 'kN/mm^2'?"},
        {"mpa", "Pa", "; did you mean 'mPa'?"},
        {"gpa", "Pa", "; did you mean 'GPa'?"},
        {"kg/(m sm)", "kg/m^2", "; did you mean 'kg/(m m)'?"},
        {"Nx mm", "N", ""},
        {"Nx mxm", "N m", ""},
        {"newton", "N", ""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char answer[256];
        struct br_unit unit;
        assert_true(br_unit_read(rows[i].of, &unit));
        wanted = unit.of;
        say_unit("%s", rows[i].wrong, answer, sizeof answer);
        assert_string_equal(answer, rows[i].suggestion);
    }
}

/* ---- methods ---- */

static const struct br_method_field *field;

static void say_field(const char *frame, const char *word, char *answer, size_t size)
{
    struct br_method m = br_method_default();
    assert_int_equal(br_method_field_read(field, fill(frame, word), &m, &err), BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

static void say_method(const char *frame, const char *word, char *answer, size_t size)
{
    struct br_named_method m;
    assert_int_equal(br_named_method_read(fill(frame, word), &m, &err), BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

TEST(methods)
{
    size_t lists_of_words = 0;
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        if ((field = &br_method_fields[i])->words && field->words->name(0)[1]) {
            try_place(say_field, "%s", 2, true);
            lists_of_words++;
        }
    assert_true(lists_of_words >= 4);
    try_place(say_method, "%s", 15, true);
    try_place(say_method, "bdf2+%s", 15, false);
}

/* ---- orders ---- */

static void say_study(const char *frame, const char *word, char *answer, size_t size)
{
    OWNED(br_orders_request) q;
    assert_int_equal(br_orders_request_read("s.yaml", fill(frame, word), &q, &err), BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

static void say_column(const char *frame, const char *word, char *answer, size_t size)
{
    FREED char *columns = strdup(fill(frame, word));
    struct br_orders_request q = br_orders_request_default();
    OWNED(br_numbers) numbers;
    q.path = (char *)"t.csv";
    q.table = (char *)"mesh_width,l2_error,pressure\n1,3,1\n.5,2,.5\n.25,1,.2\n";
    *(strchr(frame, '=') ? &q.columns : &q.errors) = columns;
    assert_int_equal(br_orders_read(&q, &numbers, &err), BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

static void say_reading(const char *frame, const char *word, char *answer, size_t size)
{
    const struct br_reading reading = {.name = (char *)"l2", .what = (char *)fill(frame, word)};
    assert_int_equal(br_reading_check(&reading, &err), BR_BAD_INPUT);
    snprintf(answer, size, "%s", err.message);
}

TEST(words_of_orders)
{
    struct list headings = {{"mesh_width", "l2_error", "pressure"}, 3};
    struct list errors = {{"l2_error", "pressure"}, 2}; /* a resolution is none */
    struct list prefixes = {{"json:", "csv:", "last:", "stderr:", "file:"}, 5};
    try_place(say_study, "\"%s\": 1\n", 19, true);
    try_list(&headings, &headings, say_column, "%s=h", true);
    try_list(&errors, &errors, say_column, "%s", true);
    for (size_t i = 0; i < prefixes.count; i++) { /* the colon is no letter of the word */
        char *colon = strchr(prefixes.word[i], ':');
        struct list one = {0};
        add(&one, prefixes.word[i], (size_t)(colon - prefixes.word[i]));
        for (size_t at = 0; one.word[0][at]; at++)
            for (int how = 0; how < 3; how++) {
                char wrong[LONGEST], answer[2048];
                misspell(one.word[0], at, how, wrong);
                strcat(wrong, ":");
                say_reading("%s/a", wrong, answer, sizeof answer);
                check_answer(&prefixes, prefixes.word[i], wrong, answer);
            }
    }
}

/* ---- the command line ---- */

static void say_program(const char *frame, const char *word, char *answer, size_t size)
{
    static struct cli_outcome out;
    cli_run_line(fill(frame, word), NULL, &out);
    if (out.exit_code != 2)
        fail_msg("'%s' has exit code %d: %s", text, out.exit_code, out.output);
    snprintf(answer, size, "%.1000s", out.output);
}

TEST(commands_and_values_of_options)
{
    try_place(say_program, "help %s", 12, false);
    try_place(say_program, "completions %s", 1, false);
    try_place(say_program, "extremes %s", 3, false);
    try_place(say_program, "study example1 --norm %s", 3, false);
    try_place(say_program, "study example1 --format %s", 5, false);
    try_place(say_program, "orders --run x{n} --read a=(b) -n %s=1,2,3", 5, false);
    try_place(say_program, "orders --run x{n} --read a=(b) -k %s=1,2,3", 3, false);
    struct list references = {{"exact", "mms"}, 2};
    try_list(&references, &references, say_program, "study example1 --reference %s", true);
    char answer[2048];
    say_program("help %s", "%%%%%", answer, sizeof answer);
    struct list commands = read_list(answer);
    add(&commands, "--help", 6);
    add(&commands, "--version", 9);
    struct list some = {0};
    for (size_t i = 0; i < commands.count && strcmp(commands.word[i], "methods") != 0; i++)
        add(&some, commands.word[i], strlen(commands.word[i]));
    try_list(&some, &some, say_program, "%s example1", false);
}

/* Its options are what it lists: "      --name". */
static struct list options_of(const char *command)
{
    static struct cli_outcome out;
    struct list l = {0};
    cli_run_line(fill("%s --help", command), NULL, &out);
    for (const char *at = out.output; (at = strstr(at, " --")); at += 3)
        if (strspn(at + 3, "abcdefghijklmnopqrstuvwxyz-") > 1)
            add(&l, at + 1, 2 + strspn(at + 3, "abcdefghijklmnopqrstuvwxyz-"));
    return l;
}

static void say_option(const char *frame, const char *word, char *answer, size_t size)
{
    static struct cli_outcome out;
    cli_run_line(fill(frame, word), NULL, &out);
    assert_int_equal(out.exit_code, 2);
    const char *at = strstr(out.output, "did you mean ");
    if (at) /* as '--name', where the others have quotes */
        snprintf(answer, size, "did you mean '%.*s'", (int)strcspn(at + 13, "?"), at + 13);
    else
        snprintf(answer, size, "%.1000s", out.output);
}

TEST(options)
{
    static const char *const commands[] = {"study example1", "orders t.csv", "trade example2",
                                           "check example1", "run example1"};
    struct list done = {0};
    for (size_t c = 0; c < sizeof commands / sizeof *commands; c++) {
        char word[16], frame[64];
        snprintf(word, sizeof word, "%.*s", (int)strcspn(commands[c], " "), commands[c]);
        snprintf(frame, sizeof frame, "%s %%s", commands[c]);
        const struct list all = options_of(word);
        struct list some = {0};
        for (size_t i = 0; i < all.count; i++)
            if (!lists(&done, all.word[i]) && strlen(all.word[i]) > 3) {
                add(&some, all.word[i], strlen(all.word[i]));
                add(&done, all.word[i], strlen(all.word[i]));
            }
        if (some.count)
            try_list(&all, &some, say_option, frame, false);
    }
    if (done.count < 35)
        fail_msg("%zu options", done.count);
}
