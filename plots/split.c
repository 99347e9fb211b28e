/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of the error over the time step, or over the mesh: where one of them takes over. */
#include <math.h>
#include <string.h>

#include "plots/pictures.h"
#include "study/trade/split.h"

enum { PANELS = 2 };

/* Runs of one method: over k on the finest of its meshes, or over h at its smallest k. */
struct line {
    const struct br_split *split, *first; /* of all count; of the method */
    size_t count, finest;                 /* n, or steps */
    bool over_k;
};

static bool same_method(const struct br_split *a, const struct br_split *b)
{
    const struct br_method *x = &a->method, *y = &b->method;
    return x->scheme == y->scheme && x->contact == y->contact && x->friction == y->friction &&
           x->solver == y->solver && x->tolerance == y->tolerance &&
           x->axial_degree == y->axial_degree && x->linear.refinement == y->linear.refinement &&
           strcmp(x->linear.scaling, y->linear.scaling) == 0;
}

static double abscissa(const struct br_split *s, bool over_k)
{
    return over_k ? br_time_step(s->scene, s->at.steps) : br_mesh_size(s->scene, s->at.n);
}

static size_t fixed(const struct br_split *s, bool over_k)
{
    return over_k ? s->at.n : s->at.steps;
}

static bool is_on(const struct line *line, const struct br_split *s)
{
    return same_method(s, line->first) && fixed(s, line->over_k) == line->finest;
}

/* The run of the line with the smallest k or h above `after`; NULL: there is none. */
static const struct br_split *next(const struct line *line, double after)
{
    const struct br_split *best = NULL;
    for (size_t i = 0; i < line->count; i++) {
        const struct br_split *s = &line->split[i];
        const double x = abscissa(s, line->over_k);
        if (is_on(line, s) && x > after && (!best || x < abscissa(best, line->over_k)))
            best = s;
    }
    return best;
}

/* Part i of a run; past the last, the whole. */
static const struct br_share *share_of(const struct br_split *s, size_t i)
{
    return i < s->shares ? &s->share[i] : &s->whole;
}

/* A gap where it cannot be told. */
static void add_points(const struct line *line, size_t share, struct br_series *series)
{
    for (const struct br_split *s = next(line, 0); s; s = next(line, abscissa(s, line->over_k))) {
        const struct br_share *part = share_of(s, share);
        const bool told = br_share_told(part, 0, BR_PART_TOTAL);
        br_point_add(series, abscissa(s, line->over_k),
                     told ? part->error[0][BR_PART_TOTAL] : (double)NAN, NULL);
    }
}

static bool is_anywhere(const struct line *line, size_t share)
{
    for (const struct br_split *s = next(line, 0); s; s = next(line, abscissa(s, line->over_k)))
        if (br_share_told(share_of(s, share), 0, BR_PART_TOTAL))
            return true;
    return false;
}

/* The method, as far as it is not the default, and what all runs of the line share. */
static void name_panel(const struct line *line, char *title, size_t size)
{
    const struct br_split *s = line->first;
    const struct br_method *m = &s->method;
    size_t used = (size_t)snprintf(title, size, "%s", m->scheme->name);
    if (s->scene->contact.modelled)
        used += (size_t)snprintf(title + used, size - used, ", %s", m->contact->name);
    if (m->friction != br_friction_rules[0])
        used += (size_t)snprintf(title + used, size - used, ", %s", m->friction->name);
    if (m->solver != br_linear_solvers[0])
        used += (size_t)snprintf(title + used, size - used, ", %s", m->solver->name);
    if (m->axial_degree != 1)
        used += (size_t)snprintf(title + used, size - used, ", P%d", m->axial_degree);
    if (line->over_k)
        snprintf(title + used, size - used, ", n = %zu", line->finest);
    else
        snprintf(title + used, size - used, ", k = %.3g s", br_time_step(s->scene, line->finest));
}

/* A source looks the same in both panels; the whole is a band behind them. */
static void fill_panel(const struct line *line, struct br_panel *p)
{
    const struct br_split *first = line->first;
    p->log_x = p->log_y = true;
    name_panel(line, p->title, sizeof p->title);
    BR_SAY(p->x_label, line->over_k ? "time step k (s)" : "mesh size h (m)");
    BR_SAY(p->y_label, "%s (%s)", first->norm[0]->symbol, first->norm[0]->unit_markup);
    add_points(line, first->shares, br_series_add(p, BR_PEN_BAND, "whole"));
    for (size_t i = 0; i < first->shares; i++) {
        if (!is_anywhere(line, i))
            continue;
        struct br_series *s = br_series_add(p, BR_PEN_CURVE, "%s", first->share[i].source->name);
        if (s)
            s->hue = 1 + i % BR_HUES;
        add_points(line, i, s);
    }
}

enum br_status br_split_draw(const struct br_split *split, size_t count, struct br_figure *f,
                             struct br_error *err)
{
    struct line line = {.split = split, .count = count};
    bool meshes = false;
    *f = (struct br_figure){.one_y = true};
    for (size_t i = 1; i < count; i++) {
        line.over_k |= split[i].at.steps != split[0].at.steps;
        meshes |= split[i].at.n != split[0].at.n;
    }
    if (!line.over_k && !meshes)
        return BR_OK;
    BR_SAY(f->stem, "%.100s-split", split->scene->name);
    BR_SAY(f->title, "Where the error comes from: %s", split->scene->title);
    for (size_t i = 0; i < count && f->panels < PANELS; i++) {
        if (line.first && same_method(&split[i], line.first))
            continue;
        line.first = &split[i];
        line.finest = 0;
        for (size_t j = 0; j < count; j++)
            if (same_method(&split[j], line.first) && fixed(&split[j], line.over_k) > line.finest)
                line.finest = fixed(&split[j], line.over_k);
        fill_panel(&line, br_panel_add(f));
    }
    return br_figure_check(f, err);
}
