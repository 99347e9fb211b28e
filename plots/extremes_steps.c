/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/extremes_steps.h"

#include <math.h>
#include <string.h>

/* The method's name without that of the solver. */
static int length_without_solver(const char *name)
{
    const char *last = strrchr(name, '+');
    return last ? (int)(last - name) : (int)strlen(name);
}

static bool draw_method(const struct br_drifts *d, size_t scene, size_t contender,
                        struct br_panel *panel)
{
    const char *name = d->contender[contender].name;
    double(*point)[2] = br_chart_curve(panel, BR_STROKE_MARKED, d->k_count, "%.*s",
                                       length_without_solver(name), name);
    for (size_t j = 0; point && j < d->k_count; j++) {
        const struct br_drift *drift = br_drift_at(d, scene, contender, j);
        const double deviation = br_drift_deviation(drift);
        point[j][0] = (double)d->steps[j];
        point[j][1] = drift->steps && deviation > 0 ? deviation : NAN;
    }
    return point;
}

static bool draw_predicted(const struct br_drifts *d, size_t scene, struct br_panel *panel)
{
    double(*point)[2] = br_chart_curve(panel, BR_STROKE_DASHED, d->k_count, "predicted");
    for (size_t j = 0; point && j < d->k_count; j++) {
        point[j][0] = (double)d->steps[j];
        point[j][1] = br_drift_at(d, scene, 0, j)->predicted;
    }
    return point;
}

static bool draw_panel(const struct br_drifts *d, size_t scene, struct br_panel *panel)
{
    panel->log_x = panel->log_y = true;
    panel->columns = 2;
    panel->y_low = 1e-17;
    panel->y_high = 1e-9;
    snprintf(panel->title, sizeof panel->title, "%s",
             scene ? "Example 2, slip" : "Example 1, stick");
    snprintf(panel->x_label, sizeof panel->x_label, "steps N");
    snprintf(panel->y_label, sizeof panel->y_label, "deviation, relative");
    for (size_t c = 0; c < d->contenders; c += d->solvers)
        if (!draw_method(d, scene, c, panel))
            return false;
    return draw_predicted(d, scene, panel);
}

enum br_status br_drifts_draw(const struct br_drifts *d, struct br_chart *chart,
                              struct br_error *err)
{
    br_chart_lay_out(chart, BR_DRIFT_SCENES);
    snprintf(chart->stem, sizeof chart->stem, "steps");
    snprintf(chart->title, sizeof chart->title,
             "Deviation from the exact discrete solution after N steps, n = %d, riccati",
             BR_DRIFT_N);
    for (size_t s = 0; s < BR_DRIFT_SCENES; s++)
        if (!draw_panel(d, s, &chart->panel[s]))
            return br_no_memory(err, "a plot");
    return BR_OK;
}
