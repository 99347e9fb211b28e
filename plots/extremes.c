/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of `extremes`. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "plots/pictures.h"
#include "study/extremes/extremes.h"

/* ---- floors: deviation over n, or over N ---- */

/* 2^-53 n^power: the growth of one rounding error; nothing is drawn above 10. */
static void add_rounding(const struct br_floors *f, int power, struct br_figure *figure)
{
    struct br_series *s =
        br_series_add(figure, BR_PEN_GUIDE, power == 1 ? "2^{-53} n" : "2^{-53} n^{%d}", power);
    for (size_t i = 0; i < f->n_count; i++) {
        const double n = (double)br_floor_at(f, 0, 0, i, 0)->n;
        const double rounding = DBL_EPSILON / 2 * pow(n, power);
        br_point_add(s, n, rounding <= 10 ? rounding : (double)NAN, NULL);
    }
}

static void add_deviation(struct br_series *s, const struct br_floor *floor, size_t over)
{
    const bool marched = floor->steps && !floor->refused.status;
    br_point_add(s, (double)over, marched ? br_floor_deviation(floor) : (double)NAN, NULL);
}

static void draw_floors(const struct br_floors *f, size_t k, struct br_figure *figure)
{
    const double step = br_floor_at(f, 0, 0, 0, k)->k;
    BR_SAY(figure->stem, "floors-k%g", step);
    BR_SAY(figure->title,
           "Deviation from the exact discrete solution after %d steps of Example 2, k = %g s",
           BR_FLOOR_STEPS, step);
    br_panel_add(figure, "elements n", "relative deviation");
    for (size_t m = 0; m < f->methods; m++) {
        const char *name = f->method[m].name;
        if (strstr(name, "scaled")) /* their points are those without scaling */
            continue;
        struct br_series *s = br_series_add(figure, BR_PEN_CURVE, "%s", name);
        for (size_t i = 0; i < f->n_count; i++)
            add_deviation(s, br_floor_at(f, 0, m, i, k), br_floor_at(f, 0, m, i, k)->n);
    }
    add_rounding(f, 1, figure);
    add_rounding(f, 4, figure);
}

static void draw_gathered(const struct br_floors *f, size_t scene, struct br_figure *figure)
{
    struct br_panel *p = br_panel_add(figure, "steps N", "relative deviation");
    BR_SAY(p->title, scene ? "Example 2, slip" : "Example 1, stick");
    for (size_t m = 0; m < f->methods; m += f->solvers) {
        const char *name = f->method[m].name, *solver = strrchr(name, '+');
        const size_t length = solver ? (size_t)(solver - name) : strlen(name);
        struct br_series *s = br_series_add(figure, BR_PEN_CURVE, "%.*s", (int)length, name);
        for (size_t j = 0; j < f->k_count; j++)
            add_deviation(s, br_floor_at(f, scene, m, 0, j), br_floor_at(f, scene, m, 0, j)->of);
    }
    struct br_series *s = br_series_add(figure, BR_PEN_GUIDE, "predicted");
    for (size_t j = 0; j < f->k_count; j++) {
        const struct br_floor *floor = br_floor_at(f, scene, 0, 0, j);
        br_point_add(s, (double)floor->of, floor->predicted, NULL);
    }
}

struct br_figure br_floors_draw(const struct br_floors *f, size_t k)
{
    struct br_figure picture = {.stem = "steps", .one_y = f->gathered}, *figure = &picture;
    if (f->gathered)
        BR_SAY(figure->title,
               "Deviation from the exact discrete solution after N steps, n = %d, riccati",
               BR_GATHERED_N);
    else
        draw_floors(f, k, figure);
    for (size_t scene = 0; scene < f->scenes && f->gathered; scene++)
        draw_gathered(f, scene, figure);
    for (size_t i = 0; i < figure->panels; i++)
        figure->panel[i].log_x = figure->panel[i].log_y = true;
    return picture;
}

/* ---- stability: growth over c_H and k ---- */

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

static void fill_cells(const struct br_stability *s, const struct br_stability_row *row,
                       struct br_figure *figure)
{
    struct br_cells *c = br_cells_make(figure, BR_STABILITY_COLUMNS, s->rows);
    if (!c)
        return;
    memcpy(c->x, s->stiffness, BR_STABILITY_COLUMNS * sizeof *c->x);
    for (size_t i = 0; i < s->rows; i++) {
        c->y[i] = row[i].k;
        memcpy(c->value + i * BR_STABILITY_COLUMNS, row[i].radius, sizeof row[i].radius);
    }
    to_edges(BR_STABILITY_COLUMNS, c->x);
    to_edges(s->rows, c->y);
}

struct br_figure br_stability_draw(const struct br_stability *s)
{
    struct br_figure picture = {.stem = "stability", .value = {1e-1, 1e3}}, *figure = &picture;
    BR_SAY(figure->title, "The closed lagged contact: growth of an error in a step, measured");
    BR_SAY(figure->value_label, "largest eigenvalue of a step");
    for (size_t i = 0; i < BR_STABILITY_RODS; i++) {
        const struct br_stability_row *row = &s->row[i * s->rows];
        struct br_panel *p = br_panel_add(figure, "c_H (N/m)", "k (s)");
        p->log_x = p->log_y = true;
        BR_SAY(p->title, "%s", row->rod->title);
        fill_cells(s, row, figure);
        struct br_series *limit = br_series_add(figure, BR_PEN_GUIDE, "predicted limit");
        struct br_series *bouncing =
            br_series_add(figure, BR_PEN_GUIDE, "no energy is gained left of this");
        for (size_t j = 0; j < s->rows; j++) {
            br_point_add(limit, row[j].limit, row[j].k, NULL);
            br_point_add(bouncing, row[j].bouncing, row[j].k, NULL);
        }
    }
    return picture;
}
