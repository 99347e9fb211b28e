/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/json_value.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "study/scene/method_fields.h"
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
    if (!text)
        return json_null();
    return br_is_utf8(text) ? json_string(text) : not_utf8(text);
}

json_t *br_json_estimate(const struct br_estimate *e)
{
    return json_pack("{s:o, s:o, s:o}", "value", br_json_number(e->value), "low",
                     br_json_number(e->low), "high", br_json_number(e->high));
}

/* null: it is not heeded, and has no value then */
static json_t *method_value(const struct br_method_field *f, const struct br_method *m)
{
    char text[BR_METHOD_VALUE];
    if (!br_method_field_reported(f, m))
        return json_null();
    br_method_field_text(f, m, text);
    if (f == &br_method_fields[BR_METHOD_DEGREE] || (!f->words && f->range.whole))
        return json_integer(atoll(text));
    return f->words ? br_json_string(text) : br_json_number(f->get(m));
}

/* Fields of a group are members of one object, null where they are not heeded. */
json_t *br_json_method(const struct br_method *m)
{
    json_t *o = json_object();
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++) {
        char key[BR_METHOD_VALUE];
        json_t *group = f->group ? json_object_get(o, f->group) : NULL;
        if (f->group && !group) {
            group = br_method_field_heeded(f, m) ? json_object() : json_null();
            json_object_set_new(o, f->group, group);
        }
        if (!f->group)
            json_object_set_new(o, br_method_field_key(f, key), method_value(f, m));
        else if (json_is_object(group))
            json_object_set_new(group, f->member, method_value(f, m));
    }
    return o;
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
