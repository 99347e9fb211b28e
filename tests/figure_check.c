/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/scene/quote.h"

char *figure_written(const struct br_figure *figure,
                     void (*write)(FILE *, const struct br_figure *))
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    write(out, figure);
    assert_int_equal(fclose(out), 0);
    return text;
}

static void expect(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("expected:\n%s\nin:\n%.3000s", part, text);
}

/* The next line with numbers; *heading (in/out): set when a comment line says this on the way. */
static char *next_row(char **rest, const char *heading, bool *found)
{
    char *line;
    while ((line = strsep(rest, "\n")) && (*line == '\0' || *line == '#'))
        *found = *found || strcmp(line, heading) == 0;
    return line;
}

static bool same(double a, double b)
{
    return isnan(b) ? isnan(a) : a == b;
}

static void check_numbers(char *row, size_t count, const double *value, char **rest)
{
    for (size_t i = 0; i < count; i++) {
        const double got = strtod(row, rest);
        if (*rest == row || !same(got, value[i]))
            fail_msg("column %zu is %.17g, expected %.17g, in: %s", i, got, value[i], row);
        row = *rest;
    }
}

/* A block of the file: where it is, and of what. */
struct reading {
    const struct br_figure *figure;
    const struct br_panel *panel;
    char *rest;
    const char *script;
    size_t index;
};

static void check_cells(struct reading *r)
{
    const struct br_panel *p = r->panel;
    const struct br_cells *c = &p->cells;
    const struct br_range range = r->figure->value;
    char heading[300], *rest;
    snprintf(heading, sizeof heading, "# %s | %s", p->x_label, p->y_label);
    bool found = false;
    for (size_t i = 0; i < c->rows * c->columns; i++) {
        const double *x = &c->x[i % c->columns], *y = &c->y[i / c->columns], v = c->value[i];
        const double kind = v >= 0 && v < (double)r->figure->kinds ? v : -1;
        const double shown = r->figure->kinds ? kind
                             : isnan(v)       ? -1
                             : v < range.low  ? range.low
                             : v > range.high ? range.high
                                              : v;
        const double row[5] = {x[0], x[1], y[0], y[1], v};
        char *line = next_row(&r->rest, heading, &found);
        assert_true(line && found);
        check_numbers(line, 5, row, &rest);
        CLOSE(strtod(rest, &rest), shown, 1e-8 * fabs(shown));
        assert_string_equal(rest, "");
    }
    char clause[128];
    snprintf(clause, sizeof clause,
             "data index %zu using ($6 < 0 ? NaN : $1):3:1:2:3:4:6 with boxxyerror", r->index++);
    expect(r->script, clause);
}

static void check_series(struct reading *r, const struct br_series *s)
{
    char heading[300], clause[64], *rest;
    bool found = false, drawn = false;
    snprintf(heading, sizeof heading, "# %s | %s | flag", r->panel->x_label, r->panel->y_label);
    for (size_t i = 0; i < s->count; i++) {
        const struct br_figure_point *at = &s->point[i];
        const double row[2] = {at->x, br_is_drawn(r->panel, at) ? at->y : (double)NAN};
        drawn |= br_is_drawn(r->panel, at);
        char *line = next_row(&r->rest, heading, &found);
        assert_true(line && found);
        check_numbers(line, 2, row, &rest);
        assert_string_equal(rest + 1, at->flag ? at->flag : "-");
    }
    snprintf(clause, sizeof clause, "index %zu using 1:2", r->index++);
    if (drawn)
        expect(r->script, clause);
}

static void check_label(const char *script, char axis, const char *label)
{
    char quoted[300], clause[320];
    br_quoted(quoted, sizeof quoted, &br_for_gnuplot, label);
    snprintf(clause, sizeof clause, "\nset %clabel %s font", axis, quoted);
    expect(script, clause);
}

void figure_check(const struct br_figure *f)
{
    char *data = figure_written(f, br_figure_write_data);
    char *script = figure_written(f, br_figure_write_script);
    struct reading r = {.figure = f, .rest = data, .script = script};
    bool ignored = false;
    for (size_t i = 0; i < f->panels; i++) {
        r.panel = &f->panel[i];
        check_label(script, 'x', r.panel->x_label);
        check_label(script, 'y', r.panel->y_label);
        if (r.panel->cells.columns)
            check_cells(&r);
        for (size_t j = 0; j < r.panel->count; j++)
            if (r.panel->series[j]->count)
                check_series(&r, r.panel->series[j]);
    }
    assert_null(next_row(&r.rest, "", &ignored));
    free(data);
    free(script);
}

const struct br_series *figure_series(const struct br_panel *p, const char *title)
{
    for (size_t j = 0; j < p->count; j++)
        if (strcmp(p->series[j]->title, title) == 0)
            return p->series[j];
    fail_msg("no series %s", title);
    return NULL;
}

void figure_axes(const struct br_panel *p, const char *x_label, const char *y_label)
{
    if (strncmp(p->x_label, x_label, strlen(x_label)) != 0)
        fail_msg("the x axis is %s, expected %s", p->x_label, x_label);
    assert_string_equal(p->y_label, y_label);
}

void figure_point(const struct br_series *s, size_t i, double x, double y)
{
    assert_true(i < s->count);
    if (!same(s->point[i].x, x) || !same(s->point[i].y, y))
        fail_msg("%s: point %zu is (%.17g, %.17g), expected (%.17g, %.17g)", s->title, i,
                 s->point[i].x, s->point[i].y, x, y);
}
