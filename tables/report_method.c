/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_method.h"

struct br_value br_method_value(const struct br_method_field *f, const struct br_method *m,
                                char text[BR_METHOD_VALUE])
{
    const bool whole = f == &br_method_fields[BR_METHOD_DEGREE] || (!f->words && f->range.whole);
    if (!br_method_field_reported(f, m))
        return br_nothing();
    if (whole)
        return br_count((size_t)atoll(br_method_field_text(f, m, text)));
    return f->words ? br_text(br_method_field_text(f, m, text)) : br_number(f->get(m));
}

static void put(struct br_document *d, const char *key, const char *member, struct br_value value)
{
    char name[2 * BR_METHOD_VALUE];
    snprintf(name, sizeof name, "%s.%s", key, member);
    br_put_fact(d, &(struct br_column){.key = name, .flags = BR_FOR_PROGRAMS}, value);
}

/* Fields of a group are members of one object, null where they are not heeded. */
void br_put_method(struct br_document *d, const char *key, const struct br_method *m)
{
    const char *group = NULL;
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++) {
        const struct br_method_field *f = &br_method_fields[i];
        char text[BR_METHOD_VALUE], name[BR_METHOD_VALUE];
        if (!f->group) {
            put(d, key, br_method_field_key(f, name), br_method_value(f, m, text));
        } else if (br_method_field_heeded(f, m)) {
            snprintf(name, sizeof name, "%s.%s", f->group, f->member);
            put(d, key, name, br_method_value(f, m, text));
        } else if (f->group != group) {
            put(d, key, f->group, br_nothing());
        }
        group = f->group;
    }
}
