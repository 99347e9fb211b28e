/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/count.h"

#include <ctype.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- rows of registries ---- */

#define BY_REGISTRY(id, text, registry, member)               \
    static int id##_bin(const struct br_extreme_case *c)      \
    {                                                         \
        for (int i = 0; registry[i]; i++)                     \
            if (registry[i] == c->method.member)              \
                return i;                                     \
        return -1;                                            \
    }                                                         \
    static bool id##_label(int bin, char *label, size_t size) \
    {                                                         \
        if (registry[bin])                                    \
            snprintf(label, size, "%s", registry[bin]->name); \
        return registry[bin] != NULL;                         \
    }                                                         \
    static const struct br_extreme_axis id = {text, id##_bin, id##_label};

BY_REGISTRY(scheme, "time scheme", br_time_schemes, scheme)
BY_REGISTRY(solver, "linear solver", br_linear_solvers, solver)
BY_REGISTRY(contact, "contact rule", br_contact_rules, contact)
BY_REGISTRY(friction, "friction rule", br_friction_rules, friction)

/* ---- words ---- */

static bool word(const char *const *words, int count, int bin, char *label, size_t size)
{
    if (bin >= count)
        return false;
    snprintf(label, size, "%s", words[bin]);
    return true;
}

static int law_bin(const struct br_extreme_case *c)
{
    return (int)c->law;
}

static bool law_label(int bin, char *label, size_t size)
{
    static const char *const words[] = {"none", "Tresca", "Coulomb"};
    return word(words, 3, bin, label, size);
}
static const struct br_extreme_axis law = {"friction law", law_bin, law_label};

static int special_bin(const struct br_extreme_case *c)
{
    return (int)c->special;
}

static bool special_label(int bin, char *label, size_t size)
{
    if (bin < BR_SPECIALS)
        snprintf(label, size, "%s", br_extreme_special_name((enum br_extreme_special)bin));
    return bin < BR_SPECIALS;
}
static const struct br_extreme_axis special = {"on purpose", special_bin, special_label};

static int drawn_bin(const struct br_extreme_case *c)
{
    return c->natural ? 0 : 1;
}

static bool drawn_label(int bin, char *label, size_t size)
{
    static const char *const words[] = {"groups without units", "every number by itself"};
    return word(words, 2, bin, label, size);
}
static const struct br_extreme_axis drawn = {"drawn", drawn_bin, drawn_label};

/* ---- ranges ---- */

/* Decades apart, from `first` on; bin 0: zero. */
struct range {
    double first, decades;
    int count;
};

static int range_bin(const struct range *r, double value)
{
    if (value == 0)
        return 0;
    const double place = floor((log10(fabs(value)) - r->first) / r->decades);
    return isnan(place) ? -1 : 1 + (int)fmax(0, fmin(place, r->count - 1));
}

static bool range_label(const struct range *r, int bin, char *label, size_t size)
{
    if (bin > r->count)
        return false;
    const double low = pow(10, r->first + r->decades * (bin - 1));
    const double high = low * pow(10, r->decades);
    if (bin == 0)
        snprintf(label, size, "0");
    else if (bin == 1)
        snprintf(label, size, "below %g", high);
    else if (bin == r->count)
        snprintf(label, size, "%g and above", low);
    else
        snprintf(label, size, "%g to %g", low, high);
    return true;
}

#define BY_RANGE(id, text, expression, from, step, bins)       \
    static const struct range id##_range = {from, step, bins}; \
    static int id##_bin(const struct br_extreme_case *c)       \
    {                                                          \
        return range_bin(&id##_range, expression);             \
    }                                                          \
    static bool id##_label(int bin, char *label, size_t size)  \
    {                                                          \
        return range_label(&id##_range, bin, label, size);     \
    }                                                          \
    static const struct br_extreme_axis id = {text, id##_bin, id##_label};

BY_RANGE(elements, "n", (double)c->n, 0, 1, 6)
BY_RANGE(steps, "steps", (double)c->steps, 0, 1, 6)
BY_RANGE(density, "rho, kg/m", c->density, -9, 3, 7)
BY_RANGE(stiff_contact, "c_H, N/m", c->contact ? c->contact_stiffness : NAN, -6, 3, 8)
BY_RANGE(bound, "c_V, N or N/m", c->law == BR_FRICTIONLESS ? NAN : c->friction, -6, 3, 8)
BY_RANGE(gap, "gap, m", c->contact ? c->gap : NAN, -15, 5, 5)
BY_RANGE(beam, "L, m", c->length, -6, 3, 5)
BY_RANGE(span, "T, s", c->duration, -6, 3, 5)
BY_RANGE(load, "bending load, N/m",
         c->field[BR_BENDING].modelled ? c->field[BR_BENDING].load.size : NAN, -12, 6, 5)
BY_RANGE(viscosity, "c/(a T) of bending",
         c->field[BR_BENDING].modelled
             ? c->field[BR_BENDING].viscosity / c->field[BR_BENDING].stiffness / c->duration
             : NAN,
         -6, 3, 5)

const struct br_extreme_axis *const br_extreme_axes[] = {
    &scheme,  &solver,        &contact, &friction, &law,  &special, &drawn, &elements,  &steps,
    &density, &stiff_contact, &bound,   &gap,      &beam, &span,    &load,  &viscosity, NULL};

/* ---- planes ---- */

static double contact_ratio(const struct br_extreme_case *c)
{
    const struct br_extreme_field *u = &c->field[BR_AXIAL];
    return c->contact ? c->contact_stiffness * c->length / u->stiffness : NAN;
}

static double step_ratio(const struct br_extreme_case *c)
{
    return 1 / (double)c->steps;
}

static double elements_of(const struct br_extreme_case *c)
{
    return (double)c->n;
}

static const struct br_extreme_field *main_part(const struct br_extreme_case *c)
{
    return &c->field[c->field[BR_BENDING].modelled ? BR_BENDING : BR_AXIAL];
}

static double inertia(const struct br_extreme_case *c)
{
    const double power = c->field[BR_BENDING].modelled ? 4 : 2;
    return c->density * pow(c->length, power) / main_part(c)->stiffness / pow(c->duration, 2);
}

static double relaxation(const struct br_extreme_case *c)
{
    return main_part(c)->viscosity / main_part(c)->stiffness / c->duration;
}

static double load_of(const struct br_extreme_case *c)
{
    return fabs(main_part(c)->load.size);
}

static double stiffness_of(const struct br_extreme_case *c)
{
    return main_part(c)->stiffness;
}

static const struct br_extreme_coordinate contacts = {"c_H L/a_1", contact_ratio, -6, 18, 24},
                                          shortness = {"k/T", step_ratio, -6, 0, 12},
                                          fineness = {"n", elements_of, 0, 6, 12},
                                          masses = {"ρL^4/(a_2T^2), or ρL^2/(a_1T^2)", inertia, -12,
                                                    12, 24},
                                          creeps = {"c/(a T)", relaxation, -9, 6, 15},
                                          loads = {"load (N/m)", load_of, -12, 18, 30},
                                          stiffnesses = {"stiffness (N m^2 or N)", stiffness_of, -6,
                                                         12, 18};

const struct br_extreme_plane br_extreme_planes[BR_EXTREME_PLANES] = {
    {"Contact and time step", &contacts, &shortness},
    {"Mesh and time step", &fineness, &shortness},
    {"Inertia and viscosity", &masses, &creeps},
    {"Stiffness and load", &stiffnesses, &loads},
};

/* ---- tallies ---- */

static void tally(const struct br_extreme_map *m, struct br_extreme_tally *t, int bin)
{
    for (size_t i = 0; i < m->cases; i++)
        if (!t->axis || t->axis->bin(&m->one[i]) == bin) {
            t->cases++;
            t->count[m->verdict[i].which]++;
        }
}

/* Fills the list, or counts what there is where it is NULL. */
static size_t list_tallies(const struct br_extreme_map *m, struct br_extreme_tally *list)
{
    struct br_extreme_tally t = {.label = "all"};
    size_t count = 0;
    tally(m, &t, 0);
    if (list)
        list[count] = t;
    count++;
    for (const struct br_extreme_axis *const *a = br_extreme_axes; *a; a++)
        for (int bin = 0;; bin++) {
            t = (struct br_extreme_tally){.axis = *a};
            if (!(*a)->label(bin, t.label, sizeof t.label))
                break;
            tally(m, &t, bin);
            if (list && t.cases)
                list[count] = t;
            count += t.cases > 0;
        }
    return count;
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

static void add_reason(struct br_extreme_counts *counts, const struct br_extreme_verdict *v,
                       size_t index)
{
    struct br_extreme_reason found = {.which = v->which, .cases = 1, .first = index};
    generalise(v->why, found.text);
    for (size_t i = 0; i < counts->reasons; i++) {
        struct br_extreme_reason *r = &counts->reason[i];
        if (r->which == found.which && strcmp(r->text, found.text) == 0) {
            r->cases++;
            return;
        }
    }
    counts->reason[counts->reasons++] = found;
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

enum br_status br_extreme_count(const struct br_extreme_map *m, struct br_extreme_counts *counts,
                                struct br_error *err)
{
    *counts = (struct br_extreme_counts){.tallies = list_tallies(m, NULL)};
    counts->tally = br_allocate(counts->tallies, sizeof *counts->tally);
    counts->reason = br_allocate(m->cases, sizeof *counts->reason);
    if (!counts->tally || !counts->reason)
        return br_no_memory(err, "the map's counts");
    list_tallies(m, counts->tally);
    for (size_t i = 0; i < m->cases; i++)
        if (*m->verdict[i].why)
            add_reason(counts, &m->verdict[i], i);
    qsort(counts->reason, counts->reasons, sizeof *counts->reason, by_class_and_count);
    return BR_OK;
}

void br_extreme_counts_clear(struct br_extreme_counts *counts)
{
    free(counts->tally);
    free(counts->reason);
    *counts = (struct br_extreme_counts){0};
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
        if (place(p->x, &m->one[i]) == x && place(p->y, &m->one[i]) == y)
            count[m->verdict[i].which]++;
    for (int which = 0; which < BR_EXTREME_CLASSES; which++)
        if (count[which] && (isnan(most) || count[which] > count[(int)most]))
            most = which;
    return count[BR_EXTREME_WRONG] ? BR_EXTREME_WRONG : most;
}

void br_extreme_plane_fill(const struct br_extreme_map *m, const struct br_extreme_plane *p,
                           double *cell)
{
    for (size_t y = 0; y < p->y->cells; y++)
        for (size_t x = 0; x < p->x->cells; x++)
            cell[y * p->x->cells + x] = cell_class(m, p, (int)x, (int)y);
}
