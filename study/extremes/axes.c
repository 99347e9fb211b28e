/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/extremes/count.h"

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

static int trick_bin(const struct br_extreme_case *c)
{
    return (int)c->trick;
}

static bool trick_label(int bin, char *label, size_t size)
{
    if (bin < BR_TRICKS)
        snprintf(label, size, "%s", br_extreme_trick_name((enum br_extreme_trick)bin));
    return bin < BR_TRICKS;
}
static const struct br_extreme_axis trick = {"on purpose", trick_bin, trick_label};

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
         c->part[BR_BENDING].modelled ? c->part[BR_BENDING].load.size : NAN, -12, 6, 5)
BY_RANGE(viscosity, "c/(a T) of bending",
         c->part[BR_BENDING].modelled
             ? c->part[BR_BENDING].viscosity / c->part[BR_BENDING].stiffness / c->duration
             : NAN,
         -6, 3, 5)

const struct br_extreme_axis *const br_extreme_axes[] = {
    &scheme,  &solver,        &contact, &friction, &law,  &trick, &drawn, &elements,  &steps,
    &density, &stiff_contact, &bound,   &gap,      &beam, &span,  &load,  &viscosity, NULL};

/* ---- planes ---- */

static double contact_ratio(const struct br_extreme_case *c)
{
    const struct br_extreme_part *u = &c->part[BR_AXIAL];
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

static const struct br_extreme_part *main_part(const struct br_extreme_case *c)
{
    return &c->part[c->part[BR_BENDING].modelled ? BR_BENDING : BR_AXIAL];
}

static double inertia(const struct br_extreme_case *c)
{
    const double power = c->part[BR_BENDING].modelled ? 4 : 2;
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

static const struct br_extreme_coordinate
    contacts = {"c_H L/a_1", contact_ratio, -6, 18, 24},
    shortness = {"k/T", step_ratio, -6, 0, 12}, fineness = {"n", elements_of, 0, 6, 12},
    masses = {"ρL^4/(a_2T^2), or ρL^2/(a_1T^2)", inertia, -12, 12, 24},
    creeps = {"c/(a T)", relaxation, -9, 6, 15}, loads = {"load (N/m)", load_of, -12, 18, 30},
    stiffnesses = {"stiffness (N m^2 or N)", stiffness_of, -6, 12, 18};

const struct br_extreme_plane br_extreme_planes[BR_EXTREME_PLANES] = {
    {"Contact and time step", &contacts, &shortness},
    {"Mesh and time step", &fineness, &shortness},
    {"Inertia and viscosity", &masses, &creeps},
    {"Stiffness and load", &stiffnesses, &loads},
};
