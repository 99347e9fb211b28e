/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/extremes_floors.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Scaling is seen in the tables: with it an assembled solver is where it is without. */
static bool is_drawn(const struct br_contender *c)
{
    return strstr(c->name, "scaled") == NULL;
}

static bool draw_solver(const struct br_floors *f, size_t solver, size_t k, struct br_panel *panel)
{
    double(*point)[2] =
        br_chart_curve(panel, BR_STROKE_MARKED, f->n_count, "%s", f->solver[solver].name);
    for (size_t i = 0; point && i < f->n_count; i++) {
        const struct br_floor *floor = br_floor_at(f, solver, i, k);
        const double deviation = br_floor_deviation(floor);
        point[i][0] = (double)f->n[i];
        point[i][1] = deviation > 0 && !floor->refused.status ? deviation : NAN;
    }
    return point;
}

/* 2^-53 n^power: what one rounding becomes. */
static bool draw_guide(const struct br_floors *f, int power, struct br_panel *panel)
{
    double(*point)[2] = br_chart_curve(
        panel, BR_STROKE_DASHED, f->n_count,
        power == 1 ? "2^{-53} n, as h^{-1}" : "2^{-53} n^{%d}, as h^{-%d}", power, power);
    for (size_t i = 0; point && i < f->n_count; i++) {
        point[i][0] = (double)f->n[i];
        point[i][1] = DBL_EPSILON / 2 * pow((double)f->n[i], power);
    }
    return point;
}

static bool draw_panel(const struct br_floors *f, size_t k, struct br_panel *panel)
{
    panel->log_x = panel->log_y = true;
    panel->columns = 4;
    panel->y_low = 1e-17;
    panel->y_high = 10;
    snprintf(panel->x_label, sizeof panel->x_label, "elements n");
    snprintf(panel->y_label, sizeof panel->y_label, "deviation, relative");
    for (size_t s = 0; s < f->solvers; s++)
        if (is_drawn(&f->solver[s]) && !draw_solver(f, s, k, panel))
            return false;
    return draw_guide(f, 1, panel) && draw_guide(f, 4, panel);
}

enum br_status br_floors_draw(const struct br_floors *f, size_t k, struct br_chart *chart,
                              struct br_error *err)
{
    br_chart_lay_out(chart, 1);
    snprintf(chart->stem, sizeof chart->stem, "floors-k%g", f->k[k]);
    snprintf(chart->title, sizeof chart->title,
             "Deviation from the exact discrete solution after %d steps of Example 2, k = %g s",
             BR_FLOOR_STEPS, f->k[k]);
    return draw_panel(f, k, &chart->panel[0]) ? BR_OK : br_no_memory(err, "a plot");
}
