/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands in each figure. */
#include <math.h>

#include "plots/figures.h"

#define NAME(panel, text) snprintf((panel)->title, sizeof(panel)->title, text)

/* ---- Example 1 ---- */

static void lay_out_inset(struct br_chart *chart, struct br_panel frame)
{
    struct br_panel *p = &chart->panel[chart->panels++];
    *p = frame;
    p->inset = true;
    p->x_high = 100;
    snprintf(p->x_label, sizeof p->x_label, "time t (µs)");
}

/* Exact line, and every 40th of the scheme's rows as circles. */
static bool draw_early_slip(const struct br_early *early, struct br_panel *p)
{
    double(*exact)[2] = br_chart_curve(p, BR_STROKE_SOLID, BR_EXACT_EARLY + 1, "exact");
    for (size_t i = 0; exact && i <= BR_EXACT_EARLY; i++) {
        exact[i][0] = 1e6 * early->exact[i].time;
        exact[i][1] = 1e9 * early->exact[i].displacement[BR_BENDING];
    }
    const size_t every = 40, count = early->record.rows / every;
    double(*scheme)[2] = br_chart_curve(p, BR_STROKE_DOTS, count, "scheme");
    for (size_t i = 0; scheme && i < count; i++) {
        scheme[i][0] = 1e6 * early->record.row[i * every].time;
        scheme[i][1] = 1e9 * early->record.row[i * every].displacement[BR_BENDING];
    }
    NAME(p, "the tip at first: line exact, o k = 0.1 µs");
    snprintf(p->y_label, sizeof p->y_label, "w(L,t) (nm)");
    return exact && scheme;
}

bool br_draw_figure2(const struct br_paper *paper, struct br_chart *chart)
{
    const struct br_example *e = &paper->example[0];
    br_chart_lay_out(chart, 2);
    NAME(&chart->panel[0], "horizontal");
    NAME(&chart->panel[1], "vertical");
    chart->panel[1].y_low = -0.1;
    chart->panel[1].y_high = 0.25;
    lay_out_inset(chart,
                  (struct br_panel){.left = 0.675, .right = 0.965, .bottom = 0.56, .top = 0.765});
    return br_draw_field(e, BR_AXIAL, &chart->panel[0]) &&
           br_draw_field(e, BR_BENDING, &chart->panel[1]) &&
           draw_early_slip(&paper->early, &chart->panel[2]);
}

static bool draw_early_forces(const struct br_early *early, struct br_panel *p)
{
    double(*stress)[2] = br_chart_curve(p, BR_STROKE_SOLID, BR_EXACT_EARLY + 1, "stress");
    double(*bound)[2] = br_chart_curve(p, BR_STROKE_DASHED, BR_EXACT_EARLY + 1, "bound");
    for (size_t i = 0; stress && bound && i <= BR_EXACT_EARLY; i++) {
        stress[i][0] = bound[i][0] = 1e6 * early->exact[i].time;
        stress[i][1] = -early->exact[i].friction_force;
        bound[i][1] = early->exact[i].friction_bound;
    }
    NAME(p, "the first instants, exact");
    snprintf(p->y_label, sizeof p->y_label, "force (N)");
    p->y_high = 0.6;
    return stress && bound;
}

bool br_draw_figure3(const struct br_paper *paper, struct br_chart *chart)
{
    const struct br_example *e = &paper->example[0];
    br_chart_lay_out(chart, 1);
    struct br_panel *p = &chart->panel[0];
    p->log_y = true;
    p->y_low = 1e-3;
    p->y_high = 1e7;
    lay_out_inset(chart,
                  (struct br_panel){.left = 0.6, .right = 0.93, .bottom = 0.39, .top = 0.535});
    return br_draw_bound(e, 1, "friction bound h(t) = c_V u(1,t)", p) &&
           br_draw_stress(e, "tangential stress {/Symbol s}_V(1,t)", p) &&
           draw_early_forces(&paper->early, &chart->panel[1]);
}

/* ---- Examples 2 and 3 ---- */

static bool draw_bending(const struct br_example *e, struct br_chart *chart)
{
    br_chart_lay_out(chart, 2);
    NAME(&chart->panel[0], "the beam");
    NAME(&chart->panel[1], "the contact node");
    chart->panel[1].plain = true;
    return br_draw_field(e, BR_BENDING, &chart->panel[0]) &&
           br_draw_tip(e, BR_BENDING, "", &chart->panel[1]);
}

bool br_draw_figure4(const struct br_paper *paper, struct br_chart *chart)
{
    return draw_bending(&paper->example[1], chart);
}

/* When the tip lets go by the text, and by the exact solution. */
static void mark_release(const struct br_example *e, double height, struct br_panel *p)
{
    struct br_mark *mark = br_chart_mark(p, 0.68, "0.68 s, the text");
    mark->height = height;
    mark->left = true;
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].phase == BR_SLIP_DOWN) {
            mark = br_chart_mark(p, e->event[i].time, "%.2f s, exact", e->event[i].time);
            mark->height = height - 0.1;
            mark->left = true;
        }
}

bool br_draw_figure5(const struct br_paper *paper, struct br_chart *chart)
{
    const bool drawn = draw_bending(&paper->example[2], chart);
    mark_release(&paper->example[2], 0.3, &chart->panel[1]);
    return drawn;
}

bool br_draw_figure6(const struct br_paper *paper, struct br_chart *chart)
{
    const struct br_example *e = &paper->example[2];
    br_chart_lay_out(chart, 1);
    struct br_panel *p = &chart->panel[0];
    p->y_high = 3500;
    mark_release(e, 0.3, p);
    return br_draw_bound(e, 1, "friction bound c_V", p) &&
           br_draw_stress(e, "tangential stress {/Symbol s}_V(1,t)", p);
}

/* ---- Example 4 ---- */

bool br_draw_figure7(const struct br_paper *paper, struct br_chart *chart)
{
    const struct br_example *e = &paper->example[3];
    br_chart_lay_out(chart, 2);
    NAME(&chart->panel[0], "the beam");
    NAME(&chart->panel[1], "the contact node");
    chart->panel[1].plain = true;
    return br_draw_field(e, BR_AXIAL, &chart->panel[0]) &&
           br_draw_tip(e, BR_AXIAL, "", &chart->panel[1]);
}

/* When the exact tip begins to stick or to slip; height: of the later labels. */
static void mark_phases(const struct br_example *e, double height, struct br_panel *p)
{
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].field == BR_EXACT_BENDING && e->event[i].time > 0) {
            struct br_mark *mark =
                br_chart_mark(p, e->event[i].time, "%s", br_phase_text(e->event[i].phase));
            mark->left = e->event[i].time > 0.5 * e->scene.duration;
            mark->height = mark->left ? height : 0.05;
        }
}

bool br_draw_figure8(const struct br_paper *paper, struct br_chart *chart)
{
    const bool drawn = draw_bending(&paper->example[3], chart);
    mark_phases(&paper->example[3], 0.05, &chart->panel[1]);
    return drawn;
}

bool br_draw_figure9(const struct br_paper *paper, struct br_chart *chart)
{
    const struct br_example *e = &paper->example[3];
    br_chart_lay_out(chart, 2);
    NAME(&chart->panel[0], "friction bound");
    NAME(&chart->panel[1], "tangential stress");
    chart->panel[1].columns = 2;
    mark_phases(e, 0.4, &chart->panel[1]);
    return br_draw_bound(e, 1, "h(t) = c_V u(1,t)", &chart->panel[0]) &&
           br_draw_bound(e, 1, "bounds h(t) and -h(t)", &chart->panel[1]) &&
           br_draw_bound(e, -1, "", &chart->panel[1]) &&
           br_draw_stress(e, "stress {/Symbol s}_V(1,t)", &chart->panel[1]);
}

/* ---- Figure 10 ---- */

static bool draw_sweep(const struct br_sweep *s, struct br_panel *p)
{
    double(*most)[2] =
        br_chart_curve(p, BR_STROKE_SOLID, s->points, "largest of all times, contact at u_n");
    double(*last)[2] = br_chart_curve(p, BR_STROKE_DASHED, s->points, "at t = T, contact at u_n");
    double(*printed)[2] =
        br_chart_curve(p, BR_STROKE_DOTS, s->points, "largest, as printed: at u_{n-1}");
    for (size_t i = 0; most && last && printed && i < s->points; i++) {
        const struct br_sweep_point *at = &s->point[i];
        most[i][0] = last[i][0] = printed[i][0] = at->coefficient;
        most[i][1] = at->most[1];
        last[i][1] = at->last[1];
        printed[i][1] = at->most[0];
    }
    p->log_x = p->log_y = true;
    p->columns = 1;
    p->x_low = s->point[0].coefficient;
    p->x_high = s->point[s->points - 1].coefficient;
    p->y_low = 0.05;
    snprintf(p->y_label, sizeof p->y_label, "|u| + |w| (m^{3/2})");
    struct br_mark *mark = br_chart_mark(p, s->paper, "the paper's");
    mark->height = s->point[0].most[1] < 0.5 ? 0.5 : 0.06; /* clear of the curves */
    mark->left = true;
    return most && last && printed;
}

bool br_draw_figure10(const struct br_paper *paper, struct br_chart *chart)
{
    const struct br_sweep *contact = &paper->sweep[BR_SWEEP_CONTACT];
    br_chart_lay_out(chart, 2);
    struct br_panel *left = &chart->panel[0], *right = &chart->panel[1];
    if (!draw_sweep(contact, left) || !draw_sweep(&paper->sweep[BR_SWEEP_FRICTION], right))
        return false;
    left->y_high = 1e4;
    right->y_high = 1;
    snprintf(left->x_label, sizeof left->x_label, "contact coefficient c_H (N/m)");
    snprintf(right->x_label, sizeof right->x_label, "friction coefficient c_V (N/m)");
    for (size_t i = 0; i < contact->points; i++)
        if (contact->point[i].unstable) {
            br_chart_mark(left, contact->point[i].coefficient, "as printed: amplifies")->height =
                0.4;
            break;
        }
    return true;
}
