/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of `extremes`. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "plots/beam/pictures.h"
#include "solver/scene.h"
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
           "Deviation from the exact discrete solution after %d steps of %s, k = %g s",
           BR_FLOOR_STEPS, f->scene[0]->name, step);
    br_panel_add(figure, true, "elements n", "relative deviation");
    for (size_t m = 0; m < f->method.count; m++) {
        struct br_series *s = br_series_add(figure, BR_PEN_CURVE, "%s", f->method.list[m].name);
        for (size_t i = 0; i < f->n_count; i++)
            add_deviation(s, br_floor_at(f, 0, m, i, k), br_floor_at(f, 0, m, i, k)->n);
    }
    add_rounding(f, 1, figure);
    add_rounding(f, 4, figure);
}

static void draw_gathered(const struct br_floors *f, size_t scene, struct br_figure *figure)
{
    struct br_panel *p = br_panel_add(figure, true, "steps N", "relative deviation");
    BR_SAY(p->title, "%s", f->scene[scene]->name);
    for (size_t m = 0; m < f->method.count; m += f->solvers) {
        const char *name = f->method.list[m].name, *solver = strrchr(name, '+');
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
    return picture;
}

/* ---- stability: a panel for each plane ---- */

/* The points of one outcome. */
static void add_points(const struct br_stability *s, const struct br_stability_plane *p,
                       enum br_stability_outcome outcome, struct br_figure *figure)
{
    static const enum br_pen pens[] = {BR_PEN_RINGS, BR_PEN_STARS, BR_PEN_SQUARES};
    if (!br_stability_count(s, p, outcome))
        return;
    struct br_series *series =
        br_series_add(figure, pens[outcome], "%s", br_stability_words[outcome]);
    for (size_t i = 0; i < p->columns * s->rows; i++) {
        const struct br_stability_column *c = &p->column[i / s->rows];
        const struct br_stability_point *point = &c->point[i % s->rows];
        if (point->outcome == outcome)
            br_point_add(series, p->over_stiffness ? c->stiffness : (double)c->n,
                         s->scene->duration / (double)point->steps, NULL);
    }
}

static void draw_plane(const struct br_stability *s, const struct br_stability_plane *p,
                       struct br_figure *figure)
{
    struct br_panel *panel =
        br_panel_add(figure, true, p->over_stiffness ? "contact stiffness c_H (N/m)" : "elements n",
                     "time step k (s)");
    if (p->over_stiffness)
        BR_SAY(panel->title, "%s, n = %zu", p->by->name, p->column[0].n);
    else if (s->own > 0)
        BR_SAY(panel->title, "%.60s, c_H = %.6g N/m", p->by->name, s->own);
    else
        BR_SAY(panel->title, "%s", p->by->name);
    for (int outcome = BR_STABLE; outcome <= BR_REFUSED; outcome++)
        add_points(s, p, (enum br_stability_outcome)outcome, figure);
    const double smallest = s->scene->duration / (double)s->steps[0];
    const double largest = s->scene->duration / (double)s->steps[s->rows - 1];
    struct br_series *found = br_series_add(figure, BR_PEN_CURVE, "largest stable k");
    struct br_series *theory = br_series_add(figure, BR_PEN_GUIDE, "by theory, closed contact");
    for (size_t i = 0; i < p->columns; i++) {
        const struct br_stability_column *c = &p->column[i];
        const double x = p->over_stiffness ? c->stiffness : (double)c->n;
        const bool inside = c->predicted >= smallest && c->predicted <= largest;
        br_point_add(found, x, isfinite(c->broken) ? c->largest : (double)NAN, NULL);
        br_point_add(theory, x, inside ? c->predicted : (double)NAN, NULL);
    }
}

struct br_figure br_stability_draw(const struct br_stability *s)
{
    struct br_figure picture = {.stem = "stability"}, *figure = &picture;
    BR_SAY(figure->title, "Where %s breaks", s->scene->name);
    for (size_t i = 0; i < s->planes; i++)
        draw_plane(s, &s->plane[i], figure);
    return picture;
}
