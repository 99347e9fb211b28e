/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/method_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

__attribute__((format(printf, 2, 3))) static void append(char text[BR_METHOD_TEXT],
                                                         const char *format, ...)
{
    const size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + used, BR_METHOD_TEXT - used, format, args);
    va_end(args);
}

const char *br_method_text(const struct br_scene *scene, const struct br_method *m,
                           char text[BR_METHOD_TEXT])
{
    const struct br_kernel *kernel = br_linear_solver_kernel(m->solver, &m->linear);
    const bool frictionless = scene->friction.law == BR_FRICTIONLESS;
    text[0] = '\0';
    append(text, "scheme %s", m->scheme->name);
    if (m->scheme->adaptive)
        append(text, " to %g", m->tolerance);
    if (m->axial_degree != 1 && scene->axial.modelled)
        append(text, ", axial elements of degree %d", m->axial_degree);
    if (!m->scheme->integrator) /* else it solves its systems itself */
        append(text, ", solver %s%s%s", m->solver->name, kernel ? " on " : "",
               kernel ? kernel->name : "");
    append(text, ", contact %s", scene->contact.modelled ? m->contact->name : "none");
    append(text, ", friction %s", frictionless ? "none" : m->friction->name);
    if (!frictionless && m->friction->iterates)
        append(text, " (parameter %g, to %g, at most %zu iterations)", m->iteration.parameter,
               m->iteration.tolerance, m->iteration.most);
    return text;
}
