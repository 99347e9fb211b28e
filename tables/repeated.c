/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report's JSON beside that of its repetition. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tables/reports.h"

enum { MOST_TEXT = 300 };

/* Relative differences below this are round-off, where a report does not state more. */
static const double usual_round_off = 1e-9;

struct comparison {
    struct br_document *d;
    struct br_repeated *found;
    double relative; /* of any number */
    double error;    /* of the errors of a study, in their unit */
};

/* Whether a key is one of the words of a list, which stand between blanks. */
static bool is_one_of(const char *key, const char *words)
{
    char word[MOST_TEXT];
    return (size_t)snprintf(word, sizeof word, " %s ", key) < sizeof word && strstr(words, word);
}

/* Measured times, estimated errors of a reference, values derived from them, texts that repeat
 * numbers, values of the machine, and sums that are round-off alone. */
static bool is_skipped(const char *key)
{
    static const char words[] =
        " provenance answer notes pictures message details kernel set_up march repeats front "
        "relative rate_h rate_k ratio imbalance worst largest_imbalance_of_a_step why path "
        "audited_error reference_error ";
    return strstr(key, "second") || strstr(key, "own_") || is_one_of(key, words);
}

/* Which trials are kept, and which are best, depends on the clock. */
static bool depends_on_clock(const char *format)
{
    return format &&
           (strcmp(format, "beamrate trade") == 0 || strcmp(format, "beamrate plan") == 0);
}

/* One value as a text of a row; nothing where there is none. */
static const char *text_of(const json_t *value, char text[MOST_TEXT])
{
    if (json_is_number(value))
        snprintf(text, MOST_TEXT, "%.17g", json_number_value(value));
    else if (json_is_string(value))
        snprintf(text, MOST_TEXT, "%.290s", json_string_value(value));
    else
        snprintf(text, MOST_TEXT, "%s",
                 json_is_true(value)     ? "true"
                 : json_is_false(value)  ? "false"
                 : json_is_array(value)  ? "a list"
                 : json_is_object(value) ? "an object"
                 : value                 ? "null"
                                         : "not there");
    return text;
}

static void put_difference(struct comparison *c, const char *path, const json_t *was,
                           const json_t *is)
{
    char text[MOST_TEXT];
    if (c->found->different++ >= BR_LONG_TABLE)
        return; /* enough to begin with */
    BR_PUT_ROW(c->d, br_text(path), br_text(text_of(was, text)));
    BR_PUT_CELLS(c->d, br_text(text_of(is, text))); /* into the same cell */
}

/* The interval that is stated beside a number: KEY_low and KEY_high, or low and high. */
static bool has_interval(const json_t *object, const char *key, double *low, double *high)
{
    char name[2][MOST_TEXT];
    snprintf(name[0], MOST_TEXT, "%.280s_low", key);
    snprintf(name[1], MOST_TEXT, "%.280s_high", key);
    const bool own = json_object_get(object, name[0]) && json_object_get(object, name[1]);
    if (!own && !is_one_of(key, " order error value "))
        return false;
    const json_t *a = json_object_get(object, own ? name[0] : "low");
    const json_t *b = json_object_get(object, own ? name[1] : "high");
    *low = json_number_value(a);
    *high = json_number_value(b);
    return json_is_number(a) && json_is_number(b);
}

/* Whether it is an end of such an interval. */
static bool is_end(const json_t *object, const char *key)
{
    const char *end = strrchr(key, '_');
    char base[MOST_TEXT];
    snprintf(base, sizeof base, "%.*s", (int)(end && end - key < MOST_TEXT ? end - key : 0), key);
    const char *name = end ? end + 1 : key;
    if (strcmp(name, "low") != 0 && strcmp(name, "high") != 0)
        return false;
    return end ? json_object_get(object, base) != NULL
               : json_object_get(object, "order") || json_object_get(object, "error") ||
                     json_object_get(object, "value");
}

static void compare(struct comparison *c, const char *path, const json_t *was, const json_t *is);

/* The scale of two numbers is the larger one; of the two fields, the largest of both. */
static void compare_member(struct comparison *c, const char *path, const json_t *object,
                           const char *key, const json_t *is)
{
    const json_t *was = json_object_get(object, key);
    char inner[MOST_TEXT];
    snprintf(inner, sizeof inner, "%.200s%s%.90s", path, *path ? "." : "", key);
    if (!json_is_number(was) || !json_is_number(is)) {
        compare(c, inner, was, is);
        return;
    }
    const double a = json_number_value(was), b = json_number_value(is);
    double low, high, scale = fmax(fabs(a), fabs(b));
    if (strcmp(key, "axial") == 0 || strcmp(key, "bending") == 0)
        scale = fmax(scale, fmax(fabs(json_number_value(json_object_get(object, "axial"))),
                                 fabs(json_number_value(json_object_get(object, "bending")))));
    const double allowed = c->relative * scale + (strcmp(key, "error") == 0 ? c->error : 0);
    const bool within = has_interval(object, key, &low, &high) && b >= low && b <= high;
    c->found->compared++;
    if (!within && !(fabs(b - a) <= allowed))
        put_difference(c, inner, was, is);
}

static void compare_objects(struct comparison *c, const char *path, const json_t *was,
                            const json_t *is)
{
    const char *key;
    const json_t *value;
    json_object_foreach ((json_t *)was, key, value)
        if (!is_skipped(key) && !is_end(was, key))
            compare_member(c, path, was, key, json_object_get(is, key));
    json_object_foreach ((json_t *)is, key, value)
        if (!is_skipped(key) && !json_object_get(was, key)) {
            char inner[MOST_TEXT];
            snprintf(inner, sizeof inner, "%.200s%s%.90s", path, *path ? "." : "", key);
            put_difference(c, inner, NULL, value);
        }
}

static void compare(struct comparison *c, const char *path, const json_t *was, const json_t *is)
{
    if (json_is_object(was) && json_is_object(is)) {
        compare_objects(c, path, was, is);
        return;
    }
    if (!json_is_array(was) || !json_is_array(is) || json_array_size(was) != json_array_size(is)) {
        c->found->compared++;
        if (!json_equal(was, is))
            put_difference(c, path, was, is);
        return;
    }
    for (size_t i = 0; i < json_array_size(was); i++) {
        char inner[MOST_TEXT];
        snprintf(inner, sizeof inner, "%.270s[%zu]", path, i);
        compare(c, inner, json_array_get(was, i), json_array_get(is, i));
    }
}

static bool is_same_trial(const json_t *a, const json_t *b)
{
    static const char *const keys[] = {"method", "n", "steps_or_levels", "tolerance"};
    bool same = true;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        same = same && json_equal(json_object_get(a, keys[i]), json_object_get(b, keys[i]));
    return same;
}

/* Trials may differ: compares errors of those in both reports, where both ended well. */
static void compare_trials(struct comparison *c, const json_t *was, const json_t *is)
{
    static const char *const keys[] = {"relative_error", "error", "axial", "bending", "scale"};
    for (size_t i = 0; i < json_array_size(was); i++)
        for (size_t j = 0; j < json_array_size(is); j++) {
            const json_t *a = json_array_get(was, i), *b = json_array_get(is, j);
            char path[MOST_TEXT];
            snprintf(path, sizeof path, "tables.trials[%zu]", i);
            for (size_t k = 0; is_same_trial(a, b) && k < sizeof keys / sizeof *keys; k++)
                if (json_is_number(json_object_get(a, keys[k])) &&
                    json_is_number(json_object_get(b, keys[k])))
                    compare_member(c, path, a, keys[k], json_object_get(b, keys[k]));
        }
}

/* A member of an object of the report, or 0. */
static double number_at(const json_t *report, const char *object, const char *key)
{
    const double value = json_number_value(json_object_get(json_object_get(report, object), key));
    return isfinite(value) ? fabs(value) : 0;
}

void br_report_repeated(const json_t *was, const json_t *is, struct br_repeated *found,
                        struct br_document *d)
{
    static const struct br_column columns[] = {
        {.key = "place"}, {.key = "was", .flags = BR_WRAP}, {.key = "is", .flags = BR_WRAP}};
    const char *format = json_string_value(json_object_get(was, "format"));
    const double round_off =
        fmax(number_at(was, "reference", "round_off"), number_at(was, "prediction", "round_off"));
    struct comparison c = {.d = d, .found = found};
    *found = (struct br_repeated){0};
    c.relative = fmax(usual_round_off, 10 * round_off);
    c.error = fmax(number_at(was, "reference", "own_error"),
                   number_at(was, "reference", "audited_error")) +
              round_off * number_at(was, "reference", "scale");
    BR_TABLE(d, "differences", "What differs", BR_MAIN, columns);
    if (depends_on_clock(format))
        compare_trials(&c, json_object_get(json_object_get(was, "tables"), "trials"),
                       json_object_get(json_object_get(is, "tables"), "trials"));
    else
        compare(&c, "", was, is);
    if (found->different)
        br_put_answer(d, "%zu of %zu values DIFFER beyond their stated error or round-off.",
                      found->different, found->compared);
    else
        br_put_answer(d, "None of %zu values differs beyond its stated error or round-off.",
                      found->compared);
    if (depends_on_clock(format))
        br_put_answer(d,
                      "Only errors of trials that both have were compared: which trials are held "
                      "and which are best depends on the clock.");
}
