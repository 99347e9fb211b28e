/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify/verify_method.h"

#include <stdlib.h>
#include <string.h>

#include "solver/method.h"
#include "study/scene/number_list.h"

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

static bool read_scaling(struct br_method *m, const char *text)
{
    static const char *const names[] = {"none", "sum", "max"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(names[i], text) == 0) {
            m->linear.scaling = names[i];
            return true;
        }
    return false;
}

static bool read_refinement(struct br_method *m, const char *text)
{
    m->linear.refinement = atoi(text);
    const size_t digits = strspn(text, "0123456789");
    return digits > 0 && digits <= 3 && !text[digits] && m->linear.refinement <= 100;
}

static const char a_name[] = "a name that 'beamrate study --help' lists";

enum { SCHEME, SOLVER, CONTACT, FRICTION, TOLERANCE, AXIAL_DEGREE, SCALING, REFINEMENT, KEYS };

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
    [SCALING] = {"scaling", read_scaling, "none, sum or max"},
    [REFINEMENT] = {"refinement", read_refinement, "a count of steps, 100 at most"},
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

/* An option that is given, and that the solver does not heed. */
static const char *unheeded(const struct br_verify_method *m)
{
    const struct br_linear_solver *solver = m->method.solver;
    if (m->given & 1u << SCALING && !br_linear_solver_heeds(solver, "--scaling"))
        return keys[SCALING].name;
    if (m->given & 1u << REFINEMENT && !br_linear_solver_heeds(solver, "--refinement"))
        return keys[REFINEMENT].name;
    return NULL;
}

enum br_status br_verify_method_end(struct br_verify_method *m, struct br_error *err)
{
    if (!(m->given & 1u << CONTACT))
        m->method.contact = br_contact_rule_of(m->method.scheme);
    if (m->given & 1u << TOLERANCE && !m->method.scheme->adaptive)
        return br_fail(err, BR_BAD_INPUT, "tolerance: time scheme '%s' does not heed it",
                       m->method.scheme->name);
    if (unheeded(m))
        return br_fail(err, BR_BAD_INPUT, "%s: solver '%s' does not heed it", unheeded(m),
                       m->method.solver->name);
    return br_method_check(&m->method, err);
}
