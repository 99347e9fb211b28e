/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of `extremes`. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "plots/pictures.h"
#include "study/extremes/map.h"

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

/* ---- energy: loss a period over steps a period ---- */

/* The density that is shown. */
enum { SHOWN = BR_VIBRATION_DENSITIES / 2 };

static void add_loss(const struct br_vibration_row *row, bool measured, struct br_series *s)
{
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++) {
        const struct br_vibration *v = &row->at[r][SHOWN];
        const double loss = fabs(measured || row->scheme->adaptive ? v->measured : v->predicted);
        br_point_add(s, v->steps, v->end == BR_VIBRATION_DONE ? loss : (double)NAN, NULL);
    }
}

/* Schemes that take the same energy share a curve. */
static bool same(const struct br_vibration_row *a, const struct br_vibration_row *b)
{
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
        if (!(fabs(a->at[r][SHOWN].predicted - b->at[r][SHOWN].predicted) <=
              b->at[r][SHOWN].round_off))
            return false;
    return a->damping == b->damping && a->kind == b->kind;
}

static bool has_curve(const struct br_energy_behaviour *b, size_t i, bool damped)
{
    const struct br_vibration_row *row = &b->vibration[i];
    for (size_t j = 0; j < i; j++)
        if (same(&b->vibration[j], row))
            return false;
    return row->kind == BR_AXIAL && (row->damping > 0) == damped &&
           row->at[0][SHOWN].end == BR_VIBRATION_DONE;
}

static void add_losses(const struct br_energy_behaviour *b, bool damped, struct br_figure *f)
{
    for (int measured = 0; measured < 2; measured++)
        for (size_t i = 0; i < b->vibrations; i++)
            if (has_curve(b, i, damped))
                add_loss(&b->vibration[i], measured,
                         measured
                             ? br_series_add(f, BR_PEN_RINGS, "measured")
                             : br_series_add(f, BR_PEN_LINE, "%s", b->vibration[i].scheme->name));
}

struct br_figure br_energy_draw(const struct br_energy_behaviour *b)
{
    struct br_figure picture = {.stem = "energy", .one_y = true}, *figure = &picture;
    BR_SAY(figure->title, "Energy of a free vibration lost to the scheme, a period");
    for (int damped = 0; damped < 2; damped++) {
        struct br_panel *p = br_panel_add(figure, "steps a period", "share lost a period, size");
        BR_SAY(p->title, damped ? "1 %% of critical damping, beside viscosity" : "undamped");
        p->log_x = p->log_y = true;
        add_losses(b, damped, figure);
    }
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

/* ---- map: verdicts over planes ---- */

static void fill_edges(const struct br_extreme_coordinate *c, double *edge)
{
    for (size_t i = 0; i <= c->cells; i++)
        edge[i] = pow(10, c->low + (c->high - c->low) * (double)i / (double)c->cells);
}

struct br_figure br_extreme_map_draw(const struct br_extreme_map *map)
{
    struct br_figure picture = {.stem = "map", .kinds = BR_EXTREME_CLASSES}, *figure = &picture;
    BR_SAY(figure->title, "The map of extremes: what most of the cases in a cell are");
    for (int i = 0; i < BR_EXTREME_CLASSES; i++)
        BR_SAY(figure->kind[i], "%s", br_extreme_names[i].title);
    for (size_t i = 0; i < BR_EXTREME_PLANES; i++) {
        const struct br_extreme_plane *plane = &br_extreme_planes[i];
        struct br_panel *p = br_panel_add(figure, plane->x.title, plane->y.title);
        struct br_cells *c = br_cells_make(figure, plane->x.cells, plane->y.cells);
        p->log_x = p->log_y = true;
        BR_SAY(p->title, "%s", plane->title);
        if (!c)
            break;
        fill_edges(&plane->x, c->x);
        fill_edges(&plane->y, c->y);
        br_extreme_plane_fill(map, plane, c->value);
    }
    return picture;
}
