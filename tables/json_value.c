/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/json_value.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "study/scene/quote.h"

static atomic_bool lacked, parsing;

static void give_up(void)
{
    static const char message[] = "beamrate: out of memory for reading JSON\n";
    (void)!write(STDERR_FILENO, message, sizeof message - 1);
    _exit(br_status_exit_code(BR_NO_MEMORY));
}

static void *remembering_malloc(size_t size)
{
    void *p = malloc(size);
    if (!p && atomic_load(&parsing))
        give_up();
    if (!p)
        atomic_store(&lacked, true);
    return p;
}

bool br_json_lacked_memory(void)
{
    json_set_alloc_funcs(remembering_malloc, free);
    return atomic_load(&lacked);
}

json_t *br_json_read(int file, json_error_t *why)
{
    br_json_lacked_memory();
    atomic_store(&parsing, true);
    json_t *json = json_loadfd(file, 0, why);
    atomic_store(&parsing, false);
    return json;
}

json_t *br_json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* A file's name need not be UTF-8, which JSON must be. */
static json_t *not_utf8(const char *text)
{
    const size_t size = 4 * strlen(text) + 1;
    char *visible = br_allocate(size, 1);
    json_t *o = visible ? json_string(br_quoted(visible, size, &br_for_text, text)) : NULL;
    free(visible);
    return o;
}

json_t *br_json_string(const char *text)
{
    json_t *o = text ? json_string(text) : json_null();
    return o ? o : not_utf8(text);
}

json_t *br_json_estimate(const struct br_estimate *e)
{
    return json_pack("{s:o, s:o, s:o}", "value", br_json_number(e->value), "low",
                     br_json_number(e->low), "high", br_json_number(e->high));
}

/* null: the friction rule does not iterate */
static json_t *iteration(const struct br_method *m)
{
    const struct br_iteration *i = &m->iteration;
    if (!m->friction->iterates)
        return json_null();
    return json_pack("{s:o, s:o, s:I}", "parameter", br_json_number(i->parameter), "tolerance",
                     br_json_number(i->tolerance), "most", (json_int_t)i->most);
}

json_t *br_json_method(const struct br_method *m)
{
    const struct br_kernel *kernel = br_linear_solver_kernel(m->solver, &m->linear);
    return json_pack("{s:s, s:o, s:i, s:s, s:o, s:s, s:i, s:s, s:s, s:o}", "scheme",
                     m->scheme->name, "tolerance",
                     m->scheme->adaptive ? br_json_number(m->tolerance) : json_null(),
                     "axial_degree", m->axial_degree, "solver", m->solver->name, "kernel",
                     br_json_string(kernel ? kernel->name : NULL), "scaling", m->linear.scaling,
                     "refinement", m->linear.refinement, "contact", m->contact->name, "friction",
                     m->friction->name, "iteration", iteration(m));
}

json_t *br_json_provenance(const struct br_provenance *p)
{
    json_t *o = json_object();
    json_object_set_new(o, "version", br_json_string(p->version));
    json_object_set_new(o, "commit", br_json_string(p->commit));
    json_object_set_new(o, "compiler", br_json_string(p->compiler));
    json_object_set_new(o, "flags", br_json_string(p->flags));
    json_object_set_new(o, "command_line", br_json_string(p->command_line));
    json_object_set_new(o, "machine", br_json_string(p->machine));
    json_object_set_new(o, "date", br_json_string(p->date));
    json_object_set_new(o, "threads", json_integer(p->threads));
    return o;
}
