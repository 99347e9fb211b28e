/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/beam/report_parts.h"

void br_put_method_facts(struct br_document *d, const char *key, const struct br_method *m,
                         const struct br_meshes *on)
{
    struct br_settings settings;
    br_method_settings(on, m, &settings);
    br_put_settings(d, key, &settings);
}

void br_put_method_cells(struct br_document *d, const struct br_method *m)
{
    struct br_settings settings;
    br_method_settings(&(struct br_meshes){0}, m, &settings);
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        br_hide(d, br_method_field_key(&br_method_fields[i]), NULL,
                br_setting_value(&settings.row[i]));
}
