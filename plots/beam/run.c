/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A recorded march: the tip over time. */
#include <stddef.h>

#include "plots/beam/pictures.h"
#include "solver/scene.h"
#include "study/run/history.h"

void br_rows_add(struct br_figure *f, enum br_pen pen, const char *title,
                 const struct br_history_record *r, size_t place, double factor)
{
    struct br_series *s = br_series_add(f, pen, "%s", title);
    for (size_t i = 0; i < r->rows; i++) {
        const double *value = (const double *)((const char *)&r->row[i] + place);
        br_point_add(s, r->row[i].time, factor * *value, NULL);
    }
}

struct br_figure br_history_draw(const struct br_scene *scene, const struct br_history_record *r)
{
    struct br_figure figure = {.stem = "history"}, *f = &figure;
    BR_SAY(f->title, "The tip over time: %s", scene->title);
    if (scene->axial.modelled) {
        br_panel_add(f, false, "time (s)", "horizontal displacement, u(L) (m)");
        br_rows_add(f, BR_PEN_LINE, "u", r, BR_ROW(displacement[BR_AXIAL]), 1);
    }
    if (scene->bending.modelled) {
        br_panel_add(f, false, "time (s)", "vertical displacement, w(L) (m)");
        br_rows_add(f, BR_PEN_LINE, "w", r, BR_ROW(displacement[BR_BENDING]), 1);
    }
    if (scene->contact.modelled) {
        br_panel_add(f, false, "time (s)", "contact force (N)");
        br_rows_add(f, BR_PEN_LINE, "contact", r, BR_ROW(contact_force), 1);
    }
    if (scene->friction.law != BR_FRICTIONLESS) {
        br_panel_add(f, false, "time (s)", "friction force and its bound (N)");
        br_rows_add(f, BR_PEN_LINE, "friction", r, BR_ROW(friction_force), 1);
        br_rows_add(f, BR_PEN_GUIDE, "bound", r, BR_ROW(friction_bound), 1);
        br_rows_add(f, BR_PEN_GUIDE, "bound", r, BR_ROW(friction_bound), -1);
    }
    return figure;
}
