/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/heat.h"

#include <math.h>
#include <stdarg.h>

#include "plots/data.h"
#include "study/scene/quote.h"

enum br_status br_heat_panel_init(struct br_heat_panel *panel, size_t columns, size_t rows,
                                  struct br_error *err)
{
    *panel = (struct br_heat_panel){.columns = columns, .rows = rows};
    panel->x = br_allocate(columns + 1, sizeof *panel->x);
    panel->y = br_allocate(rows + 1, sizeof *panel->y);
    panel->value = br_allocate(rows * columns + 1, sizeof *panel->value);
    if (!panel->x || !panel->y || !panel->value)
        return br_no_memory(err, "a heat map");
    for (size_t i = 0; i < rows * columns; i++)
        panel->value[i] = NAN;
    return BR_OK;
}

double (*br_heat_line(struct br_heat_panel *panel, size_t count, const char *title, ...))[2]
{
    if (panel->lines == BR_HEAT_LINES)
        return NULL;
    struct br_heat_line *line = &panel->line[panel->lines];
    line->point = br_allocate(count + 1, sizeof *line->point);
    if (!line->point)
        return NULL;
    line->count = count;
    va_list arguments;
    va_start(arguments, title);
    vsnprintf(line->title, sizeof line->title, title, arguments);
    va_end(arguments);
    panel->lines++;
    return line->point;
}

void br_heat_clear(struct br_heat *heat)
{
    for (size_t i = 0; i < BR_HEAT_PANELS; i++) {
        struct br_heat_panel *p = &heat->panel[i];
        free(p->x);
        free(p->y);
        free(p->value);
        for (size_t j = 0; j < p->lines; j++)
            free(p->line[j].point);
    }
    *heat = (struct br_heat){0};
}

/* ---- data ---- */

void br_heat_range(const struct br_heat *heat, double *low, double *high)
{
    *low = heat->low;
    *high = heat->high;
    if (heat->low < heat->high)
        return;
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < heat->panels; i++)
        for (size_t j = 0; j < heat->panel[i].rows * heat->panel[i].columns; j++) {
            const double v = heat->panel[i].value[j];
            if (!isfinite(v) || (heat->log_value && !(v > 0)))
                continue;
            *low = fmin(*low, v);
            *high = fmax(*high, v);
        }
    if (!(*low <= *high))
        *low = *high = 1; /* nothing is told */
    if (*low == *high) {
        *low = heat->log_value ? *low / 10 : *low - 1;
        *high = heat->log_value ? *high * 10 : *high + 1;
    }
}

bool br_heat_told(const struct br_heat *heat, double value)
{
    return heat->kinds ? value >= 0 && value < (double)heat->kinds : !isnan(value);
}

static double middle(double a, double b, bool logarithmic)
{
    return logarithmic ? sqrt(a) * sqrt(b) : (a + b) / 2;
}

static void write_number(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, " %.12g", value);
    else
        fprintf(out, isnan(value) ? " NaN" : value > 0 ? " Inf" : " -Inf");
}

static void write_cells(FILE *out, const struct br_heat *heat, const struct br_heat_panel *p)
{
    double low, high;
    br_heat_range(heat, &low, &high);
    for (size_t i = 0; i < p->rows; i++)
        for (size_t j = 0; j < p->columns; j++) {
            const double v = p->value[i * p->columns + j];
            fprintf(out, "%.12g %.12g %.12g %.12g %.12g %.12g",
                    middle(p->x[j], p->x[j + 1], p->log_x), middle(p->y[i], p->y[i + 1], p->log_y),
                    p->x[j], p->x[j + 1], p->y[i], p->y[i + 1]);
            write_number(out, v);
            write_number(out, isnan(v) || heat->kinds ? v : fmin(fmax(v, low), high));
            fprintf(out, " %d\n", br_heat_told(heat, v));
        }
}

static void write_line(FILE *out, const struct br_heat_line *line)
{
    for (size_t k = 0; k < line->count; k++)
        if (isfinite(line->point[k][0]) && isfinite(line->point[k][1]))
            fprintf(out, "%.12g %.12g\n", line->point[k][0], line->point[k][1]);
        else
            fprintf(out, "NaN NaN\n");
}

void br_heat_write_data(FILE *out, const struct br_heat *heat)
{
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, heat->title);
    for (size_t k = 0; k < heat->kinds; k++)
        fprintf(out, "# value %zu: %s\n", k, heat->kind[k]);
    size_t index = 0;
    for (size_t i = 0; i < heat->panels; i++) {
        const struct br_heat_panel *p = &heat->panel[i];
        fprintf(
            out,
            "# index %zu: %s; cells: x y, x from to, y from to, value, colour, told\n# %s | %s\n",
            index++, p->title, p->x_label, p->y_label);
        write_cells(out, heat, p);
        fputs("\n\n", out);
        for (size_t j = 0; j < p->lines; j++) {
            fprintf(out, "# index %zu: %s; %s\n", index++, p->title, p->line[j].title);
            write_line(out, &p->line[j]);
            fputs("\n\n", out);
        }
    }
}
