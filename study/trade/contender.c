/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/trade/contender.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "solver/method.h"

enum { WORD = 32 };

/* ---- the words of a name ---- */

/* A kind of words: take sets what the word means, if it is one of them; row i is a word, NULL
 * behind the last. */
struct kind {
    const char *title;
    bool (*take)(const char *word, struct br_method *method);
    const char *(*row)(size_t i);
};

static bool take_scheme(const char *word, struct br_method *m)
{
    const struct br_time_scheme *found = br_time_scheme_find(word);
    m->scheme = found ? found : m->scheme;
    return found;
}

static bool take_contact(const char *word, struct br_method *m)
{
    const struct br_contact_rule *found = br_contact_rule_find(word);
    m->contact = found ? found : m->contact;
    return found;
}

static bool take_friction(const char *word, struct br_method *m)
{
    const struct br_friction_rule *found = br_friction_rule_find(word);
    m->friction = found ? found : m->friction;
    return found;
}

static bool take_solver(const char *word, struct br_method *m)
{
    const struct br_linear_solver *found = br_linear_solver_find(word);
    m->solver = found ? found : m->solver;
    return found;
}

static bool take_degree(const char *word, struct br_method *m)
{
    if (strcmp(word, "p1") != 0 && strcmp(word, "p2") != 0)
        return false;
    m->axial_degree = word[1] - '0';
    return true;
}

static bool take_scaling(const char *word, struct br_method *m)
{
    if (strcmp(word, "scaled") != 0)
        return false;
    m->linear.scaling = "sum";
    return true;
}

static bool take_refinement(const char *word, struct br_method *m)
{
    if (strcmp(word, "refined") != 0)
        return false;
    m->linear.refinement = 2;
    return true;
}

static const char *scheme_row(size_t i)
{
    return br_time_schemes[i] ? br_time_schemes[i]->name : NULL;
}

static const char *contact_row(size_t i)
{
    return br_contact_rules[i] ? br_contact_rules[i]->name : NULL;
}

static const char *friction_row(size_t i)
{
    return br_friction_rules[i] ? br_friction_rules[i]->name : NULL;
}

static const char *solver_row(size_t i)
{
    return br_linear_solvers[i] ? br_linear_solvers[i]->name : NULL;
}

static const char *degree_row(size_t i)
{
    static const char *const words[] = {"p1", "p2", NULL};
    return words[i];
}

static const char *scaling_row(size_t i)
{
    return i == 0 ? "scaled" : NULL;
}

static const char *refinement_row(size_t i)
{
    return i == 0 ? "refined" : NULL;
}

enum { SCHEME, CONTACT, FRICTION, SOLVER, DEGREE, SCALING, REFINEMENT, KINDS };

static const struct kind kinds[KINDS] = {
    [SCHEME] = {"time scheme", take_scheme, scheme_row},
    [CONTACT] = {"contact", take_contact, contact_row},
    [FRICTION] = {"friction", take_friction, friction_row},
    [SOLVER] = {"linear solver", take_solver, solver_row},
    [DEGREE] = {"axial elements", take_degree, degree_row},
    [SCALING] = {"rows scaled by their sums", take_scaling, scaling_row},
    [REFINEMENT] = {"two refinement steps a solve", take_refinement, refinement_row},
};

size_t br_contender_kinds(void)
{
    return KINDS;
}

const char *br_contender_kind(size_t kind, char *words, size_t size)
{
    size_t used = 0;
    words[0] = '\0';
    for (size_t i = 0; kinds[kind].row(i) && used < size; i++)
        used +=
            (size_t)snprintf(words + used, size - used, "%s%s", i ? ", " : "", kinds[kind].row(i));
    return kinds[kind].title;
}

/* ---- names ---- */

static enum br_status take_word(const char *word, struct br_method *m, bool taken[KINDS],
                                struct br_error *err)
{
    size_t i = 0;
    while (i < KINDS && !kinds[i].take(word, m))
        i++;
    if (i == KINDS)
        return br_fail(err, BR_BAD_INPUT,
                       "found '%s', expected a time scheme, a contact rule, a friction rule, a "
                       "linear solver, p1, p2, scaled or refined",
                       word);
    if (taken[i])
        return br_fail(err, BR_BAD_INPUT, "found '%s', but the %s is given already", word,
                       kinds[i].title);
    taken[i] = true;
    return BR_OK;
}

/* Whether a march of the scene begins with it. */
static enum br_status try_scene(const struct br_scene *scene, const struct br_method *method,
                                struct br_error *err)
{
    struct br_march *march = NULL;
    const enum br_status status = br_march_create(&march, scene, 4, 4, method, err);
    br_march_free(march);
    return status;
}

/* What is refused with each field alone and with all there is goes with no scene. */
static enum br_status check_somewhere(const struct br_method *m, struct br_error *err)
{
    const struct br_scene axial = {.length = 1,
                                   .duration = 1,
                                   .density = 1,
                                   .axial = {.modelled = true, .stiffness = 1, .viscosity = 1}};
    struct br_scene bending = axial, all = axial;
    bending.axial.modelled = false;
    bending.bending.modelled = all.bending.modelled = true;
    bending.bending.stiffness = all.bending.stiffness = 1;
    bending.bending.viscosity = all.bending.viscosity = 1;
    all.contact = (struct br_contact){.modelled = true, .stiffness = 1};
    all.friction = (struct br_friction){BR_TRESCA, 1, 1};
    struct br_error refusal = {0};
    const bool refused = try_scene(&axial, m, NULL) == BR_BAD_INPUT &&
                         try_scene(&bending, m, NULL) == BR_BAD_INPUT &&
                         try_scene(&all, m, &refusal) == BR_BAD_INPUT;
    return refused ? br_fail(err, BR_BAD_INPUT, "%.1000s", refusal.message) : BR_OK;
}

/* What no march would heed is refused. */
static enum br_status check(const struct br_method *m, const bool taken[KINDS],
                            struct br_error *err)
{
    if (taken[SCALING] && !br_linear_solver_heeds(m->solver, "--scaling"))
        return br_fail(err, BR_BAD_INPUT, "solver %s does not heed 'scaled'", m->solver->name);
    if (taken[REFINEMENT] && !br_linear_solver_heeds(m->solver, "--refinement"))
        return br_fail(err, BR_BAD_INPUT, "solver %s does not heed 'refined'", m->solver->name);
    const enum br_status status = br_method_check(m, err);
    return status ? status : check_somewhere(m, err);
}

bool br_contender_adaptive(const struct br_contender *contender)
{
    return contender->method.scheme->adaptive;
}

enum br_status br_contender_read(const char *name, struct br_contender *c, struct br_error *err)
{
    bool taken[KINDS] = {false};
    *c = (struct br_contender){.method = br_method_default()};
    if (strlen(name) >= sizeof c->name)
        return br_fail(err, BR_BAD_INPUT, "found '%s', expected at most %d letters", name,
                       BR_CONTENDER_NAME - 1);
    strcpy(c->name, name);
    enum br_status status = BR_OK;
    for (const char *rest = name; !status; rest++) {
        char word[WORD];
        const size_t length = strcspn(rest, "+");
        snprintf(word, sizeof word, "%.*s", (int)(length < WORD ? length : WORD - 1), rest);
        status = take_word(word, &c->method, taken, err);
        rest += length;
        if (!*rest)
            break;
    }
    if (!taken[CONTACT])
        c->method.contact = br_contact_rule_of(c->method.scheme);
    return status ? status : check(&c->method, taken, err);
}

/* ---- lists ---- */

static bool same_method(const struct br_method *a, const struct br_method *b)
{
    return a->scheme == b->scheme && a->solver == b->solver && a->contact == b->contact &&
           a->friction == b->friction && a->axial_degree == b->axial_degree &&
           strcmp(a->linear.scaling, b->linear.scaling) == 0 &&
           a->linear.refinement == b->linear.refinement;
}

static bool contains(const struct br_contenders *all, const struct br_contender *c)
{
    for (size_t i = 0; i < all->count; i++)
        if (same_method(&all->list[i].method, &c->method))
            return true;
    return false;
}

enum br_status br_contenders_read(const char *option, const char *text, struct br_contenders *all,
                                  struct br_error *err)
{
    all->count = 0;
    for (const char *rest = text;; rest++) {
        char name[2 * BR_CONTENDER_NAME];
        struct br_contender c;
        struct br_error inner = {0};
        const size_t length = strcspn(rest, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1),
                 rest);
        if (br_contender_read(name, &c, &inner))
            return br_fail(err, BR_BAD_INPUT, "%s: '%s': %s", option, name, inner.message);
        if (contains(all, &c))
            return br_fail(err, BR_BAD_INPUT, "%s: %s is given twice", option, name);
        if (all->count == BR_MOST_CONTENDERS)
            return br_fail(err, BR_BAD_INPUT, "%s: more than %d methods", option,
                           BR_MOST_CONTENDERS);
        all->list[all->count++] = c;
        rest += length;
        if (!*rest)
            return BR_OK;
    }
}

/* ---- the default ones ---- */

/* Adds the contender of that name, unless the scene or the list has no use for it. */
static void add(const struct br_scene *scene, struct br_contenders *all, const char *name)
{
    struct br_contender c;
    if (br_contender_read(name, &c, NULL) || contains(all, &c) ||
        all->count == BR_MOST_CONTENDERS || try_scene(scene, &c.method, NULL))
        return;
    all->list[all->count++] = c;
}

__attribute__((format(printf, 3, 4))) static void add_named(const struct br_scene *scene,
                                                            struct br_contenders *all,
                                                            const char *format, ...)
{
    char name[BR_CONTENDER_NAME];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    add(scene, all, name);
}

static void add_scheme(const struct br_scene *scene, const struct br_time_scheme *scheme,
                       struct br_contenders *all)
{
    if (!scene->contact.modelled || !scheme->may_lag) {
        add(scene, all, scheme->name);
        return;
    }
    for (const struct br_contact_rule *const *rule = br_contact_rules; *rule; rule++)
        add_named(scene, all, "%s+%s", scheme->name, (*rule)->name);
}

/* The first scheme of order two: what the other friction rules and solvers are held with. */
static const struct br_time_scheme *base_scheme(void)
{
    const struct br_time_scheme *const *scheme = br_time_schemes;
    while (scheme[1] && (*scheme)->order != 2)
        scheme++;
    return *scheme;
}

static void add_solvers(const struct br_scene *scene, const char *base, struct br_contenders *all)
{
    for (const struct br_linear_solver *const *s = &br_linear_solvers[1]; *s; s++) {
        add_named(scene, all, "%s+%s", base, (*s)->name);
        if (br_linear_solver_heeds(*s, "--scaling") && br_linear_solver_heeds(*s, "--refinement"))
            add_named(scene, all, "%s+%s+scaled+refined", base, (*s)->name);
    }
}

void br_contenders_default(const struct br_scene *scene, struct br_contenders *all)
{
    const struct br_time_scheme *base = base_scheme();
    all->count = 0;
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        add_scheme(scene, *s, all);
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        if (scene->axial.modelled && !(*s)->integrator && (*s == base || (*s)->order > 2))
            add_named(scene, all, "%s+p2", (*s)->name);
    for (size_t i = 1; br_friction_rules[i] && scene->friction.law != BR_FRICTIONLESS; i++)
        add_named(scene, all, "%s+%s", base->name, br_friction_rules[i]->name);
    add_solvers(scene, base->name, all);
}
