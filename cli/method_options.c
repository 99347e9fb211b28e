/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/method_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/kernel_option.h"
#include "cli/names.h"
#include "cli/number_option.h"
#include "solver/method.h"

void br_method_options_table(struct br_method_options *o,
                             struct poptOption table[BR_METHOD_OPTIONS])
{
    const struct poptOption rows[BR_METHOD_OPTIONS] = {
        {"scheme", 0, POPT_ARG_STRING, &o->scheme, 0, "time scheme", "NAME"},
        {"tolerance", 0, POPT_ARG_STRING, &o->tolerance, 0,
         "error a step of an adaptive scheme, relative to the largest strain (default 1e-6)", "X"},
        {"axial-degree", 0, POPT_ARG_STRING, &o->axial_degree, 0,
         "of the axial elements: 1 (default) or 2", "COUNT"},
        {"solver", 0, POPT_ARG_STRING, &o->solver, 0, "linear solver", "NAME"},
        {"kernel", 0, POPT_ARG_STRING, &o->kernel, 0,
         "instruction set of the solver riccati (default: the best)", "NAME"},
        {"scaling", 0, POPT_ARG_STRING, &o->scaling, 0,
         "umfpack's row scaling: none (default), sum or max", "NAME"},
        {"refinement", 0, POPT_ARG_STRING, &o->refinement, 0,
         "refinement steps a solve of assembled solvers, at most (default 0)", "COUNT"},
        {"contact", 0, POPT_ARG_STRING, &o->contact, 0,
         "where contact takes its force (default: the first that goes with the scheme)", "NAME"},
        {"friction", 0, POPT_ARG_STRING, &o->friction, 0, "friction law, or its iteration", "NAME"},
        {"friction-parameter", 0, POPT_ARG_STRING, &o->friction_parameter, 0,
         "of a friction rule that iterates, over the one that converges fastest (default 0.5)",
         "X"},
        {"friction-tolerance", 0, POPT_ARG_STRING, &o->friction_tolerance, 0,
         "of such a rule, relative to the friction bound (default 1e-10)", "X"},
        {"friction-iterations", 0, POPT_ARG_STRING, &o->friction_iterations, 0,
         "of such a rule, a step at most (default 10000)", "COUNT"},
        POPT_TABLEEND,
    };
    memcpy(table, rows, sizeof rows);
}

void br_method_options_clear(struct br_method_options *o)
{
    char *const texts[] = {o->scheme,
                           o->tolerance,
                           o->solver,
                           o->kernel,
                           o->scaling,
                           o->refinement,
                           o->contact,
                           o->friction,
                           o->friction_parameter,
                           o->friction_tolerance,
                           o->friction_iterations,
                           o->axial_degree};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        free(texts[i]);
    *o = (struct br_method_options){0};
}

/* ---- reading ---- */

static enum br_status unknown(const char *option, const char *found, const char *names,
                              struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "--%s: found '%s', expected one of: %s", option, found,
                   names);
}

static enum br_status read_names(const struct br_method_options *o, struct br_method *m,
                                 struct br_error *err)
{
    if (o->scheme && !(m->scheme = br_time_scheme_find(o->scheme)))
        return unknown("scheme", o->scheme, br_scheme_names(), err);
    if (o->contact && !(m->contact = br_contact_rule_find(o->contact)))
        return unknown("contact", o->contact, br_contact_names(), err);
    if (o->friction && !(m->friction = br_friction_rule_find(o->friction)))
        return unknown("friction", o->friction, br_friction_names(), err);
    if (o->solver && !(m->solver = br_linear_solver_find(o->solver)))
        return unknown("solver", o->solver, br_solver_names(), err);
    if (!o->contact && !m->scheme->may_lag && !m->contact->at_new_step)
        m->contact = br_contact_rule_of(m->scheme);
    return BR_OK;
}

static enum br_status read_linear(const struct br_method_options *o, struct br_linear_options *l,
                                  struct br_error *err)
{
    static const char *const scalings[] = {"none", "sum", "max"};
    bool known = !o->scaling;
    for (size_t i = 0; i < sizeof scalings / sizeof *scalings && !known; i++)
        if (strcmp(o->scaling, scalings[i]) == 0) {
            l->scaling = scalings[i];
            known = true;
        }
    if (!known)
        return unknown("scaling", o->scaling, "none, sum, max", err);
    const enum br_status status =
        br_read_count_option("refinement", o->refinement, 100, &l->refinement, err);
    return status ? status : br_read_kernel_option(o->kernel, &l->kernel, err);
}

static enum br_status read_iteration(const struct br_method_options *o, struct br_method *m,
                                     struct br_error *err)
{
    struct br_iteration *i = &m->iteration;
    int most = (int)i->most;
    const double below = m->friction->iterates ? m->friction->parameter_below : INFINITY;
    enum br_status status = br_read_number_option("friction-parameter", o->friction_parameter, 0,
                                                  below, &i->parameter, err);
    if (!status)
        status = br_read_number_option("friction-tolerance", o->friction_tolerance, 1e-14, 1,
                                       &i->tolerance, err);
    if (!status)
        status = br_read_count_option("friction-iterations", o->friction_iterations, 1000000000,
                                      &most, err);
    if (!status && most < 1)
        status = br_fail(err, BR_BAD_INPUT, "--friction-iterations: found '%s', expected 1 or more",
                         o->friction_iterations);
    i->most = (size_t)most;
    return status;
}

enum br_status br_method_options_read(const struct br_method_options *o, struct br_method *m,
                                      struct br_error *err)
{
    enum br_status status = read_names(o, m, err);
    if (!status)
        status = read_linear(o, &m->linear, err);
    if (!status)
        status = read_iteration(o, m, err);
    if (!status)
        status = br_read_number_option("tolerance", o->tolerance, 1e-14, 1, &m->tolerance, err);
    if (!status && o->axial_degree && strcmp(o->axial_degree, "1") != 0 &&
        strcmp(o->axial_degree, "2") != 0)
        status = br_fail(err, BR_BAD_INPUT, "--axial-degree: found '%s', expected 1 or 2",
                         o->axial_degree);
    if (!status && o->axial_degree)
        m->axial_degree = *o->axial_degree - '0';
    return status ? status : br_method_check(m, err);
}

/* ---- options that the rows of a registry heed or not ---- */

static bool solver_heeds(const struct br_method *m, const char *option)
{
    return br_linear_solver_heeds(m->solver, option);
}

static bool scheme_heeds(const struct br_method *m, const char *option)
{
    (void)option;
    return m->scheme->adaptive;
}

static bool friction_heeds(const struct br_method *m, const char *option)
{
    (void)option;
    return m->friction->iterates;
}

static const char *solver_name(const struct br_method *m)
{
    return m->solver->name;
}

static const char *scheme_name(const struct br_method *m)
{
    return m->scheme->name;
}

static const char *friction_name(const struct br_method *m)
{
    return m->friction->name;
}

struct registry {
    const char *option; /* that chooses the row, without -- */
    const char *word;
    const char *(*name)(const struct br_method *m);
    bool (*heeds)(const struct br_method *m, const char *option);
    bool (*choose)(struct br_method *m, size_t row); /* false: there are no more */
};

static bool choose_solver(struct br_method *m, size_t row)
{
    return (m->solver = br_linear_solvers[row]) != NULL;
}

static bool choose_scheme(struct br_method *m, size_t row)
{
    return (m->scheme = br_time_schemes[row]) != NULL;
}

static bool choose_friction(struct br_method *m, size_t row)
{
    return (m->friction = br_friction_rules[row]) != NULL;
}

static const struct registry solvers = {"solver", "solver", solver_name, solver_heeds,
                                        choose_solver};
static const struct registry schemes = {"scheme", "time scheme", scheme_name, scheme_heeds,
                                        choose_scheme};
static const struct registry frictions = {"friction", "friction rule", friction_name,
                                          friction_heeds, choose_friction};

/* ", as --solver riccati does": the first row that heeds the option. */
static const char *example(const struct registry *r, const char *option, char text[64])
{
    struct br_method m = br_method_default();
    text[0] = '\0';
    for (size_t row = 0; !*text && r->choose(&m, row); row++)
        if (r->heeds(&m, option))
            snprintf(text, 64, ", as --%s %s does", r->option, r->name(&m));
    return text;
}

static enum br_status check_heeded(const struct registry *r, const char *option,
                                   const struct br_method *const *method, size_t count,
                                   struct br_error *err)
{
    char text[64];
    for (size_t i = 0; i < count; i++)
        if (r->heeds(method[i], option))
            return BR_OK;
    if (count == 1)
        return br_fail(err, BR_BAD_INPUT, "%s: %s %s does not heed it%s", option, r->word,
                       r->name(method[0]), example(r, option, text));
    return br_fail(err, BR_BAD_INPUT, "%s: no study here has a %s that heeds it%s", option, r->word,
                   example(r, option, text));
}

enum br_status br_method_options_check(const struct br_method_options *o,
                                       const struct br_method *const *method, size_t count,
                                       struct br_error *err)
{
    const struct {
        const char *option, *value; /* NULL: not given */
        const struct registry *by;
    } given[] = {
        {"--scaling", o->scaling, &solvers},
        {"--refinement", o->refinement, &solvers},
        {"--kernel", o->kernel, &solvers},
        {"--tolerance", o->tolerance, &schemes},
        {"--friction-parameter", o->friction_parameter, &frictions},
        {"--friction-tolerance", o->friction_tolerance, &frictions},
        {"--friction-iterations", o->friction_iterations, &frictions},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof given / sizeof *given && !status; i++)
        if (given[i].value)
            status = check_heeded(given[i].by, given[i].option, method, count, err);
    return status;
}

/* ---- help ---- */

void br_print_method_registries(FILE *out)
{
    fprintf(out, "\nTime schemes (--scheme), the first is the default:\n");
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        fprintf(out, "  %-15s %s\n", (*s)->name, (*s)->title);
    fprintf(out, "Linear solvers (--solver):\n");
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        fprintf(out, "  %-15s %s%s%s\n", (*s)->name, (*s)->title, *(*s)->options ? "; heeds " : "",
                (*s)->options);
    br_print_kernels(out);
    fprintf(out, "Contact (--contact):\n");
    for (const struct br_contact_rule *const *c = br_contact_rules; *c; c++)
        fprintf(out, "  %-15s %s\n", (*c)->name, (*c)->title);
    fprintf(out, "Friction (--friction):\n");
    for (const struct br_friction_rule *const *f = br_friction_rules; *f; f++)
        fprintf(out, "  %-15s %s\n", (*f)->name, (*f)->title);
}
