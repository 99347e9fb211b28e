/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/figures.h"

static const struct br_figure figure2 = {
    .number = 2,
    .example = 1,
    .title = "Example 1: horizontal and vertical displacements at different instants",
    .says =
        "The right end of the beam keeps clamped, because the tangential stress does not achieve "
        "the friction bound, and the beam remains stuck to the obstacle.",
    .beside =
        "The inset is w(L,t) in the first 100 microseconds, exact and by the scheme with steps of "
        "0.1 microseconds: the friction bound first grows slower than the reaction.",
    .draw = br_draw_figure2,
};
static const struct br_figure figure3 = {
    .number = 3,
    .example = 1,
    .title = "Example 1: evolution in time of the tangential stress and the friction bound",
    .says = "The tangential stress does not achieve the friction bound.",
    .beside = "The inset has the first 100 microseconds of the exact solution, where it does.",
    .draw = br_draw_figure3,
};
static const struct br_figure figure4 = {
    .number = 4,
    .example = 2,
    .title = "Example 2: vertical displacements, and that of the contact node over time",
    .says = "There is always movement of the contact node, since the tangential stress equals the "
            "friction bound.",
    .draw = br_draw_figure4,
};
static const struct br_figure figure5 = {
    .number = 5,
    .example = 3,
    .title = "Example 3: vertical displacements, and that of the contact node over time",
    .says =
        "The contact node is clamped until time t = 0.68 s, when the tangential stress reaches the "
        "friction bound.",
    .draw = br_draw_figure5,
};
static const struct br_figure figure6 = {
    .number = 6,
    .example = 3,
    .title = "Example 3: evolution in time of the tangential stress",
    .says = "At t = 0.68 s the tangential stress reaches the friction bound.",
    .draw = br_draw_figure6,
};
static const struct br_figure figure7 = {
    .number = 7,
    .example = 4,
    .title = "Example 4: horizontal displacements, and that of the contact node over time",
    .says = "There is always penetration of the beam into the obstacle.",
    .draw = br_draw_figure7,
};
static const struct br_figure figure8 = {
    .number = 8,
    .example = 4,
    .title = "Example 4: vertical displacements, and that of the contact node over time",
    .says = "The text only names this figure.",
    .draw = br_draw_figure8,
};
static const struct br_figure figure9 = {
    .number = 9,
    .example = 4,
    .title = "Example 4: evolution in time of the friction bound and the tangential stress",
    .says = "The friction bound is h(t) = c_V u(1,t).",
    .beside = "The bound is drawn beside the stress, too, with both signs.",
    .draw = br_draw_figure9,
};
static const struct br_figure figure10 = {
    .number = 10,
    .example = 4,
    .title = "Example 4: sum of the L2 norms depending on c_H and c_V",
    .says = "The stability of the solution is clearly observed.",
    .beside =
        "The paper says neither the ranges nor the time of its norms: shown are the largest sum "
        "of all times and that at t = T. Beyond the dashed line in c_H the scheme as printed, "
        "with the contact force of the step before, amplifies.",
    .draw = br_draw_figure10,
};

const struct br_figure *const br_figures[] = {&figure2, &figure3, &figure4, &figure5,  &figure6,
                                              &figure7, &figure8, &figure9, &figure10, NULL};

enum br_status br_figure_draw(const struct br_figure *figure, const struct br_paper *paper,
                              struct br_chart *chart, struct br_error *err)
{
    *chart = (struct br_chart){0};
    if (!figure->draw(paper, chart))
        return br_no_memory(err, "a figure");
    snprintf(chart->stem, sizeof chart->stem, "figure%d", figure->number);
    snprintf(chart->title, sizeof chart->title, "Figure %d. %s", figure->number, figure->title);
    return BR_OK;
}

/* ---- curves ---- */

bool br_draw_field(const struct br_example *e, enum br_field_kind kind, struct br_panel *panel)
{
    const struct br_history_record *r = &e->record;
    const size_t unknowns = r->unknowns[kind], every = r->n > 200 ? r->n / 200 : 1;
    for (size_t look = 0; look < r->looks; look++) {
        const double *nodal = br_history_field(r, look, kind, false);
        const size_t count = r->n / every + 1;
        double(*point)[2] =
            br_chart_curve(panel, BR_STROKE_SERIES, count, "t = %.4g s", r->at[look].time);
        if (!point)
            return false;
        for (size_t i = 0; i < count; i++) {
            point[i][0] = (double)(i * every) / (double)r->n * e->scene.length;
            point[i][1] = nodal[i * every * unknowns];
        }
    }
    snprintf(panel->x_label, sizeof panel->x_label, "x (m)");
    snprintf(panel->y_label, sizeof panel->y_label,
             kind == BR_AXIAL ? "horizontal displacement u (m)" : "vertical displacement w (m)");
    panel->x_high = e->scene.length;
    return true;
}

/* What a curve over time shows of a row. */
typedef double of_row(const struct br_history_row *row, double factor);

static double bending_of(const struct br_history_row *row, double factor)
{
    return factor * row->displacement[BR_BENDING];
}

static double axial_of(const struct br_history_row *row, double factor)
{
    return factor * row->displacement[BR_AXIAL];
}

static double force_of(const struct br_history_row *row, double factor)
{
    return factor * row->friction_force;
}

static double bound_of(const struct br_history_row *row, double factor)
{
    return factor * row->friction_bound;
}

static bool draw_rows(const struct br_example *e, of_row *value, double factor, double (*point)[2],
                      struct br_panel *panel)
{
    for (size_t i = 0; point && i < e->record.rows; i++) {
        point[i][0] = e->record.row[i].time;
        point[i][1] = value(&e->record.row[i], factor);
    }
    snprintf(panel->x_label, sizeof panel->x_label, "time t (s)");
    panel->x_high = e->scene.duration;
    return point != NULL;
}

bool br_draw_tip(const struct br_example *e, enum br_field_kind kind, const char *title,
                 struct br_panel *panel)
{
    snprintf(panel->y_label, sizeof panel->y_label,
             kind == BR_AXIAL ? "horizontal displacement u (m)" : "vertical displacement w (m)");
    return draw_rows(e, kind == BR_AXIAL ? axial_of : bending_of, 1,
                     br_chart_curve(panel, BR_STROKE_SOLID, e->record.rows, "%s", title), panel);
}

bool br_draw_stress(const struct br_example *e, const char *title, struct br_panel *panel)
{
    snprintf(panel->y_label, sizeof panel->y_label, "force (N)");
    return draw_rows(e, force_of, -1,
                     br_chart_curve(panel, BR_STROKE_SOLID, e->record.rows, "%s", title), panel);
}

bool br_draw_bound(const struct br_example *e, double sign, const char *title,
                   struct br_panel *panel)
{
    snprintf(panel->y_label, sizeof panel->y_label, "force (N)");
    return draw_rows(e, bound_of, sign,
                     br_chart_curve(panel, BR_STROKE_DASHED, e->record.rows, "%s", title), panel);
}
