/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/report_cells.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void br_put_estimate(struct br_document *d, const struct br_column *column,
                     const struct br_estimate *e, const char *shown)
{
    char low[32], high[32];
    snprintf(low, sizeof low, "%s_low", column->key);
    snprintf(high, sizeof high, "%s_high", column->key);
    br_put_cell(d, column, br_number(e->value));
    if (shown && isfinite(e->value))
        br_put_shown(d, "%s", shown);
    br_hide(d, low, column->unit, br_number(e->low));
    br_hide(d, high, column->unit, br_number(e->high));
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
