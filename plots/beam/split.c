/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Components of the error over the time step, or over the mesh width. */
#include <math.h>

#include "plots/beam/pictures.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/scene/method_fields.h"
#include "study/trade/split.h"

enum { PANELS = 2 };

/* Runs of one method: over k on the finest of its meshes, or over h at its smallest k. */
struct line {
    const struct br_split *split, *first; /* of all count; of the method */
    size_t count, finest;                 /* n, or steps */
    bool over_k;
};

/* The number of elements or steps that all runs of a line share. */
static size_t fixed(const struct line *line, const struct br_split *s)
{
    return line->over_k ? s->at.n : s->at.steps;
}

static bool is_on(const struct line *line, const struct br_split *s)
{
    return br_methods_equal(&s->method, &line->first->method) && fixed(line, s) == line->finest;
}

/* Component i of the runs; past the last, the whole. A gap where it is below its floor. */
static void add_points(const struct line *line, size_t part, struct br_series *series)
{
    for (size_t i = 0; i < line->count; i++) {
        const struct br_split *s = &line->split[i];
        if (!is_on(line, s))
            continue;
        const struct br_share *share = part < BR_SOURCES ? &s->share[part] : &s->whole;
        br_point_add(
            series,
            line->over_k ? br_time_step(s->scene, s->at.steps) : br_mesh_size(s->scene, s->at.n),
            br_share_known(share, 0, BR_PART_TOTAL) ? share->error[0][BR_PART_TOTAL] : (double)NAN,
            NULL);
    }
    br_series_sort(series);
}

static bool is_anywhere(const struct line *line, size_t part)
{
    bool known = false;
    for (size_t i = 0; i < line->count; i++)
        known |= is_on(line, &line->split[i]) &&
                 br_share_known(&line->split[i].share[part], 0, BR_PART_TOTAL);
    return known;
}

/* The method, as far as it is not the default, and the elements or steps that the runs share. */
static void name_panel(const struct line *line, struct br_panel *p)
{
    const struct br_split *s = line->first;
    const struct br_method *m = &s->method;
    const bool contact = s->scene->contact.modelled;
    const bool friction = m->friction != br_friction_rules[0];
    const bool solver = m->solver != br_linear_solvers[0];
    char at[40];
    if (line->over_k)
        BR_SAY(at, "n = %zu", line->finest);
    else
        BR_SAY(at, "k = %.3g s", br_time_step(s->scene, line->finest));
    BR_SAY(p->title, "%s%s%s%s%s%s%s%s, %s", m->scheme->name, contact ? ", " : "",
           contact ? m->contact->name : "", friction ? ", " : "", friction ? m->friction->name : "",
           solver ? ", " : "", solver ? m->solver->name : "", m->axial_degree != 1 ? ", P2" : "",
           at);
}

/* The whole is a band behind its components. */
static void fill_panel(const struct line *line, struct br_figure *f)
{
    const struct br_split *first = line->first;
    name_panel(line, br_panel_add(f, true, line->over_k ? "time step k (s)" : "mesh size h (m)",
                                  "%s (%s)", first->norm[0]->symbol, first->norm[0]->unit_markup));
    add_points(line, BR_SOURCES, br_series_add(f, BR_PEN_BAND, "whole"));
    for (size_t i = 0; i < BR_SOURCES; i++)
        if (is_anywhere(line, i))
            add_points(line, i, br_series_add(f, BR_PEN_CURVE, "%s", first->share[i].name));
}

struct br_figure br_split_draw(const struct br_split *split, size_t count)
{
    struct line line = {.split = split, .count = count};
    bool meshes = false;
    struct br_figure figure = {.one_y = true}, *f = &figure;
    for (size_t i = 1; i < count; i++) {
        line.over_k |= split[i].at.steps != split[0].at.steps;
        meshes |= split[i].at.n != split[0].at.n;
    }
    if (!line.over_k && !meshes)
        return figure;
    BR_SAY(f->stem, "%.100s-split", split->scene->name);
    BR_SAY(f->title, "Where the error comes from: %s", split->scene->title);
    for (size_t i = 0; i < count && f->panels < PANELS; i++) {
        if (line.first && br_methods_equal(&split[i].method, &line.first->method))
            continue;
        line.first = &split[i];
        line.finest = 0;
        for (size_t j = 0; j < count; j++)
            if (br_methods_equal(&split[j].method, &line.first->method) &&
                fixed(&line, &split[j]) > line.finest)
                line.finest = fixed(&line, &split[j]);
        fill_panel(&line, f);
    }
    return figure;
}
