/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/vary.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/base/words.h"
#include "study/scene/file.h"

/* ---- what is varied ---- */

static bool is_number(const struct br_scene_key *k)
{
    return k->kind == BR_KEY_POSITIVE || k->kind == BR_KEY_NOT_NEGATIVE;
}

/* The name of a key on the command line. */
static const char *full_name(const struct br_scene_key *k, char name[64])
{
    snprintf(name, 64, "%s%s%s", k->section, *k->section ? "." : "", k->name);
    return name;
}

static enum br_status find_key(const char *text, size_t length, struct br_varied *v,
                               struct br_error *err)
{
    char name[BR_MOST_SCENE_KEYS][64], word[100], expected[BR_EXPECTED];
    const char *names[BR_MOST_SCENE_KEYS];
    size_t count = 0;
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        full_name(k, v->name);
        const bool found = strlen(v->name) == length && strncmp(text, v->name, length) == 0;
        if (found && !is_number(k) && k->kind != BR_KEY_SECTION)
            return br_fail(err, BR_BAD_INPUT,
                           "--vary: %s: it is %s, expected a key whose value is a number", v->name,
                           k->help);
        if (found && is_number(k))
            v->key = k;
        if (found && v->key)
            return BR_OK;
        names[count] = strcpy(name[count], v->name);
        count += is_number(k);
    }
    snprintf(word, sizeof word, "%.*s", (int)(length < 99 ? length : 99), text);
    return br_fail(err, BR_BAD_INPUT, "--vary: found key '%s', %s", word,
                   br_expected(word, names, count, expected));
}

/* Whether its unit is 1, which is never printed. */
static bool is_bare(const struct br_scene_key *key)
{
    return strcmp(key->unit, "1") == 0;
}

/* Reads "210 GPa": a number and perhaps (*given) the unit of all values. False: it is not a number,
 * or has a different unit. */
static bool read_value(struct br_varied *v, const char *text, const char *end, double *value,
                       bool *given)
{
    char item[100];
    const size_t length = (size_t)(end - text);
    if (length >= sizeof item)
        return false;
    snprintf(item, sizeof item, "%.*s", (int)length, text);
    const char *unit = br_read_number(item + strspn(item, " "), value);
    if (!unit)
        return false;
    for (char *last = item + length; last > unit && last[-1] == ' ';)
        *--last = '\0';
    unit += strspn(unit, " ");
    *given = *unit;
    if (!*unit)
        return true;
    if (!*v->unit && strlen(unit) < sizeof v->unit)
        strcpy(v->unit, unit);
    return strcmp(v->unit, unit) == 0;
}

static enum br_status refuse_values(const struct br_varied *v, const char *found,
                                    struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT,
                   "--vary: %s: found '%.200s', expected LOW..HIGH log COUNT, LOW..HIGH lin COUNT, "
                   "or numbers separated by commas, %s%s or with one unit behind them, like "
                   "'%s=1e2..1e6 log 9'",
                   v->name, found + strspn(found, " "), is_bare(v->key) ? "without unit" : "in ",
                   is_bare(v->key) ? "" : v->key->unit, v->name);
}

static enum br_status check_count(const struct br_varied *v, double count, double least,
                                  struct br_error *err)
{
    if (count >= least && count <= BR_MOST_VARIED && count == floor(count))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT, "--vary: %s: found %g values, expected %g to %d", v->name,
                   count, least, BR_MOST_VARIED);
}

/* If the key accepts numbers without unit, either all values have a unit or none has. */
static enum br_status read_list(struct br_varied *v, const char *text, struct br_error *err)
{
    size_t most = 1;
    bool given = false, first = false;
    for (const char *c = text; *c; c++)
        most += *c == ',';
    if (check_count(v, (double)most, 1, err))
        return err->status;
    for (const char *rest = text;; rest++) {
        double *value = &v->value[v->count];
        const char *end = strchrnul(rest, ',');
        const bool read = read_value(v, rest, end, value, &given);
        first = v->count ? first : given;
        if (!read || (v->key->need == BR_OR_RATIO && given != first))
            return refuse_values(v, rest, err);
        for (size_t i = 0; i < v->count; i++)
            if (v->value[i] == *value)
                return br_fail(err, BR_BAD_INPUT, "--vary: %s: %g is given twice", v->name, *value);
        v->count++;
        rest = end;
        if (!*rest)
            return BR_OK;
    }
}

/* Rounds to 15 digits: 1000, not 1000.0000000000001. */
static double rounded(double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.15g", value);
    br_read_number(text, &value);
    return value;
}

/* Refuses ends that are too near each other: the values between them must differ. */
static enum br_status check_rise(const struct br_varied *v, struct br_error *err)
{
    for (size_t i = 1; i < v->count; i++)
        if (!(v->value[i] > v->value[i - 1]))
            return br_fail(
                err, BR_BAD_INPUT,
                "--vary: %s: found %zu values from %.17g to %.17g, expected fewer: in 15 "
                "digits some are the same",
                v->name, v->count, v->value[0], v->value[v->count - 1]);
    return BR_OK;
}

/* Reads "LOW..HIGH log 9". dots: its "..". */
static enum br_status read_range(struct br_varied *v, const char *text, const char *dots,
                                 struct br_error *err)
{
    double low = NAN, high = NAN, count = NAN;
    const char *log = strstr(dots, " log "), *word = log ? log : strstr(dots, " lin ");
    bool given = false;
    const bool read = word && read_value(v, text, dots, &low, &given) &&
                      read_value(v, dots + 2, word, &high, &given);
    const char *end = read ? br_read_number(word + strlen(" log "), &count) : NULL;
    v->logarithmic = log;
    if (!end || *end)
        return refuse_values(v, text, err);
    if (!(low < high) || (v->logarithmic && !(low > 0)))
        return br_fail(err, BR_BAD_INPUT, "--vary: %s: found %g..%g, expected %s", v->name, low,
                       high,
                       low < high ? "numbers above 0 for log" : "a lower and then a higher number");
    if (check_count(v, count, 2, err))
        return err->status;
    for (v->count = 0; (double)v->count < count; v->count++) {
        const double fraction = (double)v->count / (count - 1);
        v->value[v->count] =
            rounded(v->logarithmic ? pow(10, log10(low) + fraction * (log10(high) - log10(low)))
                                   : low + fraction * (high - low));
    }
    v->value[0] = low;
    v->value[v->count - 1] = high;
    return check_rise(v, err);
}

enum br_status br_varied_read(const char *text, struct br_varied *v, struct br_error *err)
{
    const size_t length = strcspn(text, "=");
    *v = (struct br_varied){0};
    if (find_key(text, length, v, err))
        return err->status;
    v->value = br_allocate(BR_MOST_VARIED, sizeof *v->value);
    if (!v->value)
        return br_no_memory(err, "the values of --vary");
    const char *values = text[length] ? text + length + 1 : "";
    const char *dots = strstr(values, "..");
    const enum br_status status =
        dots ? read_range(v, values, dots, err) : read_list(v, values, err);
    if (!*v->unit && !is_bare(v->key) && v->key->need != BR_OR_RATIO)
        strcpy(v->unit, v->key->unit);
    return status;
}

void br_varied_clear(struct br_varied *v)
{
    free(v->value);
    *v = (struct br_varied){0};
}

enum br_status br_varied_scene(const struct br_varied *v, size_t i, const char *path,
                               const char *text, struct br_scene *scene, struct br_error *err)
{
    char value[100];
    snprintf(value, sizeof value, "%.17g %s", v->value[i], v->unit);
    const struct br_scene_asked asked = {.varied = v->key, .value = value};
    return br_scene_parse(path, text, &asked, scene, err);
}

/* ---- results ---- */

const char *br_varied_text(const struct br_varied *v, size_t i, char text[BR_VARIED_TEXT])
{
    snprintf(text, BR_VARIED_TEXT, "%s = %.15g%s%s", v->name, v->value[i], *v->unit ? " " : "",
             v->unit);
    return text;
}

enum br_status br_variation_create(struct br_variation *s, const struct br_scene *scene,
                                   struct br_error *err)
{
    const size_t numbers = s->varied->count * s->columns;
    snprintf(s->name, sizeof s->name, "%.200s-%s%s%s", scene->name, s->varied->key->section,
             *s->varied->key->section ? "-" : "", s->varied->key->name);
    snprintf(s->caption, sizeof s->caption, "%.300s, over %s", scene->title, s->varied->name);
    s->value = br_allocate(numbers, sizeof *s->value);
    s->remark = br_allocate(s->varied->count, sizeof(char *));
    s->unstable = br_allocate(s->varied->count, sizeof *s->unstable);
    s->failure = br_allocate(s->varied->count, sizeof *s->failure);
    for (size_t i = 0; s->value && i < numbers; i++)
        s->value[i] = NAN;
    return s->value && s->remark && s->unstable && s->failure
               ? BR_OK
               : br_no_memory(err, "the values of --vary");
}

void br_variation_clear(struct br_variation *s)
{
    free(s->value);
    free(s->remark);
    free(s->unstable);
    free(s->failure);
    *s = (struct br_variation){0};
}

size_t br_variation_failures(const struct br_variation *s, size_t *first)
{
    size_t failures = 0;
    for (size_t i = s->failure ? s->varied->count : 0; i-- > 0;)
        if (s->failure[i].status) {
            failures++;
            *first = i;
        }
    return failures;
}
