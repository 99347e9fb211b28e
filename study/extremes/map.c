/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/map.h"

#include <ctype.h>
#include <errno.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/grid/each.h"

/* ---- cases ---- */

struct work {
    const struct br_extreme_request *request;
    struct br_extreme_map *map;
};

static enum br_status ask(const struct br_extreme_request *w, const struct br_extreme_case *one,
                          struct br_extreme_verdict *verdict, struct br_error *err)
{
    return (w->judge ? w->judge : br_extreme_judge)(one, &w->judging, verdict, err);
}

static enum br_status do_case(void *self, size_t i, struct br_error *err)
{
    const struct work *work = self;
    const struct br_extreme_request *w = work->request;
    struct br_extreme_verdict *verdict = &work->map->verdict[i];
    char what[120], key[BR_SHA256_TEXT];
    br_extreme_draw(w->seed, i, &work->map->one[i]);
    if (!w->kept)
        return ask(w, &work->map->one[i], verdict, err);
    snprintf(what, sizeof what, "case %zu of seed %llu, rounding %d, quick %d, boast %g", i,
             (unsigned long long)w->seed, w->judging.rounding, w->judging.quick, w->judging.boast);
    br_kept_key(&w->kept->base, what, key);
    if (br_kept_read_into(w->kept, key, verdict, sizeof *verdict)) {
        atomic_fetch_add(&w->kept->taken, 1);
        return BR_OK;
    }
    const enum br_status status = ask(w, &work->map->one[i], verdict, err);
    if (!status)
        br_kept_write(w->kept, key, verdict, sizeof *verdict);
    return status;
}

/* ---- a case that is wrong, made small while it stays wrong, so that a person can read it ---- */

enum change {
    DROP_AXIAL,
    DROP_BENDING,
    DROP_CONTACT,
    DROP_FRICTION,
    USUAL_SCHEME,
    USUAL_SOLVER,
    USUAL_LAWS,
    USUAL_REST,
    PLAIN_FORCES,
    HALF_ELEMENTS,
    HALF_DURATION, /* with the step kept */
    HALF_STEPS,    /* with the duration kept */
    CHANGES
};

static void plain_forces(struct br_extreme_field *p)
{
    p->load.shape = BR_SHAPE_FLAT;
    p->load.history = p->tip_force.history = p->tip_moment.history = BR_HISTORY_SUDDEN;
    p->displacement.waved = p->velocity.waved = false;
}

static void make(enum change change, struct br_extreme_case *c)
{
    switch (change) {
    case DROP_AXIAL:
        c->field[BR_AXIAL] = (struct br_extreme_field){0};
        c->contact = false;
        break;
    case DROP_BENDING:
        c->field[BR_BENDING] = (struct br_extreme_field){0};
        c->law = BR_FRICTIONLESS;
        break;
    case DROP_CONTACT:
        c->contact = false;
        break;
    case DROP_FRICTION:
        c->law = BR_FRICTIONLESS;
        break;
    case USUAL_SCHEME:
        c->method.scheme = br_time_schemes[0];
        break;
    case USUAL_SOLVER:
        c->method.solver = br_linear_solvers[0];
        break;
    case USUAL_LAWS:
        c->method.friction = br_friction_rules[0];
        c->method.contact = br_contact_rule_of(c->method.scheme);
        break;
    case USUAL_REST:
        c->method.axial_degree = 1;
        c->method.linear = br_linear_defaults;
        break;
    case PLAIN_FORCES:
        plain_forces(&c->field[BR_AXIAL]);
        plain_forces(&c->field[BR_BENDING]);
        break;
    case HALF_ELEMENTS:
        c->n = (c->n + 1) / 2;
        break;
    case HALF_DURATION:
        c->duration *= (double)((c->steps + 1) / 2) / (double)c->steps;
        c->steps = (c->steps + 1) / 2;
        break;
    case HALF_STEPS:
        c->steps = (c->steps + 1) / 2;
        break;
    case CHANGES:
        break;
    }
    if (c->law == BR_COULOMB && !c->contact)
        c->law = BR_FRICTIONLESS;
    if (c->law == BR_FRICTIONLESS || !c->field[BR_AXIAL].modelled)
        c->wanted = 0;
}

enum { FIELD_NUMBERS = 10, NUMBERS = 27, NOT_ZERO = 25 }; /* from this one on none may be 0 */

static double *number_of(struct br_extreme_case *c, size_t i)
{
    struct br_extreme_field *p = &c->field[i < FIELD_NUMBERS ? BR_AXIAL : BR_BENDING];
    double *const numbers[] = {
        &p->stiffness,         &p->viscosity,         &p->load.size,      &p->tip_force.size,
        &p->tip_moment.size,   &p->displacement.size, &p->velocity.size,  &p->load.rate,
        &p->tip_force.rate,    &p->tip_moment.rate,   &c->density,        &c->gap,
        &c->contact_stiffness, &c->friction,          &c->regularisation, &c->length,
        &c->duration,
    };
    return numbers[i < FIELD_NUMBERS ? i : i - FIELD_NUMBERS];
}

static double one_digit(double x)
{
    const double power = pow(10, floor(log10(fabs(x))));
    const double rounded = round(x / power) * power;
    return isfinite(rounded) && rounded != 0 ? rounded : x;
}

enum { MOST_QUESTIONS = 300 };

struct shrinking {
    const struct br_extreme_request *request;
    struct br_extreme_shrunk *best;
    char text[BR_EXTREME_TEXT]; /* of the best: what does not change it is not tried */
    size_t asked;
    bool gained;
};

static enum br_status attempt(struct shrinking *s, const struct br_extreme_case *smaller,
                              struct br_error *err)
{
    const struct br_observer *o = s->request->observer;
    struct br_extreme_verdict verdict;
    char text[BR_EXTREME_TEXT];
    br_extreme_scene(smaller, text);
    if (strcmp(text, s->text) == 0 || s->asked >= MOST_QUESTIONS)
        return BR_OK;
    s->asked++;
    if (o && o->stop && o->stop(o->self))
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    const enum br_status status = ask(s->request, smaller, &verdict, err);
    if (status || verdict.which != BR_EXTREME_WRONG)
        return status;
    s->best->one = *smaller;
    s->best->verdict = verdict;
    strcpy(s->text, text);
    s->gained = true;
    return BR_OK;
}

/* All changes, then each number becomes 0, or 1, or has one digit left. */
static enum br_status try_all(struct shrinking *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    s->gained = false;
    for (int change = 0; change < CHANGES && !status; change++) {
        struct br_extreme_case smaller = s->best->one;
        make((enum change)change, &smaller);
        status = attempt(s, &smaller, err);
    }
    for (size_t i = 0; i < 2 * NUMBERS && !status; i++) {
        struct br_extreme_case smaller = s->best->one;
        double *number = number_of(&smaller, i / 2);
        *number = i % 2 ? one_digit(*number) : i / 2 < NOT_ZERO ? 0 : 1;
        status = attempt(s, &smaller, err);
    }
    return status;
}

static enum br_status write_scene(const struct br_extreme_request *w, struct br_extreme_shrunk *s,
                                  const char *text, struct br_error *err)
{
    char path[4096];
    snprintf(s->file, sizeof s->file, "wrong-%zu.yaml", s->one.index);
    br_extreme_command(&s->one, s->file, s->command);
    if (!w->folder)
        return BR_OK;
    snprintf(path, sizeof path, "%s/%s", w->folder, s->file);
    FILE *file = fopen(path, "w");
    if (!file)
        return br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
    fprintf(file, "# Silently wrong: %s\n%s", s->verdict.why, text);
    const bool failed = ferror(file) != 0;
    return fclose(file) == 0 && !failed ? BR_OK
                                        : br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
}

static enum br_status shrink(void *self, size_t i, struct br_error *err)
{
    const struct work *work = self;
    struct shrinking s = {.request = work->request, .best = &work->map->shrunk[i], .gained = true};
    enum br_status status = BR_OK;
    br_extreme_scene(&s.best->one, s.text);
    while (s.gained && !status && s.asked < MOST_QUESTIONS)
        status = try_all(&s, err);
    return status ? status : write_scene(work->request, s.best, s.text, err);
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

static int by_label(const void *a, const void *b)
{
    const struct br_extreme_tally *x = a, *y = b;
    return strcmp(x->label, y->label);
}

/* The tallies of one kind, sorted. */
static void add_tallies(struct br_extreme_map *m, const struct kind *kind)
{
    struct br_extreme_tally *first = m->tally + m->tallies, *end = first;
    for (size_t i = 0; i < m->cases; i++) {
        struct br_extreme_tally *t = first;
        const char *label = kind->word(&m->one[i]);
        while (t < end && strcmp(t->label, label) != 0)
            t++;
        if (t == end)
            *end++ = (struct br_extreme_tally){.title = kind->title, .label = label};
        t->cases++;
        t->count[m->verdict[i].which]++;
    }
    qsort(first, (size_t)(end - first), sizeof *first, by_label);
    m->tallies += (size_t)(end - first);
}

/* ---- reasons ---- */

static bool starts_number(const char *c, const char *text)
{
    const bool inside = c > text && (isalnum((unsigned char)c[-1]) || c[-1] == '_');
    return !inside && isdigit((unsigned char)c[*c == '-' || *c == '+']);
}

/* Numbers become #, so that reasons of different cases are alike; what follows a colon of a place
 * in a scene stays. */
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

static void add_reason(struct br_extreme_map *m, size_t index)
{
    const struct br_extreme_verdict *v = &m->verdict[index];
    struct br_extreme_reason found = {.which = v->which, .cases = 1, .first = index};
    generalise(v->why, found.text);
    for (size_t i = 0; i < m->reasons; i++) {
        struct br_extreme_reason *r = &m->reason[i];
        if (r->which == found.which && strcmp(r->text, found.text) == 0) {
            r->cases++;
            return;
        }
    }
    m->reason[m->reasons++] = found;
}

static int by_class_and_count(const void *a, const void *b)
{
    const struct br_extreme_reason *x = a, *y = b;
    if (x->which != y->which)
        return x->which > y->which ? -1 : 1;
    if (x->cases != y->cases)
        return x->cases < y->cases ? 1 : -1;
    return (x->first > y->first) - (x->first < y->first);
}

/* ---- all ---- */

static enum br_status run(struct work *work, struct br_error *err)
{
    struct br_extreme_map *m = work->map;
    struct br_each each = {.count = m->cases,
                           .threads = work->request->threads,
                           .observer = work->request->observer,
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
    for (size_t i = 0; i < m->cases; i++)
        if (*m->verdict[i].why)
            add_reason(m, i);
    qsort(m->reason, m->reasons, sizeof *m->reason, by_class_and_count);
    each = (struct br_each){
        .count = m->shrunks, .threads = each.threads, .turn = shrink, .self = work};
    return br_each(&each, err);
}

enum br_status br_extreme_map_run(const struct br_extreme_request *request,
                                  struct br_extreme_map *map, struct br_error *err)
{
    *map = (struct br_extreme_map){.seed = request->seed, .cases = request->cases};
    struct work work = {.request = request, .map = map};
    map->one = br_allocate(request->cases, sizeof *map->one);
    map->verdict = br_allocate(request->cases, sizeof *map->verdict);
    map->shrunk = br_allocate(BR_EXTREME_MOST_SHRUNK, sizeof *map->shrunk);
    map->tally = br_allocate(1 + KINDS * request->cases, sizeof *map->tally);
    map->reason = br_allocate(request->cases, sizeof *map->reason);
    const bool full = map->one && map->verdict && map->shrunk && map->tally && map->reason;
    return full ? run(&work, err) : br_no_memory(err, "the map");
}

void br_extreme_map_clear(struct br_extreme_map *map)
{
    free(map->one);
    free(map->verdict);
    free(map->shrunk);
    free(map->tally);
    free(map->reason);
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

/* The beam, or a rod alone. */
static const struct br_extreme_field *main_part(const struct br_extreme_case *c)
{
    return &c->field[c->field[BR_BENDING].modelled ? BR_BENDING : BR_AXIAL];
}

static double inertia(const struct br_extreme_case *c)
{
    const double power = c->field[BR_BENDING].modelled ? 4 : 2;
    return c->density * pow(c->length, power) / main_part(c)->stiffness / pow(c->duration, 2);
}

OF_CASE(double, relaxation, main_part(c)->viscosity / main_part(c)->stiffness / c->duration)
OF_CASE(double, contact_ratio,
        c->contact ? c->contact_stiffness * c->length / c->field[BR_AXIAL].stiffness : NAN)
OF_CASE(double, step_ratio, 1 / (double)c->steps)
OF_CASE(double, elements, (double)c->n)
OF_CASE(double, load, fabs(main_part(c)->load.size))
OF_CASE(double, stiffness, main_part(c)->stiffness)

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
static int place(const struct br_extreme_coordinate *c, const struct br_extreme_case *one)
{
    const double decade = log10(c->value(one));
    if (!isfinite(decade))
        return -1;
    const double cell = floor((decade - c->low) / (c->high - c->low) * (double)c->cells);
    return (int)fmax(0, fmin(cell, (double)c->cells - 1));
}

static double cell_class(const struct br_extreme_map *m, const struct br_extreme_plane *p, int x,
                         int y)
{
    size_t count[BR_EXTREME_CLASSES] = {0};
    double most = NAN;
    for (size_t i = 0; i < m->cases; i++)
        if (place(&p->x, &m->one[i]) == x && place(&p->y, &m->one[i]) == y)
            count[m->verdict[i].which]++;
    for (int which = 0; which < BR_EXTREME_CLASSES; which++)
        if (count[which] && (isnan(most) || count[which] > count[(int)most]))
            most = which;
    return count[BR_EXTREME_WRONG] ? BR_EXTREME_WRONG : most;
}

void br_extreme_plane_fill(const struct br_extreme_map *m, const struct br_extreme_plane *p,
                           double *cell)
{
    for (size_t y = 0; y < p->y.cells; y++)
        for (size_t x = 0; x < p->x.cells; x++)
            cell[y * p->x.cells + x] = cell_class(m, p, (int)x, (int)y);
}
