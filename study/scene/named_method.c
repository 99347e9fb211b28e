/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/named_method.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/scene/method_fields.h"

/* ---- the words of a name ---- */

/* The fields of a method whose words may stand in a name. */
static const struct br_method_field *const kinds[] = {
    &br_method_fields[BR_METHOD_SCHEME], &br_method_fields[BR_METHOD_CONTACT],
    &br_method_fields[BR_METHOD_FRICTION], &br_method_fields[BR_METHOD_SOLVER],
    &br_method_fields[BR_METHOD_DEGREE]};
enum { CONTACT = 1, KINDS = sizeof kinds / sizeof *kinds };

/* The word of a kind's value i; NULL: i is behind the last one. */
static const char *word_of(const struct br_method_field *f, size_t i)
{
    return f->word ? f->word[i] : f->words->name(i);
}

const char *br_named_method_kind(size_t kind, char *words, size_t size)
{
    const char *word;
    if (kind >= KINDS)
        return NULL;
    words[0] = '\0';
    for (size_t i = 0; (word = word_of(kinds[kind], i)); i++)
        br_append(words, size, "%s%s", i ? ", " : "", word);
    return kinds[kind]->title;
}

/* ---- names ---- */

static bool take(const struct br_method_field *f, const char *word, struct br_method *m)
{
    const char *name;
    size_t i = 0;
    while ((name = word_of(f, i)) && strcmp(name, word) != 0)
        i++;
    if (name)
        f->set(m, (double)i);
    return name;
}

static enum br_status take_word(const char *word, struct br_method *m, bool taken[KINDS],
                                struct br_error *err)
{
    size_t i = 0;
    while (i < KINDS && !take(kinds[i], word, m))
        i++;
    if (i == KINDS) {
        const char *names[64];
        char expected[BR_EXPECTED];
        size_t count = 0;
        for (size_t kind = 0; kind < KINDS; kind++)
            for (size_t j = 0; count < 64 && (names[count] = word_of(kinds[kind], j)); j++)
                count++;
        return br_fail(err, BR_BAD_INPUT, "found '%s', %s", word,
                       br_expected(word, names, count, expected));
    }
    if (taken[i])
        return br_fail(err, BR_BAD_INPUT, "found '%s', but the %s is given already", word,
                       kinds[i]->title);
    taken[i] = true;
    return BR_OK;
}

enum br_status br_named_method_read(const char *name, struct br_named_method *c,
                                    struct br_error *err)
{
    bool taken[KINDS] = {false};
    *c = (struct br_named_method){.method = br_method_default()};
    if (strlen(name) >= sizeof c->name)
        return br_fail(err, BR_BAD_INPUT, "found '%s', expected at most %d letters", name,
                       BR_METHOD_NAME_SIZE - 1);
    strcpy(c->name, name);
    enum br_status status = BR_OK;
    char words[BR_METHOD_NAME_SIZE], *rest = strcpy(words, name);
    while (rest && !status)
        status = take_word(strsep(&rest, "+"), &c->method, taken, err);
    if (!taken[CONTACT])
        c->method.contact = br_contact_rule_of(c->method.scheme);
    return status ? status : br_method_check(&c->method, NULL, err);
}

/* ---- lists ---- */

static bool contains(const struct br_named_methods *all, const struct br_named_method *c)
{
    for (size_t i = 0; i < all->count; i++)
        if (br_methods_equal(&all->list[i].method, &c->method))
            return true;
    return false;
}

enum br_status br_named_methods_read(const char *text, struct br_named_methods *all,
                                     struct br_error *err)
{
    all->count = 0;
    for (const char *rest = text;; rest++) {
        char name[2 * BR_METHOD_NAME_SIZE];
        struct br_named_method c;
        struct br_error inner = {0};
        const size_t length = strcspn(rest, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1),
                 rest);
        if (br_named_method_read(name, &c, &inner))
            return br_fail(err, BR_BAD_INPUT, "--methods: '%s': %s", name, inner.message);
        if (contains(all, &c))
            return br_fail(err, BR_BAD_INPUT, "--methods: %s is given twice", name);
        if (all->count == BR_MOST_NAMED_METHODS)
            return br_fail(err, BR_BAD_INPUT, "--methods: more than %d methods",
                           BR_MOST_NAMED_METHODS);
        all->list[all->count++] = c;
        rest += length;
        if (!*rest)
            return BR_OK;
    }
}

/* ---- the default ones ---- */

const struct br_time_scheme *br_highest_scheme(void)
{
    const struct br_time_scheme *highest = br_time_schemes[0];
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        if (!(*s)->adaptive && (*s)->order > highest->order)
            highest = *s;
    return highest;
}

/* Whether a march of the scene can be created with the method. */
static bool begins(const struct br_scene *scene, const struct br_method *method)
{
    struct br_march *march = NULL;
    const enum br_status status = br_march_create(&march, scene, 4, 4, method, NULL);
    br_march_free(march);
    return !status;
}

void br_named_methods_add(struct br_named_methods *all, const struct br_scene *scene,
                          const char *format, ...)
{
    char name[BR_METHOD_NAME_SIZE];
    struct br_named_method c;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    if (!br_named_method_read(name, &c, NULL) && !contains(all, &c) &&
        all->count < BR_MOST_NAMED_METHODS && (!scene || begins(scene, &c.method)))
        all->list[all->count++] = c;
}

static void add_scheme(const struct br_scene *scene, const struct br_time_scheme *scheme,
                       struct br_named_methods *all)
{
    if (!scene->contact.modelled || !scheme->may_lag) {
        br_named_methods_add(all, scene, "%s", scheme->name);
        return;
    }
    for (const struct br_contact_rule *const *rule = br_contact_rules; *rule; rule++)
        br_named_methods_add(all, scene, "%s+%s", scheme->name, (*rule)->name);
}

void br_named_methods_default(const struct br_scene *scene, struct br_named_methods *all)
{
    /* The first scheme of order two: the other friction rules and solvers are tried with it. */
    const struct br_time_scheme *const *second = br_time_schemes;
    while (second[1] && (*second)->order != 2)
        second++;
    const char *base = (*second)->name;
    all->count = 0;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        add_scheme(scene, *s, all);
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        if (scene->axial.modelled && (s == second || (*s)->order > 2))
            br_named_methods_add(all, scene, "%s+p2", (*s)->name);
    for (size_t i = 1; br_friction_rules[i] && scene->friction.law != BR_FRICTIONLESS; i++)
        br_named_methods_add(all, scene, "%s+%s", base, br_friction_rules[i]->name);
    for (const struct br_linear_solver *const *s = &br_linear_solvers[1]; *s; s++)
        br_named_methods_add(all, scene, "%s+%s", base, (*s)->name);
}
