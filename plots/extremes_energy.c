/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/extremes_energy.h"

#include <math.h>
#include <stdlib.h>

/* The density that is shown. */
enum { SHOWN = BR_VIBRATION_DENSITIES / 2 };

static bool add_curve(struct br_panel *panel, const struct br_vibration_row *row, bool measured,
                      const char *title)
{
    double(*point)[2] = br_chart_curve(panel, measured ? BR_STROKE_DOTS : BR_STROKE_SERIES,
                                       BR_VIBRATION_RATES, "%s", title);
    for (size_t r = 0; point && r < BR_VIBRATION_RATES; r++) {
        const struct br_vibration *v = &row->at[r][SHOWN];
        const double loss = fabs(measured || row->scheme->adaptive ? v->measured : v->predicted);
        point[r][0] = v->steps;
        point[r][1] = loss > 0 && v->end == BR_VIBRATION_DONE ? loss : NAN;
    }
    return point;
}

/* Schemes that take the same share a column. */
static bool same(const struct br_vibration_row *a, const struct br_vibration_row *b)
{
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
        if (!(fabs(a->at[r][SHOWN].predicted - b->at[r][SHOWN].predicted) <=
              b->at[r][SHOWN].round_off))
            return false;
    return a->damping == b->damping && a->kind == b->kind;
}

static const struct br_vibration_row *earlier(const struct br_energy_behaviour *b, size_t i)
{
    for (size_t j = 0; j < i; j++)
        if (same(&b->vibration[j], &b->vibration[i]))
            return &b->vibration[j];
    return NULL;
}

static bool is_drawn(const struct br_vibration_row *row, bool damped)
{
    return row->kind == BR_AXIAL && (row->damping > 0) == damped &&
           row->at[0][SHOWN].end == BR_VIBRATION_DONE;
}

static bool draw_panel(const struct br_energy_behaviour *b, bool damped, struct br_panel *panel)
{
    bool drawn = true, told = false;
    for (size_t i = 0; i < b->vibrations && drawn; i++)
        if (is_drawn(&b->vibration[i], damped) && !earlier(b, i))
            drawn = add_curve(panel, &b->vibration[i], false, b->vibration[i].scheme->name);
    for (size_t i = 0; i < b->vibrations && drawn; i++)
        if (is_drawn(&b->vibration[i], damped) && !earlier(b, i)) {
            drawn = add_curve(panel, &b->vibration[i], true, told ? "" : "measured");
            told = true;
        }
    return drawn;
}

enum br_status br_energy_chart(const struct br_energy_behaviour *b, struct br_chart **chart,
                               struct br_error *err)
{
    struct br_chart *c = *chart = br_allocate(1, sizeof *c);
    if (!c)
        return br_no_memory(err, "a chart");
    br_chart_lay_out(c, 2);
    snprintf(c->stem, sizeof c->stem, "energy");
    snprintf(c->title, sizeof c->title, "Energy of a free vibration lost to the scheme, a period");
    bool drawn = true;
    for (int damped = 0; damped < 2 && drawn; damped++) {
        struct br_panel *p = &c->panel[damped];
        snprintf(p->title, sizeof p->title, "%s",
                 damped ? "1 % of critical damping, beside viscosity" : "undamped");
        snprintf(p->x_label, sizeof p->x_label, "steps a period");
        snprintf(p->y_label, sizeof p->y_label, "share a period%s", damped ? ", size" : "");
        p->log_x = p->log_y = true;
        drawn = draw_panel(b, damped, p);
    }
    return drawn ? BR_OK : br_no_memory(err, "a curve");
}
