/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work-precision diagrams of any programs. */
#include <math.h>

#include "base/quote.h"
#include "orders/work.h"
#include "plots/pictures.h"

enum { MARKUP = 120 };

static void add_point(struct br_series *s, const struct br_work_point *p)
{
    br_point_add(s, p->cost, p->error, p->is_start ? "start" : NULL);
}

/* The runs that another one of their program beats; the front of all, behind; and the stairs of
 * each program's own best. */
static void add_work(struct br_figure *f, const struct br_work_precision *w)
{
    char text[MARKUP], error[MARKUP + 8];
    struct br_panel *panel = br_panel_add(f, true, "", "%s", "");
    br_label_set(panel->x_label, br_quoted(text, MARKUP, &br_for_markup, w->cost), w->cost_unit);
    snprintf(error, sizeof error, "error %s", br_quoted(text, MARKUP, &br_for_markup, w->quantity));
    br_label_set(panel->y_label, error, w->unit);
    struct br_series *front = br_series_add(f, BR_PEN_BAND, "front of all"), *others = NULL;
    for (size_t i = 0; i < w->points; i++) {
        if (w->point[i].front)
            br_point_add(front, w->point[i].cost, w->point[i].error, NULL);
        if (!w->point[i].own && !others)
            others = br_series_add(f, BR_PEN_DOTS, "dearer and no better");
        if (!w->point[i].own)
            add_point(others, &w->point[i]);
    }
    br_series_stairs(front);
    for (const struct br_work_program *p = w->program; p < w->program + w->programs; p++) {
        struct br_series *s =
            br_series_add(f, BR_PEN_CURVE, "%s", br_quoted(text, MARKUP, &br_for_markup, p->name));
        for (size_t i = 0; i < p->points; i++)
            if (p->point[i].own)
                add_point(s, &p->point[i]);
        br_series_stairs(s);
    }
}

struct br_figure br_work_draw(const struct br_work_precision *works, size_t count,
                              const char *caption)
{
    struct br_figure f = {0};
    BR_SAY(f.stem, "trade");
    BR_SAY(f.title, "%s", caption);
    BR_SAY(f.about, "errors over costs of each program, and the front of all");
    BR_SAY(f.hollow, "mostly its start");
    for (size_t i = 0; i < count && i < BR_FIGURE_PANELS; i++)
        add_work(&f, &works[i]);
    return f;
}
