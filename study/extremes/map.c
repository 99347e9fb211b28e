/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/map.h"

#include <ctype.h>
#include <errno.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "study/grid/each.h"

/* ---- cases ---- */

struct work {
    const struct br_extremes_job *job;
    struct br_extreme_map *map;
    br_extreme_judging_function *judge;
};

static enum br_status ask(const struct work *w, const struct br_extreme_case *one,
                          struct br_extreme_verdict *verdict, struct br_error *err)
{
    return w->judge(one, &(struct br_extreme_judging){.rounding = w->job->rounding}, verdict, err);
}

static enum br_status do_case(void *self, size_t i, struct br_error *err)
{
    const struct work *w = self;
    struct br_kept *kept = w->job->kept;
    struct br_extreme_case *one = &w->map->one[i];
    struct br_extreme_verdict *verdict = &w->map->verdict[i];
    char what[120], key[BR_SHA256_TEXT];
    br_extreme_draw(w->map->seed, i, one);
    if (!kept)
        return ask(w, one, verdict, err);
    snprintf(what, sizeof what, "case %zu of seed %llu, rounding %d", i,
             (unsigned long long)w->map->seed, w->job->rounding);
    br_kept_key(&kept->base, what, key);
    if (br_kept_read_into(kept, key, verdict, sizeof *verdict)) {
        atomic_fetch_add(&kept->taken, 1);
        return BR_OK;
    }
    const enum br_status status = ask(w, one, verdict, err);
    if (!status)
        br_kept_write(kept, key, verdict, sizeof *verdict);
    return status;
}

/* ---- a case that is wrong, made small while it stays wrong, so that a person can read it ---- */

/* A member of a case, or of both of its fields, that is set as in the plainest case. A number that
 * must differ from that is rounded to one digit. */
struct member {
    size_t offset, size;
    bool number;
};
#define MEMBER(type, member) offsetof(struct type, member), sizeof((struct type *)NULL)->member
static const struct member of_case[] = {
    {MEMBER(br_extreme_case, field[BR_AXIAL]), false},
    {MEMBER(br_extreme_case, field[BR_BENDING]), false},
    {MEMBER(br_extreme_case, contact), false},
    {MEMBER(br_extreme_case, law), false},
    {MEMBER(br_extreme_case, method.scheme), false},
    {MEMBER(br_extreme_case, method.solver), false},
    {MEMBER(br_extreme_case, method.friction), false},
    {MEMBER(br_extreme_case, method.contact), false},
    {MEMBER(br_extreme_case, method.axial_degree), false},
    {MEMBER(br_extreme_case, method.linear), false},
    {MEMBER(br_extreme_case, density), true},
    {MEMBER(br_extreme_case, gap), true},
    {MEMBER(br_extreme_case, contact_stiffness), true},
    {MEMBER(br_extreme_case, friction), true},
    {MEMBER(br_extreme_case, regularisation), true},
    {MEMBER(br_extreme_case, length), true},
    {MEMBER(br_extreme_case, duration), true},
};
static const struct member of_field[] = {
    {MEMBER(br_extreme_field, load.shape), false},
    {MEMBER(br_extreme_field, load.history), false},
    {MEMBER(br_extreme_field, tip_force.history), false},
    {MEMBER(br_extreme_field, tip_moment.history), false},
    {MEMBER(br_extreme_field, displacement.waved), false},
    {MEMBER(br_extreme_field, velocity.waved), false},
    {MEMBER(br_extreme_field, stiffness), true},
    {MEMBER(br_extreme_field, viscosity), true},
    {MEMBER(br_extreme_field, load.size), true},
    {MEMBER(br_extreme_field, load.rate), true},
    {MEMBER(br_extreme_field, tip_force.size), true},
    {MEMBER(br_extreme_field, tip_force.rate), true},
    {MEMBER(br_extreme_field, tip_moment.size), true},
    {MEMBER(br_extreme_field, tip_moment.rate), true},
    {MEMBER(br_extreme_field, displacement.size), true},
    {MEMBER(br_extreme_field, velocity.size), true},
};
enum { OF_CASE = sizeof of_case / sizeof *of_case, OF_FIELD = sizeof of_field / sizeof *of_field };
enum { HALVES = 3, MEMBERS = OF_CASE + 2 * OF_FIELD };

/* Halves the elements, the duration with the same time step, or the steps. */
static void halve(size_t what, struct br_extreme_case *c)
{
    if (what == 0)
        c->n = (c->n + 1) / 2;
    if (what == 1)
        c->duration *= (double)((c->steps + 1) / 2) / (double)c->steps;
    if (what > 0)
        c->steps = (c->steps + 1) / 2;
}

static double one_digit(double x)
{
    const double power = pow(10, floor(log10(fabs(x))));
    const double rounded = round(x / power) * power;
    return isfinite(rounded) && rounded != 0 ? rounded : x;
}

static void simplify(size_t i, bool to_a_digit, struct br_extreme_case *c)
{
    const struct br_extreme_case plain = {
        .length = 1, .duration = 1, .method = br_method_default()};
    const struct member *member = i < OF_CASE ? &of_case[i] : &of_field[(i - OF_CASE) % OF_FIELD];
    const size_t field = (i - OF_CASE) / OF_FIELD * sizeof *c->field;
    const size_t at =
        member->offset + (i < OF_CASE ? 0 : offsetof(struct br_extreme_case, field) + field);
    double *number = (double *)(void *)((char *)c + at);
    if (!to_a_digit)
        memcpy((char *)c + at, (const char *)&plain + at, member->size);
    else if (member->number)
        *number = one_digit(*number);
}

/* Makes the members agree with each other after a change. */
static void make_consistent(struct br_extreme_case *c)
{
    c->contact &= c->field[BR_AXIAL].modelled;
    if (!c->field[BR_BENDING].modelled || (c->law == BR_COULOMB && !c->contact))
        c->law = BR_FRICTIONLESS;
    if (c->law == BR_FRICTIONLESS || !c->field[BR_AXIAL].modelled)
        c->wanted = 0;
    if (!c->method.scheme->may_lag)
        c->method.contact = br_contact_rule_of(c->method.scheme);
}

enum { MOST_TRIALS = 300 };

struct shrinking {
    const struct work *work;
    struct br_extreme_shrunk *best;
    char text[BR_EXTREME_TEXT]; /* of the best: what does not change it is not tried */
    size_t tried;
    bool gained;
};

static enum br_status attempt(struct shrinking *s, const struct br_extreme_case *smaller,
                              struct br_error *err)
{
    struct br_extreme_verdict verdict;
    char text[BR_EXTREME_TEXT];
    br_extreme_scene(smaller, text);
    if (strcmp(text, s->text) == 0 || s->tried >= MOST_TRIALS)
        return BR_OK;
    s->tried++;
    if (br_observer_stops(s->work->job->observer))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    const enum br_status status = ask(s->work, smaller, &verdict, err);
    if (status || verdict.which != BR_EXTREME_WRONG)
        return status;
    s->best->one = *smaller;
    s->best->verdict = verdict;
    strcpy(s->text, text);
    s->gained = true;
    return BR_OK;
}

/* Tries each member plain, then all halves, then one digit. */
static enum br_status try_all(struct shrinking *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    s->gained = false;
    for (size_t i = 0; i < 2 * MEMBERS + HALVES && !status; i++) {
        struct br_extreme_case smaller = s->best->one;
        if (i < MEMBERS || i >= MEMBERS + HALVES)
            simplify(i < MEMBERS ? i : i - MEMBERS - HALVES, i >= MEMBERS, &smaller);
        else
            halve(i - MEMBERS, &smaller);
        make_consistent(&smaller);
        status = attempt(s, &smaller, err);
    }
    return status;
}

static enum br_status write_scene(const char *folder, struct br_extreme_shrunk *s, const char *text,
                                  struct br_error *err)
{
    char path[4096];
    snprintf(s->file, sizeof s->file, "wrong-%zu.yaml", s->one.index);
    br_extreme_command(&s->one, s->file, s->command);
    if (!folder)
        return BR_OK;
    snprintf(path, sizeof path, "%s/%s", folder, s->file);
    FILE *file = fopen(path, "w");
    const bool written =
        file && fprintf(file, "# Silently wrong: %s\n%s", s->verdict.why, text) > 0;
    if (!file || (fclose(file) != 0) | !written)
        return br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
    return BR_OK;
}

static enum br_status shrink(void *self, size_t i, struct br_error *err)
{
    const struct work *work = self;
    struct shrinking s = {.work = work, .best = &work->map->shrunk[i], .gained = true};
    enum br_status status = BR_OK;
    br_extreme_scene(&s.best->one, s.text);
    while (s.gained && !status && s.tried < MOST_TRIALS)
        status = try_all(&s, err);
    return status ? status : write_scene(work->job->folder, s.best, s.text, err);
}

/* ---- tallies ---- */

#define OF_CASE(type, id, expression)               \
    static type id(const struct br_extreme_case *c) \
    {                                               \
        return expression;                          \
    }

OF_CASE(const char *, scheme, c->method.scheme->name)
OF_CASE(const char *, solver, c->method.solver->name)
OF_CASE(const char *, contact, c->method.contact->name)
OF_CASE(const char *, friction, c->method.friction->name)
OF_CASE(const char *, law,
        c->law == BR_TRESCA    ? "Tresca"
        : c->law == BR_COULOMB ? "Coulomb"
                               : "none")
OF_CASE(const char *, special, br_extreme_specials[c->special])
OF_CASE(const char *, drawn, c->natural ? "groups without units" : "every number by itself")

static const struct kind {
    const char *title;
    const char *(*word)(const struct br_extreme_case *one);
} kinds[] = {
    {"time scheme", scheme},   {"linear solver", solver},
    {"contact rule", contact}, {"friction rule", friction},
    {"friction law", law},     {"on purpose", special},
    {"drawn", drawn},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static bool starts_number(const char *c, const char *text)
{
    const bool inside = c > text && (isalnum((unsigned char)c[-1]) || c[-1] == '_');
    return !inside && isdigit((unsigned char)c[*c == '-' || *c == '+']);
}

/* Replaces numbers by #, so that equal reasons of different cases have equal texts. */
static void generalise(const char *why, char text[150])
{
    size_t used = 0;
    for (const char *c = why; *c && used < 149;) {
        if (starts_number(c, why)) {
            text[used++] = '#';
            char *end;
            strtod(c, &end);
            c = end > c ? end : c + 1;
        } else {
            text[used++] = *c++;
        }
    }
    text[used] = '\0';
}

static int by_label(const void *a, const void *b)
{
    const struct br_extreme_tally *x = a, *y = b;
    return strcmp(x->label, y->label);
}

static int by_class_and_count(const void *a, const void *b)
{
    const struct br_extreme_tally *x = a, *y = b;
    for (int which = BR_EXTREME_CLASSES - 1; which >= 0; which--)
        if (x->count[which] != y->count[which])
            return x->count[which] < y->count[which] ? 1 : -1;
    return (x->first > y->first) - (x->first < y->first);
}

/* The tallies of one kind, or of the reasons (NULL), sorted. */
static struct br_extreme_tally *add_tallies(struct br_extreme_map *m, const struct kind *kind)
{
    struct br_extreme_tally *first = m->tally + m->tallies, *end = first;
    for (size_t i = 0; i < m->cases; i++) {
        struct br_extreme_tally *t = first;
        const enum br_extreme_class which = m->verdict[i].which;
        char label[sizeof t->label];
        if (kind)
            snprintf(label, sizeof label, "%s", kind->word(&m->one[i]));
        else
            generalise(m->verdict[i].why, label);
        while (t < end && (strcmp(t->label, label) != 0 || !(kind || t->count[which])))
            t++;
        if (t == end && !(kind || *label))
            continue; /* it is right */
        if (t == end) {
            *end++ = (struct br_extreme_tally){.title = kind ? kind->title : NULL, .first = i};
            memcpy(t->label, label, sizeof label);
        }
        t->cases++;
        t->count[which]++;
    }
    qsort(first, (size_t)(end - first), sizeof *first, kind ? by_label : by_class_and_count);
    m->tallies += (size_t)(end - first);
    return first;
}

/* ---- all ---- */

enum { CASES = 2000, SEED = 1 };

static enum br_status run(struct work *work, struct br_error *err)
{
    struct br_extreme_map *m = work->map;
    struct br_each each = {.count = m->cases,
                           .threads = work->job->threads,
                           .observer = work->job->observer,
                           .turn = do_case,
                           .self = work};
    const enum br_status status = br_each(&each, err);
    if (status)
        return status;
    for (size_t i = 0; i < m->cases; i++) {
        m->count[m->verdict[i].which]++;
        if (m->verdict[i].which == BR_EXTREME_WRONG && m->shrunks < BR_EXTREME_MOST_SHRUNK)
            m->shrunk[m->shrunks++] =
                (struct br_extreme_shrunk){.one = m->one[i], .verdict = m->verdict[i]};
    }
    m->tallies = 1;
    m->tally[0] = (struct br_extreme_tally){.title = "all", .cases = m->cases};
    memcpy(m->tally[0].count, m->count, sizeof m->count);
    for (size_t i = 0; i < KINDS; i++)
        add_tallies(m, &kinds[i]);
    const size_t kinds_of = m->tallies;
    m->reason = add_tallies(m, NULL);
    m->reasons = m->tallies - kinds_of;
    m->tallies = kinds_of;
    each = (struct br_each){
        .count = m->shrunks, .threads = each.threads, .turn = shrink, .self = work};
    return br_each(&each, err);
}

enum br_status br_extreme_map_run(struct br_extreme_map *map, const struct br_extremes_job *job,
                                  br_extreme_judging_function *judge, struct br_error *err)
{
    *map = (struct br_extreme_map){.seed = job->seed ? job->seed : SEED,
                                   .cases = job->cases ? job->cases : CASES};
    struct work work = {job, map, judge};
    map->one = br_allocate(map->cases, sizeof *map->one);
    map->verdict = br_allocate(map->cases, sizeof *map->verdict);
    map->shrunk = br_allocate(BR_EXTREME_MOST_SHRUNK, sizeof *map->shrunk);
    map->tally = br_allocate(1 + (KINDS + 1) * map->cases, sizeof *map->tally);
    const bool full = map->one && map->verdict && map->shrunk && map->tally;
    return full ? run(&work, err) : br_no_memory(err, "the map");
}

void br_extreme_map_clear(struct br_extreme_map *map)
{
    free(map->one);
    free(map->verdict);
    free(map->shrunk);
    free(map->tally);
    *map = (struct br_extreme_map){0};
}

/* ---- rates ---- */

struct br_extreme_rate br_extreme_rate(const struct br_extreme_map *m)
{
    struct br_extreme_rate r = {.wrong = m->count[BR_EXTREME_WRONG]};
    for (size_t i = 0; i < m->cases; i++) {
        const enum br_extreme_class which = m->verdict[i].which;
        if (which == BR_EXTREME_REFUSED || which == BR_EXTREME_UNJUDGED)
            continue;
        r.answers++;
        r.unstated += !m->verdict[i].known;
        r.unstated_unstable += !m->verdict[i].known && which == BR_EXTREME_UNSTABLE;
    }
    const double x = (double)r.wrong, rest = (double)(r.answers - r.wrong);
    r.low = x > 0 ? gsl_cdf_beta_Pinv(0.025, x, rest + 1) : 0;
    r.high = rest > 0 ? gsl_cdf_beta_Pinv(0.975, x + 1, rest) : 1;
    return r;
}

/* ---- planes ---- */

/* The field of the beam, or of the rod if there is no beam. */
static const struct br_extreme_field *main_field(const struct br_extreme_case *c)
{
    return &c->field[c->field[BR_BENDING].modelled ? BR_BENDING : BR_AXIAL];
}

static double inertia(const struct br_extreme_case *c)
{
    const double power = c->field[BR_BENDING].modelled ? 4 : 2;
    return c->density * pow(c->length, power) / main_field(c)->stiffness / pow(c->duration, 2);
}

OF_CASE(double, relaxation, main_field(c)->viscosity / main_field(c)->stiffness / c->duration)
OF_CASE(double, contact_ratio,
        c->contact ? c->contact_stiffness * c->length / c->field[BR_AXIAL].stiffness : NAN)
OF_CASE(double, step_ratio, 1 / (double)c->steps)
OF_CASE(double, elements, (double)c->n)
OF_CASE(double, load, fabs(main_field(c)->load.size))
OF_CASE(double, stiffness, main_field(c)->stiffness)

const struct br_extreme_plane br_extreme_planes[BR_EXTREME_PLANES] = {
    {"Contact and time step",
     {"c_H L/a_1", contact_ratio, -6, 18, 24},
     {"k/T", step_ratio, -6, 0, 12}},
    {"Mesh and time step", {"n", elements, 0, 6, 12}, {"k/T", step_ratio, -6, 0, 12}},
    {"Inertia and viscosity",
     {"ρL^4/(a_2T^2), or ρL^2/(a_1T^2)", inertia, -12, 12, 24},
     {"c/(a T)", relaxation, -9, 6, 15}},
    {"Stiffness and load",
     {"stiffness (N m^2 or N)", stiffness, -6, 12, 18},
     {"load (N/m)", load, -12, 18, 30}},
};

/* The cell along one coordinate; -1: not in the plane. */
static int cell_index(const struct br_extreme_coordinate *c, const struct br_extreme_case *one)
{
    const double decade = log10(c->value(one));
    if (!isfinite(decade))
        return -1;
    const double cell = floor((decade - c->low) / (c->high - c->low) * (double)c->cells);
    return (int)fmax(0, fmin(cell, (double)c->cells - 1));
}

void br_extreme_plane_fill(const struct br_extreme_map *m, const struct br_extreme_plane *p,
                           double *cell)
{
    for (size_t at = 0; at < p->x.cells * p->y.cells; at++) {
        size_t count[BR_EXTREME_CLASSES] = {0}, most = 0;
        for (size_t i = 0; i < m->cases; i++)
            if (cell_index(&p->y, &m->one[i]) == (int)(at / p->x.cells) &&
                cell_index(&p->x, &m->one[i]) == (int)(at % p->x.cells))
                count[m->verdict[i].which]++;
        for (size_t which = 1; which < BR_EXTREME_CLASSES; which++)
            most = count[which] > count[most] ? which : most;
        cell[at] = count[BR_EXTREME_WRONG] ? BR_EXTREME_WRONG : count[most] ? (double)most : NAN;
    }
}
