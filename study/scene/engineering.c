/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas of derived numbers, and cross-sections. Their sources: docs/scenes.md. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "study/scene/units.h"
#include "study/scene/value.h"

/* ---- formulas: long double throughout, rounded once ---- */

/* The two sources that a recipe names, the density and the length. */
enum { SOURCES = 4 };
typedef const struct br_scene_number *sources[SOURCES];

static long double area_of_section(sources of)
{
    return of[0]->value;
}

static long double inertia_of_section(sources of)
{
    return of[0]->second;
}

static long double product(sources of)
{
    return of[0]->value * of[1]->value;
}

/* A mode of (3) or (4) with stiffness a and viscosity tau a is q'' + tau omega^2 q' + omega^2 q,
 * so its damping ratio is tau omega/2 (Clough and Penzien, Dynamics of Structures, damping in
 * proportion to stiffness). of: damping ratio, stiffness, density, length. */
static long double relaxation_time(sources of, long double root, int power)
{
    const long double wave = powl(root / of[3]->value, power);
    const long double omega = wave * sqrtl(of[1]->value / of[2]->value);
    return isfinite(omega) && omega > 0 ? 2 * of[0]->value / omega : NAN;
}

/* Lowest modes, clamped at one end and free at the other: cos(root) = 0 of the rod, cos(root)
 * cosh(root) = -1 of the beam (Blevins, Formulas for Natural Frequency and Mode Shape, ch. 8). */
static long double axial_time(sources of)
{
    return relaxation_time(of, 1.570796326794896619231L, 1);
}

static long double bending_time(sources of)
{
    return relaxation_time(of, 1.875104068711961166445L, 2);
}

/* Each recipe comes after those that make its sources. first: given instead of `what`. Keys are
 * "section.name". most: of `first`; 0: any. Above it a unit or a % is missing. */
static const struct recipe {
    const char *what, *first, *second, *words;
    long double (*formula)(sources of);
    double most;
} recipes[] = {
    {"area", "section", "section", "that of the section", area_of_section, 0},
    {"inertia", "section", "section", "that of the section", inertia_of_section, 0},
    {"density", "mass_density", "area", "mass_density * area", product, 0},
    {"axial.stiffness", "young", "area", "young * area", product, 0},
    {"bending.stiffness", "young", "inertia", "young * inertia", product, 0},
    {"axial.relaxation_time", "axial.damping_ratio", "axial.stiffness", "2 damping_ratio/omega_1",
     axial_time, 1},
    {"bending.relaxation_time", "bending.damping_ratio", "bending.stiffness",
     "2 damping_ratio/omega_1", bending_time, 1},
    {"axial.viscosity", "axial.relaxation_time", "axial.stiffness", "relaxation_time * stiffness",
     product, 0},
    {"bending.viscosity", "bending.relaxation_time", "bending.stiffness",
     "relaxation_time * stiffness", product, 0},
    {"friction.coefficient", "friction.coefficient", "contact.stiffness",
     "coefficient * contact stiffness", product, 10},
};
enum { RECIPES = sizeof recipes / sizeof *recipes };
_Static_assert((int)RECIPES < (int)BR_MOST_DERIVED, "struct br_scene has no room");

/* ---- derivation ---- */

static bool section_is_given(const struct br_scene_given *g, const struct br_scene_key *key)
{
    return !*key->section || g->row[br_scene_row(key->section)].line;
}

static enum br_status refuse_two(const struct br_scene_reader *r, size_t row, size_t source)
{
    const struct br_scene_number *given = &r->given->row[row], *other = &r->given->row[source];
    char place[BR_PLACE];
    return br_scene_refuse(
        r, given->line, br_scene_keys[given->origin].name,
        "is given beside %s (%s%s), which makes %s, too, expected one of the two",
        br_scene_keys[other->origin].name, other->line > BR_LAST_LINE ? "" : "line ",
        br_yaml_place(&r->yaml, other->line, place), br_scene_keys[row].name);
}

/* Marks a source of a scene's number as used, and the number that the source was made from. */
static void use(struct br_scene_given *g, size_t row)
{
    g->row[row].used = true;
    g->row[g->row[row].origin].used = true;
}

static enum br_status make(const struct br_scene_reader *r, const struct recipe *p, size_t row,
                           const size_t source[2])
{
    const struct br_scene_key *key = &br_scene_keys[row];
    struct br_scene_number *number = r->given->row;
    const struct br_scene_number first = number[source[0]];
    const char *name = br_scene_keys[source[0]].name;
    if (p->most > 0 && !(first.value <= p->most))
        return br_scene_refuse(r, first.line, name,
                               "found %Lg without unit, expected at most %g: was %s forgotten?",
                               first.value, p->most, p->most > 1 ? key->unit : "%");
    const long double value =
        p->formula((sources){&number[source[0]], &number[source[1]],
                             &number[br_scene_row("density")], &number[br_scene_row("length")]});
    if (!isfinite((double)value) || (value != 0 && (double)value == 0))
        return br_scene_refuse(r, first.line, name,
                               "makes no number of %s, expected a stiffness and a density above 0 "
                               "for a damping, and no overflow",
                               key->name);
    number[row] =
        (struct br_scene_number){first.line, first.origin, source[0] == row, false, value, 0};
    if (key->need == BR_MAKES)
        return BR_OK;
    *(double *)((char *)r->scene + key->offset) = (double)value;
    use(r->given, source[0]);
    use(r->given, source[1]);
    return BR_OK;
}

/* Applies a recipe if all its sources are given. */
static enum br_status try(const struct br_scene_reader *r, const struct recipe *p)
{
    const struct br_scene_number *number = r->given->row;
    const size_t row = br_scene_row(p->what),
                 source[] = {br_scene_row(p->first), br_scene_row(p->second)};
    const bool itself = source[0] == row,
               mode = p->formula == axial_time || p->formula == bending_time;
    if (mode && !number[br_scene_row("density")].line)
        return BR_OK; /* check_row reports the missing density */
    if (!number[source[0]].line || !number[source[1]].line || (itself && !number[row].ratio) ||
        !section_is_given(r->given, &br_scene_keys[row]))
        return BR_OK;
    if (number[row].line && !itself)
        return refuse_two(r, row, source[0]);
    return make(r, p, row, source);
}

/* ---- missing and unused numbers ---- */

static enum br_status refuse_missing(const struct br_scene_reader *r, size_t row)
{
    const struct br_scene_key *key = &br_scene_keys[row];
    char made[200] = "";
    for (const struct recipe *p = recipes; p < recipes + RECIPES; p++)
        if (br_scene_row(p->what) == row)
            snprintf(made, sizeof made, "%s", p->words);
    const size_t line = *key->section ? r->given->row[br_scene_row(key->section)].line
                                      : br_yaml_line(yaml_document_get_root_node(r->yaml.document));
    return br_scene_refuse(r, line, key->name, "missing%s%s, expected %s, in %s, or %s to make it",
                           *key->section ? " in " : "", key->section, key->help, key->unit, made);
}

static enum br_status check_row(const struct br_scene_reader *r, size_t row)
{
    const struct br_scene_key *key = &br_scene_keys[row];
    const struct br_scene_number *n = &r->given->row[row];
    if (key->need == BR_OR_DERIVED && !n->line && section_is_given(r->given, key))
        return refuse_missing(r, row);
    if (key->need == BR_MAKES && n->line && n->origin == row && !n->used)
        return br_scene_refuse(r, n->line, key->name, "has no effect alone, expected with it: %s",
                               key->help);
    return BR_OK;
}

enum br_status br_scene_derive(const struct br_scene_reader *r)
{
    struct br_derived *derived = r->scene->derived;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < RECIPES && !status; i++)
        status = try(r, &recipes[i]);
    for (size_t row = 0; br_scene_keys[row].name && !status; row++)
        status = check_row(r, row);
    for (const struct recipe *p = recipes; p < recipes + RECIPES && !status; p++) {
        const size_t row = br_scene_row(p->what);
        const struct br_scene_key *key = &br_scene_keys[row];
        const struct br_scene_number *n = &r->given->row[row];
        const bool made = n->line && (n->origin != row || n->ratio);
        if (made && (n->used || key->need != BR_MAKES))
            *derived++ = (struct br_derived){p->what, p->words, key->unit, (double)n->value};
    }
    return status;
}

/* ---- cross-sections ---- */

/* Area and second moment of area for bending in the direction of w. a, b: width and height of a
 * rectangle, diameter and wall of a tube; b is 0 for a circle. The formulas of a tube avoid a
 * difference of powers: (D^4 - d^4)/64 = (D^2 - d^2)/4 (D^2 + d^2)/16, with D - d = 2 b. */
static void set_shape(struct br_scene_number *to, bool rectangle, long double a, long double b)
{
    const long double pi = 3.141592653589793238463L, inner = b > 0 ? a - 2 * b : 0;
    const long double area = rectangle ? a * b : b > 0 ? pi * b * (a - b) : pi * a * a / 4;
    to->value = area;
    to->second = rectangle ? area * b * b / 12 : area * (a * a + inner * inner) / 16;
}

enum br_status br_scene_read_shape(struct br_scene_value *v)
{
    static const char *const words[] = {"rectangle", "circle", "tube"};
    const char *text = br_yaml_text(v->node), *cross = strstr(text, " x ");
    const size_t length = strcspn(text, " ");
    struct br_si_number a, b = {0, 0};
    size_t shape = 0;
    char word[32], suggestion[BR_SUGGESTION] = "";
    snprintf(word, sizeof word, "%.*s", (int)(length < 31 ? length : 31), text);
    while (shape < 3 && strcmp(word, words[shape]) != 0)
        shape++;
    if (shape == 3)
        br_suggestion(word, words, 3, suggestion);
    if (shape == 3 || !text[length] || (shape == 1) == (cross != NULL))
        return BR_REFUSE_VALUE(v, "found '%s', expected %s%s", text, v->key->help, suggestion);
    v->unit = "m";
    enum br_status status = br_scene_read_quantity(v, text + length + 1, cross, &a);
    if (!status && cross)
        status = br_scene_read_quantity(v, cross + strlen(" x "), NULL, &b);
    if (status)
        return status;
    if (!(a.wide > 0 && (b.wide > 0 || shape == 1) && (shape != 2 || 2 * b.wide < a.wide)))
        return BR_REFUSE_VALUE(
            v,
            "found '%s', expected lengths above 0, and the wall of a tube below its "
            "radius",
            text);
    set_shape(&v->r->given->row[v->key - br_scene_keys], shape == 0, a.wide, b.wide);
    return BR_OK;
}
