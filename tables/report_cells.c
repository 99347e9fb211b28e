/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_cells.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const char *br_order_shown(struct br_document *d, const struct br_estimate *e)
{
    return br_format(d, "%s", br_order_text(e, (char[64]){0}, 64));
}

const char *br_interval_shown(struct br_document *d, const struct br_estimate *e)
{
    return br_format(d, "%s", br_interval_text(e, (char[128]){0}, 128));
}

void br_put_estimate(struct br_document *d, const struct br_column *column, const char *prefix,
                     const struct br_estimate *e, const char *shown)
{
    br_put_cell(d, column, br_number(e->value));
    if (shown && isfinite(e->value))
        br_put_shown(d, "%s", shown);
    br_hide(d, br_format(d, "%slow", prefix), column->unit, br_number(e->low));
    br_hide(d, br_format(d, "%shigh", prefix), column->unit, br_number(e->high));
}

struct br_value br_setting_value(const struct br_setting *s)
{
    if (!*s->text)
        return br_nothing();
    return s->kind == BR_SETTING_COUNT    ? br_count(strtoull(s->text, NULL, 10))
           : s->kind == BR_SETTING_NUMBER ? br_number(strtod(s->text, NULL))
                                          : br_text(s->text);
}

void br_put_settings(struct br_document *d, const char *key, const struct br_settings *settings)
{
    const char *group = NULL;
    for (const struct br_setting *s = settings->row; s < settings->row + settings->count; s++) {
        if (!s->group)
            br_hide_fact(d, br_setting_value(s), NULL, "%s.%s", key, s->key);
        else if (*s->text)
            br_hide_fact(d, br_setting_value(s), NULL, "%s.%s.%s", key, s->group, s->key);
        else if (s->group != group)
            br_hide_fact(d, br_nothing(), NULL, "%s.%s", key, s->group);
        group = s->group;
    }
}
