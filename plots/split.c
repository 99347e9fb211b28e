/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/split.h"

#include <math.h>
#include <string.h>

enum { PANELS = 2 };

/* Runs of one method along one axis, by ascending k or h. */
struct line {
    const struct br_split **run; /* owned */
    size_t count;
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

static void insert(struct line *line, const struct br_split *s)
{
    size_t i = line->count++;
    for (; i > 0 && abscissa(line->run[i - 1], line->over_k) > abscissa(s, line->over_k); i--)
        line->run[i] = line->run[i - 1];
    line->run[i] = s;
}

/* The runs of the method of `first`, on the finest of its meshes or at its smallest step. */
static void collect(const struct br_split *split, size_t count, const struct br_split *first,
                    struct line *line)
{
    size_t finest = 0;
    line->count = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t other = line->over_k ? split[i].at.n : split[i].at.steps;
        if (same_method(&split[i], first) && other > finest)
            finest = other;
    }
    for (size_t i = 0; i < count; i++)
        if (same_method(&split[i], first) &&
            (line->over_k ? split[i].at.n : split[i].at.steps) == finest)
            insert(line, &split[i]);
}

/* One part along the line, or the whole; a gap where it cannot be told. Parts that are nowhere
 * have no curve. */
static bool draw_part(const struct line *line, size_t share, enum br_stroke stroke,
                      struct br_panel *panel)
{
    const bool whole = share >= line->run[0]->shares;
    bool anywhere = false;
    for (size_t i = 0; i < line->count && !whole; i++)
        anywhere |= br_share_told(&line->run[i]->share[share], 0, BR_PART_TOTAL);
    if (!anywhere && !whole)
        return true;
    double(*point)[2] = br_chart_curve(panel, stroke, line->count, "%s",
                                       whole ? "whole" : line->run[0]->share[share].source->name);
    if (point) { /* a source looks the same in both panels */
        panel->curve[panel->curves - 1].pen = share + 1;
        panel->curve[panel->curves - 1].pens = line->run[0]->shares;
    }
    for (size_t i = 0; point && i < line->count; i++) {
        const struct br_split *s = line->run[i];
        const struct br_share *part = whole ? &s->whole : &s->share[share];
        point[i][0] = abscissa(s, line->over_k);
        point[i][1] = br_share_told(part, 0, BR_PART_TOTAL) ? part->error[0][BR_PART_TOTAL] : NAN;
    }
    return point;
}

/* The method, as far as it is not the default, and what all runs of the line share. */
static void name_panel(const struct line *line, char *title, size_t size)
{
    const struct br_split *s = line->run[0];
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
        snprintf(title + used, size - used, ", n = %zu", s->at.n);
    else
        snprintf(title + used, size - used, ", k = %.3g s", br_time_step(s->scene, s->at.steps));
}

static bool draw_panel(const struct line *line, struct br_panel *panel)
{
    const struct br_split *s = line->run[0];
    panel->log_x = panel->log_y = true;
    panel->columns = 4;
    name_panel(line, panel->title, sizeof panel->title);
    snprintf(panel->x_label, sizeof panel->x_label, "%s",
             line->over_k ? "time step k (s)" : "element length h (m)");
    snprintf(panel->y_label, sizeof panel->y_label, "%s (%s)", s->norm[0]->symbol,
             s->norm[0]->unit_markup);
    panel->x_low = abscissa(s, line->over_k) / 1.3;
    panel->x_high = abscissa(line->run[line->count - 1], line->over_k) * 1.3;
    bool drawn = true;
    for (size_t i = 0; i < s->shares && drawn; i++)
        drawn = draw_part(line, i, BR_STROKE_MARKED, panel);
    return drawn && draw_part(line, s->shares, BR_STROKE_DOTS, panel); /* above all */
}

/* One range for all panels: their heights can be compared. */
static void share_range(struct br_chart *chart)
{
    double low = INFINITY, high = 0;
    for (size_t i = 0; i < chart->panels; i++)
        for (size_t j = 0; j < chart->panel[i].curves; j++)
            for (size_t k = 0; k < chart->panel[i].curve[j].count; k++) {
                const double y = chart->panel[i].curve[j].point[k][1];
                low = y > 0 && y < low ? y : low;
                high = y > high ? y : high;
            }
    for (size_t i = 0; i < chart->panels && low <= high; i++) {
        chart->panel[i].y_low = pow(10, floor(log10(low / 1.5)));
        chart->panel[i].y_high = pow(10, ceil(log10(1.5 * high)));
    }
}

/* The first runs of up to two methods; how many. */
static size_t first_runs(const struct br_split *split, size_t count,
                         const struct br_split *first[PANELS])
{
    size_t found = 0;
    for (size_t i = 0; i < count && found < PANELS; i++)
        if (found == 0 || !same_method(&split[i], first[0]))
            first[found++] = &split[i];
    return found;
}

static bool draw(const struct br_split *split, size_t count, struct line *line,
                 struct br_chart *chart)
{
    const struct br_split *first[PANELS];
    const size_t panels = first_runs(split, count, first);
    br_chart_lay_out(chart, panels);
    snprintf(chart->stem, sizeof chart->stem, "%.100s-split", split->scene->name);
    snprintf(chart->title, sizeof chart->title, "Where the error comes from: %s",
             split->scene->title);
    bool drawn = true;
    for (size_t i = 0; i < panels && drawn; i++) {
        collect(split, count, first[i], line);
        drawn = draw_panel(line, &chart->panel[i]);
    }
    share_range(chart);
    return drawn;
}

enum br_status br_split_chart(const struct br_split *split, size_t count, struct br_chart *chart,
                              struct br_error *err)
{
    struct line line = {0};
    bool meshes = false;
    *chart = (struct br_chart){0};
    for (size_t i = 1; i < count; i++) {
        line.over_k |= split[i].at.steps != split[0].at.steps;
        meshes |= split[i].at.n != split[0].at.n;
    }
    if (!line.over_k && !meshes)
        return BR_OK;
    line.run = br_allocate(count, sizeof(struct br_split *));
    const bool drawn = line.run && draw(split, count, &line, chart);
    free(line.run);
    return drawn ? BR_OK : br_no_memory(err, "the plot");
}
