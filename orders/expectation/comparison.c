/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/expectation/comparison.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"

enum { SUBJECT = 192 }; /* characters of a difference's subject */

const char *const br_severity_names[] = {"same", "note", "warning", "serious"};

/* Where each severity begins: a shift of the order in tolerances, factors otherwise. */
static const double order_steps[] = {0.01, 0.25, 1};
static const double constant_steps[] = {1.001, 1.05, 2};
static const double work_steps[] = {1, 1.5, INFINITY};
static const double time_steps[] = {1.25, 1.5, INFINITY}; /* machines differ: never serious */

void br_old_check_clear(struct br_old_check *old)
{
    for (size_t i = 0; i < old->count; i++)
        br_check_clear(&old->check[i]);
    free(old->check);
    json_decref(old->json);
    *old = (struct br_old_check){0};
}

void br_comparison_clear(struct br_comparison *c)
{
    free(c->difference);
    *c = (struct br_comparison){0};
}

/* By how many of the steps `change` is above; NaN is above all. */
static enum br_severity grade(double change, const double steps[BR_SERIOUS])
{
    int severity = 0;
    while (severity < BR_SERIOUS && !(change <= steps[severity]))
        severity++;
    return (enum br_severity)severity;
}

/* The factor between two numbers that are not negative, >= 1; 1 where both are missing or 0. */
static double factor(double before, double now)
{
    if ((isnan(before) && isnan(now)) || before == now)
        return 1;
    return now > before ? now / before : before / now;
}

/* Counts a difference, and lists it where it is worth a line. */
__attribute__((format(printf, 7, 8))) static void add(struct br_comparison *c, const char *subject,
                                                      const char *what, double before, double now,
                                                      enum br_severity severity, const char *format,
                                                      ...)
{
    c->tally[severity]++;
    if (severity == BR_SAME)
        return;
    struct br_difference *d = &c->difference[c->count++];
    *d = (struct br_difference){.before = before, .now = now, .severity = severity};
    snprintf(d->subject, sizeof d->subject, "%s: %s", subject, what);
    va_list args;
    va_start(args, format);
    vsnprintf(d->remark, sizeof d->remark, format, args);
    va_end(args);
}

/* ---- cases ---- */

/* "the constant is 2.5 times the baseline's", "+3.4 %" */
static const char *say_constant(double before, double now, char text[80])
{
    if (isnan(before) || isnan(now))
        snprintf(text, 80,
                 isnan(now) ? "the baseline has a constant, this check has none"
                            : "the baseline has no constant");
    else if (grade(factor(before, now), constant_steps) == BR_SERIOUS)
        snprintf(text, 80, "the constant is %.3g times the baseline's", now / before);
    else
        snprintf(text, 80, "%+.2g %%", 100 * (now / before - 1));
    return text;
}

/* A name that is not UTF-8 has got question marks in JSON (tables/json_value.h). */
static bool same_name(const char *a, const char *b)
{
    while (*a && (*a == *b || (*a == '?' && (unsigned char)*b >= 0x80) ||
                  (*b == '?' && (unsigned char)*a >= 0x80))) {
        a++;
        b++;
    }
    return *a == *b;
}

static const struct br_check *find_check(const struct br_check *checks, size_t count,
                                         const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (same_name(checks[i].name, name))
            return &checks[i];
    return NULL;
}

static const struct br_case *find_case(const struct br_check *check, const struct br_case *c)
{
    for (size_t i = 0; i < check->count; i++) {
        const struct br_case *x = &check->cases[i];
        if (x->kind == c->kind && strcmp(x->measure, c->measure) == 0 &&
            strcmp(x->part, c->part) == 0)
            return x;
    }
    return NULL;
}

/* Whether a limit has gone or moved outward; direction: 1 for an upper one, -1 for a lower one. */
static bool is_looser(double before, double now, double direction)
{
    return before != now && !isnan(before) && !(direction * (now - before) <= 1e-9 * fabs(before));
}

/* A band that is wider lets pass what failed before. */
static bool expects_less(const struct br_expectation *e, const struct br_expectation *old)
{
    return is_looser(br_expectation_high(old), br_expectation_high(e), 1) ||
           is_looser(br_expectation_low(old), br_expectation_low(e), -1) ||
           is_looser(old->ceiling, e->ceiling, 1) || is_looser(old->floor, e->floor, -1);
}

/* "2 to 4 +- 0.2, at most 8" */
static const char *say_expectation(const struct br_expectation *e, char text[160])
{
    br_expectation_text(e, text);
    if (isfinite(e->floor))
        br_append(text, 160, ", %g to %g", e->floor, e->ceiling);
    else if (isfinite(e->ceiling))
        br_append(text, 160, ", at most %g", e->ceiling);
    return text;
}

/* The constant, as the baseline has it. That of a least order is of the observed one: it is taken
 * to the baseline's order where the finest error is the same. */
static double constant_of(const struct br_case *c, double shift)
{
    size_t last = c->points;
    while (last > 0 && c->point[last - 1].flag)
        last--;
    return c->expected.tolerance == 0 && last && isfinite(shift)
               ? c->constant * pow(c->point[last - 1].z, shift)
               : c->constant;
}

static void compare_known(struct br_comparison *out, const char *subject, const struct br_case *c,
                          const struct br_case *old)
{
    const struct br_expectation *e = &c->expected, *before = &old->expected;
    char was[160], now[160], shown[80];
    const double shift = c->order.value - old->order.value;
    const double tolerance = e->tolerance > 0 ? e->tolerance : e->order / 10; /* of a least order */
    const enum br_severity verdict = old->verdict == c->verdict ? BR_SAME
                                     : c->verdict == BR_PASS    ? BR_NOTE
                                                                : BR_SERIOUS;
    enum br_severity order = isnan(old->order.value) && isnan(c->order.value)
                                 ? BR_SAME
                                 : grade(fabs(shift) / tolerance, order_steps);
    const double now_is = constant_of(c, shift);
    enum br_severity constant = grade(factor(old->constant, now_is), constant_steps);
    if (verdict == BR_NOTE || (e->tolerance == 0 && shift > 0)) /* it has not become worse */
        order = order > BR_NOTE ? BR_NOTE : order;
    if (verdict == BR_NOTE || (e->tolerance == 0 && now_is < old->constant))
        constant = constant > BR_NOTE ? BR_NOTE : constant;
    add(out, subject, "verdict", NAN, NAN, verdict, "%s before, %s now",
        br_verdict_names[old->verdict], br_verdict_names[c->verdict]);
    add(out, subject, "expectation", before->order, e->order,
        expects_less(e, before) ? BR_WARNING : BR_SAME, "looser: %s before, %s now",
        say_expectation(before, was), say_expectation(e, now));
    add(out, subject, "order", old->order.value, c->order.value, order,
        isnan(shift) ? "the baseline or this check has no order" : "%+.2g of a tolerance of %.2g",
        shift, tolerance);
    add(out, subject, "constant", old->constant, now_is, constant, "%s",
        say_constant(old->constant, now_is, shown));
}

/* Compares cases, and reports earlier ones that are missing now. NULL: the scene is missing now, or
 * was missing before. */
static void compare_cases(struct br_comparison *out, const struct br_check *check,
                          const struct br_check *old)
{
    const struct br_check *const both[] = {check, old}, *const other[] = {old, check};
    for (int was = 0; was < 2; was++)
        for (size_t i = 0; both[was] && i < both[was]->count; i++) {
            const struct br_case *c = &both[was]->cases[i];
            const struct br_case *beside = other[was] ? find_case(other[was], c) : NULL;
            char subject[SUBJECT];
            snprintf(subject, sizeof subject, "%.100s %s %s%s%s", both[was]->name,
                     br_verify_names[c->kind], c->measure, *c->part ? " " : "", c->part);
            if (beside && !was)
                compare_known(out, subject, c, beside);
            else if (!beside)
                add(out, subject, was ? "gone" : "new", was ? c->order.value : NAN,
                    was ? NAN : c->order.value, was ? BR_SERIOUS : BR_NOTE, "%s",
                    was ? "the baseline has this order, this check has not" : "");
        }
}

/* ---- methods ---- */

/* The object methods.I.KIND; NULL: that study was not made. */
static const json_t *old_method(const struct br_old_check *old, size_t i, enum br_verify_kind kind)
{
    char number[32];
    snprintf(number, sizeof number, "%zu", i);
    const json_t *methods = json_object_get(json_object_get(old->json, "methods"), number);
    return json_object_get(methods, br_verify_names[kind]);
}

const char *br_old_setting(const struct br_old_check *old, size_t i, enum br_verify_kind kind,
                           const struct br_setting *s, char buffer[BR_SETTING_USUAL])
{
    const json_t *method = old_method(old, i, kind);
    const json_t *value =
        json_object_get(s->group ? json_object_get(method, s->group) : method, s->key);
    if (!value)
        return s->needed ? NULL : s->usual;
    if (json_is_number(value))
        return br_shortest(json_number_value(value), buffer, BR_SETTING_USUAL);
    return json_is_null(value) ? "" : json_string_value(value);
}

/* The settings of a study that is made now and was made before; NULL: there are none. */
static const struct br_settings *settings_of(const struct br_check *check,
                                             const struct br_old_check *old, size_t i, int kind)
{
    return check->method && check->method[kind].count &&
                   old_method(old, i, (enum br_verify_kind)kind)
               ? &check->method[kind]
               : NULL;
}

/* Numbers of another method are no continuation. i: of the check before. */
static void compare_methods(struct br_comparison *out, const struct br_check *check,
                            const struct br_old_check *old, size_t i)
{
    char subject[SUBJECT], buffer[BR_SETTING_USUAL];
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        const struct br_settings *now = settings_of(check, old, i, kind);
        snprintf(subject, sizeof subject, "%.100s %s", check->name, br_verify_names[kind]);
        for (const struct br_setting *s = now ? now->row : NULL; now && s < now->row + now->count;
             s++) {
            const char *a = br_old_setting(old, i, (enum br_verify_kind)kind, s, buffer);
            if (s->compared && strcmp(a, s->text) != 0)
                add(out, subject, "another method than the baseline's", NAN, NAN, BR_SERIOUS,
                    "%s %.40s -> %.40s", s->name, *a ? a : "not used",
                    *s->text ? s->text : "not used");
        }
    }
}

/* ---- scenes ---- */

static const char not_given[] = " not given";

static const char *next_line(const char *line)
{
    line += strcspn(line, "\n");
    return line + (*line != '\0');
}

static size_t lines_of(const char *data)
{
    size_t lines = 0;
    for (; data && *data; data = next_line(data))
        lines++;
    return lines;
}

/* A key's value in the data of a scene, from the blank before it on, and its length (out). */
static const char *value_of(const char *data, const char *key, int length, int *size)
{
    while (*data && !(strncmp(data, key, (size_t)length) == 0 && data[length] == ':'))
        data = next_line(data);
    const char *value = *data ? data + length + 1 : not_given;
    *size = (int)strcspn(value, "\n");
    return value;
}

/* The length of the unit that ends a value, with the blank before it: of " 1000 N m^2", or of an
 * expression as " 2 * x [N/m]". */
static int unit_length(const char *value, int size)
{
    int from = 1;
    if (size > 1 && value[size - 1] == ']')
        for (from = size - 1; from > 0 && value[from] != '[';)
            from--;
    else
        from += 1 + (int)strcspn(value + 1, " \n");
    return from > 1 && from <= size ? size - from + 1 : 0;
}

/* "bending.stiffness 1000 -> 1300 N m^2": each key that has another value. */
static void compare_data(struct br_comparison *out, const char *subject, const char *old,
                         const char *now)
{
    const char *const both[] = {now, old};
    for (int was = 0; was < 2; was++)
        for (const char *line = both[was]; *line; line = next_line(line)) {
            const int key = (int)strcspn(line, ":\n");
            int a, b;
            const char *before = value_of(old, line, key, &a),
                       *after = value_of(now, line, key, &b);
            const bool in_both = before != not_given && after != not_given;
            if (in_both && (was || (a == b && memcmp(before, after, (size_t)a) == 0)))
                continue;
            const int tail = in_both ? unit_length(before, a) : 0;
            const char *unit = before + a - tail;
            if (tail && tail < b && memcmp(unit, after + b - tail, (size_t)tail) == 0)
                a -= tail;
            add(out, subject, "another scene than the baseline's", NAN, NAN, BR_SERIOUS,
                "%.*s%.*s ->%.*s", key, line, a, before, b, after);
        }
}

static void compare_scene(struct br_comparison *out, const struct br_check *check,
                          const struct br_check *old)
{
    char subject[SUBJECT];
    snprintf(subject, sizeof subject, "%.100s", check->name);
    if (check->data && old->data) {
        compare_data(out, subject, old->data, check->data);
    } else if (check->data)
        add(out, subject, "scene", NAN, NAN, BR_NOTE,
            "the baseline is older than the record of scenes, so a change of the scene is not "
            "detected: make a new baseline");
}

/* ---- cost ---- */

static void compare_cost(struct br_comparison *out, const struct br_check *check,
                         const struct br_check *old)
{
    const double before = old->seconds / old->element_steps * 1e9;
    const double now = check->seconds / check->element_steps * 1e9;
    char subject[SUBJECT];
    snprintf(subject, sizeof subject, "%.100s", check->name);
    if (check->of_program)
        return; /* its work is not known */
    add(out, subject, "element-steps", old->element_steps, check->element_steps,
        grade(factor(old->element_steps, check->element_steps), work_steps), "%s", "");
    if (isfinite(before) && isfinite(now)) /* both did march */
        add(out, subject, "ns per element-step", before, now,
            grade(factor(before, now), time_steps), "times depend on the machine and its load");
}

static int by_severity(const void *a, const void *b)
{
    const struct br_difference *x = a, *y = b;
    return x->severity != y->severity ? (x->severity < y->severity) - (x->severity > y->severity)
                                      : strcmp(x->subject, y->subject);
}

/* Results of two different problems cannot be compared. */
static enum br_status check_problem(const struct br_check *check, const struct br_check *old,
                                    struct br_error *err)
{
    if (!*check->problem || !*old->problem || strcmp(check->problem, old->problem) == 0)
        return BR_OK;
    return br_fail(
        err, BR_BAD_INPUT,
        "%s: the earlier check had another problem: another command, other columns or other "
        "expectations (%.8s..., now %.8s...)",
        check->name, old->problem, check->problem);
}

/* The settings that will be compared must be there. */
static enum br_status check_methods(const struct br_check *check, const struct br_old_check *old,
                                    size_t i, struct br_error *err)
{
    char buffer[BR_SETTING_USUAL];
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        const struct br_settings *now = settings_of(check, old, i, kind);
        for (size_t j = 0; now && j < now->count; j++)
            if (now->row[j].compared &&
                !br_old_setting(old, i, (enum br_verify_kind)kind, &now->row[j], buffer))
                return br_fail(err, BR_BAD_INPUT,
                               "%s: methods: found no %s of %s %s, expected it as 'beamrate check "
                               "--json' writes it",
                               old->path, now->row[j].key, check->name, br_verify_names[kind]);
    }
    return BR_OK;
}

static enum br_status refuse_others(const struct br_check *checks, size_t count,
                                    const struct br_old_check *old, struct br_error *err)
{
    enum { FIRST = 5 };
    char has[640] = "";
    const char *what = "scene";
    for (size_t i = 0; i < count; i++)
        what = checks[i].of_program ? "source" : what;
    for (size_t i = 0; i < old->count && i < FIRST; i++)
        br_append(has, sizeof has, "%s%.100s", i ? ", " : "", old->check[i].name);
    return br_fail(err, BR_BAD_INPUT,
                   "none of these %ss is in the earlier check %.200s, which has %s%s", what,
                   old->path, *has ? has : "none", old->count > FIRST ? ", ..." : "");
}

enum br_status br_compare_check(const struct br_check *checks, size_t count,
                                const struct br_old_check *old, struct br_error *err)
{
    bool found = false;
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i; j++)
            if (strcmp(checks[i].name, checks[j].name) == 0)
                return br_fail(err, BR_BAD_INPUT,
                               "two scenes are called %s, expected different names in a comparison",
                               checks[i].name);
        const struct br_check *before = find_check(old->check, old->count, checks[i].name);
        found |= before != NULL;
        if (before && (check_problem(&checks[i], before, err) ||
                       check_methods(&checks[i], old, (size_t)(before - old->check), err)))
            return err->status;
    }
    return found ? BR_OK : refuse_others(checks, count, old, err);
}

enum br_status br_compare(const struct br_check *checks, size_t count, bool whole,
                          const struct br_old_check *old, struct br_comparison *out,
                          struct br_error *err)
{
    *out = (struct br_comparison){.version = old->version};
    size_t most = 1;
    for (size_t i = 0; i < old->count; i++)
        most += old->check[i].count;
    for (size_t i = 0; i < count; i++) {
        const struct br_check *before = find_check(old->check, old->count, checks[i].name);
        most += 4 * checks[i].count + 3 + (size_t)BR_VERIFY_KINDS * BR_MOST_SETTINGS;
        most += lines_of(checks[i].data) + (before ? lines_of(before->data) : 0);
    }
    out->difference = br_allocate(most, sizeof *out->difference);
    if (!out->difference)
        return br_no_memory(err, "the comparison");
    for (size_t i = 0; i < count; i++) {
        const struct br_check *before = find_check(old->check, old->count, checks[i].name);
        const size_t first = out->count;
        compare_cases(out, &checks[i], before);
        if (before) {
            compare_scene(out, &checks[i], before);
            compare_methods(out, &checks[i], old, (size_t)(before - old->check));
            compare_cost(out, &checks[i], before);
        }
        for (size_t j = first; j < out->count; j++)
            out->difference[j].check = &checks[i];
    }
    for (size_t i = 0; i < old->count && whole; i++)
        if (!find_check(checks, count, old->check[i].name))
            compare_cases(out, NULL, &old->check[i]);
    qsort(out->difference, out->count, sizeof *out->difference, by_severity);
    return BR_OK;
}
