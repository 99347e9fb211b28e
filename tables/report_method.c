/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_method.h"

void br_put_method(struct br_document *d, const char *key, const struct br_method *m)
{
    const struct br_kernel *kernel = br_linear_solver_kernel(m->solver, &m->linear);
    const bool iterates = m->friction->iterates;
    const struct {
        const char *name;
        struct br_value value;
    } rows[] = {
        {"scheme", br_text(m->scheme->name)},
        {"tolerance", m->scheme->adaptive ? br_number(m->tolerance) : br_nothing()},
        {"axial_degree", br_count((size_t)m->axial_degree)},
        {"solver", br_text(m->solver->name)},
        {"kernel", br_text(kernel ? kernel->name : NULL)},
        {"scaling", br_text(m->linear.scaling)},
        {"refinement", br_count((size_t)m->linear.refinement)},
        {"contact", br_text(m->contact->name)},
        {"friction", br_text(m->friction->name)},
        {"iteration.parameter", br_number(m->iteration.parameter)},
        {"iteration.tolerance", br_number(m->iteration.tolerance)},
        {"iteration.most", br_count(m->iteration.most)},
    };
    const size_t all = sizeof rows / sizeof *rows;
    char name[100];
    for (size_t i = 0; i < (iterates ? all : all - 3); i++) {
        snprintf(name, sizeof name, "%s.%s", key, rows[i].name);
        br_put_fact(d, &(struct br_column){.key = name, .flags = BR_FOR_PROGRAMS}, rows[i].value);
    }
    snprintf(name, sizeof name, "%s.iteration", key);
    if (!iterates)
        br_put_fact(d, &(struct br_column){.key = name, .flags = BR_FOR_PROGRAMS}, br_nothing());
}
