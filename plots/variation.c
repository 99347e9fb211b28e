/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results over a scene's number that was varied. */
#include <math.h>
#include <string.h>

#include "plots/pictures.h"
#include "study/scene/vary.h"

/* Adds one panel for the columns with the axis of `first`, from `first` on. */
static void add_panel(struct br_figure *f, const struct br_variation *variation, size_t first)
{
    const struct br_varied *v = variation->varied;
    char label[120];
    if (*v->unit)
        BR_SAY(label, "%s (%s)", v->name, v->unit);
    else
        BR_SAY(label, "%s", v->name);
    for (char *under = label; (under = strchr(under, '_'));)
        *under = ' '; /* no subscript */
    struct br_panel *p = br_panel_add(f, label, variation->column[first].axis);
    p->log_x = v->logarithmic;
    p->log_y = variation->column[first].logarithmic;
    for (size_t c = first; c < variation->columns; c++) {
        const struct br_variation_column *column = &variation->column[c];
        if (column->axis && strcmp(column->axis, variation->column[first].axis) == 0) {
            struct br_series *s = br_series_add(f, BR_PEN_CURVE, "%s", column->heading);
            for (size_t i = 0; i < v->count; i++)
                if (!variation->unstable[i])
                    br_point_add(s, v->value[i], br_variation_value(variation, i, c),
                                 variation->remark[i]);
            br_series_sort(s);
        }
    }
}

static bool has_number(const struct br_variation *variation, size_t column)
{
    bool has = false;
    for (size_t i = 0; i < variation->varied->count; i++)
        has |= !variation->unstable[i] && isfinite(br_variation_value(variation, i, column));
    return has;
}

struct br_figure br_variation_draw(const struct br_variation *variation)
{
    struct br_figure figure = {0}, *f = &figure;
    BR_SAY(f->stem, "%s", variation->name);
    BR_SAY(f->title, "%s", variation->caption);
    BR_SAY(f->about, "what was found over %s", variation->varied->name);
    BR_SAY(f->hollow, "see the table's remarks");
    for (size_t c = 0; c < variation->columns; c++) {
        bool first = variation->column[c].axis && has_number(variation, c);
        for (size_t b = 0; b < c && first; b++)
            first = !variation->column[b].axis || !has_number(variation, b) ||
                    strcmp(variation->column[b].axis, variation->column[c].axis) != 0;
        if (first && f->panels < BR_FIGURE_PANELS)
            add_panel(f, variation, c);
    }
    return figure;
}
