/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_method.h"

#include <stdlib.h>

#include "study/scene/method_fields.h"

static struct br_value value_of(const struct br_method_field *f, const struct br_method *m,
                                char text[BR_METHOD_VALUE])
{
    if (!br_method_field_reported(f, m))
        return br_nothing();
    br_method_field_text(f, m, text);
    if (f == &br_method_fields[BR_METHOD_DEGREE] || (!f->words && f->range.whole))
        return br_count((size_t)atoll(text));
    return f->words ? br_text(text) : br_number(f->get(m));
}

/* Fields of a group are members of one object, which is null where they are not heeded. */
void br_put_method(struct br_document *d, const char *key, const struct br_method *m)
{
    const char *group = "";
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++) {
        const bool lacks = f->group && !br_method_field_heeded(f, m);
        char name[100], text[BR_METHOD_VALUE];
        if (lacks && f->group == group)
            continue;
        group = f->group ? f->group : "";
        snprintf(name, sizeof name, "%s.%s%s%s", key, group, f->group && !lacks ? "." : "",
                 lacks      ? ""
                 : f->group ? f->member
                            : br_method_field_key(f, text));
        br_put_fact(d, &(struct br_column){.key = name, .flags = BR_FOR_PROGRAMS},
                    lacks ? br_nothing() : value_of(f, m, text));
    }
}
