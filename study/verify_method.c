/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify_method.h"

#include <string.h>

#include "solver/method.h"
#include "study/number_list.h"

/* ---- one key each; false: the text is not what it takes ---- */

static bool read_scheme(struct br_method *m, const char *text)
{
    return (m->scheme = br_time_scheme_find(text)) != NULL;
}

static bool read_solver(struct br_method *m, const char *text)
{
    return (m->solver = br_linear_solver_find(text)) != NULL;
}

static bool read_contact(struct br_method *m, const char *text)
{
    return (m->contact = br_contact_rule_find(text)) != NULL;
}

static bool read_friction(struct br_method *m, const char *text)
{
    return (m->friction = br_friction_rule_find(text)) != NULL;
}

static bool read_tolerance(struct br_method *m, const char *text)
{
    const char *end = br_read_number(text, &m->tolerance);
    return end && !*end && m->tolerance > 0;
}

static bool read_axial_degree(struct br_method *m, const char *text)
{
    m->axial_degree = *text - '0';
    return strcmp(text, "1") == 0 || strcmp(text, "2") == 0;
}

static const char a_name[] = "a name that 'beamrate study --help' lists";

enum { SCHEME, SOLVER, CONTACT, FRICTION, TOLERANCE, AXIAL_DEGREE, KEYS };

static const struct {
    const char *name;
    bool (*read)(struct br_method *m, const char *text);
    const char *expected;
} keys[KEYS] = {
    [SCHEME] = {"scheme", read_scheme, a_name},
    [SOLVER] = {"solver", read_solver, a_name},
    [CONTACT] = {"contact", read_contact, a_name},
    [FRICTION] = {"friction", read_friction, a_name},
    [TOLERANCE] = {"tolerance", read_tolerance, "a number above 1e-14 and below 1, like 1e-6"},
    [AXIAL_DEGREE] = {"axial_degree", read_axial_degree, "1 or 2"},
};

enum br_status br_verify_method_read(const struct br_scene_reader *r, const char *key,
                                     const yaml_node_t *node, struct br_verify_method *m,
                                     bool *known)
{
    unsigned i = 0;
    while (i < KEYS && strcmp(key, keys[i].name) != 0)
        i++;
    *known = i < KEYS;
    if (!*known)
        return BR_OK;
    const size_t line = br_yaml_line(node);
    const char *text = br_yaml_text(node);
    if (m->given & 1u << i)
        return br_scene_refuse(r, line, key, "given twice");
    m->given |= 1u << i;
    if (!keys[i].read(&m->method, text))
        return br_scene_refuse(r, line, key, "found '%s', expected %s", text, keys[i].expected);
    return BR_OK;
}

enum br_status br_verify_method_end(struct br_verify_method *m, struct br_error *err)
{
    if (!(m->given & 1u << CONTACT))
        m->method.contact = br_contact_rule_of(m->method.scheme);
    if (m->given & 1u << TOLERANCE && !m->method.scheme->adaptive)
        return br_fail(err, BR_BAD_INPUT, "tolerance: time scheme '%s' does not heed it",
                       m->method.scheme->name);
    return br_method_check(&m->method, err);
}
