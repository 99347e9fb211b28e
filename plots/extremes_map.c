/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/extremes_map.h"

#include <math.h>
#include <stdio.h>

static void fill_edges(const struct br_extreme_coordinate *c, double *edge)
{
    for (size_t i = 0; i <= c->cells; i++)
        edge[i] = pow(10, c->low + (c->high - c->low) * (double)i / (double)c->cells);
}

static enum br_status draw_plane(const struct br_extreme_map *map,
                                 const struct br_extreme_plane *plane, struct br_heat_panel *panel,
                                 struct br_error *err)
{
    const enum br_status status = br_heat_panel_init(panel, plane->x->cells, plane->y->cells, err);
    if (status)
        return status;
    snprintf(panel->title, sizeof panel->title, "%s", plane->title);
    snprintf(panel->x_label, sizeof panel->x_label, "%s", plane->x->title);
    snprintf(panel->y_label, sizeof panel->y_label, "%s", plane->y->title);
    panel->log_x = panel->log_y = true;
    fill_edges(plane->x, panel->x);
    fill_edges(plane->y, panel->y);
    br_extreme_plane_fill(map, plane, panel->value);
    return BR_OK;
}

enum br_status br_extremes_map_draw(const struct br_extreme_map *map, struct br_heat *heat,
                                    struct br_error *err)
{
    *heat = (struct br_heat){.stem = "map", .kinds = BR_EXTREME_CLASSES};
    snprintf(heat->title, sizeof heat->title,
             "The map of extremes: what most of the cases in a cell are");
    for (int i = 0; i < BR_EXTREME_CLASSES; i++)
        snprintf(heat->kind[i], sizeof heat->kind[i], "%s",
                 br_extreme_title((enum br_extreme_class)i));
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_EXTREME_PLANES && !status; i++)
        status = draw_plane(map, &br_extreme_planes[i], &heat->panel[heat->panels++], err);
    return status;
}
