/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/extremes_stability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Ascending values become the edges of their cells (in/out, count values, count + 1 edges), halfway
 * between their logarithms. */
static void to_edges(size_t count, double *edge)
{
    const double first = count > 1 ? sqrt(edge[1] / edge[0]) : 2;
    const double last = count > 1 ? sqrt(edge[count - 1] / edge[count - 2]) : 2;
    edge[count] = edge[count - 1] * last;
    for (size_t i = count - 1; i > 0; i--)
        edge[i] = sqrt(edge[i - 1]) * sqrt(edge[i]);
    edge[0] /= first;
}

static enum br_status draw_lines(const struct br_stability *s, const struct br_stability_plane *p,
                                 struct br_heat_panel *panel, struct br_error *err)
{
    double(*limit)[2] = br_heat_line(panel, s->rows, "predicted limit");
    double(*bouncing)[2] = br_heat_line(panel, s->rows, "no energy is gained left of this");
    if (!limit || !bouncing)
        return br_no_memory(err, "a heat map");
    for (size_t i = 0; i < s->rows; i++) {
        limit[i][0] = p->row[i].limit;
        bouncing[i][0] = p->row[i].bouncing;
        limit[i][1] = bouncing[i][1] = p->row[i].k;
    }
    return BR_OK;
}

static enum br_status draw_plane(const struct br_stability *s, const struct br_stability_plane *p,
                                 struct br_heat_panel *panel, struct br_error *err)
{
    const enum br_status status = br_heat_panel_init(panel, s->columns, s->rows, err);
    if (status)
        return status;
    snprintf(panel->title, sizeof panel->title, "%s", p->rod->title);
    snprintf(panel->x_label, sizeof panel->x_label, "c_H, N/m");
    snprintf(panel->y_label, sizeof panel->y_label, "k, s");
    panel->log_x = panel->log_y = true;
    memcpy(panel->x, s->stiffness, s->columns * sizeof *panel->x);
    for (size_t i = 0; i < s->rows; i++)
        panel->y[i] = p->row[i].k;
    to_edges(s->columns, panel->x);
    to_edges(s->rows, panel->y);
    for (size_t i = 0; i < s->rows * s->columns; i++)
        panel->value[i] = p->radius[i];
    return draw_lines(s, p, panel, err);
}

enum br_status br_extremes_stability_draw(const struct br_stability *s, struct br_heat *heat,
                                          struct br_error *err)
{
    *heat = (struct br_heat){.stem = "stability", .low = 1e-1, .high = 1e3, .log_value = true};
    snprintf(heat->title, sizeof heat->title,
             "The closed lagged contact: growth of an error in a step, measured");
    snprintf(heat->value_label, sizeof heat->value_label, "largest eigenvalue of a step");
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_STABILITY_RODS && !status; i++)
        status = draw_plane(s, &s->plane[i], &heat->panel[heat->panels++], err);
    return status;
}
